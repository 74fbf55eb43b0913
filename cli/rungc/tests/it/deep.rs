//! Findings of `rungc check --deep` on the programs in `golden/warnings/deep`: each is labelled there, right or false,
//! with the reason. A finding without a label, a right one that is missing and a false one that is back fail the test.

use crate::common::{rungc, text};
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The labels.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Labels {
    finding: Vec<Label>,
}

/// What is known of a finding.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Label {
    /// The program, from the folder of the labels.
    program: String,
    /// Line and its text.
    place: String,
    code: String,
    verdict: Verdict,
    reason: String,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Eq, Debug)]
#[serde(rename_all = "lowercase")]
enum Verdict {
    /// It is given, and should be.
    Right,
    /// It is not given, and was once, or follows from another one.
    False,
}

/// A finding: program, place, code.
type Given = (String, String, String);

/// The findings on the programs in a folder and below.
fn findings(folder: &Path) -> BTreeSet<Given> {
    let output = rungc(folder, &["check", "--deep", ".", "--format", "json"]);
    let found: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|e| panic!("{e}: {}", text(&output.stderr)));
    let mut given = BTreeSet::new();
    for file in found["files"].as_array().expect("files") {
        let path = Path::new(file["file"].as_str().expect("a path"));
        let program = path.strip_prefix(".").unwrap_or(path);
        let lines = fs::read_to_string(folder.join(program)).expect("a program");
        let diagnostics = file["diagnostics"].as_array().expect("diagnostics");
        for finding in diagnostics {
            let code = finding["code"].as_str().expect("a code");
            if code.starts_with("W09") {
                let line = finding["line"].as_u64().expect("a line") as usize;
                let place = format!("{line} {}", lines.lines().nth(line - 1).unwrap_or_default());
                let program = program.to_string_lossy().replace('\\', "/");
                given.insert((program, place, code.to_owned()));
            }
        }
    }
    given
}

#[test]
fn every_deep_finding_is_labelled_and_right() {
    let folder = Path::new(env!("RUNGC_ROOT")).join("golden/warnings/deep");
    let labels = fs::read_to_string(folder.join("labels.toml")).expect("labels");
    let labels: Labels = toml::from_str(&labels).expect("labels");
    let given = findings(&folder);
    let mut known = BTreeMap::new();
    let mut wrong = Vec::new();
    for label in labels.finding {
        let lines = fs::read_to_string(folder.join(&label.program)).expect(&label.program);
        let mut places = lines.lines().zip(1..);
        if !places.any(|(line, n)| format!("{n} {line}") == label.place) {
            wrong.push(format!("{} has no line {:?}", label.program, label.place));
        }
        let key = (label.program, label.place, label.code);
        let is_given = given.contains(&key);
        if label.reason.is_empty() || known.insert(key.clone(), label.verdict).is_some() {
            wrong.push(format!("{key:?} has no reason, or two labels"));
        }
        match (label.verdict, is_given) {
            (Verdict::Right, true) | (Verdict::False, false) => {}
            (Verdict::Right, false) => wrong.push(format!("{key:?} is right and missing")),
            (Verdict::False, true) => wrong.push(format!("{key:?} is false: {}", label.reason)),
        }
    }
    let new = given.iter().filter(|key| !known.contains_key(*key));
    wrong.extend(new.map(|key| format!("{key:?} has no label")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
