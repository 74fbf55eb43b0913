//! The generated parts of the documentation are what the catalogue and the table of codes say.
//! `UPDATE_DOCS=1 cargo test -p rungc-golden --test docs` writes them anew.

use rungc_golden::book;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

const BEGIN: &str = "<!-- Generated from the catalogue. ANCHOR: support -->\n";
const END: &str = "<!-- ANCHOR_END: support -->\n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn updating() -> bool {
    std::env::var_os("UPDATE_DOCS").is_some()
}

/// Compares a file with its expected content, or writes it.
fn check(path: &Path, expected: &str) {
    if updating() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, expected).unwrap();
    }
    let actual = fs::read_to_string(path).unwrap_or_default();
    assert!(
        actual == expected,
        "{} is out of date; UPDATE_DOCS=1 cargo test -p rungc-golden --test docs writes it anew",
        path.display()
    );
}

#[test]
fn support_table_of_the_readme() {
    let path = root().join("README.md");
    let readme = fs::read_to_string(&path).unwrap();
    let (before, rest) = readme
        .split_once(BEGIN)
        .expect("README.md marks the start of the table");
    let (_, after) = rest
        .split_once(END)
        .expect("README.md marks the end of the table");
    let table = rungc_catalogue::support_table();
    check(&path, &format!("{before}{BEGIN}\n{table}\n{END}{after}"));
}

#[test]
fn generated_pages_of_the_book() {
    let source = root().join("docs/src");
    for pages in book::chapters() {
        let folder = source.join(Path::new(&pages[0].path).parent().unwrap());
        for page in &pages {
            check(&source.join(&page.path), &page.text);
        }
        let expected: BTreeSet<_> = pages.iter().map(|page| source.join(&page.path)).collect();
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if !expected.contains(&path) {
                assert!(updating(), "{} is no longer generated", path.display());
                fs::remove_file(path).unwrap();
            }
        }
    }
}

#[test]
fn generated_lines_of_the_table_of_contents() {
    let path = root().join("docs/src/SUMMARY.md");
    let written = fs::read_to_string(&path).unwrap();
    check(&path, &book::summary(&written));
}
