//! Packs the C that runs sweeps, which the library embeds.

use std::{fs, io};

/// The file, in `src/`.
const MAIN: &str = "lanes.c";

fn main() -> io::Result<()> {
    let path = format!("src/{MAIN}");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={path}");
    let text = fs::read_to_string(path)?;
    rungc_packed::embed("main.bin", [(MAIN.to_string(), text)])
}
