//! Operands that make an instruction fail, or do less than it says, each time it runs.

use super::Code;
use rungc_catalogue::{ArithOp, Lower, Rule, Shape};
use rungc_syntax::{DeviceClass, Diagnostics, Fix, Operand, OperandKind, Phrase, codes, phrase};

/// Checks the constants of instruction `i`.
pub(super) fn check(code: &Code, i: usize, out: &mut Diagnostics) {
    let Some(inst) = code.inst(i) else {
        return;
    };
    failing_constants(code, i, out);
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
    let diagnostic = codes::DIVISION_BY_ZERO.at(
        divisor.span,
        phrase!("`{mnemonic}` divides by zero", mnemonic),
    );
    out.push(match fails {
        true => {
            diagnostic.label("an operation error each time this runs; the result does not change")
        }
        false => diagnostic.label("gives the limit of the range each time this runs"),
    });
}

/// Constants with which the instruction always fails, by the rules of the catalogue.
fn failing_constants(code: &Code, i: usize, out: &mut Diagnostics) {
    let instr = code.instr(i);
    for (operand, param) in instr.operands.iter().zip(code.params(i)) {
        let Some(works) = param
            .rules
            .iter()
            .find_map(|rule| broken(rule, operand, &instr.operands))
        else {
            continue;
        };
        let message = phrase!(
            "`{mnemonic}` always fails with `{kind}`",
            mnemonic = instr.mnemonic,
            kind = operand.kind
        );
        out.push(
            codes::CONSTANT_FAILS
                .at(operand.span, message)
                .label(effect(code, i))
                .help(works),
        );
    }
}

/// Effect of an instruction that fails.
fn effect(code: &Code, i: usize) -> &'static str {
    let mut params = code.params(i).iter();
    let of_axis = params.any(|param| param.sends_pulses && param.shape == Shape::Word);
    match code.lower(i) {
        Some(Lower::Axis(_)) => "motions of the axis that need it do not start",
        Some(Lower::Exclusive(_)) => "the table does not change",
        _ if of_axis => "sends no pulses",
        _ => "an operation error each time this runs",
    }
}

/// The constants that work, if this one breaks the rule.
fn broken(rule: &Rule, operand: &Operand, all: &[Operand]) -> Option<Phrase> {
    let value = number(&operand.kind)?;
    let (breaks, works) = match *rule {
        Rule::WorksWith(min, i64::MAX) => (value < min as f64, phrase!("use {min} or more", min)),
        Rule::WorksWith(min, max) => (
            value < min as f64 || value > max as f64,
            phrase!("use a constant from {min} to {max}", min, max),
        ),
        Rule::WorksAbove(bound) => (
            value <= bound as f64,
            phrase!("use a constant above {bound}", bound),
        ),
        Rule::WordWorksTo(at, max) => {
            let word = !matches!(all.get(at)?.kind, OperandKind::Device(device, _) if is_bit(device.class));
            (
                word && value > max as f64,
                phrase!("use at most {max} with a word", max),
            )
        }
        Rule::WorksFrom(at) => {
            let other = all.get(at)?;
            let least = number(&other.kind)?;
            (
                value < least,
                phrase!("use `{kind}` or more", kind = other.kind),
            )
        }
        Rule::WorksIf(works, when) => (!works(all), phrase!("it works if {when}", when)),
        _ => return None,
    };
    breaks.then_some(works)
}

/// The value of a constant.
fn number(kind: &OperandKind) -> Option<f64> {
    match *kind {
        OperandKind::Float(value) => Some(value.into()),
        ref kind => kind.constant().map(|value| value as f64),
    }
}

/// Returns true for bits.
fn is_bit(class: DeviceClass) -> bool {
    matches!(
        class,
        DeviceClass::X | DeviceClass::Y | DeviceClass::M | DeviceClass::S
    )
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
        .at(
            code.span(i),
            phrase!("`{mnemonic}` resets `{first}` alone", mnemonic, first),
        )
        .label("the first device of the range comes after the last")
        .help(phrase!(
            "write `{mnemonic} {last} {first}`",
            mnemonic,
            last,
            first
        ))
        .fix(
            Fix::suggested("swap the operands")
                .replace(places[0].span, last.to_string())
                .replace(places[1].span, first.to_string()),
        );
    out.push(diagnostic);
}
