//! Packs the modules, the style and the panels of the page, `assets/`, which the library embeds.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=assets");
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    let texts = rungc_packed::folder(Path::new("assets"), "")?;
    let out = PathBuf::from(out).join("assets.bin");
    fs::write(out, rungc_packed::pack(texts)?)
}
