//! Tests of the crate from outside, one module for each area.

mod equal;
mod figures;
mod pulse_counts;
