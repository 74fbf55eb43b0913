//! Frame 1E: `command PC timer(2) …`, answered by `command + 80h, end code, data`.

use super::device::Device;
use super::{Fields, Refusal, points};
use crate::comm::{Frame, LineFault, Map};

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
/// Words.
const MOST_WORDS: u32 = 64;
/// 32-bit counters.
const MOST_COUNTERS32: u32 = 32;
/// Points and words of the test commands.
const MOST_TESTED: (u32, u32) = (80, 10);

/// PC number that means this PLC.
const THIS_PC: u8 = 0xff;
/// PC type of FX3U and FX3UC.
const TYPE_FX3U: u8 = 0xf3;

/// Returns true if the first byte of a request is a command of this frame.
pub(super) fn is_command(byte: u8) -> bool {
    matches!(byte, READ_BITS..=TEST_WORDS | REMOTE_RUN..=LOOP_BACK)
}

/// The length of a request, as far as it shows.
pub(super) fn length(received: &[u8]) -> Option<usize> {
    let command = *received.first()?;
    let rest = received.get(HEAD..)?;
    let batch = || Some((Fields(rest.get(..6)?), usize::from(*rest.get(6)?)));
    let data = match command {
        READ_BITS | READ_WORDS => BATCH,
        WRITE_BITS => {
            let (_, count) = batch()?;
            BATCH + (if count == 0 { 256 } else { count }).div_ceil(2)
        }
        WRITE_WORDS => {
            let (mut device, count) = batch()?;
            let is_double = Device::of_1e(&mut device).is_ok_and(Device::is_counter32);
            BATCH + count * if is_double { 4 } else { 2 }
        }
        TEST_BITS => 2 + 7 * usize::from(*rest.first()?),
        TEST_WORDS => 2 + 8 * usize::from(*rest.first()?),
        LOOP_BACK => 1 + usize::from(*rest.first()?),
        _ => 0,
    };
    Some(HEAD + data)
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
    request: &[u8],
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let command = request.first().copied().unwrap_or(0);
    reply.push(command | 0x80);
    reply.push(0);
    let Err(refused) = execute(command, request, map, reply) else {
        return Ok(());
    };
    reply.truncate(2);
    match refused {
        Refused::ByPlc(code, fault) => {
            reply.set(1, 0x5b);
            reply.push(code);
            reply.push(0);
            Err(fault)
        }
        Refused::By(refusal) => {
            reply.set(
                1,
                match refusal {
                    Refusal::Command | Refusal::Length => 0x50,
                    Refusal::Device => 0x56,
                    Refusal::Points => 0x57,
                    Refusal::Data => 0x54,
                },
            );
            Err(refusal.fault())
        }
    }
}

fn execute(
    command: u8,
    request: &[u8],
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<(), Refused> {
    if length(request) != Some(request.len()) {
        return Err(Refusal::Length.into());
    }
    let mut fields = Fields(request);
    fields.take(1)?;
    if fields.number(1)? != u32::from(THIS_PC) {
        return Err(Refused::ByPlc(0x10, LineFault::Station));
    }
    fields.take(2)?;
    match command {
        READ_BITS..=WRITE_WORDS => Ok(batch(command, fields, map, reply)?),
        TEST_BITS => Ok(test(true, MOST_TESTED.0, fields, map)?),
        TEST_WORDS => Ok(test(false, MOST_TESTED.1, fields, map)?),
        REMOTE_RUN | REMOTE_STOP => {
            map.request_running(command == REMOTE_RUN);
            Ok(())
        }
        PC_TYPE => {
            reply.push(TYPE_FX3U);
            reply.push(0);
            Ok(())
        }
        _ => {
            reply.extend(fields.0);
            Ok(())
        }
    }
}

fn batch(
    command: u8,
    mut fields: Fields,
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<(), Refusal> {
    let device = Device::of_1e(&mut fields)?;
    let count = fields.number(1)?;
    fields.take(1)?;
    if command == READ_BITS || command == WRITE_BITS {
        let count = if count == 0 { 256 } else { count };
        return if command == READ_BITS {
            device.read_bits(points(count, MOST_BITS.0)?, map, reply)
        } else {
            device.write_bits(points(count, MOST_BITS.1)?, fields, map)
        };
    }
    if device.is_counter32() {
        return counters32(
            device,
            points(count, MOST_COUNTERS32)?,
            command,
            fields,
            map,
            reply,
        );
    }
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

/// Values of 32-bit counters take four bytes each.
fn counters32(
    device: Device,
    count: u32,
    command: u8,
    mut fields: Fields,
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<(), Refusal> {
    let all = (device.first..device.first + count).map(|first| Device { first, ..device });
    if !all.clone().all(|counter| counter.has_double_word(map)) {
        return Err(Refusal::Device);
    }
    for counter in all {
        if command == READ_WORDS {
            reply.extend(&counter.double_word(map)?.to_le_bytes());
        } else {
            counter.set_double_word(fields.number(4)?, map);
        }
    }
    Ok(())
}

/// Single bits or words, each with its device.
fn test(bit: bool, most: u32, mut fields: Fields, map: &mut dyn Map) -> Result<(), Refusal> {
    let count = points(fields.number(1)?, most)?;
    fields.take(1)?;
    let bytes = if bit { 1 } else { 2 };
    let mut checked = fields;
    for _ in 0..count {
        let device = Device::of_1e(&mut checked)?;
        checked.take(bytes)?;
        if !device.exists(bit, map) {
            return Err(Refusal::Device);
        }
    }
    checked.end()?;
    for _ in 0..count {
        let device = Device::of_1e(&mut fields)?;
        device.set(bit, fields.number(bytes)?, map);
    }
    Ok(())
}
