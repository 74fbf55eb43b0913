//! The archive for Windows.

use super::files::Files;
use super::systems::WINDOWS;
use super::{Dist, VERSION};
use crate::{Problem, root};
use std::fs;
use std::io::{Cursor, Write};
use std::path::PathBuf;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Makes the archive.
pub fn make(dist: &Dist) -> Result<PathBuf, Problem> {
    let system = dist.target.unwrap_or(WINDOWS);
    if !system.is_windows() {
        return Err(format!("`zip` is for Windows, not for {}", system.triple).into());
    }
    let executable = dist.executable(system)?;
    let mut files = Files::documents()?;
    files.add_executable(system.executable(), &executable)?;
    files.add_completions(&executable)?;
    let script = fs::read(root().join("packaging/windows/install.ps1"))?;
    files.add("install.ps1", script);
    let name = format!("rungc-{VERSION}-{}", system.name);
    let path = dist.out.join(format!("{name}.zip"));
    fs::write(&path, zipped(&files.inside(&name))?)?;
    Ok(path)
}

/// An archive of files, sorted by name, the same for the same files: all have the earliest time there is.
fn zipped(files: &Files) -> Result<Vec<u8>, Problem> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, file) in &files.0 {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(file.mode());
        zip.start_file(path, options)?;
        zip.write_all(&file.contents)?;
    }
    Ok(zip.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;
    use zip::ZipArchive;

    #[test]
    fn archives_hold_their_files_and_are_the_same_each_time() {
        let mut files = Files::default();
        files.add("b", b"second".to_vec());
        files.add("a", b"first".to_vec());
        let made = zipped(&files).unwrap();
        assert_eq!(made, zipped(&files).unwrap());
        let mut archive = ZipArchive::new(Cursor::new(made)).unwrap();
        let mut found = Vec::new();
        for n in 0..archive.len() {
            let mut file = archive.by_index(n).unwrap();
            let mut text = String::new();
            file.read_to_string(&mut text).unwrap();
            found.push((file.name().to_owned(), text));
        }
        let expected = [("a", "first"), ("b", "second")];
        let expected = expected.map(|(name, text)| (name.to_owned(), text.to_owned()));
        assert_eq!(found, expected);
    }
}
