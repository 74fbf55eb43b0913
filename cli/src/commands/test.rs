//! `rungc test`.

use super::{Context, Failure, Outcome, Result, counted, defaults, say, subject};
use crate::args::{EngineChoice, TestArgs};
use crate::progress;
use rungc_rt_sources::cache::{self, Slot};
use rungc_sim::engines::{EngineKind, build};
use rungc_sim::plant;
use rungc_sim::plctest::{self, Report, Suite, TestFile};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Ending of the names of test files.
const ENDING: &str = ".plctest.toml";

/// Runs test files.
pub fn run(args: &TestArgs, cx: Context) -> Result {
    let start = Instant::now();
    let project = subject::project(args.project.as_deref(), cx)?;
    let settings = project.as_ref();
    let mut paths = args.files.clone();
    if let (true, Some(project)) = (paths.is_empty(), settings) {
        let files = project.test.files.iter();
        paths.extend(files.map(|file| subject::near(project.at(file))));
    }
    if paths.is_empty() {
        let why = "which tests? Name a FILE, or `files` in `[test]` of rungc.toml";
        return Err(Failure::Because(why.to_string()));
    }
    let usual = settings.map(defaults::engine).transpose();
    let usual = usual.map_err(|error| Failure::Because(error.to_string()))?;
    let engine = args.engine.or(usual.flatten());
    let mut files = load(&paths, args.only.as_deref())?;
    if let Some(path) = &args.machine {
        wire(&mut files, path)?;
    }
    let suite = progress::spin("compiling the cases", || Suite::compile(files));
    if suite.is_empty() {
        return Err(Failure::Because("no case to run".to_string()));
    }
    let kinds = engines(engine.unwrap_or(EngineChoice::Interp));
    let names: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
    let cases = counted(suite.len(), "case");
    cx.note(&format!("     Running {cases} on {}", names.join(", ")));
    let folder = BuildFolder::take()?;
    let mut report = Report::default();
    for kind in kinds {
        let what = if kind == EngineKind::Interp {
            "preparing"
        } else {
            "building the engine"
        };
        let built = progress::spin(what, || build(kind, suite.modules(), folder.path()));
        let mut engine = built.map_err(|error| Failure::Because(error.to_string()))?;
        let bar = progress::bar(suite.len() as u64).with_message(kind.name());
        report.extend(plctest::run(&suite, engine.as_mut(), &mut |_| bar.inc(1)));
        bar.finish_and_clear();
    }
    for failed in report.failures() {
        say(&format!("{}\n", failed.describe(&suite)))?;
    }
    let failed = report.failures().count();
    say(&format!(
        "{} passed, {failed} failed ({:.1} s)\n",
        report.passed(),
        start.elapsed().as_secs_f64()
    ))?;
    Ok(if report.is_success() {
        Outcome::Success
    } else {
        Outcome::Failed
    })
}

/// Where engines are built: a folder of the cache, where the runtime is compiled already the next time, or without a cache a
/// temporary one.
enum BuildFolder {
    Kept(Slot),
    Temporary(tempfile::TempDir),
}

impl BuildFolder {
    fn take() -> std::io::Result<Self> {
        let kept = cache::folder().and_then(|cache| Slot::take(&cache, "engines"));
        match kept {
            Ok(slot) => Ok(BuildFolder::Kept(slot)),
            Err(_) => Ok(BuildFolder::Temporary(tempfile::tempdir()?)),
        }
    }

    fn path(&self) -> &Path {
        match self {
            BuildFolder::Kept(slot) => slot.path(),
            BuildFolder::Temporary(folder) => folder.path(),
        }
    }
}

fn engines(choice: EngineChoice) -> Vec<EngineKind> {
    match choice {
        EngineChoice::Interp => vec![EngineKind::Interp],
        EngineChoice::C => vec![EngineKind::C],
        EngineChoice::Rust => vec![EngineKind::Rust],
        EngineChoice::All => EngineKind::ALL.to_vec(),
    }
}

/// Loads files and, from folders, all test files in them; keeps the cases whose `file::name` contains `only`.
fn load(paths: &[PathBuf], only: Option<&str>) -> std::result::Result<Vec<TestFile>, Failure> {
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
    let mut problems = Vec::new();
    let mut files = Vec::new();
    for name in &names {
        match plctest::load(name) {
            Ok(file) => files.push(file),
            Err(error) => problems.push(error.to_string()),
        }
    }
    if !problems.is_empty() {
        return Err(Failure::Because(problems.join("\n")));
    }
    if let Some(only) = only {
        for file in &mut files {
            let name = file.name.clone();
            file.cases
                .retain(|case| format!("{name}::{}", case.name).contains(only));
        }
        files.retain(|file| !file.cases.is_empty());
    }
    Ok(files)
}

/// Gives the machine of a file to cases that name none.
fn wire(files: &mut [TestFile], path: &Path) -> std::result::Result<(), Failure> {
    let described = plant::load(path).map_err(|error| Failure::Because(error.to_string()))?;
    let described = Arc::new(described);
    for case in files.iter_mut().flat_map(|file| &mut file.cases) {
        case.machine.get_or_insert_with(|| Arc::clone(&described));
    }
    Ok(())
}

fn find(folder: &Path, names: &mut Vec<PathBuf>) -> std::result::Result<(), Failure> {
    let at = |error: std::io::Error| Failure::Because(format!("{}: {error}", folder.display()));
    for entry in fs::read_dir(folder).map_err(at)? {
        let path = entry.map_err(at)?.path();
        if path.is_dir() {
            find(&path, names)?;
        } else if path.to_string_lossy().ends_with(ENDING) {
            names.push(path);
        }
    }
    Ok(())
}
