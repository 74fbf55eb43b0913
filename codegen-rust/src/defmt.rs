//! Support in a crate for [defmt](https://defmt.ferrous-systems.com), the logger of small microcontrollers.

use crate::{OutFile, template};
use syn::Ident;

/// The line of the manifest's dependencies.
pub(crate) const DEPENDENCY: &str = "defmt = { version = \"1\", optional = true }\n";

/// The end of the manifest.
pub(crate) const FEATURE: &str =
    "\n[features]\n# defmt prints the program's state.\ndefmt = [\"dep:defmt\"]\n";

/// The line of `src/lib.rs`.
pub const MODULE: &str = "#[cfg(feature = \"defmt\")]\nmod format;\n";

/// The file with the program's [`defmt::Format`](https://docs.rs/defmt/1/defmt/trait.Format.html).
pub fn file(type_name: &Ident, crate_name: &str) -> OutFile {
    let text = template!("format.rs")
        .replace("MACHINE", &type_name.to_string())
        .replace("NAME", crate_name);
    OutFile::new("src/format.rs", text)
}
