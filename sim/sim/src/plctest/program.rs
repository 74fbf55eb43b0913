//! The program of a case: a list in the test file, or a file of any format.

use rungc_frontend::Read;
use rungc_lower::compile::{self, Bound, CompileOptions};
use rungc_models::{ModelId, Plc};
use rungc_project::{Error, Project};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The program of a case.
#[derive(Clone, Debug)]
pub enum CaseProgram {
    /// An instruction list in the test file.
    List(String),
    /// A file.
    File(Arc<ProgramFile>),
}

/// A program in a separate file.
#[derive(Clone, Debug)]
pub struct ProgramFile {
    /// Result of reading. Mistakes in it are a matter of the case.
    pub read: Read,
    /// Ranges of operands with an index, from its settings.
    pub bounds: Vec<Bound>,
    /// Codes of errors that are warnings in it.
    pub warn: Vec<&'static str>,
    /// The file.
    pub path: PathBuf,
    /// The settings that name a model, and the model.
    pub settings: Option<(PathBuf, ModelId)>,
}

impl CaseProgram {
    /// Its text: the list, or what diagnostics of the file quote.
    pub fn text(&self) -> &str {
        match self {
            CaseProgram::List(list) => list,
            CaseProgram::File(file) => &file.read.program.source.text,
        }
    }
}

/// A program and the PLC that it is for, if it says so itself.
#[derive(Clone, Debug)]
pub(super) struct Tested {
    pub program: CaseProgram,
    pub plc: Option<Plc>,
}

impl Tested {
    pub fn list(list: String) -> Self {
        Tested {
            program: CaseProgram::List(list),
            plc: None,
        }
    }

    /// In place of what could not be read, which is a separate problem.
    pub fn unread() -> Self {
        Tested {
            program: CaseProgram::List(String::new()),
            plc: Some(Plc::any(ModelId::Fx3u)),
        }
    }
}

/// Reads a program of any format, with the settings of its project.
pub(super) fn read(path: &Path) -> Result<Tested, String> {
    let project = match Project::find(path) {
        Some(settings) => Project::load(&settings).map_err(|error| error_lines(&error))?,
        None => Project::default(),
    };
    let read = rungc_frontend::read_with(path, &project.reading());
    let mut read = read.map_err(|error| error.to_string())?;
    let compiled = CompileOptions {
        model: project.model,
        ..CompileOptions::default()
    };
    let model = compile::model(&read.program, &compiled);
    let found = rungc_structured::compile(&mut read.program, model);
    read.diagnostics.extend(found.iter().cloned());
    let completed = project.complete(path, &mut read.program, model);
    completed.map_err(|error| error_lines(&error))?;
    let variant = project.variant.filter(|v| v.model == model.id);
    Ok(Tested {
        plc: Some(Plc {
            model: model.id,
            variant,
        }),
        program: CaseProgram::File(Arc::new(ProgramFile {
            bounds: project.bounds(path),
            warn: project.check.warn,
            path: path.to_path_buf(),
            settings: project.model.map(|model| (near(project.path), model)),
            read,
        })),
    })
}

/// A path as seen from the current folder, where it lies below it.
pub(super) fn near(path: PathBuf) -> PathBuf {
    let folder = std::env::current_dir().and_then(dunce::canonicalize);
    let below = folder
        .ok()
        .and_then(|f| path.strip_prefix(f).ok().map(Path::to_path_buf));
    below.unwrap_or(path)
}

/// Errors in settings, one per line.
pub(super) fn error_lines(error: &Error) -> String {
    let Error::Invalid {
        path,
        text,
        diagnostics,
    } = error
    else {
        return error.to_string();
    };
    let lines = diagnostics.iter().map(|d| {
        let (line, column) = text.line_col(d.span.start);
        format!("{}:{line}:{column}: {}", path.display(), d.message)
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// A program as the test file names it.
#[derive(Clone)]
pub(super) enum RawProgram {
    List(String),
    /// By its path from the test file.
    File(String),
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    file: String,
}

impl<'de> Deserialize<'de> for RawProgram {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ProgramVisitor)
    }
}

/// Returns true if a text is the path of a file rather than a list: one line that ends like a file name.
fn is_path(text: &str) -> bool {
    let Some(ending) = Path::new(text).extension().and_then(|e| e.to_str()) else {
        return false;
    };
    let letter = ending.starts_with(|c: char| c.is_ascii_alphabetic());
    let name = ending.len() >= 2 && letter && ending.chars().all(|c| c.is_ascii_alphanumeric());
    name && !text.contains('\n')
}

struct ProgramVisitor;

impl<'de> Visitor<'de> for ProgramVisitor {
    type Value = RawProgram;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an instruction list, or the path of a program: \"machine.gxw\"")
    }

    fn visit_str<E>(self, text: &str) -> Result<RawProgram, E> {
        Ok(match is_path(text) {
            true => RawProgram::File(text.to_string()),
            false => RawProgram::List(text.to_string()),
        })
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawProgram, A::Error> {
        let RawFile { file } = RawFile::deserialize(MapAccessDeserializer::new(map))?;
        Ok(RawProgram::File(file))
    }
}
