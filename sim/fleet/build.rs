//! Packs the C that runs PLCs, which the library embeds.

use std::{fs, io};

/// The files, in `src/`.
const SOURCES: [&str; 3] = ["children.c", "lanes.c", "singles.c"];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let mut texts = Vec::new();
    for name in SOURCES {
        let path = format!("src/{name}");
        println!("cargo::rerun-if-changed={path}");
        texts.push((name.to_string(), fs::read_to_string(path)?));
    }
    rungc_packed::embed("sources.bin", texts)
}
