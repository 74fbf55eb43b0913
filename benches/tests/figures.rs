//! Bytes and instructions on a microcontroller do not get worse than `figures.toml` says. They do not depend on the machine, and on the
//! compiler only as far as it does not treat code written by hand likewise. Without the tools a test says what is missing and that it did
//! not run; with `RUNGC_REQUIRE_EMBEDDED` set, as in CI, that is a failure.

use rungc_benches::embedded::{self, Figures, Level, Measured};
use rungc_benches::ladder::{Kind, Ladder};
use rungc_benches::problem::{Problem, Result};
use rungc_benches::subject::Code;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Length of the programs.
const STEPS: u32 = 1000;

/// How much worse than recorded a figure may be.
const TOLERANCE: f64 = 1.02;

/// RAM that a program may need besides its devices (those of Cortex-M4 have 32 bits).
const RAM_BESIDES_DEVICES: u64 = 256;

/// Flash that the image of a blinking lamp may take.
const BLINK_FLASH: u64 = 4096;

/// What one implementation takes.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Record {
    flash: u64,
    ram: u64,
    instructions: u64,
}

/// What the implementations of one program take.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Program {
    hand: Record,
    c: Record,
}

/// Names of the figures of a [`Record`].
const FIGURES: [&str; 3] = ["bytes of flash", "bytes of RAM", "instructions"];

impl Record {
    fn figures(&self) -> [u64; 3] {
        [self.flash, self.ram, self.instructions]
    }

    fn of(figures: &Figures) -> Self {
        Record {
            flash: figures.flash,
            ram: figures.ram,
            instructions: figures.instructions.unwrap_or_default().round() as u64,
        }
    }
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("figures.toml")
}

/// What can be measured here; nothing, and a message, where tools are missing and may be.
fn unless_missing<T>(result: Result<T>) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(problem @ Problem::Missing(_)) => {
            let required = std::env::var_os("RUNGC_REQUIRE_EMBEDDED").is_some();
            assert!(!required, "{problem}");
            eprintln!("not run: {problem}");
            None
        }
        Err(problem) => panic!("{problem}"),
    }
}

fn measure(ladder: &Ladder) -> Result<Program> {
    let codes = [Code::Hand, Code::C];
    let all = embedded::measure(ladder, &codes, Level::Size, true)?;
    let mut records = Vec::new();
    for Measured { figures, .. } in all {
        records.push(Record::of(&figures?));
    }
    Ok(Program {
        hand: records[0],
        c: records[1],
    })
}

/// Adds a line for each figure that is worse than recorded, or enough better to be recorded.
fn compare(worse: &mut String, name: &str, now: &Program, recorded: &Program) {
    let (now_hand, hand) = (now.hand.figures(), recorded.hand.figures());
    let (now_c, c) = (now.c.figures(), recorded.c.figures());
    for (i, what) in FIGURES.iter().enumerate() {
        // Another compiler treats both alike.
        let expected = c[i] as f64 * now_hand[i] as f64 / hand[i].max(1) as f64;
        let is = now_c[i];
        if is as f64 > expected * TOLERANCE {
            let _ = writeln!(worse, "{name}: {is} {what}, recorded {expected:.0}");
        } else if (is as f64) * TOLERANCE < expected {
            eprintln!(
                "{name}: {is} {what}, better than {expected:.0}: UPDATE_FIGURES=1 records that"
            );
        }
    }
}

#[test]
fn emitted_c_gets_no_worse() {
    let mut measured = BTreeMap::new();
    for kind in Kind::ALL {
        let ladder = Ladder::new(kind, STEPS);
        let Some(program) = unless_missing(measure(&ladder)) else {
            return;
        };
        let ram = u64::from(ladder.device_bytes()) + RAM_BESIDES_DEVICES;
        assert!(program.c.ram <= ram, "{}: {program:?}", kind.name());
        measured.insert(kind.name().to_string(), program);
    }
    if std::env::var_os("UPDATE_FIGURES").is_some() {
        let text = toml::to_string(&measured).unwrap();
        let head = "# Cortex-M4, -Os, programs of 1000 steps. Remade by UPDATE_FIGURES=1 cargo test -p rungc-benches --test figures\n\n";
        std::fs::write(path(), format!("{head}{text}")).unwrap();
    }
    let text = std::fs::read_to_string(path()).unwrap();
    let recorded: BTreeMap<String, Program> = toml::from_str(&text).unwrap();
    let mut worse = String::new();
    for (name, program) in &measured {
        match recorded.get(name) {
            Some(recorded) => compare(&mut worse, name, program, recorded),
            None => worse.push_str(&format!("{name}: not recorded\n")),
        }
    }
    assert!(
        worse.is_empty(),
        "emitted C got worse:\n{worse}If it is worth that, UPDATE_FIGURES=1 cargo test -p rungc-benches --test figures"
    );
}

#[test]
fn a_blinking_lamp_is_small() {
    if let Some((flash, ram)) = unless_missing(embedded::blink()) {
        assert!(flash < BLINK_FLASH, "{flash} bytes of flash, {ram} of RAM");
    }
}
