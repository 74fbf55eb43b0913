//! Instructions that the compiler knows but cannot translate.

use super::Code;
use rungc_catalogue::{Inst, Lower};
use rungc_syntax::{Diagnostic, Diagnostics, Span, codes};

/// Reports every instruction without an implementation on the model.
pub(super) fn check(code: &Code, out: &mut Diagnostics) {
    for i in 0..code.len {
        let Some(inst) = code.inst(i).filter(|_| !code.is_meant(i)) else {
            continue;
        };
        if let Some(Lower::Todo(what)) = code.lower(i) {
            out.push(refusal(inst, what, code.instr(i).mnemonic_span));
        }
    }
}

/// The error of an instruction that cannot be compiled, for the reason `what`.
pub fn refusal(inst: &Inst, what: &str, span: Span) -> Diagnostic {
    let message = format!("`{}` cannot be compiled: {what}", inst.name);
    codes::NOT_IMPLEMENTED
        .at(span, message)
        .label("a program with this instruction cannot be built")
}
