//! QLink: two functions that a Modbus RTU slave of H1U and H2U has beside its own (h1u-h2u-programming §5.7.3, §5.7.5).
//!
//! Function 60h names scattered bits and registers under a number and reads them, 61h reads what a number stands for.
//! Two blocks are kept; a third takes the place of the older one. They are lost at power-off, and when the port's
//! protocol changes.
//!
//! The manual says that errors have the codes 1 to 4, not which: an undefined block and an address without a device are
//! 2, everything else is 3.

use super::memory::{Memory, SIZE};
use super::modbus::{self, Place, Profile, crc16};
use super::{Frame, LineFault, Map};

/// Names and reads a block.
const DEFINE: u8 = 0x60;
/// Reads a block.
const READ: u8 = 0x61;
/// Added to the function in a refusal.
const REFUSED: u8 = 0x80;

/// Rejected: an address without a device, a block that is not there.
const ILLEGAL_ADDRESS: u8 = 2;
/// Rejected: a number of devices, or of a block.
const ILLEGAL_VALUE: u8 = 3;

/// Number that no block has.
const NO_BLOCK: u16 = 0xffff;
/// Blocks that are kept.
const BLOCKS: usize = 2;
/// Maximum number of devices of a block: 240 bytes of addresses.
const MOST: usize = 120;
/// Bytes that a block takes: its number plus 1, numbers of bits and of registers, addresses.
const BLOCK: usize = 4 + 2 * MOST;
/// Offset of the number of the block to be replaced next.
const OLDER: usize = BLOCKS * BLOCK;
const _: () = assert!(OLDER < SIZE);

/// Maximum number of bytes of data in an answer.
const MOST_DATA: usize = 240;

/// Returns true if a frame of Modbus RTU is one of QLink.
pub(super) fn is_qlink(request: &[u8]) -> bool {
    matches!(request, [_, DEFINE | READ, ..])
}

/// Reason to reject a request: the exception's code, and the fault that the PLC records.
type Refusal = (u8, LineFault);

const NO_DEVICE: Refusal = (ILLEGAL_ADDRESS, LineFault::Address);
const BAD_VALUE: Refusal = (ILLEGAL_VALUE, LineFault::Data);

/// Answers a frame that silence has ended. `most` is how many devices a block may have: 120 on H2U, 50 on H1U.
pub(super) fn answer(
    settings: &modbus::Settings,
    most: u16,
    memory: &mut Memory,
    request: &[u8],
    map: &dyn Map,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let Some((body, crc)) = request.split_last_chunk::<2>() else {
        return Err(LineFault::Length);
    };
    if crc16(body).to_le_bytes() != *crc {
        return Err(LineFault::Sum);
    }
    let &[station, function, ref fields @ ..] = body else {
        return Err(LineFault::Length);
    };
    if u16::from(station) != settings.station {
        return Ok(());
    }
    reply.extend(&[station, function]);
    let outcome = serve(settings.profile, most, memory, function, fields, map, reply);
    if let Err((code, _)) = outcome {
        reply.clear();
        reply.extend(&[station, function | REFUSED, code]);
    }
    reply.push_le16(crc16(reply.as_slice()));
    outcome.map_err(|(_, fault)| fault)
}

fn serve(
    profile: &Profile,
    most: u16,
    memory: &mut Memory,
    function: u8,
    fields: &[u8],
    map: &dyn Map,
    reply: &mut Frame,
) -> Result<(), Refusal> {
    let &[high, low, bits, registers, ref addresses @ ..] = fields else {
        return Err(BAD_VALUE);
    };
    let number = u16::from_be_bytes([high, low]);
    let (bits, registers) = (usize::from(bits), usize::from(registers));
    if number == NO_BLOCK {
        return Err(BAD_VALUE);
    }
    reply.extend(&fields[..4]);
    if function == READ {
        if !addresses.is_empty() {
            return Err(BAD_VALUE);
        }
        let addresses = block(memory, number, bits, registers).ok_or(NO_DEVICE)?;
        return read(profile, most, bits, addresses, map, reply);
    }
    if addresses.len() != 2 * (bits + registers) || bits + registers > MOST {
        return Err(BAD_VALUE);
    }
    read(profile, most, bits, addresses, map, reply)?;
    keep(memory, number, &fields[2..]);
    Ok(())
}

/// Appends the values of bits and of registers, each by its address.
fn read(
    profile: &Profile,
    most: u16,
    bits: usize,
    addresses: &[u8],
    map: &dyn Map,
    reply: &mut Frame,
) -> Result<(), Refusal> {
    let start = reply.len();
    let (bit_addresses, registers) = addresses.split_at(2 * bits);
    let mut devices = bits;
    for group in bit_addresses.chunks(16) {
        let mut byte = 0;
        for (bit, address) in group.chunks_exact(2).enumerate() {
            let on = match modbus::place(profile.coils, word_of(address)) {
                Some(Place::Bits(class, number, 1)) => map.bit(class, number),
                _ => None,
            };
            byte |= u8::from(on.ok_or(NO_DEVICE)?) << bit;
        }
        reply.push(byte);
    }
    for address in registers.chunks_exact(2) {
        match modbus::place(profile.registers, word_of(address)).ok_or(NO_DEVICE)? {
            Place::Half {
                counter,
                high: false,
            } => {
                let value = map.counter32(counter).ok_or(NO_DEVICE)? as u32;
                // As two registers would be read: the low word first.
                reply.push_be16(value as u16);
                reply.push_be16((value >> 16) as u16);
                devices += 2;
            }
            Place::Word(class, number) => {
                reply.push_be16(map.word(class, number).ok_or(NO_DEVICE)? as u16);
                devices += 1;
            }
            Place::Bits(..) | Place::Coil(..) | Place::Half { high: true, .. } => {
                return Err(NO_DEVICE);
            }
        }
    }
    if devices > usize::from(most) || reply.len() - start > MOST_DATA {
        return Err(BAD_VALUE);
    }
    Ok(())
}

/// A word, high byte first.
fn word_of(bytes: &[u8]) -> u16 {
    match *bytes {
        [high, low] => u16::from_be_bytes([high, low]),
        _ => 0,
    }
}

/// Mark of a block's number in the memory, where 0 means no block.
fn mark(number: u16) -> [u8; 2] {
    (number + 1).to_be_bytes()
}

/// The addresses of a block, if one of this number and these counts is kept.
fn block(memory: &Memory, number: u16, bits: usize, registers: usize) -> Option<&[u8]> {
    let mut blocks = memory.0.chunks_exact(BLOCK).take(BLOCKS);
    let block = blocks.find(|block| block[..2] == mark(number))?;
    let is_alike = usize::from(block[2]) == bits && usize::from(block[3]) == registers;
    block
        .get(4..4 + 2 * (bits + registers))
        .filter(|_| is_alike)
}

/// Keeps a block: its counts and addresses.
fn keep(memory: &mut Memory, number: u16, block: &[u8]) {
    let mark = mark(number);
    let mut blocks = memory.0.chunks_exact(BLOCK).take(BLOCKS);
    let known = blocks.position(|block| block[..2] == mark);
    let at = known.unwrap_or(usize::from(memory.0[OLDER]) % BLOCKS);
    memory.0[OLDER] = (at + 1) as u8;
    let place = memory.0.chunks_exact_mut(BLOCK).nth(at);
    let Some((head, rest)) = place.and_then(|place| place.split_at_mut_checked(2)) else {
        return;
    };
    head.copy_from_slice(&mark);
    for (to, from) in rest.iter_mut().zip(block) {
        *to = *from;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comm::modbus::{Framing, H1U, H2U};
    use crate::comm::watched::{Watched, bytes, hex, reply_of};
    use crate::plc::Class;
    use proptest::prelude::*;
    use std::string::String;
    use std::vec::Vec;

    const SETTINGS: modbus::Settings = modbus::Settings {
        framing: Framing::Rtu,
        station: 1,
        profile: &H2U,
    };

    fn exchange(
        memory: &mut Memory,
        map: &Watched,
        request: &[u8],
    ) -> (Vec<u8>, Result<(), LineFault>) {
        reply_of(|reply| answer(&SETTINGS, 120, memory, request, map, reply))
    }

    /// The answer to a request without its CRC, without its CRC.
    fn ask(memory: &mut Memory, map: &Watched, request: &str) -> String {
        let mut request = bytes(request);
        request.extend(crc16(&request).to_le_bytes());
        assert!(is_qlink(&request));
        let (reply, _) = exchange(memory, map, &request);
        hex(&reply[..reply.len().saturating_sub(2)])
    }

    #[test]
    fn a_block_is_defined_and_read() {
        let mut map = Watched::new();
        map.plc.set_m(5, "1");
        map.plc.set_d(0, &[0x1234]);
        map.plc.set_d(100, &[0x5100]);
        let mut memory = Memory::new();
        let (reply, _) = exchange(
            &mut memory,
            &map,
            &bytes("01 60 00 01 02 02 00 00 00 05 00 00 00 64 5B DD"),
        );
        assert_eq!(hex(&reply), "01 60 00 01 02 02 02 12 34 51 00 E2 AE");
        map.plc.set_m(0, "1");
        let (reply, _) = exchange(&mut memory, &map, &bytes("01 61 00 01 02 02 6D 63"));
        assert_eq!(hex(&reply[..9]), "01 61 00 01 02 02 03 12 34");
        map.set_counter32(200, 0x1_0002);
        assert_eq!(
            ask(&mut memory, &map, "01 60 00 01 00 02 F7 00 00 64"),
            "01 60 00 01 00 02 00 02 00 01 51 00"
        );
    }

    #[test]
    fn two_blocks_are_kept() {
        let mut map = Watched::new();
        map.plc.set_d(0, &[10, 11, 12]);
        let mut memory = Memory::new();
        for id in 0..3 {
            ask(
                &mut memory,
                &map,
                &std::format!("01 60 00 0{id} 00 01 00 0{id}"),
            );
        }
        assert_eq!(ask(&mut memory, &map, "01 61 00 00 00 01"), "01 E1 02");
        assert_eq!(
            ask(&mut memory, &map, "01 61 00 01 00 01"),
            "01 61 00 01 00 01 00 0B"
        );
        assert_eq!(
            ask(&mut memory, &map, "01 61 00 02 00 01"),
            "01 61 00 02 00 01 00 0C"
        );
        assert_eq!(ask(&mut memory, &map, "01 61 00 02 01 00"), "01 E1 02");
        // A new definition replaces the one of its number.
        ask(&mut memory, &map, "01 60 00 02 00 01 00 00");
        assert_eq!(
            ask(&mut memory, &map, "01 61 00 02 00 01"),
            "01 61 00 02 00 01 00 0A"
        );
        assert_eq!(
            ask(&mut memory, &map, "01 61 00 01 00 01"),
            "01 61 00 01 00 01 00 0B"
        );
    }

    #[test]
    fn refusals() {
        let map = Watched::new();
        let mut memory = Memory::new();
        assert_eq!(
            ask(&mut memory, &map, "01 60 FF FF 00 01 00 0A"),
            "01 E0 03"
        );
        assert_eq!(
            ask(&mut memory, &map, "01 60 00 01 00 01 F8 05"),
            "01 E0 02"
        );
        assert_eq!(
            ask(&mut memory, &map, "01 60 00 01 00 02 00 0A F8 05"),
            "01 E0 02"
        );
        assert_eq!(ask(&mut memory, &map, "01 61 00 01 00 02"), "01 E1 02");
        assert_eq!(
            ask(&mut memory, &map, "01 60 00 01 00 02 00 0A"),
            "01 E0 03"
        );
        assert_eq!(ask(&mut memory, &map, "02 60 00 01 00 01 00 0A"), "");
        let (reply, outcome) = exchange(&mut memory, &map, &bytes("01 60 00 01 00 01 00 0A 0D 00"));
        assert_eq!((reply.as_slice(), outcome), (&[][..], Err(LineFault::Sum)));
    }

    proptest! {
        /// Any bytes: no panic, and the blocks that are kept stay readable.
        #[test]
        fn any_bytes(function in DEFINE..=READ, fields in proptest::collection::vec(any::<u8>(), 0..260)) {
            let map = Watched::new();
            let mut memory = Memory::new();
            ask(&mut memory, &map, "01 60 12 34 00 01 00 00");
            let mut request = [&[1, function], fields.as_slice()].concat();
            request.extend(crc16(&request).to_le_bytes());
            for profile in [&H1U, &H2U] {
                let settings = modbus::Settings { profile, ..SETTINGS };
                let (reply, outcome) = reply_of(|reply| {
                    answer(&settings, 50, &mut memory, &request, &map, reply)
                });
                prop_assert_eq!(outcome.is_err(), reply[1] & REFUSED != 0);
            }
            prop_assert_eq!(
                ask(&mut memory, &map, "01 61 12 34 00 01"),
                "01 61 12 34 00 01 00 00"
            );
            prop_assert_eq!(map.bit(Class::M, 0), Some(false));
        }
    }
}
