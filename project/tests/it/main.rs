//! Tests of the crate from outside, one module for each area.

mod common;
mod connections;
mod modules;
mod read;
mod requests;
mod tables;
