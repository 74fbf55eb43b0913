//! Frames around Modbus requests and replies: the parts before and after the function and its data.

use super::check::{CRC_START, crc_step, crc16};
use crate::comm::{Cut, Frame, LineFault, hex_byte};

/// How requests and replies are wrapped on a serial line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Framing {
    /// Bytes as they are, and a CRC; a frame ends after 3.5 characters of silence.
    #[default]
    Rtu,
    /// Two digits for each byte, between a colon and CR LF, and a sum.
    Ascii,
}

/// The shortest RTU frame: anything below is a wrong length (h1u-h2u-programming §8.1, 63x1).
const SHORTEST_RTU: usize = 5;
/// The longest RTU frame.
pub const LONGEST_RTU: usize = 256;
/// The longest ASCII frame.
pub const LONGEST_ASCII: usize = 513;

/// Whether the characters so far are an ASCII frame. A colon begins one wherever it comes.
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
pub(super) enum Body<'a> {
    /// As they are.
    Bytes(&'a [u8]),
    /// As digits, of which all are hexadecimal and the number is even.
    Digits(&'a [u8]),
}

impl<'a> Body<'a> {
    /// Takes a serial frame apart. A damaged frame is not answered.
    pub fn open(framing: Framing, frame: &'a [u8]) -> Result<Self, LineFault> {
        match framing {
            Framing::Rtu => Self::open_rtu(frame),
            Framing::Ascii => Self::open_ascii(frame),
        }
    }

    fn open_rtu(frame: &'a [u8]) -> Result<Self, LineFault> {
        if !(SHORTEST_RTU..=LONGEST_RTU).contains(&frame.len()) {
            return Err(LineFault::Length);
        }
        let (body, crc) = frame.split_at(frame.len() - 2);
        if crc != crc16(body).to_le_bytes() {
            return Err(LineFault::Sum);
        }
        Ok(Body::Bytes(body))
    }

    fn open_ascii(frame: &'a [u8]) -> Result<Self, LineFault> {
        let digits = frame
            .strip_prefix(b":")
            .and_then(|rest| rest.strip_suffix(b"\r\n"))
            .ok_or(LineFault::Form)?;
        let whole = Body::Digits(digits);
        // The same bytes as in RTU, with one byte of check code rather than two.
        if digits.len() % 2 == 1 || whole.len() < SHORTEST_RTU - 1 || frame.len() > LONGEST_ASCII {
            return Err(LineFault::Length);
        }
        let sum = (0..whole.len()).try_fold(0u8, |sum, n| Some(sum.wrapping_add(whole.byte(n)?)));
        match sum {
            Some(0) => Ok(Body::Digits(&digits[..digits.len() - 2])),
            Some(_) => Err(LineFault::Sum),
            None => Err(LineFault::Form),
        }
    }

    /// How many bytes there are.
    pub fn len(&self) -> usize {
        match self {
            Body::Bytes(bytes) => bytes.len(),
            Body::Digits(digits) => digits.len() / 2,
        }
    }

    /// The byte at `at`.
    pub fn byte(&self, at: usize) -> Option<u8> {
        match self {
            Body::Bytes(bytes) => bytes.get(at).copied(),
            Body::Digits(digits) => hex_byte(digits, at.checked_mul(2)?),
        }
    }

    /// The word at `at`, high byte first.
    pub fn word(&self, at: usize) -> Option<u16> {
        Some(u16::from_be_bytes([
            self.byte(at)?,
            self.byte(at.checked_add(1)?)?,
        ]))
    }

    /// Whether the bit at `index`, counted from the lowest of the byte at `first`, is on.
    pub fn bit(&self, first: usize, index: usize) -> Option<bool> {
        let byte = self.byte(first.checked_add(index / 8)?)?;
        Some(byte >> (index % 8) & 1 == 1)
    }
}

/// What wraps a frame that is being made.
#[derive(Clone, Copy, Debug)]
enum Wrap {
    Serial(Framing),
    /// Modbus TCP, under this transaction number.
    Tcp(u16),
}

/// Where the length of a Modbus TCP frame is.
const TCP_LENGTH: usize = 4;
/// Bytes before the unit of a Modbus TCP frame.
pub(super) const TCP_HEADER: usize = 6;

/// A frame that is being made, from the station number on.
pub(super) struct Writer<'w, 'f> {
    frame: &'w mut Frame<'f>,
    wrap: Wrap,
    crc: u16,
    sum: u8,
}

impl<'w, 'f> Writer<'w, 'f> {
    /// Begins a serial frame.
    pub fn serial(framing: Framing, frame: &'w mut Frame<'f>) -> Self {
        Self::begin(Wrap::Serial(framing), frame)
    }

    /// Begins a Modbus TCP frame.
    pub fn tcp(transaction: u16, frame: &'w mut Frame<'f>) -> Self {
        Self::begin(Wrap::Tcp(transaction), frame)
    }

    fn begin(wrap: Wrap, frame: &'w mut Frame<'f>) -> Self {
        let mut writer = Writer {
            frame,
            wrap,
            crc: CRC_START,
            sum: 0,
        };
        writer.restart();
        writer
    }

    /// Forgets what has been appended.
    pub fn restart(&mut self) {
        self.frame.clear();
        self.crc = CRC_START;
        self.sum = 0;
        match self.wrap {
            Wrap::Serial(Framing::Rtu) => {}
            Wrap::Serial(Framing::Ascii) => self.frame.push(b':'),
            // Protocol 0; the length is filled in at the end.
            Wrap::Tcp(transaction) => [transaction, 0, 0]
                .into_iter()
                .for_each(|word| self.frame.push_be16(word)),
        }
    }

    /// Appends a byte.
    pub fn push(&mut self, byte: u8) {
        match self.wrap {
            Wrap::Serial(Framing::Ascii) => self.frame.push_hex(byte.into(), 2),
            _ => self.frame.push(byte),
        }
        self.crc = crc_step(self.crc, byte);
        self.sum = self.sum.wrapping_add(byte);
    }

    /// Appends a word, high byte first.
    pub fn push_word(&mut self, word: u16) {
        word.to_be_bytes()
            .into_iter()
            .for_each(|byte| self.push(byte));
    }

    /// Appends bits, eight to a byte, the first the lowest; those that fill the last byte are 0. Ends at the first that is not there.
    pub fn push_bits(&mut self, bits: impl Iterator<Item = Option<bool>>) -> Option<()> {
        let (mut byte, mut count) = (0, 0);
        for bit in bits {
            byte |= u8::from(bit?) << count;
            count += 1;
            if count == 8 {
                self.push(byte);
                (byte, count) = (0, 0);
            }
        }
        if count > 0 {
            self.push(byte);
        }
        Some(())
    }

    /// Appends the check code. A frame that does not fit is none at all.
    pub fn finish(self) -> Result<(), LineFault> {
        match self.wrap {
            Wrap::Serial(Framing::Rtu) => self.frame.push_le16(self.crc),
            Wrap::Serial(Framing::Ascii) => {
                self.frame.push_hex(self.sum.wrapping_neg().into(), 2);
                self.frame.extend(b"\r\n");
            }
            Wrap::Tcp(_) => {
                let length = self.frame.len().saturating_sub(TCP_HEADER) as u16;
                for (at, byte) in (TCP_LENGTH..).zip(length.to_be_bytes()) {
                    self.frame.set(at, byte);
                }
            }
        }
        if self.frame.overflows() {
            self.frame.clear();
            return Err(LineFault::Overflow);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// What `cut` says after each character of `text`.
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
    fn faults_of_frames_are_told_apart() {
        let rtu = |frame: &[u8]| Body::open(Framing::Rtu, frame).map(|body| body.len());
        assert_eq!(rtu(&[1, 3, 0, 0x64, 0, 1, 0xc5, 0xd5]), Ok(6));
        assert_eq!(rtu(&[1, 3, 0, 0x64, 0, 1, 0xd5, 0xc5]), Err(LineFault::Sum));
        assert_eq!(rtu(&[0xff]), Err(LineFault::Length));
        assert_eq!(rtu(&[0; LONGEST_RTU + 1]), Err(LineFault::Length));
        let ascii = |frame: &[u8]| Body::open(Framing::Ascii, frame).map(|body| body.len());
        assert_eq!(ascii(b":01030064000197\r\n"), Ok(6));
        assert_eq!(ascii(b":01030064000198\r\n"), Err(LineFault::Sum));
        assert_eq!(ascii(b":0103006400019\r\n"), Err(LineFault::Length));
        assert_eq!(ascii(b":010300G4000197\r\n"), Err(LineFault::Form));
        assert_eq!(ascii(b":01030064000197\n"), Err(LineFault::Form));
        assert_eq!(ascii(b":\r\n"), Err(LineFault::Length));
    }

    #[test]
    fn a_frame_that_does_not_fit_is_not_sent() {
        let mut bytes = [0; 4];
        let mut frame = Frame::new(&mut bytes);
        let mut writer = Writer::serial(Framing::Rtu, &mut frame);
        [1, 2, 3].into_iter().for_each(|byte| writer.push(byte));
        assert_eq!(writer.finish(), Err(LineFault::Overflow));
        assert!(frame.is_empty());
    }
}
