//! A compound file and the list of its streams. In a GX Works2 project the outer file holds the list and, as one
//! stream, an inner file, whose streams have numbers for names.

use cfb::CompoundFile;
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::io::{Cursor, Read as _};
use std::path::PathBuf;

/// An open compound file.
pub(super) struct Container<'b> {
    file: RefCell<CompoundFile<Cursor<&'b [u8]>>>,
    /// Number of bytes that may still be read. Streams share no sectors: together they are not longer than the file.
    left: Cell<usize>,
}

impl<'b> Container<'b> {
    /// Opens a compound file.
    pub fn open(bytes: &'b [u8]) -> Option<Self> {
        Some(Container {
            file: RefCell::new(CompoundFile::open(Cursor::new(bytes)).ok()?),
            left: Cell::new(bytes.len()),
        })
    }

    /// A stream of the root storage, as far as it can be read; `None` if it does not exist.
    pub fn stream(&self, name: &str) -> Option<Vec<u8>> {
        let mut content = Vec::new();
        let mut file = self.file.borrow_mut();
        let stream = file.open_stream(name).ok()?;
        // The readable part before a damaged sector is used.
        let _ = stream
            .take(self.left.get() as u64)
            .read_to_end(&mut content);
        self.left.set(self.left.get() - content.len());
        Some(content)
    }

    /// All streams, in the order of their names: numbers go by their values.
    pub fn all(&self) -> Vec<Vec<u8>> {
        let entries = self.file.borrow();
        let mut names: Vec<(usize, PathBuf)> = entries
            .walk()
            .filter(cfb::Entry::is_stream)
            .map(|entry| (entry.name().len(), entry.path().to_owned()))
            .collect();
        drop(entries);
        names.sort();
        let path = |(_, path): (usize, PathBuf)| self.stream(path.to_str()?);
        names.into_iter().filter_map(path).collect()
    }
}

/// A row of the project's list.
pub(super) struct Row {
    /// Name of the stream.
    pub id: String,
    /// Name: `MAIN.Program.pou`.
    pub name: String,
    /// The folder of the project that it lies in, which a program file shares with its tasks.
    pub folder: String,
}

/// The largest list that is read, in bytes. One of a hundred parts takes 60 kilobytes.
const MAX_LIST: usize = 4 << 20;

/// The rows of `projectdatalist.xml`; nothing if it cannot be read.
pub(super) fn rows(list: &[u8]) -> Option<Vec<Row>> {
    let list = Some(list).filter(|list| list.len() <= MAX_LIST)?;
    let (text, _) = crate::encoding::decode(list, None)?;
    let document = roxmltree::Document::parse(text.trim_start_matches('\u{FEFF}')).ok()?;
    let rows = document
        .descendants()
        .filter(|node| node.has_tag_name("D_Projectdata"));
    let mut known = BTreeSet::new();
    let rows: Vec<Row> = rows
        .filter_map(|row| {
            let field = |name| {
                let field = row.children().find(|child| child.has_tag_name(name))?;
                Some(field.text()?.to_owned())
            };
            Some(Row {
                id: field("iID")?,
                name: field("szName")?,
                folder: field("uiFolderNo").unwrap_or_default(),
            })
        })
        .filter(|row| known.insert(row.id.clone()))
        .collect();
    (!rows.is_empty()).then_some(rows)
}
