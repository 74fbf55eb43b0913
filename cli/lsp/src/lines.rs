//! Positions in a text, in the units that an editor counts in.

use gen_lsp_types::{GeneralClientCapabilities, Position, PositionEncodingKind};

/// Units of columns.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum Encoding {
    /// Bytes.
    Utf8,
    /// Units of UTF-16, which every editor knows.
    #[default]
    Utf16,
    /// Characters.
    Utf32,
}

impl Encoding {
    /// The units in which nothing has to be converted, if the editor offers them, or else the editor's first choice.
    pub(crate) fn negotiated(general: Option<&GeneralClientCapabilities>) -> Self {
        let offered = general.and_then(|general| general.position_encodings.as_deref());
        let offered = offered.unwrap_or_default();
        let known = |kind: &PositionEncodingKind| match kind {
            PositionEncodingKind::UTF8 => Some(Encoding::Utf8),
            PositionEncodingKind::UTF16 => Some(Encoding::Utf16),
            PositionEncodingKind::UTF32 => Some(Encoding::Utf32),
            PositionEncodingKind::Custom(_) => None,
        };
        match offered.contains(&PositionEncodingKind::UTF8) {
            true => Encoding::Utf8,
            false => offered.iter().find_map(known).unwrap_or_default(),
        }
    }

    /// Its name in the protocol.
    pub(crate) fn kind(self) -> PositionEncodingKind {
        match self {
            Encoding::Utf8 => PositionEncodingKind::UTF8,
            Encoding::Utf16 => PositionEncodingKind::UTF16,
            Encoding::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    /// Units of a character.
    fn units(self, c: char) -> u32 {
        let units = match self {
            Encoding::Utf8 => c.len_utf8(),
            Encoding::Utf16 => c.len_utf16(),
            Encoding::Utf32 => 1,
        };
        units as u32
    }

    /// Units of a text.
    pub(crate) fn length(self, text: &str) -> u32 {
        match self {
            Encoding::Utf8 => text.len() as u32,
            Encoding::Utf16 | Encoding::Utf32 if text.is_ascii() => text.len() as u32,
            Encoding::Utf16 | Encoding::Utf32 => text.chars().map(|c| self.units(c)).sum(),
        }
    }
}

/// Beginnings of lines. A line ends as the protocol says: with a line feed, a carriage return, or both.
#[derive(Clone, Debug)]
pub(crate) struct Lines {
    starts: Vec<u32>,
    encoding: Encoding,
}

impl Lines {
    /// Finds the lines of a text.
    pub(crate) fn of(text: &str, encoding: Encoding) -> Self {
        let bytes = text.as_bytes();
        let ends = bytes.iter().enumerate().filter(|(at, byte)| match byte {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        });
        let starts = ends.map(|(at, _)| at as u32 + 1);
        Lines {
            starts: std::iter::once(0).chain(starts).collect(),
            encoding,
        }
    }

    /// Bytes of a line without its end; of a line past the end, the end of the text.
    pub(crate) fn range(&self, text: &str, line: u32) -> std::ops::Range<usize> {
        let start = |line: usize| self.starts.get(line).map_or(text.len(), |&at| at as usize);
        let (from, to) = (start(line as usize), start(line as usize + 1));
        let content = text.get(from..to).unwrap_or_default();
        from..from + content.trim_end_matches(['\r', '\n']).len()
    }

    /// The line of a byte.
    pub(crate) fn line(&self, offset: usize) -> u32 {
        let after = self
            .starts
            .partition_point(|&start| start as usize <= offset);
        after.saturating_sub(1) as u32
    }

    /// The position of a byte; within a character, that of the character.
    pub(crate) fn position(&self, text: &str, offset: usize) -> Position {
        let mut offset = offset.min(text.len());
        while !text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.line(offset);
        let start = self.starts.get(line as usize).map_or(0, |&at| at as usize);
        let before = text.get(start..offset).unwrap_or_default();
        Position {
            line,
            character: self.encoding.length(before),
        }
    }

    /// The byte at a position; past the end of a line, its end.
    pub(crate) fn offset(&self, text: &str, position: Position) -> usize {
        let line = self.range(text, position.line);
        let content = text.get(line.clone()).unwrap_or_default();
        let mut units = 0;
        for (at, c) in content.char_indices() {
            units += self.encoding.units(c);
            if units > position.character {
                return line.start + at;
            }
        }
        line.end
    }

    /// Units of a text.
    pub(crate) fn length(&self, text: &str) -> u32 {
        self.encoding.length(text)
    }
}

#[cfg(test)]
mod tests {
    use super::{Encoding, Lines};
    use gen_lsp_types::Position;

    const TEXT: &str = "LD X0\r\n; 电机😀!\nOUT Y0\rEND";

    #[test]
    fn columns_count_in_units_of_the_editor() {
        let at = TEXT.find('!').unwrap();
        for (encoding, character) in [
            (Encoding::Utf8, 12),
            (Encoding::Utf16, 6),
            (Encoding::Utf32, 5),
        ] {
            let lines = Lines::of(TEXT, encoding);
            let position = Position { line: 1, character };
            assert_eq!(lines.position(TEXT, at), position, "{encoding:?}");
            assert_eq!(lines.offset(TEXT, position), at, "{encoding:?}");
        }
    }

    #[test]
    fn every_line_end_of_the_protocol_ends_a_line() {
        let lines = Lines::of(TEXT, Encoding::Utf16);
        let texts: Vec<_> = (0..5).map(|n| &TEXT[lines.range(TEXT, n)]).collect();
        assert_eq!(texts, ["LD X0", "; 电机😀!", "OUT Y0", "END", ""]);
    }

    #[test]
    fn positions_outside_are_brought_inside() {
        let lines = Lines::of(TEXT, Encoding::Utf16);
        let at = |line, character| lines.offset(TEXT, Position { line, character });
        assert_eq!(at(0, 99), 5);
        assert_eq!(at(9, 9), TEXT.len());
        // Between the halves of a surrogate pair.
        assert_eq!(at(1, 5), TEXT.find('😀').unwrap());
        let inside = TEXT.find('机').unwrap() + 1;
        assert_eq!(lines.position(TEXT, inside).character, 3);
        assert_eq!(lines.position(TEXT, 999).line, 3);
    }
}
