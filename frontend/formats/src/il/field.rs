//! Fields of a table read with the grammar of lists.

use super::fault::Faults;
use super::fold::Folded;
use super::grammar;
use rungc_syntax::{Diagnostics, Operand, OperandKind, Operands, Span};
use smol_str::SmolStr;

/// Reads a field that names an instruction or a label; `start` is its place in the source.
pub(crate) fn mnemonic(field: &str, start: u32, diagnostics: &mut Diagnostics) -> Option<SmolStr> {
    let mut faults = Faults::default();
    let folded = fold(field, &mut faults);
    let mnemonic = grammar::parse(&grammar::mnemonic_field(), &folded.text, &mut faults);
    report(faults, &folded, start, diagnostics);
    mnemonic.flatten()
}

/// Reads a field that holds an operand; `start` is its place in the source. `characters`: it is what ASC takes.
pub(crate) fn operand(
    field: &str,
    start: u32,
    characters: bool,
    diagnostics: &mut Diagnostics,
) -> Option<Operand> {
    let mut faults = Faults::default();
    let folded = match characters {
        true => Folded::of(field),
        false => fold(field, &mut faults),
    };
    let operand = if characters {
        grammar::parse(&grammar::text_field(), &folded.text, &mut faults)
    } else {
        grammar::parse(&grammar::operand_field(), &folded.text, &mut faults)
    };
    report(faults, &folded, start, diagnostics);
    operand.map(|mut operand| {
        place_operand(&mut operand, field, start, &place(&folded, start));
        operand
    })
}

/// Reads a field that holds a whole instruction, `MOV K1 D0`; `None` if it holds anything else.
pub(crate) fn instruction(field: &str, start: u32) -> Option<(SmolStr, Span, Operands)> {
    if is_word(field) {
        return None;
    }
    let mut faults = Faults::default();
    let folded = fold(field, &mut faults);
    let body = grammar::parse(&grammar::instruction_field(), &folded.text, &mut faults)?;
    let place = place(&folded, start);
    let mut operands = body.operands;
    for operand in &mut operands {
        place_operand(operand, field, start, &place);
    }
    let whole = faults.is_empty() && !operands.is_empty();
    whole.then(|| (body.mnemonic.into(), place(body.mnemonic_span), operands))
}

/// Reads a field that holds several operands, `K1 D0`; `None` if it holds anything else.
pub(crate) fn operands(field: &str, start: u32) -> Option<Operands> {
    if is_word(field) {
        return None;
    }
    let mut faults = Faults::default();
    let folded = fold(field, &mut faults);
    let mut operands = grammar::parse(&grammar::operands_field(), &folded.text, &mut faults)?;
    for operand in &mut operands {
        place_operand(operand, field, start, &place(&folded, start));
    }
    (faults.is_empty() && operands.len() > 1).then_some(operands)
}

/// Returns true if nothing separates words in a field.
fn is_word(field: &str) -> bool {
    !field.contains(|c: char| c.is_whitespace() || matches!(c, ',' | '，' | '\0'))
}

/// Gives an operand of a field, which begins at `start`, its place in the source, and its text as written.
fn place_operand(operand: &mut Operand, field: &str, start: u32, place: &impl Fn(Span) -> Span) {
    operand.span = place(operand.span);
    let [first, last] = [operand.span.start, operand.span.end].map(|at| (at - start) as usize);
    keep_text(operand, &field[first..last]);
}

/// Makes a text what was written: in it, full-width characters mean themselves.
pub(super) fn keep_text(operand: &mut Operand, written: &str) {
    let OperandKind::Text(text) = &mut operand.kind else {
        return;
    };
    let quoted = written
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    match quoted {
        Some(inside) if !inside.is_ascii() => *text = inside.replace("\"\"", "\"").into(),
        _ => {}
    }
}

fn fold(field: &str, faults: &mut Faults) -> Folded {
    let mut folded = Folded::default();
    folded.fold_line(field, faults);
    folded
}

fn place(folded: &Folded, start: u32) -> impl Fn(Span) -> Span {
    move |span| {
        let (first, last) = folded.original(span.start, span.end);
        Span::new(first + start, last + start)
    }
}

fn report(mut faults: Faults, folded: &Folded, start: u32, diagnostics: &mut Diagnostics) {
    diagnostics.extend(
        faults
            .drain()
            .map(|f| f.diagnostic(&folded.text, place(folded, start), None)),
    );
}
