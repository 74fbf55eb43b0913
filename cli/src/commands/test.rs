//! `rungc test`.

mod junit;
mod report;

use super::{
    AtomicFile, Context, Failure, Outcome, Result, counted, defaults, interruption, say, subject,
};
use crate::args::{EngineChoice, Shard, TestArgs, TestFormat};
use crate::progress;
use crate::report::visible_json;
use report::Results;
use rungc_runtime_sources::cache::{self, Slot};
use rungc_sim::engines::{EngineKind, build};
use rungc_sim::plant;
use rungc_sim::plctest::{self, Report, Suite, TestFile};
use rungc_syntax::order;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use walkdir::{DirEntry, WalkDir};

/// Ending of the names of test files.
const ENDING: &str = ".plctest.toml";

/// Runs test files.
pub fn run(args: &TestArgs, cx: Context) -> Result {
    let start = Instant::now();
    interruption::note_for_a_while();
    let project = subject::project(args.project.as_deref(), cx)?;
    let settings = project.as_ref();
    let mut paths = args.files.clone();
    if let (true, Some(project)) = (paths.is_empty(), settings) {
        let files = project.test.files.iter();
        paths.extend(files.map(|file| subject::near(project.at(file))));
    }
    if paths.is_empty() {
        let why = "no tests given: name a FILE, or set `files` in `[test]` of rungc.toml";
        return Err(Failure::Because(why.to_string()));
    }
    let usual = settings.map(defaults::engine).transpose();
    let usual = usual.map_err(|error| Failure::Because(error.to_string()))?;
    let engine = args.engine.or(usual.flatten());
    let mut files = load(&paths, args.filter.as_deref())?;
    if files.is_empty() {
        return Err(Failure::Because("no cases to run".to_string()));
    }
    if let Some(shard) = args.shard {
        keep(&mut files, shard);
    }
    if let Some(path) = &args.machine {
        wire(&mut files, path)?;
    }
    let warn = settings.map_or(&[][..], |project| &project.check.warn);
    let suite = progress::spin("compiling the cases", || Suite::compile(files, warn));
    let kinds = engines(engine.unwrap_or(EngineChoice::Interp));
    let names: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
    let cases = counted(suite.len(), "case");
    cx.note(&format!("     Running {cases} on {}", names.join(", ")));
    let mut report = Report::default();
    if !suite.is_empty() {
        let folder = match kinds.iter().all(|kind| *kind == EngineKind::Interp) {
            true => BuildFolder::None,
            false => BuildFolder::take()?,
        };
        for kind in kinds {
            report.extend(run_on(kind, &suite, folder.path())?);
        }
    }
    let results = Results {
        suite: &suite,
        report: &report,
        elapsed: start.elapsed(),
    };
    publish(args, &results, cx)?;
    Ok(match report.is_success() {
        _ if interruption::is_asked() => Outcome::Interrupted,
        true => Outcome::Success,
        false => Outcome::Failed,
    })
}

/// Runs the cases on an engine until interrupted.
fn run_on(kind: EngineKind, suite: &Suite, folder: &Path) -> std::result::Result<Report, Failure> {
    let what = match kind {
        EngineKind::Interp => "preparing",
        _ => "building the engine",
    };
    let built = progress::spin(what, || build(kind, suite.modules(), folder));
    let mut engine = built.map_err(|error| Failure::Because(error.to_string()))?;
    let bar = progress::bar(suite.len() as u64).with_message(kind.name());
    let report = plctest::run(suite, engine.as_mut(), &mut |_| {
        bar.inc(1);
        match interruption::is_asked() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    });
    bar.finish_and_clear();
    Ok(report)
}

/// Prints or writes the results.
fn publish(args: &TestArgs, results: &Results, cx: Context) -> std::result::Result<(), Failure> {
    let text = match args.format {
        TestFormat::Human => report::human(results),
        TestFormat::Junit => junit::junit(results)?,
        TestFormat::Json => visible_json(&report::json(results)?).into_owned(),
    };
    let Some(path) = &args.output else {
        return say(&text).map_err(Failure::from);
    };
    let file = AtomicFile::create(path)?;
    let written = file.writer()?.write_all(text.as_bytes());
    written.map_err(|error| file.failed(error))?;
    file.persist()?;
    let (passed, failed) = (results.report.passed(), results.report.failures().count());
    let path = path.display();
    cx.note(&format!(
        "       Wrote {path}: {passed} passed, {failed} failed"
    ));
    Ok(())
}

/// Where engines are built: a folder of the cache, where the runtime is compiled already the next time, or without a
/// cache a temporary one.
enum BuildFolder {
    Kept(Slot),
    Temporary(tempfile::TempDir),
    /// The interpreter is there already.
    None,
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
            BuildFolder::None => Path::new(""),
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

/// Loads files and, from folders, all test files in them; keeps the cases whose `file::name` contains `filter`.
fn load(paths: &[PathBuf], filter: Option<&str>) -> std::result::Result<Vec<TestFile>, Failure> {
    let mut names = Vec::new();
    for path in paths {
        if path.is_dir() {
            find(path, &mut names)?
        } else {
            names.push(path.clone())
        }
    }
    order::by(&mut names, Ord::cmp);
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

/// Keeps one part of the cases: dealt out in their order, so that the parts are equal and a slow file is shared.
fn keep(files: &mut Vec<TestFile>, shard: Shard) {
    let mut dealt = (0..shard.parts).cycle();
    for file in &mut *files {
        file.cases.retain(|_| dealt.next() == Some(shard.part - 1));
    }
    files.retain(|file| !file.cases.is_empty());
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
        let path = entry.map_err(io::Error::from)?.into_path();
        if path.to_string_lossy().ends_with(ENDING) && !path.is_dir() {
            names.push(path.strip_prefix(".").map_or(path.clone(), Path::to_owned));
        }
    }
    Ok(())
}
