//! Programs for another model than the default one, which nothing names.

use rungc_frontend::Read;
use rungc_lower::compile::{self, CompileOptions, Compiled};
use rungc_models::{Model, ModelId};
use rungc_syntax::diag::counted;
use rungc_syntax::{Diagnostic, Diagnostics, Severity, codes};

/// Diagnostics of a program that was compiled with these options. If nothing says which model it is for, and its
/// instructions are those of another one, one error says so, instead of one for each instruction.
pub fn joined(options: &CompileOptions, read: &Read, compiled: &Compiled) -> Diagnostics {
    let mut missing = compiled.diagnostics.iter().filter(|d| is_missing(d));
    let is_chosen = options.model.is_some() || read.program.cpu.is_some();
    let first = missing.next().filter(|_| !is_chosen);
    let better = first.and_then(|first| Some((first, better(options, read)?)));
    let Some((first, (models, errors))) = better else {
        return compiled.diagnostics.clone();
    };
    let mut diagnostics = Diagnostics::new();
    diagnostics.push(error(read, first, missing.count(), &models));
    diagnostics.extend(errors);
    diagnostics
}

fn is_missing(diagnostic: &Diagnostic) -> bool {
    diagnostic.code == codes::NOT_ON_MODEL.id
}

/// The models that have all instructions of a program and on which it has the fewest errors, and these errors.
fn better(options: &CompileOptions, read: &Read) -> Option<(Vec<&'static Model>, Vec<Diagnostic>)> {
    let mut best: Option<(Vec<&'static Model>, Vec<Diagnostic>)> = None;
    for id in ModelId::ALL {
        let options = CompileOptions {
            model: Some(id),
            ..options.clone()
        };
        let checked = compile::check(&read.program, &options).diagnostics;
        if checked.iter().any(is_missing) {
            continue;
        }
        let errors = checked.iter().filter(|d| d.severity == Severity::Error);
        let errors: Vec<_> = errors.cloned().collect();
        match &mut best {
            Some((_, fewest)) if fewest.len() < errors.len() => {}
            Some((models, fewest)) if fewest.len() == errors.len() => models.push(Model::get(id)),
            _ => best = Some((vec![Model::get(id)], errors)),
        }
    }
    best
}

/// The error at the first instruction that the default model lacks, and `others`.
fn error(read: &Read, first: &Diagnostic, others: usize, models: &[&Model]) -> Diagnostic {
    let instrs = &read.program.instrs;
    let at = instrs.iter().find(|instr| {
        let extent = instr.span.start..instr.span.end.max(instr.span.start + 1);
        extent.contains(&first.span.start)
    });
    let name = at.map_or("an instruction", |instr| instr.mnemonic.as_str());
    let (all, are) = match others {
        0 => (format!("`{name}`"), "is"),
        _ => {
            let others = counted(others, "other instruction");
            (format!("`{name}` and {others}"), "are")
        }
    };
    let default = Model::get(ModelId::Fx3u).title;
    let of = match models {
        [model] => format!("this is a program for {}", model.title),
        _ => "this program is for another model".to_string(),
    };
    let message = format!("{of}: {all} {are} not available on {default}, the default model");
    let options: Vec<_> = models
        .iter()
        .map(|m| format!("`--model {}`", m.name))
        .collect();
    let name = models.first().map_or("", |model| model.name);
    let help = format!(
        "use {}, or set `model = \"{name}\"` in `[project]` of rungc.toml (`rungc init`)",
        options.join(" or "),
    );
    let error = codes::NOT_ON_MODEL.at(first.span, message).help(help);
    error.label(first.label.clone())
}
