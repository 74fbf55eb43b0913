//! Source text and places in it.

use std::ops::Range;

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
/// For an instruction list it is the file itself, decoded to UTF-8. For an export or a binary project it is a listing made by the
/// reader, one line per row of the export (or per instruction of the project), so that line N is row N.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// What to call it in diagnostics and in generated headers: the file's name without its folder.
    pub name: String,
    /// The text.
    pub text: String,
    line_starts: Vec<u32>,
}

/// Lines of programs are rarely shorter, in bytes.
const SHORT_LINE: usize = 8;

impl Source {
    /// Takes the text over and finds its lines. Texts over 4 GiB must be refused before.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        let text = text.into();
        let mut line_starts = Vec::with_capacity(text.len() / SHORT_LINE + 1);
        line_starts.push(0);
        line_starts.extend(memchr::memchr_iter(b'\n', text.as_bytes()).map(|i| i as u32 + 1));
        Source {
            name: name.into(),
            text,
            line_starts,
        }
    }

    /// The 1-based line and column (in characters) of a byte offset; offsets past the end give the end.
    pub fn line_col(&self, offset: u32) -> (u32, u32) {
        let offset = (offset as usize).min(self.text.len());
        let line = self
            .line_starts
            .partition_point(|&start| start as usize <= offset)
            .max(1);
        let start = self.line_starts.get(line - 1).map_or(0, |&s| s as usize);
        let column = self
            .text
            .get(start..offset)
            .map_or(0, |t| t.chars().count());
        (line as u32, column as u32 + 1)
    }

    /// The text of a span; empty if the span does not lie on character boundaries of the text.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.range()).unwrap_or("")
    }

    /// The lines with what ends them, and where each begins; none behind the last end of a line.
    pub fn lines(&self) -> impl Iterator<Item = (u32, &str)> {
        let ends = self.line_starts.iter().skip(1).copied();
        let ends = ends.chain([self.text.len() as u32]);
        self.line_starts
            .iter()
            .zip(ends)
            .map(|(&start, end)| (start, self.slice(Span::new(start, end))))
            .filter(|(_, line)| !line.is_empty())
    }

    /// How many lines the text has.
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
}
