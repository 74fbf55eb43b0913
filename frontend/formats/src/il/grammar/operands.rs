//! Devices, constants and texts.

use super::super::fault::{Faults, Kind, mistyped_digit};
use super::tokens::{blanks, digits, foreign_comment_start, letter, word, word_end};
use super::{Matched, Rule, device_field, parse, report, span};
use chumsky::prelude::*;
use rungc_syntax::{Device, DeviceClass, Index, Operand, OperandKind};
use smol_str::SmolStr;

/// One operand. What cannot be read is reported and stays as such, and the next operand is read.
pub(super) fn operand<'s>() -> impl Rule<'s, Operand> {
    let readable = choice((
        device_operand(),
        k_operand(),
        h_operand(),
        e_operand(),
        text_operand(),
        buffer_operand(),
    ));
    // After the last operand no kind of operand is tried.
    let none = choice((word_end(), foreign_comment_start()));
    none.not().ignore_then(choice((
        placed(readable),
        placed(spaced_operand()),
        placed(unreadable_operand()),
    )))
}

/// An operand where it is, up to the end of its word. One with an error is unreadable: no later check reports it again.
pub(super) fn placed<'s>(kind: impl Rule<'s, OperandKind>) -> impl Rule<'s, Operand> {
    kind.map_with(|kind, e: &mut Matched| {
        let place = e.span();
        let kind = match e.state().since(place.start) {
            [] => kind,
            faults if faults.iter().any(|fault| fault.kind.loses_number()) => {
                OperandKind::Unreadable(None)
            }
            _ => OperandKind::Unreadable(named(kind)),
        };
        Operand {
            span: span(place),
            kind,
        }
    })
    .then_ignore(word_end())
}

/// The device that an operand names, or was meant to name.
fn named(kind: OperandKind) -> Option<Device> {
    match kind {
        OperandKind::Device(device, _)
        | OperandKind::WordBit(device, ..)
        | OperandKind::Nibbles(_, device, _) => Some(device),
        OperandKind::Unreadable(meant) => meant,
        _ => None,
    }
}

fn class<'s>() -> impl Rule<'s, DeviceClass> {
    let single = select! {
        'X' | 'x' => DeviceClass::X,
        'M' | 'm' => DeviceClass::M,
        'Y' | 'y' => DeviceClass::Y,
        'S' | 's' => DeviceClass::S,
        'T' | 't' => DeviceClass::T,
        'C' | 'c' => DeviceClass::C,
        'D' | 'd' => DeviceClass::D,
        'R' | 'r' => DeviceClass::R,
        'V' | 'v' => DeviceClass::V,
        'Z' | 'z' => DeviceClass::Z,
        'P' | 'p' => DeviceClass::P,
        'I' | 'i' => DeviceClass::I,
        'N' | 'n' => DeviceClass::N,
    };
    let extension = letter('E').then(letter('R')).to(DeviceClass::ER);
    choice((single, extension))
}

fn index_class<'s>() -> impl Rule<'s, DeviceClass> {
    select! {
        'V' | 'v' => DeviceClass::V,
        'Z' | 'z' => DeviceClass::Z,
    }
}

/// The number of a device of this class, as far as its digits can be read.
pub(super) fn number(class: DeviceClass, digits: &str) -> (u32, Option<Kind>) {
    let radix = if class.is_octal() { 8 } else { 10 };
    if class.is_octal() && digits.bytes().any(|b| b > b'7') {
        return (digits.parse().unwrap_or(0), Some(Kind::Octal(class)));
    }
    match u32::from_str_radix(digits, radix) {
        Ok(number) => (number, None),
        Err(_) => (0, Some(Kind::DeviceNumber)),
    }
}

/// A device with its number.
pub(super) fn numbered<'s>(class: impl Rule<'s, DeviceClass>) -> impl Rule<'s, Device> {
    class.then(digits()).map_with(|(class, digits), e| {
        let (number, fault) = number(class, digits);
        if let Some(kind) = fault {
            report(e, kind);
        }
        Device { class, number }
    })
}

/// `X000`, `D0`, and `V` and `Z` without a number.
pub(super) fn device<'s>() -> impl Rule<'s, Device> {
    let bare = index_class()
        .then_ignore(word_end())
        .map(|class| Device { class, number: 0 });
    choice((numbered(class()), bare))
}

/// `Z0`, `V7`, `Z`.
fn index<'s>() -> impl Rule<'s, Index> {
    index_class()
        .then(digits().or_not())
        .map_with(|(class, digits), e| {
            let (number, fault) = digits.map_or((0, None), |digits| number(class, digits));
            if let Some(kind) = fault {
                report(e, kind);
            }
            Index { class, number }
        })
}

/// `X000`, `D0Z1`, `D0.F`, `D0.FZ1`.
fn device_operand<'s>() -> impl Rule<'s, OperandKind> {
    let bit = any()
        .filter(char::is_ascii_alphanumeric)
        .then(digits().or_not())
        .to_slice();
    device()
        .then(just('.').ignore_then(bit).or_not())
        .then(index().or_not())
        .map_with(|((device, bit), index), e| {
            let Some(bit) = bit else {
                return OperandKind::Device(device, index);
            };
            let bit = match u8::from_str_radix(bit, 16) {
                Ok(bit @ 0..=15) => bit,
                _ => {
                    report(e, Kind::BitNumber);
                    0
                }
            };
            OperandKind::WordBit(device, bit, index)
        })
}

/// `K10`, `K-5Z0`, `K4M0`, `K2X010Z1`.
fn k_operand<'s>() -> impl Rule<'s, OperandKind> {
    let amount = one_of("+-").or_not().then(digits()).to_slice();
    // An index register at the end of the word is an index.
    let only_index = index().or_not().then(word_end());
    let group = only_index.not().ignore_then(device());
    letter('K')
        .ignore_then(amount)
        .then(group.or_not())
        .then(index().or_not())
        .map_with(|((amount, group), index), e| {
            let mut fault = |kind| report(e, kind);
            let Some(device) = group else {
                let value = amount.parse::<i32>().unwrap_or_else(|_| {
                    fault(Kind::Decimal);
                    0
                });
                return OperandKind::Decimal(value.into(), index);
            };
            use DeviceClass::{M, S, X, Y};
            if !matches!(device.class, X | Y | M | S) {
                fault(Kind::DigitClass(device.class));
            }
            let digits = match amount.parse() {
                Ok(digits @ 1..=8) => digits,
                _ => {
                    fault(Kind::DigitCount);
                    4
                }
            };
            OperandKind::Nibbles(digits, device, index)
        })
}

/// `H1F`, `H1FZ0`.
fn h_operand<'s>() -> impl Rule<'s, OperandKind> {
    let digits = any()
        .filter(char::is_ascii_hexdigit)
        .repeated()
        .at_least(1)
        .to_slice();
    letter('H')
        .ignore_then(digits)
        .then(index().or_not())
        .map_with(|(hex, index), e| {
            let value = u32::from_str_radix(hex, 16).unwrap_or_else(|_| {
                report(e, Kind::Hex);
                0
            });
            OperandKind::Hex(value.into(), index)
        })
}

/// `E1.5`, `E-1.5E+3`, and `E1.5+3` as the manuals of FX print it.
fn e_operand<'s>() -> impl Rule<'s, OperandKind> {
    let sign = one_of("+-");
    let whole = digits().then(just('.').then(digits().or_not()).or_not());
    let fraction = just('.').then(digits());
    let mantissa = sign
        .or_not()
        .then(choice((whole.ignored(), fraction.ignored())))
        .to_slice();
    let exponent = choice((
        letter('E').ignore_then(sign.or_not().then(digits()).to_slice()),
        sign.then(digits()).to_slice(),
    ));
    letter('E')
        .ignore_then(mantissa)
        .then(exponent.or_not())
        .map_with(|(mantissa, exponent): (&str, Option<&str>), e| {
            let value = match exponent {
                None => mantissa.parse::<f32>(),
                Some(exponent) => format!("{mantissa}e{exponent}").parse(),
            };
            let is_zero = !mantissa.contains(|c: char| matches!(c, '1'..='9'));
            let value: Option<f32> = value.ok();
            let read = value.filter(|value| is_zero || *value != 0.0);
            read.and_then(OperandKind::float).unwrap_or_else(|| {
                let is_large = value.is_none_or(f32::is_infinite);
                report(
                    e,
                    if is_large {
                        Kind::Float
                    } else {
                        Kind::SmallFloat
                    },
                );
                OperandKind::Float(0.0)
            })
        })
}

/// `"ABC"`; a quote inside is written twice.
pub(super) fn text_operand<'s>() -> impl Rule<'s, OperandKind> {
    choice((just("\"\"").ignored(), none_of('"').ignored()))
        .repeated()
        .to_slice()
        .delimited_by(just('"'), just('"'))
        .map(|text: &str| {
            OperandKind::Text(if text.contains('"') {
                text.replace("\"\"", "\"").into()
            } else {
                SmolStr::new(text)
            })
        })
}

/// The characters of ASC without quotes.
pub(super) fn bare_text<'s>() -> impl Rule<'s, OperandKind> {
    none_of('"')
        .and_is(word_end().not())
        .repeated()
        .at_least(1)
        .to_slice()
        .map(|text: &str| OperandKind::Text(text.into()))
}

/// `U0\G5`.
fn buffer_operand<'s>() -> impl Rule<'s, OperandKind> {
    letter('U')
        .ignore_then(digits())
        .then_ignore(just('\\'))
        .then_ignore(letter('G'))
        .then(digits())
        .then(index().or_not())
        .map_with(|((module, address), index), e| {
            let mut number = |digits: &str| {
                digits.parse().unwrap_or_else(|_| {
                    report(e, Kind::DeviceNumber);
                    0
                })
            };
            OperandKind::Buffer {
                module: number(module),
                address: number(address),
                index,
            }
        })
}

/// `K 10`, `X 000`: a space before the number.
fn spaced_operand<'s>() -> impl Rule<'s, OperandKind> {
    let constant = choice((letter('K'), letter('H')));
    choice((class().map(Some), constant.to(None)))
        .then_ignore(blanks())
        .then(digits())
        .then_ignore(word_end())
        .map_with(|(class, digits), e| {
            report(e, Kind::SpacedNumber);
            class.map_or(OperandKind::Unreadable(None), |class| {
                let (number, _) = number(class, digits);
                OperandKind::Device(Device { class, number }, None)
            })
        })
}

/// Any other word.
fn unreadable_operand<'s>() -> impl Rule<'s, OperandKind> {
    word().map_with(|word: &str, e| {
        let open = word.starts_with('"') && word.matches('"').count() % 2 == 1;
        let kind = if open { Kind::Unclosed } else { Kind::Operand };
        report(e, kind);
        OperandKind::Unreadable(meant_device(word))
    })
}

/// The device that an unreadable operand was probably meant to name: `MO`, `XOO1`.
fn meant_device(word: &str) -> Option<Device> {
    let meant = mistyped_digit(&word.to_ascii_uppercase())?;
    parse(&device_field(), &meant, &mut Faults::default())
}
