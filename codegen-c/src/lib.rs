//! C99 from rungc's IR.
//!
//! [`emit`] makes a folder that builds with `make`: the program's struct and functions, `rungc.h` with what all
//! programs share, only if the program calls the runtime, the runtime's sources, and if it takes events or it is
//! requested, the wiring between it and a board. [`Part`] and [`together`] do the same for several programs of one
//! firmware; [`batch`] makes one executable of many programs, for tests.
//!
//! `rungc_emit` decides on the fields of the program's struct, on its functions and on where temporaries live. What is
//! done here is to print that: `fields` the struct's fields, `writer` and `expr` statements and expressions; `unit`
//! puts it all together.
//!
//! This crate must not know instructions or file formats, nor decide what a program means. Start reading at `files`,
//! then `unit`.

#![deny(clippy::wildcard_enum_match_arm)]

mod access;
mod board;
mod cmake;
mod code;
mod devices;
mod events;
mod expr;
mod fields;
mod files;
mod header;
mod helpers;
mod host;
pub mod lanes;
mod makefile;
mod members;
mod page;
mod parts;
mod reads;
mod retain;
mod run_control;
mod runtime;
mod stations;
mod steps;
mod stmt;
mod table;
mod text;
mod unit;
mod writer;

pub use cmake::runtime as cmake_runtime;
pub use files::{Part, together};
pub use makefile::Recipe;
pub use members::Members;
pub use parts::{RuntimeCall, runtime_calls};
pub use retain::record_len;
pub use rungc_emit::OutFile;
pub use rungc_emit::storage::{Memory, memory};
use rungc_ir::Module;
use rungc_syntax::DeviceClass;

/// Options of the output.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Also a `main.c` for a host that scans in real time.
    pub main: bool,
    /// The `main.c` takes options that open servers over TCP; the runtime library is needed then.
    pub servers: bool,
    /// The `main.c` takes options that connect terminals and keep a log; the runtime library is needed then, with the
    /// standard library of Rust.
    pub io: bool,
    /// The bit that is on while the `main.c` cannot save latched devices.
    pub unsaved: Option<(DeviceClass, u32)>,
    /// Also `NAME_board.h`, the wiring between the program and a board, of a program that takes no events; one that
    /// does always has it.
    pub board: bool,
    /// Also `NAME_access.h`, which reads and writes devices by number and by name.
    pub access: bool,
    /// Also `NAME_retain.h`, which saves latched devices to flash, of a program that has any; with `access`, which it
    /// needs.
    pub retain: bool,
    /// Also `NAME_lanes.h` and its functions, which run [`lanes::LANES`] instances at once, of a program that
    /// [`lanes::refusal`] has nothing against.
    pub lanes: bool,
    /// Other code of the folder calls the runtime library, which is linked even if the runtime in C has what the
    /// program calls.
    pub library: bool,
    /// Also `misra.txt`, the deviations from MISRA C:2012 with their reasons, as suppressions for cppcheck.
    pub misra: bool,
}

/// Text of a file of `include/`: a header that programs share, or a template. `rungc_rt.h`, the header of the runtime
/// library, is made by `cargo xtask generate`.
macro_rules! template {
    ($name:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/include/", $name))
    };
}
use template;

/// Emits one executable that holds all programs and does what requests on its standard input say: for tests. `make`
/// builds it as `batch`; the protocol is that of `rungc-sim`, and the hardware is virtual.
pub fn batch(modules: &[Module]) -> Vec<OutFile> {
    files::batch(modules, false)
}

/// The same with the runtime in C as far as it is there, and its library for the rest.
pub fn batch_in_c(modules: &[Module]) -> Vec<OutFile> {
    files::batch(modules, true)
}

/// Emits a program. The same module gives the same bytes.
pub fn emit(module: &Module, options: &Options) -> Vec<OutFile> {
    Part::new(module, options).alone()
}
