//! Packs the headers and templates of `include/`, which the library embeds.

use std::io;
use std::path::Path;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=include");
    let texts = rungc_packed::folder(Path::new("include"), "")?;
    rungc_packed::embed("include.bin", texts)
}
