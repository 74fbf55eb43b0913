//! A line of C in the making.

use std::fmt::Display;

/// The text of a line, and where it may be broken: where its parts are put together says so.
#[derive(Default)]
pub struct Code {
    text: String,
    /// Number of open parentheses and braces.
    depth: u32,
    breaks: Vec<Break>,
}

/// Place where a line may be broken.
#[derive(Clone, Copy)]
struct Break {
    /// The operator or the comma.
    mark: usize,
    /// Start of the next line: at the operator, or after the comma.
    next: usize,
    /// Number of parentheses and braces open there.
    depth: u32,
}

/// Position in a line: its bytes, and the number of open parentheses and braces.
#[derive(Clone, Copy)]
pub struct Mark {
    len: usize,
    depth: u32,
}

impl Code {
    /// An empty line with room for a usual one.
    pub fn new() -> Self {
        Code {
            text: String::with_capacity(crate::text::WIDTH),
            ..Code::default()
        }
    }

    /// The text, to which parts are added that cannot be broken and whose parentheses are closed.
    pub fn text(&mut self) -> &mut String {
        &mut self.text
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// Adds a part that cannot be broken and whose parentheses are closed.
    pub fn push_str(&mut self, part: &str) {
        self.text.push_str(part);
    }

    /// Adds what ends with an opening parenthesis or brace: the name of a function and `(`.
    pub fn open(&mut self, head: &str) {
        self.text.push_str(head);
        self.depth += 1;
    }

    /// Adds what starts with a closing parenthesis or brace.
    pub fn close(&mut self, tail: &str) {
        self.text.push_str(tail);
        self.depth -= 1;
    }

    /// Adds a comma between arguments.
    pub fn comma(&mut self) {
        let mark = self.text.len();
        self.text.push_str(", ");
        self.may_break(mark, mark + 2);
    }

    /// Adds an argument, which cannot be broken, after a comma.
    pub fn argument(&mut self, argument: impl Display) {
        use std::fmt::Write;
        self.comma();
        // Writing to a String does not fail.
        let _ = write!(self.text, "{argument}");
    }

    /// Adds an infix operator. Lines are broken before those that join conditions and bits.
    pub fn operator(&mut self, op: &str) {
        self.text.push(' ');
        let mark = self.text.len();
        self.text.push_str(op);
        self.text.push(' ');
        if matches!(op, "&" | "|" | "&&" | "||") {
            self.may_break(mark, mark);
        }
    }

    /// Adds a line in the making, all of whose parentheses are closed.
    pub fn append(&mut self, other: &Code) {
        let (at, depth) = (self.text.len(), self.depth);
        self.text.push_str(&other.text);
        self.breaks.extend(other.breaks.iter().map(|inner| Break {
            mark: at + inner.mark,
            next: at + inner.next,
            depth: depth + inner.depth,
        }));
    }

    /// Current position in the line.
    pub fn mark(&self) -> Mark {
        Mark {
            len: self.text.len(),
            depth: self.depth,
        }
    }

    /// Takes off what was added after a mark.
    pub(crate) fn back_to(&mut self, mark: Mark) {
        self.take(mark);
    }

    /// Takes off what was added after a mark, as a separate line.
    pub fn take(&mut self, from: Mark) -> Code {
        let kept = self.breaks.partition_point(|place| place.mark < from.len);
        let taken = self.breaks.split_off(kept).into_iter().map(|place| Break {
            mark: place.mark - from.len,
            next: place.next - from.len,
            depth: place.depth - from.depth,
        });
        self.depth = from.depth;
        Code {
            text: self.text.split_off(from.len),
            depth: 0,
            breaks: taken.collect(),
        }
    }

    fn may_break(&mut self, mark: usize, next: usize) {
        self.breaks.push(Break {
            mark,
            next,
            depth: self.depth,
        });
    }

    /// Place to break the text from `start` on, if it does not fit: before the operator, or after the comma, that is
    /// least deep in parentheses, the last one of those.
    pub(crate) fn break_at(&self, start: usize, room: usize) -> Option<usize> {
        if self.text.len() - start <= room {
            return None;
        }
        let mut best: Option<Break> = None;
        let first = self.breaks.partition_point(|place| place.mark < start);
        for place in &self.breaks[first..] {
            if place.mark - start > room && best.is_some() {
                break;
            }
            if place.mark - start > room / 3 && best.is_none_or(|best| place.depth <= best.depth) {
                best = Some(*place);
            }
        }
        best.map(|place| place.next)
    }
}

impl From<&str> for Code {
    fn from(text: &str) -> Self {
        Code {
            text: text.to_string(),
            ..Code::default()
        }
    }
}
