//! Rows of a table, apart from those that an unclosed quote takes into a field.

use super::layout::table;
use csv::{Position, StringRecord};
use std::borrow::Cow;
use std::ops::Range;

/// Advice about an unclosed quote.
pub(super) const HELP: &str = "write a text that begins with a quote, or holds a separator, as `\"…\"`, with quotes in it doubled";

/// The row that a line is by itself; `None` for the end of a text that begins above it.
pub(super) fn alone(line: &str, delimiter: u8) -> Option<StringRecord> {
    let line = line.trim_end_matches(['\r', '\n']);
    let (first, _) = line.split_once(char::from(delimiter))?;
    if first.matches('"').count() % 2 == 1 {
        return None;
    }
    table(&unspaced(line), delimiter)
        .into_records()
        .next()?
        .ok()
}

/// A table without blanks beside the quotes around its cells (`"LD", "X000"`): after a blank, a quote is part of its
/// cell. Lines stay lines.
pub(crate) fn unspaced(text: &str) -> Cow<'_, str> {
    let mut out = String::new();
    let (mut copied, mut start) = (0, 0);
    for line in text.split_inclusive('\n') {
        for blanks in spaced_quotes(line) {
            out.push_str(&text[copied..start + blanks.start]);
            copied = start + blanks.end;
        }
        start += line.len();
    }
    match copied {
        0 => Cow::Borrowed(text),
        _ => Cow::Owned(out + &text[copied..]),
    }
}

/// The blanks before the quotes that open the cells of a line, and after those that close them.
fn spaced_quotes(line: &str) -> Vec<Range<usize>> {
    const SEPARATORS: [char; 3] = [',', ';', '\t'];
    let mut found = Vec::new();
    let mut inside = false;
    let mut rest = line;
    while let Some(at) = rest.find('"') {
        let after = rest[at..].trim_start_matches('"');
        let count = rest.len() - at - after.len();
        let begin = line.len() - rest.len() + at;
        rest = after;
        let before = line[..begin].trim_end_matches(' ');
        let is_first = before.is_empty() || before.ends_with(SEPARATORS);
        let next = after.trim_start_matches(' ');
        let is_last = next.trim_end().is_empty() || next.starts_with(SEPARATORS);
        // Doubled quotes are part of a text, but for those of an empty cell.
        let is_odd = count % 2 == 1;
        let opens = !inside && is_first && (is_odd || is_last);
        if opens && before.len() < begin {
            found.push(before.len()..begin);
        }
        let was_inside = inside || opens;
        inside = was_inside && (inside != is_odd);
        let end = line.len() - after.len();
        if was_inside && !inside && is_last && next.len() < after.len() {
            found.push(end..line.len() - next.len());
        }
    }
    found
}

/// A row of a table.
pub(super) struct Row {
    /// Its fields.
    pub record: StringRecord,
    /// Its line, from 1.
    pub line: u32,
    /// True if one of its quotes would take in the rows below.
    pub is_unclosed: bool,
}

/// Iterator of rows. Fields may hold line ends, unless what follows is a row itself.
pub(super) struct Rows<'t, F> {
    text: &'t str,
    delimiter: u8,
    is_row: F,
    reader: csv::Reader<&'t [u8]>,
    /// Place where the reader began.
    start: usize,
    /// Place up to which lines are counted.
    counted: usize,
    /// Line of that place, from 1.
    line: u32,
}

impl<'t, F: Fn(&str) -> bool> Rows<'t, F> {
    /// The rows of a text; `is_row` returns true for a line that is a row by itself.
    pub fn new(text: &'t str, delimiter: u8, is_row: F) -> Self {
        Rows {
            text,
            delimiter,
            is_row,
            reader: table(text, delimiter),
            start: 0,
            counted: 0,
            line: 1,
        }
    }

    /// The place of the first line of a row, other than its first, that is a row itself.
    fn swallowed(&self, from: usize, to: usize) -> Option<usize> {
        let row = self.text.get(from..to)?;
        let mut at = from;
        for (number, line) in row.split_inclusive('\n').enumerate() {
            if number > 0 && (self.is_row)(line) {
                return Some(at);
            }
            at += line.len();
        }
        None
    }

    fn line_of(&mut self, at: usize) -> u32 {
        let passed = self.text.as_bytes().get(self.counted..at);
        self.line += memchr::memchr_iter(b'\n', passed.unwrap_or_default()).count() as u32;
        self.counted = at;
        self.line
    }
}

impl<F: Fn(&str) -> bool> Iterator for Rows<'_, F> {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        let mut record = StringRecord::new();
        if !self.reader.read_record(&mut record).ok()? {
            return None;
        }
        let begin = record.position().map_or(0, Position::byte) as usize + self.start;
        let end = self.reader.position().byte() as usize + self.start;
        let raw = self.text.get(begin..end).unwrap_or_default();
        // Line ends above a row count to it.
        let from = end - raw.trim_start_matches(['\r', '\n']).len();
        let line = self.line_of(from);
        let next = self.swallowed(from, end);
        if let Some(next) = next {
            table(&self.text[from..next], self.delimiter)
                .read_record(&mut record)
                .ok()?;
            self.reader = table(&self.text[next..], self.delimiter);
            self.start = next;
        }
        Some(Row {
            record,
            line,
            is_unclosed: next.is_some(),
        })
    }
}
