//! Recognition of structured text. Its instructions depend on the model, so they come when it is compiled for one.

mod contents;
pub(crate) mod program;

use crate::{MAX_SIZE, Read, ReadError, ReadOptions, encoding};
use contents::Contents;
use program::Joined;
use rungc_syntax::{Program, Source, SourceKind};
use std::path::{Path, PathBuf};
use walkdir::WalkDir;

/// Keywords that a text of declarations and statements begins with.
const FIRST: [&str; 6] = [
    "PROGRAM",
    "FUNCTION",
    "FUNCTION_BLOCK",
    "TYPE",
    "VAR_GLOBAL",
    "CONFIGURATION",
];

/// Returns true for a file that is called one of structured text.
pub(crate) fn is_named(name: &str) -> bool {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending);
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("st"))
}

/// Returns true for structured text, by its name or by what it begins with and holds. Units of other languages have
/// declarations, too, but no statements that end in `;`.
pub(crate) fn detect(name: &str, text: &str) -> bool {
    const END_OF_DECLARATIONS: &str = "END_VAR";
    let body = || {
        let declared = text.to_ascii_uppercase().rfind(END_OF_DECLARATIONS);
        declared.map_or(text, |at| &text[at + END_OF_DECLARATIONS.len()..])
    };
    is_named(name) || begins(text) && body().contains(';')
}

/// Returns true if the first word that is not a comment begins a unit.
fn begins(text: &str) -> bool {
    let mut rest = text.trim_start_matches('\u{FEFF}').trim_start();
    while let Some(comment) = rest.strip_prefix("(*") {
        let Some((_, after)) = comment.split_once("*)") else {
            return false;
        };
        rest = after.trim_start();
    }
    let word = rest
        .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .next();
    word.is_some_and(|word| FIRST.iter().any(|first| word.eq_ignore_ascii_case(first)))
}

/// A program whose instructions are not there yet.
pub(crate) fn read(name: &str, text: &str) -> Read {
    read_source(Source::new(name, text))
}

/// A program of a file and those that define what it uses.
pub(crate) fn read_joined(
    name: &str,
    joined: &Joined,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    let mut read = read_files(name, &joined.files, options)?;
    let notes = joined.notes(&read.program.source);
    read.diagnostics.extend(notes);
    Ok(read)
}

/// A program of several files.
pub(crate) fn read_files(
    name: &str,
    files: &[PathBuf],
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    let mut texts = Vec::new();
    let mut damaged = Vec::new();
    let mut size = 0;
    for file in files {
        let bytes = options.load(file)?;
        let path = near(file).display().to_string();
        size += bytes.len() as u64;
        if size > MAX_SIZE {
            return Err(ReadError::TooLarge { name: path });
        }
        let encoding = options.unsaved.encoding(file).or(options.encoding);
        let Some((text, is_damaged)) = encoding::decode(&bytes, encoding) else {
            return Err(ReadError::Undecodable { name: path });
        };
        if is_damaged {
            damaged.push(texts.len());
        }
        texts.push((path, text));
    }
    let mut read = read_source(Source::joined(name, texts));
    let source = &read.program.source;
    let spans = source.spans();
    let is_utf8 = options.encoding.is_none();
    let found = damaged
        .into_iter()
        .map(|at| crate::undecoded(source, spans[at], is_utf8));
    let found: Vec<_> = found.collect();
    read.diagnostics.extend(found);
    Ok(read)
}

/// A path as seen from the current folder, where it lies below it.
fn near(path: &Path) -> &Path {
    let folder = std::env::current_dir().and_then(dunce::canonicalize);
    let below = folder
        .ok()
        .and_then(|folder| path.strip_prefix(folder).ok());
    let path = below.unwrap_or(path);
    path.strip_prefix(".").unwrap_or(path)
}

/// The files of structured text in a folder and below, in the order of their paths. Hidden folders and those called
/// `target` are left out.
pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let is_meant = |entry: &walkdir::DirEntry| {
        entry.depth() == 0 || !entry.file_type().is_dir() || !crate::search::is_left_out(entry)
    };
    let entries = WalkDir::new(folder).sort_by_file_name().into_iter();
    let entries = entries.filter_entry(is_meant).flatten();
    let files = entries.filter(|entry| entry.file_type().is_file());
    let files = files.map(walkdir::DirEntry::into_path);
    files
        .filter(|path| is_named(&path.to_string_lossy()))
        .collect()
}

/// Returns true if the files of a folder are one program: it has files of structured text, and one of them states the
/// tasks, or has no program.
pub(crate) fn is_project(folder: &Path) -> bool {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return false;
    };
    let files = entries.flatten().map(|entry| entry.path());
    let files = files.filter(|path| is_named(&path.to_string_lossy()) && path.is_file());
    let kinds: Vec<_> = files.filter_map(|path| kind(&path)).collect();
    let has = |kind| kinds.contains(&kind);
    has(Kind::Tasks) || has(Kind::Program) && has(Kind::Part)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Tasks,
    Program,
    Part,
}

/// What the units of a file are.
fn kind(path: &Path) -> Option<Kind> {
    let bytes = std::fs::read(path).ok()?;
    let (text, _) = encoding::decode(&bytes, None)?;
    let Contents {
        programs,
        defined,
        has_tasks,
        ..
    } = Contents::of(&text);
    match (has_tasks, !programs.is_empty(), !defined.is_empty()) {
        (true, ..) => Some(Kind::Tasks),
        (_, true, _) => Some(Kind::Program),
        (_, _, true) => Some(Kind::Part),
        _ => None,
    }
}

fn read_source(source: Source) -> Read {
    Read {
        program: Program {
            source,
            kind: SourceKind::StructuredText,
            unread: vec![0],
            ..Program::default()
        },
        ..Read::default()
    }
}
