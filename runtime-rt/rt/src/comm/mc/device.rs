//! Devices of both frames, and what batch commands do to them.

use super::{Code, Fields, Refusal, Reply, digits};
use crate::comm::Map;
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

/// A row of the table of devices.
struct Row {
    class: Class,
    /// True if a point is a bit.
    is_bit: bool,
    /// Code in frame 1E.
    code_1e: u16,
    /// Code in frame 3E.
    code_3e: u8,
    /// Name in frame 3E in ASCII, where a space may stand for the asterisk.
    name: [u8; 2],
}

const fn row(class: Class, is_bit: bool, code_1e: u16, code_3e: u8, name: [u8; 2]) -> Row {
    Row {
        class,
        is_bit,
        code_1e,
        code_3e,
        name,
    }
}

/// Codes of devices. R has two in frame 3E: as a bank and as one file.
const ROWS: &[Row] = &[
    row(Class::X, true, 0x5820, 0x9c, *b"X*"),
    row(Class::Y, true, 0x5920, 0x9d, *b"Y*"),
    row(Class::M, true, 0x4d20, 0x90, *b"M*"),
    row(Class::S, true, 0x5320, 0x98, *b"S*"),
    row(Class::T, true, 0x5453, 0xc1, *b"TS"),
    row(Class::C, true, 0x4353, 0xc4, *b"CS"),
    row(Class::T, false, 0x544e, 0xc2, *b"TN"),
    row(Class::C, false, 0x434e, 0xc5, *b"CN"),
    row(Class::D, false, 0x4420, 0xa8, *b"D*"),
    row(Class::R, false, 0x5220, 0xaf, *b"R*"),
    row(Class::R, false, 0x5220, 0xb0, *b"ZR"),
];

/// Codes of devices in requests: in frame 1E and in frame 3E. `is_bit` chooses between contacts and current values of
/// timers and counters. `None` if the protocol does not have them.
pub fn codes(class: Class, is_bit: bool) -> Option<(u16, u8)> {
    let mut rows = ROWS.iter();
    let row = rows.find(|row| row.class == class && row.is_bit == is_bit)?;
    Some((row.code_1e, row.code_3e))
}

impl Row {
    /// Device of the row. No PLC has as many devices as numbers may say, so sums of numbers and counts do not overflow.
    fn device(&self, first: u32) -> Result<Device, Refusal> {
        if first > 0xff_ffff {
            return Err(Refusal::Head);
        }
        Ok(Device {
            class: self.class,
            is_bit: self.is_bit,
            first,
        })
    }

    /// Base of numbers in ASCII: hexadecimal for terminals, else decimal.
    fn base(&self) -> u32 {
        match self.class {
            Class::X | Class::Y => 16,
            _ => 10,
        }
    }

    fn find(is: impl Fn(&Row) -> bool) -> Result<&'static Row, Refusal> {
        ROWS.iter().find(|row| is(row)).ok_or(Refusal::Device)
    }
}

impl Device {
    /// Number and code of a device of frame 1E: four bytes and two; in ASCII the code comes first.
    pub(super) fn number_of_1e(fields: &mut Fields) -> Result<(u32, u32), Refusal> {
        match fields.code {
            Code::Binary => Ok((fields.number(4)?, fields.number(2)?)),
            Code::Ascii => {
                let code = fields.number(2)?;
                Ok((fields.number(4)?, code))
            }
        }
    }

    /// A device of frame 1E.
    pub(super) fn of_1e(fields: &mut Fields) -> Result<Device, Refusal> {
        let (first, code) = Device::number_of_1e(fields)?;
        Row::find(|row| u32::from(row.code_1e) == code)?.device(first)
    }

    /// A device of frame 3E: number in three bytes, code in one; in ASCII a name of two characters and six digits, of
    /// which the first may be spaces.
    pub(super) fn of_3e(fields: &mut Fields) -> Result<Device, Refusal> {
        match fields.code {
            Code::Binary => {
                let (first, code) = (fields.number(3)?, fields.number(1)?);
                Row::find(|row| u32::from(row.code_3e) == code)?.device(first)
            }
            Code::Ascii => {
                let (name, number) = (fields.characters(2)?, fields.characters(6)?);
                let is_name = |row: &Row| {
                    let [first, second] = row.name;
                    name == row.name || second == b'*' && name == [first, b' ']
                };
                let row = Row::find(is_name)?;
                row.device(digits(number.trim_ascii_start(), row.base())?)
            }
        }
    }

    /// Returns true if these are 32-bit counters as words.
    pub(super) fn is_counter32(self) -> bool {
        self.class == Class::C && !self.is_bit && self.first >= FIRST_COUNTER32
    }

    /// Checks that `count` words from here on exist.
    ///
    /// # Errors
    /// [`Refusal::Head`] or [`Refusal::End`].
    fn check_words(self, count: u32, map: &dyn Map) -> Result<(), Refusal> {
        let exist = |count: u32| {
            if self.is_bit {
                return map.has_bits(self.class, self.first, 16 * count);
            }
            let end = self.first + count;
            let ends_before_32_bits = self.class != Class::C || end <= FIRST_COUNTER32;
            ends_before_32_bits && map.has_words(self.class, self.first, count)
        };
        let has_head = match self.is_bit {
            true => map.bit(self.class, self.first).is_some(),
            false => exist(1),
        };
        reach(has_head, exist(count))
    }

    /// Checks that these are bit devices, and that `count` of them exist.
    ///
    /// # Errors
    /// [`Refusal::Kind`], [`Refusal::Head`] or [`Refusal::End`].
    fn check_bits(self, count: u32, map: &dyn Map) -> Result<(), Refusal> {
        if !self.is_bit {
            return Err(Refusal::Kind);
        }
        let has_head = map.bit(self.class, self.first).is_some();
        reach(has_head, map.has_bits(self.class, self.first, count))
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
        word.ok_or(Refusal::Head)
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
                .ok_or(Refusal::Head);
        }
        Ok(u32::from(self.word(0, map)?) | u32::from(self.word(1, map)?) << 16)
    }

    /// Checks that [`Device::double_word`] finds a value.
    ///
    /// # Errors
    /// [`Refusal::Head`] or [`Refusal::End`].
    pub(super) fn check_double_word(self, map: &dyn Map) -> Result<(), Refusal> {
        if self.is_counter32() {
            let exists = map.counter32(self.first).is_some();
            reach(exists, exists)
        } else {
            self.check_words(2, map)
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
        reply: &mut Reply,
    ) -> Result<(), Refusal> {
        self.check_words(count, map)?;
        for index in 0..count {
            reply.number(u32::from(self.word(index, map)?), 2);
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
        if data.left.len() != 2 * count as usize * data.code.width() {
            return Err(Refusal::Length);
        }
        self.check_words(count, map)?;
        data.check_numbers(count, 2)?;
        for index in 0..count {
            self.set_word(index, data.number(2)? as u16, map);
        }
        Ok(())
    }

    /// Appends `count` bits.
    pub(super) fn read_bits(
        self,
        count: u32,
        map: &dyn Map,
        reply: &mut Reply,
    ) -> Result<(), Refusal> {
        self.check_bits(count, map)?;
        reply.bits(count, |index| {
            map.bit(self.class, self.first + index) == Some(true)
        });
        Ok(())
    }

    /// Writes `count` bits, which are all that follows: two to a byte, the first in the high half, or a digit for each.
    pub(super) fn write_bits(
        self,
        count: u32,
        data: Fields,
        map: &mut dyn Map,
    ) -> Result<(), Refusal> {
        let expected = match data.code {
            Code::Binary => count.div_ceil(2),
            Code::Ascii => count,
        };
        if data.left.len() != expected as usize {
            return Err(Refusal::Length);
        }
        self.check_bits(count, map)?;
        data.check_bits()?;
        for (index, number) in (self.first..self.first + count).enumerate() {
            let on = match (data.code, data.left.get(index), data.left.get(index / 2)) {
                (Code::Ascii, Some(digit), _) => *digit == b'1',
                (Code::Binary, _, Some(pair)) if index % 2 == 0 => pair >> 4 == 1,
                (Code::Binary, _, Some(pair)) => pair & 15 == 1,
                _ => false,
            };
            let _ = map.set_bit(self.class, number, on);
        }
        Ok(())
    }

    /// Checks that a single bit (`bit`) or word exists.
    ///
    /// # Errors
    /// [`Refusal::Kind`], [`Refusal::Head`] or [`Refusal::End`].
    pub(super) fn check(self, bit: bool, map: &dyn Map) -> Result<(), Refusal> {
        if bit {
            self.check_bits(1, map)
        } else {
            self.check_words(1, map)
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

/// Outcome of a check of devices, of which the first exists, or all.
fn reach(has_head: bool, has_all: bool) -> Result<(), Refusal> {
    match (has_head, has_all) {
        (_, true) => Ok(()),
        (true, false) => Err(Refusal::End),
        (false, false) => Err(Refusal::Head),
    }
}
