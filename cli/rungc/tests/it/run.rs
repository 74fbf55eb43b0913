//! `rungc run` and machines, as their user sees them.

use crate::common;
use crate::common::{HANG, MOTOR, code, folder, rungc, shown, text};
use std::fs;

#[test]
fn settings_after_the_end_are_reported() {
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
    // Of what the program writes, and in the form that it writes.
    let scales = b"LD M8000\nFLT D0 D10\nDEADD D10 E0.5 D12\nDMOV D4 D6\nSET S0\nOUT M8034\nEND\n";
    fs::write(folder.path().join("scales.il"), scales).unwrap();
    let args = [
        "run",
        "scales.il",
        "--set",
        "D0=3,D4.i32=70000",
        "--for",
        "0",
    ];
    insta::assert_snapshot!("run_views", shown(folder.path(), &args));
    for wrong in [
        &["--watch", "D0:f"][..],
        &["--set", "X008=1"],
        &["--set", "D0"],
        &["--watch", "Q1"],
        &["--watch", "D70000"],
        &["--for", "soon"],
        &["--scan", "0"],
        &["--watch", "D4294967295.i32"],
        &["--set", "K8M4294967295=1"],
    ] {
        let args = [&["run", "motor.il"], wrong].concat();
        assert_eq!(code(folder.path(), &args), 2, "{wrong:?}");
    }
    insta::assert_snapshot!(
        "run_wrong_set",
        shown(folder.path(), &["run", "motor.il", "--set", "X000=2"])
    );
    insta::assert_snapshot!(
        "run_wrong_view",
        shown(folder.path(), &["run", "motor.il", "--watch", "D0:f"])
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
    // A run stopped by the watchdog keeps its recording.
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
    use std::io::Read;
    use std::process::{Command, Stdio};
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
            .args(["-TERM", &id])
            .status()
            .unwrap()
            .success()
    );
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
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
    // Over the pulses instead of over time.
    let over = ["--over", "Y000.pulses"];
    let args = ["run", "pulses.il", "--for", "300ms", "--set", "X000=1"];
    let plot = ["--plot", "over.svg"];
    assert_eq!(code(path, &[&args[..], &plot, &over].concat()), 0);
    let drawn_over = fs::read_to_string(path.join("over.svg")).unwrap();
    assert!(drawn_over.contains(">Y000.pulses</text>") && !drawn_over.contains("time ("));
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
        (
            "over_text",
            &[
                "--plot", "a.svg", "--for", "1s", "--watch", "Y000", "--over", "D0.str",
            ],
        ),
    ] {
        let args = [&["run", "door.il"], args].concat();
        insta::assert_snapshot!(format!("run_plot_{name}"), shown(path, &args));
    }
    let there = |name: &str| path.join(name).exists();
    assert!(!there("none.svg") && !there("a.svg"));
}

#[test]
fn operation_errors_are_reported_with_their_places() {
    let program = b"LD M8000\nFMOV K0 D0Z0 K10\nLD M8000\nMOV K9000 Z0\nDIV D0 D1 D2\nEND\n";
    let folder = folder(&[("errors.il", program)]);
    let path = folder.path();
    let args = ["run", "errors.il", "--for", "30ms"];
    insta::assert_snapshot!("run_errors", shown(path, &args));
    let denied = [&args[..], &["--deny-errors", "--verbose"]].concat();
    insta::assert_snapshot!("run_errors_denied", shown(path, &denied));
}

/// Nothing happens between its scans, so they take no time.
#[test]
fn long_scans_run_quickly() {
    let folder = folder(&[("idle.il", b"LD X0\nOUT Y0\nEND\n")]);
    let begin = std::time::Instant::now();
    let args = [
        "run",
        "idle.il",
        "--for",
        "1193h",
        "--scan",
        "1h",
        "--set",
        "X0=1@5400s",
    ];
    let shown = shown(folder.path(), &args);
    assert!(
        shown.contains("7200.000 s"),
        "the scan after it takes notice: {shown}"
    );
    assert!(begin.elapsed() < HANG, "it steps through each millisecond");
}

#[test]
fn a_scan_that_does_not_end_is_the_programs_fault() {
    let folder = folder(&[("endless.il", b"P0\nLD M8000\nCJ P0\nEND\n")]);
    let args = ["run", "endless.il"];
    insta::assert_snapshot!("run_endless", shown(folder.path(), &args));
}

#[test]
fn a_run_becomes_a_test() {
    let folder = common::folder(&[("motor.il", common::MOTOR.as_bytes())]);
    let path = folder.path();
    let run = [
        "run",
        "motor.il",
        "--for",
        "1s",
        "--set",
        "X000=1@105ms,X000=0@200ms,X001=1@800ms",
        "--watch",
        "T0,D0",
        "--record",
        "tests/motor.plctest.toml",
    ];
    let output = common::rungc(path, &run);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        common::text(&output.stderr)
    );
    let test = path.join("tests/motor.plctest.toml");
    insta::assert_snapshot!("run_recorded_test", std::fs::read_to_string(&test).unwrap());
    for engine in ["interp", "all"] {
        assert_eq!(
            common::code(path, &["test", "tests", "--engine", engine]),
            0,
            "{engine}"
        );
    }
    // A timer that expires one unit earlier or later is noticed, and so are all other values.
    for preset in ["K2", "K4"] {
        std::fs::write(path.join("motor.il"), common::MOTOR.replace("K3", preset)).unwrap();
        assert_eq!(common::code(path, &["test", "tests"]), 1, "{preset}");
    }
    let refused = [
        &["run", "motor.il", "--record", "motor.il"][..],
        &[
            "run",
            "motor.il",
            "--record",
            "a.plctest.toml",
            "--retain",
            "kept",
        ],
        &[
            "run",
            "motor.il",
            "--record",
            "a.plctest.toml",
            "--modbus-tcp",
            "0",
        ],
        &[
            "run",
            "motor.il",
            "--record",
            "a.plctest.toml",
            "--real-time",
        ],
    ];
    let story: Vec<String> = refused
        .iter()
        .map(|args| common::shown(path, args))
        .collect();
    insta::assert_snapshot!("run_record_refused", story.join("\n\n"));
}

/// What a run records of a pulse output is what a test sees of it: its terminal at the end of each scan's time.
#[test]
fn a_run_with_pulses_becomes_a_test() {
    let programs = [
        ("plsy.il", "LD X000\nPLSY K50 K0 Y000\nEND\n"),
        (
            "few.il",
            "LD X000\nPLSY K130 K7 Y000\nLD M8029\nOUT Y010\nEND\n",
        ),
        ("drvi.il", "LD X000\nDRVI K40 K90 Y000 Y004\nEND\n"),
        ("off.il", "LD X000\nOUT Y005\nLD X001\nOUT M8034\nEND\n"),
    ];
    let files: Vec<_> = programs
        .iter()
        .map(|(name, text)| (*name, text.as_bytes()))
        .collect();
    let folder = common::folder(&files);
    let path = folder.path();
    for (name, _) in programs {
        for scan in ["3", "7", "10"] {
            let test = format!("{name}-{scan}.plctest.toml");
            let args = [
                "--for",
                "400ms",
                "--set",
                "X000=1@20ms,X001=1@90ms,X001=0@150ms",
            ];
            let record = ["--watch", "Y000", "--record", &test];
            let run = [&["run", name, "--scan", scan][..], &args, &record].concat();
            let output = common::rungc(path, &run);
            let said = common::text(&output.stderr);
            assert_eq!(output.status.code(), Some(0), "{name} {scan}: {said}");
            assert_eq!(common::code(path, &["test", &test]), 0, "{name} {scan}");
        }
    }
}
