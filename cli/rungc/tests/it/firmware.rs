//! Libraries and images for another machine: what is built runs under QEMU, and missing tools are reported.

use crate::common::{MOTOR, code, folder, rungc, shown, text};
use crate::tools::{cargo, leave_out, no_rust, tools, with_cargo};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn repository() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

fn traffic_light() -> String {
    let path = repository().join("examples/programs/traffic_light.il");
    path.display().to_string()
}

fn board(file: &str) -> String {
    repository()
        .join("examples")
        .join(file)
        .display()
        .to_string()
}

/// Output of an image on a machine of QEMU's. It prints some kinds of semihosting to standard output, others to
/// standard error.
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

/// Succeeded, with nothing but the line that says so; the runtime may have to be built before, and a name be changed.
pub fn quiet(output: &Output) {
    let messages = text(&output.stderr);
    assert!(output.status.success(), "{messages}");
    let lines = messages.lines();
    let other = lines.filter(|line| !line.starts_with("    Building the runtime for "));
    let other = other.filter(|line| !line.starts_with("       Named "));
    assert_eq!(other.count(), 1, "{messages}");
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
    let image = [
        "--emit",
        "elf",
        "--board",
        &board("firmware/stm32f405/board.toml"),
    ];
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

/// The other cores, at boards of QEMU's. A micro:bit stands for any Cortex-M0: nothing of its pins is looked at.
#[test]
fn images_run_on_other_cores() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let m3 = std::fs::read_to_string(board("boards/mps2-an385.toml")).unwrap();
    let m0 = m3.replace("thumbv7m", "thumbv6m").replace("4M", "16K");
    let folder = folder(&[("m3.toml", m3.as_bytes()), ("m0.toml", m0.as_bytes())]);
    for (board, machine) in [("m3", "mps2-an385"), ("m0", "microbit")] {
        let image = format!("{board}.elf");
        let args = ["build", &traffic_light(), "--emit", "elf", "-o", &image];
        let script = ["--set", "X0=1@2s,X0=0@2.1s", "--for", "30s"];
        let board = ["--board", &format!("{board}.toml")];
        let output = rungc(folder.path(), &[&args[..], &script, &board].concat());
        quiet(&output);
        let printed = simulated(machine, &folder.path().join(image));
        insta::assert_snapshot!("traffic_light", printed);
    }
}

/// Three edges between two scans interrupt this program.
const EDGES: &str = "\
EI
LD>= D0 K3
OUT Y000
FEND
I001
LD M8000
INC D0
IRET
END
";

const EDGES_SCRIPT: &str = "X0=1@11ms,X0=0@12ms,X0=1@13ms,X0=0@14ms,X0=1@15ms,X0=0@16ms";

#[test]
fn an_image_takes_edges() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let folder = folder(&[("edges.il", EDGES.as_bytes())]);
    let args = ["build", "edges.il", "--emit", "elf", "--set", EDGES_SCRIPT];
    let board = [
        "--for",
        "50ms",
        "--board",
        &board("firmware/stm32f405/board.toml"),
    ];
    quiet(&rungc(folder.path(), &[&args[..], &board].concat()));
    let printed = simulated("netduinoplus2", &folder.path().join("edges.elf"));
    assert_eq!(printed, "      0.020 s  Y000 on");
}

/// The same images in Rust do the same, on a Cortex-M3 and a Cortex-M4.
#[test]
fn images_in_rust_run() {
    if !tools(&["arm-none-eabi-ld", "qemu-system-arm"]) {
        return;
    }
    let folder = folder(&[("edges.il", EDGES.as_bytes())]);
    let light = traffic_light();
    for (program, script, end, place, target, machine) in [
        (
            light.as_str(),
            "X0=1@2s,X0=0@2.1s",
            "30s",
            "boards/mps2-an385.toml",
            "thumbv7m-none-eabi",
            "mps2-an385",
        ),
        (
            "edges.il",
            EDGES_SCRIPT,
            "50ms",
            "firmware/stm32f405/board.toml",
            "thumbv7em-none-eabihf",
            "netduinoplus2",
        ),
    ] {
        let Some(cargo) = cargo(target) else {
            return leave_out(&no_rust(target));
        };
        let output = with_cargo(&cargo)
            .args(["build", program, "--emit", "elf", "--backend", "rust"])
            .args(["--board", &board(place), "--set", script, "--for", end])
            .args(["-o", machine])
            .current_dir(folder.path())
            .output();
        quiet(&output.unwrap());
        let printed = simulated(machine, &folder.path().join(machine));
        match program {
            "edges.il" => assert_eq!(printed, "      0.020 s  Y000 on"),
            _ => insta::assert_snapshot!("traffic_light", printed),
        }
    }
}

/// Images in Rust are built in one place after the other, and none sees the program, the board or the linker script of
/// the one before.
#[test]
fn images_in_rust_do_not_see_each_other() {
    if !tools(&["arm-none-eabi-ld"]) {
        return;
    }
    let target = "thumbv7m-none-eabi";
    let Some(cargo) = cargo(target) else {
        return leave_out(&no_rust(target));
    };
    let described = std::fs::read_to_string(board("boards/mps2-an385.toml")).unwrap();
    let moved = described.replace("origin = 0x2000_0000", "origin = 0x2000_1000");
    assert_ne!(described, moved);
    let folder = folder(&[
        ("timer.il", b"LD X000\nOUT T0 K3\nLD T0\nOUT Y000\nEND\n"),
        ("lamp.il", b"LD X000\nOUT Y001\nEND\n"),
        ("board.toml", described.as_bytes()),
        ("moved.toml", moved.as_bytes()),
    ]);
    let build = |program: &str, board: &str, output: &str| {
        let built = with_cargo(&cargo)
            .args(["build", program, "--name", "plc", "--emit", "elf"])
            .args(["--backend", "rust", "--board", board, "-o", output])
            .current_dir(folder.path())
            .output();
        quiet(&built.unwrap());
        std::fs::read(folder.path().join(output)).unwrap()
    };
    let timer = build("timer.il", "board.toml", "a.elf");
    let lamp = build("lamp.il", "board.toml", "b.elf");
    let lamp_moved = build("lamp.il", "moved.toml", "c.elf");
    assert!(timer != lamp && lamp != lamp_moved);
    assert!(timer == build("timer.il", "board.toml", "d.elf"));
    assert!(lamp == build("lamp.il", "board.toml", "e.elf"));
}

/// Times of a trace in tenths of a second: in which scan a script's input is seen depends on how long a scan takes.
fn to_tenths(trace: &str) -> String {
    let line = |line: &str| match line.trim().split_once(" s  ") {
        Some((time, what)) => format!("{} s  {what}\n", &time[..time.len() - 2]),
        None => format!("{line}\n"),
    };
    trace.lines().map(line).collect()
}

/// Counts go out to a converter and come back from one, in images from C and from Rust: at power-on the converter holds
/// 0, which is -10 V.
#[test]
fn channels_of_modules_are_pins() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let target = "thumbv7m-none-eabi";
    let Some(cargo) = cargo(target) else {
        return leave_out(&no_rust(target));
    };
    let folder = folder(&[]);
    let (program, board) = (board("analog/follow.il"), board("analog/board.toml"));
    for backend in ["c", "rust"] {
        let output = with_cargo(&cargo)
            .args(["build", &program, "--emit", "elf", "--board", &board])
            .args(["--set", "X0=1@1s,X0=0@2s", "--for", "3s"])
            .args(["--backend", backend, "-o", backend])
            .current_dir(folder.path())
            .output();
        quiet(&output.unwrap());
        let printed = simulated("mps2-an385", &folder.path().join(backend));
        insta::assert_snapshot!("analog", to_tenths(&printed));
    }
    std::fs::copy(&board, folder.path().join("board.toml")).unwrap();
    let wrong = "[[module]]\nat = 0\nkind = \"H2U-4AD\"\npins = { CH1 = \"AI7\" }\n";
    std::fs::write(folder.path().join("rungc.toml"), wrong).unwrap();
    std::fs::write(folder.path().join("p.il"), "LD X0\nFROM K0 K5 D0 K1\nEND\n").unwrap();
    let args = [
        "build",
        "p.il",
        "--model",
        "h2u",
        "--emit",
        "elf",
        "--board",
        "board.toml",
    ];
    insta::assert_snapshot!("no_analog_pin", shown(folder.path(), &args));
}

/// A board whose pins are functions in C. What it shows are two outputs and how often they were set.
const PANEL: &str = "\
name = \"Panel\"
target = \"thumbv7m-none-eabi\"
sources = [\"panel.c\", \"panel.h\"]

[memory]
flash = { origin = 0, length = \"64K\" }
ram = { origin = 0x2000_0000, length = \"16K\" }

[clock]
hz = 25_000_000

[functions]
init = \"panel_init\"
input = \"panel_input\"
set_output = \"panel_set_output\"

[interrupts]
5 = \"panel_interrupt\"
";

const PANEL_C: &str = "\
#include <stdbool.h>
#include <stdint.h>
#include \"panel.h\"

static unsigned reads;
static bool interrupted;

static void call(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__(\"r0\") = operation;
    register const void *r1 __asm__(\"r1\") = argument;
    __asm__ volatile(\"bkpt 0xAB\" : \"+r\"(r0) : \"r\"(r1) : \"memory\");
}

void panel_interrupt(void)
{
    interrupted = true;
}

void panel_init(void)
{
    *(volatile uint32_t *)0xE000E100u = 1u << 5; /* enabled */
    *(volatile uint32_t *)0xE000E200u = 1u << 5; /* and requested */
}

bool panel_input(void *context, uint16_t number, bool *on)
{
    (void)context;
    *on = number == 0u && ++reads > FIRST && interrupted;
    return true;
}

void panel_set_output(void *context, uint16_t number, bool on)
{
    (void)context;
    if (number == 0u && on) {
        call(0x04, \" s  Y000 of the panel\\n\");
        call(0x18, (const void *)0x20026);
    }
}
";

#[test]
fn a_board_may_have_functions_of_its_own() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("panel.toml", PANEL.as_bytes()),
        ("panel.c", PANEL_C.as_bytes()),
        ("panel.h", b"#define FIRST 3u\n"),
    ]);
    let args = [
        "build",
        "motor.il",
        "--emit",
        "elf",
        "--board",
        "panel.toml",
    ];
    quiet(&rungc(folder.path(), &args));
    let printed = simulated("mps2-an385", &folder.path().join("motor.elf"));
    assert_eq!(printed, " s  Y000 of the panel");
    // The same as sources, which build by themselves.
    let args = [
        "build",
        "motor.il",
        "--emit",
        "c",
        "--board",
        "panel.toml",
        "-o",
        "src",
    ];
    quiet(&rungc(folder.path(), &args));
    let source = folder.path().join("src");
    let made = Command::new("make")
        .arg("-C")
        .arg(&source)
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", text(&made.stderr));
    assert_eq!(text(&made.stderr), "", "warnings");
    assert_eq!(simulated("mps2-an385", &source.join("motor.elf")), printed);
}

/// Nothing is written by what cannot be built.
#[test]
fn what_is_missing_is_reported() {
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
        ("own.toml", PANEL.as_bytes()),
        ("panel.c", PANEL_C.as_bytes()),
        ("panel.h", b""),
    ]);
    let board = board("firmware/stm32f405/board.toml");
    let mut messages = Vec::new();
    for args in [
        &["--emit", "elf"][..],
        &["--emit", "ir", "--target", "host"],
        &["--emit", "bin", "--target", "thumbv7m-none-eabi"],
        &["--emit", "bin", "--board", &board],
        &["--emit", "c", "--main", "--board", &board],
        &["--emit", "lib", "--main"],
        &["--emit", "lib", "--target", "pdp11"],
        &["--emit", "lib", "--backend", "rust"],
        &[
            "--emit",
            "elf",
            "--backend",
            "rust",
            "--report",
            "--board",
            &board,
        ],
        &["--emit", "elf", "--backend", "rust", "--board", "own.toml"],
        &["--emit", "rust", "--report"],
        &["--report", "--format", "sarif"],
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
        messages.push(shown(folder.path(), &args).replace(&board, "BOARD"));
        assert_eq!(code(folder.path(), &args), 2, "{args:?}");
        assert!(!folder.path().join("out").exists(), "{args:?}");
    }
    insta::assert_snapshot!("refused", messages.join("\n\n"));
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
    let board = std::fs::read_to_string(board("firmware/stm32f405/board.toml")).unwrap();
    let board = board.replace("hz = 16_000_000", "tick_us = 50\nhz = 16_000_000");
    let folder = folder(&[("board.toml", board.as_bytes())]);
    let stepper = repository().join("examples/firmware/stm32f405/stepper.il");
    let mut build = with_cargo(&cargo);
    build
        .args(["build", &stepper.display().to_string(), "--emit", "elf"])
        .args(["--board", "board.toml", "-o", "stepper.elf"])
        .args(["--set", "X0=1@10ms,X0=0@20ms", "--for", "500ms"])
        .current_dir(folder.path());
    quiet(&build.output().unwrap());
    let printed = simulated("netduinoplus2", &folder.path().join("stepper.elf"));
    // The train ends after 344 ms; the scan after it sees that.
    let lines = ["      0.010 s  Y002 on", "      0.350 s  Y001 on  done"];
    assert_eq!(printed, lines.join("\n"));
}

/// Three edges of an input interrupt the program, all of them between two scans.
#[test]
fn an_image_notes_edges() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let program = b"EI\nLD>= D0 K3\nOUT Y0\nFEND\nI001\nLD M8000\nINC D0\nIRET\nEND\n";
    let folder = folder(&[("edges.il", program)]);
    let presses = "X0=1@11ms,X0=0@12ms,X0=1@13ms,X0=0@14ms,X0=1@15ms";
    let mut build = Command::new(env!("CARGO_BIN_EXE_rungc"));
    build
        .args(["build", "edges.il", "--emit", "elf", "-o", "edges.elf"])
        .args(["--board", &board("firmware/stm32f405/board.toml")])
        .args(["--set", presses, "--for", "50ms"])
        .current_dir(folder.path());
    quiet(&build.output().unwrap());
    let printed = simulated("netduinoplus2", &folder.path().join("edges.elf"));
    assert_eq!(printed, "      0.020 s  Y000 on");
}

/// A text without the sizes that another version of a compiler would change.
fn without_sizes(text: &str) -> String {
    let measured = ["flash", "RAM", "a scan", "image"];
    let lines = text.lines().map(|line| {
        let measured = measured
            .iter()
            .any(|what| line.trim_start().starts_with(what));
        match measured {
            true => line
                .replace(|c: char| c.is_ascii_digit(), "")
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" "),
            false => line.to_string(),
        }
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Interrupts, a loop whose count is in a device, a call, a jump back.
const BUSY: &str = "\
EI
LD X010
OUT Y000
FOR D10
LD M8000
ADD D0 K1 D0
NEXT
FOR K5
LD M8000
ADD D1 K1 D1
NEXT
P1
LD X011
CALL P0
LD X012
CJ P1
FEND
P0
LD M8000
INC D2
SRET
I001
LD M8000
INC D3
IRET
END
";

#[test]
fn what_a_program_takes_is_reported() {
    if !tools(&["make", "arm-none-eabi-gcc"]) {
        return;
    }
    let folder = folder(&[("busy.il", BUSY.as_bytes())]);
    let mut messages = Vec::new();
    for (file, place) in [
        (
            traffic_light(),
            ["--board", &board("firmware/stm32f405/board.toml")],
        ),
        (traffic_light(), ["--target", "thumbv6m-none-eabi"]),
        ("busy.il".to_string(), ["--target", "thumbv7m-none-eabi"]),
        ("busy.il".to_string(), ["--target", "host"]),
    ] {
        let args = [&["build", &file, "--report"][..], &place].concat();
        let output = rungc(folder.path(), &args);
        assert!(output.status.success(), "{}", text(&output.stderr));
        messages.push(without_sizes(&text(&output.stdout)));
    }
    insta::assert_snapshot!("report", messages.join("\n\n"));
}

#[test]
fn a_report_for_tools() {
    if !tools(&["make", "arm-none-eabi-gcc"]) {
        return;
    }
    let folder = folder(&[]);
    let args = ["build", &traffic_light(), "--report", "--format", "json"];
    let board = ["--board", &board("firmware/stm32f405/board.toml")];
    let output = rungc(folder.path(), &[&args[..], &board].concat());
    let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let report = &read["report"];
    let number = |pointer: &str| report.pointer(pointer).and_then(|n| n.as_u64()).unwrap();
    // The goal of a small image, which holds far from what compilers change.
    assert!((500..4096).contains(&number("/flash")), "{report}");
    assert!((100..512).contains(&number("/ram")), "{report}");
    assert!((8..512).contains(&number("/stack/scan")), "{report}");
    assert!(number("/stack/image") > number("/stack/scan"), "{report}");
    assert_eq!(number("/scan/steps"), 52);
    let areas = report["devices"]["areas"].as_array().unwrap();
    let sum: u64 = areas
        .iter()
        .map(|area| area["bytes"].as_u64().unwrap())
        .sum();
    assert_eq!(sum + number("/devices/private"), number("/devices/bytes"));
    let outputs = areas.iter().find(|area| area["class"] == "Y").unwrap();
    assert_eq!(outputs["devices"], 5);
}
