//! Mistakes in TOML files that a user writes, each with its place.

use rungc_frontend::{Recognised, is_meant_as_toml, is_program, recognise};
use rungc_syntax::{Source, inputs, toml_words};
use serde::de::DeserializeOwned;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

/// A mistake in a file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Problem {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// Description of the error.
    pub message: String,
    /// The line.
    pub text: String,
}

impl Problem {
    /// A problem at a byte of the text.
    pub(crate) fn at(source: &Source, at: usize, message: String) -> Problem {
        let (line, column) = source.line_col(at as u32);
        let text = source.text.lines().nth(line as usize - 1);
        Problem {
            line,
            column,
            message,
            text: text.unwrap_or_default().to_string(),
        }
    }
}

/// Reason why a file could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// It could not be read.
    #[error("{}: {error}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The underlying I/O error.
        error: std::io::Error,
    },
    /// Mistakes in it, one a line.
    #[error("{}", lines(name, problems))]
    Format {
        /// The file's name.
        name: String,
        /// Its problems.
        problems: Vec<Problem>,
    },
}

impl LoadError {
    /// The error with the lines in question and a mark below each place.
    pub fn report(&self) -> String {
        let LoadError::Format { name, problems } = self else {
            return self.to_string();
        };
        let shown = problems.iter().map(|problem| {
            let message = lines(name, std::slice::from_ref(problem));
            let place = (problem.line, problem.column);
            message + &toml_words::marked(&problem.text, place)
        });
        shown.collect::<Vec<_>>().join("\n")
    }
}

fn lines(name: &str, problems: &[Problem]) -> String {
    let line = |p: &Problem| format!("{name}:{}:{}: {}", p.line, p.column, p.message);
    problems.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The text of a file.
pub(crate) fn read(path: &Path) -> Result<Source, LoadError> {
    inputs::note(path);
    let io = |error| LoadError::Io {
        path: path.to_path_buf(),
        error,
    };
    let text = String::from_utf8(std::fs::read(path).map_err(io)?).map_err(|error| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let what = other_kind(&name, error.as_bytes());
        let what = what.unwrap_or_else(|| "it is not text in UTF-8".to_owned());
        io(Error::new(ErrorKind::InvalidData, what))
    })?;
    Ok(Source::new(path.display().to_string(), text))
}

/// Description of a file that is not TOML, and what to do with it.
fn other_kind(name: &str, bytes: &[u8]) -> Option<String> {
    if let Some(Recognised { what, help }) = recognise(name, bytes) {
        return Some(format!("this is {what}: {help}"));
    }
    let help = "check it with `rungc check`; a test file names it: `program = { file = \"…\" }`";
    is_program(bytes).then(|| format!("this is a program: {help}"))
}

/// Reads the TOML of a file, without looking at what it means.
pub(crate) fn from_toml<T: DeserializeOwned>(source: &Source) -> Result<T, Vec<Problem>> {
    toml::from_str(&source.text).map_err(|error| {
        let is_toml = source.text.parse::<toml::Table>().is_ok() || is_meant_as_toml(&source.text);
        let other = other_kind(&source.name, source.text.as_bytes());
        if let Some(what) = other.filter(|_| !is_toml) {
            return vec![Problem::at(source, 0, what)];
        }
        let at = error.span().map_or(0, |span| span.start);
        vec![Problem::at(
            source,
            at,
            toml_words::message(error.message()),
        )]
    })
}
