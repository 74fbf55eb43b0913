//! Packs the templates of `templates/` and the descriptions of `boards/`, which the library embeds.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// What a test assembles: `boot2.rs` has its words.
const ASSEMBLED: &str = "boot2.s";

fn main() -> io::Result<()> {
    for path in ["build.rs", "boards", "templates"] {
        println!("cargo::rerun-if-changed={path}");
    }
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    let mut texts = rungc_packed::folder(Path::new("templates"), "")?;
    texts.retain(|(name, _)| name != ASSEMBLED);
    texts.extend(rungc_packed::folder(Path::new("boards"), "boards/")?);
    let out = PathBuf::from(out).join("templates.bin");
    fs::write(out, rungc_packed::pack(texts)?)
}
