//! From a compiled program to a library or an image for another machine.
//!
//! [`target`] lists the machines, [`board`] reads the description of a board and [`boards`] has some, [`image`] writes
//! the sources of an image for it, [`sources`] those of a library, [`package`] those of a library for another build
//! system, [`fmu`] a unit for co-simulation, and [`build`] calls the compilers; [`report`] measures the resources it
//! uses there, and [`flash`] writes an image into a microcontroller.
//!
//! This crate must not know what a program computes: it calls the backends and compilers, and reads what they made.
//! Start reading at [`target`] and [`image`].

pub mod board;
pub mod boards;
pub mod build;
pub mod flash;
pub mod fmu;
pub mod image;
pub mod package;
pub mod report;
pub mod sources;
pub mod target;

/// Text of a file of `templates/`, for images and packages.
macro_rules! template {
    ($name:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/templates/", $name))
    };
}
use template;
