//! The command line as its user sees it: what is printed where, what is written, and the exit code.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A start-stop circuit with a timer and a counted edge.
const MOTOR: &str = "\
LD X000      ; start
OR M0
ANI X001     ; stop
OUT M0       ; motor latch
LD M0
OUT T0 K3
LD T0
OUT Y000     ; main contactor
LDP X002
ADD D0 K1 D0
LD>= D0 K10
SET Y001
END
";

/// Three errors and a double coil.
const BAD: &str = "LD X000\nOUT Y000\nLD X009\nMOVE D0 D1\nADD D0 K1\nOUT Y000\nEND\n";

/// Correct, with a double coil.
const DOUBLE: &str = "LD X000\nOUT Y000\nLD X001\nOUT Y000\nEND\n";

/// A folder of its own with these files.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in files {
        fs::write(folder.path().join(name), content).unwrap();
    }
    folder
}

fn rungc(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Times differ from run to run, paths and numbers of errors from system to system.
fn normal(text: &str, folder: &Path) -> String {
    let text = text.replace(&folder.display().to_string(), "FOLDER");
    let mut lines = Vec::new();
    for line in text.lines() {
        let mut line = line.to_owned();
        if let Some((before, rest)) = line.split_once(") in ") {
            let rest = rest.trim_start_matches(|c: char| c.is_ascii_digit());
            line = format!("{before}) in …{rest}");
        }
        if let Some((before, _)) = line.split_once(" failed (") {
            line = format!("{before} failed (… s)");
        }
        lines.push(line);
    }
    lines.join("\n")
}

/// What was called, what it printed and how it ended.
fn shown(folder: &Path, args: &[&str]) -> String {
    let output = rungc(folder, args);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    for printed in [&out, &err] {
        assert!(
            !printed.contains('\u{1b}'),
            "colours without a terminal: {printed}"
        );
        assert!(!printed.contains("panicked"), "{printed}");
    }
    let code = output.status.code().unwrap();
    let args = args.join(" ");
    format!(
        "$ rungc {args}\n{}\n--- standard error\n{}\n--- exit code {code}",
        normal(&out, folder),
        normal(&err, folder)
    )
}

fn code(folder: &Path, args: &[&str]) -> i32 {
    rungc(folder, args).status.code().unwrap()
}

/// A `MAIN.wpg` for FX3U: LD X000, OUT Y000, END.
fn wpg() -> Vec<u8> {
    let mut bytes = vec![0x40, 0x00, 0x22, 0x01];
    bytes.resize(0x24, b' ');
    bytes.extend([0x04, 0x02, 0x08, 0x02]);
    bytes.resize(0x40, 0xFF);
    bytes.extend([0x04, 0x00, 0xFF, 0xFF]);
    bytes.extend([3, 0x00, 3, 4, 0x9C, 0, 4]);
    bytes.extend([3, 0x20, 3, 4, 0x9D, 0, 4]);
    bytes.extend([3, 0x34, 3]);
    bytes.extend([0x02; 64]);
    bytes
}

#[test]
fn check_for_people() {
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("bad.il", BAD.as_bytes()),
        ("MAIN.wpg", &wpg()),
    ]);
    insta::assert_snapshot!("check_good", shown(folder.path(), &["check", "motor.il"]));
    insta::assert_snapshot!("check_bad", shown(folder.path(), &["check", "bad.il"]));
    insta::assert_snapshot!(
        "check_project",
        shown(folder.path(), &["check", "MAIN.wpg"])
    );
    insta::assert_snapshot!(
        "check_limit",
        shown(folder.path(), &["check", "bad.il", "--limit", "1"])
    );
}

#[test]
fn check_for_tools() {
    let folder = folder(&[("bad.il", BAD.as_bytes()), ("motor.il", MOTOR.as_bytes())]);
    for format in ["json", "sarif"] {
        let args = ["check", "bad.il", "--format", format];
        insta::assert_snapshot!(format!("check_{format}"), shown(folder.path(), &args));
        for file in ["bad.il", "motor.il"] {
            let output = rungc(folder.path(), &["check", file, "--format", format]);
            let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            assert!(read.is_object());
            assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
        }
    }
}

/// What a command makes and what it reports do not mix on standard output.
#[test]
fn reports_for_tools_leave_standard_output_clean() {
    let folder = folder(&[("double.il", DOUBLE.as_bytes())]);
    let args = ["build", "double.il", "--emit", "c", "--format", "json"];
    let output = rungc(folder.path(), &args);
    let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(read["warnings"], 1);
    assert_eq!(output.status.code(), Some(0));
    for args in [
        &["build", "double.il", "--emit", "ir"][..],
        &["run", "double.il"],
        &["convert", "double.il", "--to", "il"],
    ] {
        let plain = rungc(folder.path(), args);
        let output = rungc(folder.path(), &[args, &["--format", "json"]].concat());
        assert_eq!(output.stdout, plain.stdout, "{args:?}");
        let read: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
        assert!(read["diagnostics"].is_array(), "{args:?}");
    }
}

#[test]
fn warnings_can_be_denied_or_allowed() {
    let folder = folder(&[("double.il", DOUBLE.as_bytes())]);
    let check = |args: &[&str]| code(folder.path(), &[&["check", "double.il"], args].concat());
    assert_eq!(check(&[]), 0);
    assert_eq!(check(&["--deny-warnings"]), 1);
    assert_eq!(check(&["--deny-warnings", "-A", "w0203"]), 0);
    assert_eq!(check(&["--deny-warnings", "-A", "double-coil"]), 0);
    assert_eq!(check(&["--deny-warnings", "-A", "W0201"]), 1);
    assert_eq!(check(&["-A", "W9999"]), 2);
    insta::assert_snapshot!(
        "allow_unknown",
        shown(folder.path(), &["check", "double.il", "-A", "W9999"])
    );
}

/// Tools get an object for what is no program, too, and exit code 2 beside it.
#[test]
fn unreadable_input_for_tools() {
    let folder = folder(&[("junk.bin", &[0, 159, 146, 150, 0, 1, 2, 3])]);
    for format in ["json", "sarif"] {
        let args = ["check", "missing.il", "--format", format];
        insta::assert_snapshot!(format!("unreadable_{format}"), shown(folder.path(), &args));
    }
    let args = ["build", "junk.bin", "--emit", "ir", "--format", "json"];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty(), "taken by the IR");
    let read: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!(read["errors"], 1);
    assert_eq!(read["diagnostics"][0]["code"], "E0010");
}

#[test]
fn what_an_export_cannot_hold_is_told() {
    let list = format!(";! X000 = start button\n{MOTOR}");
    let folder = folder(&[("motor.il", list.as_bytes())]);
    let said = |to| text(&rungc(folder.path(), &["convert", "motor.il", "--to", to]).stderr);
    assert!(said("csv").contains("1 device comment left out"));
    assert!(said("il").is_empty());
}

#[test]
fn settings_behind_the_end_are_told() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let args = ["run", "motor.il", "--set", "X000=1@2s", "--for", "1s"];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stderr).contains("`X000` was not set"));
}

#[test]
fn run_shows_a_table_and_a_diagram() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let args = [
        "run",
        "motor.il",
        "--set",
        "X000=1@200ms,X002=1@300ms",
        "--set",
        "x001=1@800ms",
        "--watch",
        "Y000,T0,D0",
        "--for",
        "1s",
    ];
    insta::assert_snapshot!("run_watch", shown(folder.path(), &args));
    let args = ["run", "motor.il", "--set", "X0=1", "--for", "400ms"];
    insta::assert_snapshot!("run_default", shown(folder.path(), &args));
    // A clock relay that the program does not use.
    let args = ["run", "motor.il", "--watch", "M8013", "--for", "1s"];
    insta::assert_snapshot!("run_clock", shown(folder.path(), &args));
    for wrong in [
        &["--set", "X008=1"],
        &["--set", "D0"],
        &["--watch", "Q1"],
        &["--watch", "D70000"],
        &["--for", "soon"],
        &["--scan", "0"],
        &["--watch", "D4294967295.i32"],
        &["--set", "K8M4294967295=1"],
    ] {
        let args = [&["run", "motor.il"], &wrong[..]].concat();
        assert_eq!(code(folder.path(), &args), 2, "{wrong:?}");
    }
    insta::assert_snapshot!(
        "run_wrong_set",
        shown(folder.path(), &["run", "motor.il", "--set", "X000=2"])
    );
    insta::assert_snapshot!(
        "run_wrong_watch",
        shown(folder.path(), &["run", "motor.il", "--watch", "D70000"])
    );
}

#[test]
fn run_records_a_value_change_dump() {
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("idle.il", b"LD M8000\nOUT M8034\nEND\n"),
        (
            "endless.il",
            b"LD M8000\nOUT Y000\nP0\nLD M8000\nCJ P0\nEND\n",
        ),
    ]);
    let path = folder.path();
    let run = |args: &[&str]| code(path, &[&["run"], args].concat());
    let recording = |name: &str| fs::read_to_string(path.join(name)).unwrap();
    let set = ["--set", "X000=1@5ms,X002=1@15ms,D4=16961"];
    let watch = ["--watch", "T0,D0,D2.f32,D4.str,K1M0,C200,M0"];
    let args = ["motor.il", "--for", "40ms", "--vcd", "new/motor.vcd"];
    assert_eq!(run(&[&args[..], &set, &watch].concat()), 0);
    insta::assert_snapshot!("run_vcd", recording("new/motor.vcd"));
    // A run of no time has a scan; a recording replaces the last one.
    let args = ["motor.il", "--for", "0", "--vcd", "new/motor.vcd"];
    assert_eq!(run(&args), 0);
    let zero = recording("new/motor.vcd");
    assert!(
        zero.contains("#0\n$dumpvars\n") && !zero.contains("#1"),
        "{zero}"
    );
    // What there is of a run that the watchdog ends is kept.
    assert_eq!(run(&["endless.il", "--vcd", "endless.vcd"]), 1);
    assert!(recording("endless.vcd").contains("Y000"));
    for (name, args) in [
        ("none", &["idle.il", "--vcd", "none.vcd"]),
        ("program", &["motor.il", "--vcd", "./motor.il"]),
        ("folder", &["motor.il", "--vcd", "new"]),
    ] {
        let args = [&["run"], &args[..]].concat();
        insta::assert_snapshot!(format!("run_vcd_{name}"), shown(path, &args));
    }
    assert_eq!(run(&["motor.il", "--vcd", "motor.il/motor.vcd"]), 2);
    let mut left: Vec<_> = fs::read_dir(path)
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    left.sort();
    assert_eq!(
        left,
        ["endless.il", "endless.vcd", "idle.il", "motor.il", "new"]
    );
    assert_eq!(recording("motor.il"), MOTOR);
}

/// A door that a motor moves, and its machine: the program does not look at the limit switch.
const DOOR: &str = "LD X000\nOUT Y000\nLD X001\nOUT Y001\nEND\n";
const DOOR_MACHINE: &str = r#"normally_closed = ["X001"]

[[axis]]
name = "door"
unit = "mm"
forward = "Y000"
reverse = "Y002"
speed = 1000
travel = [0, 500]
forward_limit = "X001"
forward_limit_at = 400
"#;
const DOOR_TEST: &str = r#"model = "fx3u"
topic = "door"
machine = "door.toml"
[[case]]
name = "opens"
program = """
LD X000
OUT Y000
END
"""
[[case.step]]
set = { X000 = 1 }
run_ms = 300
expect = { X001 = 1 }
expect_position = { door = 300 }
[[case.step]]
set = { X000 = 0 }
scans = 1
expect_position = { door = 300 }
[[case]]
name = "does_not_open"
program = "END"
[[case.step]]
expect_position = { door = 17 }
[[case]]
name = "crashes"
program = """
LD M8000
OUT Y000
END
"""
[[case.step]]
run_ms = 1000
[[case]]
name = "sets_what_the_machine_drives"
program = "END"
[[case.step]]
set = { X001 = 1 }
[[case]]
name = "other_axis"
program = "END"
[[case.step]]
expect_position = { gate = 1 }
[[case]]
name = "other_model"
model = "h1u"
machine = "wide.toml"
program = "END"
[[case.step]]
scans = 1
"#;

#[test]
fn machines_are_wired_to_programs() {
    let wide = "[[delay]]\noutput = 'Y000'\ninput = 'X777'\non_ms = 1\n";
    let folder = folder(&[
        ("door.il", DOOR.as_bytes()),
        ("door.toml", DOOR_MACHINE.as_bytes()),
        ("door.plctest.toml", DOOR_TEST.as_bytes()),
        ("wide.toml", wide.as_bytes()),
        ("wrong.toml", b"[[axis]]\noutput = 'Y000'\nhomes = 'X000'\n"),
        ("binary.toml", &[0xFF, 0xFE, 0, 1]),
    ]);
    let path = folder.path();
    let seconds = ["--set", "X000=1@5ms", "--for", "1s", "--vcd", "door.vcd"];
    for (name, machine, more) in [
        ("door", "door.toml", &seconds[..]),
        ("set", "door.toml", &["--set", "K4X000=1"]),
        ("wide", "wide.toml", &[]),
        ("wrong", "wrong.toml", &[]),
        ("binary", "binary.toml", &[]),
        ("missing", "missing.toml", &[]),
    ] {
        let args = [&["run", "door.il", "--machine", machine], more].concat();
        insta::assert_snapshot!(format!("machine_{name}"), shown(path, &args));
    }
    let recording = fs::read_to_string(path.join("door.vcd")).unwrap();
    // The limit switch opens at 400 mm, which the door reaches 400 ms after the scan at 10 ms.
    assert!(recording.contains("#410000\n0\""), "{recording}");
    let args = ["test", "door.plctest.toml"];
    insta::assert_snapshot!("machine_test", shown(path, &args));
    let args = ["test", "door.plctest.toml", "--machine", "wrong.toml"];
    assert_eq!(code(path, &args), 2);
}

/// A run in real time is ended by Ctrl-C, and what it has recorded by then is written.
#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_recording() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["run", "motor.il", "--real-time", "--for", "1h"])
        .args([
            "--vcd",
            "motor.vcd",
            "--plot",
            "motor.svg",
            "--watch",
            "Y000",
        ])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The first line is written when the handler is there.
    let mut begun = [0; 10];
    child
        .stdout
        .as_mut()
        .unwrap()
        .read_exact(&mut begun)
        .unwrap();
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stderr).contains("rungc: interrupted at"));
    let written = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(written("motor.vcd").contains("$enddefinitions"));
    assert!(written("motor.svg").trim_end().ends_with("</svg>"));
}

#[test]
fn run_draws_a_diagram() {
    let folder = folder(&[
        ("door.il", DOOR.as_bytes()),
        ("door.toml", DOOR_MACHINE.as_bytes()),
        ("pulses.il", b"LD X000\nPLSY K1000 K250 Y000\nEND\n"),
    ]);
    let path = folder.path();
    let run = ["run", "door.il", "--for", "500ms"];
    let machine = ["--machine", "door.toml", "--set", "X000=1@5ms,X000=0@300ms"];
    let plot = ["--plot", "out/door.svg", "--watch", "X001,Y000"];
    let args = [&run[..], &machine, &plot].concat();
    assert_eq!(code(path, &args), 0);
    let drawn = || fs::read_to_string(path.join("out/door.svg")).unwrap();
    let first = drawn();
    insta::assert_snapshot!("run_plot", first);
    assert_eq!(code(path, &args), 0);
    assert_eq!(drawn(), first, "the same run gives the same bytes");
    // Without a machine there is what is watched; a run of no time has a moment.
    let args = ["run", "door.il", "--for", "0"];
    assert_eq!(code(path, &[&args[..], &plot].concat()), 0);
    assert!(drawn().contains(">X001</text>") && !drawn().contains("Position"));
    // Pulses that no axis follows are drawn, too.
    let args = ["run", "pulses.il", "--for", "300ms", "--set", "X000=1"];
    let written = ["--plot", "pulses.svg", "--vcd", "pulses.vcd"];
    assert_eq!(code(path, &[&args[..], &written].concat()), 0);
    let drawn = fs::read_to_string(path.join("pulses.svg")).unwrap();
    for panel in ["Position (pulses)", "Speed (pulses/s)", ">Y000</text>"] {
        assert!(drawn.contains(panel), "{panel}: {drawn}");
    }
    let recorded = fs::read_to_string(path.join("pulses.vcd")).unwrap();
    assert!(recorded.contains("Y000_pulses") && recorded.contains("Y000_hz"));
    let watch = ["--watch", "Y000.pulses,Y000.hz", "--scan", "100"];
    let output = rungc(path, &[&args[..], &watch].concat());
    let last = text(&output.stdout).lines().nth(3).unwrap().to_string();
    assert_eq!(last.split_whitespace().last(), Some("1000"), "{last}");
    assert_eq!(
        code(path, &[&args[..], &["--set", "Y000.pulses=1"]].concat()),
        2
    );
    for (name, args) in [
        ("none", &["--plot", "none.svg"][..]),
        (
            "vcd",
            &["--vcd", "a.svg", "--plot", "./a.svg", "--watch", "Y000"],
        ),
        (
            "machine",
            &["--machine", "door.toml", "--plot", "door.toml"],
        ),
        ("folder", &["--plot", "door.il/a.svg", "--watch", "Y000"]),
    ] {
        let args = [&["run", "door.il"], args].concat();
        insta::assert_snapshot!(format!("run_plot_{name}"), shown(path, &args));
    }
    let there = |name: &str| path.join(name).exists();
    assert!(!there("none.svg") && !there("a.svg"));
}

#[test]
fn a_scan_that_does_not_end_is_the_programs_fault() {
    let folder = folder(&[("endless.il", b"P0\nLD M8000\nCJ P0\nEND\n")]);
    let args = ["run", "endless.il"];
    insta::assert_snapshot!("run_endless", shown(folder.path(), &args));
}

#[test]
fn convert_there_and_back() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes()), ("MAIN.wpg", &wpg())]);
    let path = folder.path();
    let list = rungc(path, &["convert", "motor.il", "--to", "il"]).stdout;
    assert_eq!(
        code(
            path,
            &["convert", "motor.il", "--to", "csv", "-o", "out.csv"]
        ),
        0
    );
    assert_eq!(
        code(
            path,
            &["convert", "motor.il", "--to", "csv", "-o", "out.csv"]
        ),
        2
    );
    assert_eq!(
        code(
            path,
            &[
                "convert", "motor.il", "--to", "csv", "-o", "out.csv", "--force"
            ]
        ),
        0
    );
    let bytes = fs::read(path.join("out.csv")).unwrap();
    assert_eq!(bytes[..2], [0xFF, 0xFE], "UTF-16 with its mark");
    let back = rungc(path, &["convert", "out.csv", "--to", "il"]);
    let instructions = |bytes: &[u8]| -> Vec<String> {
        let text = text(bytes);
        let lines = text
            .lines()
            .map(|l| l.split(';').next().unwrap_or("").trim().to_owned());
        lines.filter(|l| !l.is_empty()).collect()
    };
    assert_eq!(instructions(&back.stdout), instructions(&list));
    insta::assert_snapshot!(
        "convert_il",
        shown(path, &["convert", "out.csv", "--to", "il"])
    );
    insta::assert_snapshot!(
        "convert_project",
        shown(path, &["convert", "MAIN.wpg", "--to", "il"])
    );
}

#[test]
fn explain_topics() {
    let folder = folder(&[]);
    for topic in ["E0106", "double-coil", "LD>=", "M8013", "nonsense", "MOVE"] {
        let name = format!("explain_{}", topic.replace(">=", "_ge"));
        insta::assert_snapshot!(name, shown(folder.path(), &["explain", topic]));
    }
    let add = rungc(folder.path(), &["explain", "add"]);
    assert!(text(&add.stdout).contains("ADD"));
    assert_eq!(add.status.code(), Some(0));
    let args = ["explain", "M8013", "--model", "h2u"];
    insta::assert_snapshot!("explain_special_on_model", shown(folder.path(), &args));
}

#[test]
fn wrong_usage() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    for args in [
        &[][..],
        &["frobnicate"],
        &["check"],
        &["check", "motor.il", "--model", "s7"],
        &["build", "motor.il"],
        &["build", "motor.il", "--emit", "pascal"],
        &["convert", "motor.il"],
        &["test"],
        &["test", "nowhere.plctest.toml"],
        &["explain"],
    ] {
        assert_eq!(code(folder.path(), args), 2, "{args:?}");
    }
    assert_eq!(code(folder.path(), &["--help"]), 0);
    assert_eq!(code(folder.path(), &["run", "--help"]), 0);
    assert_eq!(code(folder.path(), &["completions", "bash"]), 0);
    let args = ["check", "motor.il", "--model", "s7"];
    insta::assert_snapshot!("unknown_model", shown(folder.path(), &args));
}

#[test]
fn inputs_that_are_no_program() {
    let junk: Vec<u8> = (0..400_u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8)
        .collect();
    let mut cut = wpg();
    cut.truncate(0x4A);
    let folder = folder(&[("empty.il", b""), ("junk.bin", &junk), ("cut.wpg", &cut)]);
    fs::create_dir(folder.path().join("nothing")).unwrap();
    for (name, file) in [
        ("missing", "missing.il"),
        ("directory", "nothing"),
        ("empty", "empty.il"),
        ("junk", "junk.bin"),
        ("cut", "cut.wpg"),
    ] {
        insta::assert_snapshot!(
            format!("input_{name}"),
            shown(folder.path(), &["check", file])
        );
        let build = code(folder.path(), &["build", file, "--emit", "ir"]);
        assert!(build == 1 || build == 2, "{file}");
    }
}

#[test]
fn build_writes_and_does_not_overwrite() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes()), ("bad.il", BAD.as_bytes())]);
    let path = folder.path();
    insta::assert_snapshot!(
        "build_ir",
        shown(path, &["build", "motor.il", "--emit", "ir"])
    );
    for (emit, file) in [("c", "motor.c"), ("rust", "Cargo.toml")] {
        let args = ["build", "motor.il", "--emit", emit, "-o", emit];
        insta::assert_snapshot!(format!("build_{emit}"), shown(path, &args));
        assert!(path.join(emit).join(file).is_file());
        insta::assert_snapshot!(format!("build_{emit}_again"), shown(path, &args));
        let forced = [&args[..], &["--force"]].concat();
        assert_eq!(code(path, &forced), 0);
    }
    assert_eq!(
        code(path, &["build", "bad.il", "--emit", "c", "-o", "none"]),
        1
    );
    assert!(
        !path.join("none").exists(),
        "a program with errors is not emitted"
    );
}

/// What is emitted can be read by whom the user's mask lets read, as what an editor writes.
#[cfg(unix)]
#[test]
fn files_have_the_permissions_of_new_files() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    let mode = |file: &str| fs::metadata(path.join(file)).unwrap().permissions().mode() & 0o777;
    fs::write(path.join("usual"), "").unwrap();
    for args in [
        &["build", "motor.il", "--emit", "c", "-o", "c"][..],
        &["convert", "motor.il", "--to", "csv", "-o", "motor.csv"],
    ] {
        assert_eq!(code(path, args), 0);
    }
    assert_eq!(mode("c/motor.c"), mode("usual"));
    assert_eq!(mode("motor.csv"), mode("usual"));
}

#[test]
fn build_writes_into_a_folder_that_is_there() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    let args = ["build", "../motor.il", "--emit", "rust", "-o", "."];
    assert_eq!(code(&out, &args), 0, "an empty folder");
    assert_eq!(code(&out, &args), 2, "not empty any more");
    fs::write(out.join("src/lib.rs"), "old").unwrap();
    fs::write(out.join("notes.txt"), "kept").unwrap();
    let forced = [&args[..], &["--force"]].concat();
    assert_eq!(code(&out, &forced), 0);
    assert!(fs::read_to_string(out.join("src/lib.rs")).unwrap().len() > 3);
    assert!(out.join("notes.txt").is_file());
    let left = fs::read_dir(&out).unwrap().flatten().map(|e| e.file_name());
    assert!(
        left.into_iter()
            .all(|name| !name.to_string_lossy().starts_with(".rungc"))
    );
}

/// The host's main program stands in `main.c`, beside what a `MAIN.csv` or `main.il` becomes.
#[test]
fn a_program_may_be_called_main() {
    let folder = folder(&[("main.il", MOTOR.as_bytes())]);
    let path = folder.path();
    assert_eq!(
        code(
            path,
            &["build", "main.il", "--emit", "c", "--main", "-o", "out"]
        ),
        0
    );
    assert!(path.join("out/main.c").is_file() && path.join("out/plc_main.c").is_file());
}

#[test]
fn build_makes_an_executable_that_scans() {
    for tool in ["cc", "make"] {
        if Command::new(tool).arg("--version").output().is_err() {
            println!("skipped: there is no {tool}");
            return;
        }
    }
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    let args = ["build", "motor.il", "--emit", "bin", "-o", "motor"];
    insta::assert_snapshot!("build_bin", shown(path, &args));
    assert_eq!(code(path, &args), 2, "it is there already");
    let mut running = Command::new(path.join("motor"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(200));
    // It scans until it is stopped, or ends when its input does; it does not crash.
    match running.try_wait().unwrap() {
        Some(status) => assert_eq!(status.code(), Some(0)),
        None => running.kill().unwrap(),
    }
    running.wait().unwrap();
}

/// Whoever reads may stop reading: `rungc explain ADD | head -1`.
#[test]
fn closed_output_is_no_error() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes()), ("bad.il", BAD.as_bytes())]);
    for args in [
        &["explain", "ADD"][..],
        &["completions", "bash"],
        &["build", "motor.il", "--emit", "ir"],
        &["check", "motor.il", "--format", "json"],
        &["convert", "motor.il", "--to", "il"],
        &["run", "motor.il", "--for", "20s", "--watch", "M8011"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(args)
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let mut said = String::new();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut said)
            .unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(0), "{args:?}: {said}");
        assert!(
            !said.contains("panicked") && !said.contains("pipe"),
            "{args:?}: {said}"
        );
    }
}

#[test]
fn test_files_pass_and_fail() {
    let suite = |expected: u8| {
        format!(
            "model = \"h2u\"\ntopic = \"OUT\"\n\n[[case]]\nname = \"follows\"\nprogram = \"\"\"\nLD X000\nOUT Y000\nEND\n\"\"\"\n\
             [[case.step]]\nset = {{ X000 = 1 }}\nexpect = {{ Y000 = {expected} }}\n"
        )
    };
    let folder = folder(&[
        ("good.plctest.toml", suite(1).as_bytes()),
        ("bad.plctest.toml", suite(0).as_bytes()),
        ("odd.plctest.toml", b"model = \"h2u\"\ncolour = 3\n"),
    ]);
    for name in ["good", "bad", "odd"] {
        let file = format!("{name}.plctest.toml");
        insta::assert_snapshot!(
            format!("test_{name}"),
            shown(folder.path(), &["test", &file])
        );
    }
}

#[test]
fn colours_when_asked_for() {
    let folder = folder(&[("bad.il", BAD.as_bytes())]);
    let output = rungc(folder.path(), &["check", "bad.il", "--color", "always"]);
    assert!(text(&output.stderr).contains("\u{1b}["));
}
