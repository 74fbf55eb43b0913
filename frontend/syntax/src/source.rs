//! Source text and places in it.

use std::ops::Range;
use std::sync::OnceLock;

/// A half-open byte range of a [`Source`]'s text.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord)]
pub struct Span {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The span from byte `start` up to and without byte `end`.
    pub const fn new(start: u32, end: u32) -> Self {
        Span { start, end }
    }

    /// The smallest span that holds both.
    pub fn to(self, other: Span) -> Span {
        Span {
            start: self.start.min(other.start),
            end: self.end.max(other.end),
        }
    }

    /// As a range of `usize`, to slice text with.
    pub fn range(self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

impl std::fmt::Debug for Span {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}..{}", self.start, self.end)
    }
}

/// The text that diagnostics quote.
///
/// For an instruction list it is the file itself, decoded to UTF-8. For an export or a binary project it is a listing
/// made by the reader, one line per row of the export (or per instruction of the project), so that line N is row N.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// Name in diagnostics and in generated headers: the file's name without its folder.
    pub name: String,
    /// The text.
    pub text: String,
    line_starts: Vec<u32>,
    /// For each block of the text, how many characters begin before it; counted when it is first needed.
    before_block: OnceLock<Vec<u32>>,
}

/// Length of the blocks in bytes.
const BLOCK: usize = 4_096;

/// Number of characters that begin in these bytes of a text.
fn characters(bytes: &[u8]) -> usize {
    let begins = |&&byte: &&u8| byte & 0xC0 != 0x80;
    bytes.iter().filter(begins).count()
}

/// Lines of programs are rarely shorter, in bytes.
const SHORT_LINE: usize = 8;

impl Source {
    /// Takes the text over and finds its lines. Texts over 4 GiB must be rejected before.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        let text = text.into();
        let mut line_starts = Vec::with_capacity(text.len() / SHORT_LINE + 1);
        line_starts.push(0);
        line_starts.extend(memchr::memchr_iter(b'\n', text.as_bytes()).map(|i| i as u32 + 1));
        Source {
            name: name.into(),
            text,
            line_starts,
            before_block: OnceLock::new(),
        }
    }

    /// The 1-based line of a byte offset; offsets past the end give the last one.
    pub fn line(&self, offset: u32) -> u32 {
        let line = self.line_starts.partition_point(|&start| start <= offset);
        line.max(1) as u32
    }

    /// The 1-based line and column (in characters) of a byte offset; offsets past the end give the end.
    pub fn line_col(&self, offset: u32) -> (u32, u32) {
        let offset = (offset as usize).min(self.text.len());
        let line = self.line(offset as u32);
        let start = self.line_starts.get(line as usize - 1);
        let start = start.map_or(0, |&start| start as usize).min(offset);
        (line, self.characters(start, offset) as u32 + 1)
    }

    /// Number of characters that begin between two byte offsets. Long lines are counted by block, except at the ends.
    fn characters(&self, start: usize, end: usize) -> usize {
        let count = |from: usize, to: usize| characters(&self.text.as_bytes()[from..to]);
        let (first, last) = (start.div_ceil(BLOCK), end / BLOCK);
        if first >= last {
            return count(start, end);
        }
        let before = self.before_block.get_or_init(|| {
            let blocks = self.text.as_bytes().chunks(BLOCK).map(characters);
            let mut sum = 0;
            let sums = blocks.map(|count| {
                sum += count as u32;
                sum
            });
            std::iter::once(0).chain(sums).collect()
        });
        let between = (before[last] - before[first]) as usize;
        count(start, first * BLOCK) + between + count(last * BLOCK, end)
    }

    /// The text of a span; empty if the span does not lie on character boundaries of the text.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.range()).unwrap_or("")
    }

    /// The lines with what ends them, and where each begins; none after the last line end.
    pub fn lines(&self) -> impl Iterator<Item = (u32, &str)> {
        let ends = self.line_starts.iter().skip(1).copied();
        let ends = ends.chain([self.text.len() as u32]);
        self.line_starts
            .iter()
            .zip(ends)
            .map(|(&start, end)| (start, self.slice(Span::new(start, end))))
            .filter(|(_, line)| !line.is_empty())
    }

    /// Number of lines.
    pub fn line_count(&self) -> u32 {
        self.line_starts.len() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_and_column_are_one_based() {
        let source = Source::new("a", "LD X0\n电机 X1\n");
        assert_eq!(source.line_col(0), (1, 1));
        assert_eq!(source.line_col(6), (2, 1));
        assert_eq!(source.line_col(12), (2, 3));
        assert_eq!(source.line_col(999), (3, 1));
    }

    #[test]
    fn columns_of_long_lines_are_counted_in_characters() {
        let source = Source::new("a", format!("END\n{}", "电a".repeat(5_000)));
        for character in [0, 1, 2, 2_047, 4_096, 9_999] {
            let offset = 4 + 4 * (character / 2) + 3 * (character % 2);
            assert_eq!(source.line_col(offset), (2, character + 1));
        }
    }
}
