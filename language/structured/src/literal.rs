//! Constants as they are written.

use crate::types::Ty;

/// Value of a constant.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Const {
    Bool(bool),
    Int(i64),
    Real(f64),
}

/// A constant and its type.
pub(crate) type Literal = (Const, Ty);

/// A number without a type: `12`, `1_000`, `16#FF`, `1.5E3`.
pub(crate) fn number(text: &str) -> Option<Literal> {
    let text = text.replace('_', "");
    if let Some((radix, digits)) = text.split_once('#') {
        let radix = radix
            .parse()
            .ok()
            .filter(|radix| [2, 8, 10, 16].contains(radix))?;
        let value = i64::from_str_radix(digits, radix).ok()?;
        return Some((Const::Int(value), Ty::Integer));
    }
    if text.bytes().all(|b| b.is_ascii_digit()) {
        return Some((Const::Int(text.parse().ok()?), Ty::Integer));
    }
    let value: f64 = text.parse().ok()?;
    value
        .is_finite()
        .then_some((Const::Real(value), Ty::Fraction))
}

/// A value with its type: `T#5s`, `INT#-5`, `WORD#16#FF`, `BOOL#1`.
pub(crate) fn typed(text: &str) -> Option<Literal> {
    let (name, value) = text.split_once('#')?;
    let ty = match name.to_ascii_uppercase().as_str() {
        "T" => Ty::Time,
        name => Ty::named(name)?,
    };
    match ty {
        Ty::Time => Some((Const::Int(duration(value)?), ty)),
        Ty::Bool => {
            let is_true = value == "1" || value.eq_ignore_ascii_case("TRUE");
            let is_false = value == "0" || value.eq_ignore_ascii_case("FALSE");
            (is_true || is_false).then_some((Const::Bool(is_true), ty))
        }
        Ty::Timer => None,
        _ => {
            let (negative, digits) = match value.strip_prefix('-') {
                Some(digits) => (true, digits),
                None => (false, value.strip_prefix('+').unwrap_or(value)),
            };
            let value = match (number(digits)?.0, ty) {
                (Const::Int(value), Ty::Real) => Const::Real(value as f64),
                (Const::Real(_), ty) if ty != Ty::Real => return None,
                (value, _) => value,
            };
            Some((if negative { negated(value)? } else { value }, ty))
        }
    }
}

fn negated(value: Const) -> Option<Const> {
    match value {
        Const::Int(value) => value.checked_neg().map(Const::Int),
        Const::Real(value) => Some(Const::Real(-value)),
        Const::Bool(_) => None,
    }
}

/// A duration in milliseconds: `1h30m`, `5s500ms`, `1.5s`.
fn duration(text: &str) -> Option<i64> {
    let (negative, mut text) = match text.strip_prefix('-') {
        Some(text) => (true, text),
        None => (false, text),
    };
    let mut total = 0.0;
    if text.is_empty() {
        return None;
    }
    while !text.is_empty() {
        let digits = text.find(|c: char| c != '.' && c != '_' && !c.is_ascii_digit())?;
        let (number, rest) = text.split_at(digits);
        let unit = rest
            .find(|c: char| !c.is_ascii_alphabetic())
            .unwrap_or(rest.len());
        let (unit, rest) = rest.split_at(unit);
        let number: f64 = number.replace('_', "").parse().ok()?;
        let factor = match unit.to_ascii_lowercase().as_str() {
            "d" => 86_400_000.0,
            "h" => 3_600_000.0,
            "m" => 60_000.0,
            "s" => 1_000.0,
            "ms" => 1.0,
            _ => return None,
        };
        total += number * factor;
        text = rest.trim_start_matches('_');
    }
    let total = if negative { -total } else { total };
    (f64::abs(total) <= f64::from(i32::MAX)).then_some(total as i64)
}

/// The values that a type has.
pub(crate) fn range(ty: Ty) -> Option<(i64, i64)> {
    Some(match ty {
        Ty::Bool => (0, 1),
        Ty::Int => (i16::MIN.into(), i16::MAX.into()),
        Ty::Word => (0, u16::MAX.into()),
        Ty::Raw16 | Ty::Timer => (i16::MIN.into(), u16::MAX.into()),
        Ty::Dint | Ty::Time => (i32::MIN.into(), i32::MAX.into()),
        Ty::Dword => (0, u32::MAX.into()),
        Ty::Raw32 | Ty::WideCounter => (i32::MIN.into(), u32::MAX.into()),
        _ => return None,
    })
}
