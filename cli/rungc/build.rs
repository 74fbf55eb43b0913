//! Lists the pages of the book that `rungc book` prints.
//!
//! They are those of `docs/src/SUMMARY.md`, but for pages that `rungc explain` and `rungc help` give, and for those
//! about rungc's own code. A published package has no such neighbour: it brings the pages in `published/`, which
//! `cargo xtask package` makes.

use std::fmt::Write;
use std::path::PathBuf;
use std::{env, fs, io};

/// The book, and what stands for it in a package.
const BOOKS: [&str; 2] = ["../../docs/src", "published"];

/// Pages, or folders of pages, that are not for `rungc book`.
const LEFT_OUT: [&str; 7] = [
    "architecture",
    "benchmarks",
    "checks/",
    "commands",
    "design/",
    "functions/",
    "instructions/",
];

/// The page that says which models have which instructions; `rungc explain` names it.
const SUPPORT: &str = "instructions/support";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let variable = |name| env::var_os(name).map(PathBuf::from);
    let folders = variable("CARGO_MANIFEST_DIR").zip(variable("OUT_DIR"));
    let (here, out) = folders.ok_or_else(|| io::Error::other("cargo sets these variables"))?;
    let mut books = BOOKS.iter().map(|book| here.join(book));
    let book = books.find(|book| book.join("SUMMARY.md").exists());
    let book = book.ok_or_else(|| io::Error::other("the book has no SUMMARY.md"))?;
    println!("cargo::rerun-if-changed={}", book.display());
    let summary = fs::read_to_string(book.join("SUMMARY.md"))?;
    let mut table = String::from("&[\n");
    for line in summary.lines() {
        let entry = line.trim().trim_start_matches("- ");
        let Some((title, name)) = entry
            .strip_prefix('[')
            .and_then(|entry| entry.strip_suffix(".md)"))
            .and_then(|entry| entry.split_once("]("))
        else {
            continue;
        };
        let is_left_out = |left: &&str| match left.ends_with('/') {
            true => name.starts_with(*left),
            false => name == *left,
        };
        if LEFT_OUT.iter().any(is_left_out) && name != SUPPORT {
            continue;
        }
        let file = book.join(format!("{name}.md"));
        let _ = writeln!(
            table,
            "    Page {{ name: {name:?}, title: {title:?}, text: include_str!({file:?}) }},"
        );
    }
    table += "]\n";
    fs::write(out.join("pages.rs"), table)
}
