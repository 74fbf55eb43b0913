//! Properties of programs: proofs, and counterexamples that the interpreter has replayed.

#![deny(missing_docs)]

pub mod aig;
pub mod bits;
pub mod model;
pub mod sat;
pub mod search;
pub mod system;
pub mod unroll;
