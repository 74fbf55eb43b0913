//! Pages in headless Chromium, driven by playwright and checked for accessibility by axe. `RUNGC_BROWSER` names a
//! folder with playwright-core and axe-core; Chromium is Debian's. Without them the tests say so and do not run.

use super::text;
use serde_json::Value;
use std::env;
use std::path::Path;
use std::process::Command;

/// Report of a script of `clients` about a page; `None` without a browser. `RUNGC_PICTURES` names a folder for pictures
/// of the page.
pub fn report(url: &str, script: &str) -> Option<Value> {
    let Some(modules) = env::var_os("RUNGC_BROWSER") else {
        eprintln!(
            "skipped: RUNGC_BROWSER names no folder with playwright-core and axe-core (see .ci/run)"
        );
        return None;
    };
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients");
    let mut command = Command::new("node");
    command
        .env("NODE_PATH", modules)
        .arg(scripts.join(script))
        .arg(url);
    if let Some(pictures) = env::var_os("RUNGC_PICTURES") {
        command.arg(pictures);
    }
    let out = command.output().unwrap();
    assert!(out.status.success(), "{}", text(&out.stderr));
    Some(serde_json::from_slice(&out.stdout).unwrap())
}
