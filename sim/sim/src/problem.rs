//! Mistakes in TOML files that a user writes, each with its place.

use rungc_syntax::Source;
use serde::de::DeserializeOwned;
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
}

impl Problem {
    /// A problem at a byte of the text.
    pub(crate) fn at(source: &Source, at: usize, message: String) -> Problem {
        let (line, column) = source.line_col(at as u32);
        Problem {
            line,
            column,
            message,
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

fn lines(name: &str, problems: &[Problem]) -> String {
    let line = |p: &Problem| format!("{name}:{}:{}: {}", p.line, p.column, p.message);
    problems.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The text of a file.
pub(crate) fn read(path: &Path) -> Result<Source, LoadError> {
    match std::fs::read_to_string(path) {
        Ok(text) => Ok(Source::new(path.display().to_string(), text)),
        Err(error) => Err(LoadError::Io {
            path: path.to_path_buf(),
            error,
        }),
    }
}

/// Reads the TOML of a file, without looking at what it means.
pub(crate) fn from_toml<T: DeserializeOwned>(source: &Source) -> Result<T, Vec<Problem>> {
    toml::from_str(&source.text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start);
        vec![Problem::at(source, at, plain(error.message()))]
    })
}

/// Message of the TOML reader, in the words of TOML rather than of Rust.
fn plain(message: &str) -> String {
    let words = [
        ("expected f64", "expected a number"),
        ("expected u16", "expected a whole number"),
        ("expected u32", "expected a whole number"),
        ("expected i32", "expected a whole number"),
        (
            "invalid type: map, expected a sequence",
            "write tables of this name in double brackets",
        ),
        ("invalid type: map", "invalid type: table"),
        ("expected a sequence", "expected a list in brackets"),
    ];
    let message = message.to_string();
    words
        .iter()
        .fold(message, |text, (from, to)| text.replace(from, to))
}
