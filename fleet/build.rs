//! Packs the C that runs PLCs, which the library embeds.

use std::path::PathBuf;
use std::{env, fs, io};

/// The files, in `src/`.
const SOURCES: [&str; 3] = ["children.c", "lanes.c", "singles.c"];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    let mut texts = Vec::new();
    for name in SOURCES {
        let path = format!("src/{name}");
        println!("cargo::rerun-if-changed={path}");
        texts.push((name.to_string(), fs::read_to_string(path)?));
    }
    let out = PathBuf::from(out).join("sources.bin");
    fs::write(out, rungc_packed::pack(texts)?)
}
