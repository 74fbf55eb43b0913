//! PLC test files (`*.plctest.toml`): cases that run a program and compare devices, or that a program must not compile.
//!
//! [`load`] reads a file; [`Suite`] compiles the programs of many; [`run`] runs them on an
//! [`Engine`](crate::engines::Engine).

mod cases;
mod format;
mod keys;
mod lines;
mod modules;
mod naming;
mod program;
mod raw;
mod report;
mod rules;
mod runner;
mod serial;
mod servers;
mod stated;
mod step;
mod suite;
mod trace;
mod values;
mod wiring;

pub use cases::{run, run_in};
pub use program::{CaseProgram, ProgramFile};
pub use report::{Failure, Outcome, Report, Uncompiled};
pub use rules::{Never, RuleKind, Rules, Whenever, Within};
pub use runner::run_steps;
pub use serial::{Item, Port, PortId, Protocol, Sent};
pub use stated::Stated;
use std::collections::BTreeSet;
pub use suite::{Id, Suite};
pub use trace::Trace;

use crate::plant::Description;
use crate::problem::{self, LoadError};
use crate::record::decimal;
use crate::target::Target;
use crate::wire::Signal;
use rungc_models::{ModelId, Variant};
use rungc_rt::Clock;
use rungc_rt::modules::Kind;
use rungc_syntax::Source;
use rungc_syntax::codes::TEST_FILE;
use serde::Deserialize;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A test file.
#[derive(Clone, Debug)]
pub struct TestFile {
    /// The file's name as it was given.
    pub name: String,
    /// The instruction or subject.
    pub topic: String,
    /// A remark on the whole file.
    pub note: String,
    /// The files and folders that it was read from: itself, programs, machines, accepted traces, settings.
    pub inputs: BTreeSet<PathBuf>,
    /// Its cases.
    pub cases: Vec<Case>,
}

/// One case.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name, unique in the file.
    pub name: String,
    /// Its line in the file, from 1.
    pub line: u32,
    /// The model that it is for.
    pub model: ModelId,
    /// The PLC of that model that it is for, if it names one.
    pub variant: Option<&'static Variant>,
    /// Identifiers of the requirements that it belongs to, each once.
    pub requirements: Vec<String>,
    /// Source of the behaviour: a manual's file and lines.
    pub source: String,
    /// Relation of the behaviour to the source.
    pub basis: Option<Basis>,
    /// A remark.
    pub note: String,
    /// The program.
    pub program: CaseProgram,
    /// The machine that its inputs and outputs are wired to.
    pub machine: Option<Arc<Description>>,
    /// The special modules that are fitted to its PLC, with their numbers.
    pub modules: Vec<(u16, &'static Kind)>,
    /// PLCs beside that of the case.
    pub others: Vec<OtherPlc>,
    /// Ports on one line each.
    pub wires: Vec<Vec<Port>>,
    /// Servers over TCP: port number, and what they speak.
    pub serve: Vec<(u16, Protocol)>,
    /// Rules that must hold after each scan.
    pub rules: Rules,
    /// Trace to be compared with an accepted run.
    pub trace: Option<Trace>,
    /// Kind of check.
    pub check: Check,
}

/// A PLC beside that of a case.
#[derive(Clone, Debug)]
pub struct OtherPlc {
    /// Its name.
    pub name: String,
    /// Its model.
    pub model: ModelId,
    /// The PLC of that model, if the case names one.
    pub variant: Option<&'static Variant>,
    /// Its program, an instruction list.
    pub program: String,
    /// Set once before the first scan.
    pub init: Vec<Setting>,
}

/// Basis of a case.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// The manual states it outright.
    Manual,
    /// It follows from the manual's rules.
    Derived,
    /// Known behaviour of the FX family on which the manual is silent.
    Fx,
}

/// Check of a case.
#[derive(Clone, Debug)]
pub enum Check {
    /// The behaviour of the program.
    Steps {
        /// Set once before the first scan.
        init: Vec<Setting>,
        /// In this order.
        steps: Vec<Step>,
    },
    /// That the program does not compile.
    Rejects(Rejects),
}

/// The diagnostic that a program must raise.
#[derive(Clone, Copy, Debug)]
pub struct Rejects {
    /// The PLC's error code; 0 for any.
    pub code: u16,
    /// The line of the program, from 1, that it points to.
    pub line: Option<u32>,
}

/// One step of a case, its parts in the order in which they happen.
#[derive(Clone, Debug)]
pub struct Step {
    /// Its line in the file, from 1.
    pub line: u32,
    /// Power off and on.
    pub power_cycle: bool,
    /// The RUN/STOP switches of these PLCs.
    pub running: Vec<(usize, bool)>,
    /// Input of ports.
    pub rx: Vec<(Port, Vec<Item>)>,
    /// Output expected from ports during the step: any of these.
    pub expect_tx: Vec<(Port, Vec<Sent>)>,
    /// The ports that are off their lines from now on, if that changes.
    pub cut: Option<Vec<Port>>,
    /// The power supply fails from now on, or is back.
    pub power_fails: Option<bool>,
    /// Sets the real-time clock.
    pub clock: Option<Clock>,
    /// Sets buffer memory: module, address, value.
    pub bfm: Vec<(u16, u16, i16)>,
    /// Modules that answer after this many milliseconds from now on.
    pub answers_after: Vec<(u16, u16)>,
    /// Sets analog inputs: channel, value.
    pub analog: Vec<(u8, i16)>,
    /// Sets devices.
    pub set: Vec<Setting>,
    /// Signals at input terminals.
    pub signals: Vec<Signal>,
    /// Number of scans.
    pub run: Run,
    /// Conditions to wait for: the step ends after the scan after which all hold, and fails if they do not come to
    /// hold.
    pub until: Vec<Setting>,
    /// Virtual milliseconds that a scan takes.
    pub scan_ms: u32,
    /// Expected devices after the step.
    pub expect: Vec<Setting>,
    /// Conditions that must come to hold during the step.
    pub within: Vec<Within>,
    /// Rules that must hold after each scan of the step.
    pub rules: Rules,
    /// Expected buffer memory after the step.
    pub expect_bfm: Vec<(u16, u16, i16)>,
    /// Expected positions of the machine's axes after the step, in their units.
    pub expect_position: Vec<(String, f64)>,
}

/// Length of a step.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Run {
    /// This many scans.
    Scans(u32),
    /// Whole scans until this many milliseconds have passed.
    Ms(u32),
}

/// A device and its value.
#[derive(Clone, PartialEq, Debug)]
pub struct Setting {
    /// The PLC: 0 for that of the case, the others in their order.
    pub plc: usize,
    /// Named target.
    pub target: Target,
    /// Its value.
    pub value: Value,
    /// Tolerance, if the file states one.
    pub tolerance: Option<f64>,
}

/// A value as [`Target`] asks for it.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// A bit, word or double word.
    Int(i32),
    /// A float.
    Float(f64),
    /// Characters.
    Text(String),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Int(v) => v.fmt(f),
            Value::Float(v) => f.pad(&decimal(*v)),
            Value::Text(v) => write!(f, "{v:?}"),
        }
    }
}

/// Reads a test file.
pub fn load(path: &Path) -> Result<TestFile, LoadError> {
    parse_source(&problem::read(path)?)
}

/// Reads the text of a test file.
pub fn parse(name: &str, text: &str) -> Result<TestFile, LoadError> {
    parse_source(&Source::new(name, text))
}

fn parse_source(source: &Source) -> Result<TestFile, LoadError> {
    format::parse(source).map_err(|problems| LoadError::Format {
        code: &TEST_FILE,
        file: Box::new(source.clone()),
        problems,
    })
}

#[cfg(test)]
mod tests {
    use super::{Check, Port, PortId, Sent, Value, parse};

    fn problems_of(text: &str) -> String {
        parse("t.plctest.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn mistakes_are_reported_with_their_place() {
        let text = r#"model = "h3u"
topic = "t"
[[case]]
name = "a"
program = "END"
init = { D0 = 70000, X009 = 1, M0 = 2 }
[[case.step]]
scans = 1
run_ms = 5
clock = "noon"
bfm = { "5" = 1 }
[[case]]
name = "a"
program = "END"
"#;
        insta::assert_snapshot!(problems_of(text), @r#"
        t.plctest.toml:1:9: `h3u` is a CPU of Inovance H3U, which is not supported: rungc compiles programs of the FX family, up to FX3
        t.plctest.toml:6:15: the value of `D0` must be a 16-bit integer, or hexadecimal in quotes: "0xFFFF"
        t.plctest.toml:6:22: `X009`: `X` is followed by an octal number
        t.plctest.toml:6:37: the value of `M0` must be 0 or 1
        t.plctest.toml:9:10: use `scans` or `run_ms` in a step, not both
        t.plctest.toml:10:9: write a time as `2026-01-02T03:04:05`
        t.plctest.toml:11:9: write a word of buffer memory as `MODULE:ADDRESS`
        t.plctest.toml:12:1: a case needs steps or `rejects`
        t.plctest.toml:13:8: the case `a` is defined twice in this file
        "#);
    }

    #[test]
    fn cases_name_requirements() {
        let of = |line: &str| {
            let text = format!(
                "model = \"fx3u\"\ntopic = \"t\"\n[[case]]\nname = \"a\"\n{line}\nprogram = \"END\"\nstep = [{{ scans = 1 }}]\n"
            );
            parse("t.plctest.toml", &text).map(|file| file.cases[0].requirements.clone())
        };
        assert_eq!(of("requirement = \"R1\"").unwrap(), ["R1"]);
        let several = "requirement = [\"R1\", \"R 2\", \"R1\"]";
        assert_eq!(of(several).unwrap(), ["R1", "R 2"]);
        assert!(of("").unwrap().is_empty());
        let wrong = [
            "requirement = 1",
            "requirement = [\"\"]",
            "requirement = \"a\\nb\"",
        ];
        let wrong = wrong.map(|line| of(line).unwrap_err().to_string());
        insta::assert_snapshot!(wrong.join("\n"), @r"
        t.plctest.toml:5:15: expected an identifier in quotes, or a list of them
        t.plctest.toml:5:15: the identifier of a requirement is one line of text
        t.plctest.toml:5:15: the identifier of a requirement is one line of text
        ");
    }

    #[test]
    fn the_name_of_a_case_is_one_line() {
        let text = r#"model = "fx3u"
topic = "t"
[[case]]
name = "a\nb"
program = "END"
step = [{ scans = 1 }]
"#;
        insta::assert_snapshot!(problems_of(text), @"t.plctest.toml:4:8: the name of a case is one line, without control characters");
    }

    #[test]
    fn communication_is_held_to_the_format() {
        let text = r#"model = "h2u"
topic = "t"
[[case]]
name = "a"
program = "END"
wire = [["COM1", "B:COM9x"]]
serve = { "UDP:502" = "modbus" }
[[case.plc]]
name = "B"
program = "END"
[[case.plc]]
name = "B:"
program = ""
[[case.step]]
set = { "B:D0" = 1, "C:D0" = 1 }
rx = { COM1 = "41 4", "B:CAN" = "200#1" }
expect_tx = { COM1 = ["41", "/10"] }
cut = ["C:COM1"]
mode = { C = "stop" }
"#;
        insta::assert_snapshot!(problems_of(text), @r#"
        t.plctest.toml:6:18: write a port as `COM1`, `CAN` or `TCP:502`
        t.plctest.toml:7:11: write a port as `COM1`, `CAN` or `TCP:502`
        t.plctest.toml:12:8: the program of the PLC `B:` is empty
        t.plctest.toml:12:8: the name of a PLC consists of letters and digits
        t.plctest.toml:15:21: `C:D0` is not a device name; examples: `M0`, `X010`, `D0.i32`
        t.plctest.toml:16:8: write bytes as pairs of hexadecimal digits
        t.plctest.toml:16:23: write a CAN frame as `200#1234`: its identifier and up to 8 bytes in hexadecimal
        t.plctest.toml:17:15: write bytes as pairs of hexadecimal digits
        t.plctest.toml:18:8: write a port as `COM1`, `CAN` or `TCP:502`
        t.plctest.toml:19:8: the case has no PLC `C`
        "#);
    }

    #[test]
    fn what_cannot_match_or_be_wired_is_reported() {
        let text = r#"model = "h2u"
topic = "t"
[[case]]
name = "a"
program = "END"
serve = { "TCP:502" = "modbus" }
wire = [["COM1"], ["COM2", "COM2"], ["COM3", "TCP:502"]]
[[case.step]]
rx = { COM1 = "/1e300 00" }
expect_tx = { COM1 = [] }
encoder = { a = "X000", b = "X000", count = 5, hz = 10 }
"#;
        insta::assert_snapshot!(problems_of(text), @r#"
        t.plctest.toml:7:10: `COM1` is alone on its line
        t.plctest.toml:7:28: `COM2` is on this line already
        t.plctest.toml:7:46: `TCP:502` is not a port of a PLC
        t.plctest.toml:9:8: a line is idle for at most 1800000 ms in a step
        t.plctest.toml:10:15: the list has no text, so that nothing matches
        t.plctest.toml:11:29: the phases of an encoder have two terminals
        "#);
    }

    #[test]
    fn what_a_case_says_of_other_plcs_carries_their_numbers() {
        let text = r#"model = "h2u"
topic = "t"
[[case]]
name = "a"
program = "END"
wire = [["COM1", "B:COM2"]]
[[case.plc]]
name = "B"
model = "h1u"
program = "END"
[[case.step]]
set = { D0 = 1, "B:D0" = 2 }
mode = { B = "stop" }
expect_tx = { "B:COM2" = ["41 42", ""] }
cut = ["B:COM2"]
"#;
        let file = parse("t.plctest.toml", text).unwrap();
        let case = &file.cases[0];
        let Check::Steps { steps, .. } = &case.check else {
            panic!("the case has steps");
        };
        let step = &steps[0];
        let port = |plc, number| Port {
            plc,
            id: PortId::Serial(number),
        };
        assert_eq!(case.wires, [[port(0, 1), port(1, 2)]]);
        let of: Vec<_> = step.set.iter().map(|s| (s.plc, s.value.clone())).collect();
        assert_eq!(of, [(1, Value::Int(2)), (0, Value::Int(1))]);
        assert_eq!(step.running, [(1, false)]);
        let sent = [&b"AB"[..], b""].map(|bytes| Sent {
            bytes: bytes.to_vec(),
            closed: false,
        });
        assert_eq!(step.expect_tx, [(port(1, 2), sent.to_vec())]);
        assert_eq!(step.cut, Some(vec![port(1, 2)]));
    }

    #[test]
    fn a_program_stands_in_the_file_or_in_its_own() {
        let text = r#"topic = "t"
[[case]]
name = "none"
rejects = { code = 0 }
[[case]]
name = "no model"
program = "END"
rejects = { code = 0 }
[[case]]
name = "not there"
program = { file = "nowhere.il" }
rejects = { code = 0 }
"#;
        let absent = std::io::Error::from_raw_os_error(2).to_string();
        insta::assert_snapshot!(problems_of(text).replace(&absent, "ABSENT"), @r"
        t.plctest.toml:2:1: neither the case nor the file has a `program`, nor does a rungc.toml above it name one
        t.plctest.toml:5:1: `model` is missing, the PLC that the program is for
        t.plctest.toml:11:11: cannot read `nowhere.il`: ABSENT
        ");
        let of = |program: &str| {
            problems_of(&format!(
                "model = \"h2u\"\ntopic = \"t\"\n[[case]]\nname = \"a\"\nprogram = {program}\n"
            ))
        };
        insta::assert_snapshot!(of("3"), @r#"t.plctest.toml:5:11: invalid type: integer `3`, expected an instruction list, or the path of a program: "machine.gxw""#);
        insta::assert_snapshot!(of("{ path = 'x.il' }"), @"t.plctest.toml:5:13: there is no key `path`; valid names: file");
        insta::assert_snapshot!(of("{}"), @"t.plctest.toml:5:11: missing key `file`");
    }

    #[test]
    fn mistakes_about_time_rows_and_scenarios_are_reported_with_their_place() {
        let text = r#"model = "h2u"
topic = "t"
program = "END"
never = [{}]
[[scenario]]
name = "start"
step = [{ do = "stop" }]
[[scenario]]
name = "stop"
step = []
[[scenario]]
name = "stop"
step = [{ set = { X000 = 1 } }]
[[case]]
name = "a"
rows = [{ x = 1 }, { x = 2, name = "b" }, { name = "b", x = "k" }]
trace = ["D0.str", "Q1"]
[[case.step]]
do = "start"
set = { D0 = "$y", D1 = { value = 5, tolerance = 1 } }
expect = { M0 = { value = 1, tolerance = 1 }, D0 = { value = 1.5, tolerance = 1 } }
run_ms = "$x"
[[case.step]]
do = "strat"
until = { Y000 = 1 }
[[case.step]]
at_most_ms = 5
scans = 2
whenever = [{ when = { X000 = 1 }, then = {} }]
within = [{ ms = 5, expect = {} }]
"#;
        insta::assert_snapshot!(problems_of(text), @r#"
        t.plctest.toml:4:10: name at least one device here
        t.plctest.toml:7:16: no scenario `stop` is defined before this
        t.plctest.toml:9:8: the scenario `stop` has no steps
        t.plctest.toml:12:8: the scenario `stop` is defined twice in this file
        t.plctest.toml:15:8: the case `a[b]` is defined twice in this file
        t.plctest.toml:17:10: a text cannot be traced; name its words
        t.plctest.toml:17:20: `Q1` is not a device name; examples: `M0`, `X010`, `D0.i32`
        t.plctest.toml:20:14: the row has no `y`
        t.plctest.toml:20:25: `tolerance` belongs to an expected value
        t.plctest.toml:21:17: the value of `M0` must be exact: `tolerance` is for numbers
        t.plctest.toml:21:52: the value of `D0` must be a 16-bit integer, or hexadecimal in quotes: "0xFFFF"
        t.plctest.toml:22:10: this value must be a whole number from 0 to 4294967295
        t.plctest.toml:24:6: no scenario `strat` is defined before this: did you mean `start`?
        t.plctest.toml:25:11: `until` needs `at_most_ms`, the time after which the step fails
        t.plctest.toml:27:14: use one of `scans`, `run_ms` and `at_most_ms` in a step
        t.plctest.toml:27:14: `at_most_ms` needs `until`, what the step waits for
        t.plctest.toml:29:13: name at least one device here
        t.plctest.toml:30:11: name at least one device here
        "#);
    }

    #[test]
    fn devices_that_each_scan_sets_cannot_be_set() {
        let text = r#"model = "fx3u"
topic = "t"
[[case]]
name = "a"
program = "END"
init = { M8011 = 1, D8000 = 300 }
[[case.step]]
set = { "K4M8000" = 0, X000 = 1, D8010 = 5 }
expect = { M8000 = 1, D8010 = 100 }
"#;
        insta::assert_snapshot!(problems_of(text), @r"
        t.plctest.toml:6:10: `M8011` cannot be set: each scan sets it (clock of 10 ms)
        t.plctest.toml:8:9: `M8000` cannot be set: each scan sets it (on while the program runs)
        t.plctest.toml:8:34: `D8010` cannot be set: each scan sets it (time of the scan in 0.1 ms)
        ");
    }

    #[test]
    fn unknown_keys_are_mistakes() {
        let text = "model = \"h2u\"\ntopic = \"t\"\n[[case]]\nname = \"a\"\nprogram = \"END\"\n[[case.step]]\nscan = 1\n";
        insta::assert_snapshot!(problems_of(text), @"t.plctest.toml:7:1: there is no key `scan`; did you mean `scans`?");
    }
    #[test]
    fn headings_and_dates_are_written_as_toml_asks() {
        let text = "model = \"h2u\"\ntopic = \"t\"\n[[case.step]]\nscans = 1\n";
        insta::assert_snapshot!(problems_of(text), @"t.plctest.toml:3:3: `[[case.step]]` needs `[[case]]` above it");
        let text = "model = \"h2u\"\ntopic = \"t\"\n[[case]]\nname = \"a\"\nprogram = \"END\"\n[[case.step]]\nclock = 2026-01-02T03:04:05\n";
        insta::assert_snapshot!(problems_of(text), @"t.plctest.toml:7:9: write a date or a time in quotes");
    }

    /// A value of a row that the case does not use would be a check that is not made.
    #[test]
    fn values_that_check_nothing_are_mistakes() {
        let text = r#"model = "fx3u"
topic = "t"
program = "END"
[[case]]
name = " "
[[case.step]]
expect = { D0 = { value = 5, tolerance = 1 } }
[[case]]
name = "a"
rows = [{ x = 1, Y000 = 1, name = "b" }, { x = 2, Y000 = 0, z = 1 }]
[[case.step]]
set = { D0 = "$x" }
"#;
        insta::assert_snapshot!(problems_of(text), @r#"
        t.plctest.toml:5:8: a case has a name
        t.plctest.toml:10:18: no value of this case is `"$Y000"`, which its rows give
        t.plctest.toml:10:61: no value of this case is `"$z"`, which its rows give
        "#);
        for tolerance in ["-1", "nan"] {
            let text = text.replace("tolerance = 1", &format!("tolerance = {tolerance}"));
            assert!(problems_of(&text).contains("`tolerance` is 0 or more"));
        }
    }
}
