//! Device classes of the FX family.

use std::fmt;

/// The letter in front of a device number.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
#[repr(u8)]
pub enum DeviceClass {
    /// Input relay, numbered in octal.
    X,
    /// Output relay, numbered in octal.
    Y,
    /// Auxiliary relay; from 8000 special relays.
    M,
    /// Step (state) relay.
    S,
    /// Timer: its contact where a bit is expected, its current value where a word is.
    T,
    /// Counter: its contact where a bit is expected, its current value where a word is (32 bits from C200).
    C,
    /// Data register; from 8000 special registers.
    D,
    /// Extension (file) register.
    R,
    /// Extension file register, stored in a memory cassette (FX3U).
    ER,
    /// Index register, upper half of a 32-bit pair on FX.
    V,
    /// Index register, lower half of a 32-bit pair on FX.
    Z,
    /// Pointer: a label that CJ or CALL goes to.
    P,
    /// Interrupt pointer.
    I,
    /// Nesting level of MC.
    N,
}

impl DeviceClass {
    /// All classes, in the order of the enum.
    pub const ALL: [DeviceClass; 14] = {
        use DeviceClass::*;
        [X, Y, M, S, T, C, D, R, ER, V, Z, P, I, N]
    };

    /// The letters.
    pub const fn prefix(self) -> &'static str {
        match self {
            DeviceClass::X => "X",
            DeviceClass::Y => "Y",
            DeviceClass::M => "M",
            DeviceClass::S => "S",
            DeviceClass::T => "T",
            DeviceClass::C => "C",
            DeviceClass::D => "D",
            DeviceClass::R => "R",
            DeviceClass::ER => "ER",
            DeviceClass::V => "V",
            DeviceClass::Z => "Z",
            DeviceClass::P => "P",
            DeviceClass::I => "I",
            DeviceClass::N => "N",
        }
    }

    /// The class with these letters, in upper case.
    pub fn from_prefix(prefix: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|class| class.prefix() == prefix)
    }

    /// Returns true if its numbers are written in octal.
    pub const fn is_octal(self) -> bool {
        matches!(self, DeviceClass::X | DeviceClass::Y)
    }

    /// Notation of a device of this class: octal and padded to three digits for X and Y, decimal otherwise.
    pub const fn number(self, number: u32) -> Number {
        Number {
            class: self,
            number,
        }
    }
}

/// Displays a device with its class letter, e.g. `X012`, `D8013`, `I001`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Number {
    class: DeviceClass,
    number: u32,
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (prefix, number) = (self.class.prefix(), self.number);
        match self.class {
            DeviceClass::X | DeviceClass::Y => write!(f, "{prefix}{number:03o}"),
            DeviceClass::I => write!(f, "{prefix}{number:03}"),
            _ => write!(f, "{prefix}{number}"),
        }
    }
}
