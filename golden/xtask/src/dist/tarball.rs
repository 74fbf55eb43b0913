//! Archives of tar and gzip, the same for the same files.

use super::files::Files;
use crate::Problem;
use flate2::{Compression, GzBuilder};
use std::io::Write;
use tar::{Builder, EntryType, Header};

/// An archive of files, sorted by name, of the user root, with this time in seconds since 1970.
pub fn make(files: &Files, time: u64) -> Result<Vec<u8>, Problem> {
    let mut tar = Builder::new(GzBuilder::new().write(Vec::new(), Compression::best()));
    for (path, file) in &files.0 {
        let mut header = Header::new_ustar();
        header.set_entry_type(EntryType::Regular);
        header.set_size(file.contents.len() as u64);
        header.set_mode(file.mode());
        header.set_mtime(time);
        header.set_uid(0);
        header.set_gid(0);
        tar.append_data(&mut header, path, &*file.contents)?;
    }
    Ok(tar.into_inner()?.finish()?)
}

/// Contents of a file, compressed, without a name and a time.
pub fn compressed(contents: &[u8]) -> Result<Vec<u8>, Problem> {
    let mut file = GzBuilder::new().write(Vec::new(), Compression::best());
    file.write_all(contents)?;
    Ok(file.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::GzDecoder;
    use std::io::Read;
    use tar::Archive;

    #[test]
    fn archives_are_sorted_and_the_same_each_time() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("program");
        std::fs::write(&program, "run").unwrap();
        let mut files = Files::default();
        files.add("b.txt", b"text".to_vec());
        files.add_executable("a", &program).unwrap();
        let files = files.inside("top");
        let made = make(&files, 86_400).unwrap();
        std::fs::write(&program, "run").unwrap();
        assert_eq!(made, make(&files, 86_400).unwrap());
        assert_ne!(made, make(&files, 86_401).unwrap());
        let mut archive = Archive::new(GzDecoder::new(&*made));
        let entries = archive.entries().unwrap().map(|entry| {
            let mut entry = entry.unwrap();
            let header = entry.header();
            let (mode, time) = (header.mode().unwrap(), header.mtime().unwrap());
            let mut text = String::new();
            entry.read_to_string(&mut text).unwrap();
            let path = entry.path().unwrap().display().to_string();
            (path, mode, time, text)
        });
        let expected = [("top/a", 0o755, "run"), ("top/b.txt", 0o644, "text")];
        let expected =
            expected.map(|(path, mode, text)| (path.to_owned(), mode, 86_400, text.to_owned()));
        assert_eq!(entries.collect::<Vec<_>>(), expected);
    }
}
