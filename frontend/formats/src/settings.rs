//! Files of rungc in TOML: their text, and what a file in the place of one is.

use crate::encoding;
use crate::recognise::{Recognised, is_meant_as_toml, is_program, recognise};
use std::path::Path;
use std::{fs, io};

/// Reads a file in TOML, as [`settings_text`] does.
///
/// # Errors
/// What the system says, or what the file is instead.
pub fn settings_file(path: &Path, program: &str) -> io::Result<String> {
    let text = settings_text(path, fs::read(path)?, program);
    text.map_err(|why| io::Error::new(io::ErrorKind::InvalidData, why))
}

/// The text of a file in TOML, which is UTF-8. `program` is what to do with a program in its place.
///
/// # Errors
/// What the file is instead, or its encoding, with what to do.
pub fn settings_text(path: &Path, bytes: Vec<u8>, program: &str) -> Result<String, String> {
    let bytes = match String::from_utf8(bytes) {
        Ok(text) => return Ok(text),
        Err(error) => error.into_bytes(),
    };
    let text = encoding::decode(&bytes, None).map(|(text, _)| text);
    let is_toml = text.is_some_and(|text| is_meant_as_toml(text.trim_start_matches('\u{FEFF}')));
    let other = other_kind(path, &bytes, program).filter(|_| !is_toml);
    Err(other.unwrap_or_else(|| {
        let encoding = match *bytes {
            [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => "UTF-16",
            _ => "not UTF-8",
        };
        format!("it is {encoding}; save it as UTF-8")
    }))
}

/// Description of a text with mistakes in its TOML that is another kind of file, and what to do with it; `None` if it
/// is meant as TOML. `program` is what to do with a program.
pub fn not_settings(path: &Path, text: &str, program: &str) -> Option<String> {
    // Settings of other programs (INI) look the same, and an empty file may be meant.
    let has_tables = text.lines().any(|line| line.trim_start().starts_with('['));
    if text.trim().is_empty() || has_tables || is_meant_as_toml(text) {
        return None;
    }
    other_kind(path, text.as_bytes(), program)
}

fn other_kind(path: &Path, bytes: &[u8], program: &str) -> Option<String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if let Some(Recognised { what, help }) = recognise(&name, bytes) {
        return Some(format!("this is {what}: {help}"));
    }
    is_program(bytes).then(|| format!("this is a program: {program}"))
}
