//! Tests of the crate from outside, one module for each area.

mod operands;
mod runtime;
mod special;
