//! Packs the tables of codes and words, which the library embeds.

use std::{fs, io};

/// The tables, and how many of their columns the library reads: what follows is a note.
const TABLES: [(&str, usize); 2] = [("src/gx/tokens.tsv", 4), ("src/image/applied.tsv", 6)];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let mut texts = Vec::new();
    for (path, columns) in TABLES {
        println!("cargo::rerun-if-changed={path}");
        let (_, name) = path.rsplit_once('/').unwrap_or_default();
        texts.push((name.to_string(), first(columns, &fs::read_to_string(path)?)));
    }
    rungc_packed::embed("tables.bin", texts)
}

/// The first columns of a table.
fn first(columns: usize, table: &str) -> String {
    let row = |row: &str| {
        let kept: Vec<&str> = row.split('\t').take(columns).collect();
        kept.join("\t") + "\n"
    };
    table.lines().map(row).collect()
}
