//! Devices and constants of the PLC as they stand in statements and declarations.

use crate::literal::{Const, Literal};
use crate::types::Ty;
use rungc_syntax::{Device, DeviceClass, Index, OperandKind};

/// A device, and the type that it has without a declaration.
pub(crate) type Place = (OperandKind, Ty);

/// A constant of the PLC: `K10`, `H1F`.
pub(crate) fn constant(word: &str) -> Option<Literal> {
    let digits = word.get(1..).filter(|digits| !digits.is_empty())?;
    let value = match word.as_bytes()[0] {
        b'K' | b'k' if digits.bytes().all(|b| b.is_ascii_digit()) => digits.parse().ok()?,
        b'H' | b'h' if digits.bytes().all(|b| b.is_ascii_hexdigit()) => {
            i64::from_str_radix(digits, 16).ok()?
        }
        _ => return None,
    };
    Some((Const::Int(value), Ty::Integer))
}

/// A constant `E1.5`, of which the point and the fraction are the member of a name.
pub(crate) fn float(word: &str, fraction: &str) -> Option<Literal> {
    let whole = word.strip_prefix(['E', 'e'])?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let value = format!("{whole}.{fraction}");
    (is_number(whole) && is_number(fraction))
        .then_some((Const::Real(value.parse().ok()?), Ty::Fraction))
}

/// A device: `X010`, `D10`, `D0Z3`, `K4M0`, `TN0`, `U0\G5`.
pub(crate) fn find(word: &str) -> Option<Place> {
    let upper = word.to_ascii_uppercase();
    if let Some((module, address)) = upper.split_once("\\G") {
        let module = module.strip_prefix('U')?.parse().ok()?;
        let address = address.parse().ok()?;
        let buffer = OperandKind::Buffer {
            module,
            address,
            index: None,
        };
        return Some((buffer, Ty::Raw16));
    }
    let (body, index) = indexed(&upper);
    if let Some(rest) = body.strip_prefix('K') {
        let split = rest.find(|c: char| !c.is_ascii_digit())?;
        let (digits, bits) = rest.split_at(split);
        let digits: u8 = digits
            .parse()
            .ok()
            .filter(|digits| (1..=8).contains(digits))?;
        let (device, _) = plain(bits)?;
        use DeviceClass::{M, S, X, Y};
        if !matches!(device.class, X | Y | M | S) {
            return None;
        }
        let ty = if digits > 4 { Ty::Raw32 } else { Ty::Raw16 };
        return Some((OperandKind::Nibbles(digits, device, index), ty));
    }
    let (device, ty) = plain(body)?;
    Some((OperandKind::Device(device, index), ty))
}

/// A word without the index register after its number.
fn indexed(word: &str) -> (&str, Option<Index>) {
    let Some(at) = word.rfind(['V', 'Z']).filter(|at| *at > 0) else {
        return (word, None);
    };
    let (body, index) = word.split_at(at);
    let class = if index.starts_with('V') {
        DeviceClass::V
    } else {
        DeviceClass::Z
    };
    let digits = &index[1..];
    let number = if digits.is_empty() {
        Some(0)
    } else {
        digits.parse().ok()
    };
    match number.filter(|_| body.ends_with(|c: char| c.is_ascii_digit())) {
        Some(number) => (body, Some(Index { class, number })),
        None => (word, None),
    }
}

/// A device without an index. `TN`, `TS`, `TC` are the value, contact and coil of a timer.
fn plain(word: &str) -> Option<(Device, Ty)> {
    let split = word.find(|c: char| c.is_ascii_digit());
    let (letters, digits) = word.split_at(split.unwrap_or(word.len()));
    let (class, part) = match letters {
        "TN" => (DeviceClass::T, Some(Ty::Raw16)),
        "TS" | "TC" => (DeviceClass::T, Some(Ty::Bool)),
        "CN" => (DeviceClass::C, Some(Ty::Raw16)),
        "CS" | "CC" => (DeviceClass::C, Some(Ty::Bool)),
        letters => (DeviceClass::from_prefix(letters)?, None),
    };
    let radix = if class.is_octal() { 8 } else { 10 };
    let number = match (class, digits) {
        (DeviceClass::V | DeviceClass::Z, "") => 0,
        _ => u32::from_str_radix(digits, radix).ok()?,
    };
    use DeviceClass::{C, D, ER, M, R, S, T, V, X, Y, Z};
    let ty = match class {
        X | Y | M | S => Ty::Bool,
        T => Ty::Timer,
        C if number >= 200 => Ty::WideCounter,
        C => Ty::Timer,
        D | R | ER | V | Z => Ty::Raw16,
        _ => return None,
    };
    let ty = match part {
        Some(Ty::Raw16) if ty == Ty::WideCounter => Ty::Raw32,
        Some(part) => part,
        None => ty,
    };
    Some((Device { class, number }, ty))
}

/// An address of IEC 61131-3 as GX Works2 writes it: `%MX0.5` M5, `%MW0.5` and `%MD0.5` D5, `%IX5` X005, `%QX5` Y005,
/// `%MX5.5` T5.
pub(crate) fn address(text: &str) -> Option<Place> {
    let upper = text.to_ascii_uppercase();
    let word = upper.strip_prefix('%')?;
    let device = |class, number: &str| {
        let number = number.parse().ok()?;
        Some(Device { class, number })
    };
    let (device, ty) = if let Some(number) = word.strip_prefix("IX") {
        (device(DeviceClass::X, number)?, Ty::Bool)
    } else if let Some(number) = word.strip_prefix("QX") {
        (device(DeviceClass::Y, number)?, Ty::Bool)
    } else if let Some(number) = word.strip_prefix("MX0.") {
        (device(DeviceClass::M, number)?, Ty::Bool)
    } else if let Some(number) = word.strip_prefix("MX5.") {
        (device(DeviceClass::T, number)?, Ty::Timer)
    } else if let Some(number) = word.strip_prefix("MW0.") {
        (device(DeviceClass::D, number)?, Ty::Raw16)
    } else {
        let number = word.strip_prefix("MD0.")?;
        (device(DeviceClass::D, number)?, Ty::Raw32)
    };
    Some((OperandKind::Device(device, None), ty))
}

/// A bit of a register: `D10.3`, `D10.F`.
pub(crate) fn bit(word: &OperandKind, bit: &str) -> Option<OperandKind> {
    let OperandKind::Device(device, index) = word else {
        return None;
    };
    let bit = u8::from_str_radix(bit, 16).ok().filter(|bit| *bit < 16)?;
    Some(OperandKind::WordBit(*device, bit, *index))
}
