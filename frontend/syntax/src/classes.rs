//! Sets of the classes that an operand may have.

use crate::{DeviceClass, OperandKind};

/// Set of operand classes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Classes(pub u32);

#[allow(missing_docs, reason = "each constant is the class of the same name")]
impl Classes {
    pub const NONE: Classes = Classes(0);
    pub const X: Classes = Classes(1);
    pub const Y: Classes = Classes(1 << 1);
    pub const M: Classes = Classes(1 << 2);
    pub const S: Classes = Classes(1 << 3);
    /// Timer: contact or current value as the instruction's parameter says.
    pub const T: Classes = Classes(1 << 4);
    /// Counter: contact or current value as the instruction's parameter says.
    pub const C: Classes = Classes(1 << 5);
    pub const D: Classes = Classes(1 << 6);
    pub const R: Classes = Classes(1 << 7);
    pub const ER: Classes = Classes(1 << 8);
    pub const V: Classes = Classes(1 << 9);
    pub const Z: Classes = Classes(1 << 10);
    pub const KNX: Classes = Classes(1 << 11);
    pub const KNY: Classes = Classes(1 << 12);
    pub const KNM: Classes = Classes(1 << 13);
    pub const KNS: Classes = Classes(1 << 14);
    /// Decimal constant.
    pub const K: Classes = Classes(1 << 15);
    /// Hexadecimal constant.
    pub const H: Classes = Classes(1 << 16);
    /// Floating constant.
    pub const E: Classes = Classes(1 << 17);
    /// Characters.
    pub const TEXT: Classes = Classes(1 << 18);
    /// Bit of a word, `D0.F`.
    pub const WORD_BIT: Classes = Classes(1 << 19);
    /// Buffer memory, `U0\G5`.
    pub const BUFFER: Classes = Classes(1 << 20);
    pub const P: Classes = Classes(1 << 21);
    pub const I: Classes = Classes(1 << 22);
    pub const N: Classes = Classes(1 << 23);

    /// Both sets.
    #[must_use]
    pub const fn or(self, other: Classes) -> Classes {
        Classes(self.0 | other.0)
    }

    /// This set without the other.
    #[must_use]
    pub const fn without(self, other: Classes) -> Classes {
        Classes(self.0 & !other.0)
    }

    /// The class of an operand as it is written; `NONE` for a group of something that has no bits to group.
    pub fn of(operand: &OperandKind) -> Classes {
        match operand {
            OperandKind::Device(device, _) => Classes::of_device(device.class),
            OperandKind::WordBit(..) => Classes::WORD_BIT,
            OperandKind::Nibbles(_, device, _) => match device.class {
                DeviceClass::X => Classes::KNX,
                DeviceClass::Y => Classes::KNY,
                DeviceClass::M => Classes::KNM,
                DeviceClass::S => Classes::KNS,
                _ => Classes::NONE,
            },
            OperandKind::Decimal(..) => Classes::K,
            OperandKind::Hex(..) => Classes::H,
            OperandKind::Float(_) => Classes::E,
            OperandKind::Text(_) => Classes::TEXT,
            OperandKind::Buffer { .. } => Classes::BUFFER,
            OperandKind::Unreadable(_) => Classes::NONE,
        }
    }

    /// The set with this one class of devices.
    pub const fn of_device(class: DeviceClass) -> Classes {
        match class {
            DeviceClass::X => Classes::X,
            DeviceClass::Y => Classes::Y,
            DeviceClass::M => Classes::M,
            DeviceClass::S => Classes::S,
            DeviceClass::T => Classes::T,
            DeviceClass::C => Classes::C,
            DeviceClass::D => Classes::D,
            DeviceClass::R => Classes::R,
            DeviceClass::ER => Classes::ER,
            DeviceClass::V => Classes::V,
            DeviceClass::Z => Classes::Z,
            DeviceClass::P => Classes::P,
            DeviceClass::I => Classes::I,
            DeviceClass::N => Classes::N,
        }
    }

    /// Its classes as a manual lists them: `K, H, KnX, …`.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        const NAMES: [(Classes, &str); 24] = [
            (Classes::K, "K"),
            (Classes::H, "H"),
            (Classes::E, "E"),
            (Classes::TEXT, "text"),
            (Classes::KNX, "KnX"),
            (Classes::KNY, "KnY"),
            (Classes::KNM, "KnM"),
            (Classes::KNS, "KnS"),
            (Classes::X, "X"),
            (Classes::Y, "Y"),
            (Classes::M, "M"),
            (Classes::S, "S"),
            (Classes::T, "T"),
            (Classes::C, "C"),
            (Classes::D, "D"),
            (Classes::R, "R"),
            (Classes::ER, "ER"),
            (Classes::V, "V"),
            (Classes::Z, "Z"),
            (Classes::WORD_BIT, "D.b"),
            (Classes::BUFFER, "U\\G"),
            (Classes::P, "P"),
            (Classes::I, "I"),
            (Classes::N, "N"),
        ];
        NAMES
            .into_iter()
            .filter(move |(class, _)| self.meets(*class))
            .map(|(_, name)| name)
    }

    /// Returns true if it contains no class.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns true if the sets share a class.
    pub const fn meets(self, other: Classes) -> bool {
        self.0 & other.0 != 0
    }
}
