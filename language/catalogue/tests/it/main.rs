//! Tests of the crate from outside, one module for each area.

mod operands;
mod pages;
mod runtime;
mod special;
