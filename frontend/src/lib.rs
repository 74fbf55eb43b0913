//! Readers and writers of instruction lists, list exports and vendor projects.
//!
//! Every reader gives a [`Program`] and what it found wrong with the source; it never gives up at the first mistake. No reader
//! knows what an instruction computes.

mod csv;
mod encoding;
mod il;
mod listing;
pub mod print;
mod text;

use rungc_syntax::{Diagnostic, Diagnostics, Program, SourceKind, Span, codes};
use std::path::{Path, PathBuf};

pub use il::read_text;

/// A program and what its reader found.
#[derive(Clone, Debug, Default)]
pub struct Read {
    /// What could be read.
    pub program: Program,
    /// What is wrong with the source. After an error the program is incomplete and must not be compiled.
    pub diagnostics: Diagnostics,
}

/// Files over this size are refused, in bytes: a list of a million steps takes a tenth of it.
pub const MAX_SIZE: u64 = 128 << 20;

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
    /// The file is larger than any program.
    #[error("`{name}` is larger than {} MiB", MAX_SIZE >> 20)]
    TooLarge {
        /// The file's name.
        name: String,
    },
    /// The content is in no known encoding or format.
    #[error("`{name}` is neither text nor a known project file")]
    Undecodable {
        /// The file's name.
        name: String,
    },
}

/// Reads a program of any known format, found by its content: a list as text, a list export, with the device comments that lie
/// beside it, a vendor's project.
pub fn read(path: &Path) -> Result<Read, ReadError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let bytes = load(path)?;
    let mut read = read_bytes(&name, &bytes)?;
    if read.program.kind == SourceKind::Csv
        && let Some(comments) = beside(path, "COMMENT.csv")
    {
        let text = encoding::decode(&load(&comments)?);
        read.program.comments = text
            .map(|(text, _)| csv::comments(&text))
            .unwrap_or_default();
    }
    Ok(read)
}

/// Reads the content of a file of any known format. `name` is what diagnostics call it.
pub fn read_bytes(name: &str, bytes: &[u8]) -> Result<Read, ReadError> {
    if bytes.len() as u64 > MAX_SIZE {
        return Err(ReadError::TooLarge {
            name: name.to_owned(),
        });
    }
    let Some((text, replaced)) = encoding::decode(bytes) else {
        return Err(ReadError::Undecodable {
            name: name.to_owned(),
        });
    };
    let mut read = match csv::detect(&text) {
        Some(layout) => csv::read(name, &text, layout),
        None => read_text(name, &text),
    };
    if replaced {
        read.diagnostics.push(undecoded(&read.program));
    }
    Ok(read)
}

/// Some characters of a text were bytes without a meaning in its encoding.
fn undecoded(program: &Program) -> Diagnostic {
    let at = program
        .source
        .text
        .find(char::REPLACEMENT_CHARACTER)
        .unwrap_or(0) as u32;
    codes::DAMAGED
        .at(
            Span::new(at, at + 3),
            "this text holds bytes that no known encoding reads",
        )
        .label("the first of them")
        .help("save the file as UTF-8")
}

fn load(path: &Path) -> Result<Vec<u8>, ReadError> {
    let io = |source| ReadError::Io {
        path: path.display().to_string(),
        source,
    };
    let size = std::fs::metadata(path).map_err(io)?.len();
    if size > MAX_SIZE {
        return Err(ReadError::TooLarge {
            name: path.display().to_string(),
        });
    }
    std::fs::read(path).map_err(io)
}

/// The file of this name, in either case, in the same folder.
fn beside(path: &Path, name: &str) -> Option<PathBuf> {
    find_in(path.parent()?, name)
}

/// The file or folder of this name, in either case, in a folder.
fn find_in(folder: &Path, name: &str) -> Option<PathBuf> {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let mut entries: Vec<_> = std::fs::read_dir(folder).ok()?.flatten().collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    let found = entries
        .into_iter()
        .find(|e| e.file_name().eq_ignore_ascii_case(name))?;
    Some(found.path())
}
