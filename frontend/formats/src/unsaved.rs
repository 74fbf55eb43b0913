//! Texts that are open in an editor, which count in place of their files.

use encoding_rs::{Encoding, UTF_8};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Texts by the files that they replace. A clone has the same texts.
#[derive(Clone, Debug, Default)]
pub struct Unsaved(BTreeMap<PathBuf, Arc<str>>);

/// A file by the one path that leads to it without links; a path where there is no file is itself.
fn place(path: &Path) -> PathBuf {
    let place = path.canonicalize().or_else(|_| std::path::absolute(path));
    place.unwrap_or_else(|_| path.to_owned())
}

impl Unsaved {
    /// Sets the text of a file.
    pub fn insert(&mut self, path: &Path, text: Arc<str>) {
        self.0.insert(place(path), text);
    }

    /// Removes the text of a file: what is saved counts again.
    pub fn remove(&mut self, path: &Path) {
        self.0.remove(&place(path));
    }

    /// The text of a file, if it is open.
    pub fn get(&self, path: &Path) -> Option<&Arc<str>> {
        match self.0.is_empty() {
            true => None,
            false => self.0.get(&place(path)),
        }
    }

    /// The encoding of an open text, which was decoded before.
    pub(crate) fn encoding(&self, path: &Path) -> Option<&'static Encoding> {
        self.get(path).map(|_| UTF_8)
    }
}

#[cfg(test)]
mod tests {
    use crate::{ReadOptions, read_with};
    use std::fs;

    #[test]
    fn open_texts_replace_files_of_any_encoding() {
        let folder = tempfile::tempdir().unwrap();
        let list = folder.path().join("a.il");
        fs::write(
            &list,
            b";! X000 = \xc6\xf4\xb6\xaf\nLD X000\nOUT Y000\nEND\n",
        )
        .unwrap();
        let mut options = ReadOptions {
            encoding: Some(encoding_rs::GBK),
            ..ReadOptions::default()
        };
        let comment = |options: &ReadOptions| {
            let program = read_with(&list, options).unwrap().program;
            program.comments.into_values().collect::<String>()
        };
        assert_eq!(comment(&options), "启动");
        let through = folder
            .path()
            .join("..")
            .join(folder.path().file_name().unwrap());
        let text = "\u{feff};! X000 = 停止\nLD X000\nOUT Y000\nEND\n";
        options.unsaved.insert(&through.join("a.il"), text.into());
        assert_eq!(comment(&options), "停止");
        options.unsaved.remove(&list);
        assert_eq!(comment(&options), "启动");
    }

    #[test]
    fn open_comments_of_an_export_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        let rows = [
            "\"Step No.\"\t\"Instruction\"\t\"I/O (Device)\"",
            "\"0\"\t\"LD\"\t\"X000\"",
            "\"1\"\t\"OUT\"\t\"Y000\"",
            "\"2\"\t\"END\"\t\"\"",
        ];
        let list = rows.join("\r\n");
        fs::write(place("MAIN.csv"), list).unwrap();
        let saved = b"Device\tComment\nX000\t\xc6\xf4\xb6\xaf\n";
        fs::write(place("COMMENT.csv"), saved).unwrap();
        let mut options = ReadOptions::default();
        options.unsaved.insert(
            &place("COMMENT.csv"),
            "Device\tComment\nX000\t停止\n".into(),
        );
        let read = read_with(&place("MAIN.csv"), &options).unwrap();
        let comments: Vec<_> = read.program.comments.into_values().collect();
        assert_eq!(comments, ["停止"], "{:?}", read.diagnostics);
    }
}
