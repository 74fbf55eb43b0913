//! Operands of a call.

use crate::plc::Class;

/// Interpretation of an [`Operand`]. The numbers are part of the C ABI.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum OperandKind {
    /// Integer constant `value`.
    Const = 0,
    /// Float constant, its bits in `value`.
    Float = 1,
    /// Device number `value` of `class`, as a bit or a word as the instruction asks.
    Device = 2,
    /// Group of `4 * digits` bits from bit device `value` of `class`.
    Nibbles = 3,
    /// Bit `digits` of word device `value` of `class`.
    WordBit = 4,
    /// Text number `value` of the program.
    Text = 5,
    /// Word `value` of the buffer memory of module `digits`.
    Buffer = 6,
}

/// An operand, its index register already added.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct Operand {
    /// Interpretation of `value`.
    pub kind: OperandKind,
    /// Device class, where it is a device.
    pub class: Class,
    /// Digits of a group, the bit of a word, or the number of a module.
    pub digits: u8,
    /// Hint for the area that stores the device in emitted C, counted from the last, which is 1. It is looked at first;
    /// 0, or an area that does not hold the device: it is searched by its number.
    pub area: u8,
    /// Device number, address, constant, or bits of a float.
    pub value: i32,
}

impl Operand {
    /// A constant.
    pub const fn constant(value: i32) -> Self {
        Operand {
            kind: OperandKind::Const,
            class: Class::D,
            digits: 0,
            area: 0,
            value,
        }
    }

    /// A float constant.
    pub const fn float(value: f32) -> Self {
        Operand {
            kind: OperandKind::Float,
            class: Class::D,
            digits: 0,
            area: 0,
            value: value.to_bits() as i32,
        }
    }

    /// A device.
    pub const fn device(class: Class, number: i32) -> Self {
        Operand {
            kind: OperandKind::Device,
            class,
            digits: 0,
            area: 0,
            value: number,
        }
    }

    /// The same operand, whose device is stored in this area.
    #[must_use]
    pub const fn within(mut self, area: u8) -> Self {
        self.area = area;
        self
    }

    /// A group of `4 * digits` bits.
    pub const fn nibbles(digits: u8, class: Class, number: i32) -> Self {
        Operand {
            kind: OperandKind::Nibbles,
            class,
            digits,
            area: 0,
            value: number,
        }
    }

    /// A bit of a word.
    pub const fn word_bit(class: Class, number: i32, bit: u8) -> Self {
        Operand {
            kind: OperandKind::WordBit,
            class,
            digits: bit,
            area: 0,
            value: number,
        }
    }

    /// A word of the buffer memory of a module.
    pub const fn buffer(module: u8, address: i32) -> Self {
        Operand {
            kind: OperandKind::Buffer,
            class: Class::D,
            digits: module,
            area: 0,
            value: address,
        }
    }

    /// A text of the program.
    pub const fn text(index: i32) -> Self {
        Operand {
            kind: OperandKind::Text,
            class: Class::D,
            digits: 0,
            area: 0,
            value: index,
        }
    }
}

/// Decimal constant.
pub const fn k(value: i32) -> Operand {
    Operand::constant(value)
}

/// Hexadecimal constant.
pub const fn h(value: u32) -> Operand {
    Operand::constant(value as i32)
}

/// Device.
pub const fn d(class: Class, number: i32) -> Operand {
    Operand::device(class, number)
}

/// Group of bits.
pub const fn kn(digits: u8, class: Class, number: i32) -> Operand {
    Operand::nibbles(digits, class, number)
}
