//! The commands. Each returns whether all went well; what stops a command before it can answer is a [`Failure`].

pub mod boards;
pub mod book;
pub mod build;
pub mod check;
pub mod convert;
pub mod dap;
mod defaults;
pub mod demo;
pub mod diff;
pub mod doc;
pub mod doctor;
mod entries;
pub mod explain;
pub mod explore;
mod fix;
pub mod flash;
pub mod fleet;
pub mod fmt;
mod in_place;
pub mod init;
pub mod interruption;
pub mod learn;
mod line;
pub mod lsp;
pub mod mcp;
mod ports;
mod properties;
pub mod read;
pub mod rename;
pub mod run;
pub mod serve;
pub mod setting;
pub mod stats;
pub mod subject;
pub mod test;
mod together;
pub mod verify;
pub mod view;
pub mod watch;
pub mod why;
pub mod xref;

use crate::args::Format;
use crate::language::Chosen;
use crate::output::write_file;
use crate::report::{Findings, Reporter, Totals, visible};
use rungc::language::message;
use rungc::{Language, language, other_model};
use rungc_frontend::{Read, ReadError};
use rungc_lower::compile::Compiled;
pub use rungc_syntax::diag::{counted, grouped};
use rungc_syntax::{Program, SourceKind, Span, codes, text};
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use subject::Subject;

/// Outcome of a command, the worst last.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Outcome {
    /// Exit code 0.
    Success,
    /// Neither a proof nor a counterexample: exit code 3.
    Undecided,
    /// Errors in the program or a failed test: exit code 1.
    Failed,
    /// One of several programs could not be worked on, which has been reported: exit code 2.
    Unusable,
    /// The user ended it with Ctrl-C: exit code 130.
    Interrupted,
}

impl Outcome {
    /// By whether a program can be compiled.
    pub fn of(findings: &Findings) -> Self {
        match findings.failed() {
            true => Outcome::Failed,
            false => Outcome::Success,
        }
    }
}

/// Reason why a command could not do its work.
#[derive(Debug)]
pub enum Failure {
    /// Reason why a command cannot run: exit code 2.
    Because(String),
    /// The same, where the report already says it.
    Reported,
    /// The reader of a run's output, such as `head`, has closed it, which ends the run.
    BrokenPipe,
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Failure::Because(reason) => f.write_str(reason),
            Failure::Reported => f.write_str("the input cannot be read"),
            Failure::BrokenPipe => f.write_str("output closed"),
        }
    }
}

impl From<String> for Failure {
    fn from(why: String) -> Self {
        Failure::Because(why)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Failure::Because(error.to_string())
    }
}

impl From<rungc_monitor::Error> for Failure {
    fn from(error: rungc_monitor::Error) -> Self {
        Failure::Because(error.to_string())
    }
}

/// Result of a command.
pub type Result = std::result::Result<Outcome, Failure>;

/// Context of every command.
#[derive(Clone, Copy, Debug)]
pub struct Context {
    /// True if standard error is coloured.
    pub color: bool,
    /// Language of human-readable reports.
    pub language: Chosen,
    /// True if standard output carries the command's result, so that a report for tools goes to standard error.
    pub stdout_in_use: bool,
    /// Verbosity of messages.
    pub verbosity: Verbosity,
}

/// Verbosity of messages.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Verbosity {
    /// Nothing: diagnostics and results alone.
    Quiet,
    /// A closing line for each program.
    Normal,
    /// More details.
    Verbose,
}

impl Context {
    /// Prints what was done, unless `--quiet` is given.
    pub fn note(self, line: &str) {
        if self.verbosity > Verbosity::Quiet {
            eprint_line(line);
        }
    }

    /// Prints a detail, if `--verbose` is given.
    pub fn detail(self, line: impl FnOnce() -> String) {
        if self.verbosity == Verbosity::Verbose {
            eprint_line(&line());
        }
    }
}

/// Reads a program as its author wrote it. That it cannot be read is an object too, for tools.
pub fn read_as_written(
    subject: &Subject,
    reporter: &mut Reporter,
) -> std::result::Result<Read, Failure> {
    match subject::source(subject) {
        Ok(read) => {
            report_idle(subject, read.program.kind, reporter);
            Ok(read)
        }
        Err(error) => Err(unread(&error, subject, reporter)?),
    }
}

/// Reads a program as its author wrote it, with the names that the settings give its devices.
pub fn read_with_names(
    subject: &Subject,
    reporter: &mut Reporter,
) -> std::result::Result<Read, Failure> {
    let mut read = read_as_written(subject, reporter)?;
    if let Some(project) = &subject.project {
        project.name_devices(&subject.file, &mut read.program);
    }
    Ok(read)
}

/// Reports options for reading that have no effect on a program of this kind; among several, they are for others.
fn report_idle(subject: &Subject, kind: SourceKind, reporter: &Reporter) {
    if reporter.many() {
        return;
    }
    let options = [
        ("--compiled", SourceKind::GxWorks2, "a GX Works2 project"),
        ("--names", SourceKind::Plcopen, "PLCopen XML"),
    ];
    for (option, of, what) in options {
        if kind != of && subject.arguments.iter().any(|given| given == option) {
            let file = subject.file.display();
            eprint_line(&format!(
                "rungc: {option} has no effect: {file} is not {what}"
            ));
        }
    }
}

/// Reads a program, and gives it what its settings say of it.
pub fn read(subject: &Subject, reporter: &mut Reporter) -> std::result::Result<Read, Failure> {
    let read = read_as_written(subject, reporter)?;
    completed(read, subject, reporter)
}

/// Gives a program that was read what its settings say of it.
pub fn completed(
    mut read: Read,
    subject: &Subject,
    reporter: &mut Reporter,
) -> std::result::Result<Read, Failure> {
    rungc::unproven::suggest(&mut read, subject.model);
    complete(subject, &mut read.program, reporter)?;
    Ok(read)
}

/// Gives a program what its settings say of it.
pub fn complete(
    subject: &Subject,
    program: &mut Program,
    reporter: &mut Reporter,
) -> std::result::Result<(), Failure> {
    with_settings(subject, program).or_else(|error| {
        subject::report_invalid(error, &subject.reporting, reporter)?;
        Err(Failure::Reported)
    })
}

/// As [`complete`], without a report.
fn with_settings(
    subject: &Subject,
    program: &mut Program,
) -> std::result::Result<(), rungc_project::Error> {
    let Some(project) = &subject.project else {
        return Ok(());
    };
    rungc::settings::complete(project, &subject.file, program, subject.plc())
}

/// Reports that a program cannot be read.
fn unread(error: &ReadError, subject: &Subject, reporter: &mut Reporter) -> io::Result<Failure> {
    let code = match error {
        ReadError::Undecodable { .. }
        | ReadError::NoProgram { .. }
        | ReadError::NoProject { .. } => &codes::UNKNOWN_FORMAT,
        ReadError::Io { .. } | ReadError::TooLarge { .. } => &codes::UNREADABLE_FILE,
    };
    if subject.reporting.format == Format::Human {
        let language = reporter.language(&subject.reporting);
        let (error, title) = (error.to_string(), language::title(language, code));
        let arguments = [
            ("code", code.id.into()),
            ("title", title.as_ref().into()),
            ("message", (&error).into()),
        ];
        eprint_line(&message(language, "unread", &arguments));
    }
    let why = code.at(Span::default(), error.to_string());
    reporter.add(&Findings::unread(&subject.file, why))?;
    Ok(Failure::Reported)
}

/// True once the reader of standard output has closed it.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Returns true if the reader of standard output, such as `head`, has closed it.
pub fn is_output_closed() -> bool {
    CLOSED.load(Ordering::Relaxed)
}

/// Writes a text to standard output, with all written out that a terminal would act on.
pub fn print_text(text: &str) -> io::Result<()> {
    print_bytes(visible(text).as_bytes())
}

/// Writes bytes to standard output. A reader that closes it, such as `head`, changes nothing about the outcome of the
/// command, which continues.
pub fn print_bytes(bytes: &[u8]) -> io::Result<()> {
    match write_bytes(bytes) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
            CLOSED.store(true, Ordering::Relaxed);
            Ok(())
        }
        written => written,
    }
}

/// Writes a text to standard output as [`print_text`] does, for commands that end when the reader closes it.
pub fn stream_text(text: &str) -> io::Result<()> {
    write_bytes(visible(text).as_bytes())
}

fn write_bytes(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let written = out.write_all(bytes).and_then(|()| out.flush());
    written.map_err(|error| io::Error::new(error.kind(), format!("standard output: {error}")))
}

/// Prints a report, or writes the same to the requested file, with `force` or not; `summary` says what is in it.
pub fn put(
    (path, force): (Option<&Path>, bool),
    text: &str,
    summary: &str,
    cx: Context,
) -> std::result::Result<(), Failure> {
    let Some(path) = path else {
        return print_text(text).map_err(Failure::from);
    };
    write_file(path, visible(text).as_bytes(), force)?;
    cx.note(&format!("       Wrote {}: {summary}", path.display()));
    Ok(())
}

/// Prints a line to standard error; a closed standard error does not stop the command.
pub fn eprint_line(line: &str) {
    let _ = writeln!(io::stderr(), "{}", visible(line));
}

/// Findings of reading a program.
pub fn found_reading<'a>(subject: &'a Subject, read: &'a Read) -> Findings<'a> {
    let diagnostics = read.diagnostics.clone();
    Findings::new(
        &subject.file,
        &read.program,
        diagnostics,
        &subject.reporting,
    )
}

/// Findings of reading and compiling a program.
pub fn findings<'a>(subject: &'a Subject, read: &'a Read, compiled: &Compiled) -> Findings<'a> {
    let mut diagnostics = read.diagnostics.clone();
    diagnostics.refine(&other_model::joined(&subject.options(), read, compiled));
    Findings {
        size: Some(compiled.into()),
        step_numbers: compiled.step_numbers.clone(),
        ports: compiled.ports.clone(),
        ..Findings::new(
            &subject.file,
            &read.program,
            diagnostics,
            &subject.reporting,
        )
    }
}

/// Reports findings, and to people a closing line that says `done` (what was accomplished) or that errors prevented it.
pub fn conclude(
    findings: &Findings,
    reporter: &mut Reporter,
    cx: Context,
    done: impl FnOnce() -> String,
) -> Result {
    reporter.add(findings)?;
    if reporter.is_for_people() {
        let name = findings.name(reporter.many());
        let language = findings.language(cx);
        let counts = counts(&findings.totals(), language);
        cx.note(&match findings.failed() {
            true => {
                let arguments = [("name", (&name).into()), ("counts", (&counts).into())];
                message(language, "failed", &arguments)
            }
            false => {
                let done = done();
                let arguments = [("done", (&done).into()), ("counts", (&counts).into())];
                message(language, "closing", &arguments)
            }
        });
    }
    Ok(Outcome::of(findings))
}

/// `0 errors, 1 warning`, and the notes if there are any.
fn counts(totals: &Totals, language: Language) -> String {
    let mut counts = vec![("errors", totals.errors), ("warnings", totals.warnings)];
    if totals.notes > 0 {
        counts.push(("notes", totals.notes));
    }
    listed_counts(&counts, language)
}

/// Numbers with the messages that name what they count, as a list.
pub fn listed_counts(counts: &[(&str, usize)], language: Language) -> String {
    let counts = counts
        .iter()
        .map(|&(id, count)| message(language, id, &[("count", count.into())]));
    let counts: Vec<_> = counts.collect();
    counts.join(&message(language, "comma", &[]))
}

/// Returns an error for a file that `what`, a file in TOML, cannot name: its texts are UTF-8.
fn check_name(file: &Path, what: &str) -> std::result::Result<(), Failure> {
    match file.to_str() {
        Some(_) => Ok(()),
        None => Err(Failure::Because(format!(
            "{}: its name is not UTF-8, so {what} cannot name it; rename it",
            file.display()
        ))),
    }
}

/// The folder that a path lies in.
pub fn parent_dir(path: &Path) -> &Path {
    path.parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// Base name of files made from a program: its name in any script, without characters that no file system accepts. A
/// name in ASCII is that of the module.
pub fn file_name(stem: &str, module: &str) -> String {
    if stem.is_ascii() {
        return module.to_string();
    }
    let refused = |c: char| text::acts(c) || "/\\:*?\"<>|".contains(c);
    stem.trim_start_matches('.').trim().replace(refused, "_")
}

/// The name of a file without folder and extension; of a project folder's `MAIN.wpg` or of `MAIN.csv` the project's.
pub fn stem(subject: &Subject, read: &Read) -> String {
    let source = &read.program.source.name;
    let stem = |path: &Path| path.file_stem().map(|s| s.to_string_lossy().into_owned());
    let plain = match read.program.kind {
        SourceKind::GxDeveloper if !source.to_lowercase().ends_with(".wpg") => Some(source.clone()),
        _ => stem(&subject.file).filter(|_| !subject.is_stdin()),
    };
    let plain = plain.unwrap_or_else(|| "program".to_string());
    match &read.program.title {
        Some(title) if plain.eq_ignore_ascii_case("main") && !title.trim().is_empty() => {
            title.clone()
        }
        _ => plain,
    }
}
