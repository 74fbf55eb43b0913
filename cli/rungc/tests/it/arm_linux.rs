//! Executables for Linux on 32-bit Arm, under QEMU's user emulation.

use crate::common::{HANG, MOTOR, folder, rungc, soon, text};
use crate::firmware::quiet;
use crate::tools::{cargo, leave_out, no_rust, tools, with_cargo, with_library};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc;

const LINUX: &str = "armv7-unknown-linux-gnueabihf";

/// The first line that a program prints whose input is switched on, under QEMU.
fn first_line(program: &Path, input: &str) -> String {
    let mut running = Command::new("qemu-arm")
        .args(["-L", "/usr/arm-linux-gnueabihf"])
        .arg(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let output = running.stdout.take().unwrap();
    let mut stdin = running.stdin.take().unwrap();
    writeln!(stdin, "{input}").unwrap();
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        let mut line = String::new();
        let read = BufReader::new(output).read_line(&mut line);
        sender.send(read.map(|_| line)).unwrap_or_default();
    });
    let line = receiver.recv_timeout(HANG);
    running.kill().unwrap();
    running.wait().unwrap();
    line.expect("a line within a minute").unwrap()
}

/// An executable for Linux on 32-bit Arm scans there, with the runtime and without.
#[test]
fn executables_run_on_arm_linux() {
    if !tools(&["make", "arm-linux-gnueabihf-gcc", "qemu-arm"]) {
        return;
    }
    let Some(cargo) = cargo(LINUX).map(with_library) else {
        return leave_out(&no_rust(LINUX));
    };
    let floats =
        "LD X000\nOUT T0 K3\nLD T0\nDESQR K4 D0\nDEMOV D0 D2\nLD T0\nANDD> D2 K0\nOUT Y000\nEND\n";
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("floats.il", floats.as_bytes()),
    ]);
    for program in ["motor", "floats"] {
        let file = format!("{program}.il");
        let args = [
            "build", &file, "--emit", "bin", "--io", "--target", LINUX, "-o", program,
        ];
        let output = with_cargo(&cargo)
            .args(args)
            .current_dir(folder.path())
            .output();
        quiet(&output.unwrap());
        let line = first_line(&folder.path().join(program), "X0=1");
        assert!(line.contains("Y000 on"), "{line}");
    }
}

/// Files are the terminals of a program under QEMU: its timer switches a lamp on.
fn switches_a_lamp(program: &Path, folder: &Path) {
    let io = "[io.panel]\nfiles = '.'\nX000 = 'read switch'\nY000 = 'write lamp'\n";
    std::fs::write(folder.join("io.toml"), io).unwrap();
    std::fs::write(folder.join("switch"), "1").unwrap();
    let mut running = Command::new("qemu-arm")
        .args(["-L", "/usr/arm-linux-gnueabihf"])
        .arg(program)
        .args(["--io", "io.toml"])
        .current_dir(folder)
        .stdin(Stdio::null())
        .spawn()
        .unwrap();
    let lamp = || std::fs::read_to_string(folder.join("lamp")).unwrap_or_default();
    soon("the lamp is on", || lamp().trim() == "1");
    running.kill().unwrap();
    running.wait().unwrap();
    assert_eq!(lamp().trim(), "1");
}

/// The same in Rust, with connections. A distribution's cargo builds the standard library from its sources.
#[test]
fn rust_runs_on_arm_linux() {
    if !tools(&["arm-linux-gnueabihf-gcc", "qemu-arm"]) {
        return;
    }
    let Some(cargo) = cargo(LINUX) else {
        return leave_out(&no_rust(LINUX));
    };
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let args = [
        "build", "motor.il", "--emit", "rust", "--main", "--io", "--target", LINUX, "-o", "motor",
    ];
    quiet(&rungc(folder.path(), &args));
    let output = with_library(cargo)
        .args(["build", "--quiet"])
        .env(
            "CARGO_TARGET_ARMV7_UNKNOWN_LINUX_GNUEABIHF_LINKER",
            "arm-linux-gnueabihf-gcc",
        )
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .current_dir(folder.path().join("motor"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    let program = folder
        .path()
        .join("motor/target")
        .join(LINUX)
        .join("debug/motor");
    switches_a_lamp(&program, folder.path());
}
