//! Reasons why something could not be measured.

use std::path::PathBuf;

/// Reason why something could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// A program that is needed is not there.
    #[error("not installed: {0}")]
    Missing(String),
    /// A program failed.
    #[error("{command} failed:\n{output}")]
    Failed {
        /// The command.
        command: String,
        /// Its output.
        output: String,
    },
    /// Reading or writing failed.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The error.
        error: std::io::Error,
    },
    /// Something about rungc is wrong: implementations differ, a program does not compile.
    #[error("{0}")]
    Wrong(String),
}

/// A measurement, or the reason why there is none.
pub type Result<T> = std::result::Result<T, Problem>;

impl Problem {
    /// Returns true if a tool is missing, rather than something wrong.
    pub fn is_missing(&self) -> bool {
        matches!(self, Problem::Missing(_))
    }
}
