//! Every conformance case on every engine.
//!
//! A case that does not pass must be listed in `conformance/EXPECTED_FAILURES.toml` with the reason, and a listed case that
//! passes must be taken from the list.

use rungc_sim::engines::{EngineKind, build};
use rungc_sim::plctest::{self, Outcome, Suite, TestFile};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Folders of conformance files.
const PARTS: [&str; 5] = ["fx2n", "fx3u", "h1u-h2u", "hm", "l01s"];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Expected {
    reason: Vec<Reason>,
}

/// Cases that do not pass, and why.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reason {
    why: String,
    /// Names of cases by file.
    cases: BTreeMap<String, Vec<String>>,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance")
}

fn load_all() -> Vec<TestFile> {
    let mut paths = Vec::new();
    for part in PARTS {
        let entries = std::fs::read_dir(folder().join(part)).unwrap();
        paths.extend(entries.map(|entry| entry.unwrap().path()));
    }
    paths.sort();
    let load = |path: &PathBuf| {
        let mut file = plctest::load(path).unwrap_or_else(|e| panic!("{e}"));
        // The name without the folder that this repository stands in.
        let short = path.strip_prefix(folder()).unwrap_or(path);
        file.name = short.display().to_string();
        file
    };
    paths.iter().map(load).collect()
}

fn expected_failures() -> BTreeMap<(String, String), String> {
    let text = std::fs::read_to_string(folder().join("EXPECTED_FAILURES.toml")).unwrap();
    let expected: Expected = toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"));
    let mut failures = BTreeMap::new();
    for reason in expected.reason {
        for (file, cases) in reason.cases {
            for case in cases {
                let twice = failures.insert((file.clone(), case.clone()), reason.why.clone());
                assert!(twice.is_none(), "{file}: {case} is listed twice");
            }
        }
    }
    failures
}

fn key(suite: &Suite, outcome: &Outcome) -> (String, String) {
    let file = &suite.files()[outcome.id.file];
    (file.name.clone(), file.cases[outcome.id.case].name.clone())
}

#[test]
fn all_engines_pass_all_cases() {
    let suite = Suite::compile(load_all());
    let expected = expected_failures();
    let mut wrong = Vec::new();
    let names: BTreeSet<_> = suite
        .cases()
        .map(|(id, case)| (suite.files()[id.file].name.clone(), case.name.clone()))
        .collect();
    for (file, case) in expected.keys() {
        if !names.contains(&(file.clone(), case.clone())) {
            wrong.push(format!(
                "{file}: {case} is listed, but there is no such case"
            ));
        }
    }
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("conformance");
    for kind in EngineKind::ALL {
        let mut engine =
            build(kind, suite.modules(), &target).unwrap_or_else(|error| panic!("{error}"));
        let report = plctest::run(&suite, &mut *engine, &mut |_| ());
        println!(
            "{}: {} of {} pass",
            kind.name(),
            report.passed(),
            suite.len()
        );
        for outcome in &report.outcomes {
            let (file, case) = key(&suite, outcome);
            match (&outcome.failure, expected.get(&(file, case))) {
                (Some(_), None) => wrong.push(outcome.describe(&suite)),
                (None, Some(why)) => wrong.push(format!(
                    "{}, but is listed as one that fails: {why}",
                    outcome.describe(&suite)
                )),
                (Some(_), Some(why)) => println!("{why}: {}", outcome.describe(&suite)),
                (None, None) => {}
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{} cases went otherwise than expected:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}
