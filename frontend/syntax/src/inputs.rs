//! Files that this process has read on behalf of its user. No output may replace one, and a process can limit them to
//! some folders.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

static READ: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// The folders of [`confine`], links followed.
static FOLDERS: OnceLock<Vec<PathBuf>> = OnceLock::new();

/// Notes a file that is read: a program, settings, a test file, what they include.
pub fn note(path: &Path) {
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if !read.contains(path) {
        read.insert(path.to_owned());
    }
}

/// Notes a file before it is opened.
///
/// # Errors
/// After [`confine`], a file that is outside of its folders, links followed.
pub fn open(path: &Path) -> io::Result<()> {
    admit(path)?;
    note(path);
    Ok(())
}

/// Limits the files of this process to those in these folders and below, from now on and for good. The first call
/// decides.
///
/// # Errors
/// A folder that does not exist.
pub fn confine(folders: &[PathBuf]) -> io::Result<()> {
    let folders: io::Result<Vec<_>> = folders.iter().map(|folder| folder.canonicalize()).collect();
    let folders = folders?;
    FOLDERS.get_or_init(|| folders);
    Ok(())
}

/// Checks that a file may be read.
///
/// # Errors
/// After [`confine`], a file that is outside of its folders, links followed.
pub fn admit(path: &Path) -> io::Result<()> {
    let Some(folders) = FOLDERS.get() else {
        return Ok(());
    };
    // What is not there is reported where it is opened, if its folder is not outside.
    let whole = path.canonicalize().or_else(|missing| {
        let name = path.file_name().ok_or(missing)?;
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        let folder = folder.unwrap_or(Path::new(".")).canonicalize()?;
        Ok::<_, io::Error>(folder.join(name))
    })?;
    match folders.iter().any(|folder| whole.starts_with(folder)) {
        true => Ok(()),
        false => Err(io::Error::new(
            io::ErrorKind::PermissionDenied,
            "it is outside of the folders that may be read",
        )),
    }
}

/// The files noted so far, in order.
pub fn all() -> Vec<PathBuf> {
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    read.iter().cloned().collect()
}
