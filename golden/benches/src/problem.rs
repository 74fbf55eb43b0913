//! Why something could not be measured.

use std::path::PathBuf;

/// Why something could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// A program that is needed is not there.
    #[error("not installed: {0}")]
    Missing(String),
    /// A program failed.
    #[error("{command} failed:\n{output}")]
    Failed {
        /// What was run.
        command: String,
        /// What it printed.
        output: String,
    },
    /// Reading or writing failed.
    #[error("{}: {error}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// Something about rungc is wrong: implementations differ, a program does not compile.
    #[error("{0}")]
    Wrong(String),
}

/// What can be measured, or why not.
pub type Result<T> = std::result::Result<T, Problem>;

impl Problem {
    /// Whether a tool is missing, rather than something wrong.
    pub fn is_missing(&self) -> bool {
        matches!(self, Problem::Missing(_))
    }
}
