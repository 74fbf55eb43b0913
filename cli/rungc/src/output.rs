//! Files that commands write. One rule decides whether a file that is there may be replaced ([`permit`]):
//!
//! - an input of this run never: the program, its settings, a test file, whatever was read;
//! - an earlier result of the same kind always: a page by a page, a recording by a recording;
//! - everything else, such as lists, tables, projects and test files, only with `--force`.
//!
//! Files are compared by identity: links and other spellings of a path do not matter.

mod folder;
mod kind;

pub use folder::{free, write_folder};
pub use kind::Kind;

use crate::args::{self, Emit};
use crate::commands::{Failure, parent_dir};
use clap::ArgMatches;
use clap::builder::{MapValueParser, PathBufValueParser, TypedValueParser, ValueParserFactory};
use rungc_project::Project;
use rungc_syntax::inputs;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::ops::Deref;
use std::path::{Component, Path, PathBuf};
use tempfile::NamedTempFile;

/// Value of an option that names what a command writes. All other paths on the command line are inputs.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct OutputPath(PathBuf);

/// Name of the standard stream that a command writes to.
pub const STREAM: &str = "-";

impl OutputPath {
    /// Returns true for `-`.
    fn is_stream(&self) -> bool {
        *self.0 == *Path::new(STREAM)
    }
}

/// Reads any path but an empty one, which names nothing.
impl ValueParserFactory for OutputPath {
    type Parser = MapValueParser<PathBufValueParser, fn(PathBuf) -> OutputPath>;

    fn value_parser() -> Self::Parser {
        PathBufValueParser::new().map(OutputPath)
    }
}

impl From<PathBuf> for OutputPath {
    fn from(path: PathBuf) -> Self {
        OutputPath(path)
    }
}

impl Deref for OutputPath {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

/// Notes the inputs that a command line names, and checks that no output is one of them or another output.
///
/// # Errors
/// The option whose file has another part.
pub fn check_arguments(matches: &ArgMatches) -> Result<(), Failure> {
    let Some((name, command)) = matches.subcommand() else {
        return Ok(());
    };
    if let Some(why) = args::idle(name, command) {
        return Err(Failure::Because(why));
    }
    let mut streams = 0;
    // Values of other types are not paths.
    for id in command.ids() {
        if let Ok(Some(paths)) = command.try_get_many::<PathBuf>(id.as_str()) {
            paths.clone().for_each(|path| inputs::note(path));
            streams += paths.filter(|path| **path == *Path::new(STREAM)).count();
        }
    }
    if streams > 1 {
        let why = "`-` stands for standard input, which can be read only once; name a file";
        return Err(Failure::Because(why.to_owned()));
    }
    let mut used: Vec<(String, PathBuf)> = Vec::new();
    for id in command.ids() {
        let outputs = command.try_get_many::<OutputPath>(id.as_str());
        let files = outputs.ok().flatten().into_iter().flatten();
        for path in files {
            let option = args::long_option(name, id.as_str());
            if path.is_stream() {
                // Results go to standard output; `--trace-frames` alone names standard error so.
                match is_streamed(name, id.as_str(), command) {
                    true => continue,
                    false => return Err(no_stream(&option)),
                }
            }
            let real = resolved(path).unwrap_or_else(|_| path.to_path_buf());
            let part = match used.iter().find(|(_, other)| *other == real) {
                Some((other, _)) => format!("is written by {other}"),
                None if is_input(path) => "is an input of this run".to_owned(),
                None => {
                    used.push((option, real));
                    continue;
                }
            };
            let path = path.display();
            let why = format!("{option} {path}: this file {part}; name another one");
            return Err(Failure::Because(why));
        }
    }
    Ok(())
}

/// Returns true for an option whose `-` is a stream: the results of a command that prints them without it.
fn is_streamed(command: &str, option: &str, matches: &ArgMatches) -> bool {
    match (command, option) {
        (_, "trace_frames") => true,
        ("convert" | "read" | "xref" | "diff" | "test" | "verify", "output") => true,
        ("build", "output") => matches.get_one::<Emit>("emit") == Some(&Emit::Ir),
        ("boards", "output") => matches.get_flag("toml"),
        _ => false,
    }
}

fn no_stream(option: &str) -> Failure {
    let why = "this is not written to standard output; name a file, or `./-` for one of this name";
    Failure::Because(format!("{option} -: {why}"))
}

/// The file of an option; `None` for standard output, which `-` is, too.
pub fn file(output: &Option<OutputPath>) -> Option<&Path> {
    output.as_deref().filter(|path| *path != Path::new(STREAM))
}

/// A path without links and `..`, whose end need not exist: a link whose end is missing leads to where that would be.
pub fn resolved(path: &Path) -> io::Result<PathBuf> {
    follow(path, LINKS)
}

/// Links without an end that a path may have in a row; systems give up at a similar number.
const LINKS: usize = 32;

fn follow(path: &Path, links: usize) -> io::Result<PathBuf> {
    let path = std::path::absolute(path)?;
    let (error, parent, name) = match (dunce::canonicalize(&path), path.parent(), path.file_name())
    {
        (Err(error), Some(parent), Some(name)) => (error, parent, name),
        (canonical, _, _) => return canonical,
    };
    match (std::fs::read_link(&path), links) {
        (Ok(_), 0) => Err(error),
        (Ok(end), _) => follow(&follow(parent, links - 1)?.join(end), links - 1),
        (Err(_), _) => Ok(follow(parent, links)?.join(name)),
    }
}

/// Rejects a path of `key` in a project's settings that leads out of the project's folder, unless the command line
/// allows the folder that it leads to. Links are followed; within an allowed folder they may lead on.
///
/// # Errors
/// The path, and the option that allows it.
pub fn refuse_outside(
    project: &Project,
    key: &str,
    path: &Path,
    allowed: &[PathBuf],
) -> Result<(), Failure> {
    let place = |path: &Path| resolved(path).map_err(|error| at(path, error));
    let own = place(&project.at(Path::new("")).join("."))?;
    let real = place(path)?;
    let named = std::path::absolute(path).unwrap_or_default();
    let is_plain = !path.components().any(|part| part == Component::ParentDir);
    let allows = |folder: &PathBuf| {
        let absolute = std::path::absolute(folder).unwrap_or_default();
        is_plain && named.starts_with(absolute)
            || resolved(folder).is_ok_and(|folder| real.starts_with(folder))
    };
    if real.starts_with(&own) || allowed.iter().any(allows) {
        return Ok(());
    }
    let folder = if real.is_dir() {
        &*real
    } else {
        parent_dir(&real)
    };
    Err(Failure::Because(format!(
        "{}: `{key}` leads out of the project's folder, to {}; `--allow-folder {}` allows it",
        project.path.display(),
        real.display(),
        folder.display()
    )))
}

/// Decides whether a command may write a file of this kind: see the module.
///
/// # Errors
/// Why not, and what to do.
pub fn permit(path: &Path, kind: Kind, force: bool) -> Result<(), Failure> {
    refuse_input(path)?;
    if is_stream(path) {
        let what = "is a stream of a process, not a file; name a file";
        return Err(Failure::Because(format!("{} {what}", path.display())));
    }
    match fs::metadata(path) {
        Ok(found) if !found.is_file() => {
            let what = "already exists and is not a regular file";
            Err(Failure::Because(format!("{} {what}", path.display())))
        }
        Ok(_) if force || kind.replaces(path) => writable(path),
        Ok(_) => Err(Failure::Because(format!(
            "{} already exists{}; use --force to overwrite",
            path.display(),
            kind.difference()
        ))),
        // A broken link, or nothing at all.
        Err(_) => Ok(()),
    }
}

/// Rejects a file that this user may not write, although its folder would let another one take its place.
fn writable(path: &Path) -> Result<(), Failure> {
    let opened = File::options().write(true).open(path);
    opened.map(drop).map_err(|error| at(path, error))
}

/// Returns true for the names of a process's open files, such as `/dev/stdout`. Replaced as files are, they would no
/// longer be what every process of the machine takes them for.
fn is_stream(path: &Path) -> bool {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let devices = ["stdin", "stdout", "stderr", "fd"].map(|name| Path::new("/dev").join(name));
    path.starts_with("/proc") || devices.iter().any(|device| path.starts_with(device))
}

/// The file that a link leads to, if only by its name: it is replaced, and the link stays.
fn target(path: &Path) -> PathBuf {
    /// More links than systems follow.
    const MOST: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST {
        let Ok(next) = fs::read_link(&path) else {
            break;
        };
        path = parent_dir(&path).join(next);
    }
    path
}

/// Rejects files that this run reads.
pub fn refuse_inputs(paths: impl Iterator<Item = PathBuf>) -> Result<(), Failure> {
    paths.into_iter().try_for_each(|path| refuse_input(&path))
}

/// Returns true for a file that this run reads, by whatever path.
fn is_input(path: &Path) -> bool {
    let is_this = |input: &PathBuf| same_file::is_same_file(input, path).unwrap_or(false);
    path.is_file() && inputs::all().iter().any(is_this)
}

/// Rejects a path where a file is that this run reads.
fn refuse_input(path: &Path) -> Result<(), Failure> {
    match is_input(path) {
        true => Err(Failure::Because(format!(
            "{} is an input of this run, which is never overwritten; name another file",
            path.display()
        ))),
        false => Ok(()),
    }
}

/// Rejects a path before long work, where a file is that a command would replace with one of no recognisable kind, or
/// where none can be written.
pub fn spare(path: &Path, force: bool) -> Result<(), Failure> {
    permit(path, Kind::Own, force)?;
    let path = target(path);
    let folder = std::path::absolute(parent_dir(&path)).map_err(|error| at(&path, error))?;
    let there = folder.ancestors().find(|folder| folder.exists());
    let Some(there) = there.filter(|folder| folder.is_dir()) else {
        return Ok(());
    };
    let tried = temporary(0o666).tempfile_in(there);
    tried.map(drop).map_err(|error| at(&path, error))
}

/// Writes a file whole or not at all, as [`permit`] allows.
pub fn write_file(path: &Path, contents: &[u8], force: bool) -> Result<(), Failure> {
    write_whole(path, contents, force, 0o666)
}

/// As [`write_file`], of a program that can be started.
pub fn write_executable(path: &Path, contents: &[u8], force: bool) -> Result<(), Failure> {
    write_whole(path, contents, force, 0o777)
}

/// Writes the files of a project, none of which may exist: all of them, or none.
pub fn write_new(files: &[(PathBuf, &[u8])]) -> Result<(), Failure> {
    let is_there = |(path, _): &&(PathBuf, &[u8])| fs::symlink_metadata(path).is_ok();
    if let Some((path, _)) = files.iter().find(is_there) {
        let why = format!("{} already exists: edit or remove it", path.display());
        return Err(Failure::Because(why));
    }
    let mut written = Vec::new();
    for (path, contents) in files {
        let mut file = AtomicFile::create(path, Kind::Own, false)?;
        let done = file.file.write_all(contents);
        done.map_err(|error| file.failed(error))?;
        written.push(file);
    }
    written.into_iter().try_for_each(AtomicFile::persist)
}

/// Of `mode`, the permissions where the system has them, the user's mask takes its part away.
fn write_whole(path: &Path, contents: &[u8], force: bool, mode: u32) -> Result<(), Failure> {
    let mut file = AtomicFile::with_mode(path, (Kind::of(contents), force), mode)?;
    let written = file.file.write_all(contents);
    written.map_err(|error| file.failed(error))?;
    file.persist()
}

/// Changes a file that the user has named to be changed: a list that is formatted, settings that get a table, an
/// accepted trace. The new contents appear whole or not at all.
pub fn rewrite(path: &Path, contents: &[u8]) -> Result<(), Failure> {
    if path.exists() {
        writable(path)?;
    }
    let file = making(path, 0o666)?;
    let written = file.as_file().write_all(contents);
    let persisted = written.and_then(|()| file.persist(path).map_err(|error| error.error));
    persisted.map_err(|error| at(path, error)).map(drop)
}

/// A file that appears whole or not at all: it is written under another name and renamed when complete. If it is
/// dropped before, nothing has happened.
pub struct AtomicFile {
    file: NamedTempFile,
    path: PathBuf,
    kind: Kind,
    force: bool,
}

impl AtomicFile {
    /// Creates a file of this kind, as [`permit`] allows.
    pub fn create(path: &Path, kind: Kind, force: bool) -> Result<AtomicFile, Failure> {
        AtomicFile::with_mode(path, (kind, force), 0o666)
    }

    fn with_mode(
        path: &Path,
        (kind, force): (Kind, bool),
        mode: u32,
    ) -> Result<AtomicFile, Failure> {
        permit(path, kind, force)?;
        let path = target(path);
        Ok(AtomicFile {
            file: making(&path, mode)?,
            path,
            kind,
            force,
        })
    }

    /// Writer to the file.
    pub fn writer(&self) -> Result<BufWriter<File>, Failure> {
        let file = self.file.reopen().map_err(|error| self.failed(error))?;
        Ok(BufWriter::new(file))
    }

    /// Error with the file's name.
    pub fn failed(&self, error: io::Error) -> Failure {
        at(&self.path, error)
    }

    /// Gives the complete file its name, unless another output of this run has it by now.
    pub fn persist(self) -> Result<(), Failure> {
        let path = self.path;
        permit(&path, self.kind, self.force)?;
        let persisted = self.file.persist(&path).map(|_| ());
        persisted.map_err(|error| at(&path, error.error))
    }
}

/// A file in the making, beside the one that it becomes. Its name means nothing to anybody.
fn making(path: &Path, mode: u32) -> Result<NamedTempFile, Failure> {
    let folder = parent_dir(path);
    make_folder(folder)?;
    let file = temporary(mode).tempfile_in(folder);
    file.map_err(|error| at(path, error))
}

/// Makes a folder, and those above it.
///
/// # Errors
/// Something else has the name of one of them, or the system's error, with the folder's name.
pub fn make_folder(folder: &Path) -> Result<(), Failure> {
    check_folder(folder)?;
    fs::create_dir_all(folder).map_err(|error| at(folder, error))
}

/// Checks that a folder is there, or could be made.
fn check_folder(folder: &Path) -> Result<(), Failure> {
    let mut parents = folder.ancestors();
    let nearest = parents.find(|parent| fs::symlink_metadata(parent).is_ok());
    if let Some(other) = nearest.filter(|nearest| !nearest.is_dir()) {
        let why = format!("{} is not a folder", other.display());
        return Err(Failure::Because(why));
    }
    Ok(())
}

/// Error of the system, with the path that it is about.
pub fn at(path: &Path, error: io::Error) -> Failure {
    Failure::Because(format!("{}: {}", path.display(), plain(error)))
}

/// Error of the system, without the path that a library may have added to it.
fn plain(error: io::Error) -> io::Error {
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
