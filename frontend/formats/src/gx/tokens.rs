//! The tokens of GX Developer and GX Works2.
//!
//! A token is `[len, body…, len]`, where `len` counts both length bytes. The first byte of the body gives its kind:
//! below 80h an instruction, 80h and 81h a statement, 82h a note, from 90h an operand, from F0h a prefix of the operand
//! that follows.

use super::table::{self, Code};
use rungc_syntax::{Device, DeviceClass, Index, OperandKind};

/// The body of `END`, after which nothing follows but padding.
pub(super) const END: &[u8] = &[0x34];
/// The first byte of a label's body, whose pointer follows as an operand.
const LABEL: u8 = 0x3C;

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

/// The device class with this code in a table of comments, where special relays and registers have separate codes.
pub(super) fn commented(code: u8) -> Option<DeviceClass> {
    match code {
        0x91 => Some(DeviceClass::M),
        0xA9 => Some(DeviceClass::D),
        _ => class(code),
    }
}

/// The device class with this code.
fn class(code: u8) -> Option<DeviceClass> {
    DEVICES.iter().find(|row| row.0 == code).map(|row| row.1)
}

/// Decoded token.
#[derive(Debug)]
pub(super) enum Token<'b> {
    /// An instruction.
    Instruction(&'static Code),
    /// The beginning of a label.
    Label,
    /// An operand, to be joined with the prefixes before it.
    Operand(Bare<'b>),
    /// Something about the operand that follows.
    Prefix(Prefix),
    /// A statement, in the project's code page.
    Statement(&'b [u8]),
    /// A note, in the project's code page.
    Note(&'b [u8]),
}

/// An operand without its prefixes.
#[derive(Debug)]
pub(super) enum Bare<'b> {
    /// A device or a number.
    Kind(OperandKind),
    /// A text, in the project's code page.
    Text(&'b [u8]),
    /// The name of a label, in the project's code page: a source that is not compiled yet.
    Name(&'b [u8]),
    /// An address in the buffer memory of the module that a prefix names.
    Address(u32),
}

/// A prefix that changes an operand.
#[derive(Clone, Copy, Debug)]
pub(super) enum Prefix {
    /// The module that the address is in.
    Module(u32),
    /// Number of groups of four bits.
    Digits(u8),
    /// An index register.
    Index(Index),
    /// A bit of the word.
    Bit(u8),
}

/// Decodes the body of a token; `None` if it is unknown.
pub(super) fn token(body: &[u8]) -> Option<Token<'_>> {
    let index = |class, number: u8| {
        Token::Prefix(Prefix::Index(Index {
            class,
            number: number.into(),
        }))
    };
    match *body {
        // The byte before the text is its number of steps: none in FX projects.
        [0x80 | 0x81, ref text @ ..] => Some(Token::Statement(text.get(1..)?)),
        [0x82, ref text @ ..] => Some(Token::Note(text.get(1..)?)),
        [0xF0, number] => Some(index(DeviceClass::Z, number)),
        [0xF4, number] => Some(index(DeviceClass::V, number)),
        [0xF1, digits @ 1..=8] => Some(Token::Prefix(Prefix::Digits(digits))),
        [0xF2, bit @ 0..=15] => Some(Token::Prefix(Prefix::Bit(bit))),
        [0xF8, module] => Some(Token::Prefix(Prefix::Module(module.into()))),
        [0xEE, ref text @ ..] => Some(Token::Operand(Bare::Text(text))),
        [0xDF, ref name @ ..] => Some(Token::Operand(Bare::Name(name))),
        [code @ 0x90..=0xEF, ref payload @ ..] => operand(code, payload).map(Token::Operand),
        [LABEL, ..] => table::find(body).map(|_| Token::Label),
        _ => table::find(body).map(Token::Instruction),
    }
}

/// Returns true if the token is an instruction's or a label's, known or not.
pub(super) fn is_instruction(body: &[u8]) -> bool {
    body.first().is_none_or(|&first| first < 0x80)
}

/// Number of steps of the instruction with this token: its second byte, one if there is none.
pub(crate) fn steps(body: &[u8]) -> u32 {
    body.get(1).map_or(1, |&steps| steps.into())
}

/// An operand: its code, then a number, lowest byte first.
fn operand(code: u8, payload: &[u8]) -> Option<Bare<'_>> {
    let value = payload
        .iter()
        .rev()
        .fold(0_u64, |value, &byte| value << 8 | u64::from(byte));
    if !(1..=4).contains(&payload.len()) {
        return None;
    }
    let value = value as u32;
    let kind = match (code, payload.len()) {
        (0xE8, 1) => OperandKind::Decimal(value.into(), None),
        (0xE8, 2) => OperandKind::Decimal((value as u16 as i16).into(), None),
        (0xE9, _) => OperandKind::Decimal((value as i32).into(), None),
        (0xEA, ..=2) | (0xEB, _) => OperandKind::Hex(value.into(), None),
        (0xEC | 0xED, 4) => OperandKind::float(f32::from_bits(value))?,
        (0xAB, _) => return Some(Bare::Address(value)),
        _ => {
            let device = Device {
                class: class(code)?,
                number: value,
            };
            OperandKind::Device(device, None)
        }
    };
    Some(Bare::Kind(kind))
}

/// The prefixes that wait for their operand.
#[derive(Default, Debug)]
pub(super) struct Prefixes {
    module: Option<u32>,
    digits: Option<u8>,
    index: Option<Index>,
    bit: Option<u8>,
    /// True if there are two of one kind, which are invalid together with any operand.
    twice: bool,
}

impl Prefixes {
    /// Adds one.
    pub fn add(&mut self, prefix: Prefix) {
        self.twice |= match prefix {
            Prefix::Module(module) => self.module.replace(module).is_some(),
            Prefix::Digits(digits) => self.digits.replace(digits).is_some(),
            Prefix::Index(index) => self.index.replace(index).is_some(),
            Prefix::Bit(bit) => self.bit.replace(bit).is_some(),
        };
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        matches!(
            self,
            Prefixes {
                module: None,
                digits: None,
                index: None,
                bit: None,
                twice: false,
            }
        )
    }

    /// A device or number with them; nothing if they do not go together.
    pub fn join(self, kind: OperandKind) -> Option<OperandKind> {
        use DeviceClass::{M, S, X, Y};
        let index = self.index;
        if self.module.is_some() || self.twice {
            return None;
        }
        match (kind, self.digits, self.bit) {
            (OperandKind::Device(device, _), None, None) => {
                Some(OperandKind::Device(device, index))
            }
            (OperandKind::Device(device, _), Some(digits), None) => {
                matches!(device.class, X | Y | M | S)
                    .then_some(OperandKind::Nibbles(digits, device, index))
            }
            (OperandKind::Device(device, _), None, Some(bit)) => {
                Some(OperandKind::WordBit(device, bit, index))
            }
            (OperandKind::Decimal(value, _), None, None) => {
                Some(OperandKind::Decimal(value, index))
            }
            (OperandKind::Hex(value, _), None, None) => Some(OperandKind::Hex(value, index)),
            (other @ OperandKind::Float(_), None, None) if index.is_none() => Some(other),
            _ => None,
        }
    }

    /// The name of a label with them, as the editor writes it: `K4Lamps`, `TableZ0`, `Flags.3`.
    pub fn around(self, name: &str) -> String {
        let digits = self.digits.map(|digits| format!("K{digits}"));
        let bit = self.bit.map(|bit| format!(".{bit:X}"));
        let index = self.index.map(|index| index.to_string());
        let [digits, bit, index] = [digits, bit, index].map(Option::unwrap_or_default);
        format!("{digits}{name}{bit}{index}")
    }

    /// An address with them; nothing if no module is named, or they do not go together.
    pub fn buffer(self, address: u32) -> Option<OperandKind> {
        let (None, None, false) = (self.digits, self.bit, self.twice) else {
            return None;
        };
        Some(OperandKind::Buffer {
            module: self.module?,
            address,
            index: self.index,
        })
    }
}
