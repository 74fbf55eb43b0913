//! Grammar of one line, over half-width text; places are byte offsets within the line.
//!
//! ```text
//! line  = [step] [label] [instruction] [comment]
//! label = pointer [":"]
//! instruction = mnemonic {operand}
//! ```
//!
//! Separators may stand between all parts. Every line can be read: the last alternative of a rule takes what the others
//! cannot read, and what is wrong goes into the parser's state, which forgets what an abandoned alternative reported.

mod fields;
mod operands;
mod tokens;

pub(super) use fields::{
    device_field, instruction_field, mnemonic_field, operand_field, operands_field, text_field,
};

use super::fault::{Fault, Faults, Kind};
use chumsky::error::EmptyErr;
use chumsky::input::MapExtra;
use chumsky::prelude::*;
use operands::{bare_text, number, numbered, operand, placed, text_operand};
use rungc_syntax::{Device, DeviceClass, Operands, Span};
use std::borrow::Cow;
use tokens::{blanks, comment_start, digits, foreign_comment_start, letter, separators, word_end};

/// No line fails, so expected continuations are never needed: the error type is empty, which makes alternatives cheap.
type Extra = extra::Full<EmptyErr, Faults, ()>;

/// Input that a rule has matched, for its mapping.
type Matched<'s, 'p> = MapExtra<'s, 'p, &'s str, Extra>;

/// A rule of the grammar that gives a `T`.
pub(super) trait Rule<'s, T>: Parser<'s, &'s str, T, Extra> + Copy {}

impl<'s, T, P: Parser<'s, &'s str, T, Extra> + Copy> Rule<'s, T> for P {}

/// The content of one line.
#[derive(Debug)]
pub(super) struct Line<'s> {
    /// Step number in front.
    pub step: Option<u32>,
    /// Label, which may be followed by an instruction.
    pub label: Option<(Device, Span)>,
    /// The instruction.
    pub instr: Option<Body<'s>>,
    /// Start of the comment's text, after `;` or `//`.
    pub comment: Option<u32>,
}

/// Mnemonic and operands.
#[derive(Debug)]
pub(super) struct Body<'s> {
    /// In upper case, operator joined.
    pub mnemonic: Cow<'s, str>,
    /// Position of the mnemonic.
    pub mnemonic_span: Span,
    /// The operands.
    pub operands: Operands,
}

/// Applies a rule to a whole text; its faults come after `faults`. A text that lacks something gives nothing.
pub(super) fn parse<'s, T>(
    rule: &impl Rule<'s, T>,
    text: &'s str,
    faults: &mut Faults,
) -> Option<T> {
    let output = rule.parse_with_state(text, faults).into_output();
    if output.is_none() {
        let end = text.len();
        faults.push(Fault::new((end..end).into(), Kind::Line));
    }
    output
}

/// Reports what is wrong with what a rule has read.
fn report(matched: &mut Matched, kind: Kind) {
    let fault = Fault::new(matched.span(), kind);
    matched.state().push(fault);
}

fn span(span: SimpleSpan) -> Span {
    Span::new(span.start as u32, span.end as u32)
}

/// A whole line. A line that is not an instruction is reported and skipped up to its comment.
pub(super) fn line<'s>() -> impl Rule<'s, Line<'s>> {
    let content = choice((body().map(Some), nonsense().map(|()| None)));
    separators()
        .ignore_then(step().or_not())
        .then_ignore(separators())
        .then(label().or_not())
        .then_ignore(separators())
        .then(content.or_not())
        .then_ignore(separators())
        .then(comment().or_not())
        .map_with(|(((step, label), content), comment), e: &mut Matched| {
            if let (Some((_, place)), None, None) = (step, &label, &content) {
                e.state().push(Fault::new(place, Kind::Bare));
            }
            Line {
                step: step.map(|(number, _)| number),
                label,
                instr: content.flatten(),
                comment,
            }
        })
}

/// `12`, `12:`, `12.`, `12)`.
fn step<'s>() -> impl Rule<'s, (u32, SimpleSpan)> {
    let number = digits().map_with(|digits, e| {
        let step = digits.parse().unwrap_or_else(|_| {
            report(e, Kind::Step);
            0
        });
        (step, e.span())
    });
    number.then_ignore(choice((word_end(), one_of(":.)").ignored())))
}

/// `P0`, `P0:`, `I001`.
fn label<'s>() -> impl Rule<'s, (Device, Span)> {
    let class = select! {
        'P' | 'p' => DeviceClass::P,
        'I' | 'i' => DeviceClass::I,
    };
    let spaced =
        class
            .then_ignore(blanks())
            .then(digits())
            .map_with(|(class, digits): (_, &str), e| {
                report(e, Kind::SpacedLabel);
                let (number, _) = number(class, digits);
                Device { class, number }
            });
    let colon = separators().then(just(':')).ignored();
    choice((numbered(class), spaced))
        .map_with(|device, e| (device, span(e.span())))
        .then_ignore(choice((colon, word_end())))
}

/// An instruction: a mnemonic and its operands.
fn body<'s>() -> impl Rule<'s, Body<'s>> {
    let usual = mnemonic().then_ignore(separators()).then(operands()).map(
        |((mnemonic, mnemonic_span), operands)| Body {
            mnemonic,
            mnemonic_span,
            operands,
        },
    );
    choice((asc(), usual))
}

fn operands<'s>() -> impl Rule<'s, Operands> {
    operand().separated_by(separators().at_least(1)).collect()
}

/// `ASC ABCDEFGH D300`: the characters are bare, whatever they look like.
fn asc<'s>() -> impl Rule<'s, Body<'s>> {
    let name = letter('A').then(letter('S')).then(letter('C'));
    let text = placed(choice((text_operand(), bare_text())));
    name.to_span()
        .then_ignore(word_end())
        .then_ignore(separators())
        .then(text)
        .then_ignore(separators())
        .then(operands())
        .map(|((name, text), mut operands)| {
            operands.insert(0, text);
            Body {
                mnemonic: Cow::Borrowed("ASC"),
                mnemonic_span: span(name),
                operands,
            }
        })
}

/// `LD`, `DMOVP`, `LD>=`, `LD D>=`, `ADD+P`.
fn mnemonic<'s>() -> impl Rule<'s, (Cow<'s, str>, Span)> {
    let first = any().filter(|c: &char| c.is_ascii_alphabetic() || matches!(c, '$' | '_'));
    let other = any().filter(|c: &char| c.is_ascii_alphanumeric() || *c == '_');
    let name = first.then(other.repeated()).to_slice();
    let pulse = letter('P').then_ignore(word_end()).to_slice().or_not();
    let added = one_of("+-")
        .to_slice()
        .then(pulse)
        .then_ignore(word_end())
        .map(|(operator, pulse)| (None, operator, pulse));
    let compared = separators()
        .ignore_then(letter('D').to_slice().or_not())
        .then(choice((
            just("!=").to_slice(),
            one_of("<=>").repeated().at_least(1).at_most(2).to_slice(),
        )))
        .then(pulse)
        .map(|((wide, operator), pulse)| (wide, operator, pulse));
    let plain = word_end().to((None, "", None));
    name.then(choice((added, compared, plain))).map_with(
        |(name, (wide, operator, pulse)): (&str, (Option<&str>, &str, Option<&str>)), e| {
            (spelling(name, wide, operator, pulse), span(e.span()))
        },
    )
}

/// The mnemonic's spelling: upper case, without the space or the second `D` of `LD D>=`, operators in the usual order.
fn spelling<'s>(
    name: &'s str,
    wide: Option<&str>,
    operator: &str,
    pulse: Option<&str>,
) -> Cow<'s, str> {
    if operator.is_empty() && !name.bytes().any(|b| b.is_ascii_lowercase()) {
        return Cow::Borrowed(name);
    }
    let operator = match operator {
        "=>" => ">=",
        "=<" => "<=",
        "><" => "<>",
        other => other,
    };
    let parts = [name, wide.unwrap_or(""), operator, pulse.unwrap_or("")];
    Cow::Owned(parts.concat().to_ascii_uppercase())
}

/// Text up to the comment that is not an instruction.
fn nonsense<'s>() -> impl Rule<'s, ()> {
    let text = any()
        .and_is(comment_start().not())
        .repeated()
        .at_least(1)
        .to_slice();
    foreign_comment_start()
        .not()
        .ignore_then(text)
        .map_with(|text: &str, e| {
            let start = e.span().start;
            let place = start..start + text.trim_end().len();
            e.state().push(Fault::new(place.into(), Kind::Line));
        })
}

/// A comment up to the end of the line; gives where its text starts.
fn comment<'s>() -> impl Rule<'s, u32> {
    let usual = comment_start().map_with(|(), e| e.span());
    let foreign = foreign_comment_start().map_with(|(), e| {
        report(e, Kind::CommentSign);
        e.span()
    });
    choice((usual, foreign))
        .then_ignore(any().repeated())
        .map(|sign: SimpleSpan| sign.end as u32)
}
