//! Structured text, which is compiled to a list as soon as its model is known.

use crate::sources::Comparison;
use rungc_frontend::Read;
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::ModelId;

/// Compiles a program that was read as structured text into its instructions for the model `chosen`, or the one that it
/// names; what is wrong with it is added to what its reader found. Other programs stay as they are; if they are
/// compiled copies of structured text, what a comparison shows is added.
pub fn compile(read: &mut Read, chosen: Option<ModelId>) {
    let options = CompileOptions {
        model: chosen,
        ..CompileOptions::default()
    };
    let model = compile::model(&read.program, &options);
    let found = rungc_structured::compile(&mut read.program, model);
    read.diagnostics.extend(found.iter().cloned());
    if let Some(comparison) = Comparison::new(read, model) {
        comparison.report(&mut read.diagnostics);
    }
}
