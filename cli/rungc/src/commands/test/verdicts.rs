//! Verdicts of earlier runs: cases that passed with the same files, the same executable and the same options.
//!
//! There is a file of them for each test file and engine in the user's cache; a case that failed is in none.

use crate::args::TestArgs;
use rungc_runtime_sources::cache;
use rungc_sim::engines::EngineKind;
use rungc_sim::plctest::{Id, Report, Suite, TestFile};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;
use walkdir::WalkDir;

/// Verdicts of earlier runs, and where those of this one go.
pub struct Verdicts {
    /// The cases that passed on all engines that are requested.
    pub known: BTreeSet<Id>,
    /// By file and engine: where they are kept, and a hash of all that they depend on.
    places: BTreeMap<(usize, &'static str), (PathBuf, String)>,
}

impl Verdicts {
    /// Finds what is known.
    pub fn look(
        args: &TestArgs,
        files: &[TestFile],
        kinds: &[EngineKind],
        warn: &[&'static str],
    ) -> Verdicts {
        let mut verdicts = Verdicts {
            known: BTreeSet::new(),
            places: BTreeMap::new(),
        };
        // Without a cache, nothing is known.
        let folder = cache::folder().map(|folder| folder.join("verdicts"));
        let (Ok(folder), Ok(executable), false) = (folder, executable(), args.no_cache) else {
            return verdicts;
        };
        for (number, file) in files.iter().enumerate() {
            let Ok(content) = content(file, args.machine.as_deref()) else {
                continue;
            };
            let mut passed: Option<BTreeSet<String>> = None;
            for kind in kinds {
                let key = hash(&(executable, content, warn, kind.name()));
                let place = std::path::absolute(&file.name).unwrap_or_default();
                let place = folder.join(hash(&(place, kind.name())));
                let on_engine = read(&place, &key);
                passed = Some(match passed {
                    Some(passed) => passed.intersection(&on_engine).cloned().collect(),
                    None => on_engine,
                });
                verdicts.places.insert((number, kind.name()), (place, key));
            }
            let passed = passed.unwrap_or_default();
            let cases = file.cases.iter().enumerate();
            let known = cases.filter(|(_, case)| passed.contains(&case.name));
            verdicts
                .known
                .extend(known.map(|(case, _)| Id { file: number, case }));
        }
        verdicts
    }

    /// Keeps the verdicts of a run. What cannot be written is found out again the next time.
    pub fn keep(&self, suite: &Suite, report: &Report) {
        for ((file, engine), (place, key)) in &self.places {
            let of_file = report.outcomes.iter();
            let of_file = of_file.filter(|o| o.id.file == *file && o.engine == *engine);
            let passed = of_file.filter(|o| o.failure.is_none());
            let names = passed.map(|o| suite.files()[*file].cases[o.id.case].name.clone());
            let mut names: BTreeSet<_> = names.collect();
            // A part of the cases may have run.
            names.extend(read(place, key));
            let names: Vec<String> = names.into_iter().collect();
            let _ = cache::write(place, &format!("{key}\n{}\n", names.join("\n")));
        }
    }
}

/// The cases that passed, if the verdicts are about the same content.
fn read(place: &Path, key: &str) -> BTreeSet<String> {
    let Ok(text) = fs::read_to_string(place) else {
        return BTreeSet::new();
    };
    let mut lines = text.lines();
    match lines.next() {
        Some(first) if first == key => lines.map(str::to_string).collect(),
        _ => BTreeSet::new(),
    }
}

fn hash(value: &impl Hash) -> String {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    // A second number makes it as good as impossible that two contents have the same.
    let first = hasher.finish();
    first.hash(&mut hasher);
    format!("{first:016x}{:016x}", hasher.finish())
}

/// Identification of this executable.
fn executable() -> io::Result<(u64, u128)> {
    let metadata = fs::metadata(std::env::current_exe()?)?;
    let changed = metadata.modified()?.duration_since(UNIX_EPOCH);
    Ok((metadata.len(), changed.map_or(0, |time| time.as_nanos())))
}

/// A hash of all files that the cases depend on.
fn content(file: &TestFile, machine: Option<&Path>) -> io::Result<u64> {
    let mut hasher = DefaultHasher::new();
    for path in file.inputs.iter().map(PathBuf::as_path).chain(machine) {
        path.hash(&mut hasher);
        for entry in WalkDir::new(path).sort_by_file_name() {
            let Ok(entry) = entry else {
                // A trace that has not been accepted.
                0u8.hash(&mut hasher);
                continue;
            };
            if entry.file_type().is_file() {
                let mut bytes = Vec::new();
                fs::File::open(entry.path())?.read_to_end(&mut bytes)?;
                entry.path().hash(&mut hasher);
                bytes.hash(&mut hasher);
            }
        }
    }
    // A program may have more files than the one that is named.
    for case in &file.cases {
        case.program.text().hash(&mut hasher);
    }
    Ok(hasher.finish())
}
