//! Instructions that the compiler knows but cannot translate.

use super::Code;
use rungc_catalogue::{Inst, Lower};
use rungc_models::{Model, ModelId};
use rungc_syntax::{Diagnostic, Diagnostics, Span, codes, phrase};

/// Reports every instruction without an implementation on the model.
pub(super) fn check(code: &Code, out: &mut Diagnostics) {
    for i in 0..code.len {
        let Some(inst) = code.inst(i).filter(|_| !code.is_meant(i)) else {
            continue;
        };
        if let Some(Lower::Todo(what)) = code.lower(i) {
            let diagnostic = refusal(inst, what, code.instr(i).mnemonic_span);
            out.push(match compiled_on(inst).as_slice() {
                [] => diagnostic,
                models => diagnostic.help(phrase!(
                    "it can be compiled for: {models}",
                    models = models.join(", ")
                )),
            });
        }
    }
}

/// The models for which an instruction can be compiled.
fn compiled_on(inst: &Inst) -> Vec<&'static str> {
    let models = ModelId::ALL.into_iter();
    let models = models.filter(|&id| inst.models.has(id));
    let models = models.filter(|&id| !matches!(inst.lower_on_model(id), Lower::Todo(_)));
    models.map(|id| Model::get(id).name).collect()
}

/// The error of an instruction that cannot be compiled, for the reason `what`.
pub fn refusal(inst: &Inst, what: &str, span: Span) -> Diagnostic {
    let message = phrase!(
        "`{inst}` cannot be compiled: {what}",
        inst = inst.name,
        what
    );
    codes::NOT_IMPLEMENTED
        .at(span, message)
        .label("a program with this instruction cannot be built")
}
