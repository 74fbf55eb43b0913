//! From a compiled program to a library or an image for another machine.
//!
//! [`target`] lists the machines, [`board`] reads the description of a board and [`boards`] has some, [`image`] writes
//! the sources of an image for it, [`sources`] those of a library, [`package`] those of a library for another build
//! system, and [`build`] calls the compilers; [`report`] measures the resources it uses there, and [`flash`] writes an
//! image into a microcontroller.
//!
//! This crate must not know what a program computes: it calls the backends and compilers, and reads what they made.
//! Start reading at [`target`] and [`image`].

pub mod board;
pub mod boards;
pub mod build;
pub mod flash;
pub mod image;
pub mod package;
pub mod report;
pub mod sources;
pub mod target;

use rungc_packed::Packed;

/// The templates of images and packages, and the descriptions of boards: `templates/` and `boards/`, packed by the
/// build script.
static TEMPLATES: Packed = Packed::new(include_bytes!(concat!(env!("OUT_DIR"), "/templates.bin")));

/// A file of `templates/`, or of `boards/` by its path.
fn template(name: &str) -> &'static str {
    TEMPLATES.text(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn what_is_packed_is_used() {
        let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut used = rungc_packed::used(&sources, "template").unwrap();
        used.extend(boards::ALL.map(|known| format!("boards/{}.toml", known.name)));
        assert_eq!(TEMPLATES.names(), used);
    }
}
