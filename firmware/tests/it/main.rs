//! Tests of the crate from outside, one module for each area.

mod board;
mod flash;
mod retain;
