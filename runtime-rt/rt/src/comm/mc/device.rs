//! Devices of both frames, and what batch commands do to them.

use super::{Fields, Refusal};
use crate::comm::{Frame, Map};
use crate::plc::Class;
use crate::runs::FIRST_COUNTER32;

/// Devices of one kind, from a number on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Device {
    pub(super) class: Class,
    /// True if a point is a bit.
    pub(super) is_bit: bool,
    pub(super) first: u32,
}

/// Class, and whether a point is a bit; code in frame 1E, code in frame 3E.
type Code = (Class, bool, u16, u8);

/// Codes of devices. R has two in frame 3E: as a bank and as one file.
const CODES: &[Code] = &[
    (Class::X, true, 0x5820, 0x9c),
    (Class::Y, true, 0x5920, 0x9d),
    (Class::M, true, 0x4d20, 0x90),
    (Class::S, true, 0x5320, 0x98),
    (Class::T, true, 0x5453, 0xc1),
    (Class::C, true, 0x4353, 0xc4),
    (Class::T, false, 0x544e, 0xc2),
    (Class::C, false, 0x434e, 0xc5),
    (Class::D, false, 0x4420, 0xa8),
    (Class::R, false, 0x5220, 0xaf),
    (Class::R, false, 0x5220, 0xb0),
];

impl Device {
    fn find(first: u32, has: impl Fn(&Code) -> bool) -> Result<Device, Refusal> {
        // No PLC has as many; so sums of numbers and counts do not overflow.
        let is_near = first <= 0xff_ffff;
        let code = CODES.iter().find(|code| is_near && has(code));
        code.map_or(Err(Refusal::Device), |&(class, is_bit, ..)| {
            Ok(Device {
                class,
                is_bit,
                first,
            })
        })
    }

    /// A device of frame 1E: number in four bytes, code in two.
    pub(super) fn of_1e(fields: &mut Fields) -> Result<Device, Refusal> {
        let (first, code) = (fields.number(4)?, fields.number(2)?);
        Device::find(first, |row| u32::from(row.2) == code)
    }

    /// A device of frame 3E: number in three bytes, code in one.
    pub(super) fn of_3e(fields: &mut Fields) -> Result<Device, Refusal> {
        let (first, code) = (fields.number(3)?, fields.number(1)?);
        Device::find(first, |row| u32::from(row.3) == code)
    }

    /// Returns true if these are 32-bit counters as words.
    pub(super) fn is_counter32(self) -> bool {
        self.class == Class::C && !self.is_bit && self.first >= FIRST_COUNTER32
    }

    /// Returns true if `count` words from here on exist.
    fn has_words(self, count: u32, map: &dyn Map) -> bool {
        if self.is_bit {
            map.has_bits(self.class, self.first, 16 * count)
        } else {
            let ends_before_32_bits =
                self.class != Class::C || self.first + count <= FIRST_COUNTER32;
            ends_before_32_bits && map.has_words(self.class, self.first, count)
        }
    }

    /// Word `index` from here on.
    fn word(self, index: u32, map: &dyn Map) -> Result<u16, Refusal> {
        let word = if self.is_bit {
            (0..16).try_fold(0, |word, bit| {
                let on = map.bit(self.class, self.first + 16 * index + bit)?;
                Some(word | u16::from(on) << bit)
            })
        } else {
            map.word(self.class, self.first + index).map(|w| w as u16)
        };
        word.ok_or(Refusal::Device)
    }

    /// Writes word `index` from here on, which is there.
    fn set_word(self, index: u32, value: u16, map: &mut dyn Map) {
        if self.is_bit {
            for bit in 0..16 {
                let on = value >> bit & 1 != 0;
                let _ = map.set_bit(self.class, self.first + 16 * index + bit, on);
            }
        } else {
            let _ = map.set_word(self.class, self.first + index, value as i16);
        }
    }

    /// Two words from here on, or the value of a 32-bit counter.
    pub(super) fn double_word(self, map: &dyn Map) -> Result<u32, Refusal> {
        if self.is_counter32() {
            return map
                .counter32(self.first)
                .map(|value| value as u32)
                .ok_or(Refusal::Device);
        }
        Ok(u32::from(self.word(0, map)?) | u32::from(self.word(1, map)?) << 16)
    }

    /// Returns true if [`Device::double_word`] finds a value.
    pub(super) fn has_double_word(self, map: &dyn Map) -> bool {
        if self.is_counter32() {
            map.counter32(self.first).is_some()
        } else {
            self.has_words(2, map)
        }
    }

    /// Writes two words or a 32-bit counter that are there.
    pub(super) fn set_double_word(self, value: u32, map: &mut dyn Map) {
        if self.is_counter32() {
            let _ = map.set_counter32(self.first, value as i32);
        } else {
            self.set_word(0, value as u16, map);
            self.set_word(1, (value >> 16) as u16, map);
        }
    }

    /// Appends `count` words.
    pub(super) fn read_words(
        self,
        count: u32,
        map: &dyn Map,
        reply: &mut Frame,
    ) -> Result<(), Refusal> {
        if !self.has_words(count, map) {
            return Err(Refusal::Device);
        }
        for index in 0..count {
            reply.push_le16(self.word(index, map)?);
        }
        Ok(())
    }

    /// Writes `count` words, which are all that follows.
    pub(super) fn write_words(
        self,
        count: u32,
        mut data: Fields,
        map: &mut dyn Map,
    ) -> Result<(), Refusal> {
        if data.0.len() != 2 * count as usize {
            return Err(Refusal::Length);
        }
        if !self.has_words(count, map) {
            return Err(Refusal::Device);
        }
        for index in 0..count {
            self.set_word(index, data.number(2)? as u16, map);
        }
        Ok(())
    }

    /// Appends `count` bits, two to a byte, the first in the high half.
    pub(super) fn read_bits(
        self,
        count: u32,
        map: &dyn Map,
        reply: &mut Frame,
    ) -> Result<(), Refusal> {
        if !self.is_bit || !map.has_bits(self.class, self.first, count) {
            return Err(Refusal::Device);
        }
        let on = |index| {
            let is_asked = index < count;
            u8::from(is_asked && map.bit(self.class, self.first + index) == Some(true))
        };
        for index in (0..count).step_by(2) {
            reply.push(on(index) << 4 | on(index + 1));
        }
        Ok(())
    }

    /// Writes `count` bits, which are all that follows.
    pub(super) fn write_bits(
        self,
        count: u32,
        data: Fields,
        map: &mut dyn Map,
    ) -> Result<(), Refusal> {
        if data.0.len() != count.div_ceil(2) as usize {
            return Err(Refusal::Length);
        }
        if !self.is_bit || !map.has_bits(self.class, self.first, count) {
            return Err(Refusal::Device);
        }
        let halves = data.0.iter().flat_map(|byte| [byte >> 4, byte & 15]);
        for (number, half) in (self.first..self.first + count).zip(halves) {
            let _ = map.set_bit(self.class, number, half != 0);
        }
        Ok(())
    }

    /// Returns true if a single bit (`bit`) or word exists.
    pub(super) fn exists(self, bit: bool, map: &dyn Map) -> bool {
        if bit {
            self.is_bit && map.bit(self.class, self.first).is_some()
        } else {
            self.has_words(1, map)
        }
    }

    /// Writes a single bit (`bit`) or word that is there.
    pub(super) fn set(self, bit: bool, value: u32, map: &mut dyn Map) {
        if bit {
            let _ = map.set_bit(self.class, self.first, value != 0);
        } else {
            self.set_word(0, value as u16, map);
        }
    }
}
