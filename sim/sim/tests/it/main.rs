//! Tests of the crate from outside, one module for each area.

mod plant;
mod program_files;
mod runner;
mod session;
mod settings;
mod test_files;
