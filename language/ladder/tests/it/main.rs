//! Tests of the crate from outside, one module for each area.

mod common;
mod complicated;
mod ladder;
mod oracle;
mod sfc;
