//! Answers of a slave.

use super::adu::{Bits, Body, Framing, LONGEST_RTU, close_ascii, close_rtu};
use super::areas::{Place, visit};
use super::function::{
    READ_COILS, READ_INPUT_REGISTERS, READ_INPUTS, READ_REGISTERS, REFUSED, WRITE_COIL,
    WRITE_COILS, WRITE_REGISTER, WRITE_REGISTERS,
};
use super::{Area, COIL_ON, Exception, Profile};
use crate::comm::{Frame, LineFault, Places};

/// Settings of a port as a slave.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// RTU or ASCII.
    pub framing: Framing,
    /// The PLC's own station as its register holds it; 1 to 247 answer.
    pub station: u16,
    /// Devices that it serves.
    pub profile: &'static Profile,
}

/// The stations that a slave may have.
const STATIONS: core::ops::RangeInclusive<u8> = 1..=247;
/// The station that means all slaves.
pub(super) const BROADCAST: u8 = 0;

/// Answers a frame, which silence (RTU) or a line feed (ASCII) has ended; see the contract of [`crate::comm`].
pub fn answer<M: Places + ?Sized>(
    settings: &Settings,
    request: &[u8],
    map: &mut M,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    match settings.framing {
        Framing::Rtu => answer_rtu(settings, request, map, reply),
        Framing::Ascii => answer_ascii(settings, request, map, reply),
    }
}

/// Answers an RTU frame, whatever the settings say.
pub(in crate::comm) fn answer_rtu<M: Places + ?Sized>(
    settings: &Settings,
    request: &[u8],
    map: &mut M,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let station = settings.station()?;
    let body = Body::open_rtu(request, settings.profile.shortest)?;
    let done = answer_body(settings.profile, station, body, map, reply);
    if !reply.is_empty() {
        close_rtu(reply)?;
    }
    done
}

/// Answers an ASCII frame, whatever the settings say.
pub(in crate::comm) fn answer_ascii<M: Places + ?Sized>(
    settings: &Settings,
    request: &[u8],
    map: &mut M,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let station = settings.station()?;
    let mut decoded = [0; LONGEST_RTU];
    let body = Body::open_ascii(request, settings.profile.shortest, &mut decoded)?;
    let done = answer_body(settings.profile, station, body, map, reply);
    if !reply.is_empty() {
        close_ascii(reply)?;
    }
    done
}

impl Settings {
    /// The station, if it may answer.
    fn station(&self) -> Result<u8, LineFault> {
        let station = u8::try_from(self.station).ok();
        let station = station.filter(|station| STATIONS.contains(station));
        station.ok_or(LineFault::Station)
    }
}

/// Answers the request in `body`, if it is for this station or for all, without check code.
fn answer_body<M: Places + ?Sized>(
    profile: &Profile,
    station: u8,
    body: Body,
    map: &mut M,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let [to, function] = [0, 1].map(|at| body.byte(at).unwrap_or(0));
    let to_all = to == BROADCAST
        && matches!(
            function,
            WRITE_COIL | WRITE_REGISTER | WRITE_COILS | WRITE_REGISTERS
        );
    if to != station && !to_all {
        return Ok(());
    }
    let done = serve_or_refuse(profile, body, map, reply);
    if to_all {
        reply.clear();
    }
    done
}

/// Answers the request in `body`, from the station on, with data or with a refusal after what is in the reply already.
pub(super) fn serve_or_refuse<M: Places + ?Sized>(
    profile: &Profile,
    body: Body,
    map: &mut M,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let begin = reply.len();
    serve(profile, body, map, reply).map_err(|why| {
        reply.truncate(begin);
        refuse(body, why, reply);
        why.fault()
    })
}

/// Appends the refusal of the request in `body`.
pub(super) fn refuse(body: Body, why: Exception, reply: &mut Frame) {
    let [station, function] = body.0.first_chunk().copied().unwrap_or_default();
    reply.extend(&[station, function | REFUSED, why.code()]);
}

/// Operation on the devices of a request, one after the other.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    /// They are read.
    Read,
    /// They are checked to exist.
    Check,
    /// They are written.
    Write,
}

/// Target of a request.
struct Request<'a> {
    areas: &'static [Area],
    /// The first address.
    first: u16,
    /// Number of addresses.
    count: u16,
    /// Coils rather than registers.
    bits: bool,
    /// Data to write; `None`: they are read.
    new: Option<&'a [u8]>,
}

impl<'a> Request<'a> {
    /// The request in `body`, whose quantity, number of bytes and length agree.
    #[inline(always)]
    fn of(profile: &Profile, body: Body<'a>) -> Result<Self, Exception> {
        let limits = &profile.limits;
        let function = body.byte(1).unwrap_or(0);
        let (areas, most) = match function {
            READ_COILS => (profile.coils, limits.read_bits),
            READ_INPUTS => (profile.inputs, limits.read_bits),
            READ_REGISTERS => (profile.registers, limits.read_words),
            READ_INPUT_REGISTERS => (profile.input_registers, limits.read_words),
            WRITE_COIL => (profile.coils, 1),
            WRITE_REGISTER => (profile.registers, 1),
            WRITE_COILS => (profile.coils, limits.write_bits),
            WRITE_REGISTERS => (profile.registers, limits.write_words),
            _ => return Err(Exception::Function),
        };
        let Some((&[_, _, high, low, upper, lower], rest)) = body.0.split_first_chunk() else {
            return Err(Exception::Value);
        };
        let word = u16::from_be_bytes([upper, lower]);
        let bits = matches!(
            function,
            READ_COILS | READ_INPUTS | WRITE_COIL | WRITE_COILS
        );
        let one = matches!(function, WRITE_COIL | WRITE_REGISTER);
        let several = matches!(function, WRITE_COILS | WRITE_REGISTERS);
        let count = if one { 1 } else { word };
        let bytes = bytes_of(count, bits);
        let (new, is_right) = match rest {
            [declared, new @ ..] if several => (
                Some(new),
                *declared == bytes && new.len() == usize::from(bytes),
            ),
            [] if one && bits => {
                let is_right = profile.any_value_is_on || matches!(word, 0 | COIL_ON);
                (Some(if word == 0 { &[0][..] } else { &[1] }), is_right)
            }
            [] if one => (body.0.get(4..), true),
            [] => (None, !several),
            _ => (None, false),
        };
        match is_right && (1..=most).contains(&count) {
            true => Ok(Request {
                areas,
                first: u16::from_be_bytes([high, low]),
                count,
                bits,
                new,
            }),
            false => Err(Exception::Value),
        }
    }

    /// New value of the address at an index.
    #[inline(always)]
    fn new_value(&self, index: u16) -> Option<u16> {
        let (new, index) = (Body(self.new?), usize::from(index));
        match self.bits {
            true => new.bit(0, index).map(u16::from),
            false => new.word(2 * index),
        }
    }
}

/// Number of data bytes for a quantity that is within the limits of a frame.
fn bytes_of(count: u16, bits: bool) -> u8 {
    match bits {
        true => count.div_ceil(8) as u8,
        false => count.wrapping_mul(2) as u8,
    }
}

/// Carries out a request. Nothing is written unless all of it can be.
fn serve<M: Places + ?Sized>(
    profile: &Profile,
    body: Body,
    map: &mut M,
    reply: &mut Frame,
) -> Result<(), Exception> {
    let request = Request::of(profile, body)?;
    // A write is confirmed by its first six bytes.
    let echoed = if request.new.is_none() { 2 } else { 6 };
    body.0
        .iter()
        .take(echoed)
        .for_each(|&byte| reply.push(byte));
    let no_half = body.byte(1) == Some(WRITE_REGISTER) && !profile.counters_by_06;
    let mut pass = Pass::Check;
    if request.new.is_none() {
        reply.push(bytes_of(request.count, request.bits));
        pass = Pass::Read;
    }
    let mut packed = Bits::new();
    loop {
        let writes = pass != Pass::Read;
        let done = visit(
            request.areas,
            request.first,
            request.count,
            writes,
            |index, place| {
                let new = match pass {
                    Pass::Write => Some(request.new_value(index)?),
                    Pass::Read | Pass::Check => None,
                };
                let value = map.exchange(place, new)?;
                match (pass, request.bits) {
                    (Pass::Read, true) => packed.push(value != 0, reply),
                    (Pass::Read, false) => reply.push_be16(value),
                    _ if no_half && matches!(place, Place::Half { .. }) => return None,
                    _ => {}
                }
                Some(())
            },
        );
        done.ok_or(Exception::Address)?;
        if pass != Pass::Check {
            packed.finish(reply);
            return Ok(());
        }
        pass = Pass::Write;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comm::Served;
    use crate::comm::modbus::{FX3U, Fill, H1U, H2U, HM, L01S, crc16};
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
    fn frames_of_four_bytes_are_requests_but_on_h1u_and_h2u() {
        let mut plc = Double::new();
        for profile in [&L01S, &HM, &FX3U] {
            let refused = (std::vec![1, 0x87, 1], Err(LineFault::Command));
            assert_eq!(ask(profile, &mut plc, &[1, 7]), refused);
        }
        for profile in [&H1U, &H2U] {
            let dropped = (std::vec![], Err(LineFault::Length));
            assert_eq!(ask(profile, &mut plc, &[1, 7]), dropped);
        }
        let ascii =
            |profile| ask_frame(Framing::Ascii, profile, &mut Double::new(), b":0107F8\r\n");
        assert_eq!(ascii(&L01S).0, b":01870177\r\n");
        assert_eq!(ascii(&H2U), (std::vec![], Err(LineFault::Length)));
        assert_eq!(ask(&L01S, &mut plc, &[1]).1, Err(LineFault::Length));
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
