//! A frame that is being made, and the digits and sums that protocols share.

/// Characters of a frame in a buffer that somebody else owns. What does not fit is lost, and the frame says so
/// ([`Frame::overflows`]).
#[derive(Debug)]
pub struct Frame<'a> {
    bytes: &'a mut [u8],
    len: usize,
    overflows: bool,
    wait_ms: u16,
}

impl<'a> Frame<'a> {
    /// An empty frame of at most `bytes.len()` characters.
    pub fn new(bytes: &'a mut [u8]) -> Self {
        Frame {
            bytes,
            len: 0,
            overflows: false,
            wait_ms: 0,
        }
    }

    /// The frame is to be sent at least this many milliseconds after the request.
    pub fn wait(&mut self, ms: u16) {
        self.wait_ms = ms;
    }

    /// After how many milliseconds it may be sent.
    pub fn wait_ms(&self) -> u16 {
        self.wait_ms
    }

    /// Appends a character.
    #[inline(never)]
    pub fn push(&mut self, byte: u8) {
        match self.bytes.get_mut(self.len) {
            Some(place) => {
                *place = byte;
                self.len += 1;
            }
            None => self.overflows = true,
        }
    }

    /// Appends characters.
    pub fn extend(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.push(byte);
        }
    }

    /// Appends a word, high byte first.
    pub fn push_be16(&mut self, word: u16) {
        self.extend(&word.to_be_bytes());
    }

    /// Appends a word, low byte first.
    pub fn push_le16(&mut self, word: u16) {
        self.extend(&word.to_le_bytes());
    }

    /// Appends the lowest `count` (at most 8) hexadecimal digits of a value, the highest first, in upper case.
    pub fn push_hex(&mut self, value: u32, count: u32) {
        for place in (0..count.min(8)).rev() {
            self.push(digit((value >> (4 * place)) as u8));
        }
    }

    /// Replaces each character by its two hexadecimal digits, and puts `first` before them.
    pub fn spread(&mut self, first: u8) {
        let end = 1 + 2 * self.len;
        let Some(bytes) = self.bytes.get_mut(..end) else {
            self.overflows = true;
            return;
        };
        for at in (0..self.len).rev() {
            let byte = bytes[at];
            bytes[1 + 2 * at] = digit(byte >> 4);
            bytes[2 + 2 * at] = digit(byte);
        }
        bytes[0] = first;
        self.len = end;
    }

    /// Replaces the character at `index`, if the frame has one there.
    pub fn set(&mut self, index: usize, byte: u8) {
        if index < self.len {
            self.bytes[index] = byte;
        }
    }

    /// The characters so far.
    pub fn as_slice(&self) -> &[u8] {
        &self.bytes[..self.len]
    }

    /// The sum of the characters from `first` on, modulo 256.
    pub fn sum_from(&self, first: usize) -> u8 {
        let summed = self.as_slice().get(first..).unwrap_or(&[]);
        summed.iter().fold(0, |sum, &byte| sum.wrapping_add(byte))
    }

    /// Length in characters.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns true if it has no characters: silence.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Forgets the characters from `len` on.
    pub fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.len = 0;
        self.overflows = false;
    }

    /// Returns true if characters were lost because the buffer is full.
    pub fn overflows(&self) -> bool {
        self.overflows
    }
}

/// The hexadecimal digit of the lowest four bits, in upper case.
fn digit(value: u8) -> u8 {
    match value & 15 {
        value @ 0..=9 => b'0' + value,
        value => b'A' - 10 + value,
    }
}

/// The value of 1 to 8 hexadecimal digits, the highest first, in upper case; `None` for anything else.
pub fn hex_digits(digits: &[u8]) -> Option<u32> {
    if digits.is_empty() || digits.len() > 8 {
        return None;
    }
    digits.iter().try_fold(0, |value, &digit| {
        let digit = match digit {
            b'0'..=b'9' => digit - b'0',
            b'A'..=b'F' => digit - b'A' + 10,
            _ => return None,
        };
        Some(value << 4 | u32::from(digit))
    })
}

/// The byte that two hexadecimal digits at `at` stand for.
pub fn hex_byte(text: &[u8], at: usize) -> Option<u8> {
    let digits = text.get(at..at.checked_add(2)?)?;
    hex_digits(digits).map(|value| value as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_frame_says_that_it_overflows() {
        let mut bytes = [0; 4];
        let mut frame = Frame::new(&mut bytes);
        frame.push_hex(0x1af, 3);
        assert_eq!(frame.as_slice(), b"1AF");
        assert_eq!(frame.sum_from(1), b'A' + b'F');
        frame.push_be16(0x0203);
        assert_eq!(
            (frame.as_slice(), frame.overflows()),
            (&b"1AF\x02"[..], true)
        );
        frame.set(3, 9);
        frame.set(4, 9);
        assert_eq!(frame.as_slice(), b"1AF\x09");
        frame.clear();
        frame.push_le16(0x0203);
        assert_eq!((frame.as_slice(), frame.overflows()), (&[3, 2][..], false));
    }

    #[test]
    fn digits_are_read_in_upper_case_alone() {
        assert_eq!(hex_digits(b"01aF"), None);
        assert_eq!(hex_digits(b"01AF"), Some(0x1af));
        assert_eq!(hex_digits(b""), None);
        assert_eq!(hex_digits(b"FFFFFFFF"), Some(u32::MAX));
        assert_eq!(hex_byte(b"x7F", 1), Some(0x7f));
        assert_eq!(hex_byte(b"7", 0), None);
        assert_eq!(hex_byte(b"7", usize::MAX), None);
    }
}
