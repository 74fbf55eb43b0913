//! The page of `rungc view` in headless Chromium, driven by playwright and checked for accessibility by axe.
//! `RUNGC_BROWSER` names a folder with playwright-core and axe-core; Chromium is Debian's. Without them the test says
//! so and does not run.

mod common;

use common::{folder, rungc, text};
use serde_json::{Value, json};
use std::env;
use std::path::Path;
use std::process::Command;

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

#[test]
fn a_page_works_in_a_browser() {
    let Some(modules) = env::var_os("RUNGC_BROWSER") else {
        eprintln!(
            "skipped: RUNGC_BROWSER names no folder with playwright-core and axe-core (see .ci/run)"
        );
        return;
    };
    let folder = folder(&[("motor.il", PROGRAM.as_bytes())]);
    let out = rungc(folder.path(), &["view", "motor.il", "-o", "motor.html"]);
    assert!(out.status.success(), "{}", text(&out.stderr));
    let page = folder.path().canonicalize().unwrap().join("motor.html");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients/page.js");
    let mut command = Command::new("node");
    command
        .env("NODE_PATH", modules)
        .arg(script)
        .arg(format!("file://{}", page.display()));
    if let Some(pictures) = env::var_os("RUNGC_PICTURES") {
        command.arg(pictures);
    }
    let out = command.output().unwrap();
    assert!(out.status.success(), "{}", text(&out.stderr));
    let mut report: Value = serde_json::from_slice(&out.stdout).unwrap();
    let loaded = report["loaded_ms"].take();
    assert!(loaded.as_u64().is_some_and(|ms| ms < 10_000), "{loaded}");
    let expected = json!({
        "loaded_ms": null,
        "networks": 4,
        "light": [],
        "found": 1,
        "all": 4,
        "marked": 3,
        "row": "M0\t\t1 2",
        "hint": "Y000: main contactor of the conveyor",
        "theme": "dark",
        "dark": [],
        "printed_list": false,
        "pages": 2,
        "requests": [],
        "errors": [],
    });
    assert_eq!(report, expected);
}
