//! Random programs for differential tests; conformance cases and examples stand beside this crate's sources.

pub mod operands;
pub mod random;
pub mod rng;
