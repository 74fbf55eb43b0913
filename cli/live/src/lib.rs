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
mod token;

pub use command::Command;
pub use frame::{Frame, Log};
pub use markup::page;
pub use scene::Scene;
pub use server::{Order, Server};
pub use token::token;

/// Text of a file of `assets/`: a module, the style or a panel of the page.
macro_rules! asset {
    ($name:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/", $name))
    };
}
use asset;
