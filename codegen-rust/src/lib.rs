//! Rust from rungc's IR: a `no_std` crate without `unsafe`, made with quote, laid out by prettyplease.
//!
//! [`emit`] makes a crate of one program; [`batch`] one of many, for tests. How a program becomes Rust: `storage` names
//! the fields, `analysis` finds where temporaries live, `function` splits what is long, `stmt`, `coils`, `expr` and
//! `numeric` write statements and expressions, `machine` the struct and its implementations, `format` lays out and
//! prints comments between statements, `files` puts it together.
//!
//! Layout takes about as long as everything else together; it is made function by function, so time is linear in the
//! program's length.
//!
//! This crate must not know instructions or file formats, nor decide what a program means. Start reading at `files`.

#![deny(clippy::wildcard_enum_match_arm)]

mod blocks;
mod call;
mod coils;
mod defmt;
mod events;
mod expr;
mod files;
mod format;
mod function;
mod generate;
mod host;
mod machine;
mod members;
mod numeric;
mod steps;
mod stmt;
mod storage;
mod temps;
mod watchdog;
mod write;

pub use members::Members;
pub use rungc_emit::OutFile;
use rungc_ir::Module;
use rungc_syntax::DeviceClass;

/// Options of the output.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Options {
    /// Also a `src/main.rs` that scans in real time on a host with `std`.
    pub main: bool,
    /// The `src/main.rs` takes options that open servers over TCP.
    pub servers: bool,
    /// It takes options that connect terminals and keep a log.
    pub io: bool,
    /// The bit that is on while it cannot save latched devices.
    pub unsaved: Option<(DeviceClass, u32)>,
    /// A feature `defmt`, with which [defmt](https://defmt.ferrous-systems.com) prints the program's state.
    pub defmt: bool,
    /// Location of `rungc-rt` for the emitted crate.
    pub runtime: Runtime,
}

/// Location of `rungc-rt` for an emitted crate.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub enum Runtime {
    /// In the folder `rungc-rt` inside it; its sources are among the files.
    #[default]
    Included,
    /// At this path, relative to the crate or absolute.
    At(String),
}

/// Text of a file of `templates/`, the same for all programs.
macro_rules! template {
    ($name:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/templates/", $name))
    };
}
use template;

/// Emits a program as a crate that `cargo build` builds. The same module gives the same bytes.
pub fn emit(module: &Module, options: &Options) -> Vec<OutFile> {
    files::program(module, options)
}

/// Names of an emitted program: its crate, and the type that implements `rungc_rt::Program`.
pub fn names(module: &Module) -> (String, String) {
    files::names(module)
}

/// Emits programs as one crate whose executable runs them on virtual hardware, as requests on standard input say.
pub fn batch(modules: &[Module]) -> Vec<OutFile> {
    files::batch(modules)
}
