//! Frame 3E: `50 00 network PC module(2) station length(2) timer(2) command(2) subcommand(2) …`, answered by
//! `D0 00 network PC module(2) station length(2) end code(2) data`. Length counts the characters that follow it. In
//! ASCII each byte is two digits, bits are a digit each, and devices are written with their names. The end codes are
//! those of the MELSEC-L CPU module user's manual (built-in Ethernet function), 5.4.

use super::device::Device;
use super::{Code, Fields, Refusal, Reply, points};
use crate::comm::{LineFault, Map};

/// Bytes up to and with the length.
const HEAD: usize = 9;
/// Bytes from the network number to the station, which the answer repeats.
const ROUTE: usize = 5;
/// Network, PC, module and station of the PLC that is connected: what libraries send unless configured otherwise.
const HERE: [u32; 4] = [0, 0xff, 0x03ff, 0];
/// Bytes before the length.
const BEFORE_LENGTH: usize = 7;

const BATCH_READ: u32 = 0x0401;
const BATCH_WRITE: u32 = 0x1401;
const RANDOM_READ: u32 = 0x0403;
const RANDOM_WRITE: u32 = 0x1402;
const REMOTE_RUN: u32 = 0x1001;
const REMOTE_STOP: u32 = 0x1002;
const CPU_TYPE: u32 = 0x0101;
const ECHO: u32 = 0x0619;

/// Modes of remote RUN: also where another station has requested STOP, and not.
const MODES: [u32; 2] = [1, 3];
/// Mode of remote STOP.
const STOP_MODE: u32 = 1;
/// Clear mode of remote RUN that clears nothing.
const CLEAR_NOTHING: u32 = 0;

const MOST_WORDS: u32 = 960;
const MOST_BITS: u32 = 7168;
const MOST_BITS_ASCII: u32 = 3584;
/// Words and double words of a random read.
const MOST_READ: u32 = 192;
/// Twelfths and fourteenths of this many words and double words may be written at random.
const MOST_WRITTEN: u32 = 1920;
/// Bits of a random write.
const MOST_BITS_WRITTEN: u32 = 188;
/// Characters of an echo.
const MOST_ECHO: u32 = 960;

/// Name of the PLC, in 16 characters; the code that follows is that of D8001.
const NAME: &[u8; 16] = b"RUNGC           ";

/// The length of a request.
///
/// # Errors
/// [`Refusal::Length`] if it does not show yet.
pub(super) fn length(received: &[u8], code: Code) -> Result<usize, Refusal> {
    let mut fields = Fields::new(received, code);
    fields.skip(BEFORE_LENGTH)?;
    let length = fields.number(2)?;
    Ok(HEAD * code.width() + length as usize)
}

pub(super) fn answer(
    request: Fields,
    map: &mut dyn Map,
    reply: &mut Reply,
) -> Result<(), LineFault> {
    let mut head = request;
    let (Ok(_), Ok(route)) = (head.skip(2), head.skip(ROUTE)) else {
        return Err(LineFault::Length);
    };
    reply.number(0xd0, 1);
    reply.number(0, 1);
    reply.frame.extend(route);
    let length = reply.frame.len();
    reply.number(0, 2);
    let end_code = reply.frame.len();
    reply.number(0, 2);
    let data = reply.frame.len();
    let outcome = execute(request, map, reply);
    if let Err(refusal) = outcome {
        reply.frame.truncate(data);
        let code = match refusal {
            Refusal::Digit => 0xc050,
            Refusal::Command => 0xc059,
            Refusal::Points => 0xc051,
            Refusal::Head | Refusal::End => 0xc056,
            Refusal::Device => 0xc05b,
            Refusal::Kind | Refusal::Group | Refusal::Mode => 0xc05c,
            Refusal::Bit => 0xc060,
            Refusal::Length => 0xc061,
            Refusal::Station => 0x4a00,
        };
        reply.replace(end_code, code, 2);
        // The rejected request: route and command.
        reply.frame.extend(route);
        match head.skip(4).and_then(|_| head.skip(4)) {
            Ok(command) => reply.frame.extend(command),
            Err(_) => reply.number(0, 4),
        }
    }
    reply.replace(length, (reply.frame.len() - end_code) as u32, 2);
    outcome.map_err(Refusal::fault)
}

fn execute(request: Fields, map: &mut dyn Map, reply: &mut Reply) -> Result<(), Refusal> {
    let code = request.code;
    if length(request.left, code)? != request.left.len() {
        return Err(Refusal::Length);
    }
    let mut fields = request;
    fields.skip(2)?;
    let (network, pc) = (fields.number(1)?, fields.number(1)?);
    let (module, station) = (fields.number(2)?, fields.number(1)?);
    if [network, pc, module, station] != HERE {
        return Err(Refusal::Station);
    }
    // Length and timer.
    fields.skip(4)?;
    let (command, subcommand) = (fields.number(2)?, fields.number(2)?);
    match (command, subcommand) {
        (BATCH_READ | BATCH_WRITE, 0 | 1) => {
            let device = Device::of_3e(&mut fields)?;
            let count = fields.number(2)?;
            let is_bits = subcommand == 1;
            let most = match (is_bits, code) {
                (false, _) => MOST_WORDS,
                (true, Code::Binary) => MOST_BITS,
                (true, Code::Ascii) => MOST_BITS_ASCII,
            };
            let count = points(count, most)?;
            if command == BATCH_READ {
                fields.end()?;
            }
            match (command, is_bits) {
                (BATCH_READ, false) => device.read_words(count, map, reply),
                (BATCH_READ, true) => device.read_bits(count, map, reply),
                (_, false) => device.write_words(count, fields, map),
                (_, true) => device.write_bits(count, fields, map),
            }
        }
        (RANDOM_READ, 0) => random_read(fields, map, reply),
        (RANDOM_WRITE, 0) => random_write(fields, map),
        (RANDOM_WRITE, 1) => random_write_bits(fields, map),
        (REMOTE_RUN | REMOTE_STOP, 0) => remote(command == REMOTE_RUN, fields, map),
        (CPU_TYPE, 0) => {
            fields.end()?;
            reply.frame.extend(NAME);
            reply.number(map.type_code().into(), 2);
            Ok(())
        }
        (ECHO, 0) => {
            let echo = fields.left;
            let count = points(fields.number(2)?, MOST_ECHO)?;
            fields.characters(count as usize)?;
            fields.end()?;
            reply.frame.extend(echo);
            Ok(())
        }
        _ => Err(Refusal::Command),
    }
}

/// Remote RUN, with its mode, clear mode and a zero, or remote STOP, with its mode (MELSEC-Q/L and iQ-R MC protocol
/// reference manual, 11.2). No device is cleared.
fn remote(run: bool, mut fields: Fields, map: &mut dyn Map) -> Result<(), Refusal> {
    let mode = fields.number(2)?;
    let is_valid = if run {
        let (clear, zero) = (fields.number(1)?, fields.number(1)?);
        MODES.contains(&mode) && clear == CLEAR_NOTHING && zero == 0
    } else {
        mode == STOP_MODE
    };
    fields.end()?;
    if !is_valid {
        return Err(Refusal::Mode);
    }
    map.request_running(run);
    Ok(())
}

/// Words and double words, each with its device.
fn random_read(mut fields: Fields, map: &dyn Map, reply: &mut Reply) -> Result<(), Refusal> {
    let (words, doubles) = (fields.number(1)?, fields.number(1)?);
    points(words + doubles, MOST_READ)?;
    for _ in 0..words {
        Device::of_3e(&mut fields)?.read_words(1, map, reply)?;
    }
    for _ in 0..doubles {
        let value = Device::of_3e(&mut fields)?.double_word(map)?;
        reply.number(value, 4);
    }
    fields.end()
}

fn random_write(mut fields: Fields, map: &mut dyn Map) -> Result<(), Refusal> {
    let (words, doubles) = (fields.number(1)?, fields.number(1)?);
    points(12 * words + 14 * doubles, MOST_WRITTEN)?;
    let mut checked = fields;
    for index in 0..words + doubles {
        let device = Device::of_3e(&mut checked)?;
        let (exists, bytes) = if index < words {
            (device.check(false, map), 2)
        } else {
            (device.check_double_word(map), 4)
        };
        checked.number(bytes)?;
        exists?;
    }
    checked.end()?;
    for index in 0..words + doubles {
        let device = Device::of_3e(&mut fields)?;
        if index < words {
            device.set(false, fields.number(2)?, map);
        } else {
            device.set_double_word(fields.number(4)?, map);
        }
    }
    Ok(())
}

fn random_write_bits(mut fields: Fields, map: &mut dyn Map) -> Result<(), Refusal> {
    let count = points(fields.number(1)?, MOST_BITS_WRITTEN)?;
    let mut checked = fields;
    for _ in 0..count {
        let device = Device::of_3e(&mut checked)?;
        if checked.number(1)? > 1 {
            return Err(Refusal::Bit);
        }
        device.check(true, map)?;
    }
    checked.end()?;
    for _ in 0..count {
        let device = Device::of_3e(&mut fields)?;
        device.set(true, fields.number(1)?, map);
    }
    Ok(())
}
