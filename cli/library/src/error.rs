//! Errors of the library.

use crate::Diagnostic;
use rungc_frontend::ReadError;
use std::path::PathBuf;

/// Reason why something could not be done.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The program cannot be read: the file is not there, or is not a program.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The settings cannot be read, have mistakes, or do not fit the program's model.
    #[error("{}", settings(.0))]
    Settings(Box<rungc_project::Error>),
    /// A folder holds several programs, and no settings name one of them.
    #[error(
        "`{folder}` has several programs, such as `{one}` and `{other}`: name one of them, or set `program` in `[project]` of its rungc.toml"
    )]
    SeveralPrograms {
        /// The folder.
        folder: PathBuf,
        /// A program in it.
        one: String,
        /// Another one.
        other: String,
    },
    /// A folder cannot be searched for programs.
    #[error("cannot search `{folder}`: {error}")]
    Search {
        /// The folder.
        folder: PathBuf,
        /// The underlying I/O error.
        error: std::io::Error,
    },
    /// No PLC has this name.
    #[error("{message}; {help}")]
    Model {
        /// What is wrong with the name.
        message: String,
        /// What to do.
        help: String,
    },
    /// The program has errors, so it is not compiled.
    #[error("the program has {} errors; the first: {}", .0.len(), .0.first().map_or_else(String::new, ToString::to_string))]
    Rejected(Vec<Diagnostic>),
    /// A moment that a PLC cannot go to.
    #[error("the snapshot is of another program")]
    OtherProgram,
    /// A question about a program that cannot be read, or has no sense.
    #[error("{0}")]
    Question(String),
    /// A name is that of no device, or a value does not fit the device.
    #[error("{0}")]
    Device(String),
}

impl From<rungc_project::Error> for Error {
    fn from(error: rungc_project::Error) -> Self {
        Error::Settings(Box::new(error))
    }
}

/// The error with the first mistake.
fn settings(error: &rungc_project::Error) -> String {
    let rungc_project::Error::Invalid {
        path,
        text,
        diagnostics,
    } = error
    else {
        return error.to_string();
    };
    let first = diagnostics.iter().next();
    first.map_or_else(
        || error.to_string(),
        |first| {
            let (line, column) = text.line_col(first.span.start);
            let (path, code) = (path.display(), first.code);
            format!("{path}:{line}:{column}: error[{code}]: {}", first.message)
        },
    )
}
