//! `rungc check`.

use super::{Context, Result, conclude, read};
use crate::args::CheckArgs;
use crate::report::Findings;
use rungc_ir::compile::{self, CompileOptions};
use std::time::Instant;

/// Reports everything that is wrong with a program.
pub fn run(args: &CheckArgs, cx: Context) -> Result {
    let start = Instant::now();
    let read = read(&args.input.file)?;
    let checked = compile::check(
        &read.program,
        &CompileOptions {
            model: args.input.model,
            ..CompileOptions::default()
        },
    );
    let mut diagnostics = read.diagnostics;
    diagnostics.extend(checked.diagnostics.iter().cloned());
    let findings = Findings::new(
        &args.input.file,
        &read.program,
        diagnostics,
        &args.input.reporting,
    );
    let elapsed = start.elapsed();
    conclude(&findings, &args.input.reporting, cx, || {
        let (name, model) = (&read.program.source.name, checked.model.name);
        format!(
            "    Checked {name} ({model}, {} steps) in {} ms",
            checked.steps,
            elapsed.as_millis()
        )
    })
}
