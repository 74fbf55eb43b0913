//! Tests of the crate from outside, one module for each area.

mod build;
mod common;
mod hostile;
mod picture;
mod shapes;
