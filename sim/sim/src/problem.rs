//! Mistakes in TOML files that a user writes, each with its place.

use rungc_frontend::{not_settings, settings_file};
use rungc_syntax::codes::Code;
use rungc_syntax::{Diagnostics, Source, Span, inputs, toml_words};
use serde::de::DeserializeOwned;
use std::fmt;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

/// A mistake in a file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Problem {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// Position in the text.
    pub span: Span,
    /// Description of the error.
    pub message: String,
    /// Remedy, if one is known.
    pub help: Option<String>,
}

impl Problem {
    /// A problem at a byte of the text.
    pub(crate) fn at(source: &Source, at: usize, message: String) -> Problem {
        let (line, column) = source.line_col(at as u32);
        Problem {
            line,
            column,
            span: toml_words::token(&source.text, at),
            message,
            help: None,
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.help {
            Some(help) => write!(f, "{}; {help}", self.message),
            None => f.write_str(&self.message),
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
    #[error("{}", lines(file, problems))]
    Format {
        /// Code of the mistakes.
        code: &'static Code,
        /// The file.
        file: Box<Source>,
        /// Its problems.
        problems: Vec<Problem>,
    },
}

impl From<LoadError> for rungc_project::Error {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::Io { path, error } => rungc_project::Error::Io { path, error },
            LoadError::Format {
                code,
                file,
                problems,
            } => {
                let mut diagnostics = Diagnostics::new();
                for Problem {
                    span,
                    message,
                    help,
                    ..
                } in problems
                {
                    let mut diagnostic = code.at(span, message);
                    diagnostic.help = help.map(Into::into);
                    diagnostics.push(diagnostic);
                }
                rungc_project::Error::Invalid {
                    path: PathBuf::from(&file.name),
                    text: file,
                    diagnostics,
                }
            }
        }
    }
}

fn lines(source: &Source, problems: &[Problem]) -> String {
    let line = |p: &Problem| format!("{}:{}:{}: {p}", source.name, p.line, p.column);
    problems.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The text of a file. Its name is the start of paths to files that it names, so it has to be UTF-8, too.
pub(crate) fn read(path: &Path) -> Result<Source, LoadError> {
    let io = |error| LoadError::Io {
        path: path.to_path_buf(),
        error,
    };
    inputs::open(path).map_err(io)?;
    if path.to_str().is_none() {
        let what = "its name, or that of its folder, is not UTF-8; rename it";
        return Err(io(Error::new(ErrorKind::InvalidInput, what)));
    }
    let text = settings_file(path, PROGRAM).map_err(io)?;
    Ok(Source::new(path.display().to_string(), text))
}

/// What to do with a program in the place of a test file.
const PROGRAM: &str =
    "check it with `rungc check`; a test file names it: `program = { file = \"…\" }`";

/// Reads the TOML of a file, without looking at what it means.
pub(crate) fn from_toml<T: DeserializeOwned>(source: &Source) -> Result<T, Vec<Problem>> {
    toml::from_str(&source.text).map_err(|error| {
        let is_toml = source.text.parse::<toml::Table>().is_ok();
        let other = not_settings(Path::new(&source.name), &source.text, PROGRAM);
        if let Some(what) = other.filter(|_| !is_toml) {
            return vec![Problem::at(source, 0, what)];
        }
        let at = error.span().map_or(0, |span| span.start);
        let (message, help) = toml_words::message_at(&source.text, at, error.message());
        vec![Problem {
            help,
            ..Problem::at(source, at, message)
        }]
    })
}
