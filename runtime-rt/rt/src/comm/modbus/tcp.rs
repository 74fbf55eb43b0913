//! Modbus TCP: the answers of a slave, with the header of the public standard ("MODBUS messaging on TCP/IP" 1.0b).

use super::adu::{Body, fits};
use super::slave::{refuse, serve_or_refuse};
use super::{Exception, Profile};
use crate::comm::{Cut, Frame, LineFault, Map};

/// Offset of the length of a frame.
const LENGTH: usize = 4;
/// Bytes before the unit of a frame.
const HEADER: usize = UNIT;

/// Offset of the unit of a frame.
pub const UNIT: usize = 6;

/// The longest frame.
pub const LONGEST: usize = 260;

/// Decides whether the characters so far form a frame. After [`Cut::Drop`] the connection is unusable: the beginning of
/// the next frame is unknown.
pub fn cut(received: &[u8]) -> Cut {
    let word = |at: usize| match received.get(at..at + 2) {
        Some(&[high, low]) => Some(u16::from_be_bytes([high, low])),
        _ => None,
    };
    // Protocol, then the length of what follows: at least unit and function.
    match (word(2), word(4).map(usize::from)) {
        (Some(1..), _) => Cut::Drop,
        (_, Some(length)) if !(2..=LONGEST - HEADER).contains(&length) => Cut::Drop,
        (_, Some(length)) if received.len() == HEADER + length => Cut::Whole,
        (_, Some(length)) if received.len() > HEADER + length => Cut::Drop,
        _ => Cut::More,
    }
}

/// Answers a frame that [`cut`] has found whole.
pub fn answer<M: Map + ?Sized>(
    profile: &Profile,
    request: &[u8],
    map: &mut M,
    reply: &mut Frame,
) -> Result<(), LineFault> {
    let (transaction, body) = match request {
        [high, low, _, _, _, _, body @ ..] if cut(request) == Cut::Whole => {
            ([*high, *low], Body(body))
        }
        _ => return Err(LineFault::Form),
    };
    begin(transaction, reply);
    let unit = body.byte(0).unwrap_or(0);
    let done = if map.takes_unit(unit) {
        serve_or_refuse(profile, body, map, reply)
    } else {
        refuse(body, Exception::NO_PATH, reply);
        Err(Exception::NO_PATH.fault())
    };
    close(reply)?;
    done
}

/// Begins a frame: protocol 0, and a length that [`close`] fills in.
pub(super) fn begin(transaction: [u8; 2], frame: &mut Frame) {
    frame.extend(&transaction);
    frame.extend(&[0; HEADER - 2]);
}

/// Fills in the length of a frame that is complete.
pub(super) fn close(frame: &mut Frame) -> Result<(), LineFault> {
    let length = frame.len().saturating_sub(HEADER) as u16;
    for (at, byte) in (LENGTH..).zip(length.to_be_bytes()) {
        frame.set(at, byte);
    }
    fits(frame)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comm::Served;
    use crate::comm::modbus::H2U;
    use crate::double::Double;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn ask(request: &[u8]) -> Vec<u8> {
        let mut plc = Double::new().with_d(100, &[0x1234, -2]);
        let mut bytes = [0; LONGEST];
        let mut reply = Frame::new(&mut bytes);
        let _ = answer(&H2U, request, &mut Served::new(&mut plc, 0), &mut reply);
        reply.as_slice().to_vec()
    }

    #[test]
    fn the_header_comes_back_with_the_new_length() {
        let reply = ask(&[0xab, 1, 0, 0, 0, 6, 255, 3, 0, 0x64, 0, 2]);
        assert_eq!(
            reply,
            [0xab, 1, 0, 0, 0, 7, 255, 3, 4, 0x12, 0x34, 0xff, 0xfe]
        );
        let refused = ask(&[0, 1, 0, 0, 0, 6, 1, 3, 0xf8, 5, 0, 1]);
        assert_eq!(refused, [0, 1, 0, 0, 0, 3, 1, 0x83, 2]);
        let nobody = ask(&[0, 1, 0, 0, 0, 6, 9, 3, 0, 0x64, 0, 2]);
        assert_eq!(nobody, [0, 1, 0, 0, 0, 3, 9, 0x83, 0x0a]);
        assert_eq!(
            ask(&[0, 1, 0, 0, 0, 2, 1, 3]),
            [0, 1, 0, 0, 0, 3, 1, 0x83, 3]
        );
    }

    #[test]
    fn a_broken_header_ends_the_connection() {
        assert_eq!(cut(&[0, 1, 0]), Cut::More);
        assert_eq!(cut(&[0, 1, 0, 7]), Cut::Drop);
        assert_eq!(cut(&[0, 1, 0, 0, 0, 1]), Cut::Drop);
        assert_eq!(cut(&[0, 1, 0, 0, 1, 0]), Cut::Drop);
        assert_eq!(cut(&[0, 1, 0, 0, 0, 2, 1]), Cut::More);
        assert_eq!(cut(&[0, 1, 0, 0, 0, 2, 1, 3]), Cut::Whole);
    }

    proptest! {
        #[test]
        fn any_bytes_are_answered_or_dropped(request in prop::collection::vec(any::<u8>(), 0..300)) {
            let reply = ask(&request);
            prop_assert_eq!(reply.is_empty(), cut(&request) != Cut::Whole);
        }
    }
}
