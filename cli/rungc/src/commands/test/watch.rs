//! `rungc test --rerun`: runs again when a file is saved.
//!
//! The files are looked at several times a second, which works on every file system, also on those of networks and
//! containers, and with editors that replace a file.

use super::super::{
    Context, Failure, Outcome, Result, eprint_line, interruption, is_output_closed,
};
use super::{Chosen, files, run_files};
use crate::args::TestArgs;
use rungc_sim::plctest::TestFile;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, SystemTime};
use walkdir::WalkDir;

/// Interval of checks for changed files.
const PERIOD: Duration = Duration::from_millis(250);

/// Time of each file's last change, and its length.
type Seen = BTreeMap<PathBuf, (Option<SystemTime>, u64)>;

/// Runs the tests, and again after each change, until interrupted.
pub fn run(args: &TestArgs, cx: Context) -> Result {
    // An error in the command line itself ends it.
    Chosen::of(args, cx)?;
    let mut inputs: BTreeSet<PathBuf> = BTreeSet::new();
    loop {
        let before = look(args, &inputs);
        let chosen = Chosen::of(args, cx);
        let loaded = chosen.and_then(|chosen| {
            let files = chosen.load(args, cx);
            let files = files.map_err(|unread| unread.failure(cx))?;
            Ok((chosen, files))
        });
        // The inputs of a file are known once it can be read; until then, the previous ones apply. Files whose state
        // before the reading is unknown are read again: they may have been half written.
        if let Ok((chosen, files)) = &loaded {
            let known = std::mem::replace(&mut inputs, all_inputs(args, chosen, files));
            if inputs != known {
                continue;
            }
        }
        let ran = loaded.and_then(|(chosen, files)| run_files(args, &chosen, files, cx));
        match ran {
            Ok(outcome) if is_output_closed() => return Ok(outcome),
            Ok(_) => {}
            Err(Failure::Reported) => {}
            Err(failure) => eprint_line(&format!("rungc: {failure}")),
        }
        cx.note("    Watching for changes; Ctrl-C ends");
        while !interruption::is_requested() && look(args, &inputs) == before {
            sleep(PERIOD);
        }
        if interruption::is_requested() {
            return Ok(Outcome::Interrupted);
        }
    }
}

/// All that the tests are read from.
fn all_inputs(args: &TestArgs, chosen: &Chosen, files: &[TestFile]) -> BTreeSet<PathBuf> {
    let of_files = files.iter().flat_map(|file| file.inputs.iter().cloned());
    let settings = chosen.project.iter().map(|project| project.path.clone());
    let named = chosen.paths.iter().chain(&args.machine).cloned();
    of_files.chain(settings).chain(named).collect()
}

/// The state of these files, of the files in program folders, and of all test files that there are now.
fn look(args: &TestArgs, inputs: &BTreeSet<PathBuf>) -> Seen {
    let folders: Vec<PathBuf> = args.files.iter().chain(inputs).cloned().collect();
    let tests = files::names(&folders).unwrap_or_default();
    let mut seen = Seen::new();
    for path in inputs.iter().chain(&tests) {
        // A folder that holds tests is looked at by its tests: what else is in it may be anything.
        let is_tests = path.is_dir() && args.files.contains(path);
        let depth = if is_tests { 0 } else { usize::MAX };
        for entry in WalkDir::new(path).max_depth(depth).into_iter().flatten() {
            if let Ok(metadata) = entry.metadata()
                && metadata.is_file()
            {
                let state = (metadata.modified().ok(), metadata.len());
                seen.insert(entry.into_path(), state);
            }
        }
    }
    seen
}
