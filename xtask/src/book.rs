//! The parts of README.md and of the book that are generated from the catalogue and the table of codes.

use crate::generate::Made;
use crate::{Problem, root};
use rungc_golden::book;
use std::fs;
use std::path::Path;

/// What surrounds the support table in README.md.
const BEGIN: &str = "<!-- Generated from the catalogue. ANCHOR: support -->\n";
const END: &str = "<!-- ANCHOR_END: support -->\n";

/// The pages, the table of contents, and README.md.
pub fn make() -> Result<Made, Problem> {
    let source = Path::new("docs/src");
    let mut made = Made::file("README.md", readme()?);
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

/// README.md with the support table of the catalogue.
fn readme() -> Result<String, Problem> {
    let readme = fs::read_to_string(root().join("README.md"))?;
    let parts = readme.split_once(BEGIN).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END)?;
        Some((before, after))
    });
    let (before, after) = parts.ok_or("README.md does not mark the place of the support table")?;
    let table = rungc_catalogue::support_table();
    Ok(format!("{before}{BEGIN}\n{table}\n{END}{after}"))
}
