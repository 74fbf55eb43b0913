//! Reading of fields that follow each other in a file.

/// The next field of some bytes, numbers with their lowest byte first.
#[derive(Clone)]
pub(super) struct Fields<'b> {
    bytes: &'b [u8],
    at: usize,
}

impl<'b> Fields<'b> {
    /// Fields from the beginning of `bytes`.
    pub fn new(bytes: &'b [u8]) -> Self {
        Fields { bytes, at: 0 }
    }

    /// Offset of the next field.
    pub fn at(&self) -> usize {
        self.at
    }

    /// The next `count` bytes.
    pub fn take(&mut self, count: usize) -> Option<&'b [u8]> {
        let taken = self.bytes.get(self.at..self.at.checked_add(count)?)?;
        self.at += count;
        Some(taken)
    }

    /// The fields of the next `count` bytes, whose offsets are those of the file.
    pub fn inside(&mut self, count: usize) -> Option<Fields<'b>> {
        let at = self.at;
        self.take(count)?;
        Some(Fields {
            bytes: &self.bytes[..self.at],
            at,
        })
    }

    /// The bytes that have not been read.
    pub fn rest(&self) -> &'b [u8] {
        &self.bytes[self.at..]
    }

    /// What `read` takes, if it is right; if not, the next field is the same.
    pub fn checked<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Option<T>,
        is_right: impl FnOnce(&T) -> bool,
    ) -> Option<T> {
        let start = self.at;
        let value = read(self)?;
        if is_right(&value) {
            return Some(value);
        }
        self.at = start;
        None
    }

    pub fn u8(&mut self) -> Option<u8> {
        self.take(1).map(|bytes| bytes[0])
    }

    pub fn u16(&mut self) -> Option<u16> {
        Some(u16::from_le_bytes(self.take(2)?.try_into().ok()?))
    }

    pub fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    /// A string of GX Works2: the number of its characters with the closing zero, then UTF-16.
    pub fn text(&mut self) -> Option<String> {
        let length = self.u32()? as usize;
        let bytes = self.take(length.checked_mul(2)?)?;
        let units = bytes
            .chunks_exact(2)
            .map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
        let text: String = char::decode_utf16(units.take_while(|&unit| unit != 0))
            .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect();
        Some(text)
    }

    /// A string as [`Fields::text`] that is certain to be one. If it is not, the next field is the first wrong unit:
    /// one that is not part of a character, a control character other than a tab or line end, a zero before the end, or
    /// the end without a zero.
    pub fn whole_text(&mut self) -> Option<String> {
        let start = self.at;
        let text = self.text()?;
        let first = start + 4;
        let count = (self.at - first) / 2;
        let is_wrong = |c: char| {
            c == char::REPLACEMENT_CHARACTER || c.is_control() && !matches!(c, '\t' | '\r' | '\n')
        };
        let units = |text: &str| text.encode_utf16().count();
        let wrong = match text.find(is_wrong) {
            Some(at) => Some(units(&text[..at])),
            None => Some(units(&text)).filter(|&length| count > 0 && length + 1 != count),
        };
        match wrong {
            None => Some(text),
            Some(unit) => {
                self.at = first + 2 * unit;
                None
            }
        }
    }
}
