//! Messages about codes of instructions that nothing proves: the instructions that would fit.

use rungc_analysis::fitting::fitting;
use rungc_frontend::{Read, Unproven, has_code};
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::{Model, ModelId};
use rungc_syntax::{Operands, codes};
use std::collections::{BTreeMap, HashMap};

/// Fitting instructions are searched for at most this many codes of a program: with more unknown ones, it is not a
/// program.
const MAX_CODES: usize = 32;
/// The number of uses of a code that are compared.
const MAX_USES: usize = 16;
/// The number of instructions that are named.
const MAX_NAMED: usize = 12;

/// Completes the errors about codes that are not known by the instructions that would fit on the program's model, which
/// is `chosen` or the one that the project names.
pub fn suggest(read: &mut Read, chosen: Option<ModelId>) {
    let options = CompileOptions {
        model: chosen,
        ..CompileOptions::default()
    };
    let model = compile::model(&read.program, &options);
    let mut codes: BTreeMap<&[u8], Vec<&Unproven>> = BTreeMap::new();
    for unproven in read.unproven.iter().filter(|unproven| !unproven.is_read()) {
        codes.entry(&unproven.code).or_default().push(unproven);
    }
    let helps: HashMap<_, _> = codes
        .into_values()
        .take(MAX_CODES)
        .flat_map(|uses| {
            let help = help(&uses, model);
            uses.into_iter()
                .map(move |unproven| (unproven.span, help.clone()))
        })
        .collect();
    let unknown = codes::UNKNOWN_BYTES.id;
    for diagnostic in read.diagnostics.iter_mut().filter(|d| d.code == unknown) {
        if let Some(help) = helps.get(&diagnostic.span) {
            diagnostic.help = Some(help.clone().into());
        }
    }
}

fn help(uses: &[&Unproven], model: &'static Model) -> String {
    let operands: Vec<&Operands> = uses.iter().take(MAX_USES).map(|u| &u.operands).collect();
    let pulse = matches!(uses[0].code.as_slice(), [_, _, _, 2]);
    let found = fitting(uses[0].steps(), pulse, &operands, model);
    let (taken, free): (Vec<_>, Vec<_>) = found.iter().partition(|name| has_code(name));
    let choice = match (free.as_slice(), taken.len()) {
        ([], 0) => format!("no instruction of {} fits", model.name),
        ([], _) => format!(
            "instructions that would fit, though other codes are known for them: {}",
            named(&taken)
        ),
        (free, 0) => format!("instructions that would fit: {}", named(free)),
        (free, n) => format!(
            "instructions that would fit: {}, and {n} for which other codes are known",
            named(free)
        ),
    };
    format!(
        "{choice}; `rungc learn PROJECT EXPORT` learns the code from a list that the editor exports"
    )
}

fn named(names: &[&String]) -> String {
    let mut list: Vec<_> = names
        .iter()
        .take(MAX_NAMED)
        .map(|name| format!("`{name}`"))
        .collect();
    if names.len() > MAX_NAMED {
        list.push("…".to_owned());
    }
    list.join(", ")
}
