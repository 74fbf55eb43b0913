//! Random programs for differential tests; conformance cases and examples stand beside this crate's sources.
//!
//! Programs are made from the catalogue's rows; what they should do is not known here: the engines are held to each other.

pub mod operands;
pub mod random;
pub mod rng;
pub mod stations;
