//! Names of devices in five characters.

use crate::comm::Map;
use crate::plc::Class;
use crate::runs::FIRST_COUNTER32;

/// Characters of a name.
pub(super) const NAME: usize = 5;

/// First of HM's registers that computer link does not reach.
const HM_REGISTERS: u32 = 8000;

/// The first device of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Device {
    /// Bit devices; as words, 16 of them are one.
    Bits(Class, u32),
    /// 16-bit words.
    Words(Class, u32),
    /// Values of 32-bit counters.
    Counters32(u32),
}

impl Device {
    /// Reads a name: `X0040` and `Y0001` in octal digits, `M0903`, `S0100`, `D0500`, `R0500`, current values `TN000`
    /// and `CN100`, contacts `TS000`, `CS000`, `T0000`, `C0000`.
    pub(super) fn parse(name: &[u8]) -> Option<Device> {
        let &[letter, second, ref short @ ..] = name else {
            return None;
        };
        let long = name.get(1..)?;
        Some(match (letter, second) {
            (b'T', b'N') => Device::Words(Class::T, number(short, 10)?),
            (b'C', b'N') => match number(short, 10)? {
                counter if counter < FIRST_COUNTER32 => Device::Words(Class::C, counter),
                counter => Device::Counters32(counter),
            },
            (b'T', b'S') => Device::Bits(Class::T, number(short, 10)?),
            (b'C', b'S') => Device::Bits(Class::C, number(short, 10)?),
            (b'X', _) => Device::Bits(Class::X, number(long, 8)?),
            (b'Y', _) => Device::Bits(Class::Y, number(long, 8)?),
            (b'M', _) => Device::Bits(Class::M, number(long, 10)?),
            (b'S', _) => Device::Bits(Class::S, number(long, 10)?),
            (b'T', _) => Device::Bits(Class::T, number(long, 10)?),
            (b'C', _) => Device::Bits(Class::C, number(long, 10)?),
            (b'D', _) => Device::Words(Class::D, number(long, 10)?),
            (b'R', _) => Device::Words(Class::R, number(long, 10)?),
            _ => return None,
        })
    }

    /// Digits of a value.
    pub(super) fn digits(self) -> usize {
        match self {
            Device::Counters32(_) => 8,
            Device::Bits(..) | Device::Words(..) => 4,
        }
    }

    /// Returns true if these are registers that HM serves.
    pub(super) fn is_general_register(self, count: u32) -> bool {
        matches!(self, Device::Words(Class::D, first) if first + count <= HM_REGISTERS)
    }

    /// Returns true if `count` words from here on all exist.
    pub(super) fn has_words(self, count: u32, map: &dyn Map) -> bool {
        match self {
            Device::Bits(class, first) => map.has_bits(class, first, 16 * count),
            // A run of counters may not go from 16 to 32 bits.
            Device::Words(class, first) => {
                map.has_words(class, first, count)
                    && (class != Class::C || first + count <= FIRST_COUNTER32)
            }
            Device::Counters32(first) => (first..first + count).all(|n| map.counter32(n).is_some()),
        }
    }

    /// Word `index` from here on.
    pub(super) fn word(self, index: u32, map: &dyn Map) -> Option<u32> {
        match self {
            Device::Bits(class, first) => (0..16).try_fold(0, |word, bit| {
                let on = map.bit(class, first + 16 * index + bit)?;
                Some(word | u32::from(on) << bit)
            }),
            Device::Words(class, first) => {
                map.word(class, first + index).map(|w| u32::from(w as u16))
            }
            Device::Counters32(first) => map.counter32(first + index).map(|value| value as u32),
        }
    }

    /// Writes word `index` from here on, which is there.
    pub(super) fn set_word(self, index: u32, value: u32, map: &mut dyn Map) {
        match self {
            Device::Bits(class, first) => {
                for bit in 0..16 {
                    let on = value >> bit & 1 != 0;
                    let _ = map.set_bit(class, first + 16 * index + bit, on);
                }
            }
            Device::Words(class, first) => {
                let _ = map.set_word(class, first + index, value as u16 as i16);
            }
            Device::Counters32(first) => {
                let _ = map.set_counter32(first + index, value as i32);
            }
        }
    }
}

/// A number in digits of this base.
fn number(digits: &[u8], base: u32) -> Option<u32> {
    digits.iter().try_fold(0, |number, &digit| {
        let digit = char::from(digit).to_digit(base)?;
        Some(number * base + digit)
    })
}
