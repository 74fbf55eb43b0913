//! Emitted crates, built by cargo and run.

mod common;

use common::{cargo, runtime_path, write};
use rungc_codegen_rust::{Options, Runtime, batch, emit};
use std::io::Write;
use std::process::{Command, Stdio};

#[test]
fn a_program_builds_without_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let options = Options {
        main: true,
        runtime: Runtime::At(runtime_path()),
    };
    write(folder.path(), &emit(&common::motor(), &options));
    cargo(folder.path(), &["clippy"]);
    cargo(folder.path(), &["build"]);
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
    let mut child = Command::new(target.join("debug/batch"))
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
