//! Runs that `rungc explore` finds, and the tests that it writes of them.

mod common;

use common::{code, folder, rungc, shown, text};
use std::fs;

/// Both contactors close with both buttons: the second rung lacks `ANI Y000`.
const REVERSER: &str = "\
;! Y000 = forward contactor
;! Y001 = reverse contactor
LD X000
OR Y000
ANI X002
ANI Y001
OUT Y000
LD X001
OR Y001
ANI X002
OUT Y001
END
";

const INTERLOCKED: &str = "\
LD X000
OR Y000
ANI X002
ANI Y001
OUT Y000
LD X001
OR Y001
ANI X002
ANI Y000
OUT Y001
END
";

#[test]
fn a_violation_is_found_and_its_test_fails_until_it_is_repaired() {
    let folder = folder(&[("reverser.il", REVERSER.as_bytes())]);
    let args = [
        "explore",
        "reverser.il",
        "--never",
        "Y000 & Y001",
        "--scans",
        "3000",
        "--replay",
        "c",
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
    let kept: Vec<&str> = args
        .iter()
        .copied()
        .filter(|arg| !["--replay", "c"].contains(arg))
        .collect();
    let again = shown(folder.path(), &kept);
    assert!(again.contains("exists"), "an existing test stays: {again}");
    fs::write(folder.path().join("reverser.il"), INTERLOCKED).unwrap();
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
fn what_cannot_be_searched_is_said() {
    let folder = folder(&[("reverser.il", REVERSER.as_bytes()), ("bad.il", b"LD Q0\n")]);
    for args in [
        &["explore", "reverser.il", "--never", "Y000 &"][..],
        &["explore", "reverser.il", "--machine", "none.toml"],
        &["explore", "reverser.il", "--threads", "0"],
        &["explore", "bad.il"],
    ] {
        assert_eq!(code(folder.path(), args), 2, "{args:?}");
    }
}
