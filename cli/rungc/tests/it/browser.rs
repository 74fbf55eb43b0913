//! The pages of `rungc view` and `rungc diff` in headless Chromium (`common/chromium.rs`).

use crate::common::{chromium, folder, rungc, text};
use serde_json::{Value, json};

const STEPS: &str = "\
;! S0 = wait
;! S20 = lift
LD M8002
SET S0
STL S0
LD X000
SET S20
STL S20
OUT Y000
LD X001
OUT S0
RET
END
";

const PROGRAM: &str = "\
;! X000 = start button
;! X001 = stop button
;! Y000 = main contactor of the conveyor
; Latch of the motor
LD X000
OR M0
ANI X001
OUT M0
; Run-up
LD M0
OUT T0 K30
AND T0
OUT Y000
LD X002
MOV K5 D0
END
";

/// Report of a script about a page that rungc makes from files; `None` without a browser.
fn report(files: &[(&str, &[u8])], args: &[&str], page: &str, script: &str) -> Option<Value> {
    let folder = folder(files);
    let out = rungc(folder.path(), args);
    assert!(out.status.code() < Some(2), "{}", text(&out.stderr));
    let page = folder.path().canonicalize().unwrap().join(page);
    let mut report = chromium::report(&format!("file://{}", page.display()), script)?;
    // Benchmarks measure it.
    report["loaded_ms"].take();
    Some(report)
}

#[test]
fn a_page_works_in_a_browser() {
    let files: &[(&str, &[u8])] = &[("motor.il", PROGRAM.as_bytes())];
    let args = ["view", "motor.il", "-o", "motor.html"];
    let Some(report) = report(files, &args, "motor.html", "page.js") else {
        return;
    };
    let expected = json!({
        "loaded_ms": null,
        "networks": 4,
        "light": [],
        "found": 1,
        "all": 4,
        "marked": 3,
        "row": "M0\t\t1 2",
        "hint": "Y000: main contactor of the conveyor",
        "states": [],
        "theme": "dark",
        "dark": [],
        "printed_list": false,
        "pages": 2,
        "requests": [],
        "errors": [],
    });
    assert_eq!(report, expected);
}

#[test]
fn a_page_of_a_step_ladder_has_its_chart_and_states() {
    let list = format!("{STEPS}{PROGRAM}");
    let files: &[(&str, &[u8])] = &[("lift.il", list.as_bytes())];
    let args = ["view", "lift.il", "-o", "lift.html"];
    let Some(report) = report(files, &args, "lift.html", "page.js") else {
        return;
    };
    let states = ["Chart", "S0 wait", "S20 lift"];
    assert_eq!(report["states"], json!(states));
    assert_eq!([&report["state"], &report["first_state"]], ["#n4", "#n2"]);
    for none in ["light", "dark", "requests", "errors"] {
        assert_eq!(report[none], json!([]), "{none}");
    }
    assert_eq!(report["pages"], 3);
}

#[test]
fn a_comparison_works_in_a_browser() {
    let new = PROGRAM
        .replace("ANI X001", "ANI X002")
        .replace("start button", "start")
        .replace("END", "LD X5\nOUT Y5\nEND");
    let files: &[(&str, &[u8])] = &[("old.il", PROGRAM.as_bytes()), ("new.il", new.as_bytes())];
    let args = [
        "diff",
        "old.il",
        "new.il",
        "--format",
        "html",
        "-o",
        "diff.html",
    ];
    let Some(report) = report(files, &args, "diff.html", "comparison.js") else {
        return;
    };
    let expected = json!({
        "loaded_ms": null,
        "titles": ["Network 1 changed", "Network 4 added", "Device comments"],
        "light": [],
        "skip": "Skip to the networks",
        "skipped_to": "#ladder",
        "network": "#c1",
        "seen": true,
        "paper": "rgb(13, 17, 23)",
        "dark": [],
        "narrow": [],
        "wider_than_screen": false,
        "pages": 1,
        "requests": [],
        "errors": [],
    });
    assert_eq!(report, expected);
}

#[test]
fn a_report_works_in_a_browser() {
    let program = "LD X000\nOR Y000\nANI X001\nOUT Y000\nEND\n";
    let settings = "[project]\nprogram = \"motor.il\"\n[test]\nfiles = [\"t.plctest.toml\"]\n[[property]]\nid = \"R1\"\n\
                    text = \"Stop stops.\"\nnever = \"X001 & Y000\"\n[[property]]\nid = \"R2\"\ntext = \"It stops by itself.\"\n\
                    stays = \"Y000\"\nuntil = \"!X000\"\n[[property]]\nid = \"R2\"\nnever = \"Y000 & !X000\"\n";
    let tests = "topic = \"t\"\nprogram = { file = \"motor.il\" }\n[[case]]\nname = \"a\"\nrequirement = \"R1\"\n\
                 [[case.step]]\nset = { X000 = 1 }\nexpect = { Y000 = 1 }\n";
    let files: &[(&str, &[u8])] = &[
        ("motor.il", program.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
        ("t.plctest.toml", tests.as_bytes()),
    ];
    let args = ["verify", "--replay", "interp", "--report", "report.html"];
    let Some(report) = report(files, &args, "report.html", "report.js") else {
        return;
    };
    let expected = json!({
        "loaded_ms": null,
        "titles": ["Requirements", "What is missing", "Assumptions", "Program and settings", "R1", "R2", "Tests"],
        "matrix": [
            "R1\tStop stops.\tproved\t1 passed\t4 of 9 (44 %)\tnot run",
            "R2\tIt stops by itself.\t2 violated\tno test\tno test\tno test",
        ],
        "light": [],
        "diagrams": 2,
        "networks": [
            "Network 1 after the last scan; thick: power",
            "Network 1 after the last scan; thick: power",
        ],
        "power": "rgb(10, 110, 44)",
        "followed": "#r2",
        "dark": [],
        "narrow": [],
        "wider": false,
        "pages": 3,
        "requests": [],
        "errors": [],
    });
    assert_eq!(report, expected);
}

#[test]
fn coverage_is_drawn_on_the_ladder() {
    let tests = "model = \"fx3u\"\ntopic = \"t\"\nprogram = \"motor.il\"\n[[case]]\nname = \"a\"\n[[case.step]]\nset = { X000 = 1 }\nrun_ms = 200\n\
        [[case]]\nname = \"b\"\nprogram = \"steps.il\"\n[[case.step]]\nscans = 2\n";
    let files: &[(&str, &[u8])] = &[
        ("motor.il", PROGRAM.as_bytes()),
        ("steps.il", STEPS.as_bytes()),
        ("t.plctest.toml", tests.as_bytes()),
    ];
    let args = ["test", ".", "--coverage", "html", "-o", "coverage.html"];
    let Some(report) = report(files, &args, "coverage.html", "coverage.js") else {
        return;
    };
    for none in ["light", "dark", "narrow", "requests", "errors"] {
        assert_eq!(report[none], json!([]), "{none}");
    }
    insta::assert_snapshot!(
        serde_json::to_string_pretty(&json!({
            "titles": report["titles"],
            "sections": report["sections"],
            "colours": report["colours"],
            "missed": report["missed"],
        }))
        .unwrap(),
        @r#"
    {
      "colours": [
        "rgb(26, 127, 55)",
        "rgb(154, 91, 0)",
        "rgb(179, 38, 30)"
      ],
      "missed": [
        "LD X000 never decided while it did not conduct",
        "OR M0 never decided while it conducted",
        "OR M0 never decided while it did not conduct",
        "ANI X001 never decided while it did not conduct",
        "OUT M0 was never off",
        "LD M0 never decided while it did not conduct",
        "OUT T0 K30 was never off",
        "OUT T0 K30 never expired",
        "AND T0 never decided while it conducted",
        "OUT Y000 was never on",
        "LD X002 never decided while it conducted",
        "MOV K5 D0 was never on",
        "LD X000 never decided while it conducted",
        "SET S20 was never taken",
        "OUT Y000 was never on",
        "OUT Y000 was never off",
        "LD X001 was never executed"
      ],
      "sections": 12,
      "titles": [
        "motor.il: 12 of 24 (50 %)",
        "steps.il: 8 of 16 (50 %)"
      ]
    }
    "#
    );
}
