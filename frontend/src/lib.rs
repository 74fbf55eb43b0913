//! Readers and writers of instruction lists, list exports and vendor projects.
//!
//! Every reader gives a [`Program`] and what it found wrong with the source; it never gives up at the first mistake. No reader
//! knows what an instruction computes.

mod il;

use rungc_syntax::{Diagnostics, Program};
use std::path::Path;

pub use il::read_text;

/// A program and what its reader found.
#[derive(Clone, Debug, Default)]
pub struct Read {
    /// What could be read.
    pub program: Program,
    /// What is wrong with the source. After an error the program is incomplete and must not be compiled.
    pub diagnostics: Diagnostics,
}

/// Why nothing at all could be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file or folder cannot be opened or read.
    #[error("cannot read `{path}`: {source}")]
    Io {
        /// Its path.
        path: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The content is in no known encoding or format.
    #[error("`{name}` is neither text nor a known project file")]
    Undecodable {
        /// The file's name.
        name: String,
    },
}

/// Reads a file of any known format, found by its content.
pub fn read(path: &Path) -> Result<Read, ReadError> {
    let bytes = std::fs::read(path).map_err(|source| ReadError::Io {
        path: path.display().to_string(),
        source,
    })?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    read_bytes(&name, &bytes)
}

/// Reads the content of a file of any known format. `name` is what diagnostics call it.
pub fn read_bytes(name: &str, bytes: &[u8]) -> Result<Read, ReadError> {
    let text = std::str::from_utf8(bytes).map_err(|_| ReadError::Undecodable {
        name: name.to_owned(),
    })?;
    Ok(read_text(name, text))
}
