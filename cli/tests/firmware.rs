//! Libraries and images for another machine: what is built runs under QEMU, and what is missing is said.

mod common;
mod tools;

use common::{MOTOR, code, folder, rungc, shown, text};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tools::{cargo, leave_out, no_rust, tools};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn traffic_light() -> String {
    let path = repository().join("golden/examples/traffic_light.il");
    path.display().to_string()
}

fn board(file: &str) -> String {
    repository()
        .join("examples")
        .join(file)
        .display()
        .to_string()
}

/// What an image prints on a machine of QEMU's. It prints some kinds of semihosting to standard output, others to standard error.
fn simulated(machine: &str, image: &Path) -> String {
    let output = Command::new("qemu-system-arm")
        .args(["-M", machine, "-nographic", "-icount", "shift=0,sleep=off"])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(image)
        .output()
        .unwrap();
    let printed = text(&[&*output.stdout, &*output.stderr].concat());
    assert!(output.status.success(), "{printed}");
    let lines = printed.lines().filter(|line| line.contains(" s  Y"));
    lines.collect::<Vec<_>>().join("\n")
}

/// Succeeded, with nothing but the line that says so.
fn quiet(output: &Output) {
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
}

#[test]
fn an_image_runs() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let folder = folder(&[]);
    let args = [
        "build",
        &traffic_light(),
        "--target",
        "thumbv7em-none-eabihf",
    ];
    let image = ["--emit", "elf", "--board", &board("stm32f405/board.toml")];
    let script = [
        "--set",
        "X0=1@2s,X0=0@2.1s",
        "--for",
        "30s",
        "-o",
        "light.elf",
    ];
    let args = [&args[..], &image, &script].concat();
    quiet(&rungc(folder.path(), &args));
    let printed = simulated("netduinoplus2", &folder.path().join("light.elf"));
    insta::assert_snapshot!("traffic_light", printed);
    let again = rungc(folder.path(), &args);
    assert_eq!(again.status.code(), Some(2), "it is there already");
}

/// Nothing is written by what cannot be built.
#[test]
fn what_is_missing_is_said() {
    if !tools(&["make"]) {
        return;
    }
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let build = || {
        let mut build = Command::new(env!("CARGO_BIN_EXE_rungc"));
        build
            .args(["build", "motor.il", "--emit", "lib", "-o", "out"])
            .args(["--target", "thumbv7m-none-eabi"])
            .current_dir(folder.path());
        build
    };
    let output = build()
        .env("CC_thumbv7m_none_eabi", "/nowhere/gcc")
        .output()
        .unwrap();
    insta::assert_snapshot!("no_compiler", text(&output.stderr));
    assert_eq!(output.status.code(), Some(2));
    assert!(!folder.path().join("out").exists());
}

#[test]
fn options_that_do_not_go_together() {
    let wrong = "name = \"Desk\"\ntarget = \"thumbv7m-none-eabi\"\n[memory]\nflash = { origin = 0, length = \"1Q\" }\n";
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("wrong.toml", wrong.as_bytes()),
    ]);
    let board = board("stm32f405/board.toml");
    let mut said = Vec::new();
    for args in [
        &["--emit", "elf"][..],
        &["--emit", "ir", "--target", "host"],
        &["--emit", "bin", "--target", "thumbv7m-none-eabi"],
        &["--emit", "bin", "--board", &board],
        &["--emit", "c", "--main", "--board", &board],
        &["--emit", "lib", "--main"],
        &["--emit", "lib", "--target", "pdp11"],
        &["--emit", "elf", "--board", "none.toml"],
        &["--emit", "elf", "--board", "wrong.toml"],
        &["--emit", "elf", "--board", &board, "--set", "D0=1"],
        &[
            "--emit",
            "elf",
            "--board",
            &board,
            "--target",
            "thumbv6m-none-eabi",
        ],
    ] {
        let args = [&["build", "motor.il", "-o", "out"], args].concat();
        said.push(shown(folder.path(), &args).replace(&board, "BOARD"));
        assert_eq!(code(folder.path(), &args), 2, "{args:?}");
        assert!(!folder.path().join("out").exists(), "{args:?}");
    }
    insta::assert_snapshot!("refused", said.join("\n\n"));
}

/// A board whose ticks are short enough for pulses of 4 kHz.
#[test]
fn an_image_sends_pulses() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let target = "thumbv7em-none-eabihf";
    let Some(cargo) = cargo(target) else {
        return leave_out(&no_rust(target));
    };
    let board = std::fs::read_to_string(board("stm32f405/board.toml")).unwrap();
    let board = board.replace("hz = 16_000_000", "tick_us = 50\nhz = 16_000_000");
    let folder = folder(&[("board.toml", board.as_bytes())]);
    let stepper = repository().join("examples/stm32f405/stepper.il");
    let mut build = with_cargo(&cargo);
    build
        .args(["build", &stepper.display().to_string(), "--emit", "elf"])
        .args(["--board", "board.toml", "-o", "stepper.elf"])
        .args(["--set", "X0=1@10ms,X0=0@20ms", "--for", "500ms"])
        .current_dir(folder.path());
    quiet(&build.output().unwrap());
    let printed = simulated("netduinoplus2", &folder.path().join("stepper.elf"));
    // The train ends after 344 ms; the scan behind it sees that.
    let lines = ["      0.010 s  Y002 on", "      0.350 s  Y001 on  done"];
    assert_eq!(printed, lines.join("\n"));
}

/// The command line with the cargo of [`tools::cargo`].
fn with_cargo(cargo: &Command) -> Command {
    let mut rungc = Command::new(env!("CARGO_BIN_EXE_rungc"));
    for (name, value) in cargo.get_envs() {
        match value {
            Some(value) => rungc.env(name, value),
            None => rungc.env_remove(name),
        };
    }
    rungc.env("CARGO", cargo.get_program());
    rungc
}
