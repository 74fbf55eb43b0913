//! Tests of the crate from outside, one module for each area.

mod corpus;
mod diagnostics;
mod exports;
mod files;
mod fixture;
mod formats;
mod image;
mod ladder_text;
mod learn;
mod plcopen;
mod plcopen_configuration;
mod plcopen_modifiers;
mod print;
mod robust;
mod sources;
mod works2;
