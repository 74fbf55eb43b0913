//! Main programs for Windows: mingw compiles those in C, and wine runs them; cargo checks those in Rust.

use crate::common::{cargo, folder, rungc, text};
use crate::tools::{no_rust, tools};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Longest wait for what the server of wine does after a process has ended.
const PATIENCE: Duration = Duration::from_secs(60);

const COMPILER: &str = "x86_64-w64-mingw32-gcc";

const RUST_TARGET: &str = "x86_64-pc-windows-gnu";

/// Y000 follows X000; D512 is latched and counts how often X000 turns on.
const KEEP: &str = "\
LD X000
OUT Y000
LDP X000
INC D512
LD= D512 K2
OUT Y001
END
";

/// COM1 is a Modbus slave, and the clock is read.
const SLAVE: &str = "\
LD M8002
MOV H2 D8126
MOV H81 D8120
MOV K1 D8121
LD M8000
MOV D8013 D0
END
";

/// Emits a main program, and makes this of it for Windows.
fn made(folder: &Path, emit: &[&str], make: &[&str]) {
    let args = [&["build", "--emit", "c", "--main", "-o", "out"], emit].concat();
    let emitted = rungc(folder, &args);
    assert!(emitted.status.success(), "{}", text(&emitted.stderr));
    let made = Command::new("make")
        .args([&format!("CC={COMPILER}"), "LDFLAGS=-static"])
        .arg("CFLAGS=-std=c99 -O1 -Wall -Wextra -Wconversion -pedantic -Werror")
        .args(make)
        .current_dir(folder.join("out"))
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", text(&made.stderr));
}

/// Returns true if Rust for Windows is installed.
fn has_rust() -> bool {
    let library = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", RUST_TARGET])
        .output()
        .unwrap();
    let is_there = Path::new(text(&library.stdout).trim()).is_dir();
    if !is_there {
        eprintln!("not run: there is no {}", no_rust(RUST_TARGET));
    }
    is_there
}

#[test]
fn main_programs_in_c_compile_for_windows() {
    if !tools(&[COMPILER, "make"]) {
        return;
    }
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    let emit = ["slave.il", "--model", "h2u", "--servers", "--io"];
    let target = format!("TARGET={RUST_TARGET}");
    let make: &[&str] = match has_rust() {
        true => &["slave", &target, "RUNTIME_OPT=0"],
        false => &["main.o", "slave.o"],
    };
    made(folder.path(), &emit, make);
}

/// Runs the program that keeps D512, and types each line once the program has printed the text of the one before.
fn run(folder: &Path, dialogue: &[(&str, &str)]) {
    let mut program = Command::new("wine")
        .args(["out/keep.exe", "--retain", "latched"])
        .env("WINEPREFIX", folder.join("wine"))
        .env("WINEDEBUG", "-all")
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        // The server of wine would keep it open for some seconds more.
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut input = program.stdin.take().unwrap();
    let mut lines = BufReader::new(program.stdout.take().unwrap()).lines();
    for (typed, printed) in dialogue {
        input.write_all(format!("{typed}\r\n").as_bytes()).unwrap();
        assert!(
            lines.any(|line| line.unwrap().contains(printed)),
            "{printed}"
        );
    }
    input.write_all(b"quit\r\n").unwrap();
    assert_eq!(program.wait().unwrap().code(), Some(0));
}

#[test]
fn a_main_program_in_c_runs_on_windows_and_keeps_devices() {
    if !tools(&[COMPILER, "make", "wine"]) {
        return;
    }
    let folder = folder(&[("keep.il", KEEP.as_bytes())]);
    let folder = folder.path();
    made(folder, &["keep.il"], &["keep"]);
    let [on, off] = [("X0=1", "Y000 on"), ("X0=0", "Y000 off")];
    run(folder, &[on, off, ("X0=1", "Y001 on")]);
    let latched = || std::fs::read(folder.join("latched")).unwrap();
    let twice = latched();
    run(folder, &[("X9=1", "Y001 on"), ("X0=1", "Y001 off")]);
    assert_ne!(latched(), twice);
    assert!(!folder.join("latched.new").exists());
    // The server of wine removes it once it learns that the process has ended.
    let started = Instant::now();
    while folder.join("latched.lock").exists() {
        assert!(started.elapsed() < PATIENCE, "latched.lock stays");
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn main_programs_in_rust_compile_for_windows() {
    if !has_rust() {
        return;
    }
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    let args = ["build", "slave.il", "--model", "h2u", "--servers", "--io"];
    cargo(
        folder.path(),
        &args,
        "slave",
        &["check", "--target", RUST_TARGET],
    );
}
