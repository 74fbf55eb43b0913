//! Random programs for differential tests; conformance cases and examples stand beside this crate's sources.
//!
//! Programs are made from the catalogue's rows; what they should do is not known here: the engines are held to each other.

pub mod book;
pub mod operands;
pub mod random;
pub mod rng;
pub mod stations;

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
