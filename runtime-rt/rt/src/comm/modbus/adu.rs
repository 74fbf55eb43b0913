//! Frames around Modbus requests and replies: the parts before and after the function and its data.

use super::check::crc16;
use crate::comm::{Cut, Frame, LineFault, hex_byte};

/// Framing of requests and replies on a serial line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Framing {
    /// Bytes as they are, and a CRC; a frame ends after 3.5 characters of silence.
    #[default]
    Rtu,
    /// Two digits for each byte, between a colon and CR LF, and a sum.
    Ascii,
}

/// The shortest RTU frame of an answer: anything below is a wrong length.
const SHORTEST_ANSWER: usize = 5;
/// The longest RTU frame.
pub const LONGEST_RTU: usize = 256;
/// The longest ASCII frame.
pub const LONGEST_ASCII: usize = 513;

/// Decides whether the characters so far form an ASCII frame. A colon begins one wherever it comes.
pub fn cut_ascii(received: &[u8]) -> Cut {
    match (received.first(), received.last()) {
        (_, Some(b':')) => Cut::Restart,
        (Some(b':'), Some(b'\n')) => Cut::Whole,
        (Some(b':'), _) if received.len() < LONGEST_ASCII => Cut::More,
        _ => Cut::Drop,
    }
}

/// The bytes of a frame, from the station number on, without check code.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body<'a>(pub &'a [u8]);

impl<'a> Body<'a> {
    /// Takes an answer apart; the bytes of an ASCII frame come to be in `decoded`. A damaged frame is not answered.
    pub fn open(
        framing: Framing,
        frame: &'a [u8],
        decoded: &'a mut [u8; LONGEST_RTU],
    ) -> Result<Self, LineFault> {
        match framing {
            Framing::Rtu => Self::open_rtu(frame, SHORTEST_ANSWER),
            Framing::Ascii => Self::open_ascii(frame, SHORTEST_ANSWER, decoded),
        }
    }

    /// Takes an RTU frame apart, which has at least `shortest` bytes.
    pub fn open_rtu(frame: &'a [u8], shortest: usize) -> Result<Self, LineFault> {
        if !(shortest..=LONGEST_RTU).contains(&frame.len()) {
            return Err(LineFault::Length);
        }
        // The check code of a frame with its check code is 0.
        match (crc16(frame), frame) {
            (0, [body @ .., _, _]) => Ok(Body(body)),
            _ => Err(LineFault::Sum),
        }
    }

    /// Takes an ASCII frame apart, which would have at least `shortest` bytes in RTU.
    pub fn open_ascii(
        frame: &[u8],
        shortest: usize,
        decoded: &'a mut [u8; LONGEST_RTU],
    ) -> Result<Self, LineFault> {
        let digits = frame
            .strip_prefix(b":")
            .and_then(|rest| rest.strip_suffix(b"\r\n"))
            .ok_or(LineFault::Form)?;
        let length = digits.len() / 2;
        // The same bytes as in RTU, with one byte of check code rather than two.
        if digits.len() % 2 == 1 || length < shortest - 1 || frame.len() > LONGEST_ASCII {
            return Err(LineFault::Length);
        }
        let mut sum = 0u8;
        for (at, place) in (0..length).zip(&mut *decoded) {
            *place = hex_byte(digits, 2 * at).ok_or(LineFault::Form)?;
            sum = sum.wrapping_add(*place);
        }
        match decoded.get(..length - 1) {
            Some(body) if sum == 0 => Ok(Body(body)),
            _ => Err(LineFault::Sum),
        }
    }

    /// Length in bytes.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The byte at `at`.
    pub fn byte(&self, at: usize) -> Option<u8> {
        self.0.get(at).copied()
    }

    /// The word at `at`, high byte first.
    pub fn word(&self, at: usize) -> Option<u16> {
        match self.0.get(at..) {
            Some(&[high, low, ..]) => Some(u16::from_be_bytes([high, low])),
            _ => None,
        }
    }

    /// The bit at `index`, counted from the lowest of the byte at `first`.
    pub fn bit(&self, first: usize, index: usize) -> Option<bool> {
        let byte = self.byte(first.checked_add(index / 8)?)?;
        Some(byte >> (index % 8) & 1 == 1)
    }
}

/// Makes a serial frame of the bytes from the station number on. One that does not fit is none at all.
pub(super) fn close(framing: Framing, frame: &mut Frame) -> Result<(), LineFault> {
    match framing {
        Framing::Rtu => close_rtu(frame),
        Framing::Ascii => close_ascii(frame),
    }
}

/// Appends the check code of an RTU frame.
pub(super) fn close_rtu(frame: &mut Frame) -> Result<(), LineFault> {
    frame.push_le16(crc16(frame.as_slice()));
    fits(frame)
}

/// Appends the sum, and replaces the bytes by an ASCII frame.
pub(super) fn close_ascii(frame: &mut Frame) -> Result<(), LineFault> {
    frame.push(frame.sum_from(0).wrapping_neg());
    frame.spread(b':');
    frame.extend(b"\r\n");
    fits(frame)
}

/// Forgets a frame that does not fit.
pub(super) fn fits(frame: &mut Frame) -> Result<(), LineFault> {
    if frame.overflows() {
        frame.clear();
        return Err(LineFault::Overflow);
    }
    Ok(())
}

/// Appends bits, eight to a byte, the first the lowest; those that fill the last byte are 0.
pub(super) struct Bits {
    byte: u8,
    count: u8,
}

impl Bits {
    /// None yet.
    pub const fn new() -> Self {
        Bits { byte: 0, count: 0 }
    }

    /// Appends one.
    pub fn push(&mut self, bit: bool, frame: &mut Frame) {
        self.byte |= u8::from(bit) << self.count;
        self.count += 1;
        if self.count == 8 {
            self.finish(frame);
        }
    }

    /// Appends those that do not fill a byte.
    pub fn finish(&mut self, frame: &mut Frame) {
        if self.count > 0 {
            frame.push(self.byte);
        }
        *self = Self::new();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// Results of `cut` after each character of `text`.
    fn cuts(text: &[u8]) -> Vec<Cut> {
        (1..=text.len())
            .map(|end| cut_ascii(&text[..end]))
            .collect()
    }

    #[test]
    fn a_colon_begins_a_frame_and_a_line_feed_ends_it() {
        use Cut::{Drop, More, Restart, Whole};
        assert_eq!(cuts(b":01\r\n"), [Restart, More, More, More, Whole]);
        assert_eq!(cuts(b"0"), [Drop]);
        assert_eq!(cuts(b"\n"), [Drop]);
        assert_eq!(cuts(b":0:"), [Restart, More, Restart]);
        let mut long = std::vec![b'0'; LONGEST_ASCII];
        long[0] = b':';
        assert_eq!(cut_ascii(&long), Drop);
        long[LONGEST_ASCII - 1] = b'\n';
        assert_eq!(cut_ascii(&long), Whole);
    }

    #[test]
    fn faults_of_frames_are_distinguished() {
        let length = |framing: Framing, frame: &[u8]| {
            let mut decoded = [0; LONGEST_RTU];
            Body::open(framing, frame, &mut decoded).map(|body| body.len())
        };
        let rtu = |frame: &[u8]| length(Framing::Rtu, frame);
        assert_eq!(rtu(&[1, 3, 0, 0x64, 0, 1, 0xc5, 0xd5]), Ok(6));
        assert_eq!(rtu(&[1, 3, 0, 0x64, 0, 1, 0xd5, 0xc5]), Err(LineFault::Sum));
        assert_eq!(rtu(&[0xff]), Err(LineFault::Length));
        assert_eq!(rtu(&[0; LONGEST_RTU + 1]), Err(LineFault::Length));
        let ascii = |frame: &[u8]| length(Framing::Ascii, frame);
        assert_eq!(ascii(b":01030064000197\r\n"), Ok(6));
        assert_eq!(ascii(b":01030064000198\r\n"), Err(LineFault::Sum));
        assert_eq!(ascii(b":0103006400019\r\n"), Err(LineFault::Length));
        assert_eq!(ascii(b":010300G4000197\r\n"), Err(LineFault::Form));
        assert_eq!(ascii(b":01030064000197\n"), Err(LineFault::Form));
        assert_eq!(ascii(b":\r\n"), Err(LineFault::Length));
    }

    #[test]
    fn a_frame_that_does_not_fit_is_not_sent() {
        for (framing, room) in [(Framing::Rtu, 4), (Framing::Ascii, 10)] {
            let mut bytes = [0; 16];
            let mut frame = Frame::new(&mut bytes[..room]);
            frame.extend(&[1, 2, 3]);
            assert_eq!(close(framing, &mut frame), Err(LineFault::Overflow));
            assert!(frame.is_empty());
            let mut frame = Frame::new(&mut bytes[..room + 1]);
            frame.extend(&[1, 2, 3]);
            assert_eq!(close(framing, &mut frame), Ok(()));
            assert_eq!(frame.len(), room + 1);
        }
    }
}
