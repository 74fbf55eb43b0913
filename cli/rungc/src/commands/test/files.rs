//! Selection of test files and cases.

use super::super::{Context, Failure, eprint_line, subject};
use crate::args::{Reporting, Shard};
use rungc_sim::LoadError;
use rungc_sim::plant;
use rungc_sim::plctest::{self, Case, TestFile};
use rungc_sim::threads::Threads;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use walkdir::{DirEntry, WalkDir};

/// Ending of the names of test files.
const ENDING: &str = ".plctest.toml";

/// Reason why there is nothing to run.
pub enum Unread {
    /// Mistakes in test files, or files that cannot be read.
    Files(Vec<LoadError>),
    /// Anything else.
    Because(Failure),
}

impl From<Failure> for Unread {
    fn from(failure: Failure) -> Self {
        Unread::Because(failure)
    }
}

impl Unread {
    /// The failure of the command; mistakes in files are reported.
    pub fn failure(self, cx: Context) -> Failure {
        match self {
            Unread::Files(errors) => {
                for error in errors {
                    match subject::refuse(error.into(), &Reporting::default(), cx) {
                        Failure::Reported => {}
                        failure => eprint_line(&format!("rungc: {failure}")),
                    }
                }
                Failure::Reported
            }
            Unread::Because(failure) => failure,
        }
    }
}

/// Loads files and, from folders, all test files in them; keeps the cases whose `file::name` contains `filter`.
pub fn load(paths: &[PathBuf], filter: Option<&str>) -> std::result::Result<Vec<TestFile>, Unread> {
    let names = names(paths)?;
    let mut problems = Vec::new();
    let mut files = Vec::new();
    for loaded in Threads::usual().map(&names, |name| plctest::load(name)) {
        match loaded {
            Ok(file) => files.push(file),
            Err(error) => problems.push(error),
        }
    }
    if !problems.is_empty() {
        return Err(Unread::Files(problems));
    }
    if let Some(filter) = filter {
        for file in &mut files {
            let name = file.name.clone();
            file.cases
                .retain(|case| format!("{name}::{}", case.name).contains(filter));
        }
    }
    files.retain(|file| !file.cases.is_empty());
    Ok(files)
}

/// Keeps one part of the cases. Which one a case is in depends on its name and that of its file alone: it stays there
/// when others are added.
pub fn keep(files: &mut Vec<TestFile>, shard: Shard) {
    for file in &mut *files {
        let path = Path::new(&file.name);
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let of_shard = |case: &Case| is_in(shard, &format!("{name}::{}", case.name));
        file.cases.retain(of_shard);
    }
    files.retain(|file| !file.cases.is_empty());
}

/// Returns true if a case of this name belongs to a part.
pub fn is_in(shard: Shard, name: &str) -> bool {
    // FNV-1a, the same on every machine and in every version.
    let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    let parts = u64::try_from(shard.parts).unwrap_or(u64::MAX);
    // The upper half depends on all bytes as well as the lower one does.
    (hash ^ hash >> 32) % parts + 1 == u64::try_from(shard.part).unwrap_or(u64::MAX)
}

/// Gives the machine of a file to cases that name none.
pub fn wire(files: &mut [TestFile], path: &Path, cx: Context) -> std::result::Result<(), Failure> {
    let described = plant::load(path);
    let described =
        described.map_err(|error| subject::refuse(error.into(), &Reporting::default(), cx))?;
    let described = Arc::new(described);
    for case in files.iter_mut().flat_map(|file| &mut file.cases) {
        case.machine.get_or_insert_with(|| Arc::clone(&described));
    }
    Ok(())
}

/// Adds the test files in a folder and below; hidden folders, folders called `target` and links to folders are left
/// out.
fn find(folder: &Path, names: &mut Vec<PathBuf>) -> std::result::Result<(), Failure> {
    let is_left_out = |entry: &DirEntry| {
        let name = entry.file_name().to_string_lossy();
        entry.depth() > 0
            && entry.file_type().is_dir()
            && (name.starts_with('.') || name == "target")
    };
    let entries = WalkDir::new(folder).into_iter();
    for entry in entries.filter_entry(|entry| !is_left_out(entry)) {
        let path = entry.map_err(rungc_frontend::walk_error)?.into_path();
        if path.to_string_lossy().ends_with(ENDING) && !path.is_dir() {
            names.push(path.strip_prefix(".").map_or(path.clone(), Path::to_owned));
        }
    }
    Ok(())
}

/// The test files that paths name, each once.
pub fn names(paths: &[PathBuf]) -> std::result::Result<Vec<PathBuf>, Failure> {
    let mut names = Vec::new();
    for path in paths {
        if path.is_dir() {
            find(path, &mut names)?
        } else {
            names.push(path.clone())
        }
    }
    names.sort();
    names.dedup();
    Ok(names)
}
