//! Tests of the crate from outside, one module for each area.

mod coils;
mod conformance;
mod corpus;
mod diagnostics;
mod lower;
mod mistakes;
mod motion;
mod parameters;
mod passes;
mod ports;
mod ranges;
mod rendered;
mod resets;
mod routines;
mod serial;
mod warnings;
mod worst;
mod zones;
