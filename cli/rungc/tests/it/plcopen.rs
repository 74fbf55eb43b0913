//! `convert --to plcopen`: the output, the messages about it, and the list it reads back to.

use crate::common::{MOTOR, code, folder, rungc, shown, text};
use std::fs;
use std::path::Path;

/// Programs of the writer's own tests.
const DOORS: &[u8] = include_bytes!(concat!(
    env!("RUNGC_ROOT"),
    "/language/export/tests/lists/doors.il"
));
const ODD: &[u8] = include_bytes!(concat!(
    env!("RUNGC_ROOT"),
    "/language/export/tests/lists/odd.il"
));
const STEPS: &[u8] = include_bytes!(concat!(
    env!("RUNGC_ROOT"),
    "/language/export/tests/lists/steps.il"
));

/// The instructions of a program, without comments and steps.
fn instructions(folder: &Path, file: &str) -> Vec<String> {
    let output = rungc(folder, &["convert", file, "--to", "il"]);
    let list = text(&output.stdout);
    assert!(!list.is_empty(), "{file}: {}", text(&output.stderr));
    let lines = list.lines().map(|line| {
        let line = line.split(';').next().unwrap_or_default();
        line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ')
            .trim()
    });
    lines
        .filter(|line| !line.is_empty())
        .map(str::to_owned)
        .collect()
}

#[test]
fn a_program_becomes_a_ladder() {
    let list = format!(";! title = Press\n;! cpu = FX2N/FX2NC\n;! X000 = start\n; Run-up\n{MOTOR}");
    let folder = folder(&[("motor.il", list.as_bytes())]);
    let path = folder.path();
    let written = rungc(path, &["convert", "motor.il", "--to", "plcopen"]);
    let omitted = "4 notes omitted, because PLCopen XML cannot store them; `--to il` keeps them";
    assert_eq!(text(&written.stderr), format!("rungc: {omitted}\n"));
    insta::assert_snapshot!("plcopen_motor", text(&written.stdout));
    fs::write(path.join("motor.xml"), &written.stdout).unwrap();
    let back = text(&rungc(path, &["convert", "motor.xml", "--to", "il"]).stdout);
    let expected = ";! title = Press\n;! cpu = FX2N/FX2NC\n;! X000 = start\n; Run-up\n";
    assert!(back.starts_with(expected), "{back}");
}

/// PLCopen XML has comments above networks, not inside.
#[test]
fn statements_that_move_are_counted() {
    let list = "; first\nLD X0\n; inside\nOUT Y0\n; second\n; line\nLD X1\nMPS\nAND X2\nOUT Y1\n\
        ; branch\nMPP\nOUT Y2\n; end\nEND\n";
    let one = "LD X0\n; inside\nOUT Y0\nEND\n";
    let none = "; first\nLD X0\nOUT Y0\n; end\nEND\n";
    let folder = folder(&[
        ("two.il", list.as_bytes()),
        ("one.il", one.as_bytes()),
        ("none.il", none.as_bytes()),
    ]);
    for body in ["ld", "il"] {
        let convert = |name: &str, to: &str| {
            let args = ["convert", name, "--to", to, "--body", body];
            let args = if to == "plcopen" {
                &args[..]
            } else {
                &args[..4]
            };
            text(&rungc(folder.path(), args).stderr)
        };
        let why = "because PLCopen XML has no place inside";
        assert_eq!(
            convert("two.il", "plcopen"),
            format!(
                "rungc: 2 statement lines move to the start of their networks, {why}; `--to il` keeps them there\n"
            )
        );
        assert_eq!(
            convert("one.il", "plcopen"),
            format!(
                "rungc: 1 statement line moves to the start of its network, {why}; `--to il` keeps it there\n"
            )
        );
        assert_eq!(convert("none.il", "plcopen"), "");
        assert_eq!(convert("two.il", "csv"), "");
    }
}

#[test]
fn a_program_becomes_a_list_of_the_standard() {
    let folder = folder(&[("doors.il", DOORS)]);
    let path = folder.path();
    let args = ["convert", "doors.il", "--to", "plcopen", "--body", "il"];
    insta::assert_snapshot!("plcopen_list", shown(path, &args));
    let written = rungc(path, &[&args[..], &["-o", "plc.xml"]].concat());
    assert!(written.status.success());
    assert_eq!(
        instructions(path, "plc.xml"),
        instructions(path, "doors.il")
    );
    let back = text(&rungc(path, &["convert", "plc.xml", "--to", "il"]).stdout);
    assert!(
        back.starts_with("; Doors\n; of the lift\nLD X000\n"),
        "{back}"
    );
    assert_eq!(
        code(path, &["convert", "doors.il", "--to", "il", "--body", "il"]),
        2
    );
}

#[test]
fn what_other_editors_do_not_know_is_reported() {
    let folder = folder(&[
        ("odd.il", ODD),
        ("form.il", b"LD X000\nLD X001\nANB\nOUT Y000\nEND\n"),
        ("broken.il", b"LD X000\nOUT Y000\nORB\nOUT Y001\nEND\n"),
    ]);
    let path = folder.path();
    let convert = |file: &'static str| {
        [
            "convert", file, "--to", "plcopen", "-o", "plc.xml", "--force",
        ]
    };
    insta::assert_snapshot!("plcopen_odd", shown(path, &convert("odd.il")));
    assert_eq!(instructions(path, "plc.xml"), instructions(path, "odd.il"));
    assert_eq!(
        code(path, &[&convert("odd.il")[..], &["--body", "il"]].concat()),
        0
    );
    assert_eq!(instructions(path, "plc.xml"), instructions(path, "odd.il"));
    insta::assert_snapshot!("plcopen_form", shown(path, &convert("form.il")));
    assert_eq!(
        instructions(path, "plc.xml"),
        ["LD X000", "AND X001", "OUT Y000", "END"]
    );
    fs::remove_file(path.join("plc.xml")).unwrap();
    insta::assert_snapshot!("plcopen_undrawn", shown(path, &convert("broken.il")));
    assert!(!path.join("plc.xml").exists());
    assert_eq!(code(path, &["explain", "E0740"]), 0);
}

#[test]
fn what_a_chart_cannot_say_names_the_state() {
    let cases = [
        "LD X000\nOUT Y000\nEND\n",
        "LD X000\nSET S0\nSTL S0\nOUT Y000\nRET\nEND\n",
        "LD M8002\nSET S0\nLD X000\nZRST S0 S20\nSTL S0\nOUT Y000\nRET\nEND\n",
        "LD M8002\nSET S0\nSTL S0\nLD X000\nSET S20\nSTL S20\nOUT Y000\nRET\nLD S20\nOUT Y001\nEND\n",
        "LD M8002\nSET S0\nSTL S0\nLD X000\nRST S0\nRET\nEND\n",
        "LD M8002\nSET S0\nSTL S0\nLD X000\nCJ P0\nRET\nP0\nEND\n",
        "LD M8002\nSET S0\nSTL S0\nOUT Y000\nLD X000\nSET S20\nSTL S20\nSET Y000\nLD X001\nOUT S0\nRET\nEND\n",
    ];
    let messages = cases.map(|list| {
        let folder = folder(&[("steps.il", list.as_bytes())]);
        let args = ["convert", "steps.il", "--to", "plcopen", "--body", "sfc"];
        assert_eq!(code(folder.path(), &args), 1, "{list}");
        shown(folder.path(), &args)
    });
    insta::assert_snapshot!("plcopen_chart_refused", messages.join("\n"));
}

#[test]
fn a_step_ladder_becomes_a_chart() {
    let folder = folder(&[("steps.il", STEPS)]);
    let path = folder.path();
    let args = ["convert", "steps.il", "--to", "plcopen", "--body", "sfc"];
    insta::assert_snapshot!("plcopen_chart", shown(path, &args));
    let names = "*,M500-M599\n";
    fs::write(path.join("free.csv"), names).unwrap();
    assert_eq!(code(path, &[&args[..], &["-o", "chart.xml"]].concat()), 0);
    let back = ["convert", "chart.xml", "--names", "free.csv", "--to", "il"];
    insta::assert_snapshot!("plcopen_chart_back", shown(path, &back));
}
