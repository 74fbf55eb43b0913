//! Emitted crates, built by cargo and run.

use crate::common;
use crate::common::{cargo, write};
use rungc_codegen_rust::{Options, batch, emit};
use rungc_ir::Module;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

#[test]
fn a_program_builds_without_warnings() {
    for module in [common::motor(), long()] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), &emit(&module, &common::options()));
        cargo(folder.path(), &["clippy"]);
        cargo(folder.path(), &["build"]);
    }
}

/// A program of several files, with functions and timers that some of them share.
fn long() -> Module {
    let mut list = String::new();
    for n in 0..600_u32 {
        let bits = n.wrapping_mul(2_654_435_761) >> 20;
        let _ = writeln!(list, "LD M{}", bits % 500);
        for at in 0..3 {
            let word = ["AND", "ANI", "OR", "ORI"][(bits >> (2 * at)) as usize % 4];
            let _ = writeln!(list, "{word} M{}", (bits + 37 * at) % 500);
        }
        let _ = match n % 50 {
            10 => writeln!(list, "OUT T{} K{}", n / 50, 1 + bits % 90),
            20 => writeln!(list, "CALL P{}", n / 300),
            _ => writeln!(list, "OUT M{}", 500 + n),
        };
    }
    list.push_str("FEND\nP0\nLD X000\nOUT Y000\nSRET\nP1\nLDP X001\nINC D0\nSRET\nEND\n");
    let module = common::compiled("long", &list);
    let files = emit(&module, &Options::default());
    let parts = files.iter().filter(|file| file.path.contains("/part"));
    assert!(parts.count() > 2);
    module
}

/// Program that uses a crate whose instructions fail: first at an index, then at a division, and at last the watchdog
/// stops a scan.
const ERRORS: &str = r#"
use errors::Errors;
use rungc_rt::{Class, LastError, Plc, Program, Stop, VirtualHal};

fn main() {
    let (mut plc, mut hal) = (Errors::new(), VirtualHal::new());
    let mut scan = |inputs: [bool; 3]| {
        for (number, on) in (0..).zip(inputs) {
            plc.set_bit(Class::X, number, on).unwrap();
        }
        plc.scan(&mut hal, 0, 0);
        plc.last_error()
    };
    assert_eq!(scan([false; 3]), LastError::NONE);
    let index = LastError { code: 6706, step: 6, ..LastError::NONE };
    assert_eq!(scan([true, false, false]), index);
    assert_eq!(scan([false; 3]), index, "it stays until another one comes");
    let division = LastError { code: 6706, step: 12, ..LastError::NONE };
    assert_eq!(scan([true, true, false]), division);
    let stopped = LastError { stop: Stop::Watchdog, stop_step: 21, ..division };
    assert_eq!(scan([false, false, true]), stopped);
    plc.set_running(true);
    assert_eq!(plc.last_error(), LastError::NONE, "RUN begins anew");
}
"#;

#[test]
fn a_program_keeps_its_last_error() {
    let folder = tempfile::tempdir().unwrap();
    let list = "LD X0\nMOV K30000 Z0\nMOV K1 D500Z0\nLD X1\nDIV D0 D1 D2\nP0\nLD X2\nCJ P0\nEND\n";
    write(
        folder.path(),
        &emit(&common::compiled("errors", list), &common::options()),
    );
    let example = folder.path().join("examples");
    std::fs::create_dir(&example).unwrap();
    std::fs::write(example.join("errors.rs"), ERRORS).unwrap();
    cargo(folder.path(), &["run", "--example", "errors"]);
    let target = cargo(folder.path(), &["build"]);
    let mut host = Command::new(target.path().join("debug/errors"))
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    host.stdin
        .take()
        .unwrap()
        .write_all(b"X0=1\nX1=1\n")
        .unwrap();
    let errors = BufReader::new(host.stderr.take().unwrap());
    let reported: Vec<String> = errors.lines().take(2).map(Result::unwrap).collect();
    host.kill().unwrap();
    host.wait().unwrap();
    let reported: Vec<&str> = reported
        .iter()
        .map(|line| line.split_once(", ").unwrap().1)
        .collect();
    // Both of one scan, or of two where the lines came apart.
    let expected = [
        "step 6: MOV K1 D500Z0: error 6706, D30500 does not exist",
        "step 12: DIV D0 D1 D2: error 6706, a device does not exist, or a value has no result",
    ];
    assert_eq!(reported, expected);
}

#[test]
fn a_batch_answers_requests() {
    let folder = tempfile::tempdir().unwrap();
    let endless = common::compiled("endless", "P0\nLD X0\nCJ P0\nLD X1\nOUT Y0\nEND\n");
    write(
        folder.path(),
        &batch(&[common::motor(), common::motor(), endless]),
    );
    let target = cargo(folder.path(), &["build"]);
    let mut child = Command::new(target.path().join("debug/batch"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let requests = [
        ("case 0", "ok"),
        ("bit X 0 1", "ok"),
        ("scan 0 0", "ok"),
        ("bit X 0 0", "ok"),
        ("scan 10 150", "ok"),
        ("getbit M 0", "1"),
        ("out 0", "0"),
        ("scan 2990 150", "ok"),
        ("getword T 0", "29"),
        ("scan 3000 150", "ok"),
        ("scan 3010 150", "ok"),
        ("getword T 0", "30"),
        ("out 0", "1"),
        ("word D 0 9", "ok"),
        ("bit X 2 1", "ok"),
        ("scan 3020 150", "ok"),
        ("scan 3030 150", "ok"),
        ("getword D 0", "10"),
        ("out 1", "1"),
        ("run 0", "ok"),
        ("out 1", "0"),
        ("getword D 0", "0"),
        ("word D 9000 1", "none"),
        ("case 1", "ok"),
        ("getbit M 0", "0"),
        ("case 2", "ok"),
        ("bit X 1 1", "ok"),
        ("scan 0 0", "ok"),
        ("out 0", "1"),
        ("bit X 0 1", "ok"),
        ("scan 10 0", "ok"),
        ("out 0", "0"),
        ("case 3", "none"),
    ];
    let input: Vec<&str> = requests.iter().map(|(request, _)| *request).collect();
    let mut stdin = child.stdin.take().unwrap();
    writeln!(stdin, "{}\nexit", input.join("\n")).unwrap();
    let output = child.wait_with_output().unwrap();
    let answers = String::from_utf8(output.stdout).unwrap();
    let expected: Vec<&str> = requests.iter().map(|(_, answer)| *answer).collect();
    let answers: Vec<&str> = answers.lines().collect();
    assert_eq!(answers, expected);
}
