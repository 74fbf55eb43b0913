//! `rungc test`.

mod broken;
pub(super) mod coverage;
pub(super) mod files;
mod github;
mod junit;
pub(super) mod report;
mod review;
mod sarif;
mod verdicts;
mod watch;

use super::properties::stated;
use super::{Context, Failure, Outcome, Result, counted, defaults, interruption, put, subject};
use crate::args::{EngineChoice, Reporting, TestArgs, TestFormat};
use crate::{output, progress};
use files::Unread;
use report::{Property, Results, Untested};
use rungc_project::Project;
use rungc_runtime_sources::cache::{self, Slot};
use rungc_sim::engines::{EngineKind, prepare};
use rungc_sim::plctest::{self, Report, Suite, TestFile};
use rungc_sim::threads::Threads;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;
use verdicts::Verdicts;

/// Runs test files.
pub fn run(args: &TestArgs, cx: Context) -> Result {
    interruption::note_for_a_while();
    if args.watch {
        return watch::run(args, cx);
    }
    let chosen = Chosen::of(args, cx)?;
    let files = match chosen.load(args, cx) {
        Ok(files) => files,
        Err(unread) => {
            if let Unread::Files(errors) = &unread {
                broken::publish(args, errors, cx)?;
            }
            return Err(unread.failure(cx));
        }
    };
    if args.coverage.is_some() || args.mutants {
        return coverage::run(args, &chosen, files, cx);
    }
    run_files(args, &chosen, files, cx)
}

/// Choices of the command line and the settings.
struct Chosen {
    project: Option<Project>,
    paths: Vec<PathBuf>,
    engine: EngineChoice,
}

impl Chosen {
    fn of(args: &TestArgs, cx: Context) -> std::result::Result<Self, Failure> {
        let project = subject::project(args.project.as_deref(), cx)?;
        let settings = project.as_ref();
        let mut paths = args.files.clone();
        if let (true, Some(project)) = (paths.is_empty(), settings) {
            for file in &project.test.files {
                let path = Path::new(&file.text);
                if let Some(absent) = project.absent(path, file.span) {
                    return Err(subject::refuse(absent, &Reporting::default(), cx));
                }
                paths.push(subject::near(project.at(path)));
            }
        }
        if paths.is_empty() {
            let why = "no tests given: name a FILE, or set `files` in `[test]` of rungc.toml";
            return Err(Failure::Because(why.to_string()));
        }
        let usual = settings.map(defaults::engine).transpose();
        let usual = usual.map_err(|error| Failure::Because(error.to_string()))?;
        let engine = args.engine.or(usual.flatten());
        Ok(Chosen {
            engine: engine.unwrap_or(EngineChoice::Interp),
            project,
            paths,
        })
    }

    /// The cases that are to run.
    fn load(&self, args: &TestArgs, cx: Context) -> std::result::Result<Vec<TestFile>, Unread> {
        let mut files = files::load(&self.paths, args.filter.as_deref())?;
        if files.is_empty() {
            return Err(Failure::Because(self.no_cases(args)).into());
        }
        // All cases judge the mutants, of which a part runs.
        if let Some(shard) = args.shard.filter(|_| !args.mutants) {
            files::keep(&mut files, shard);
        }
        if let Some(path) = &args.machine {
            files::wire(&mut files, path, cx)?;
        }
        Ok(files)
    }

    /// Reason why there is nothing to run.
    fn no_cases(&self, args: &TestArgs) -> String {
        match &args.filter {
            Some(filter) => format!("no cases to run: no `file::name` contains `{filter}`"),
            None => {
                let paths = self.paths.iter().map(|path| format!("`{}`", path.display()));
                let paths = paths.collect::<Vec<_>>().join(", ");
                format!("no cases to run in {paths}: test files are named `*.plctest.toml`")
            }
        }
    }

    /// The properties that the settings demand, which are not test cases. `rungc verify` reports mistakes in them.
    fn untested(&self) -> Option<Untested> {
        let project = self.project.as_ref();
        let project = project.filter(|project| project.has_properties())?;
        let rows = rungc_functions::properties(project).unwrap_or_default();
        let properties = rows.into_iter().map(|expanded| Property {
            property: stated(&expanded.row),
            requirement: expanded.row.requirement,
        });
        Some(Untested {
            file: subject::near(project.path.clone()),
            properties: properties.collect(),
        })
    }

    /// Errors that are warnings.
    fn warn(&self) -> &[&'static str] {
        let settings = self.project.as_ref();
        settings.map_or(&[][..], |project| &project.check.warn)
    }
}

fn run_files(args: &TestArgs, chosen: &Chosen, files: Vec<TestFile>, cx: Context) -> Result {
    let start = Instant::now();
    let kinds = engines(chosen.engine);
    let verdicts = Verdicts::look(args, &files, &kinds, chosen.warn());
    let known = &verdicts.known;
    let suite = progress::spin("compiling the cases", || {
        Suite::compile_but(files, chosen.warn(), known)
    });
    let names: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
    let cases = counted(suite.len(), "case");
    cx.note(&format!("     Running {cases} on {}", names.join(", ")));
    if !known.is_empty() {
        cx.detail(|| format!("       Known {} to pass", counted(known.len(), "case")));
    }
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
    if !interruption::is_requested() {
        // A verdict is about the files as they were when the cases ran.
        verdicts.keep(&suite, &report);
        review::traces(args, &suite, &mut report, cx)?;
    }
    let untested = chosen.untested();
    let results = Results {
        suite: &suite,
        report: &report,
        elapsed: start.elapsed(),
        untested: untested.as_ref(),
    };
    publish(args, &results, cx)?;
    if untested.is_some() {
        cx.note("  Not tested `[[property]]` of rungc.toml, which `rungc verify` decides");
    }
    Ok(match report.is_success() {
        _ if interruption::is_requested() => Outcome::Interrupted,
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
    let ready = progress::spin(what, || prepare(kind, suite.modules(), folder));
    let ready = ready.map_err(|error| Failure::Because(error.to_string()))?;
    let bar = progress::bar(suite.len() as u64).with_message(kind.name());
    let report = plctest::run_in(suite, Threads::usual(), &|| ready.start(), &mut |_| {
        bar.inc(1);
        match interruption::is_requested() {
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
        TestFormat::Json => report::json(results)?,
        TestFormat::Sarif => sarif::sarif(results)?,
        TestFormat::Github => github::github(results),
    };
    let (passed, failed) = (results.report.passed(), results.report.failures().count());
    put(
        (output::file(&args.output), args.force),
        &text,
        &format!("{passed} passed, {failed} failed"),
        cx,
    )
}

/// Folder in which engines are built: one of the cache, where the runtime is compiled already the next time, or without
/// a cache a temporary one.
pub(super) enum BuildFolder {
    Cached(Slot),
    Temporary(tempfile::TempDir),
    /// The interpreter is there already.
    None,
}

impl BuildFolder {
    pub(super) fn take() -> std::io::Result<Self> {
        let cached = cache::folder().and_then(|cache| Slot::take(&cache, "engines"));
        match cached {
            Ok(slot) => Ok(BuildFolder::Cached(slot)),
            Err(_) => Ok(BuildFolder::Temporary(tempfile::tempdir()?)),
        }
    }

    pub(super) fn path(&self) -> &Path {
        match self {
            BuildFolder::Cached(slot) => slot.path(),
            BuildFolder::Temporary(folder) => folder.path(),
            BuildFolder::None => Path::new(""),
        }
    }
}

pub(super) fn engines(choice: EngineChoice) -> Vec<EngineKind> {
    match choice {
        EngineChoice::Interp => vec![EngineKind::Interp],
        EngineChoice::C => vec![EngineKind::C],
        EngineChoice::Rust => vec![EngineKind::Rust],
        EngineChoice::All => EngineKind::ALL.to_vec(),
    }
}
