//! Tests of the crate from outside, one module for each area.

mod machine;
mod repeat;
