//! The commands. Each returns whether all went well; what stops a command before it can answer is a [`Failure`].

pub mod boards;
pub mod build;
pub mod check;
pub mod convert;
mod defaults;
pub mod diff;
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
mod ports;
mod properties;
pub mod read;
pub mod run;
pub mod serve;
pub mod setting;
pub mod stats;
pub mod subject;
pub mod test;
mod together;
mod unproven;
pub mod verify;
pub mod view;
pub mod xref;

use crate::args::Format;
use crate::report::{Findings, Reporter, Totals, visible};
use rungc_frontend::{Read, ReadError};
use rungc_lower::compile::{self, CompileOptions, Compiled};
pub use rungc_syntax::diag::{counted, grouped};
use rungc_syntax::{SourceKind, Span, codes, text};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use subject::Subject;
use tempfile::NamedTempFile;

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
    /// The reader of the output, such as `head`, has closed it: no failure at all.
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
        match error.kind() {
            io::ErrorKind::BrokenPipe => Failure::BrokenPipe,
            _ => Failure::Because(error.to_string()),
        }
    }
}

/// Result of a command.
pub type Result = std::result::Result<Outcome, Failure>;

/// Context of every command.
#[derive(Clone, Copy, Debug)]
pub struct Context {
    /// True if standard error is coloured.
    pub color: bool,
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
        Ok(read) => Ok(read),
        Err(error) => Err(unread(&error, subject, reporter)?),
    }
}

/// Reads a program, and gives it what its settings say of it.
pub fn read(subject: &Subject, reporter: &mut Reporter) -> std::result::Result<Read, Failure> {
    let mut read = read_as_written(subject, reporter)?;
    unproven::suggest(&mut read, subject.model);
    if let Some(project) = &subject.project {
        let options = CompileOptions {
            model: subject.model,
            ..CompileOptions::default()
        };
        let model = compile::model(&read.program, &options);
        if let Err(error) = project.complete(&subject.file, &mut read.program, model) {
            subject::report_invalid(error, &subject.reporting, reporter)?;
            return Err(Failure::Reported);
        }
    }
    Ok(read)
}

/// Reports that a program cannot be read.
fn unread(error: &ReadError, subject: &Subject, reporter: &mut Reporter) -> io::Result<Failure> {
    let code = match error {
        ReadError::Undecodable { .. }
        | ReadError::NoProgram { .. }
        | ReadError::NoProject { .. } => &codes::UNKNOWN_FORMAT,
        ReadError::Io { .. } | ReadError::TooLarge { .. } => &codes::UNREADABLE_FILE,
    };
    let id = code.id;
    if subject.reporting.format == Format::Human {
        eprint_line(&format!(
            "rungc: error[{id}]: {error}\n       for more, run `rungc explain {id}`"
        ));
    }
    let why = code.at(Span::default(), error.to_string());
    reporter.add(&Findings::unread(&subject.file, why))?;
    Ok(Failure::Reported)
}

/// Writes a text to standard output, with all written out that a terminal would act on.
pub fn print_text(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(visible(text).as_bytes())?;
    out.flush()
}

/// Prints a report, or writes it to the requested file; `summary` says what is in it.
pub fn put(
    path: Option<&Path>,
    text: &str,
    summary: &str,
    cx: Context,
) -> std::result::Result<(), Failure> {
    let Some(path) = path else {
        return print_text(text).map_err(Failure::from);
    };
    let file = AtomicFile::create(path)?;
    let written = file.writer()?.write_all(text.as_bytes());
    written.map_err(|error| file.failed(error))?;
    file.persist()?;
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
    diagnostics.refine(&compiled.diagnostics);
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
        cx.note(&match findings.failed() {
            true => format!("      Failed {name}: {}", counts(&findings.totals())),
            false => format!("{}: {}", done(), counts(&findings.totals())),
        });
    }
    Ok(Outcome::of(findings))
}

/// `0 errors, 1 warning`, and the notes if there are any.
fn counts(totals: &Totals) -> String {
    let counts = format!(
        "{}, {}",
        counted(totals.errors, "error"),
        counted(totals.warnings, "warning")
    );
    match totals.notes {
        0 => counts,
        notes => format!("{counts}, {}", counted(notes, "note")),
    }
}

/// Writes a file whole or not at all; does not replace one unless `force`.
pub fn write_file(path: &Path, contents: &[u8], force: bool) -> std::result::Result<(), Failure> {
    write_whole(path, contents, force, 0o666)
}

/// As [`write_file`], of a program that can be started.
pub fn write_executable(
    path: &Path,
    contents: &[u8],
    force: bool,
) -> std::result::Result<(), Failure> {
    write_whole(path, contents, force, 0o777)
}

/// Rejects a path where a file is, unless `force`.
pub fn spare(path: &Path, force: bool) -> std::result::Result<(), Failure> {
    match path.exists() && !force {
        true => Err(Failure::Because(format!(
            "{} already exists; use --force to overwrite",
            path.display()
        ))),
        false => Ok(()),
    }
}

/// Of `mode`, the permissions where the system has them, the user's mask takes its part away.
fn write_whole(
    path: &Path,
    contents: &[u8],
    force: bool,
    mode: u32,
) -> std::result::Result<(), Failure> {
    spare(path, force)?;
    let mut file = AtomicFile::with_mode(path, mode)?;
    let written = file.file.write_all(contents);
    written.map_err(|error| file.failed(error))?;
    file.persist()
}

/// A file that appears whole or not at all: it is written under another name and renamed when complete. If it is
/// dropped before, nothing has happened.
pub struct AtomicFile {
    file: NamedTempFile,
    path: PathBuf,
}

impl AtomicFile {
    /// Creates a file, which replaces an existing one.
    pub fn create(path: &Path) -> std::result::Result<AtomicFile, Failure> {
        AtomicFile::with_mode(path, 0o666)
    }

    fn with_mode(path: &Path, mode: u32) -> std::result::Result<AtomicFile, Failure> {
        let at = |error: io::Error| Failure::Because(format!("{}: {error}", path.display()));
        if path.exists() && !path.is_file() {
            let what = "already exists and is not a regular file";
            return Err(Failure::Because(format!("{} {what}", path.display())));
        }
        let folder = parent_dir(path);
        if folder.exists() && !folder.is_dir() {
            let (path, folder) = (path.display(), folder.display());
            return Err(Failure::Because(format!(
                "{path}: {folder} is not a folder"
            )));
        }
        fs::create_dir_all(folder).map_err(at)?;
        // The file in the making has a name that means nothing to anybody.
        let file = temporary(mode).tempfile_in(folder);
        Ok(AtomicFile {
            file: file.map_err(|error| at(plain(error)))?,
            path: path.to_path_buf(),
        })
    }

    /// Writer to the file.
    pub fn writer(&self) -> std::result::Result<BufWriter<File>, Failure> {
        let file = self.file.reopen().map_err(|error| self.failed(error))?;
        Ok(BufWriter::new(file))
    }

    /// Error with the file's name.
    pub fn failed(&self, error: io::Error) -> Failure {
        Failure::Because(format!("{}: {error}", self.path.display()))
    }

    /// Gives the complete file its name.
    pub fn persist(self) -> std::result::Result<(), Failure> {
        let path = self.path;
        let persisted = self.file.persist(&path).map(|_| ());
        persisted.map_err(|error| Failure::Because(format!("{}: {}", path.display(), error.error)))
    }
}

/// Error of the system, without the path that a library may have added to it.
pub fn plain(error: io::Error) -> io::Error {
    match (error.raw_os_error(), error.get_ref()) {
        (None, Some(_)) => error.kind().into(),
        _ => error,
    }
}

/// Makes temporary files with these permissions, which are Unix's.
#[cfg(unix)]
fn temporary(mode: u32) -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    builder
}

/// Makes temporary files; there are no permissions of this kind.
#[cfg(not(unix))]
fn temporary(_mode: u32) -> tempfile::Builder<'static, 'static> {
    tempfile::Builder::new()
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
