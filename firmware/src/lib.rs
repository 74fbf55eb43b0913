//! From a compiled program to a library or an image for another machine.
//!
//! [`target`] lists the machines, [`board`] reads the description of a board, [`image`] writes the sources of an image for it,
//! [`sources`] those of a library, and [`build`] calls the compilers; [`report`] tells what it takes
//! there.

pub mod board;
pub mod build;
pub mod image;
pub mod report;
pub mod sources;
pub mod target;
