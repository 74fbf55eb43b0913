//! Files that are made of a program.

/// A file to write: text, or bytes where a tool made it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct OutFile<Contents = String> {
    /// Path relative to the output folder, with `/` between its parts.
    pub path: String,
    /// Its contents.
    pub contents: Contents,
}

impl OutFile {
    /// A text file.
    pub fn new(path: impl Into<String>, text: impl Into<String>) -> Self {
        OutFile {
            path: path.into(),
            contents: text.into(),
        }
    }

    /// The same file in another folder.
    pub fn inside(self, folder: &str) -> Self {
        OutFile {
            path: format!("{folder}/{}", self.path),
            ..self
        }
    }
}

impl From<OutFile> for OutFile<Vec<u8>> {
    fn from(file: OutFile) -> Self {
        OutFile {
            path: file.path,
            contents: file.contents.into_bytes(),
        }
    }
}
