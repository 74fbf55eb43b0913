//! Answers of a slave.

use super::adu::{Body, Framing, Writer};
use super::areas::{Place, places};
use super::function::{
    READ_COILS, READ_INPUT_REGISTERS, READ_INPUTS, READ_REGISTERS, REFUSED, WRITE_COIL,
    WRITE_COILS, WRITE_REGISTER, WRITE_REGISTERS,
};
use super::{Area, COIL_ON, Exception, Profile};
use crate::comm::{Frame, LineFault, Map};
use crate::word::{pair, words};

/// How a port is set up as a slave.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// RTU or ASCII.
    pub framing: Framing,
    /// The PLC's own station as its register holds it; 1 to 247 answer.
    pub station: u16,
    /// What it serves.
    pub profile: &'static Profile,
}

/// The stations that a slave may have.
const STATIONS: core::ops::RangeInclusive<u8> = 1..=247;
/// The station that means all slaves.
pub(super) const BROADCAST: u8 = 0;

/// Answers a frame, which silence (RTU) or a line feed (ASCII) has ended; see the contract of [`crate::comm`].
pub fn answer(
    settings: &Settings,
    request: &[u8],
    map: &mut dyn Map,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let station = u8::try_from(settings.station)
        .ok()
        .filter(|station| STATIONS.contains(station))
        .ok_or(LineFault::Station)?;
    let body = Body::open(settings.framing, request)?;
    let to = body.byte(0).unwrap_or(BROADCAST);
    if to != station && to != BROADCAST {
        return Ok(());
    }
    let mut writer = Writer::serial(settings.framing, reply);
    writer.push(to);
    if to == BROADCAST {
        let function = body.byte(1).unwrap_or(0);
        let writes = [WRITE_COIL, WRITE_REGISTER, WRITE_COILS, WRITE_REGISTERS].contains(&function);
        let done = match writes {
            true => serve(settings.profile, function, body, map, &mut writer),
            false => Ok(()),
        };
        reply.clear();
        return done.map_err(Exception::fault);
    }
    let done = serve_or_refuse(settings.profile, body, map, &mut writer);
    writer.finish()?;
    done
}

/// Answers the request in `body`, from the station on, with data or with a refusal. The station is in the reply already.
pub(super) fn serve_or_refuse(
    profile: &Profile,
    body: Body,
    map: &mut dyn Map,
    reply: &mut Writer,
) -> Result<(), LineFault> {
    let function = body.byte(1).unwrap_or(0);
    serve(profile, function, body, map, reply).map_err(|why| {
        refuse(body, why, reply);
        why.fault()
    })
}

/// Makes a reply the refusal of the request in `body`.
pub(super) fn refuse(body: Body, why: Exception, reply: &mut Writer) {
    reply.restart();
    reply.push(body.byte(0).unwrap_or(0));
    reply.push(body.byte(1).unwrap_or(0) | REFUSED);
    reply.push(why.code());
}

/// Where the data of 0F and 10 begin.
const DATA: usize = 7;

/// Carries out a request. Nothing is written unless all of it can be.
fn serve(
    profile: &Profile,
    function: u8,
    body: Body,
    map: &mut dyn Map,
    reply: &mut Writer,
) -> Result<(), Exception> {
    let limits = profile.limits;
    match function {
        READ_COILS => read_bits(profile.coils, limits.read_bits, body, map, reply),
        READ_INPUTS => read_bits(profile.inputs, limits.read_bits, body, map, reply),
        READ_REGISTERS => read_words(profile.registers, limits.read_words, body, map, reply),
        READ_INPUT_REGISTERS => {
            let areas = profile.input_registers;
            read_words(areas, limits.read_words, body, map, reply)
        }
        WRITE_COIL => write_coil(profile, body, map, reply),
        WRITE_REGISTER => write_register(profile, body, map, reply),
        WRITE_COILS => write_coils(profile, body, map, reply),
        WRITE_REGISTERS => write_registers(profile, body, map, reply),
        _ => Err(Exception::Function),
    }
}

/// Address and quantity of a request, which has this many bytes and is about 1 to `most` devices.
fn range(body: Body, length: usize, most: u16) -> Result<(u16, u16), Exception> {
    match (body.word(2), body.word(4)) {
        (Some(first), Some(count)) if body.len() == length && (1..=most).contains(&count) => {
            Ok((first, count))
        }
        _ => Err(Exception::Value),
    }
}

/// Where the range and data of a request to write several end: quantity, number of bytes and length agree.
fn range_with_data(body: Body, most: u16, bits: bool) -> Result<(u16, u16), Exception> {
    let bytes = body.byte(DATA - 1).ok_or(Exception::Value)?;
    let (first, count) = range(body, DATA + usize::from(bytes), most)?;
    let needed = match bits {
        true => count.div_ceil(8),
        false => 2 * count,
    };
    if u16::from(bytes) == needed {
        Ok((first, count))
    } else {
        Err(Exception::Value)
    }
}

fn read_bits(
    areas: &'static [Area],
    most: u16,
    body: Body,
    map: &dyn Map,
    reply: &mut Writer,
) -> Result<(), Exception> {
    let (first, count) = range(body, 6, most)?;
    reply.push(body.byte(1).unwrap_or(0));
    reply.push(count.div_ceil(8) as u8);
    let bits = places(areas, first, count, false).map(|place| match place? {
        Place::Bit(class, n) => map.bit(class, n),
        _ => None,
    });
    reply.push_bits(bits).ok_or(Exception::Address)
}

fn read_words(
    areas: &'static [Area],
    most: u16,
    body: Body,
    map: &dyn Map,
    reply: &mut Writer,
) -> Result<(), Exception> {
    let (first, count) = range(body, 6, most)?;
    reply.push(body.byte(1).unwrap_or(0));
    reply.push((2 * count) as u8);
    for place in places(areas, first, count, false) {
        let word = place
            .and_then(|place| word(place, map))
            .ok_or(Exception::Address)?;
        reply.push_word(word);
    }
    Ok(())
}

/// The register at a place.
fn word(place: Place, map: &dyn Map) -> Option<u16> {
    match place {
        Place::Bit(..) => None,
        Place::Word(class, n) => map.word(class, n).map(|word| word as u16),
        Place::Half { counter, high } => {
            let halves = words(map.counter32(counter)?);
            Some(halves[usize::from(high)] as u16)
        }
        Place::Packed(class, first) => (0..16).try_fold(0, |word, bit| {
            Some(word | u16::from(map.bit(class, first + bit)?) << bit)
        }),
    }
}

/// Writes the register at a place.
fn set_word(place: Place, value: u16, map: &mut dyn Map) -> Option<()> {
    match place {
        Place::Bit(..) => None,
        Place::Word(class, n) => map.set_word(class, n, value as i16),
        Place::Half { counter, high } => {
            let [low, old_high] = words(map.counter32(counter)?);
            let value = value as i16;
            let whole = match high {
                true => pair(low, value),
                false => pair(value, old_high),
            };
            map.set_counter32(counter, whole)
        }
        Place::Packed(class, first) => {
            (0..16).try_for_each(|bit| map.set_bit(class, first + bit, value >> bit & 1 == 1))
        }
    }
}

/// Appends the first six bytes of the request after its station: the answer to a write.
fn confirm(body: Body, reply: &mut Writer) {
    (1..6)
        .filter_map(|at| body.byte(at))
        .for_each(|byte| reply.push(byte));
}

fn write_coil(
    profile: &Profile,
    body: Body,
    map: &mut dyn Map,
    reply: &mut Writer,
) -> Result<(), Exception> {
    let (Some(address), Some(value), 6) = (body.word(2), body.word(4), body.len()) else {
        return Err(Exception::Value);
    };
    if !profile.any_value_is_on && value != 0 && value != COIL_ON {
        return Err(Exception::Value);
    }
    match places(profile.coils, address, 1, true).next().flatten() {
        Some(Place::Bit(class, n)) if map.bit(class, n).is_some() => {
            map.set_bit(class, n, value != 0).ok_or(Exception::Address)
        }
        _ => Err(Exception::Address),
    }?;
    confirm(body, reply);
    Ok(())
}

fn write_register(
    profile: &Profile,
    body: Body,
    map: &mut dyn Map,
    reply: &mut Writer,
) -> Result<(), Exception> {
    let (Some(address), Some(value), 6) = (body.word(2), body.word(4), body.len()) else {
        return Err(Exception::Value);
    };
    let place = places(profile.registers, address, 1, true).next().flatten();
    let place = place
        .filter(|place| profile.counters_by_06 || !matches!(place, Place::Half { .. }))
        .filter(|&place| word(place, map).is_some())
        .ok_or(Exception::Address)?;
    set_word(place, value, map).ok_or(Exception::Address)?;
    confirm(body, reply);
    Ok(())
}

fn write_coils(
    profile: &Profile,
    body: Body,
    map: &mut dyn Map,
    reply: &mut Writer,
) -> Result<(), Exception> {
    let (first, count) = range_with_data(body, profile.limits.write_bits, true)?;
    let coils = || places(profile.coils, first, count, true);
    let all_there = coils()
        .all(|place| matches!(place, Some(Place::Bit(class, n)) if map.bit(class, n).is_some()));
    if !all_there {
        return Err(Exception::Address);
    }
    for (index, place) in coils().enumerate() {
        if let (Some(Place::Bit(class, n)), Some(on)) = (place, body.bit(DATA, index)) {
            map.set_bit(class, n, on).ok_or(Exception::Address)?;
        }
    }
    confirm(body, reply);
    Ok(())
}

fn write_registers(
    profile: &Profile,
    body: Body,
    map: &mut dyn Map,
    reply: &mut Writer,
) -> Result<(), Exception> {
    let (first, count) = range_with_data(body, profile.limits.write_words, false)?;
    let registers = || places(profile.registers, first, count, true);
    let all_there = registers().all(|place| place.is_some_and(|place| word(place, map).is_some()));
    if !all_there {
        return Err(Exception::Address);
    }
    for (index, place) in registers().enumerate() {
        if let (Some(place), Some(value)) = (place, body.word(DATA + 2 * index)) {
            set_word(place, value, map).ok_or(Exception::Address)?;
        }
    }
    confirm(body, reply);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comm::Served;
    use crate::comm::modbus::{Fill, H1U, H2U, HM, L01S, crc16};
    use crate::double::Double;
    use crate::{Class, Plc};
    use proptest::prelude::*;
    use std::vec::Vec;

    /// The answer of station 1 to a request without its CRC, without its CRC; and what the port notes.
    fn ask(
        profile: &'static Profile,
        plc: &mut Double,
        request: &[u8],
    ) -> (Vec<u8>, Result<(), LineFault>) {
        let mut frame = request.to_vec();
        frame.extend(crc16(request).to_le_bytes());
        let (mut reply, done) = ask_frame(Framing::Rtu, profile, plc, &frame);
        if let Some(body) = reply.len().checked_sub(2) {
            let crc = reply.split_off(body);
            assert_eq!(crc, crc16(&reply).to_le_bytes());
        }
        (reply, done)
    }

    fn ask_frame(
        framing: Framing,
        profile: &'static Profile,
        plc: &mut Double,
        request: &[u8],
    ) -> (Vec<u8>, Result<(), LineFault>) {
        let settings = Settings {
            framing,
            station: 1,
            profile,
        };
        let mut bytes = [0; 513];
        let mut reply = Frame::new(&mut bytes);
        let mut map = Served::new(plc, 0);
        let done = answer(&settings, request, &mut map, &mut reply);
        (reply.as_slice().to_vec(), done)
    }

    #[test]
    fn the_frames_that_the_manual_prints() {
        let mut plc = Double::new().with_d(100, &[0x5100]);
        let rtu = |plc: &mut Double, frame: &[u8]| ask_frame(Framing::Rtu, &H2U, plc, frame).0;
        assert_eq!(
            rtu(&mut plc, &[1, 3, 0, 0x64, 0, 1, 0xc5, 0xd5]),
            [1, 3, 2, 0x51, 0, 0x85, 0xd4]
        );
        assert_eq!(
            rtu(&mut plc, &[1, 3, 0xf0, 1, 0, 1, 0xe6, 0xca]),
            [1, 3, 2, 0, 0, 0xb8, 0x44]
        );
        assert_eq!(
            rtu(&mut plc, &[1, 3, 0xf8, 5, 0, 1, 0xa5, 0x6b]),
            [1, 0x83, 2, 0xc0, 0xf1]
        );
        let ascii = ask_frame(Framing::Ascii, &H2U, &mut plc, b":01030064000197\r\n").0;
        assert_eq!(ascii, b":0103025100A9\r\n");
    }

    #[test]
    fn the_frames_that_the_manual_of_l01s_prints() {
        let ten = [66, 77, 88, 88, 99, 55, 44, 33, 22, 11];
        let mut plc = Double::new()
            .with_d(100, &ten)
            .with_d(0, &[12, 23, 34, 56, 78, 99]);
        let rtu = |plc: &mut Double, frame: &[u8]| ask_frame(Framing::Rtu, &L01S, plc, frame).0;
        let read = rtu(&mut plc, &[1, 3, 0, 0x64, 0, 10, 0x84, 0x12]);
        assert_eq!(read[..5], [1, 3, 20, 0, 66]);
        assert_eq!(read[23..], [0x9f, 0xc7]);
        let read = rtu(&mut plc, &[1, 3, 0, 0, 0, 6, 0xc5, 0xc8]);
        assert_eq!(read[15..], [0xc4, 0x29]);
        let mut write = std::vec![1, 0x10, 0, 0x64, 0, 8, 16];
        (1..=8).for_each(|n| write.extend([0, 11 * n]));
        write.extend([0xd1, 0x6c]);
        assert_eq!(rtu(&mut plc, &write), [1, 0x10, 0, 0x64, 0, 8, 0x80, 0x10]);
        assert_eq!(plc.d(100, 8), [11, 22, 33, 44, 55, 66, 77, 88]);
    }

    #[test]
    fn counters_of_32_bits_take_two_registers() {
        let mut plc = Double::new();
        plc.set_counter32(205, 0x1234_5678);
        let (reply, _) = ask(&H2U, &mut plc, &[1, 3, 0xf7, 0x0a, 0, 2]);
        assert_eq!(reply, [1, 3, 4, 0x56, 0x78, 0x12, 0x34]);
        let write = [1, 0x10, 0xf7, 0x0b, 0, 1, 2, 0xab, 0xcd];
        assert_eq!(ask(&H2U, &mut plc, &write).0, write[..6]);
        assert_eq!(plc.counter32(205), Some(0xabcd_5678_u32 as i32));
        let by_06 = [1, 6, 0xf7, 0x0a, 0, 1];
        let refused = ask(&H2U, &mut plc, &by_06);
        assert_eq!(refused, (std::vec![1, 0x86, 2], Err(LineFault::Address)));
        assert_eq!(ask(&L01S, &mut plc, &[1, 6, 0xa4, 0x12, 0, 1]).0[1], 6);
        assert_eq!(plc.counter32(205), Some(0xabcd_0001_u32 as i32));
    }

    #[test]
    fn what_a_coil_is_written_with() {
        let mut plc = Double::new();
        assert_eq!(
            ask(&H2U, &mut plc, &[1, 5, 0, 10, 0, 1]).0,
            [1, 5, 0, 10, 0, 1]
        );
        assert_eq!(plc.bit(Class::M, 10), Some(true));
        let refused = ask(&L01S, &mut plc, &[1, 5, 0, 10, 0, 1]);
        assert_eq!(refused, (std::vec![1, 0x85, 3], Err(LineFault::Data)));
        let (reply, _) = ask(&H2U, &mut plc, &[1, 5, 0xf8, 0, 0xff, 0]);
        assert_eq!(reply, [1, 0x85, 2]);
        assert_eq!(plc.bit(Class::X, 0), Some(false));
    }

    #[test]
    fn requests_of_a_wrong_length_write_nothing() {
        let mut plc = Double::new();
        let refused: &[&[u8]] = &[
            &[1, 3, 0, 0, 0],
            &[1, 3, 0, 0, 0, 1, 0],
            &[1, 6, 0, 0, 1],
            &[1, 5, 0, 0, 0xff, 0, 0],
            &[1, 0x10, 0, 0, 0, 2, 3, 0, 1, 0, 2],
            &[1, 0x10, 0, 0, 0, 2, 4, 0, 1, 0],
            &[1, 0x0f, 0, 0, 0, 9, 1, 0xff],
            &[1, 0x0f, 0, 0, 0, 0, 0],
        ];
        for request in refused {
            let (reply, done) = ask(&H2U, &mut plc, request);
            assert_eq!(reply, [1, request[1] | 0x80, 3], "{request:?}");
            assert_eq!(done, Err(LineFault::Data));
        }
        assert_eq!(plc.d(0, 2), [0, 0]);
        assert_eq!(plc.bit(Class::M, 0), Some(false));
    }

    #[test]
    fn limits_are_those_of_the_model() {
        let mut plc = Double::new();
        for (profile, most) in [(&H2U, 125), (&H1U, 50), (&HM, 125)] {
            let first = if core::ptr::eq(profile, &HM) {
                0x0170_u16
            } else {
                0
            };
            let [high, low] = first.to_be_bytes();
            assert_eq!(ask(profile, &mut plc, &[1, 3, high, low, 0, most]).0[1], 3);
            let (reply, _) = ask(profile, &mut plc, &[1, 3, high, low, 0, most + 1]);
            assert_eq!(reply, [1, 0x83, 3]);
        }
    }

    #[test]
    fn a_broadcast_writes_and_is_not_answered() {
        let mut plc = Double::new();
        let write = ask(&H2U, &mut plc, &[0, 6, 0, 100, 0, 7]);
        assert_eq!(
            (write, plc.d(100, 1)),
            ((std::vec![], Ok(())), std::vec![7])
        );
        let read = ask(&H2U, &mut plc, &[0, 3, 0, 100, 0, 1]);
        assert_eq!(read, (std::vec![], Ok(())));
        let refused = ask(&H2U, &mut plc, &[0, 6, 0xff, 0xff, 0, 7]);
        assert_eq!(refused, (std::vec![], Err(LineFault::Address)));
    }

    #[test]
    fn frames_for_others_and_broken_frames_are_not_answered() {
        let mut plc = Double::new();
        let other = ask(&H2U, &mut plc, &[2, 6, 0, 100, 0, 7]);
        assert_eq!(other, (std::vec![], Ok(())));
        let swapped = [1, 3, 0, 0x64, 0, 1, 0xd5, 0xc5];
        let broken = ask_frame(Framing::Rtu, &H2U, &mut plc, &swapped);
        assert_eq!(broken, (std::vec![], Err(LineFault::Sum)));
        let settings = Settings {
            framing: Framing::Rtu,
            station: 248,
            profile: &H2U,
        };
        let mut reply = Frame::new(&mut []);
        let done = answer(
            &settings,
            &swapped,
            &mut Served::new(&mut plc, 0),
            &mut reply,
        );
        assert_eq!(done, Err(LineFault::Station));
    }

    /// A model with eight registers and eight relays, far from the first.
    static SMALL: Profile = Profile {
        coils: &[few(Class::M, Fill::Bits)],
        inputs: &[few(Class::X, Fill::Bits)],
        registers: &[few(Class::D, Fill::Words)],
        input_registers: &[few(Class::D, Fill::Words)],
        ..L01S
    };

    const fn few(class: Class, fill: Fill) -> Area {
        Area {
            address: 0x20,
            count: 8,
            class,
            first: 100,
            fill,
            writable: true,
        }
    }

    proptest! {
        /// Any bytes, with a right check or without: no panic, and no write outside of the map.
        #[test]
        fn any_request(
            body in prop::collection::vec(any::<u8>(), 0..260),
            function in 0u8..=0x11,
            address in 0u8..0x30,
            sealed: bool,
            digits: bool,
        ) {
            let mut frame = body;
            if let [station, code, high, low, ..] = &mut frame[..] && sealed {
                (*station, *code, *high, *low) = (*station & 1, function, 0, address);
                frame.extend(crc16(&frame).to_le_bytes());
            }
            let mut plc = Double::new();
            let framing = if digits { Framing::Ascii } else { Framing::Rtu };
            let _ = ask_frame(framing, &SMALL, &mut plc, &frame);
            prop_assert!(plc.d(0, 100).iter().chain(&plc.d(108, 100)).all(|&word| word == 0));
            let relays = (0..100).chain(108..2200);
            prop_assert!(relays.into_iter().all(|n| plc.bit(Class::M, n) == Some(false)));
        }
    }
}
