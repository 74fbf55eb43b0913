//! Grammar of a whole field of a table.

use super::super::fault::Kind;
use super::operands::{device, operand, placed, text_operand};
use super::tokens::separators;
use super::{Body, Matched, Rule, body, label, mnemonic, operands, report, span};
use chumsky::prelude::*;
use rungc_syntax::{Device, Operand, OperandKind, Operands};
use smol_str::{SmolStr, ToSmolStr};

/// An operand that fills a whole field of a table.
pub(in crate::il) fn operand_field<'s>() -> impl Rule<'s, Operand> {
    let stray = any()
        .map_with(|_, e: &mut Matched| {
            report(e, Kind::Line);
            span(e.span())
        })
        .then_ignore(any().repeated());
    let unreadable = |span| Operand {
        span,
        kind: OperandKind::Unreadable(None),
    };
    separators().ignore_then(choice((
        operand()
            .then_ignore(separators())
            .then(stray.or_not())
            .map(move |(operand, stray)| stray.map_or(operand, unreadable)),
        stray.map(unreadable),
    )))
}

/// Several operands in one field.
pub(in crate::il) fn operands_field<'s>() -> impl Rule<'s, Operands> {
    let whole = separators().ignore_then(operands());
    whole.then_ignore(separators()).then_ignore(end())
}

/// A mnemonic and its operands in one field.
pub(in crate::il) fn instruction_field<'s>() -> impl Rule<'s, Body<'s>> {
    let whole = separators().ignore_then(body());
    whole.then_ignore(separators()).then_ignore(end())
}

/// The characters that ASC takes, filling a whole field of a table.
pub(in crate::il) fn text_field<'s>() -> impl Rule<'s, Operand> {
    let quoted = placed(text_operand()).then_ignore(end());
    let bare = any()
        .repeated()
        .to_slice()
        .map_with(|text: &str, e| Operand {
            span: span(e.span()),
            kind: OperandKind::Text(text.into()),
        });
    choice((quoted, bare))
}

/// A mnemonic or label that fills a whole field of a table.
pub(in crate::il) fn mnemonic_field<'s>() -> impl Rule<'s, Option<SmolStr>> {
    let pointer = label().map(|(device, _)| device.to_smolstr());
    let mnemonic = mnemonic().map(|(mnemonic, _)| mnemonic.into());
    let readable = choice((pointer, mnemonic))
        .then_ignore(separators())
        .then_ignore(end())
        .map(Some);
    let unreadable = any()
        .repeated()
        .at_least(1)
        .map_with(|(), e: &mut Matched| {
            report(e, Kind::Line);
            None
        });
    choice((readable, unreadable))
}

/// A device by itself.
pub(in crate::il) fn device_field<'s>() -> impl Rule<'s, Device> {
    device().padded().then_ignore(end())
}
