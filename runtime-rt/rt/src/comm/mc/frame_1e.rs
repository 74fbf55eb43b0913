//! Frame 1E: `command PC timer(2) …`, answered by `command + 80h, end code, data`. In ASCII each byte is two digits;
//! bits of batches are a digit each, and a zero makes their number even. The end codes are those of the FX3U-ENET-ADP
//! user's manual, 9.3.2.

use super::device::Device;
use super::{ANSWER, Code, Fields, Refusal, Reply, points};
use crate::comm::{LineFault, Map};

const READ_BITS: u8 = 0x00;
const READ_WORDS: u8 = 0x01;
const WRITE_BITS: u8 = 0x02;
const WRITE_WORDS: u8 = 0x03;
const TEST_BITS: u8 = 0x04;
const TEST_WORDS: u8 = 0x05;
const REMOTE_RUN: u8 = 0x13;
const REMOTE_STOP: u8 = 0x14;
const PC_TYPE: u8 = 0x15;
const LOOP_BACK: u8 = 0x16;

/// Command, PC number and timer.
const HEAD: usize = 4;
/// Device, number of points and a zero of batch commands.
const BATCH: usize = 8;

/// Limits of FX3: points of a batch of bits, read and written.
const MOST_BITS: (u32, u32) = (256, 160);
/// Words of 16 bit devices, read and written.
const MOST_WORDS_OF_BITS: (u32, u32) = (32, 10);
/// Words, of which 32-bit counters have two each.
const MOST_WORDS: u32 = 64;
/// Points and words of the test commands.
const MOST_TESTED: (u32, u32) = (80, 10);

/// PC number that means this PLC.
const THIS_PC: u8 = 0xff;
/// PC type of FX3U and FX3UC.
const TYPE_FX3U: u8 = 0xf3;

/// End code of a command that is none.
pub(super) const UNKNOWN: u32 = 0x50;

/// Returns true if the first byte of a request is a command of this frame.
pub(super) fn is_command(command: u32) -> bool {
    matches!(
        u8::try_from(command),
        Ok(READ_BITS..=TEST_WORDS | REMOTE_RUN..=LOOP_BACK)
    )
}

/// The length of a request.
///
/// # Errors
/// [`Refusal::Length`] if it does not show yet.
pub(super) fn length(received: &[u8], code: Code) -> Result<usize, Refusal> {
    let mut fields = Fields::new(received, code);
    let command = fields.number(1)? as u8;
    fields.skip(HEAD - 1)?;
    let (bytes, characters) = match command {
        READ_BITS | READ_WORDS => (BATCH, 0),
        WRITE_BITS => {
            Device::number_of_1e(&mut fields)?;
            (BATCH + bits(fields.number(1)?).div_ceil(2) as usize, 0)
        }
        WRITE_WORDS => {
            Device::number_of_1e(&mut fields)?;
            (BATCH + 2 * fields.number(1)? as usize, 0)
        }
        TEST_BITS => (2 + 7 * fields.number(1)? as usize, 0),
        TEST_WORDS => (2 + 8 * fields.number(1)? as usize, 0),
        LOOP_BACK => (1, fields.number(1)? as usize),
        _ => (0, 0),
    };
    Ok((HEAD + bytes) * code.width() + characters)
}

/// Points of a batch of bits, of which 0 are 256.
fn bits(count: u32) -> u32 {
    if count == 0 { 256 } else { count }
}

/// Reason to reject a frame, in the codes of this frame.
enum Refused {
    By(Refusal),
    /// The PLC itself rejects: 5B and a separate code.
    ByPlc(u8, LineFault),
}

impl From<Refusal> for Refused {
    fn from(refusal: Refusal) -> Self {
        Refused::By(refusal)
    }
}

pub(super) fn answer(
    request: Fields,
    map: &mut dyn Map,
    reply: &mut Reply,
) -> Result<(), LineFault> {
    let mut fields = request;
    let command = fields.number(1).map_err(Refusal::fault)?;
    reply.number(command | ANSWER, 1);
    let end_code = reply.frame.len();
    reply.number(0, 1);
    let Err(refused) = execute(command as u8, request, map, reply) else {
        return Ok(());
    };
    reply.frame.truncate(end_code);
    match refused {
        Refused::ByPlc(code, fault) => {
            reply.number(0x5b, 1);
            reply.number(code.into(), 1);
            reply.number(0, 1);
            Err(fault)
        }
        Refused::By(refusal) => {
            let code = match refusal {
                Refusal::Command => UNKNOWN,
                Refusal::Device => 0x56,
                Refusal::Points | Refusal::End | Refusal::Length => 0x57,
                Refusal::Kind | Refusal::Head | Refusal::Group => 0x58,
                Refusal::Bit | Refusal::Mode | Refusal::Digit => 0x54,
                Refusal::Station => 0x5b,
            };
            reply.number(code, 1);
            Err(refusal.fault())
        }
    }
}

fn execute(
    command: u8,
    request: Fields,
    map: &mut dyn Map,
    reply: &mut Reply,
) -> Result<(), Refused> {
    if length(request.left, request.code)? != request.left.len() {
        return Err(Refusal::Length.into());
    }
    let mut fields = request;
    fields.skip(1)?;
    if fields.number(1)? != u32::from(THIS_PC) {
        return Err(Refused::ByPlc(0x10, LineFault::Station));
    }
    fields.skip(2)?;
    match command {
        READ_BITS..=WRITE_WORDS => Ok(batch(command, fields, map, reply)?),
        TEST_BITS => Ok(test(true, MOST_TESTED.0, fields, map)?),
        TEST_WORDS => Ok(test(false, MOST_TESTED.1, fields, map)?),
        REMOTE_RUN | REMOTE_STOP => {
            map.request_running(command == REMOTE_RUN);
            Ok(())
        }
        PC_TYPE => {
            reply.number(TYPE_FX3U.into(), 1);
            reply.number(0, 1);
            Ok(())
        }
        _ => {
            reply.frame.extend(fields.left);
            Ok(())
        }
    }
}

fn batch(
    command: u8,
    mut fields: Fields,
    map: &mut dyn Map,
    reply: &mut Reply,
) -> Result<(), Refusal> {
    let device = Device::of_1e(&mut fields)?;
    let count = fields.number(1)?;
    fields.skip(1)?;
    if command == READ_BITS || command == WRITE_BITS {
        return batch_of_bits(device, bits(count), command, fields, map, reply);
    }
    if device.is_counter32() {
        let words = points(count, MOST_WORDS)?;
        return counters32(device, words, command, fields, map, reply);
    }
    check_group(device)?;
    let most = match (device.is_bit, command) {
        (true, READ_WORDS) => MOST_WORDS_OF_BITS.0,
        (true, _) => MOST_WORDS_OF_BITS.1,
        (false, _) => MOST_WORDS,
    };
    let count = points(count, most)?;
    if command == READ_WORDS {
        device.read_words(count, map, reply)
    } else {
        device.write_words(count, fields, map)
    }
}

/// Checks that words of bit devices begin at a multiple of 16.
fn check_group(device: Device) -> Result<(), Refusal> {
    if device.is_bit && !device.first.is_multiple_of(16) {
        return Err(Refusal::Group);
    }
    Ok(())
}

/// In ASCII, an odd number of bits has a zero after it (FX3U-ENET-ADP user's manual 7.5).
fn batch_of_bits(
    device: Device,
    count: u32,
    command: u8,
    mut fields: Fields,
    map: &mut dyn Map,
    reply: &mut Reply,
) -> Result<(), Refusal> {
    let is_filled = reply.code == Code::Ascii && count % 2 == 1;
    if command == READ_BITS {
        device.read_bits(points(count, MOST_BITS.0)?, map, reply)?;
        if is_filled {
            reply.frame.push(b'0');
        }
        return Ok(());
    }
    let count = points(count, MOST_BITS.1)?;
    if is_filled {
        fields.check_bits()?;
        fields.left = fields.left.get(..count as usize).ok_or(Refusal::Length)?;
    }
    device.write_bits(count, fields, map)
}

/// 32-bit counters, with two points and four bytes each (FX3U-ENET user's manual 9.3.4 and 9.3.6).
fn counters32(
    device: Device,
    words: u32,
    command: u8,
    mut fields: Fields,
    map: &mut dyn Map,
    reply: &mut Reply,
) -> Result<(), Refusal> {
    if !words.is_multiple_of(2) {
        return Err(Refusal::Points);
    }
    let count = words / 2;
    let all = (device.first..device.first + count).map(|first| Device { first, ..device });
    for counter in all.clone() {
        let checked = counter.check_double_word(map);
        let is_head = counter.first == device.first;
        checked.map_err(|refusal| if is_head { refusal } else { Refusal::End })?;
    }
    if command != READ_WORDS {
        fields.check_numbers(count, 4)?;
    }
    for counter in all {
        if command == READ_WORDS {
            reply.number(counter.double_word(map)?, 4);
        } else {
            counter.set_double_word(fields.number(4)?, map);
        }
    }
    Ok(())
}

/// Single bits or words, each with its device.
fn test(bit: bool, most: u32, mut fields: Fields, map: &mut dyn Map) -> Result<(), Refusal> {
    let count = points(fields.number(1)?, most)?;
    fields.skip(1)?;
    let bytes = if bit { 1 } else { 2 };
    let mut checked = fields;
    for _ in 0..count {
        let device = Device::of_1e(&mut checked)?;
        let value = checked.number(bytes)?;
        device.check(bit, map)?;
        if !bit {
            check_group(device)?;
        } else if value > 1 {
            return Err(Refusal::Bit);
        }
    }
    checked.end()?;
    for _ in 0..count {
        let device = Device::of_1e(&mut fields)?;
        device.set(bit, fields.number(bytes)?, map);
    }
    Ok(())
}
