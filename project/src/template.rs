//! The file that `rungc init` writes.

use rungc_models::{Model, ModelId};
use std::path::Path;
use toml::Value;

/// Properties, as comments.
const PROPERTIES: &str = r#"# What the program must never do, and what the machine around it sees to: `rungc verify`.
# [[property]]
# name = "no short circuit"
# never = "Y000 & Y001"
# [verify]
# assume = ["!(X000 & X001)"]
"#;

/// What is around the program, as comments.
const OUTSIDE: &str = r#"# Devices that operator panels write and read: to checks and proofs, those written may change at any time.
# [hmi]
# writes = "D70-D79"
# reads = "M0-M15"

# What `rungc serve` opens, and devices that an emitted program stores for its ports, beyond those that the program names.
# [serve]
# modbus-tcp = "127.0.0.1:5020"
# mc = "127.0.0.1:5001"
# fx = "127.0.0.1:5556"
# page = "127.0.0.1:8080"
# serial = { COM1 = "/dev/ttyUSB0" }
# D = "D0-D511"
"#;

/// The line that names the program.
fn program_line(program: Option<&Path>) -> String {
    match program {
        // Separators as every system reads them.
        Some(path) => key("program", &path.display().to_string().replace('\\', "/")),
        None => format!("# {}", key("program", "machine.gxw")),
    }
}

/// The line that names the model.
fn model_line(model: Option<ModelId>) -> String {
    match model {
        Some(model) => key("model", Model::get(model).name),
        None => format!("# {}", key("model", "fx3u")),
    }
}

/// A file for a program, with a comment on each key. What is unknown appears as a comment; so does a model that the
/// program does not name itself.
pub fn template(program: Option<&Path>, model: Option<ModelId>) -> String {
    let models: Vec<_> = ModelId::ALL.iter().map(|&id| Model::get(id).name).collect();
    let program = program_line(program);
    let model = model_line(model);
    format!(
        r#"# Settings of a project for rungc, explained in `rungc book project`. Command-line options take precedence.

[project]
# The program, relative to this file: the default for commands without a FILE.
{program}
# The PLC model: {models}.
{model}
# Name of the program in emitted code, if it differs from the file's.
# name = "packer"
# Encoding of texts that are not Unicode, if rungc guesses wrong.
# encoding = "windows-1252"

[check]
# Warnings to suppress, by code or name: `rungc explain double-coil`.
allow = []
# Warnings to treat as errors.
deny = []
# Limits of the model to treat as warnings, by the codes of their errors.
# warn = ["E0105"]

# The language of reports: en or zh. Default: that of the environment.
# [report]
# lang = "zh"

[build]
# The output form of `rungc build`, and its path: c, rust, lib, bin, elf or ir.
# emit = "c"
# output = "firmware/plc"
# target = "thumbv7em-none-eabihf"
# board = "board.toml"
# Whether emitted C reads and writes devices by number and by name.
# access = true

[test]
# The files that `rungc test` runs, and on which engine: interp, c, rust or all.
# files = ["tests"]
# engine = "interp"

# The devices that an operand with an index register can reach, so that no others are stored.
# [index]
# "D100Z0" = "D100-D163"

# Instructions, by the bytes that encode them in vendor projects; `rungc learn` writes them.
# [tokens]
# "63 09 20" = "DSZR"

# Devices that keep their values over power-off, where that differs from the model's usual ranges.
# [latched]
# D = "D200-D511"

# Names of devices, in place of their comments: in reports, views, tests and emitted code.
# [labels]
# "Axis1.Ready" = "M100"

# Where `rungc run` and `rungc serve` keep latched devices from run to run.
# [retain]
# file = "machine.retain"

# Special modules, for checks and simulation: their numbers in FROM and TO, and what they are.
# [[module]]
# at = 0
# kind = "FX2N-4AD"

{PROPERTIES}
{OUTSIDE}"#,
        models = models.join(", ")
    )
}

fn key(name: &str, value: &str) -> String {
    format!("{name} = {}", Value::String(value.to_string()))
}
