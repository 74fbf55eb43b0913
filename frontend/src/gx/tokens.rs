//! The token codes of GX Developer and GX Works2: one table, and the reading of operands.
//!
//! A token is `[len, body…, len]`, where `len` counts both length bytes. The first byte of the body tells its kind: below 80h an
//! instruction, 80h a line statement, 82h a note, from 90h an operand, from F0h a prefix of the operand that follows.

use rungc_syntax::{Device, DeviceClass, Index, OperandKind};
use smol_str::{SmolStr, format_smolstr};

/// Bodies of instruction tokens. Those of three bytes are applied instructions: family, length in steps, sub-code; a fourth byte 02
/// makes them pulse forms.
const INSTRUCTIONS: &[(&[u8], &str)] = &[
    (&[], "NOP"),
    (&[0x00], "LD"),
    (&[0x00, 0x03], "LD"),
    (&[0x01], "LDI"),
    (&[0x01, 0x03], "LDI"),
    (&[0x02, 0x02], "LDP"),
    (&[0x03, 0x02], "LDF"),
    (&[0x06], "OR"),
    (&[0x06, 0x03], "OR"),
    (&[0x07], "ORI"),
    (&[0x07, 0x03], "ORI"),
    (&[0x08, 0x02], "ORP"),
    (&[0x09, 0x02], "ORF"),
    (&[0x0C], "AND"),
    (&[0x0C, 0x03], "AND"),
    (&[0x0D], "ANI"),
    (&[0x0D, 0x03], "ANI"),
    (&[0x0E, 0x02], "ANDP"),
    (&[0x0F, 0x02], "ANDF"),
    (&[0x14], "INV"),
    (&[0x18], "ORB"),
    (&[0x19], "ANB"),
    (&[0x1A], "MPS"),
    (&[0x1B], "MRD"),
    (&[0x1C], "MPP"),
    (&[0x20], "OUT"),
    (&[0x20, 0x03], "OUT"),
    (&[0x21, 0x03], "OUT"),
    (&[0x21, 0x05], "OUT"),
    (&[0x23], "SET"),
    (&[0x23, 0x02], "SET"),
    (&[0x23, 0x03], "SET"),
    (&[0x24], "RST"),
    (&[0x24, 0x02], "RST"),
    (&[0x24, 0x03], "RST"),
    (&[0x25, 0x02], "PLS"),
    (&[0x26, 0x02], "PLF"),
    (&[0x2C, 0x05], "MC"),
    (&[0x33], "FEND"),
    (&[0x34], "END"),
    (&[0x48, 0x07, 0x06], "CMP"),
    (&[0x48, 0x09, 0x08], "ZCP"),
    (&[0x48, 0x0D, 0x0A], "DECMP"),
    (&[0x49, 0x07, 0x28], "ADD"),
    (&[0x49, 0x07, 0x2A], "SUB"),
    (&[0x49, 0x07, 0x2C], "MUL"),
    (&[0x49, 0x07, 0x2E], "DIV"),
    (&[0x49, 0x0D, 0x29], "DADD"),
    (&[0x49, 0x0D, 0x2B], "DSUB"),
    (&[0x49, 0x0D, 0x2D], "DMUL"),
    (&[0x49, 0x0D, 0x2F], "DDIV"),
    (&[0x49, 0x0D, 0x30], "DEADD"),
    (&[0x49, 0x0D, 0x31], "DESUB"),
    (&[0x49, 0x0D, 0x32], "DEMUL"),
    (&[0x49, 0x0D, 0x33], "DEDIV"),
    (&[0x4A, 0x03, 0x00], "INC"),
    (&[0x4A, 0x03, 0x02], "DEC"),
    (&[0x4A, 0x05, 0x01], "DINC"),
    (&[0x4A, 0x05, 0x03], "DDEC"),
    (&[0x4B, 0x05, 0x00], "BCD"),
    (&[0x4B, 0x03, 0x0E], "NEG"),
    (&[0x4B, 0x05, 0x04], "INT"),
    (&[0x4C, 0x05, 0x00], "MOV"),
    (&[0x4C, 0x09, 0x01], "DMOV"),
    (&[0x4C, 0x07, 0x06], "BMOV"),
    (&[0x4C, 0x07, 0x07], "FMOV"),
    (&[0x4C, 0x03, 0x0B], "SWAP"),
    (&[0x4C, 0x05, 0x08], "XCH"),
    (&[0x4C, 0x09, 0x09], "DXCH"),
    (&[0x4C, 0x0B, 0x0C], "SMOV"),
    (&[0x4D, 0x03, 0x00], "CJ"),
    (&[0x4E, 0x0D, 0x04], "DHSCS"),
    (&[0x4F, 0x07, 0x01], "WAND"),
    (&[0x4F, 0x07, 0x03], "WOR"),
    (&[0x4F, 0x07, 0x05], "WXOR"),
    (&[0x50, 0x05, 0x00], "ROR"),
    (&[0x50, 0x05, 0x01], "ROL"),
    (&[0x50, 0x05, 0x02], "RCR"),
    (&[0x50, 0x05, 0x03], "RCL"),
    (&[0x53, 0x05, 0x19], "ZRST"),
    (&[0x53, 0x07, 0x20], "ANS"),
    (&[0x53, 0x05, 0x22], "FLT"),
    (&[0x53, 0x07, 0x04], "DECO"),
    (&[0x53, 0x07, 0x1E], "MEAN"),
    (&[0x54, 0x03, 0x01], "CALL"),
    (&[0x56, 0x09, 0x02], "FROM"),
    (&[0x56, 0x09, 0x0A], "TO"),
    (&[0x5A, 0x05, 0x08], "SQR"),
    (&[0x5A, 0x09, 0x16], "DESQR"),
    (&[0x5A, 0x09, 0x17], "DSIN"),
    (&[0x5A, 0x09, 0x18], "DCOS"),
    (&[0x5A, 0x09, 0x19], "DTAN"),
    (&[0x5B, 0x11, 0x01], "DLIMIT"),
    (&[0x5D, 0x09, 0x07], "TZCP"),
    (&[0x5E, 0x09, 0x07], "PID"),
    (&[0x5F, 0x07, 0x1B], "RD3A"),
    (&[0x5F, 0x07, 0x1C], "WR3A"),
    (&[0x5F, 0x09, 0x21], "IVRD"),
    (&[0x5F, 0x09, 0x22], "IVWR"),
    (&[0x63, 0x03, 0x0F], "ALT"),
    (&[0x63, 0x07, 0x07], "PLSY"),
    (&[0x63, 0x09, 0x09], "MTR"),
    (&[0x6A, 0x03, 0x00], "FOR"),
    (&[0x6A, 0x01, 0x01], "NEXT"),
    (&[0x6A, 0x01, 0x07], "SRET"),
    (&[0x6C, 0x01, 0x23], "STL"),
    (&[0x6C, 0x01, 0x24], "RET"),
];

/// The body of `END`, after which nothing follows but padding.
pub(super) const END: &[u8] = &[0x34];
/// First byte of a contact comparison: 40h, steps, comparison, position.
const COMPARE: u8 = 0x40;
/// Comparisons of 16 bits; those of 32 bits follow in the same order.
const COMPARISONS: [&str; 6] = ["=", "<>", ">", ">=", "<", "<="];
/// Where a comparison stands in the rung, from code 10h.
const POSITIONS: [&str; 3] = ["LD", "AND", "OR"];
/// The body of a label, whose pointer follows as an operand.
const LABEL: &[u8] = &[0x3C];

/// Codes of operands that name devices.
const DEVICES: [(u8, DeviceClass); 13] = [
    (0x90, DeviceClass::M),
    (0x98, DeviceClass::S),
    (0x9C, DeviceClass::X),
    (0x9D, DeviceClass::Y),
    (0xA8, DeviceClass::D),
    (0xAF, DeviceClass::R),
    (0xC2, DeviceClass::T),
    (0xC5, DeviceClass::C),
    (0xCC, DeviceClass::Z),
    (0xCD, DeviceClass::V),
    (0xD0, DeviceClass::P),
    (0xD1, DeviceClass::I),
    (0xD2, DeviceClass::N),
];

/// Names of CPU types, as the list export writes them.
const CPUS: [(u16, &str); 10] = [
    (0x0201, "FX0/FX0S"),
    (0x0202, "FX0N"),
    (0x0203, "FX1"),
    (0x0204, "FX2/FX2C"),
    (0x0205, "FX2N/FX2NC"),
    (0x0206, "FX1S"),
    (0x0207, "FX1N/FX1NC"),
    (0x0208, "FX3U/FX3UC"),
    (0x0209, "FX3G"),
    (0x020A, "FX3S"),
];

/// The name of the CPU type with this code.
pub(super) fn cpu(code: u16) -> Option<&'static str> {
    CPUS.iter().find(|row| row.0 == code).map(|row| row.1)
}

/// The device class with this code.
pub(super) fn class(code: u8) -> Option<DeviceClass> {
    DEVICES.iter().find(|row| row.0 == code).map(|row| row.1)
}

/// What a token is.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Token<'b> {
    /// An instruction of this name.
    Instruction(SmolStr),
    /// The beginning of a label.
    Label,
    /// An operand.
    Operand(OperandKind),
    /// An index register for the operand that follows.
    Index(u32),
    /// The digit count of the operand that follows.
    Digits(u8),
    /// The bit of the word that follows.
    Bit(u8),
    /// A line statement, in the local code page.
    Statement(&'b [u8]),
    /// A note, in the local code page.
    Note(&'b [u8]),
}

/// What the body of a token means; nothing if it is unknown.
pub(super) fn token(body: &[u8]) -> Option<Token<'_>> {
    match body {
        LABEL => Some(Token::Label),
        [0x80, text @ ..] => Some(Token::Statement(text.get(1..)?)),
        [0x82, text @ ..] => Some(Token::Note(text.get(1..)?)),
        [0xF0, n @ 0..=7] => Some(Token::Index((*n).into())),
        [0xF1, n @ 1..=8] => Some(Token::Digits(*n)),
        [0xF2, n @ 0..=15] => Some(Token::Bit(*n)),
        [code @ 0x90..=0xEF, payload @ ..] => operand(*code, payload).map(Token::Operand),
        _ => instruction(body).map(Token::Instruction),
    }
}

fn instruction(body: &[u8]) -> Option<SmolStr> {
    let named = |body: &[u8]| {
        INSTRUCTIONS
            .iter()
            .find(|row| row.0 == body)
            .map(|row| row.1)
    };
    if let Some(name) = named(body) {
        return Some(SmolStr::new_static(name));
    }
    match body {
        [COMPARE, 5 | 9, comparison, position] => {
            let position = POSITIONS.get(position.checked_sub(0x10)? as usize)?;
            let wide = if *comparison < 6 { "" } else { "D" };
            let comparison = COMPARISONS.get(if wide.is_empty() {
                *comparison
            } else {
                comparison - 6
            } as usize)?;
            Some(format_smolstr!("{position}{wide}{comparison}"))
        }
        [applied @ .., 0x02] if applied.len() == 3 => {
            named(applied).map(|name| format_smolstr!("{name}P"))
        }
        _ => None,
    }
}

/// An operand: its code, then a number, lowest byte first.
fn operand(code: u8, payload: &[u8]) -> Option<OperandKind> {
    let value = payload
        .iter()
        .rev()
        .fold(0_u64, |value, &byte| value << 8 | u64::from(byte));
    if !(1..=4).contains(&payload.len()) {
        return None;
    }
    let value = value as u32;
    match (code, payload.len()) {
        (0xE8, 1) => Some(OperandKind::Decimal(value.into(), None)),
        (0xE8, 2) => Some(OperandKind::Decimal((value as u16 as i16).into(), None)),
        (0xE9, _) => Some(OperandKind::Decimal((value as i32).into(), None)),
        (0xEA, ..=2) | (0xEB, _) => Some(OperandKind::Hex(value.into(), None)),
        (0xEC, 4) => Some(f32::from_bits(value))
            .filter(|v| v.is_finite())
            .map(OperandKind::Float),
        _ => {
            let device = Device {
                class: class(code)?,
                number: value,
            };
            Some(OperandKind::Device(device, None))
        }
    }
}

/// An operand with the prefixes that stood before it; nothing if they do not go together.
pub(super) fn with_prefixes(
    kind: OperandKind,
    digits: Option<u8>,
    bit: Option<u8>,
    index: Option<u32>,
) -> Option<OperandKind> {
    let index = index.map(|number| Index {
        class: DeviceClass::Z,
        number,
    });
    match (kind, digits, bit) {
        (OperandKind::Device(device, _), None, None) => Some(OperandKind::Device(device, index)),
        (OperandKind::Device(device, _), Some(digits), None) => {
            use DeviceClass::{M, S, X, Y};
            matches!(device.class, X | Y | M | S)
                .then_some(OperandKind::Nibbles(digits, device, index))
        }
        (OperandKind::Device(device, _), None, Some(bit)) => {
            Some(OperandKind::WordBit(device, bit, index))
        }
        (OperandKind::Decimal(value, _), None, None) => Some(OperandKind::Decimal(value, index)),
        (OperandKind::Hex(value, _), None, None) => Some(OperandKind::Hex(value, index)),
        (other @ OperandKind::Float(_), None, None) if index.is_none() => Some(other),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_code_has_one_meaning() {
        for (at, (body, name)) in INSTRUCTIONS.iter().enumerate() {
            assert!(
                INSTRUCTIONS[..at].iter().all(|(other, _)| other != body),
                "{name}"
            );
        }
    }

    #[test]
    fn comparisons_and_pulse_forms_are_derived() {
        let name = |body: &[u8]| instruction(body).map(|name| name.to_string());
        assert_eq!(name(&[0x40, 5, 3, 0x10]).as_deref(), Some("LD>="));
        assert_eq!(name(&[0x40, 9, 7, 0x11]).as_deref(), Some("ANDD<>"));
        assert_eq!(name(&[0x40, 9, 12, 0x11]), None);
        assert_eq!(name(&[0x4A, 3, 0, 2]).as_deref(), Some("INCP"));
        assert_eq!(name(&[0x4A, 3, 1]), None);
    }
}
