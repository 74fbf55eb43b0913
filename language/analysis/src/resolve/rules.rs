//! Conditions on an operand in addition to its class and limits: the [`Rule`]s of the catalogue.

use super::operands::is_unreadable;
use rungc_catalogue::{Limits, Param, Rule};
use rungc_models::runs::{FIRST_COUNTER32, is_special};
use rungc_syntax::{
    Classes, Device, DeviceClass, Diagnostic, Operand, OperandKind, Phrase, codes, phrase,
};

/// Error in operand `at` of an instruction by the rules of its parameter, if any.
pub(super) fn broken(
    operands: &[Operand],
    at: usize,
    param: &Param,
    wide: bool,
) -> Option<Diagnostic> {
    let operand = operands.get(at).filter(|operand| !is_unreadable(operand))?;
    let against = |other: usize, wrong: fn(i64, i64) -> bool, demand| {
        compare(operand, operands.get(other)?, wrong, demand)
    };
    param.rules.iter().find_map(|rule| match *rule {
        // A failure at run time is a warning.
        Rule::WorksWith(..)
        | Rule::WorksAbove(_)
        | Rule::WordWorksTo(..)
        | Rule::WorksFrom(_)
        | Rule::WorksIf(..)
        | Rule::WideLimits(..)
        | Rule::WordsWith(_) => None,
        Rule::Not(min, max) => {
            let value = operand.kind.constant()?;
            (min..=max)
                .contains(&value)
                .then(|| forbidden(operand, min, max))
        }
        Rule::MultipleOf(of) => {
            let value = operand.kind.constant()?;
            (of != 0 && value % of != 0).then(|| no_multiple(operand, of))
        }
        Rule::AtMost(other) => against(other, |v, bound| v > bound, Demand::AtMost),
        Rule::AtLeast(other) => against(other, |v, bound| v < bound, Demand::AtLeast),
        Rule::Below(other) => against(other, |v, bound| v >= bound, Demand::Below),
        Rule::EndsInZero => {
            let device = device_of(&operand.kind)?;
            let base = if device.class.is_octal() { 8 } else { 10 };
            let message = phrase!("the number of `{device}` does not end in 0", device);
            unaligned(operand, device, base, message)
        }
        Rule::Aligned(of) => {
            let device = device_of(&operand.kind)?;
            unaligned(operand, device, of, not_a_multiple(device, of))
        }
        Rule::WholeGroup => {
            let whole = if wide { 8 } else { 4 };
            let digits = digits(operand)?;
            (digits != whole).then(|| partial_group(operand, whole))
        }
        Rule::GroupAligned(of) | Rule::WideAligned(of) => {
            let narrow = matches!(rule, Rule::WideAligned(_)) && !wide;
            digits(operand).filter(|_| !narrow)?;
            let device = device_of(&operand.kind)?;
            unaligned(operand, device, of, not_a_multiple(device, of))
        }
        Rule::SameDigits(other) => {
            let other = operands.get(other)?;
            let differ = digits(operand)? != digits(other)?;
            differ.then(|| disagree(operand, other, Demand::SameDigits))
        }
        Rule::GroupLike(other) => unlike_group(operand, operands.get(other)?),
        Rule::GroupAtMost(other, max) => too_many_groups(operand, operands.get(other)?, max),
        Rule::NotBefore(other) => before(operand, operands.get(other)?),
        Rule::WideCounter => {
            let device = device_of(&operand.kind)?;
            let narrow = device.class == DeviceClass::C && device.number < FIRST_COUNTER32;
            (wide && narrow).then(|| narrow_counter(operand))
        }
        Rule::WideNot(classes) => {
            let barred = wide && classes.meets(Classes::of(&operand.kind));
            barred.then(|| only_narrow(operand))
        }
        Rule::Holds(holds, demand) => (!holds(operands)).then(|| contradictory(operand, demand)),
        Rule::Suits(suits, demand) => {
            (!suits(operand.kind.constant()?)).then(|| unsuited(operand, demand))
        }
        Rule::ClassLike(other) => unlike_class(operand, operands.get(other)?),
    })
}

/// Operands that a predicate does not accept together.
fn contradictory(operand: &Operand, demand: &'static str) -> Diagnostic {
    let message = phrase!(
        "`{kind}` contradicts the other operands",
        kind = operand.kind
    );
    codes::OPERANDS_DISAGREE
        .at(operand.span, message)
        .label(demand)
}

/// A constant that a predicate does not accept.
fn unsuited(operand: &Operand, demand: &'static str) -> Diagnostic {
    let message = phrase!(
        "`{kind}` is not a value that is accepted here",
        kind = operand.kind
    );
    codes::LIMITS.at(operand.span, message).label(demand)
}

/// Of two devices, one is a group of bits and the other is not.
fn unlike_group(operand: &Operand, other: &Operand) -> Option<Diagnostic> {
    device_of(&operand.kind).and(device_of(&other.kind))?;
    let differ = digits(operand).is_some() != digits(other).is_some();
    differ.then(|| disagree(operand, other, Demand::Match))
}

/// A number of values is greater than `max`, and the other operand is a group of bits.
fn too_many_groups(operand: &Operand, other: &Operand, max: i64) -> Option<Diagnostic> {
    digits(other)?;
    let value = operand.kind.constant()?;
    (value > max).then(|| {
        let message = phrase!("`{kind}` is too many groups of bits", kind = operand.kind);
        codes::LIMITS
            .at(operand.span, message)
            .label(phrase!("at most K{max} with a group", max))
    })
}

/// A last device comes before the first one, or in another range of its class.
fn before(operand: &Operand, other: &Operand) -> Option<Diagnostic> {
    let (last, first) = (unindexed(&operand.kind)?, unindexed(&other.kind)?);
    let apart = is_special(first.class, first.number) != is_special(last.class, last.number);
    (first.class == last.class && (apart || last.number < first.number))
        .then(|| disagree(operand, other, Demand::SameRange))
}

/// Two operands are of different classes.
fn unlike_class(operand: &Operand, other: &Operand) -> Option<Diagnostic> {
    let differ = Classes::of(&operand.kind) != Classes::of(&other.kind);
    (differ && !is_unreadable(other)).then(|| {
        disagree(operand, other, Demand::SameClass)
            .help("name the first and the last device of one class")
    })
}

/// The limits of a constant in the form that is written.
pub(super) fn limits(param: &Param, wide: bool) -> Limits {
    let of_wide_form = param.rules.iter().find_map(|rule| match *rule {
        Rule::WideLimits(min, max) if wide => Some(Limits::Between((min, max))),
        _ => None,
    });
    of_wide_form.unwrap_or(param.limits)
}

/// A class that the 32-bit form does not take.
fn only_narrow(operand: &Operand) -> Diagnostic {
    let message = phrase!(
        "`{kind}` cannot be this operand of the 32-bit form",
        kind = operand.kind
    );
    codes::OPERAND_CLASS
        .at(operand.span, message)
        .label("only the 16-bit form takes it")
        .help("use a pair of data registers, and move its low word to the index register")
}

fn forbidden(operand: &Operand, min: i64, max: i64) -> Diagnostic {
    let message = phrase!("`{kind}` has no meaning here", kind = operand.kind);
    let range = match min == max {
        true => phrase!("K{min} is not used", min),
        false => phrase!("K{min} to K{max} are not used", min, max),
    };
    codes::LIMITS.at(operand.span, message).label(range)
}

fn no_multiple(operand: &Operand, of: i64) -> Diagnostic {
    let message = phrase!(
        "`{kind}` is not a multiple of {of}",
        kind = operand.kind,
        of
    );
    codes::LIMITS.at(operand.span, message).label(phrase!(
        "K{of}, K{twice}, … here",
        of,
        twice = of.saturating_mul(2)
    ))
}

fn compare(
    operand: &Operand,
    other: &Operand,
    wrong: fn(i64, i64) -> bool,
    demand: Demand,
) -> Option<Diagnostic> {
    let (value, bound) = (operand.kind.constant()?, other.kind.constant()?);
    wrong(value, bound).then(|| disagree(operand, other, demand))
}

fn not_a_multiple(device: Device, of: u32) -> Phrase {
    phrase!(
        "the number of `{device}` is not a multiple of {of}",
        device,
        of
    )
}

fn unaligned(operand: &Operand, device: Device, of: u32, message: Phrase) -> Option<Diagnostic> {
    let rest = device.number.checked_rem(of).filter(|&rest| rest != 0)?;
    let below = device.class.number(device.number - rest);
    Some(
        codes::NOT_THIS_NUMBER
            .at(operand.span, message)
            .label(phrase!("e.g. {below}", below)),
    )
}

fn partial_group(operand: &Operand, whole: u8) -> Diagnostic {
    let message = phrase!(
        "`{kind}` must have all {whole} digits here",
        kind = operand.kind,
        whole
    );
    codes::DIGITS
        .at(operand.span, message)
        .label(phrase!("K{whole} here", whole))
}

fn narrow_counter(operand: &Operand) -> Diagnostic {
    let message = phrase!(
        "`{kind}` is a 16-bit counter; a 32-bit one is required here",
        kind = operand.kind
    );
    codes::NOT_THIS_NUMBER
        .at(operand.span, message)
        .label("C200 and up in the 32-bit form")
}

/// What an operand has to be in relation to another one.
#[derive(Clone, Copy)]
enum Demand {
    AtMost,
    AtLeast,
    Below,
    SameDigits,
    Match,
    SameRange,
    SameClass,
}

fn disagree(operand: &Operand, other: &Operand, demand: Demand) -> Diagnostic {
    let (one, another) = (&operand.kind, &other.kind);
    let message = match demand {
        Demand::AtMost => phrase!("`{one}` must not be greater than `{another}`", one, another),
        Demand::AtLeast => phrase!("`{one}` must not be smaller than `{another}`", one, another),
        Demand::Below => phrase!("`{one}` must be smaller than `{another}`", one, another),
        Demand::SameDigits => phrase!(
            "`{one}` must have as many digits as `{another}`",
            one,
            another
        ),
        Demand::Match => phrase!("`{one}` does not match `{another}`", one, another),
        Demand::SameRange => phrase!(
            "`{one}` must be in the same range as, and not before, `{another}`",
            one,
            another
        ),
        Demand::SameClass => phrase!(
            "`{one}` must be of the same class as `{another}`",
            one,
            another
        ),
    };
    // The labels are read in the order of their places.
    let (here, there) = match other.span < operand.span {
        true => ("… conflicts with this", "this …"),
        false => ("this …", "… conflicts with this"),
    };
    codes::OPERANDS_DISAGREE
        .at(operand.span, message)
        .label(here)
        .other(other.span, there)
}

fn device_of(kind: &OperandKind) -> Option<Device> {
    match *kind {
        OperandKind::Device(device, _) | OperandKind::Nibbles(_, device, _) => Some(device),
        _ => None,
    }
}

/// The device that an operand without an index register names.
fn unindexed(kind: &OperandKind) -> Option<Device> {
    match *kind {
        OperandKind::Device(device, None) => Some(device),
        _ => None,
    }
}

fn digits(operand: &Operand) -> Option<u8> {
    match operand.kind {
        OperandKind::Nibbles(digits, ..) => Some(digits),
        _ => None,
    }
}
