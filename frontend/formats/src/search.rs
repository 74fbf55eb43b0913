//! Finding the programs in a folder.

use crate::{GX_DEVELOPER, csv, encoding, find, image, main_file, plcopen, structured};
use rungc_syntax::inputs;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use walkdir::{DirEntry, WalkDir};

/// Size of the part of a table that shows whether it is a list export, in bytes: its headers are in the first rows.
const HEAD: u64 = 64 << 10;

/// Returns true if a folder is itself a program: that of a GX Developer project, of a list export alone, or of several
/// files in structured text.
pub fn is_project(folder: &Path) -> bool {
    let is_alone = || programs(folder, usize::MAX).is_ok_and(|found| found.len() < 2);
    is_of_gx_developer(folder)
        || structured::is_project(folder)
        || main_file(folder).is_ok() && is_alone()
}

fn is_of_gx_developer(folder: &Path) -> bool {
    GX_DEVELOPER
        .iter()
        .any(|place| find(folder, place).is_some())
}

/// All programs in a folder and, to this depth (1: in itself), below, in the order of their paths: instruction lists
/// (`.il`), structured text (`.st`, or the folder of several files of one program), list exports (`.csv`), GX Developer
/// projects (their folders), GX Works2 projects (`.gxw`), FXGP/WIN programs (`.pmw`), images of program memory (`.bin`)
/// and PLCopen XML (`.xml`). Hidden folders, folders called `target`, links to folders and what is not a file, such as
/// a pipe, are left out.
pub fn programs(folder: &Path, depth: usize) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let entries = WalkDir::new(folder).max_depth(depth).sort_by_file_name();
    let mut entries = entries.into_iter();
    while let Some(entry) = entries.next() {
        let entry = entry.map_err(walk_error)?;
        let path = entry.path();
        if entry.file_type().is_dir() {
            if entry.depth() > 0 && is_left_out(&entry) {
                entries.skip_current_dir();
            } else if is_of_gx_developer(path) || structured::is_project(path) {
                found.push(path.to_owned());
                entries.skip_current_dir();
            }
            continue;
        }
        // A link to nothing is reported where it is read.
        if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
            continue;
        }
        let ending = path.extension().unwrap_or_default();
        let ending = ending.to_string_lossy().to_lowercase();
        let fits = match ending.as_str() {
            "il" | "st" | "gxw" | "pmw" => true,
            "csv" => is_export(path),
            "bin" => is_memory(path),
            "xml" => is_plcopen(path),
            _ => false,
        };
        if fits {
            found.push(path.to_owned());
        }
    }
    Ok(found)
}

/// Error of a walk through folders, with the path that cannot be read.
pub fn walk_error(error: walkdir::Error) -> io::Error {
    let path = error.path().unwrap_or(Path::new("")).display().to_string();
    let (kind, why) = match error.io_error() {
        Some(why) => (why.kind(), why.to_string()),
        None => (io::ErrorKind::Other, error.to_string()),
    };
    io::Error::new(kind, format!("cannot read `{path}`: {why}"))
}

pub(crate) fn is_left_out(folder: &DirEntry) -> bool {
    let name = folder.file_name().to_string_lossy();
    name.starts_with('.') || name == "target"
}

/// The beginning of a file; nothing if it cannot be read, which is reported where it is read whole.
fn head(path: &Path) -> Option<Vec<u8>> {
    let mut head = Vec::new();
    inputs::admit(path).ok()?;
    let read = File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    read.is_ok().then_some(head)
}

/// Returns true if a file of bytes is an image of program memory, not firmware or something else.
fn is_memory(path: &Path) -> bool {
    head(path).is_none_or(|head| image::is_image(&head))
}

/// Returns true if a document is a project of PLCopen XML.
fn is_plcopen(path: &Path) -> bool {
    let Some(head) = head(path) else {
        return true;
    };
    encoding::decode(&head, None).is_some_and(|(text, _)| plcopen::is_project(&text))
}

/// Returns true if a table is a list export, not comments or something else.
fn is_export(path: &Path) -> bool {
    let Some(mut head) = head(path) else {
        return true;
    };
    // Whole lines alone: the last character may be cut. In UTF-16 a line feed has a zero beside it.
    if head.len() as u64 == HEAD
        && let Some(last) = head.iter().rposition(|&byte| byte == b'\n')
    {
        head.truncate(last + 1 + usize::from(head.get(last + 1) == Some(&0)));
    }
    let text = encoding::decode(&head, None);
    text.is_some_and(|(text, _)| csv::detect(&text).is_some())
}
