//! Packs the modules, the style and the panels of the page, `assets/`, which the library embeds.

use std::io;
use std::path::Path;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=assets");
    let texts = rungc_packed::folder(Path::new("assets"), "")?;
    rungc_packed::embed("assets.bin", texts)
}
