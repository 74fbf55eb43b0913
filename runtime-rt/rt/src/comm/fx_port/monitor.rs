//! The monitor list: devices that a client names once and samples as often as it likes.

use crate::comm::Memory;

/// Bytes before the first address: number of words, a mark, number of bits.
const HEAD: u32 = 4;

/// A list, at addresses 1400h to 178Fh: byte 0 is the number of words, byte 1 a mark (81h), bytes 2 and 3 the number of
/// bits; then follow the byte addresses of the words and the numbers of the bits, the low byte of each first.
pub(super) struct MonitorList<'a>(pub(super) &'a mut Memory);

impl MonitorList<'_> {
    /// A byte of the list.
    pub(super) fn byte(&self, index: u32) -> Option<u8> {
        self.0.0.get(index as usize).copied()
    }

    /// Writes a byte of the list.
    pub(super) fn set(&mut self, index: u32, value: u8) {
        if let Some(byte) = self.0.0.get_mut(index as usize) {
            *byte = value;
        }
    }

    /// The two bytes at `index`, the low one first; 0 beyond the list.
    fn word(&self, index: u32) -> u16 {
        let byte = |index| u16::from(self.byte(index).unwrap_or(0));
        byte(index) | byte(index + 1) << 8
    }

    /// Number of sampled words.
    pub(super) fn words(&self) -> u32 {
        self.byte(0).unwrap_or(0).into()
    }

    /// Byte address of a word.
    pub(super) fn address(&self, index: u32) -> u32 {
        self.word(HEAD + 2 * index).into()
    }

    /// Number of a bit.
    pub(super) fn bit(&self, index: u32) -> Option<u16> {
        (index < u32::from(self.word(2))).then(|| self.word(HEAD + 2 * (self.words() + index)))
    }
}
