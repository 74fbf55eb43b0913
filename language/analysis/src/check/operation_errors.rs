//! Operands that make an instruction fail, or do less than it says, each time it runs.

use super::Code;
use rungc_catalogue::{ArithOp, Lower};
use rungc_syntax::{Diagnostics, Fix, OperandKind, codes};

/// Checks the constants of instruction `i`.
pub(super) fn check(code: &Code, i: usize, out: &mut Diagnostics) {
    let Some(inst) = code.inst(i) else {
        return;
    };
    match code.lower(i) {
        Some(Lower::Arith(ArithOp::Div)) => by_zero(code, i, true, out),
        Some(Lower::ArithSaturating(ArithOp::Div)) => by_zero(code, i, false, out),
        _ => match inst.name {
            "EDIV" => by_zero(code, i, true, out),
            "ZRST" => reversed(code, i, out),
            _ => {}
        },
    }
}

/// A divisor that is the constant 0: an operation error (h1u-h2u-programming §4.3.3), where the model does not limit
/// the result.
fn by_zero(code: &Code, i: usize, fails: bool, out: &mut Diagnostics) {
    let Some(divisor) = code.instr(i).operands.get(1) else {
        return;
    };
    let zero = match divisor.kind {
        OperandKind::Float(value) => value == 0.0,
        ref kind => kind.constant() == Some(0),
    };
    if !zero {
        return;
    }
    let mnemonic = &code.instr(i).mnemonic;
    let diagnostic =
        codes::DIVISION_BY_ZERO.at(divisor.span, format!("`{mnemonic}` divides by zero"));
    out.push(match fails {
        true => {
            diagnostic.label("an operation error each time this runs; the result does not change")
        }
        false => diagnostic.label("gives the limit of the range each time this runs"),
    });
}

/// ZRST whose first device comes after its last one resets only the first (FX3 programming manual, FNC 40).
fn reversed(code: &Code, i: usize, out: &mut Diagnostics) {
    let (Some(first), Some(last)) = (code.device(i, 0), code.device(i, 1)) else {
        return;
    };
    if first.class != last.class || first.number <= last.number {
        return;
    }
    let mnemonic = &code.instr(i).mnemonic;
    let places = &code.instr(i).operands;
    let diagnostic = codes::REVERSED_RANGE
        .at(code.span(i), format!("`{mnemonic}` resets `{first}` alone"))
        .label("the first device of the range comes after the last")
        .help(format!("write `{mnemonic} {last} {first}`"))
        .fix(
            Fix::suggested("swap the operands")
                .replace(places[0].span, last.to_string())
                .replace(places[1].span, first.to_string()),
        );
    out.push(diagnostic);
}
