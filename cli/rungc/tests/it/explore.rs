//! Runs that `rungc explore` finds, and the tests that it writes of them.

use crate::common::{code, folder, reverser, rungc, shown, text};
use std::fs;

#[test]
fn a_violation_is_found_and_its_test_fails_until_it_is_repaired() {
    let folder = folder(&[("reverser.il", reverser("").as_bytes())]);
    let args = [
        "explore",
        "reverser.il",
        "--never",
        "Y000 & Y001",
        "--scans",
        "3000",
        "--replay",
        "all",
        "--write-test",
        "found.plctest.toml",
        "--vcd",
        "found.vcd",
    ];
    insta::assert_snapshot!("violated", shown(folder.path(), &args));
    let test = fs::read_to_string(folder.path().join("found.plctest.toml")).unwrap();
    insta::assert_snapshot!("test_file", test);
    let vcd = fs::read_to_string(folder.path().join("found.vcd")).unwrap();
    assert!(vcd.contains("Y001"), "{vcd}");
    assert_eq!(code(folder.path(), &["test", "found.plctest.toml"]), 1);
    for (engine, name) in [("rust", "emitted Rust"), ("c", "emitted C")] {
        let requested = [&args[..6], &["--replay", engine]].concat();
        let output = text(&rungc(folder.path(), &requested).stdout);
        let messages = format!("Each run was replayed on {name}.");
        assert!(output.contains(&messages), "{output}");
    }
    let kept: Vec<&str> = args
        .iter()
        .copied()
        .filter(|arg| !["--replay", "all"].contains(arg))
        .collect();
    let again = shown(folder.path(), &kept);
    assert!(again.contains("exists"), "an existing test stays: {again}");
    fs::write(folder.path().join("reverser.il"), reverser("ANI Y000")).unwrap();
    assert_eq!(code(folder.path(), &["test", "found.plctest.toml"]), 0);
    let nothing = shown(folder.path(), &args[..6]);
    assert!(nothing.contains("Nothing was found."), "{nothing}");
    assert!(nothing.ends_with("exit code 0"), "{nothing}");
}

#[test]
fn errors_loops_coils_and_outputs_that_never_rest_are_found() {
    let program = "\
LD M8002
MOV K2 D1
LDP X000
DEC D1
LD X001
DIV K100 D1 D2
LD X002
OUT Y000
LD X003
OUT Y000
LD X004
ANI Y001
OUT Y001
P0
LD X005
AND X006
CJ P0
END
";
    let folder = folder(&[("all.il", program.as_bytes())]);
    let args = [
        "explore",
        "all.il",
        "--scans",
        "20000",
        "--write-test",
        "found.plctest.toml",
    ];
    let report = shown(folder.path(), &args);
    for expected in [
        "error[E0830]: `DIV K100 D1 D2` (step 12) meets operation error 6706",
        "error[E0831]: a scan does not end; the watchdog stops it at step 29",
        "error[E0832]: one coil of `Y000` is on, and a later one is off",
        "error[E0833]: `Y001` changes in every scan while no input does",
        "scan 1                0 ms  X005 = 1, X006 = 1\n",
        "--- exit code 1",
    ] {
        assert!(report.contains(expected), "{expected}:\n{report}");
    }
    let test = fs::read_to_string(folder.path().join("found.plctest.toml")).unwrap();
    for expected in ["M8067 = 0", "M8061 = 0", "Y000 = 1", "Y001 = "] {
        assert!(test.contains(expected), "{expected}:\n{test}");
    }
    let tested = rungc(folder.path(), &["test", "found.plctest.toml"]);
    let tested = text(&tested.stdout);
    assert!(
        tested.contains("4 failed") && tested.contains("0 passed"),
        "{tested}"
    );
    let ignore: Vec<&str> = ["errors", "watchdog", "coils", "oscillation"]
        .into_iter()
        .flat_map(|kind| ["--ignore", kind])
        .collect();
    let args = [&["explore", "all.il", "--scans", "3000"], &ignore[..]].concat();
    assert_eq!(code(folder.path(), &args), 0);
}

#[test]
fn a_run_is_as_short_as_it_can_be() {
    let program =
        "LDP X000\nINC D0\nLDP X001\nMOV K0 D0\nLD>= D0 K8\nOUT Y000\nLD X002\nOUT Y001\nEND\n";
    let folder = folder(&[("presses.il", program.as_bytes())]);
    let args = [
        "explore",
        "presses.il",
        "--never",
        "Y000",
        "--scans",
        "40000",
        "--first",
    ];
    let all = [&args[..], &["--write-test", "p.plctest.toml"]].concat();
    assert_eq!(code(folder.path(), &all), 1);
    let test = fs::read_to_string(folder.path().join("p.plctest.toml")).unwrap();
    let presses = test.matches("X000 = 1").count();
    assert_eq!(presses, 8, "{test}");
    assert!(!test.contains("X001") && !test.contains("X002"), "{test}");
    let threads = |n| {
        let output = rungc(folder.path(), &[&args[..], &["--threads", n]].concat());
        text(&output.stdout)
    };
    assert_eq!(
        threads("1"),
        threads("3"),
        "one search, however many threads"
    );
}

#[test]
fn a_machine_constrains_the_inputs_and_can_break() {
    let program = "LD X000\nANI X011\nOUT Y000\nLD X001\nOUT Y001\nEND\n";
    let machine = "\
[[axis]]
name = \"gate\"
unit = \"mm\"
forward = \"Y000\"
reverse = \"Y001\"
speed = 1000
travel = [0, 100]
forward_limit = \"X011\"
forward_limit_at = 90
";
    let folder = folder(&[
        ("gate.il", program.as_bytes()),
        ("gate.toml", machine.as_bytes()),
    ]);
    let args = [
        "explore",
        "gate.il",
        "--machine",
        "gate.toml",
        "--scans",
        "4000",
    ];
    let all = [&args[..], &["--write-test", "g.plctest.toml"]].concat();
    insta::assert_snapshot!("machine", shown(folder.path(), &all));
    assert_eq!(code(folder.path(), &["test", "g.plctest.toml"]), 1);
    let args = [&args[..], &["--ignore", "collisions", "--never", "X011"]].concat();
    let output = text(&rungc(folder.path(), &args).stdout);
    assert!(
        output.contains("X000 = 1") && !output.contains("X011 = 1,"),
        "{output}"
    );
}

#[test]
fn what_cannot_be_searched_is_reported() {
    let folder = folder(&[
        ("reverser.il", reverser("").as_bytes()),
        ("bad.il", b"LD Q0\n"),
    ]);
    for args in [
        &["explore", "reverser.il", "--never", "Y000 &"][..],
        &["explore", "reverser.il", "--machine", "none.toml"],
        &["explore", "reverser.il", "--threads", "0"],
        &["explore", "bad.il"],
    ] {
        assert_eq!(code(folder.path(), args), 2, "{args:?}");
    }
}

#[test]
fn lanes_print_what_the_interpreter_prints() {
    let sends = "LD X000\nPLSY K100 K50 Y000\nLD X001\nOUT Y001\nEND\n";
    let list = reverser("ANI X003");
    let folder = folder(&[
        ("reverser.il", list.as_bytes()),
        ("sends.il", sends.as_bytes()),
    ]);
    let searched = |engine: &str, threads: &str| {
        let args = [
            "explore",
            "reverser.il",
            "--never",
            "Y000 & Y001",
            "--scans",
            "70000",
            "--engine",
            engine,
            "--threads",
            threads,
        ];
        shown(folder.path(), &args).replacen(engine, "ENGINE", 1)
    };
    let interpreted = searched("interp", "1").replace("--threads 1", "");
    assert_eq!(
        interpreted,
        searched("lanes", "2").replace("--threads 2", "")
    );
    let args = ["explore", "sends.il", "--engine", "lanes"];
    let refused = shown(folder.path(), &args);
    assert!(
        refused.contains("`--engine lanes`: the program sends pulses"),
        "{refused}"
    );
    assert!(refused.ends_with("exit code 2"), "{refused}");
}

/// A latched counter of cycles, a relay that only a power failure clears.
const COUNTED: &str = "\
LD M8002
SET M0
LDP X000
INC D200
RST M0
LD>= D200 K2
AND M0
OUT Y000
END
";

#[test]
fn latched_devices_begin_with_what_was_saved() {
    let folder = folder(&[("counted.il", COUNTED.as_bytes())]);
    let args = |latched| {
        let requested = [
            "explore",
            "counted.il",
            "--model",
            "fx3u",
            "--never",
            "Y000",
        ];
        let rest = ["--scans", "6000", "--latched", latched, "--replay", "c"];
        [
            &requested[..],
            &rest[..],
            &["--write-test", "p.plctest.toml"],
        ]
        .concat()
    };
    let begins_new = shown(folder.path(), &args("zero"));
    assert!(begins_new.contains("Nothing was found."), "{begins_new}");
    insta::assert_snapshot!("saved", shown(folder.path(), &args("saved")));
    let test = fs::read_to_string(folder.path().join("p.plctest.toml")).unwrap();
    assert!(test.contains("power_cycle = true"), "{test}");
    assert_eq!(code(folder.path(), &["test", "p.plctest.toml"]), 1);
    // Sweeps continue from moments after the power has come back, too.
    let searched = |engine| {
        let args = [
            "explore",
            "counted.il",
            "--scans",
            "70000",
            "--latched",
            "saved",
        ];
        let output = rungc(folder.path(), &[&args[..], &["--engine", engine]].concat());
        text(&output.stdout)
    };
    assert_eq!(searched("interp"), searched("lanes"));
}

#[test]
fn what_is_not_varied_is_reported() {
    let list = "\
LD M8000
OUT C235 K100
RS D0 K4 D10 K4
PLSY K100 K50 Y000
FROM K0 K0 D20 K1
LD C235
OUT Y001
END
";
    let folder = folder(&[("around.il", list.as_bytes())]);
    let args = ["explore", "around.il", "--model", "fx3u", "--scans", "2000"];
    insta::assert_snapshot!("not_tried", shown(folder.path(), &args));
}

/// A knife that comes down at a length of 300 pulses, and must not while the clamp is open. `{}`: how it is switched.
fn cutter(switched: &str) -> String {
    format!(
        "\
LD X001          ; feed
OUT C235 K100000 ; length
LD X001
DHSCS K300 C235 {switched}
LDI X001
RST C235
RST Y000
RST M0
END
"
    )
}

const FAULTY: &str = "Y000   ; knife";
const REPAIRED: &str = "M0\nLD M0\nAND X002 ; clamp\nOUT Y000 ; knife";

#[test]
fn faults_that_show_after_many_pulses_are_found() {
    let folder = folder(&[("cutter.il", cutter(FAULTY).as_bytes())]);
    let args = [
        "explore",
        "cutter.il",
        "--model",
        "fx3u",
        "--never",
        "Y000 & !X002",
        "--scans",
        "4000",
        "--replay",
        "all",
        "--write-test",
        "found.plctest.toml",
    ];
    insta::assert_snapshot!("pulses", shown(folder.path(), &args));
    let test = fs::read_to_string(folder.path().join("found.plctest.toml")).unwrap();
    insta::assert_snapshot!("pulses_test_file", test);
    let tested = || {
        code(
            folder.path(),
            &["test", "found.plctest.toml", "--engine", "all"],
        )
    };
    assert_eq!(tested(), 1);
    fs::write(folder.path().join("cutter.il"), cutter(REPAIRED)).unwrap();
    assert_eq!(tested(), 0);
    let nothing = shown(folder.path(), &args[..8]);
    assert!(nothing.contains("Nothing was found."), "{nothing}");
}

/// A slide on an encoder that must not go back beyond its stop.
const SLIDE: &str = "\
LD M8000
OUT C251 K100000
LDD< C251 K-40
OUT Y000
END
";

#[test]
fn encoders_turn_in_both_directions() {
    let folder = folder(&[("slide.il", SLIDE.as_bytes())]);
    let args = ["explore", "slide.il", "--model", "fx3u", "--never", "Y000"];
    let rest = ["--replay", "all", "--write-test", "found.plctest.toml"];
    let args = [&args[..], &["--scans", "4000"], &rest].concat();
    let output = shown(folder.path(), &args);
    assert!(output.contains("cycles of X000 and X001 = -41"), "{output}");
    let test = fs::read_to_string(folder.path().join("found.plctest.toml")).unwrap();
    let step = "encoder = { a = \"X000\", b = \"X001\", count = -41, hz = 5000 }";
    assert!(test.contains(step), "{test}");
    assert_eq!(code(folder.path(), &["test", "found.plctest.toml"]), 1);
}

/// Texts of TOML are UTF-8: what names such a program could not be read back.
#[cfg(target_os = "linux")]
#[test]
fn programs_that_no_test_file_can_name_are_rejected() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = folder(&[]);
    let name = OsStr::from_bytes(b"\xB5\xE7.il");
    std::fs::write(folder.path().join(name), "LD X0\nOUT Y0\nEND\n").unwrap();
    let write = ["--write-test", "t.plctest.toml"];
    for args in [
        vec!["init", "."],
        vec!["explore", ".", "--for", "100ms"],
        [&["verify", ".", "--never", "Y0"][..], &write].concat(),
        [&["run", ".", "--for", "100ms"][..], &write].concat(),
    ] {
        let output = rungc(folder.path(), &args);
        let messages = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {messages}");
        let why = "cannot name it; rename it";
        assert!(messages.contains(why), "{args:?}: {messages}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
