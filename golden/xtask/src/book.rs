//! The pages of the book that are generated from the catalogue and the table of codes.

use crate::generate::Made;
use crate::{Problem, root};
use rungc_golden::book;
use std::fs;
use std::path::Path;

/// The pages and the table of contents.
pub fn make() -> Result<Made, Problem> {
    let source = Path::new("docs/src");
    let mut made = Made::default();
    for pages in book::chapters() {
        for page in &pages {
            made.files
                .push((source.join(&page.path), page.text.clone()));
        }
        made.folders.extend(
            Path::new(&pages[0].path)
                .parent()
                .map(|folder| source.join(folder)),
        );
    }
    let contents = source.join("SUMMARY.md");
    let written = fs::read_to_string(root().join(&contents))?;
    made.files.push((contents, book::summary(&written)));
    Ok(made)
}
