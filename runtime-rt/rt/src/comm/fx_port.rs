//! The programming port of the FX family, which is also its HMI monitor: device read, write and force, RUN and STOP,
//! monitor lists.
//!
//! The vendors do not publish this protocol (h1u-h2u-programming §5.3.1 names it, no manual prints a frame). This code
//! follows published recordings between GX Works2 and PLCs and from published drivers. Program memory is read where the
//! PLC has one (a simulated PLC does, a compiled program does not); commands that would change it are rejected with
//! NAK.
//!
//! The line is 9600 bit/s, 7 data bits, even parity, 1 stop bit. A request is `STX command fields ETX sum`, in
//! hexadecimal digits of upper case; the sum is the low byte of all characters after STX up to and with ETX. A lone ENQ
//! asks whether somebody is there.

mod monitor;
mod space;
#[cfg(test)]
mod tests;

use super::{Cut, Frame, LineFault, Map, Memory, hex_digits};
use crate::plc::Class;
use crate::special;
use core::ops::Range;
use monitor::MonitorList;
pub use space::Space;
use space::{Area, Place};

/// Start of text.
const STX: u8 = 0x02;
/// End of text; two digits of the sum follow.
const ETX: u8 = 0x03;
/// Asks whether somebody is there.
const ENQ: u8 = 0x05;
/// Yes, or done.
const ACK: u8 = 0x06;
/// Rejected.
const NAK: u8 = 0x15;

/// Maximum number of bytes that the commands `0` and `1` move.
const MOST_BASIC: u32 = 0x40;
/// Maximum number of bytes that the commands `E00` and `E10` move; more than any published tool asks for.
const MOST_EXTENDED: u32 = 0xfe;

/// First address of program memory: its parameters.
pub const PROGRAM_MEMORY: u32 = 0x8000;
/// Offset of the first instruction.
const PROGRAM: u32 = 0x805c;
/// The word of `END`.
const END: u16 = 0x000f;

/// Maximum number of characters of a request: `E10` with all its bytes.
pub const LONGEST: usize = 1 + 9 + 2 * MOST_EXTENDED as usize + 3;

/// Type and version of the PLC.
const D_TYPE: u32 = special::D_TYPE.number();
/// The same on FX, where D8101 shows the memory's version.
const D_TYPE_AGAIN: u32 = special::D_TYPE_AGAIN.number();
/// Enables forced RUN.
const M_FORCE_ENABLE: u32 = special::M_FORCE_ENABLE.number();
/// Forced RUN, with M8035.
const M_FORCE_RUN: u32 = special::M_FORCED_RUN.number();
/// Forced STOP.
const M_FORCE_STOP: u32 = special::M_FORCED_STOP.number();

/// Settings of the protocol by model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Address space of the extended commands.
    pub space: Space,
    /// True if M8035 to M8037 switch RUN and STOP, and D8101 shows the same as D8001, as on FX. HM uses these devices
    /// otherwise (hm-motion-controller §4.4).
    pub fx_relays: bool,
}

/// Decides whether the characters received so far form a request.
pub fn cut(received: &[u8]) -> Cut {
    match received {
        [ENQ] => Cut::Whole,
        [STX] => Cut::More,
        [STX, .., STX | ENQ] => Cut::Restart,
        [STX, .., ETX, _, _] => Cut::Whole,
        [STX, ..] if received.len() < LONGEST => Cut::More,
        _ => Cut::Drop,
    }
}

/// Answers a request. A rejected one is answered by NAK; commands for program memory that is not served are rejected
/// without a fault.
///
/// # Errors
/// What is wrong with a request that no PLC would take.
pub fn answer(
    settings: Settings,
    memory: &mut Memory,
    request: &[u8],
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    if request == [ENQ] {
        reply.push(ACK);
        return Ok(());
    }
    let server = Server {
        settings,
        list: MonitorList(memory),
        map,
    };
    let outcome = text_of(request).and_then(|text| server.execute(text, reply));
    match outcome {
        Ok(Answer::Data) => {
            reply.push(ETX);
            reply.push_hex(reply.sum_from(1).into(), 2);
            Ok(())
        }
        Ok(Answer::Done) => {
            reply.push(ACK);
            Ok(())
        }
        Ok(Answer::NotServed) => {
            reply.clear();
            reply.push(NAK);
            Ok(())
        }
        Err(fault) => {
            reply.clear();
            reply.push(NAK);
            Err(fault)
        }
    }
}

/// The text between STX and ETX of a request, or of an answer with data.
///
/// # Errors
///
/// The frame is malformed, or its sum is wrong.
pub fn text_of(request: &[u8]) -> Result<&[u8], LineFault> {
    let [STX, text @ .., ETX, high, low] = request else {
        return Err(LineFault::Form);
    };
    let sum = text.iter().fold(ETX, |sum, &c| sum.wrapping_add(c));
    match hex_digits(&[*high, *low]) {
        Some(stated) if stated == u32::from(sum) => Ok(text),
        _ => Err(LineFault::Sum),
    }
}

/// The bit rate that a request asks for, in hundreds of bits per second: command `A` and a digit. It holds once the
/// request has been answered.
pub fn rate(text: &[u8]) -> Option<u16> {
    let [b'A', digit] = text else {
        return None;
    };
    Some(match digit {
        b'0' => 96,
        b'1' => 192,
        b'2' => 384,
        b'3' => 576,
        b'5' => 1152,
        _ => return None,
    })
}

/// Answer to a request.
enum Answer {
    /// The contents of the reply from STX on.
    Data,
    /// ACK.
    Done,
    /// NAK, since there is no such program memory, or it cannot be changed.
    NotServed,
}

/// The fields of a request that have not been read yet.
struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
    /// The value of the next `count` digits.
    fn hex(&mut self, count: usize) -> Result<u32, LineFault> {
        let (digits, rest) = self.0.split_at_checked(count).ok_or(LineFault::Form)?;
        self.0 = rest;
        hex_digits(digits).ok_or(LineFault::Unknown)
    }

    /// A bit number, whose low byte is sent first.
    fn bit(&mut self) -> Result<u16, LineFault> {
        Ok((self.hex(4)? as u16).swap_bytes())
    }

    /// Nothing may follow.
    fn end(&self) -> Result<(), LineFault> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(LineFault::Form)
        }
    }
}

/// The addresses that a request to read names: the first, and how many.
fn addresses(most: u32, fields: &[u8]) -> Result<Range<u32>, LineFault> {
    let mut fields = Fields(fields);
    let (address, count) = (fields.hex(4)?, fields.hex(2)?);
    fields.end()?;
    if !(1..=most).contains(&count) {
        return Err(LineFault::Data);
    }
    Ok(address..address + count)
}

/// One request on its way.
struct Server<'a> {
    settings: Settings,
    list: MonitorList<'a>,
    map: &'a mut dyn Map,
}

impl Server<'_> {
    fn execute(mut self, text: &[u8], reply: &mut Frame) -> Result<Answer, LineFault> {
        let extended = self.settings.space;
        match text {
            [b'0', fields @ ..] => self.read(Space::Basic, MOST_BASIC, fields, reply),
            [b'1', fields @ ..] => self.write(Space::Basic, MOST_BASIC, fields),
            [b'7', fields @ ..] => self.force(Space::Basic, fields, true),
            [b'8', fields @ ..] => self.force(Space::Basic, fields, false),
            [b'E', b'0', b'0', fields @ ..] => self.read(extended, MOST_EXTENDED, fields, reply),
            [b'E', b'1', b'0', fields @ ..] => self.write(extended, MOST_EXTENDED, fields),
            [b'E', b'7', fields @ ..] => self.force(extended, fields, true),
            [b'E', b'8', fields @ ..] => self.force(extended, fields, false),
            [b'F', b'5', b'0', b'1', fields @ ..] if extended == Space::Fx3 => {
                self.read_one(fields, reply)
            }
            [b'E', b'0', b'1', fields @ ..] => self.read_program(MOST_EXTENDED, fields, reply),
            [b'E', b'4', b'1', fields @ ..] => {
                let mut fields = Fields(fields);
                let (from, word) = (fields.hex(4)?, fields.hex(4)? as u16);
                fields.end()?;
                Ok(self.find_in_program(from, word.swap_bytes(), reply))
            }
            // End of the program, as tools query it before they read it.
            [b'F', b'8'] => Ok(self.find_in_program(PROGRAM, END, reply)),
            _ if rate(text).is_some() => Ok(Answer::Done),
            // Clear and write of program memory, identity challenge, end of a download.
            [b'E', b'1', b'1', ..]
            | [b'E', b'6', b'1' | b'2' | b'4' | b'7']
            | [b'E', b'C' | b'E', ..]
            | [b'F', b'7', ..]
            | [b'B'] => Ok(Answer::NotServed),
            _ => Err(LineFault::Command),
        }
    }

    fn read(
        &mut self,
        space: Space,
        most: u32,
        fields: &[u8],
        reply: &mut Frame,
    ) -> Result<Answer, LineFault> {
        let addresses = addresses(most, fields)?;
        if space == Space::Basic && addresses.start >= PROGRAM_MEMORY {
            // FX1S has no other command for it.
            return self.read_program(most, fields, reply);
        }
        reply.push(STX);
        for address in addresses {
            let byte = self.byte(space, address).ok_or(LineFault::Address)?;
            reply.push_hex(byte.into(), 2);
        }
        Ok(Answer::Data)
    }

    /// Reads bytes of program memory.
    fn read_program(
        &self,
        most: u32,
        fields: &[u8],
        reply: &mut Frame,
    ) -> Result<Answer, LineFault> {
        reply.push(STX);
        for address in addresses(most, fields)? {
            let Some(byte) = self.program_byte(address) else {
                return Ok(Answer::NotServed);
            };
            reply.push_hex(byte.into(), 2);
        }
        Ok(Answer::Data)
    }

    /// Answers with `1` and the first address from `from` on, in steps of a word, where program memory holds this word.
    fn find_in_program(&self, from: u32, word: u16, reply: &mut Frame) -> Answer {
        for address in (from..=0xffff).step_by(2) {
            let bytes = self
                .program_byte(address)
                .zip(self.program_byte(address + 1));
            match bytes {
                None => break,
                Some((low, high)) if u16::from_le_bytes([low, high]) == word => {
                    reply.push(STX);
                    reply.push(b'1');
                    reply.push_hex(address, 4);
                    return Answer::Data;
                }
                Some(_) => {}
            }
        }
        Answer::NotServed
    }

    fn program_byte(&self, address: u32) -> Option<u8> {
        self.map.program_byte(address.checked_sub(PROGRAM_MEMORY)?)
    }

    fn write(&mut self, space: Space, most: u32, fields: &[u8]) -> Result<Answer, LineFault> {
        let mut fields = Fields(fields);
        let (address, count) = (fields.hex(4)?, fields.hex(2)?);
        if !(1..=most).contains(&count) {
            return Err(LineFault::Data);
        }
        let data = fields.0;
        for address in address..address + count {
            fields.hex(2)?;
            if !self.takes(space, address) {
                return Err(LineFault::Address);
            }
        }
        fields.end()?;
        for (address, digits) in (address..).zip(data.chunks_exact(2)) {
            let byte = hex_digits(digits).unwrap_or(0) as u8;
            self.set_byte(space, address, byte);
        }
        Ok(Answer::Done)
    }

    fn force(&mut self, space: Space, fields: &[u8], value: bool) -> Result<Answer, LineFault> {
        let mut fields = Fields(fields);
        let bit = fields.bit()?;
        fields.end()?;
        let (area, place) = space.find(space.byte_of(bit)).ok_or(LineFault::Address)?;
        let bit = u32::from(bit % 8);
        match area {
            Area::Bits(class, _) => {
                let number = place.first + bit;
                self.map
                    .set_bit(class, number, value)
                    .ok_or(LineFault::Address)?;
                if class == Class::M {
                    self.switch(number, value);
                }
            }
            Area::Resets(class) => {
                let number = place.first + bit;
                if value {
                    self.map.reset(class, number).ok_or(LineFault::Address)?;
                } else {
                    self.map.bit(class, number).ok_or(LineFault::Address)?;
                }
            }
            _ => return Err(LineFault::Address),
        }
        Ok(Answer::Done)
    }

    /// FX3 reads single bits and words by a separate command.
    fn read_one(&mut self, fields: &[u8], reply: &mut Frame) -> Result<Answer, LineFault> {
        let mut fields = Fields(fields);
        reply.push(STX);
        if fields.hex(1)? == 0 {
            let bit = fields.bit()?;
            fields.end()?;
            let value = self.bit(self.settings.space, bit);
            reply.push_hex(value.ok_or(LineFault::Address)?.into(), 1);
        } else {
            fields.hex(1)?;
            let address = fields.hex(4)?;
            fields.end()?;
            for address in address..address + 2 {
                let byte = self.byte(self.settings.space, address);
                reply.push_hex(byte.ok_or(LineFault::Address)?.into(), 2);
            }
        }
        Ok(Answer::Data)
    }

    /// Forcing M8037 on stops the PLC, forcing it off starts it; M8036 starts it where M8035 is on.
    fn switch(&mut self, relay: u32, value: bool) {
        match relay {
            _ if !self.settings.fx_relays => {}
            M_FORCE_STOP => self.map.request_running(!value),
            M_FORCE_RUN if value && self.map.bit(Class::M, M_FORCE_ENABLE) == Some(true) => {
                self.map.request_running(true);
            }
            _ => {}
        }
    }

    /// A bit by its number in a space; a device that the model lacks is off.
    fn bit(&self, space: Space, bit: u16) -> Option<bool> {
        let byte = self.byte(space, space.byte_of(bit))?;
        Some(byte >> (bit % 8) & 1 != 0)
    }

    /// A word of D, with what identifies the PLC.
    fn word(&self, class: Class, number: u32) -> i16 {
        match (class, number) {
            (Class::D, D_TYPE) => self.map.type_code() as i16,
            (Class::D, D_TYPE_AGAIN) if self.settings.fx_relays => self.map.type_code() as i16,
            _ => self.map.word(class, number).unwrap_or(0),
        }
    }

    /// The byte at an address; `None` where a space has nothing. A device that the model lacks is 0.
    fn byte(&self, space: Space, address: u32) -> Option<u8> {
        let (area, Place { first, byte }) = space.find(address)?;
        Some(match area {
            Area::Bits(class, _) => (0..8).fold(0, |bits, bit| {
                let on = self.map.bit(class, first + bit).unwrap_or(false);
                bits | u8::from(on) << bit
            }),
            Area::Words(class, _) => (self.word(class, first) as u16 >> (8 * byte)) as u8,
            Area::Counters32 => (self.map.counter32(first).unwrap_or(0) as u32 >> (8 * byte)) as u8,
            Area::Coils | Area::Resets(_) => 0,
            Area::List => self.list.byte(first)?,
            Area::Sample => self.sample(space, first),
        })
    }

    /// Byte `index` of what the monitor list names.
    fn sample(&self, space: Space, index: u32) -> u8 {
        let words = self.list.words();
        if index < 2 * words {
            let address = self.list.address(index / 2);
            // A list that names the sample would never end.
            return match space.find(address) {
                Some((Area::Sample, _)) | None => 0,
                Some(_) => self.byte(space, address + index % 2).unwrap_or(0),
            };
        }
        let first = 8 * (index - 2 * words);
        (0..8).fold(0, |bits, bit| {
            let on =
                self.list
                    .bit(first + bit)
                    .and_then(|bit| match space.find(space.byte_of(bit)) {
                        Some((Area::Sample, _)) | None => None,
                        Some(_) => self.bit(space, bit),
                    });
            bits | u8::from(on == Some(true)) << bit
        })
    }

    /// Returns true if a byte may be written: it is not the system's, and its device exists.
    fn takes(&self, space: Space, address: u32) -> bool {
        let Some((area, Place { first, .. })) = space.find(address) else {
            return false;
        };
        match area {
            Area::Bits(class, _) => (first..first + 8).any(|n| self.map.bit(class, n).is_some()),
            Area::Words(class, _) => self.map.word(class, first).is_some(),
            Area::Counters32 => self.map.counter32(first).is_some(),
            Area::List => true,
            Area::Coils | Area::Resets(_) | Area::Sample => false,
        }
    }

    /// Writes a byte that may be written. Of eight bits those change that the model has.
    fn set_byte(&mut self, space: Space, address: u32, value: u8) {
        let Some((area, Place { first, byte })) = space.find(address) else {
            return;
        };
        let merged = |old: u32| old & !(0xff << (8 * byte)) | u32::from(value) << (8 * byte);
        match area {
            Area::Bits(class, _) => {
                for bit in 0..8 {
                    let (number, on) = (first + bit, value >> bit & 1 != 0);
                    let old = self.map.bit(class, number);
                    if self.map.set_bit(class, number, on).is_some()
                        && class == Class::M
                        && old != Some(on)
                    {
                        self.switch(number, on);
                    }
                }
            }
            Area::Words(class, _) => {
                let old = self.map.word(class, first).unwrap_or(0) as u16;
                let _ = self
                    .map
                    .set_word(class, first, merged(old.into()) as u16 as i16);
            }
            Area::Counters32 => {
                let old = self.map.counter32(first).unwrap_or(0) as u32;
                let _ = self.map.set_counter32(first, merged(old) as i32);
            }
            Area::List => self.list.set(first, value),
            Area::Coils | Area::Resets(_) | Area::Sample => {}
        }
    }
}
