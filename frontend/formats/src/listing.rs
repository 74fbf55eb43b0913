//! The listing that stands for an export or a binary project: the text that diagnostics quote.

use rungc_syntax::{Source, Span};

/// Width of the margin that holds the step number.
const MARGIN: usize = 12;

/// A listing while it is made, line by line.
#[derive(Default)]
pub(crate) struct Listing {
    text: String,
    /// Start of the current line.
    line_start: usize,
    /// The current line, from 1; 0 before the first.
    line: u32,
}

impl Listing {
    /// Begins the next line.
    pub fn next_line(&mut self) {
        self.go_to_line(self.line + 1);
    }

    /// Begins the line of this number, from 1, leaving empty those in between; a line that has passed means the next
    /// one.
    pub(crate) fn go_to_line(&mut self, line: u32) {
        let line = line.max(self.line + 1);
        let first = u32::from(self.line == 0);
        self.text.extend(std::iter::repeat_n(
            '\n',
            (line - self.line - first) as usize,
        ));
        self.line = line;
        self.line_start = self.text.len();
    }

    /// Writes text that belongs to no instruction; gives its place.
    pub fn line(&mut self, text: &str) -> Span {
        self.raw(text)
    }

    /// Writes the margin with the step number in it; gives the number's place.
    pub fn margin(&mut self, step: &str) -> Span {
        if self.text.len() > self.line_start {
            self.text.push_str("  ");
        }
        let start = self.text.len();
        if !step.is_empty() {
            self.raw("step ");
        }
        let number = self.raw(step);
        let width = self.text[start..].chars().count();
        self.text.extend(std::iter::repeat_n(
            ' ',
            MARGIN.saturating_sub(width).max(1),
        ));
        number
    }

    /// Appends a mnemonic or an operand.
    pub fn word(&mut self, text: &str) -> Span {
        if !self.text.ends_with([' ', '\n']) && !self.text.is_empty() {
            self.text.push(' ');
        }
        self.raw(text)
    }

    /// Appends a comment.
    pub fn comment(&mut self, text: &str) {
        if self.text.len() > self.line_start {
            self.text.push_str("   ");
        }
        self.text.push_str("; ");
        self.raw(text);
    }

    /// Place of the current line.
    pub(crate) fn current_line(&self) -> Span {
        Span::new(self.line_start as u32, self.text.len() as u32)
    }

    /// The text at a place.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.range()).unwrap_or("")
    }

    /// The finished text.
    pub fn finish(self, name: &str) -> Source {
        Source::new(name, self.text)
    }

    /// Writes text that must not break the line. Control characters become spaces, of which each byte keeps its place.
    fn raw(&mut self, text: &str) -> Span {
        let start = self.text.len() as u32;
        for c in text.chars() {
            match c.is_control() {
                true => self.text.extend(std::iter::repeat_n(' ', c.len_utf8())),
                false => self.text.push(c),
            }
        }
        Span::new(start, self.text.len() as u32)
    }
}
