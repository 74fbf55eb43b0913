//! Tests of the crate from outside, one module for each area.

mod access;
mod build;
mod emit;
mod errors;
mod parts;
mod retain;
mod shapes;
mod windows;
