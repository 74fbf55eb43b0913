//! Packs the templates of `templates/`, which the library embeds.

use std::io;
use std::path::Path;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=templates");
    let texts = rungc_packed::folder(Path::new("templates"), "")?;
    rungc_packed::embed("templates.bin", texts)
}
