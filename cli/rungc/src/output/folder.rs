//! Folders that commands write.

use super::{at, check_folder, make_folder, refuse_inputs};
use crate::commands::{Failure, parent_dir};
use rungc_emit::OutFile;
use std::fs;
use std::path::Path;

/// Rejects a folder that is not empty before a long build, unless it may be written into. Returns whether it is there.
pub fn free(folder: &Path, force: bool) -> Result<bool, Failure> {
    let there = folder.exists();
    if fs::symlink_metadata(folder).is_ok() && !folder.is_dir() {
        let why = format!("{} is not a folder; name another one", folder.display());
        return Err(Failure::Because(why));
    }
    let occupied = there
        && fs::read_dir(folder)
            .map_err(|e| at(folder, e))?
            .next()
            .is_some();
    match occupied && !force {
        true => Err(Failure::Because(format!(
            "{} already exists and is not empty; use --force to write into it",
            folder.display()
        ))),
        false => Ok(there),
    }
}

/// Writes all files into a folder: a new one appears only when complete, in one that is there (not empty only with
/// `force`) they take their outputs when all of them are written.
pub fn write_folder(folder: &Path, files: &[OutFile<Vec<u8>>], force: bool) -> Result<(), Failure> {
    let there = free(folder, force)?;
    let beside = match there {
        true => folder,
        false => parent_dir(folder),
    };
    make_folder(beside)?;
    for file in files.iter().filter(|_| there) {
        let to = folder.join(&file.path);
        check_folder(parent_dir(&to))?;
        if to.is_dir() {
            let why = format!("{} is a folder, where a file is to be", to.display());
            return Err(Failure::Because(why));
        }
    }
    let fresh = tempfile::Builder::new()
        .prefix(".rungc-")
        .tempdir_in(beside)
        .map_err(|e| at(folder, e))?;
    let inside = fresh.path().join("out");
    fs::create_dir(&inside).map_err(|e| at(&inside, e))?;
    for file in files {
        let path = inside.join(&file.path);
        let written = fs::create_dir_all(parent_dir(&path));
        let written = written.and_then(|()| fs::write(&path, &file.contents));
        written.map_err(|e| at(&folder.join(&file.path), e))?;
    }
    refuse_inputs(files.iter().map(|file| folder.join(&file.path)))?;
    if !there {
        return fs::rename(&inside, folder).map_err(|e| at(folder, e));
    }
    for file in files {
        let to = folder.join(&file.path);
        make_folder(parent_dir(&to))?;
        fs::rename(inside.join(&file.path), &to).map_err(|e| at(&to, e))?;
    }
    Ok(())
}
