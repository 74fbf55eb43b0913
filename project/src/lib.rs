//! The settings of a project: `rungc.toml`, which lies in the folder of a program or above it.
//!
//! The file is read strictly: a key that is not known, or a value that does not fit, is a diagnostic with its place.
//! Whoever calls decides what a setting does; what the command line says wins over the file.
//!
//! This crate must not know output languages. Start reading at [`Project`].
#![deny(missing_docs)]

pub mod canlink;
pub mod connections;
pub mod device;
mod language;
pub mod modbus;
pub mod module;
mod program;
pub mod property;
mod reader;
pub mod serve;
mod template;

use encoding_rs::Encoding;
use rungc_frontend::{LearnedCodes, Names, ReadOptions, Unsaved};
use rungc_models::{ModelId, Variant};
use rungc_syntax::{
    Device, DeviceClass, DeviceRun, Diagnostic, Diagnostics, Index, Phrase, Source, Span, codes,
    inputs,
};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

pub use language::Language;
pub use template::template;

/// The file's name.
pub const FILE: &str = "rungc.toml";

/// A larger file, in bytes, is rejected.
pub const MAX_SIZE: u64 = 1 << 20;

/// The settings of a project. Paths are as the file gives them, from its own folder on.
#[derive(Clone, Debug, Default)]
pub struct Project {
    /// The file.
    pub path: PathBuf,
    /// Its text, for diagnostics.
    pub source: Source,
    /// The program that the project is about: `[project] program`.
    pub program: Option<PathBuf>,
    /// All files of the program, where `[project] program` lists several in structured text; each stands for all.
    pub parts: Vec<PathBuf>,
    /// Position of `[project] program`.
    pub program_span: Span,
    /// The PLC model: `[project] model`.
    pub model: Option<ModelId>,
    /// The PLC of its family that the program is for, if `[project] model` names one.
    pub variant: Option<&'static Variant>,
    /// Name of the program in emitted code: `[project] name`.
    pub name: Option<String>,
    /// Encoding of texts that are not Unicode: `[project] encoding`.
    pub encoding: Option<&'static Encoding>,
    /// State of the program, a GX Works2 project, that is compiled: `[project] compiled`.
    pub compiled: Option<String>,
    /// `[check]`
    pub check: Check,
    /// Language of human-readable reports: `[report] lang`.
    pub language: Option<Language>,
    /// `[build]`
    pub build: Build,
    /// `[test]`
    pub test: Test,
    /// `[tokens]`: instructions by the bytes that stand for them in vendor projects.
    pub learned: LearnedCodes,
    /// `[index]`: what indexed operands can reach.
    pub index: Vec<Bound>,
    /// `[[modbus]]`: the rows of the Modbus table.
    pub modbus: Vec<modbus::Row>,
    /// `[canlink]`: this PLC as a station of CANlink.
    pub canlink: Option<canlink::Station>,
    /// `[[module]]`: the special modules that are fitted.
    pub modules: Vec<module::Row>,
    /// `[[property]]`: what the program must never do.
    pub properties: Vec<property::Row>,
    /// `[[property]]` with `use` or `matrix`: several properties by one row.
    pub uses: Vec<property::Use>,
    /// The requirements that these name, each once, and those that have no property, in the order of the file.
    pub requirements: Vec<property::Requirement>,
    /// `[verify]`: what is supposed of the machine around it.
    pub verify: property::Verify,
    /// `[latched]`: devices that keep their value over power-off, in place of those of the model for each class that is
    /// named.
    pub latched: Vec<Range>,
    /// `[labels]`: names of devices of the program.
    pub labels: Vec<Label>,
    /// `[retain] file`: where `run` and `serve` keep latched devices.
    pub retain: Option<PathBuf>,
    /// `[retain] fault`: the bit that is on while they cannot be saved.
    pub retain_fault: Option<Range>,
    /// `[plcopen]`: the devices of variables of PLCopen XML.
    pub plcopen: Names,
    /// `[serve]`: servers and serial lines of a running program, and devices that it serves.
    pub serve: serve::Serve,
    /// `[hmi] writes`: devices that operator panels write.
    pub hmi: Vec<Range>,
    /// `[hmi] reads`: devices that operator panels read.
    pub hmi_reads: Vec<Range>,
    /// `[io]`: what terminals and registers of a running program are connected to.
    pub io: Vec<connections::Connected>,
}

/// Findings to report, and their severity: identifiers of codes, such as `W0203`.
#[derive(Clone, Debug, Default)]
pub struct Check {
    /// Warnings that are left out.
    pub allow: Vec<&'static str>,
    /// Errors that become warnings.
    pub warn: Vec<&'static str>,
    /// Warnings that become errors.
    pub deny: Vec<&'static str>,
}

/// Settings of `build`.
#[derive(Clone, Debug, Default)]
pub struct Build {
    /// The machine to build for.
    pub target: Option<Named>,
    /// The description of a board.
    pub board: Option<PathBuf>,
    /// Kind of output.
    pub emit: Option<Named>,
    /// Output path.
    pub output: Option<PathBuf>,
    /// True if emitted C reads and writes devices by number and by name.
    pub access: bool,
}

/// Settings of `test`.
#[derive(Clone, Debug, Default)]
pub struct Test {
    /// Test files and folders of them.
    pub files: Vec<Named>,
    /// Engine for the cases.
    pub engine: Option<Named>,
}

/// A name with its place, whose meaning is the caller's to know.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Named {
    /// The name as written.
    pub text: String,
    /// Position in the file.
    pub span: Span,
}

/// Range of an operand with an index register.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Bound {
    /// Class of the operand.
    pub class: DeviceClass,
    /// Number of the operand, without its index.
    pub number: u32,
    /// The index register.
    pub index: Index,
    /// First number that it reaches.
    pub first: u32,
    /// Last number that it reaches, inclusive.
    pub last: u32,
    /// Position of the range.
    pub span: Span,
}

/// A name of a device, with the place of the device.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Label {
    /// The name, such as `Axis1.Ready`.
    pub name: String,
    /// The device.
    pub device: Device,
    /// Position of the device in the file.
    pub span: Span,
}

/// A range of devices with its place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Range {
    /// Their class.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// Last number, inclusive.
    pub last: u32,
    /// Position of the range.
    pub span: Span,
}

/// Reason why a file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The system says so.
    #[error("cannot read `{}`: {error}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The underlying I/O error.
        error: io::Error,
    },
    /// The file has mistakes.
    #[error("`{}` has errors", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// Its text.
        text: Box<Source>,
        /// Its mistakes: at least one error.
        diagnostics: Diagnostics,
    },
}

impl Range {
    /// One device.
    pub fn one(Device { class, number }: Device, span: Span) -> Self {
        Range {
            class,
            first: number,
            last: number,
            span,
        }
    }

    /// The devices as a run.
    pub fn run(&self) -> DeviceRun {
        DeviceRun {
            class: self.class,
            first: self.first,
            count: self.last - self.first + 1,
        }
    }
}

/// What to do with a program in the place of settings.
const PROGRAM: &str = "its settings are in a file `rungc.toml` (`rungc init`)";

impl Project {
    /// The file that is for a program or a folder: in its own folder, else in the nearest one above.
    pub fn find(path: &Path) -> Option<PathBuf> {
        let path = std::path::absolute(path).ok()?;
        // Through `..` and links as the system goes, where there is something at the path.
        let path = dunce::canonicalize(&path).unwrap_or(path);
        path.ancestors()
            .map(|folder| folder.join(FILE))
            .find(|file| file.is_file())
    }

    /// Reads a file.
    pub fn load(path: &Path) -> Result<Project, Error> {
        let io = |error| Error::Io {
            path: path.to_owned(),
            error,
        };
        inputs::open(path).map_err(io)?;
        let mut bytes = Vec::new();
        let file = std::fs::File::open(path).map_err(io)?;
        file.take(MAX_SIZE + 1)
            .read_to_end(&mut bytes)
            .map_err(io)?;
        if bytes.len() as u64 > MAX_SIZE {
            let message = format!("it is larger than {} MiB", MAX_SIZE >> 20);
            return Err(io(io::Error::new(io::ErrorKind::InvalidData, message)));
        }
        let other = |why| io(io::Error::new(io::ErrorKind::InvalidData, why));
        let text = rungc_frontend::settings_text(path, bytes, PROGRAM).map_err(other)?;
        Project::parse(path, &text).map_err(|error| {
            rungc_frontend::not_settings(path, &text, PROGRAM).map_or(error, other)
        })
    }

    /// Reads a file, or what an editor has not saved of it.
    pub fn load_with(path: &Path, unsaved: &Unsaved) -> Result<Project, Error> {
        match unsaved.get(path) {
            Some(text) => Project::parse(path, text),
            None => Project::load(path),
        }
    }

    /// Reads the text of a file. `path` is what it is called, and where its paths begin.
    pub fn parse(path: &Path, text: &str) -> Result<Project, Error> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let source = Source::new(name, text.strip_prefix('\u{feff}').unwrap_or(text));
        let (project, diagnostics) = reader::read(&source.text);
        if diagnostics.has_errors() {
            return Err(Error::Invalid {
                path: path.to_owned(),
                text: Box::new(source),
                diagnostics,
            });
        }
        Ok(Project {
            path: path.to_owned(),
            source,
            ..project
        })
    }

    /// That a value does not fit, for what only the caller can know.
    pub fn error(&self, why: Diagnostic) -> Error {
        let mut diagnostics = Diagnostics::new();
        diagnostics.push(why);
        self.invalid(diagnostics)
    }

    /// That several values do not fit.
    pub fn invalid(&self, diagnostics: Diagnostics) -> Error {
        Error::Invalid {
            path: self.path.clone(),
            text: Box::new(self.source.clone()),
            diagnostics,
        }
    }

    /// Options for reading programs of the project.
    pub fn reading(&self) -> ReadOptions {
        ReadOptions {
            learned: self.learned.clone(),
            encoding: self.encoding,
            names: self.plcopen.clone(),
            compiled_state: self.compiled.clone(),
            parts: self.parts.iter().map(|part| self.at(part)).collect(),
            ..ReadOptions::default()
        }
    }

    /// A path of the file, as seen from the caller's folder.
    pub fn at(&self, path: &Path) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }

    /// The program that the project is about, as seen from the caller's folder.
    pub fn program(&self) -> Option<PathBuf> {
        self.program.as_deref().map(|program| self.at(program))
    }

    /// Returns true if the file has a `[[property]]`.
    pub fn has_properties(&self) -> bool {
        !(self.properties.is_empty() && self.uses.is_empty())
    }

    /// Returns true if this file is the program of the project, or one of several that are.
    pub fn is_about(&self, file: &Path) -> bool {
        let place = |path: &Path| path.canonicalize().ok();
        let parts = self.parts.iter().map(|part| self.at(part));
        let mut all = self.program().into_iter().chain(parts);
        let file = place(file);
        file.is_some() && all.any(|program| place(&program) == file)
    }

    /// The first file of the program, for one of several that are it, or for their folder; other files stand for
    /// themselves.
    pub fn whole(&self, file: PathBuf) -> PathBuf {
        let is_own = |folder: &Path| folder.is_dir() && folder.canonicalize().ok() == self.folder();
        match self.program().filter(|_| !self.parts.is_empty()) {
            Some(program) if self.is_about(&file) || is_own(&file) => program,
            _ => file,
        }
    }

    /// The folder of the file.
    fn folder(&self) -> Option<PathBuf> {
        self.at(Path::new(".")).canonicalize().ok()
    }
}

impl Project {
    /// That there is nothing at a path of the file, which is at this place.
    pub fn absent(&self, path: &Path, place: Span) -> Option<Error> {
        let at = self.at(path);
        if at.exists() {
            return None;
        }
        let why = codes::PROJECT_VALUE.at(place, format!("there is no `{}`", path.display()));
        let folder = self.path.parent().unwrap_or(Path::new("")).display();
        Some(self.error(why.help(format!(
            "paths begin at the folder of this file, `{folder}`"
        ))))
    }
}

impl Named {
    /// That it does not fit its key.
    pub fn error(&self, why: impl Into<Phrase>) -> Diagnostic {
        codes::PROJECT_VALUE.at(self.span, why)
    }
}
