//! Devices and operands of machine code, both ways.
//!
//! A bit device is a *point*: 12 bits, which a nibble above them widens. An operand of an applied instruction is a
//! pair of words, `1iii mmmm vvvvvvvv` and `1000 0000 + n wwwwwwww`: kind m, sub-kind n, index i and the value `v +
//! 256 w`. In a 32-bit instruction a second pair follows, with the upper half of a constant.

use rungc_syntax::{Device, DeviceClass, Index, OperandKind};

/// Consecutive devices whose codes follow each other.
struct Run {
    class: DeviceClass,
    /// First device number.
    first: u32,
    /// Number of devices.
    count: u32,
    /// Code of the first one.
    code: u16,
    /// Distance between codes.
    width: u16,
}

const fn run(class: DeviceClass, first: u32, count: u32, code: u16, width: u16) -> Run {
    Run {
        class,
        first,
        count,
        code,
        width,
    }
}

/// Points. T256 and up and M8256 and up are derived from tables of independent firmware.
const POINTS: [Run; 10] = {
    use DeviceClass::{C, M, S, T, X, Y};
    [
        run(S, 0, 1024, 0x000, 1),
        run(X, 0, 256, 0x400, 1),
        run(Y, 0, 256, 0x500, 1),
        run(T, 0, 256, 0x600, 1),
        run(T, 256, 256, 0x700, 1),
        run(M, 0, 1536, 0x800, 1),
        run(C, 0, 256, 0xE00, 1),
        run(M, 8000, 256, 0xF00, 1),
        run(M, 8256, 256, 0x1000, 1),
        run(M, 1536, 2048, 0x2800, 1),
    ]
};

/// Registers by their sub-kind: codes are byte offsets. V and Z lie among the special registers: see
/// [`INDEX_REGISTERS`].
const REGISTERS: [(u8, Run); 6] = {
    use DeviceClass::{C, D, T};
    [
        (0, run(D, 8000, 512, 0, 2)),
        (2, run(T, 0, 512, 0, 2)),
        (4, run(C, 0, 200, 0, 2)),
        (4, run(C, 200, 56, 0x200, 4)),
        (6, run(D, 0, 1000, 0, 2)),
        (8, run(D, 1000, 7000, 0, 2)),
    ]
};

/// The special registers that are Z and V: the first of a pair Z and V, and its number.
const INDEX_REGISTERS: [(u32, u32); 8] = [
    (8028, 0),
    (8182, 1),
    (8184, 2),
    (8186, 3),
    (8188, 4),
    (8190, 5),
    (8192, 6),
    (8194, 7),
];

impl Run {
    fn code_of(&self, device: Device) -> Option<u16> {
        let at = device.number.checked_sub(self.first)?;
        let fits = device.class == self.class && at < self.count;
        fits.then(|| self.code + at as u16 * self.width)
    }

    fn device_at(&self, code: u16) -> Option<Device> {
        let at = code.checked_sub(self.code)?;
        let (at, rest) = (u32::from(at / self.width), at % self.width);
        (rest == 0 && at < self.count).then_some(Device {
            class: self.class,
            number: self.first + at,
        })
    }
}

/// The point of a bit device, with the nibble that widens it.
pub(super) fn point(device: Device) -> Option<u16> {
    POINTS.iter().find_map(|run| run.code_of(device))
}

/// The bit device at a point.
pub(super) fn at_point(point: u16) -> Option<Device> {
    POINTS.iter().find_map(|run| run.device_at(point))
}

/// The special register that an index register is.
fn special_of(device: Device) -> Device {
    let pair = INDEX_REGISTERS.iter().find(|pair| pair.1 == device.number);
    let number = match (device.class, pair) {
        (DeviceClass::Z, Some((first, _))) => *first,
        (DeviceClass::V, Some((first, _))) => first + 1,
        _ => return device,
    };
    let class = DeviceClass::D;
    Device { class, number }
}

/// The index register that a special register is, or the register itself.
fn index_register(device: Device) -> Device {
    let found = INDEX_REGISTERS.iter().find_map(|&(first, number)| {
        match device.number.checked_sub(first) {
            Some(0) => Some((DeviceClass::Z, number)),
            Some(1) => Some((DeviceClass::V, number)),
            _ => None,
        }
    });
    match found {
        Some((class, number)) if device.class == DeviceClass::D => Device { class, number },
        _ => device,
    }
}

fn register_code(device: Device) -> Option<(u8, u16)> {
    let device = special_of(device);
    let mut runs = REGISTERS.iter();
    runs.find_map(|(sub, run)| Some((*sub, run.code_of(device)?)))
}

fn register_at(sub: u8, code: u16) -> Option<Device> {
    let mut runs = REGISTERS.iter().filter(|(of, _)| *of == sub);
    let device = runs.find_map(|(_, run)| run.device_at(code))?;
    Some(index_register(device))
}

/// Kinds of operands: the low nibble of the first word's upper byte.
mod kind {
    pub const DECIMAL: u8 = 0;
    pub const HEX: u8 = 2;
    pub const BITS: u8 = 4;
    pub const REGISTER: u8 = 6;
    pub const POINTER: u8 = 8;
}

/// The bits of the first word that name the only index register that images have shown, Z0.
const INDEX_Z0: u8 = 2;

/// One pair of words.
#[derive(Clone, Copy)]
struct Pair {
    kind: u8,
    sub: u8,
    index: u8,
    value: u16,
}

impl Pair {
    fn of([first, second]: [u16; 2]) -> Option<Self> {
        let ([v, head], [w, tail]) = (first.to_le_bytes(), second.to_le_bytes());
        let formed = head & 0x80 != 0 && tail & 0xE0 == 0x80;
        formed.then_some(Pair {
            kind: head & 0xF,
            sub: tail & 0x1F,
            index: head >> 4 & 7,
            value: u16::from_le_bytes([v, w]),
        })
    }

    fn words(self) -> [u16; 2] {
        let [v, w] = self.value.to_le_bytes();
        let head = 0x80 | self.index << 4 | self.kind;
        [[v, head], [w, 0x80 | self.sub]].map(u16::from_le_bytes)
    }

    /// The pair of a constant's half.
    fn half(kind: u8, value: u16) -> Self {
        Pair {
            kind,
            sub: 0,
            index: 0,
            value,
        }
    }
}

/// Operand of these words: two, in a 32-bit instruction four.
pub(super) fn operand(words: &[u16]) -> Option<OperandKind> {
    let (low, high) = match *words {
        [a, b] => (Pair::of([a, b])?, None),
        [a, b, c, d] => (Pair::of([a, b])?, Some(Pair::of([c, d])?)),
        _ => return None,
    };
    let index = match low.index {
        0 => None,
        INDEX_Z0 => Some(Index {
            class: DeviceClass::Z,
            number: 0,
        }),
        _ => return None,
    };
    let constant = matches!(low.kind, kind::DECIMAL | kind::HEX);
    let upper = match high {
        Some(high) => {
            let plain = high.sub == 0 && high.index == 0;
            let fits = if constant {
                high.kind == kind::DECIMAL || high.kind == low.kind
            } else {
                high.kind == kind::DECIMAL && high.value == 0
            };
            (plain && fits).then_some(Some(high.value))?
        }
        None => None,
    };
    let value = upper.map(|upper| u32::from(upper) << 16 | u32::from(low.value));
    Some(match (low.kind, low.sub) {
        (kind::DECIMAL, 0) => {
            let narrow = || i64::from(low.value as i16);
            OperandKind::Decimal(value.map_or_else(narrow, |v| i64::from(v as i32)), index)
        }
        (kind::HEX, 0) => OperandKind::Hex(value.unwrap_or(low.value.into()).into(), index),
        (kind::BITS, 0) => OperandKind::Device(at_point(low.value)?, index),
        (kind::BITS, sub @ 2..=16) if sub % 2 == 0 => {
            OperandKind::Nibbles(sub / 2, at_point(low.value)?, index)
        }
        (kind::REGISTER, sub) => OperandKind::Device(register_at(sub, low.value)?, index),
        (kind::POINTER, 0) if low.value % 2 == 0 && low.value < 512 => {
            let device = Device {
                class: DeviceClass::P,
                number: u32::from(low.value / 2),
            };
            OperandKind::Device(device, index)
        }
        _ => return None,
    })
}

/// An operand's words: two, in a 32-bit instruction (`wide`) four; nothing if its machine code is not known.
pub(super) fn operand_words(operand: &OperandKind, wide: bool) -> Option<Vec<u16>> {
    let device_pair = |kind, sub, value| Pair {
        sub,
        ..Pair::half(kind, value)
    };
    let (mut low, upper, index) = match *operand {
        OperandKind::Decimal(value, index) => {
            let bits = if wide {
                i32::try_from(value).ok()? as u32
            } else {
                u32::from(i16::try_from(value).ok()? as u16)
            };
            constant(kind::DECIMAL, bits, index)
        }
        OperandKind::Hex(value, index) => {
            let most = if wide { u32::MAX } else { u16::MAX.into() };
            let bits = u32::try_from(value).ok().filter(|bits| *bits <= most)?;
            constant(kind::HEX, bits, index)
        }
        OperandKind::Nibbles(digits @ 1..=8, device, index) => {
            let pair = device_pair(kind::BITS, 2 * digits, point(device)?);
            (pair, Pair::half(kind::DECIMAL, 0), index)
        }
        OperandKind::Device(device, index) => {
            use DeviceClass::{M, P, S, X, Y};
            let pair = match device.class {
                X | Y | M | S => device_pair(kind::BITS, 0, point(device)?),
                P => {
                    let number = u16::try_from(device.number).ok().filter(|n| *n < 256)?;
                    device_pair(kind::POINTER, 0, 2 * number)
                }
                _ => {
                    let (sub, value) = register_code(device)?;
                    device_pair(kind::REGISTER, sub, value)
                }
            };
            (pair, Pair::half(kind::DECIMAL, 0), index)
        }
        _ => return None,
    };
    low.index = match index {
        None => 0,
        Some(Index {
            class: DeviceClass::Z,
            number: 0,
        }) => INDEX_Z0,
        Some(_) => return None,
    };
    let mut words = low.words().to_vec();
    if wide {
        words.extend(upper.words());
    }
    Some(words)
}

/// Both halves of a constant.
fn constant(kind: u8, bits: u32, index: Option<Index>) -> (Pair, Pair, Option<Index>) {
    let upper = Pair::half(kind, (bits >> 16) as u16);
    (Pair::half(kind, bits as u16), upper, index)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Words of published images and quotations with what they mean.
    const SHOWN: [(&[u16], &str); 14] = [
        (&[0x8400, 0x8008], "M0"),
        (&[0x84FF, 0x802D], "M3071"),
        (&[0x8405, 0x8005], "Y005"),
        (&[0x86AE, 0x8836], "D7999"),
        (&[0x86FE, 0x8201], "T255"),
        (&[0x86DC, 0x8402], "C255"),
        (&[0x868E, 0x8401], "C199"),
        (&[0x8638, 0x8000], "Z0"),
        (&[0x800F, 0x8000], "K15"),
        (&[0x80FF, 0x80FF], "K-1"),
        (&[0x8842, 0x8000], "P33"),
        (&[0x8401, 0x8804], "K4X001"),
        (&[0x80E7, 0x8003, 0x8000, 0x8000], "K999"),
        (&[0x86D0, 0x8807, 0x8000, 0x8000], "D2000"),
    ];

    #[test]
    fn operands_of_images_are_read_and_written() {
        for (words, text) in SHOWN {
            let read = operand(words).unwrap();
            assert_eq!(read.to_string(), text);
            let written = operand_words(&read, words.len() == 4);
            assert_eq!(written.as_deref(), Some(words), "{text}");
        }
    }

    #[test]
    fn no_two_devices_share_a_code() {
        let points: Vec<_> = (0..=u16::MAX).filter_map(at_point).collect();
        for device in points {
            assert_eq!(point(device).and_then(at_point), Some(device));
        }
        for sub in 0..32 {
            for device in (0..=u16::MAX).filter_map(|code| register_at(sub, code)) {
                let (sub, code) = register_code(device).unwrap();
                assert_eq!(register_at(sub, code), Some(device));
            }
        }
    }

    #[test]
    fn what_no_image_has_shown_is_not_guessed() {
        let indexed = |number| Index {
            class: DeviceClass::V,
            number,
        };
        let d0 = Device {
            class: DeviceClass::D,
            number: 0,
        };
        assert_eq!(
            operand_words(&OperandKind::Device(d0, Some(indexed(0))), false),
            None
        );
        assert_eq!(operand_words(&OperandKind::Float(1.5), true), None);
        assert_eq!(
            operand_words(&OperandKind::Decimal(40_000, None), false),
            None
        );
        assert_eq!(operand(&[0xC400, 0x8008]), None);
        assert_eq!(operand(&[0x8400, 0x0008]), None);
        assert_eq!(operand(&[0x8601, 0x8600]), None, "an odd offset");
    }
}
