//! Structured text, which is compiled to a list as soon as its model is known.

use crate::sources::Comparison;
use rungc_frontend::Read;
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::ModelId;
use rungc_syntax::codes;

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
    // Words that other files define are of interest only if the program lacks them.
    let is_missing = |span| {
        let mut missing = found
            .iter()
            .filter(|one| one.code == codes::ST_UNKNOWN_NAME.id);
        missing.any(|one| one.span == span)
    };
    let earlier = std::mem::take(&mut read.diagnostics);
    let kept = earlier
        .iter()
        .filter(|one| one.code != codes::ST_LEFT_OUT.id || is_missing(one.span));
    read.diagnostics.extend(kept.chain(found.iter()).cloned());
    if let Some(comparison) = Comparison::new(read, model) {
        comparison.report(&mut read.diagnostics);
    }
}
