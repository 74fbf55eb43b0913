//! Changing the file that a program was read from.

use super::Failure;
use super::subject::Subject;
use crate::output::{at, rewrite};
use rungc_frontend::Read;
use std::fs;
use std::path::PathBuf;

/// Byte-order mark of UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// An instruction list as a file that can be replaced.
pub struct InPlace {
    file: PathBuf,
    /// True if it begins with a byte-order mark.
    marked: bool,
}

impl InPlace {
    /// The file of a list, on behalf of `who`. A file in another encoding than UTF-8 is rejected.
    pub fn open(subject: &Subject, read: &Read, who: &str) -> Result<InPlace, Failure> {
        let path = &subject.file;
        let file = fs::canonicalize(path).map_err(|error| at(path, error))?;
        let bytes = fs::read(&file).map_err(|error| at(path, error))?;
        let text = bytes.strip_prefix(BYTE_ORDER_MARK);
        let text = text.unwrap_or(&bytes);
        let source = read.program.source.text.as_bytes();
        if text != source {
            let differs = match text.len() == source.len() && text.contains(&b'\r') {
                true => "ends its lines with a carriage return alone",
                false => "is not UTF-8",
            };
            let path = path.display();
            let why = format!("{who}: {path} {differs}; `rungc convert --to il` converts it");
            return Err(Failure::Because(why));
        }
        let marked = bytes.starts_with(BYTE_ORDER_MARK);
        Ok(InPlace { file, marked })
    }

    /// Replaces the text, whole or not at all; who may read and write the file stays the same.
    pub fn write(&self, text: &str) -> Result<(), Failure> {
        let permissions = fs::metadata(&self.file).map_err(|error| at(&self.file, error))?;
        let mark = if self.marked { BYTE_ORDER_MARK } else { &[] };
        rewrite(&self.file, &[mark, text.as_bytes()].concat())?;
        fs::set_permissions(&self.file, permissions.permissions())
            .map_err(|error| at(&self.file, error))
    }
}
