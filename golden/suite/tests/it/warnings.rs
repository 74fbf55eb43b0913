//! Warnings of `check` on programs that people wrote: each is labelled in `golden/warnings`, right or false, with the
//! reason. A warning without a label, a right one that is missing and a false one that is back fail the test.
//!
//! Programs beside this repository are not part of it; without them their labels are not looked at.

use rungc_frontend::{ReadOptions, is_project, programs};
use rungc_lower::compile::{self, CompileOptions};
use rungc_project::Project;
use rungc_syntax::Severity;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The labels of the programs in some folders.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Labels {
    /// Folder of the folders, from the root of the repository.
    root: String,
    /// Folders in which every program is checked.
    folders: Vec<String>,
    #[serde(default)]
    warning: Vec<Label>,
}

/// What is known of a warning.
#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
struct Label {
    /// The program, from `root`.
    program: String,
    /// Step and instruction.
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
    /// It is not given, and was once.
    False,
}

/// A warning: program, place, code.
type Given = (String, String, String);

/// The warnings of the program in a file; none of one that has errors.
fn warnings(root: &Path, file: &Path) -> BTreeSet<Given> {
    let name = file
        .strip_prefix(root)
        .unwrap_or(file)
        .display()
        .to_string();
    let name = name.replace('\\', "/");
    let settings = Project::find(file).map(|path| Project::load(&path).expect("settings"));
    let reading = settings
        .as_ref()
        .map_or_else(ReadOptions::default, Project::reading);
    let mut read =
        rungc_frontend::read_with(file, &reading).unwrap_or_else(|e| panic!("{name}: {e}"));
    let options = CompileOptions {
        model: settings.as_ref().and_then(|settings| settings.model),
        ..CompileOptions::default()
    };
    if let Some(settings) = &settings {
        let model = compile::model(&read.program, &options);
        settings
            .complete(file, &mut read.program, model)
            .expect("settings that fit");
    }
    let checked = compile::check(&read.program, &options);
    let all: Vec<_> = read
        .diagnostics
        .iter()
        .chain(checked.diagnostics.iter())
        .collect();
    let place = |start: u32| {
        let instrs = read.program.instrs.iter().zip(&checked.step_numbers);
        let mut here =
            instrs.filter(|(instr, _)| (instr.span.start..instr.span.end).contains(&start));
        here.next()
            .map_or_else(String::new, |(instr, step)| format!("{step} {instr}"))
    };
    let found = all
        .iter()
        .filter(|found| found.severity == Severity::Warning);
    found
        .map(|found| {
            (
                name.clone(),
                place(found.span.start),
                found.code.to_string(),
            )
        })
        .collect()
}

/// The programs in a folder and below.
fn files(folder: &Path) -> Vec<PathBuf> {
    let found = if is_project(folder) {
        vec![folder.to_owned()]
    } else {
        programs(folder, usize::MAX).unwrap_or_else(|e| panic!("{}: {e}", folder.display()))
    };
    assert!(!found.is_empty(), "no program in {}", folder.display());
    found
}

/// Differences between the labels and what is given.
fn differences(labels: &Labels, root: &Path) -> Vec<String> {
    let present = labels.folders.iter().filter(|folder| {
        let is_there = root.join(folder).is_dir();
        if !is_there {
            println!("skipped: there is no folder {folder} in {}", labels.root);
        }
        is_there
    });
    let present: Vec<_> = present.collect();
    let all = present.iter().flat_map(|folder| files(&root.join(folder)));
    let given: BTreeSet<Given> = all.flat_map(|file| warnings(root, &file)).collect();
    let is_present = |program: &str| {
        let mut folders = present.iter();
        folders.any(|folder| program.starts_with(&format!("{folder}/")))
    };
    let mut known = BTreeMap::new();
    let mut wrong = Vec::new();
    for label in labels
        .warning
        .iter()
        .filter(|label| is_present(&label.program))
    {
        let key = (
            label.program.clone(),
            label.place.clone(),
            label.code.clone(),
        );
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
    wrong
}

#[test]
fn every_warning_is_labelled_and_right() {
    let repository = Path::new(env!("RUNGC_ROOT"));
    let folder = repository.join("golden/warnings");
    let mut wrong = Vec::new();
    let mut looked = 0;
    for entry in std::fs::read_dir(&folder).expect("golden/warnings") {
        let path = entry.expect("a file").path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("labels");
        let labels: Labels =
            toml::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        wrong.extend(differences(&labels, &repository.join(&labels.root)));
        looked += 1;
    }
    assert!(looked >= 2, "{looked} files of labels");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
