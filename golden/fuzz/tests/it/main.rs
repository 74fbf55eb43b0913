//! Tests of the crate from outside, one module for each area.

mod storms;
mod targets;
