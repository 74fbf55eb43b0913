//! Tests of the crate from outside, one module for each area.

mod inert;
mod no_panic;
mod resolve;
mod roles;
mod undefined;
mod variants;
mod xref;
