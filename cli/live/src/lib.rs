//! A page that shows a program while it runs, and its controls.
//!
//! [`page`] makes the page of a program and its [`Scene`], which says where power flows in the ladder. [`Server`]
//! serves the page to this machine alone, takes its [`Command`]s, and shows a [`Frame`] whenever the run has one. What
//! a command does is a matter of the run (`rungc serve --page`). Start reading at [`Scene`].

mod command;
mod frame;
mod http;
mod markup;
mod probe;
mod scene;
mod server;

pub use command::Command;
pub use frame::{Frame, Log};
pub use markup::page;
pub use scene::Scene;
pub use server::{Order, Server};

use rungc_packed::Packed;

/// The modules, the style and the panels of the page: `assets/`, packed by the build script.
static ASSETS: Packed = Packed::new(include_bytes!(concat!(env!("OUT_DIR"), "/assets.bin")));

/// A file of `assets/`.
fn asset(name: &str) -> &'static str {
    ASSETS.text(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn what_is_packed_is_used() {
        let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let used = rungc_packed::used(&sources, "asset").unwrap();
        assert_eq!(ASSETS.names(), used);
    }
}
