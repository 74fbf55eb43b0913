//! The programs that a command works on: where they are, and which settings hold for each.

use super::{Context, Failure, Outcome, Result, counts, eprint_line, interruption};
use crate::args::{Format, Input, Inputs, Reading, Reporting};
use crate::report::{Findings, Reporter, breaks_lines, visible_line};
use rungc::language::message;
use rungc::settings;
use rungc_firmware::board::BoardError;
use rungc_frontend::ReadOptions;
use rungc_lower::compile::CompileOptions;
use rungc_models::{ModelId, Plc, Variant};
use rungc_project::{Error, FILE, Project};
use rungc_sim::threads::Threads;
use rungc_syntax::{DeviceClass, Diagnostics, Program};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Name of standard input.
const STDIN: &str = "-";

/// One program, with what the command line and its project's settings say about it.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The file or folder as named; `-` is standard input.
    pub file: PathBuf,
    /// The settings of its project.
    pub project: Option<Arc<Project>>,
    /// The model, if it is chosen; else the program names it.
    pub model: Option<ModelId>,
    /// The PLC of its family that the program is held to.
    pub variant: Option<&'static Variant>,
    /// Options for reporting diagnostics.
    pub reporting: Reporting,
    /// Options for reading.
    pub options: ReadOptions,
    /// Arguments of the command line that `rungc check` takes as well.
    pub arguments: Vec<String>,
}

impl Subject {
    /// Returns true if it is read from standard input.
    pub fn is_stdin(&self) -> bool {
        self.file == Path::new(STDIN)
    }

    /// Command that lists all that can be said of the program; `None` for standard input.
    pub fn check_command(&self) -> Option<String> {
        let quoted = |word: &String| match word.contains(char::is_whitespace) {
            true => format!(" \"{word}\""),
            false => format!(" {word}"),
        };
        let file = self.file.display().to_string();
        let words = std::iter::once(&file).chain(&self.arguments);
        let words: String = words.map(quoted).collect();
        (!self.is_stdin()).then(|| format!("rungc check{words}"))
    }

    /// Options for compiling, by its settings.
    pub fn options(&self) -> CompileOptions {
        let warn = &self.reporting.warn;
        settings::compiling(self.project.as_deref(), &self.file, self.plc(), warn)
    }

    /// The PLC, if it is chosen.
    pub fn plc(&self) -> Option<Plc> {
        Some(Plc {
            model: self.model?,
            variant: self.variant,
        })
    }

    /// `[retain] fault`: the bit that is on while latched devices cannot be saved.
    pub fn unsaved(&self) -> Option<(DeviceClass, u32)> {
        settings::unsaved(self.project.as_ref()?)
    }

    /// The settings of its project, if the project is about this program.
    pub fn own_project(&self) -> Option<&Project> {
        let project = self.project.as_deref();
        project.filter(|project| project.is_about(&self.file))
    }
}

/// An option whose value depends on the program, in messages.
pub fn option_of(option: &str, subject: &Subject) -> String {
    format!("{}: {option}", subject.file.display())
}

/// The settings found so far, by the file they are in.
struct Projects<'a> {
    reading: &'a Reading,
    cx: Context,
    loaded: BTreeMap<PathBuf, Arc<Project>>,
}

impl Projects<'_> {
    /// The settings for a path.
    fn of(&mut self, path: &Path) -> std::result::Result<Option<Arc<Project>>, Failure> {
        let found = match &self.reading.project {
            Some(given) => Some(given.clone()),
            None => Project::find(path),
        };
        let Some(found) = found else { return Ok(None) };
        if let Some(project) = self.loaded.get(&found) {
            return Ok(Some(Arc::clone(project)));
        }
        let project = Arc::new(load(&found, &self.reading.reporting, self.cx)?);
        self.cx
            .detail(|| format!("    Settings {}", project.path.display()));
        self.loaded.insert(found, Arc::clone(&project));
        Ok(Some(project))
    }

    fn subject(&mut self, file: PathBuf) -> std::result::Result<Subject, Failure> {
        let folder = Path::new(".");
        let is_stdin = file == Path::new(STDIN);
        let project = self.of(if is_stdin { folder } else { &file })?;
        let mut reporting = self.reading.reporting.clone();
        if let Some(project) = &project {
            reporting.rules = settings::rules(project);
            reporting.lang = project.language;
        }
        let options = self.reading.options();
        let options = match &project {
            Some(project) => settings::reading(project, options),
            None => options,
        };
        let plc = self.reading.kind.model;
        let plc = plc.or_else(|| settings::plc(project.as_ref()?));
        Ok(Subject {
            file,
            model: plc.map(|plc| plc.model),
            variant: plc.and_then(|plc| plc.variant),
            project,
            reporting,
            options,
            arguments: self.reading.arguments(),
        })
    }

    /// The program of a folder: the one that its settings name, else the only one in it.
    fn inside(&mut self, path: &Path) -> std::result::Result<PathBuf, Failure> {
        if !path.is_dir() {
            return Ok(path.to_owned());
        }
        let has_settings = self.reading.project.is_none() && path.join(FILE).is_file();
        let own = if has_settings { self.of(path)? } else { None };
        settings::program_in(path, own.as_deref()).map_err(|error| match error {
            rungc::Error::Settings(error) => refuse(*error, &self.reading.reporting, self.cx),
            error => Failure::Because(visible_line(&error.to_string()).into_owned()),
        })
    }

    /// The program of the project that this folder belongs to.
    fn own(&mut self) -> std::result::Result<PathBuf, Failure> {
        let Some(project) = self.of(Path::new("."))? else {
            let why = "no program given: name a FILE, or create rungc.toml with `rungc init`";
            return Err(Failure::Because(why.to_string()));
        };
        let named = project.program.as_deref();
        if let Some(absent) = named.and_then(|path| project.absent(path, project.program_span)) {
            return Err(refuse(absent, &self.reading.reporting, self.cx));
        }
        project.program().map(near).ok_or_else(|| {
            let path = project.path.display();
            Failure::Because(format!(
                "no program given: name a FILE, or set `program` in `[project]` of {path}"
            ))
        })
    }
}

/// A path as seen from the current folder, where it lies below it.
pub fn near(path: PathBuf) -> PathBuf {
    let folder = std::env::current_dir().and_then(dunce::canonicalize);
    let below = folder
        .ok()
        .and_then(|f| path.strip_prefix(f).ok().map(Path::to_owned));
    match below {
        Some(below) if below.as_os_str().is_empty() => PathBuf::from("."),
        Some(below) => below,
        None => path,
    }
}

/// Reads settings; their mistakes are reported.
pub fn load(
    path: &Path,
    reporting: &Reporting,
    cx: Context,
) -> std::result::Result<Project, Failure> {
    Project::load(path)
        .and_then(|project| super::defaults::check(&project).map(|()| project))
        .map_err(|error| refuse(error, reporting, cx))
}

/// Reports what is wrong with settings, where nothing else is reported.
pub fn refuse(error: Error, reporting: &Reporting, cx: Context) -> Failure {
    let mut reporter = Reporter::new(reporting, cx, false);
    let reported = report_invalid(error, reporting, &mut reporter);
    match reported.and_then(|()| Ok(reporter.finish()?)) {
        Ok(()) => Failure::Reported,
        Err(failure) => failure,
    }
}

/// Reports what is wrong with the description of a board.
pub fn refuse_board(error: BoardError, reporting: &Reporting, reporter: &mut Reporter) -> Failure {
    let BoardError::Wrong { file, error } = error else {
        return Failure::Because(error.to_string());
    };
    let mut diagnostics = Diagnostics::new();
    diagnostics.push(*error);
    let error = Error::Invalid {
        path: PathBuf::from(&file.name),
        text: file,
        diagnostics,
    };
    match report_invalid(error, reporting, reporter) {
        Ok(()) => Failure::Reported,
        Err(failure) => failure,
    }
}

/// Reports what is wrong with settings.
pub fn report_invalid(
    error: Error,
    reporting: &Reporting,
    reporter: &mut Reporter,
) -> std::result::Result<(), Failure> {
    let Error::Invalid {
        path,
        text,
        diagnostics,
    } = error
    else {
        return Err(Failure::Because(error.to_string()));
    };
    let program = Program {
        source: *text,
        ..Program::default()
    };
    let path = near(path);
    let findings = Findings::new(&path, &program, diagnostics, reporting);
    Ok(reporter.add(&findings)?)
}

/// The program of a command that takes one.
pub fn one(input: &Input, cx: Context) -> std::result::Result<Subject, Failure> {
    let reading = &input.reading;
    let mut projects = Projects {
        reading,
        cx,
        loaded: BTreeMap::new(),
    };
    let file = match &input.file {
        Some(file) => projects.inside(file)?,
        None => projects.own()?,
    };
    projects.subject(file)
}

/// The settings for the current folder, or those that are given.
pub fn project(given: Option<&Path>, cx: Context) -> std::result::Result<Option<Project>, Failure> {
    let found = given
        .map(Path::to_owned)
        .or_else(|| Project::find(Path::new(".")));
    let reporting = Reporting::default();
    found.map(|path| load(&path, &reporting, cx)).transpose()
}

/// The programs that a command line names, and whether it can mean several.
fn all(inputs: &Inputs, cx: Context) -> std::result::Result<(Vec<Subject>, bool), Failure> {
    let mut projects = Projects {
        reading: &inputs.reading,
        cx,
        loaded: BTreeMap::new(),
    };
    let mut many = inputs.files.len() > 1;
    let mut files = Vec::new();
    for file in &inputs.files {
        if !file.is_dir() || rungc_frontend::is_project(file) {
            files.push(file.clone());
            continue;
        }
        let found = settings::programs_in(file);
        let mut found = found.map_err(|error| Failure::Because(error.to_string()))?;
        let names = found.iter().map(|path| path.to_string_lossy());
        if let Some(broken) = names.into_iter().find(|name| breaks_lines(name)) {
            let name = visible_line(&broken);
            let why = format!("the name of `{name}` contains a line break; rename the file");
            return Err(Failure::Because(why));
        }
        if found.is_empty() {
            // An empty folder is reported where it is read.
            found.push(file.clone());
        } else {
            many = true;
        }
        files.extend(found);
    }
    if inputs.files.is_empty() {
        files.push(projects.own()?);
    }
    for file in &mut files {
        if let Some(project) = projects.of(file)?.filter(|one| !one.parts.is_empty()) {
            *file = near(project.whole(std::mem::take(file)));
        }
    }
    let mut seen = BTreeSet::new();
    files.retain(|file| seen.insert(file.clone()));
    let subjects = files.into_iter().map(|file| projects.subject(file));
    Ok((subjects.collect::<std::result::Result<_, _>>()?, many))
}

/// Works on each program that the command line names, and reports about all of them. The outcome is the worst.
pub fn each(
    inputs: &Inputs,
    cx: Context,
    mut work: impl FnMut(&Subject, &mut Reporter) -> Result,
) -> Result {
    let work = |subject: &Subject, (), reporter: &mut Reporter| work(subject, reporter);
    each_in(Threads::ONE, inputs, cx, &|_| (), work)
}

/// As [`each`], with a part of the work that several threads do, each for another program: `prepare` reports nothing,
/// and `work` takes its results in the order of the programs.
pub fn each_in<P: Send>(
    threads: Threads,
    inputs: &Inputs,
    cx: Context,
    prepare: &(dyn Fn(&Subject) -> P + Sync),
    mut work: impl FnMut(&Subject, P, &mut Reporter) -> Result,
) -> Result {
    let (subjects, many) = all(inputs, cx)?;
    let reporting = &inputs.reading.reporting;
    let mut reporter = Reporter::new(reporting, cx, many);
    let mut worst = Outcome::Success;
    let mut unusable = 0;
    let mut stopped = None;
    let prepare = |(): &mut (), subject: &Subject| prepare(subject);
    let mut left = subjects.iter();
    threads.each(
        &subjects,
        || (),
        prepare,
        |prepared| {
            let Some(subject) = left.next() else {
                return ControlFlow::Break(());
            };
            let outcome = match work(subject, prepared, &mut reporter) {
                Ok(outcome) => outcome,
                Err(Failure::Because(_)) if interruption::is_requested() => Outcome::Interrupted,
                // One program that cannot be worked on does not hide the others.
                Err(Failure::Because(why)) => {
                    eprint_line(&format!("rungc: {why}"));
                    Outcome::Unusable
                }
                Err(Failure::Reported) => Outcome::Unusable,
                Err(failure) => {
                    stopped = Some(failure);
                    return ControlFlow::Break(());
                }
            };
            unusable += usize::from(outcome == Outcome::Unusable);
            worst = worst.max(outcome);
            match outcome {
                Outcome::Interrupted => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            }
        },
    );
    let totals = reporter.totals();
    let printed = reporter.finish();
    if let Some(failure) = stopped {
        return Err(failure);
    }
    printed?;
    if many && reporting.format == Format::Human {
        let settings = subjects.first().and_then(|subject| subject.reporting.lang);
        let language = cx.language.or(settings);
        let counts = counts(&totals, language);
        let id = if unusable > 0 { "total-but" } else { "total" };
        let unusable = unusable.to_string();
        let arguments = [
            ("programs", subjects.len().into()),
            ("counts", (&counts).into()),
            ("unusable", (&unusable).into()),
        ];
        cx.note(&message(language, id, &arguments));
    }
    Ok(worst)
}

/// Reads a program, wherever it comes from.
pub fn source(
    subject: &Subject,
) -> std::result::Result<rungc_frontend::Read, rungc_frontend::ReadError> {
    let mut read = match subject.is_stdin() {
        true => rungc_frontend::read_from("stdin", io::stdin().lock(), &subject.options)?,
        false => rungc_frontend::read_with(&subject.file, &subject.options)?,
    };
    rungc::structured::compile(&mut read, subject.model);
    Ok(read)
}

/// Output paths of a command's programs, with the file that each was read from.
#[derive(Default)]
pub struct OutputPaths(BTreeMap<PathBuf, PathBuf>);

impl OutputPaths {
    /// Claims a path for a program; no other program of this command may have it.
    pub fn claim(
        &mut self,
        path: PathBuf,
        subject: &Subject,
    ) -> std::result::Result<PathBuf, Failure> {
        match self.0.insert(path.clone(), subject.file.clone()) {
            None => Ok(path),
            Some(other) => Err(Failure::Because(format!(
                "{}: {} is already the output of {}; build programs with the same name one at a time",
                subject.file.display(),
                path.display(),
                other.display()
            ))),
        }
    }

    /// Output path of one of `many` programs: a file called `name` in the folder `output`; of a program alone, the file
    /// `output`, or `None` for standard output.
    pub fn place(
        &mut self,
        output: Option<&Path>,
        many: bool,
        name: impl FnOnce() -> String,
        subject: &Subject,
    ) -> std::result::Result<Option<PathBuf>, Failure> {
        match output {
            Some(path) if many && is_file_name(path) => {
                let (path, folder) = (path.display(), path.with_extension(""));
                Err(Failure::Because(format!(
                    "-o: several programs need a folder, and `{path}` is the name of a file: name a folder, such as \
                     `{}`",
                    folder.display()
                )))
            }
            Some(folder) if many => self.claim(folder.join(name()), subject).map(Some),
            None if many => {
                let why = "-o: several programs need a folder; name one";
                Err(Failure::Because(why.to_string()))
            }
            output => Ok(output.map(Path::to_owned)),
        }
    }
}

/// Returns true for a path that is not a folder and has the name extension of a file that rungc writes.
fn is_file_name(path: &Path) -> bool {
    const ENDINGS: [&str; 8] = ["bin", "csv", "html", "il", "json", "md", "txt", "xml"];
    let ending = path.extension().unwrap_or_default();
    !path.is_dir()
        && ENDINGS
            .iter()
            .any(|known| ending.eq_ignore_ascii_case(known))
}
