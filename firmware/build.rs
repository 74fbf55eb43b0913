//! Packs the templates of `templates/` and the descriptions of `boards/`, which the library embeds.

use std::io;
use std::path::Path;

/// Source to be assembled by a test: `boot2.rs` has its words.
const ASSEMBLED: &str = "boot2.s";

fn main() -> io::Result<()> {
    for path in ["build.rs", "boards", "templates"] {
        println!("cargo::rerun-if-changed={path}");
    }
    let mut texts = rungc_packed::folder(Path::new("templates"), "")?;
    texts.retain(|(name, _)| name != ASSEMBLED);
    texts.extend(rungc_packed::folder(Path::new("boards"), "boards/")?);
    rungc_packed::embed("templates.bin", texts)
}
