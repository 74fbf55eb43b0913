//! Tests that span the crates: conformance cases (`conformance/`), snapshots of what the examples become, random
//! programs for differential tests, the pages that are generated from the tables, and the workspace's own rules.
//!
//! Random programs are made from the catalogue's rows. What they should do must not be known here: the engines are
//! compared with one another. Start reading at `tests/it/conformance.rs`, then [`random`] and
//! `tests/it/differential.rs`.

pub mod book;
mod fitting;
pub mod motions;
pub mod operands;
pub mod part;
pub mod random;
pub mod rng;
pub mod rows;
pub mod sequences;
pub mod shapes;
pub mod stations;
pub mod workspace;

use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;

/// The module of a list that compiles for a model.
pub fn module(text: &str, model: ModelId) -> Module {
    let read = rungc_frontend::read_text("test.il", text);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    compiled
        .module
        .unwrap_or_else(|| panic!("{:?}", compiled.diagnostics))
}
