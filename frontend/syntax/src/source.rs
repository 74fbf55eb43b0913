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
    /// The files that the text is made of, in order; empty if it is one.
    parts: Vec<Part>,
    /// For each block of the text, how many characters begin before it; counted when it is first needed.
    before_block: OnceLock<Vec<u32>>,
}

/// A file of a source that is made of several.
#[derive(Clone, Debug)]
pub struct Part {
    /// Path for users.
    pub path: String,
    /// First byte of its text.
    pub start: u32,
    /// Number of lines before it.
    lines_before: u32,
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
            parts: Vec::new(),
            before_block: OnceLock::new(),
        }
    }

    /// Joins the texts of several files, each by its path; lines are counted in each of them. Texts of more than 4 GiB
    /// must be rejected before.
    pub fn joined(
        name: impl Into<String>,
        files: impl IntoIterator<Item = (String, String)>,
    ) -> Self {
        let mut text = String::new();
        let mut parts = Vec::new();
        for (path, file) in files {
            parts.push((path, text.len() as u32));
            text.push_str(&file);
            // The next one begins on its own line.
            if !text.is_empty() && !text.ends_with('\n') {
                text.push('\n');
            }
        }
        let mut source = Source::new(name, text);
        let parts = parts.into_iter().map(|(path, start)| Part {
            path,
            start,
            lines_before: source.whole_line(start) - 1,
        });
        source.parts = parts.collect();
        source
    }

    /// The files that the text is made of, in order; empty if it is one.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The file that holds a byte offset, if the text is made of several.
    pub fn part(&self, offset: u32) -> Option<&Part> {
        let next = self.parts.partition_point(|part| part.start <= offset);
        self.parts.get(next.checked_sub(1)?)
    }

    /// The bytes of each file that the text is made of; all bytes if it is one.
    pub fn spans(&self) -> Vec<Span> {
        let end = self.text.len() as u32;
        let starts = || self.parts.iter().map(|part| part.start);
        match self.parts.is_empty() {
            true => vec![Span::new(0, end)],
            false => starts()
                .zip(starts().skip(1).chain([end]))
                .map(|(start, end)| Span::new(start, end))
                .collect(),
        }
    }

    /// The 1-based line of a byte offset in its file; offsets past the end give the last one.
    pub fn line(&self, offset: u32) -> u32 {
        self.whole_line(offset) - self.part(offset).map_or(0, |part| part.lines_before)
    }

    /// The 1-based line in the whole text.
    fn whole_line(&self, offset: u32) -> u32 {
        let line = self.line_starts.partition_point(|&start| start <= offset);
        line.max(1) as u32
    }

    /// Returns true for two bytes on one line.
    pub fn is_one_line(&self, offset: u32, other: u32) -> bool {
        self.whole_line(offset) == self.whole_line(other)
    }

    /// The 1-based line and column (in characters) of a byte offset; offsets past the end give the end.
    pub fn line_col(&self, offset: u32) -> (u32, u32) {
        let offset = (offset as usize).min(self.text.len());
        let line = self.line(offset as u32);
        let start = self.whole_line(offset as u32) - 1;
        let start = self.line_starts.get(start as usize);
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
    fn lines_are_those_of_each_file() {
        let files = [
            ("a.st", "one\ntwo"),
            ("b.st", ""),
            ("c.st", "three\nfour\n"),
        ];
        let files = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
        let source = Source::joined("all", files);
        let place = |offset| {
            let (line, column) = source.line_col(offset);
            let path = source.part(offset).map(|part| part.path.as_str());
            (path.unwrap_or_default(), line, column)
        };
        assert_eq!(place(5), ("a.st", 2, 2));
        assert_eq!(place(8), ("c.st", 1, 1));
        assert_eq!(place(15), ("c.st", 2, 2));
        assert!(source.is_one_line(8, 13) && !source.is_one_line(5, 8));
        let texts: Vec<_> = source
            .spans()
            .into_iter()
            .map(|s| source.slice(s))
            .collect();
        assert_eq!(texts, ["one\ntwo\n", "", "three\nfour\n"]);
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
