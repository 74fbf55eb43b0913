//! Requests of a master, and what the answers mean.

use super::adu::{Bits, Body, Framing, LONGEST_RTU, close};
use super::areas::Limits;
use super::function::{
    READ_COILS, READ_INPUT_REGISTERS, READ_INPUTS, READ_REGISTERS, REFUSED, WRITE_COIL,
    WRITE_COILS, WRITE_REGISTER, WRITE_REGISTERS,
};
use super::slave::BROADCAST;
use super::{COIL_ON, Exception, diagnosis};
use crate::comm::{Frame, LineFault, Map};
use crate::plc::Class;

/// The last address of a slave.
const LAST_STATION: u8 = 247;

/// The layout of data in the devices of a master.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Layout {
    /// Words, one for each register; coils are packed sixteen to a word, the first the lowest.
    #[default]
    Words = 0,
    /// Words as above, but of coils the first byte is the high one (FX3U-compatible boards).
    HighFirst = 1,
    /// Bit devices, one for each coil.
    Bits = 2,
    /// A constant.
    Constant = 3,
}

/// Devices of the master that a request sends or its answer fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Buffer {
    /// Their class.
    pub class: Class,
    /// The layout of data in them.
    pub layout: Layout,
    /// Number of the first, or the constant.
    pub first: u32,
}

impl Buffer {
    /// Words from this one on.
    pub const fn words(class: Class, first: u32) -> Self {
        Buffer {
            class,
            layout: Layout::Words,
            first,
        }
    }

    /// Bits from this one on.
    pub const fn bits(class: Class, first: u32) -> Self {
        Buffer {
            class,
            layout: Layout::Bits,
            first,
        }
    }

    /// Word number `index`.
    pub(super) fn word(self, index: u32, map: &dyn Map) -> Option<u16> {
        match self.layout {
            Layout::Bits => None,
            Layout::Constant => Some(self.first as u16),
            Layout::Words | Layout::HighFirst => {
                let word = map.word(self.class, self.first.checked_add(index)?)?;
                Some(word as u16)
            }
        }
    }

    /// Writes word number `index`.
    pub(super) fn set_word(self, index: u32, value: u16, map: &mut dyn Map) -> Option<()> {
        match self.layout {
            Layout::Bits | Layout::Constant => None,
            Layout::Words | Layout::HighFirst => {
                map.set_word(self.class, self.first.checked_add(index)?, value as i16)
            }
        }
    }

    /// A word of coils with the first coil in its lowest bit, of one as stored in the device, and the other way round.
    fn ordered(self, word: u16) -> u16 {
        match self.layout {
            Layout::HighFirst => word.swap_bytes(),
            _ => word,
        }
    }

    /// Coil number `index`.
    fn coil(self, index: u32, map: &dyn Map) -> Option<bool> {
        if self.layout == Layout::Bits {
            return map.bit(self.class, self.first.checked_add(index)?);
        }
        let word = self.ordered(self.word(index / 16, map)?);
        Some(word >> (index % 16) & 1 == 1)
    }

    /// Writes `count` coils from `body`, starting at byte `at`. The rest of the last word is 0.
    fn set_coils(self, count: u16, body: Body, at: usize, map: &mut dyn Map) -> Option<()> {
        let count = u32::from(count);
        if self.layout == Layout::Bits {
            return (0..count).try_for_each(|index| {
                let on = body.bit(at, index as usize)?;
                map.set_bit(self.class, self.first.checked_add(index)?, on)
            });
        }
        (0..count.div_ceil(16)).try_for_each(|index| {
            let bits = (count - 16 * index).min(16);
            let word = (0..bits).try_fold(0u16, |word, bit| {
                let on = body.bit(at, (16 * index + bit) as usize)?;
                Some(word | u16::from(on) << bit)
            })?;
            self.set_word(index, self.ordered(word), map)
        })
    }

    /// Returns true if `count` coils or registers fit in devices that exist.
    fn holds(self, count: u16, coils: bool, map: &dyn Map) -> bool {
        let count = u32::from(count);
        match self.layout {
            Layout::Bits => coils && map.has_bits(self.class, self.first, count),
            Layout::Constant => count == 1,
            Layout::Words | Layout::HighFirst => {
                let words = if coils { count.div_ceil(16) } else { count };
                map.has_words(self.class, self.first, words)
            }
        }
    }
}

/// Request of a master.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Job {
    /// The slave; 0 for all.
    pub station: u8,
    /// The function: 01 to 06, 0F, 10; for FX3's ADPRW also 07, 08, 0B, 0C, 11, 16.
    pub function: u8,
    /// The first address, as on the line.
    pub address: u16,
    /// Number of coils or registers; 05 and 06 write one regardless.
    pub count: u16,
    /// Devices that hold or receive the data.
    pub buffer: Buffer,
}

impl Job {
    /// Returns true if a slave answers.
    pub fn is_answered(&self) -> bool {
        self.station != BROADCAST && !diagnosis::is_silent(self)
    }

    /// Returns true for coils rather than registers.
    fn coils(&self) -> bool {
        [READ_COILS, READ_INPUTS, WRITE_COIL, WRITE_COILS].contains(&self.function)
    }

    /// Number of coils or registers, checked against the limits.
    fn count(&self, limits: &Limits) -> Result<u16, LineFault> {
        match limits.most(self.function) {
            Some(most) if (1..=most).contains(&self.count) => Ok(self.count),
            Some(_) => Err(LineFault::Data),
            None if [WRITE_COIL, WRITE_REGISTER].contains(&self.function) => Ok(1),
            None => Err(LineFault::Command),
        }
    }

    /// Faults unless a slave, or all slaves of a line, can have the station: 248 to 255 are reserved, and all slaves
    /// only take requests to write (Modbus over serial line §2.2; hm-motion-controller §6.4).
    fn check_station(&self) -> Result<(), LineFault> {
        let reads = [
            READ_COILS,
            READ_INPUTS,
            READ_REGISTERS,
            READ_INPUT_REGISTERS,
        ];
        match self.station {
            BROADCAST if reads.contains(&self.function) => Err(LineFault::Station),
            BROADCAST..=LAST_STATION => Ok(()),
            _ => Err(LineFault::Station),
        }
    }
}

/// Makes the request of a job; see the contract of [`crate::comm`].
pub fn request(
    framing: Framing,
    limits: &Limits,
    job: &Job,
    map: &dyn Map,
    frame: &mut Frame,
) -> Result<(), LineFault> {
    job.check_station()?;
    request_body(limits, job, map, frame)?;
    close(framing, frame)
}

/// Appends the request without its framing: from the station on, without a check code.
pub(super) fn request_body(
    limits: &Limits,
    job: &Job,
    map: &dyn Map,
    frame: &mut Frame,
) -> Result<(), LineFault> {
    if limits.diagnosis && diagnosis::is_known(job.function) {
        frame.push(job.station);
        frame.push(job.function);
        return diagnosis::request(job, map, frame);
    }
    let count = job.count(limits)?;
    if !job.buffer.holds(count, job.coils(), map) {
        return Err(LineFault::Address);
    }
    frame.push(job.station);
    frame.push(job.function);
    frame.push_be16(job.address);
    let buffer = job.buffer;
    let mut coils = (0..u32::from(count)).map(|index| buffer.coil(index, map));
    let mut words = (0..u32::from(count)).map(|index| buffer.word(index, map).unwrap_or(0));
    match job.function {
        WRITE_COIL => {
            // A register stands for on by any value but 0.
            let on = match buffer.layout {
                Layout::Bits => coils.next().flatten() == Some(true),
                _ => words.next() != Some(0),
            };
            frame.push_be16(if on { COIL_ON } else { 0 });
        }
        WRITE_REGISTER => frame.push_be16(words.next().unwrap_or(0)),
        WRITE_COILS => {
            frame.push_be16(count);
            frame.push(count.div_ceil(8) as u8);
            let mut bits = Bits::new();
            for coil in coils {
                bits.push(coil.ok_or(LineFault::Address)?, frame);
            }
            bits.finish(frame);
        }
        WRITE_REGISTERS => {
            frame.push_be16(count);
            frame.push((2 * count) as u8);
            words.for_each(|word| frame.push_be16(word));
        }
        _ => frame.push_be16(count),
    }
    Ok(())
}

/// Takes the answer to a job; see the contract of [`crate::comm`]. Nothing is written unless all of it fits the job.
pub fn accept(
    framing: Framing,
    job: &Job,
    reply: &[u8],
    map: &mut dyn Map,
) -> Result<(), LineFault> {
    let mut decoded = [0; LONGEST_RTU];
    accept_body(job, Body::open(framing, reply, &mut decoded)?, map)
}

/// The same without the parts that a line puts around it.
pub(super) fn accept_body(job: &Job, body: Body, map: &mut dyn Map) -> Result<(), LineFault> {
    if body.byte(0) != Some(job.station) {
        return Err(LineFault::Address);
    }
    match body.byte(1) {
        Some(function) if function == job.function => {}
        Some(function) if function == job.function | REFUSED => {
            let code = body.byte(2).filter(|_| body.len() == 3);
            return Err(code.map_or(LineFault::Length, |code| Exception::from_code(code).fault()));
        }
        _ => return Err(LineFault::Command),
    }
    match job.function {
        function if diagnosis::is_known(function) => diagnosis::accept(job, body, map),
        READ_COILS | READ_INPUTS => {
            expect_data(body, job.count.div_ceil(8))?;
            let there = job.buffer.holds(job.count, true, map);
            let set = there.then(|| job.buffer.set_coils(job.count, body, DATA, map));
            set.flatten().ok_or(LineFault::Address)
        }
        READ_REGISTERS | READ_INPUT_REGISTERS => {
            expect_data(body, job.count.saturating_mul(2))?;
            if !job.buffer.holds(job.count, false, map) {
                return Err(LineFault::Address);
            }
            (0..job.count).try_for_each(|index| {
                let value = body.word(DATA + 2 * usize::from(index));
                value
                    .and_then(|value| job.buffer.set_word(index.into(), value, map))
                    .ok_or(LineFault::Address)
            })
        }
        _ => confirms(job, body),
    }
}

/// The function and the code of an answer that rejects the request of a job.
pub fn refusal(framing: Framing, job: &Job, reply: &[u8]) -> Option<[u8; 2]> {
    let mut decoded = [0; LONGEST_RTU];
    let body = Body::open(framing, reply, &mut decoded).ok()?;
    let function = body.byte(1)?;
    let refuses = body.byte(0) == Some(job.station) && function == job.function | REFUSED;
    Some([function, body.byte(2)?]).filter(|_| refuses)
}

/// Offset of the data of an answer.
const DATA: usize = 3;

/// Checks that an answer has this many bytes of data, and that its length field agrees.
fn expect_data(body: Body, bytes: u16) -> Result<(), LineFault> {
    let says = body.byte(DATA - 1).map(u16::from);
    match says == Some(bytes) && body.len() == DATA + usize::from(bytes) {
        true => Ok(()),
        false => Err(LineFault::Length),
    }
}

/// Checks that an answer repeats the address of a write and, of 0F and 10, the quantity. The value written by 05 and 06
/// is not compared: some slaves answer with the value that they derived from it.
fn confirms(job: &Job, body: Body) -> Result<(), LineFault> {
    let several = [WRITE_COILS, WRITE_REGISTERS].contains(&job.function);
    match (body.len(), body.word(2), body.word(4)) {
        (6, Some(address), _) if address != job.address => Err(LineFault::Address),
        (6, _, Some(count)) if several && count != job.count => Err(LineFault::Data),
        (6, ..) => Ok(()),
        _ => Err(LineFault::Length),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Plc;
    use crate::comm::Served;
    use crate::double::Double;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// A job whose data is from D10 on.
    fn job(station: u8, function: u8, address: u16, count: u16) -> Job {
        Job {
            station,
            function,
            address,
            count,
            buffer: Buffer::words(Class::D, 10),
        }
    }

    fn ask(framing: Framing, job: &Job, plc: &mut Double) -> Result<Vec<u8>, LineFault> {
        let mut bytes = [0; 513];
        let mut frame = Frame::new(&mut bytes);
        request(framing, &Limits::H2U, job, &Served::new(plc, 0), &mut frame)?;
        Ok(frame.as_slice().to_vec())
    }

    fn take(job: &Job, reply: &[u8], plc: &mut Double) -> Result<(), LineFault> {
        accept(Framing::Rtu, job, reply, &mut Served::new(plc, 0))
    }

    fn high_first(first: u32) -> Buffer {
        Buffer {
            layout: Layout::HighFirst,
            ..Buffer::words(Class::D, first)
        }
    }

    fn hex(text: &str) -> Vec<u8> {
        let byte = |byte| u8::from_str_radix(byte, 16).unwrap();
        text.split_whitespace().map(byte).collect()
    }

    #[test]
    fn requests_that_the_manuals_print() {
        let mut plc = Double::new().with_d(10, &[0x1234, 0xabcd]);
        let frames = [
            (job(1, 3, 100, 1), "01 03 00 64 00 01 C5 D5"),
            (job(1, 3, 0xf001, 1), "01 03 F0 01 00 01 E6 CA"),
            (job(1, 3, 0xf805, 1), "01 03 F8 05 00 01 A5 6B"),
            (job(1, 3, 0, 6), "01 03 00 00 00 06 C5 C8"),
            (job(1, 3, 100, 10), "01 03 00 64 00 0A 84 12"),
            (job(1, 16, 100, 2), "01 10 00 64 00 02 04 12 34 AB CD 0E 67"),
            (job(1, 6, 100, 9), "01 06 00 64 12 34 C5 62"),
            (job(1, 5, 100, 0), "01 05 00 64 FF 00 CD E5"),
        ];
        for (job, frame) in frames {
            assert_eq!(ask(Framing::Rtu, &job, &mut plc), Ok(hex(frame)), "{frame}");
        }
        plc.set_d(10, &[0x0205]);
        let coils = ask(Framing::Rtu, &job(1, 15, 100, 10), &mut plc);
        assert_eq!(coils, Ok(hex("01 0F 00 64 00 0A 02 05 02 6F 8D")));
        let ascii = ask(Framing::Ascii, &job(1, 3, 100, 3), &mut plc);
        assert_eq!(ascii, Ok(b":01030064000395\r\n".to_vec()));
    }

    #[test]
    fn requests_that_cannot_be_made() {
        let mut plc = Double::new();
        let faults = [
            (job(1, 3, 0, 126), LineFault::Data),
            (job(1, 3, 0, 0), LineFault::Data),
            (job(1, 16, 0, 121), LineFault::Data),
            (job(1, 8, 0, 1), LineFault::Command),
            (job(0, 3, 0, 1), LineFault::Station),
            (job(0, 1, 0, 1), LineFault::Station),
            (job(248, 6, 0, 1), LineFault::Station),
            (job(255, 3, 0, 1), LineFault::Station),
            (
                Job {
                    buffer: Buffer::words(Class::D, 8511),
                    ..job(1, 3, 0, 2)
                },
                LineFault::Address,
            ),
            (
                Job {
                    buffer: Buffer::bits(Class::M, 0),
                    ..job(1, 3, 0, 2)
                },
                LineFault::Address,
            ),
        ];
        for (job, fault) in faults {
            assert_eq!(ask(Framing::Rtu, &job, &mut plc), Err(fault), "{job:?}");
        }
    }

    #[test]
    fn answers_fill_registers_relays_and_words_of_coils() {
        let mut plc = Double::new();
        let read = job(1, 3, 100, 1);
        assert_eq!(take(&read, &hex("01 03 02 51 00 85 D4"), &mut plc), Ok(()));
        assert_eq!(plc.d(10, 1), [0x5100]);
        let relays = Job {
            buffer: Buffer::bits(Class::M, 100),
            ..job(1, 1, 0, 4)
        };
        assert_eq!(take(&relays, &hex("01 01 01 0B 10 4F"), &mut plc), Ok(()));
        let on = [0, 1, 2, 3, 4].map(|n| plc.bit(Class::M, 100 + n).unwrap());
        assert_eq!(on, [true, true, false, true, false]);
        let board = Job {
            buffer: high_first(2),
            ..job(2, 1, 0, 7)
        };
        assert_eq!(take(&board, &hex("02 01 01 41 91 FC"), &mut plc), Ok(()));
        assert_eq!(plc.d(2, 2), [0x4100, 0]);
        let words = Job {
            buffer: Buffer::words(Class::D, 2),
            ..board
        };
        assert_eq!(take(&words, &hex("02 01 01 41 91 FC"), &mut plc), Ok(()));
        assert_eq!(plc.d(2, 2), [0x41, 0]);
    }

    #[test]
    fn coils_come_back_from_words_as_they_were_read() {
        let mut plc = Double::new().with_d(10, &[0x0201]);
        let write = Job {
            buffer: high_first(10),
            ..job(1, 15, 0, 10)
        };
        let frame = ask(Framing::Rtu, &write, &mut plc).unwrap();
        assert_eq!(frame[..9], [1, 15, 0, 0, 0, 10, 2, 0x02, 0x01]);
    }

    #[test]
    fn wrong_answers_are_distinguished_and_write_nothing() {
        let read = job(1, 3, 100, 1);
        let answers = [
            ("01 83 01 80 F0", LineFault::Command),
            ("01 83 02 C0 F1", LineFault::Address),
            ("01 83 03 01 31", LineFault::Data),
            ("01 83 04 40 F3", LineFault::Form),
            ("01 04 02 51 00 84 A0", LineFault::Command),
            ("02 03 02 51 00 C1 D4", LineFault::Address),
            ("01 03 02 51 00 85 D5", LineFault::Sum),
            ("01 03 04 00 05 00 06 2A 31", LineFault::Length),
            ("01 03", LineFault::Length),
        ];
        for (answer, fault) in answers {
            let mut plc = Double::new().with_d(10, &[9, 9]);
            let mut answer = hex(answer);
            if fault != LineFault::Sum && answer.len() > 4 {
                let end = answer.len() - 2;
                let crc = super::super::crc16(&answer[..end]).to_le_bytes();
                answer[end..].copy_from_slice(&crc);
            }
            assert_eq!(take(&read, &answer, &mut plc), Err(fault), "{answer:x?}");
            assert_eq!(plc.d(10, 2), [9, 9]);
        }
        let mut plc = Double::new();
        let write = job(1, 16, 100, 2);
        assert_eq!(
            take(&write, &hex("01 10 00 64 00 02 00 17"), &mut plc),
            Ok(())
        );
        let other = job(1, 16, 101, 2);
        assert_eq!(
            take(&other, &hex("01 10 00 64 00 02 00 17"), &mut plc),
            Err(LineFault::Address)
        );
        let more = job(1, 16, 100, 3);
        assert_eq!(
            take(&more, &hex("01 10 00 64 00 02 00 17"), &mut plc),
            Err(LineFault::Data)
        );
    }

    proptest! {
        /// Any bytes: no panic, and nothing but the job's buffer is written.
        #[test]
        fn any_answer(
            reply in prop::collection::vec(any::<u8>(), 0..300),
            function in 0u8..=0x11,
            count in 0u16..=300,
            sealed: bool,
        ) {
            let mut reply = reply;
            if let [station, code, ..] = &mut reply[..] && sealed {
                (*station, *code) = (1, function);
                reply.extend(super::super::crc16(&reply).to_le_bytes());
            }
            let mut plc = Double::new();
            let job = job(1, function, 0, count);
            let _ = take(&job, &reply, &mut plc);
            let end = 10 + u32::from(count);
            prop_assert!(plc.d(0, 10).iter().chain(&plc.d(end, 100)).all(|&word| word == 0));
        }
    }
}
