//! The conformance cases and what is expected of them.

use rungc_golden::part::Part;
use rungc_ir::Module;
use rungc_sim::engines::Engine;
use rungc_sim::plctest::{self, Case, Outcome, Suite, TestFile};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Folders of conformance files.
const PARTS: [&str; 8] = [
    "fx1n", "fx1s", "fx2n", "fx3s", "fx3u", "h1u-h2u", "hm", "l01s",
];

/// The list of disputed cases.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    #[serde(default)]
    disputed: Vec<Disputed>,
}

/// Cases of a file that contradict the manual, and why.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Disputed {
    file: String,
    cases: Vec<String>,
    why: String,
}

fn folder() -> PathBuf {
    Path::new(env!("RUNGC_ROOT")).join("golden/conformance")
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

/// Files of cases that the last commit or the working tree changes, as far as Git knows.
fn changed() -> BTreeSet<String> {
    let output = Command::new("git")
        .args(["diff", "--name-only", "--relative", "HEAD~1", "--", "."])
        .current_dir(folder())
        .output();
    let Ok(output) = output else {
        return BTreeSet::new();
    };
    let paths = String::from_utf8_lossy(&output.stdout);
    paths.lines().map(str::to_string).collect()
}

/// Reduces files to the cases of a part; files that were changed keep all.
fn take(part: &Part, files: &mut Vec<TestFile>) {
    let count = |files: &[TestFile]| files.iter().map(|file| file.cases.len()).sum::<usize>();
    let all = count(files);
    let changed = changed();
    for file in files
        .iter_mut()
        .filter(|file| !changed.contains(&file.name))
    {
        let name = &file.name;
        file.cases
            .retain(|case| part.contains(&format!("{name}: {}", case.name)));
    }
    files.retain(|file| !file.cases.is_empty());
    println!(
        "{part}, and all of changed files: {} of {all}",
        count(files)
    );
}

/// Reasons why cases are disputed, by file and name.
type Reasons = BTreeMap<(String, String), String>;

fn disputed() -> Reasons {
    let text = std::fs::read_to_string(folder().join("DISPUTED.toml")).unwrap();
    let list: List = toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"));
    let mut reasons = BTreeMap::new();
    for Disputed { file, cases, why } in list.disputed {
        for case in cases {
            let twice = reasons.insert((file.clone(), case.clone()), why.clone());
            assert!(twice.is_none(), "{file}: {case} is listed twice");
        }
    }
    reasons
}

fn key(suite: &Suite, outcome: &Outcome) -> (String, String) {
    let file = &suite.files()[outcome.id.file];
    (file.name.clone(), file.cases[outcome.id.case].name.clone())
}

/// All cases, and which of them are disputed.
pub struct Conformance {
    suite: Suite,
    disputed: Reasons,
}

impl Conformance {
    /// Reads and compiles all cases.
    pub fn all() -> Self {
        Self::load(&Part::ALL, usize::MAX).remove(0)
    }

    /// Reads and compiles those of a part, in batches of whole files with at most this many cases, unless a file alone
    /// has more.
    pub fn load(part: &Part, most: usize) -> Vec<Self> {
        let mut files = load_all();
        let disputed = disputed();
        let cases = files.iter().flat_map(|file| {
            let named = |case: &Case| (file.name.clone(), case.name.clone());
            file.cases.iter().map(named)
        });
        let names: BTreeSet<_> = cases.collect();
        for key @ (file, case) in disputed.keys() {
            assert!(
                names.contains(key),
                "{file}: {case} is listed, but there is no such case"
            );
        }
        if !part.is_all() {
            take(part, &mut files);
        }
        let mut batches: Vec<Vec<TestFile>> = Vec::new();
        let mut room = 0;
        for file in files {
            let cases = file.cases.len();
            if cases > room {
                batches.push(Vec::new());
                room = most;
            }
            room = room.saturating_sub(cases);
            batches.last_mut().unwrap().push(file);
        }
        let batch = |files| Conformance {
            suite: Suite::compile(files, &[]),
            disputed: disputed.clone(),
        };
        batches.into_iter().map(batch).collect()
    }

    /// Those with a program for which this is true.
    pub fn of(is_taken: impl Fn(&Module) -> bool) -> Self {
        let all = Self::all();
        let modules = all.suite.modules();
        let cases = all.suite.cases();
        let taken = cases.filter(|(id, _)| {
            let mut modules_of = all.suite.modules_of(*id).iter();
            modules_of.any(|&module| is_taken(&modules[module]))
        });
        let taken: BTreeSet<_> = taken.map(|(id, _)| (id.file, id.case)).collect();
        let files = all.suite.files().iter().cloned();
        let files = (0..).zip(files).map(|(file, mut contents)| {
            let mut case = 0;
            contents.cases.retain(|_| {
                case += 1;
                taken.contains(&(file, case - 1))
            });
            contents
        });
        let files = files.filter(|file| !file.cases.is_empty()).collect();
        Conformance {
            suite: Suite::compile(files, &[]),
            disputed: all.disputed,
        }
    }

    /// The compiled programs.
    pub fn modules(&self) -> &[Module] {
        self.suite.modules()
    }

    /// Deviations of an engine from the expectation.
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
            let disputed = self.disputed.get(&key(&self.suite, outcome));
            match (&outcome.failure, disputed) {
                (Some(_), None) => wrong.push(described),
                (None, Some(why)) => {
                    wrong.push(format!("{described}, but is listed as disputed: {why}"));
                }
                (Some(_), Some(_)) => println!("disputed: {described}"),
                (None, None) => {}
            }
        }
        wrong
    }
}
