//! Computer link: a computer asks PLCs by station number, in text (h1u-h2u-programming §5.6); the BD protocol of L01S
//! is the same (l01s-programming §8.2), and HM has a part of it (hm-motion-controller §6.3).
//!
//! A request is `ENQ station PC command wait contents [sum] [CR LF]`. Formats differ by the terminator alone: format 4
//! ends with CR LF, format 1 by the length that its command has. The low byte of the sum of all characters after the
//! control character follows as two digits where the format word says so; ACK and NAK carry none.
//!
//! Where the manuals are silent, FX decides: the lowest device of a word of bits is bit 0, contacts of timers and
//! counters are `TS` and `CS` with three digits (`T` and `C` with four are taken as well), `BR` with count 00 reads 256
//! points, a frame for another station is not answered even if it is wrong.

mod device;
pub mod master;
pub mod on_demand;
#[cfg(test)]
mod tests;

use super::{Cut, Frame, LineFault, Map, hex_byte, hex_digits};
use crate::plc::Class;
use crate::special::M_FORCE_ENABLE;
use device::{Device, NAME};

/// Start of text.
const STX: u8 = 0x02;
/// End of text.
const ETX: u8 = 0x03;
/// Begins a request.
const ENQ: u8 = 0x05;
/// Done.
const ACK: u8 = 0x06;
/// Rejected; a code follows.
const NAK: u8 = 0x15;

/// Characters from ENQ to the wait digit.
const HEAD: usize = 8;
/// Maximum number of characters of a request: 254 of a loop-back test, sum and terminator included, fewer than 64
/// words.
pub const LONGEST: usize = HEAD + NAME + 2 + 8 * MOST_WORDS as usize + 4;

/// Maximum number of points of BW.
const MOST_BITS_WRITTEN: u32 = 160;
/// Maximum number of words of WR and WW.
const MOST_WORDS: u32 = 64;
/// Maximum number of words of 16 bit devices that WR reads.
const MOST_WORDS_OF_BITS_READ: u32 = 32;
/// Maximum number of words of 16 bit devices that WW writes.
const MOST_WORDS_OF_BITS: u32 = 10;
/// Maximum number of points of BT.
const MOST_BITS_TESTED: u32 = 20;
/// Maximum number of words of WT.
const MOST_WORDS_TESTED: u32 = 10;
/// Maximum number of characters of TT.
const MOST_LOOPED: u32 = 254;

/// Station number of a request for all PLCs on the line.
const TO_ALL: u8 = 0xff;
/// Commands of requests.
const COMMANDS: [&[u8]; 11] = [
    b"BR", b"WR", b"BW", b"WW", b"BT", b"WT", b"RR", b"RS", b"PC", b"GW", b"TT",
];

/// Relay that GW sets in all PLCs on the line.
pub(super) const M_GLOBAL: u32 = 8126;

/// Settings of the protocol by port and model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Own station: 0 to 15 (H1U, H2U, L01S), 1 to 63 (HM).
    pub station: u8,
    /// True if frames carry a sum (b13 of the format word).
    pub sum: bool,
    /// True if CR LF ends a frame (b15 of the format word, format 4).
    pub crlf: bool,
    /// Dialect of the model.
    pub dialect: Dialect,
}

/// Parts of the protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// All commands; `PC` answers this code: `9D` (h1u-h2u-communication §7.2), as FX2N.
    Fx([u8; 2]),
    /// `WR` and `WW` of D0 to D7999.
    Hm,
}

/// State of a slave between frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Remote {
    /// RUN was begun by RR, so that RS may end it.
    forced_run: bool,
}

impl Remote {
    /// As at power-on.
    pub const fn new() -> Self {
        Remote { forced_run: false }
    }
}

/// Decides whether the characters received so far form a request. A request of format 1 whose length is unknown ends by
/// silence.
///
/// Anything else a computer sends (ACK or NAK for data, EOT and CL) begins no request and is dropped without an answer.
pub fn cut(settings: Settings, received: &[u8]) -> Cut {
    match received {
        [ENQ] => Cut::More,
        [ENQ, .., ENQ] => Cut::Restart,
        [ENQ, ..] if received.len() >= LONGEST => Cut::Drop,
        [ENQ, .., b'\r', b'\n'] if settings.crlf => Cut::Whole,
        [ENQ, ..] if !settings.crlf && expected(settings, received) == Some(received.len()) => {
            Cut::Whole
        }
        [ENQ, ..] => Cut::More,
        _ => Cut::Drop,
    }
}

/// Length of a request of format 1 in characters, as far as known.
fn expected(settings: Settings, received: &[u8]) -> Option<usize> {
    let contents = received.get(HEAD..)?;
    let count = |at: usize| hex_byte(contents, at).map(usize::from);
    let length = match received.get(5..7)? {
        b"BR" | b"WR" => NAME + 2,
        b"BW" => NAME + 2 + count(NAME)?,
        b"WW" => {
            let name = contents.get(..NAME)?;
            let digits = Device::parse(name).map_or(4, Device::digits);
            NAME + 2 + digits * count(NAME)?
        }
        b"BT" => 2 + (NAME + 1) * count(0)?,
        b"WT" => 2 + (NAME + 4) * count(0)?,
        b"TT" => 2 + count(0)?,
        b"GW" => 1,
        b"RR" | b"RS" | b"PC" => 0,
        _ => return None,
    };
    Some(HEAD + length + if settings.sum { 2 } else { 0 })
}

/// Milliseconds that the computer asks to wait before the answer: ten for each count of the wait digit.
fn wait_ms(request: &[u8]) -> u16 {
    let digit = request.get(HEAD - 1..HEAD).and_then(hex_digits);
    10 * digit.unwrap_or(0) as u16
}

/// Reason to reject a request: the code that follows NAK.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    /// 02: the sum is wrong.
    Sum,
    /// 03: the frame has not the form of its command.
    Form,
    /// 06: a device, a count or a command that is not allowed.
    Area,
    /// 07: a character of a value is not a hexadecimal digit.
    Digit,
    /// 10: the PC number is not FF.
    PcNumber,
    /// 18: remote RUN or STOP is not possible.
    Remote,
}

impl Refusal {
    fn code(self) -> u8 {
        match self {
            Refusal::Sum => 0x02,
            Refusal::Form => 0x03,
            Refusal::Area => 0x06,
            Refusal::Digit => 0x07,
            Refusal::PcNumber => 0x10,
            Refusal::Remote => 0x18,
        }
    }

    /// Fault that the PLC records for it; a request at the wrong time is not a fault of the line.
    fn fault(self) -> Result<(), LineFault> {
        Err(match self {
            Refusal::Sum => LineFault::Sum,
            Refusal::Form | Refusal::PcNumber => LineFault::Form,
            Refusal::Area => LineFault::Command,
            Refusal::Digit => LineFault::Unknown,
            Refusal::Remote => return Ok(()),
        })
    }
}

/// Answer to an executed request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    /// The data that the reply holds.
    Data,
    /// ACK.
    Done,
    /// Nothing.
    Silence,
}

/// Answers a request; silence if it is for another station, or a value for all.
///
/// # Errors
/// What is wrong with a request for this station.
pub fn answer(
    settings: Settings,
    remote: &mut Remote,
    request: &[u8],
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let text = match request {
        [text @ .., b'\r', b'\n'] if settings.crlf => text,
        text => text,
    };
    let Some((station, command)) = address_of(text) else {
        return Ok(());
    };
    let to_all = station == TO_ALL;
    let is_global = to_all && command == b"GW";
    if to_all && !is_global && settings.dialect != Dialect::Hm {
        return Err(LineFault::Command);
    }
    if station != settings.station && !is_global {
        return Ok(());
    }
    reply.wait(wait_ms(request));
    head(STX, settings.station, b"FF", reply);
    let data = reply.len();
    match execute(settings, remote, text, map, reply) {
        Ok(Answer::Data) => {
            reply.push(ETX);
            end(settings, reply);
            Ok(())
        }
        Ok(Answer::Done) => {
            reply.truncate(data);
            reply.set(0, ACK);
            terminate(settings, reply);
            Ok(())
        }
        Ok(Answer::Silence) => {
            reply.clear();
            Ok(())
        }
        Err(_) if is_global => {
            reply.clear();
            Ok(())
        }
        Err(refusal) => {
            reply.truncate(data);
            reply.set(0, NAK);
            reply.push_hex(refusal.code().into(), 2);
            terminate(settings, reply);
            refusal.fault()
        }
    }
}

/// Answers a request of format 1 whose length is unknown, after silence; the rest of any other has not come.
///
/// # Errors
/// [`LineFault::TimeOut`] for an incomplete request for this station; what is wrong with one of unknown length.
pub fn answer_late(
    settings: Settings,
    remote: &mut Remote,
    request: &[u8],
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let Some((station, command)) = address_of(request) else {
        return Ok(());
    };
    let unknown = command.len() == 2 && !COMMANDS.contains(&command);
    if unknown && !settings.crlf {
        return answer(settings, remote, request, map, reply);
    }
    match [settings.station, TO_ALL].contains(&station) {
        true => Err(LineFault::TimeOut),
        false => Ok(()),
    }
}

/// Station and command of a request.
fn address_of(text: &[u8]) -> Option<(u8, &[u8])> {
    if text.first() != Some(&ENQ) {
        return None;
    }
    Some((hex_byte(text, 1)?, text.get(5..7).unwrap_or(&[])))
}

/// Control character, station and PC number.
fn head(control: u8, station: u8, pc: &[u8; 2], frame: &mut Frame) {
    frame.clear();
    frame.push(control);
    frame.push_hex(station.into(), 2);
    frame.extend(pc);
}

/// Sum and terminator.
fn end(settings: Settings, frame: &mut Frame) {
    if settings.sum {
        frame.push_hex(frame.sum_from(1).into(), 2);
    }
    terminate(settings, frame);
}

/// Terminator.
fn terminate(settings: Settings, frame: &mut Frame) {
    if settings.crlf {
        frame.extend(b"\r\n");
    }
}

/// Checks and executes a request for this station.
fn execute(
    settings: Settings,
    remote: &mut Remote,
    text: &[u8],
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<Answer, Refusal> {
    let text = if settings.sum {
        let (text, stated) = text.split_at(text.len().saturating_sub(2));
        let summed = text.get(1..).unwrap_or(&[]);
        let sum = summed.iter().fold(0u8, |sum, &c| sum.wrapping_add(c));
        if hex_byte(stated, 0) != Some(sum) {
            return Err(Refusal::Sum);
        }
        text
    } else {
        text
    };
    if text.get(3..5).ok_or(Refusal::Form)? != b"FF" {
        return Err(Refusal::PcNumber);
    }
    let command = text.get(5..7).ok_or(Refusal::Form)?;
    let wait = text.get(7..HEAD).ok_or(Refusal::Form)?;
    hex_digits(wait).ok_or(Refusal::Digit)?;
    let mut contents = Contents(text.get(HEAD..).ok_or(Refusal::Form)?);
    if settings.dialect == Dialect::Hm {
        return match command {
            b"WR" => read_words(&mut contents, settings.dialect, map, reply),
            b"WW" => write_words(&mut contents, settings.dialect, map),
            _ => Err(Refusal::Area),
        };
    }
    match command {
        b"BR" => read_bits(&mut contents, map, reply),
        b"WR" => read_words(&mut contents, settings.dialect, map, reply),
        b"BW" => write_bits(&mut contents, map),
        b"WW" => write_words(&mut contents, settings.dialect, map),
        b"BT" => test_bits(&mut contents, map),
        b"WT" => test_words(&mut contents, map),
        b"RR" | b"RS" => {
            contents.end()?;
            switch(remote, command == b"RR", map)
        }
        b"PC" => {
            contents.end()?;
            if let Dialect::Fx(code) = settings.dialect {
                reply.extend(&code);
            }
            Ok(Answer::Data)
        }
        b"GW" => {
            let on = contents.bit()?;
            contents.end()?;
            // A model without the relay has nothing to note.
            let _ = map.set_bit(Class::M, M_GLOBAL, on);
            Ok(Answer::Silence)
        }
        b"TT" => {
            let count = contents.count(MOST_LOOPED)?;
            let looped = contents.0;
            if looped.len() != count as usize {
                return Err(Refusal::Form);
            }
            reply.push_hex(count, 2);
            reply.extend(looped);
            Ok(Answer::Data)
        }
        _ => Err(Refusal::Area),
    }
}

/// The contents of a request that have not been read yet.
struct Contents<'a>(&'a [u8]);

impl<'a> Contents<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Refusal> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(Refusal::Form)?;
        self.0 = rest;
        Ok(taken)
    }

    /// A device's name.
    fn device(&mut self) -> Result<Device, Refusal> {
        Device::parse(self.take(NAME)?).ok_or(Refusal::Area)
    }

    /// Two digits that are 1 to `most`.
    fn count(&mut self, most: u32) -> Result<u32, Refusal> {
        let count = hex_digits(self.take(2)?).ok_or(Refusal::Digit)?;
        if (1..=most).contains(&count) {
            Ok(count)
        } else {
            Err(Refusal::Area)
        }
    }

    /// `0` or `1`.
    fn bit(&mut self) -> Result<bool, Refusal> {
        match self.take(1)? {
            b"0" => Ok(false),
            b"1" => Ok(true),
            digit => Err(hex_digits(digit).map_or(Refusal::Digit, |_| Refusal::Area)),
        }
    }

    /// A value of `digits` digits.
    fn value(&mut self, digits: usize) -> Result<u32, Refusal> {
        hex_digits(self.take(digits)?).ok_or(Refusal::Digit)
    }

    /// Nothing may follow.
    fn end(&self) -> Result<(), Refusal> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(Refusal::Form)
        }
    }
}

fn read_bits(contents: &mut Contents, map: &dyn Map, reply: &mut Frame) -> Result<Answer, Refusal> {
    let device = contents.device()?;
    let count = match contents.value(2)? {
        0 => 256,
        count => count,
    };
    contents.end()?;
    let Device::Bits(class, first) = device else {
        return Err(Refusal::Area);
    };
    for number in first..first + count {
        let on = map.bit(class, number).ok_or(Refusal::Area)?;
        reply.push(b'0' + u8::from(on));
    }
    Ok(Answer::Data)
}

fn write_bits(contents: &mut Contents, map: &mut dyn Map) -> Result<Answer, Refusal> {
    let device = contents.device()?;
    let count = contents.count(MOST_BITS_WRITTEN)?;
    let Device::Bits(class, first) = device else {
        return Err(Refusal::Area);
    };
    let values = contents.0;
    for _ in 0..count {
        contents.bit()?;
    }
    contents.end()?;
    if !map.has_bits(class, first, count) {
        return Err(Refusal::Area);
    }
    for (number, &value) in (first..).zip(values) {
        let _ = map.set_bit(class, number, value == b'1');
    }
    Ok(Answer::Done)
}

/// A device and a count of words, all of which there are.
fn words(
    contents: &mut Contents,
    dialect: Dialect,
    most_of_bits: u32,
    map: &dyn Map,
) -> Result<(Device, u32), Refusal> {
    let device = contents.device()?;
    let count = contents.count(match device {
        Device::Bits(..) => most_of_bits,
        Device::Words(..) | Device::Counters32(_) => MOST_WORDS,
    })?;
    let is_served = dialect != Dialect::Hm || device.is_general_register(count);
    if is_served && device.has_words(count, map) {
        Ok((device, count))
    } else {
        Err(Refusal::Area)
    }
}

fn read_words(
    contents: &mut Contents,
    dialect: Dialect,
    map: &dyn Map,
    reply: &mut Frame,
) -> Result<Answer, Refusal> {
    let (device, count) = words(contents, dialect, MOST_WORDS_OF_BITS_READ, map)?;
    contents.end()?;
    for index in 0..count {
        let value = device.word(index, map).ok_or(Refusal::Area)?;
        reply.push_hex(value, device.digits() as u32);
    }
    Ok(Answer::Data)
}

fn write_words(
    contents: &mut Contents,
    dialect: Dialect,
    map: &mut dyn Map,
) -> Result<Answer, Refusal> {
    let (device, count) = words(contents, dialect, MOST_WORDS_OF_BITS, map)?;
    let mut values = Contents(contents.0);
    for _ in 0..count {
        contents.value(device.digits())?;
    }
    contents.end()?;
    for index in 0..count {
        device.set_word(index, values.value(device.digits())?, map);
    }
    Ok(Answer::Done)
}

fn test_bits(contents: &mut Contents, map: &mut dyn Map) -> Result<Answer, Refusal> {
    let count = contents.count(MOST_BITS_TESTED)?;
    let mut points = Contents(contents.0);
    for _ in 0..count {
        match contents.device()? {
            Device::Bits(class, number) if map.bit(class, number).is_some() => contents.bit()?,
            _ => return Err(Refusal::Area),
        };
    }
    contents.end()?;
    for _ in 0..count {
        if let Device::Bits(class, number) = points.device()? {
            let value = points.bit()?;
            let _ = map.set_bit(class, number, value);
        }
    }
    Ok(Answer::Done)
}

fn test_words(contents: &mut Contents, map: &mut dyn Map) -> Result<Answer, Refusal> {
    let count = contents.count(MOST_WORDS_TESTED)?;
    let mut words = Contents(contents.0);
    for _ in 0..count {
        let device = contents.device()?;
        if matches!(device, Device::Counters32(_)) || !device.has_words(1, map) {
            return Err(Refusal::Area);
        }
        contents.value(4)?;
    }
    contents.end()?;
    for _ in 0..count {
        let device = words.device()?;
        device.set_word(0, words.value(4)?, map);
    }
    Ok(Answer::Done)
}

/// RUN out of STOP; STOP out of a forced RUN: one that was begun so, or by M8035 and M8036. M8035 is on meanwhile
/// (h1u-h2u-programming §5.6, §8.9).
fn switch(remote: &mut Remote, run: bool, map: &mut dyn Map) -> Result<Answer, Refusal> {
    let running = map.running();
    let forced = (Class::M, M_FORCE_ENABLE.number());
    let possible = if run {
        !running
    } else {
        running && (remote.forced_run || map.bit(forced.0, forced.1) == Some(true))
    };
    if !possible {
        return Err(Refusal::Remote);
    }
    remote.forced_run = run;
    // A program that does not use M8035 may not store it.
    let _ = map.set_bit(forced.0, forced.1, run);
    map.request_running(run);
    Ok(Answer::Done)
}
