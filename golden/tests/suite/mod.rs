//! The conformance cases and what is expected of them.

use rungc_ir::Module;
use rungc_sim::engines::Engine;
use rungc_sim::plctest::{self, Outcome, Suite, TestFile};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Folders of conformance files.
const PARTS: [&str; 8] = [
    "fx1n", "fx1s", "fx2n", "fx3s", "fx3u", "h1u-h2u", "hm", "l01s",
];

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
    /// The engines on which they do not pass; by default all.
    engines: Option<Vec<String>>,
    /// Names of cases by file.
    cases: BTreeMap<String, Vec<String>>,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance")
}

/// All cases.
fn load_all() -> Vec<TestFile> {
    let mut paths = Vec::new();
    for part in PARTS {
        let entries = std::fs::read_dir(folder().join(part)).unwrap();
        paths.extend(entries.map(|entry| entry.unwrap().path()));
    }
    paths.sort();
    let load = |path: &PathBuf| {
        let mut file = plctest::load(path).unwrap_or_else(|e| panic!("{e}"));
        // The name without the folder of this repository.
        let short = path.strip_prefix(folder()).unwrap_or(path);
        file.name = short.display().to_string();
        file
    };
    paths.iter().map(load).collect()
}

/// Which cases fail: why, and on which engines.
type Failures = BTreeMap<(String, String), (String, Option<Vec<String>>)>;

fn expected_failures() -> Failures {
    let text = std::fs::read_to_string(folder().join("EXPECTED_FAILURES.toml")).unwrap();
    let expected: Expected = toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"));
    let mut failures = BTreeMap::new();
    for reason in expected.reason {
        for (file, cases) in reason.cases {
            for case in cases {
                let reason = (reason.why.clone(), reason.engines.clone());
                let twice = failures.insert((file.clone(), case.clone()), reason);
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

/// All cases, and which of them do not pass.
pub struct Conformance {
    suite: Suite,
    expected: Failures,
}

impl Conformance {
    /// Reads and compiles them.
    pub fn load() -> Self {
        let suite = Suite::compile(load_all(), &[]);
        let expected = expected_failures();
        let cases = suite.cases();
        let names: BTreeSet<_> = cases
            .map(|(id, case)| (suite.files()[id.file].name.clone(), case.name.clone()))
            .collect();
        for key @ (file, case) in expected.keys() {
            assert!(
                names.contains(key),
                "{file}: {case} is listed, but there is no such case"
            );
        }
        Conformance { suite, expected }
    }

    /// The compiled programs.
    pub fn modules(&self) -> &[Module] {
        self.suite.modules()
    }

    /// What goes otherwise than expected on an engine.
    pub fn run(&self, engine: &mut dyn Engine) -> Vec<String> {
        let mut wrong = Vec::new();
        let report = plctest::run(&self.suite, engine, &mut |_| ControlFlow::Continue(()));
        println!(
            "{}: {} of {} pass",
            engine.name(),
            report.passed(),
            self.suite.len()
        );
        for outcome in &report.outcomes {
            let described = outcome.describe(&self.suite);
            let listed = self.expected.get(&key(&self.suite, outcome));
            let fails = |engines: &Vec<String>| {
                let name = engine.name();
                engines.iter().any(|engine| name.starts_with(engine))
            };
            let why = listed
                .filter(|(_, engines)| engines.as_ref().is_none_or(fails))
                .map(|(why, _)| why);
            match (&outcome.failure, why) {
                (Some(_), None) => wrong.push(described),
                (None, Some(why)) => wrong.push(format!(
                    "{described}, but is listed as one that fails: {why}"
                )),
                (Some(_), Some(why)) => println!("{why}: {described}"),
                (None, None) => {}
            }
        }
        wrong
    }
}
