//! Emitted C that runs 64 instances at once does in each of them what the C of one instance does, bit for bit.

use rungc_codegen_c::{Members, Options, emit, lanes};
use rungc_golden::operands::candidates;
use rungc_golden::random::program;
use rungc_golden::rng::Rng;
use rungc_golden::stations;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_syntax::DeviceClass::{D, M, X};
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// Runs one program in lanes and alone, with random inputs, relays and registers, and compares their structs.
const MAIN: &str = r#"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "NAME_lanes.h"

static NAME_plc one[PLC_LANES];
static NAME_lanes all;
static uint32_t state = 1;

static uint32_t next(void)
{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

int main(void)
{
    NAME_lanes_init(&all);
    for (unsigned l = 0; l < PLC_LANES; l++) {
        NAME_init(&one[l]);
        NAME_plc *const plc = &one[l];
PRESETS
        NAME_lanes_load(&all, l, plc);
    }
    uint32_t now = 0;
    for (int scan = 0; scan < 300; scan++) {
        now += next() % 40u;
        for (unsigned l = 0; l < PLC_LANES; l++) {
            NAME_plc *const plc = &one[l];
            bool on;
            (void)on;
            (void)plc;
INPUTS
            NAME_scan(&one[l], now, 0);
        }
        NAME_lanes_scan(&all, now, 0);
        for (unsigned l = 0; l < PLC_LANES; l++) {
            static NAME_plc stored;
            NAME_lanes_store(&all, l, &stored);
            const unsigned char *const a = (const unsigned char *)&stored, *const b = (const unsigned char *)&one[l];
            for (size_t i = 0; i < sizeof stored; i++) {
                if (a[i] != b[i]) {
                    printf("scan %d, instance %u: byte %zu is %u in lanes, %u alone\n", scan, l, i, a[i], b[i]);
OFFSETS
                    return 1;
                }
            }
            if (((unsigned)scan + l) % 50u == 0u) {
                NAME_lanes_load(&all, l, &stored);
            }
        }
    }
    return 0;
}
"#;

fn compiled(list: &str, model: ModelId, name: &str, optimise: bool) -> Option<Module> {
    let read = rungc_frontend::read_text("lanes.il", list);
    let options = CompileOptions {
        model: Some(model),
        name: Some(name.to_string()),
        optimise,
        ..CompileOptions::default()
    };
    let module = compile(&read.program, &options).module;
    module.filter(|module| lanes::refusal(module).is_none())
}

/// The test's `main.c` for a program.
fn main_file(module: &Module) -> String {
    let members = Members::new(module);
    let (mut presets, mut inputs, mut offsets) = (String::new(), String::new(), String::new());
    let mut found = Vec::new();
    for (class, last) in [(X, 0o377), (M, 499), (D, 499)] {
        found.extend(
            (0..=last).filter_map(|number| Some((class, number, members.of(class, number)?))),
        );
    }
    for (class, number, member) in found {
        // Writing to a String does not fail.
        let _ = match class {
            X => writeln!(
                inputs,
                "            if (next() % 4u == 0u) {{\n                on = next() % 2u != 0u;\n                plc->{member} = on;\n                \
                 plc_put_lane(&all.{member}, l, on);\n            }}"
            ),
            M => writeln!(presets, "        plc->{member} = next() % 2u != 0u;"),
            _ => writeln!(presets, "        plc->{member} = (int16_t)(next() % 50u);"),
        };
        let _ = writeln!(
            offsets,
            "                    if (i + 1u > offsetof({}_plc, {member})) {{ puts(\"  after {}{number}\"); }}",
            module.name,
            class.prefix()
        );
    }
    MAIN.replace("NAME", &module.name)
        .replace("PRESETS\n", &presets)
        .replace("INPUTS\n", &inputs)
        .replace("OFFSETS\n", &offsets)
}

/// Compiles and runs it; what went wrong.
fn differs(module: &Module, folder: &Path) -> Option<String> {
    let folder = folder.join(&module.name);
    let options = Options {
        lanes: true,
        ..Options::default()
    };
    let mut command = Command::new("cc");
    command.args([
        "-std=c99",
        "-O1",
        "-Wall",
        "-Wextra",
        "-Wconversion",
        "-Werror",
        "-o",
        "lanes",
    ]);
    std::fs::create_dir_all(&folder).expect("a folder for the program");
    for file in emit(module, &options) {
        std::fs::write(folder.join(&file.path), &file.contents).expect("a file of the program");
        if file.path.ends_with(".c") {
            command.arg(&file.path);
        }
    }
    std::fs::write(folder.join("main.c"), main_file(module)).expect("the test's main.c");
    let built = command
        .arg("main.c")
        .current_dir(&folder)
        .output()
        .expect("a C compiler");
    if !built.status.success() {
        return Some(String::from_utf8_lossy(&built.stderr).into_owned());
    }
    let ran = Command::new(folder.join("lanes"))
        .output()
        .expect("the program");
    (!ran.status.success())
        .then(|| format!("{}\n{}", ran.status, String::from_utf8_lossy(&ran.stdout)))
}

/// Timers that wait for one of them to start, stop or time out, and some that cannot, because their value is read or
/// something else changes them.
const TIMERS: &str = "\
LD X000
OUT T0 K3
LD X001
AND T0
OUT T200 K17
LD T200
OUT Y000
LD X002
OUT T256 K55
LDI T256
OUT Y001
LD X003
OUT T1 K5
LD M8000
MOV T1 D0
LD X004
OUT T2 K4
LD X005
RST T2
LD X006
MC N0 M10
LD X007
OUT T3 K2
MCR N0
LD X010
OUT T4 D1
LD X011
OUT T5 K0
LD T5
OUT Y002
LD X012
INC D1
END
";

#[test]
fn timers_wait_until_something_happens() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("lanes");
    let module = compiled(TIMERS, ModelId::Fx3u, "timers", true).expect("it runs in lanes");
    let options = Options {
        lanes: true,
        ..Options::default()
    };
    let files = emit(&module, &options);
    let source = files.iter().find(|file| file.path == "timers.c");
    let source = &source.expect("the source").contents;
    let waits = |number: u32| source.contains(&format!("T{number}_left = UINT32_MAX"));
    let all = [0, 1, 2, 3, 4, 5, 200, 256];
    let found: Vec<u32> = all.into_iter().filter(|&number| waits(number)).collect();
    assert_eq!(found, [0, 3, 5, 200, 256], "{source}");
    assert_eq!(differs(&module, &folder), None);
}

#[test]
fn random_programs_do_the_same_in_lanes() {
    let count = std::env::var("RUNGC_RANDOM_LANES")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(12);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("lanes");
    // Programs of any instruction would nearly all call the runtime, which lanes reject.
    let mut rng = Rng::new(7);
    let mut pool = candidates(ModelId::Fx3u);
    pool.retain(|candidate| {
        (0..2).all(|_| {
            let drawn = candidate.draw(&mut rng, ModelId::Fx3u);
            drawn.is_some_and(|inst| {
                compiled(&format!("LD M0\n{inst}\nEND\n"), ModelId::Fx3u, "one", true).is_some()
            })
        })
    });
    assert!(pool.len() > 40, "{} instructions", pool.len());
    let (mut done, mut seed) = (0, 0);
    while done < count {
        seed += 1;
        let list = match seed % 6 {
            0 => stations::program(seed),
            _ => program(seed, ModelId::Fx3u, &pool, 2 + (seed % 8) as u32),
        };
        let name = format!("random{seed}");
        let Some(module) = compiled(&list, ModelId::Fx3u, &name, seed % 3 != 0) else {
            continue;
        };
        done += 1;
        if let Some(problem) = differs(&module, &folder) {
            panic!("seed {seed}: {problem}\n{list}");
        }
    }
}
