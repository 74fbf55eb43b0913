//! Rules about operands that a parameter of the catalogue cannot state: how operands limit each other, and numbers that must be
//! round.

use super::operands::constant_value;
use crate::catalogue::Found;
use crate::model::{Model, ModelId, ModelSet};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Instr, Operand, OperandKind, codes};
use rustc_hash::FxHashMap;

/// A rule about the operands of some instructions.
struct Rule {
    /// The instructions, by the names of their rows.
    insts: &'static [&'static str],
    /// The models that have the rule.
    models: ModelSet,
    /// The rule.
    demand: Demand,
}

/// What a rule demands of operands, which are given by position.
enum Demand {
    /// A constant lies in one of these ranges in the 16-bit form, or in one of those in the 32-bit form.
    Constant(usize, &'static [(i64, i64)], &'static [(i64, i64)]),
    /// The first constant is not greater than the second.
    NotAbove(usize, usize),
    /// A constant is a multiple of this.
    MultipleConstant(usize, i64),
    /// A device's number is a multiple of this.
    Multiple(usize, u32),
    /// A device's number, as it is written, ends in 0.
    Round(usize),
    /// Devices of this class have a number in this range.
    Number(usize, DeviceClass, u32, u32),
    /// Both operands are devices of one class.
    SameClass(usize, usize),
    /// Two groups have the same number of digits.
    SameDigits(usize, usize),
    /// A group and a word do not go together.
    SameKind(usize, usize),
    /// A group has this number of digits in the 16-bit form, or that in the 32-bit form.
    Digits(usize, u8, u8),
}

const HM: ModelSet = ModelSet::of(&[ModelId::Hm]);
const H1U: ModelSet = ModelSet::of(&[ModelId::H1u]);
const INOVANCE: ModelSet = ModelSet::of(&[ModelId::H1u, ModelId::H2u]);
const NOT_HM: ModelSet = ModelSet::ALL.except(&[ModelId::Hm]);

const fn rule(insts: &'static [&'static str], models: ModelSet, demand: Demand) -> Rule {
    Rule {
        insts,
        models,
        demand,
    }
}

const RULES: &[Rule] = &[
    // P128 to P131 are encrypted subroutines (h1u-h2u-programming §4.3.1).
    rule(&["CJ"], INOVANCE, Demand::Number(0, DeviceClass::P, 0, 127)),
    rule(&["SMOV"], ModelSet::ALL, Demand::NotAbove(2, 1)),
    rule(
        &["SFTL", "SFTR", "WSFL", "WSFR"],
        ModelSet::ALL,
        Demand::NotAbove(3, 2),
    ),
    rule(
        &["SFTL", "SFTR"],
        H1U,
        Demand::Constant(2, &[(1, 256)], &[]),
    ),
    rule(
        &["BMOV", "SFWR", "SFRD"],
        ModelSet::ALL,
        Demand::SameDigits(0, 1),
    ),
    rule(&["SFWR", "SFRD"], HM, Demand::SameKind(0, 1)),
    rule(
        &["ROL", "ROR", "RCL", "RCR"],
        ModelSet::ALL,
        Demand::Digits(0, 4, 8),
    ),
    rule(
        &["ROL", "ROR", "RCL", "RCR"],
        ModelSet::ALL,
        Demand::Constant(1, &[(0, 16)], &[(0, 32)]),
    ),
    rule(&["ZRST"], ModelSet::ALL, Demand::SameClass(0, 1)),
    rule(&["REF"], ModelSet::ALL, Demand::Round(0)),
    rule(&["REF"], NOT_HM, Demand::MultipleConstant(1, 8)),
    rule(&["REF"], HM, Demand::Constant(1, &[(8, 8)], &[])),
    rule(&["MTR"], ModelSet::ALL, Demand::Round(0)),
    rule(&["MTR"], ModelSet::ALL, Demand::Round(1)),
    rule(&["PRUN"], ModelSet::ALL, Demand::Round(0)),
    rule(&["PRUN"], ModelSet::ALL, Demand::Round(1)),
    rule(&["ABSD"], ModelSet::ALL, Demand::Digits(0, 4, 8)),
    rule(&["ROTC"], ModelSet::ALL, Demand::NotAbove(2, 1)),
    // Local modules 0 to 7, remote ones from 100 (h1u-h2u-programming §4.3.8).
    rule(
        &["FROM", "TO"],
        INOVANCE,
        Demand::Constant(0, &[(0, 7), (100, 32767)], &[(0, 7), (100, 32767)]),
    ),
    rule(&["HSCT"], HM, Demand::Multiple(3, 16)),
];

/// The rules by instruction.
pub(super) struct Rules(FxHashMap<&'static str, Vec<&'static Rule>>);

impl Rules {
    /// The rules of a model.
    pub(super) fn new(model: &Model) -> Self {
        let mut rules: FxHashMap<_, Vec<_>> = FxHashMap::default();
        for rule in RULES.iter().filter(|rule| rule.models.has(model.id)) {
            for &name in rule.insts {
                rules.entry(name).or_default().push(rule);
            }
        }
        Rules(rules)
    }

    /// What is wrong with the operands of an instruction by the rules for it.
    pub(super) fn broken(&self, found: Found, instr: &Instr) -> Vec<Diagnostic> {
        self.0.get(found.inst.name).map_or_else(Vec::new, |rules| {
            rules
                .iter()
                .filter_map(|rule| rule.demand.broken(&instr.operands, found.form.wide))
                .collect()
        })
    }
}

impl Demand {
    /// What to say if the operands do not meet the demand; an operand that is not there or not of the right kind meets it.
    fn broken(&self, operands: &[Operand], wide: bool) -> Option<Diagnostic> {
        let at = |i: usize| operands.get(i);
        let constant = |i: usize| constant_value(&at(i)?.kind);
        let device = |i: usize| device_of(&at(i)?.kind);
        let span = |i: usize| at(i).map(|operand| operand.span);
        let text = |i: usize| at(i).map(|operand| operand.kind.to_string());
        match *self {
            Demand::Constant(i, narrow, broad) => {
                let ranges = if wide { broad } else { narrow };
                let value = constant(i)?;
                let fits = ranges
                    .iter()
                    .any(|&(min, max)| (min..=max).contains(&value));
                (!fits).then_some(())?;
                let ranges: Vec<_> = ranges.iter().map(|&(min, max)| range(min, max)).collect();
                let message = format!("`{}` is outside the limits of this operand", text(i)?);
                Some(
                    codes::LIMITS
                        .at(span(i)?, message)
                        .label(format!("{} here", ranges.join(" or "))),
                )
            }
            Demand::NotAbove(low, high) => {
                (constant(low)? > constant(high)?).then_some(())?;
                let message = format!(
                    "`{}` must not be greater than `{}`",
                    text(low)?,
                    text(high)?
                );
                Some(disagree(&operands[low], &operands[high], message))
            }
            Demand::MultipleConstant(i, of) => {
                (constant(i)? % of != 0).then_some(())?;
                let message = format!("`{}` is not a multiple of {of}", text(i)?);
                Some(
                    codes::LIMITS
                        .at(span(i)?, message)
                        .label(format!("K{of}, K{}, … here", 2 * of)),
                )
            }
            Demand::Multiple(i, of) => {
                let device = device(i)?;
                (device.number % of != 0).then_some(())?;
                let next = device.class.number(device.number.next_multiple_of(of));
                let message = format!("the number of `{device}` is not a multiple of {of}");
                Some(
                    codes::NOT_THIS_NUMBER
                        .at(span(i)?, message)
                        .label(format!("e.g. {next}")),
                )
            }
            Demand::Round(i) => {
                let device = device(i)?;
                let base = if device.class.is_octal() { 8 } else { 10 };
                (device.number % base != 0).then_some(())?;
                let below = device.class.number(device.number - device.number % base);
                let message = format!("the number of `{device}` does not end in 0");
                Some(
                    codes::NOT_THIS_NUMBER
                        .at(span(i)?, message)
                        .label(format!("e.g. {below}")),
                )
            }
            Demand::Number(i, class, first, last) => {
                let device = device(i)?;
                (device.class == class && !(first..=last).contains(&device.number)).then_some(())?;
                let (first, last) = (class.number(first), class.number(last));
                let message = format!("`{device}` cannot serve here");
                Some(
                    codes::NOT_THIS_NUMBER
                        .at(span(i)?, message)
                        .label(format!("here only {first}–{last}")),
                )
            }
            Demand::SameClass(a, b) => {
                (device(a)?.class != device(b)?.class).then_some(())?;
                let message = format!("`{}` and `{}` are not of one class", text(a)?, text(b)?);
                Some(disagree(&operands[b], &operands[a], message))
            }
            Demand::SameDigits(a, b) => {
                (digits(at(a)?)? != digits(at(b)?)?).then_some(())?;
                let message = format!(
                    "`{}` and `{}` have different digit counts",
                    text(a)?,
                    text(b)?
                );
                Some(disagree(&operands[b], &operands[a], message))
            }
            Demand::SameKind(a, b) => {
                (device(a).is_some() && device(b).is_some()).then_some(())?;
                (digits(at(a)?).is_some() != digits(at(b)?).is_some()).then_some(())?;
                let message = format!(
                    "`{}` and `{}`: a group and a word do not go together",
                    text(a)?,
                    text(b)?
                );
                Some(disagree(&operands[b], &operands[a], message))
            }
            Demand::Digits(i, narrow, broad) => {
                let wanted = if wide { broad } else { narrow };
                (digits(at(i)?)? != wanted).then_some(())?;
                let message = format!("`{}` must have the full {wanted} digits here", text(i)?);
                Some(
                    codes::DIGITS
                        .at(span(i)?, message)
                        .label(format!("K{wanted} here")),
                )
            }
        }
    }
}

fn disagree(main: &Operand, other: &Operand, message: String) -> Diagnostic {
    codes::OPERANDS_DISAGREE
        .at(main.span, message)
        .label("this does not go …")
        .other(other.span, "… with this")
}

fn range(min: i64, max: i64) -> String {
    match min == max {
        true => format!("K{min}"),
        false => format!("K{min} to K{max}"),
    }
}

fn device_of(kind: &OperandKind) -> Option<Device> {
    match *kind {
        OperandKind::Device(device, _) | OperandKind::Nibbles(_, device, _) => Some(device),
        _ => None,
    }
}

fn digits(operand: &Operand) -> Option<u8> {
    match operand.kind {
        OperandKind::Nibbles(digits, ..) => Some(digits),
        _ => None,
    }
}
