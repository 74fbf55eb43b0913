//! Bytes and instructions on a microcontroller do not get worse than `figures.toml` says. They do not depend on the
//! machine, and on the compiler only as far as it does not treat code written by hand likewise. Without the tools a
//! test reports what is missing and that it did not run; with `RUNGC_REQUIRE_EMBEDDED` set, as in CI, that is a
//! failure.

use rungc_benches::embedded;
use rungc_benches::figures::{self, Figures, Program, Record, STEPS};
use rungc_benches::ladder::{Kind, Ladder};
use rungc_benches::problem::{Problem, Result};
use std::fmt::Write;
use std::path::Path;

/// Tolerance of a figure, relative to the recorded one.
const TOLERANCE: f64 = 1.02;

/// RAM that a program may need in addition to its devices (those of Cortex-M4 have 32 bits).
const RAM_BESIDES_DEVICES: u64 = 256;

/// RAM in which a PID instruction keeps what it must know of its last execution.
const PRIVATE_RAM: u64 = 32;

/// Flash that the image of a blinking lamp may take.
const BLINK_FLASH: u64 = 4096;

/// Names of the figures of a [`Record`].
const NAMES: [&str; 3] = ["bytes of flash", "bytes of RAM", "instructions"];

/// Command that records new figures.
const RECORD: &str = "`cargo xtask generate figures`";

fn values(record: &Record) -> [u64; 3] {
    [record.flash, record.ram, record.instructions]
}

/// Result of a measurement; `None`, and a message, where tools are missing and may be.
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

/// Adds a line for each figure that is worse than recorded, or enough better to be recorded.
fn compare(worse: &mut String, name: &str, now: &Program, recorded: &Program) {
    let (now_hand, hand) = (values(&now.hand), values(&recorded.hand));
    let (now_c, c) = (values(&now.c), values(&recorded.c));
    for (i, what) in NAMES.iter().enumerate() {
        // Another compiler treats both alike.
        let expected = c[i] as f64 * now_hand[i] as f64 / hand[i].max(1) as f64;
        let is = now_c[i];
        if is as f64 > expected * TOLERANCE {
            let _ = writeln!(worse, "{name}: {is} {what}, recorded {expected:.0}");
        } else if (is as f64) * TOLERANCE < expected {
            eprintln!("{name}: {is} {what}, better than {expected:.0}: {RECORD} records that");
        }
    }
}

#[test]
fn emitted_c_gets_no_worse() {
    let Some(measured) = unless_missing(figures::measure()) else {
        return;
    };
    for kind in Kind::ALL {
        let program = &measured[kind.name()];
        let ladder = Ladder::new(kind, STEPS);
        let private = PRIVATE_RAM * ladder.list().matches("\nPID ").count() as u64;
        let ram = u64::from(ladder.device_bytes()) + private + RAM_BESIDES_DEVICES;
        // An index whose bounds are not known leads to all registers, which are stored then.
        let indexed = matches!(kind, Kind::Index | Kind::Recipe);
        assert!(
            indexed || program.c.ram <= ram,
            "{}: {program:?}",
            kind.name()
        );
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("figures.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let recorded: Figures = toml::from_str(&text).unwrap();
    let mut worse = String::new();
    for (name, program) in &measured {
        match recorded.get(name) {
            Some(recorded) => compare(&mut worse, name, program, recorded),
            None => worse.push_str(&format!("{name}: not recorded\n")),
        }
    }
    assert!(
        worse.is_empty(),
        "emitted C got worse:\n{worse}If it is worth that, {RECORD} records it"
    );
}

#[test]
fn a_blinking_lamp_is_small() {
    if let Some((flash, ram)) = unless_missing(embedded::blink()) {
        assert!(flash < BLINK_FLASH, "{flash} bytes of flash, {ram} of RAM");
    }
}
