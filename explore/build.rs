//! Packs the C that runs sweeps, which the library embeds.

use std::path::PathBuf;
use std::{env, fs, io};

/// The file, in `src/`.
const MAIN: &str = "lanes.c";

fn main() -> io::Result<()> {
    let path = format!("src/{MAIN}");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={path}");
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    let text = fs::read_to_string(path)?;
    let out = PathBuf::from(out).join("main.bin");
    fs::write(out, rungc_packed::pack([(MAIN.to_string(), text)])?)
}
