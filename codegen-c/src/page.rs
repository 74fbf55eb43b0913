//! The statements of a function as they are written: lines within blocks.

use crate::code::Code;
use crate::text;

/// Indentation of a block.
const STEP: usize = 4;

/// Lines of C.
pub struct Page {
    text: String,
    indent: usize,
    /// True at the start of a block, which has no blank line.
    fresh: bool,
}

impl Page {
    /// The inside of a function; lines are added to a text.
    pub fn new(text: String) -> Self {
        Page {
            text,
            indent: STEP,
            fresh: true,
        }
    }

    /// The text.
    pub fn finish(self) -> String {
        self.text
    }

    /// Adds a statement, and a comment beside it.
    pub fn commented(&mut self, code: &Code, beside: Option<&str>) {
        text::line(&mut self.text, self.indent, code, beside);
        self.fresh = false;
    }

    /// Adds a statement that is short enough for a line.
    pub fn line(&mut self, code: &str) {
        self.commented(&Code::from(code), None);
    }

    /// Begins a block with this head, which ends in its brace.
    pub fn open(&mut self, head: &str) {
        self.open_code(&Code::from(head));
    }

    /// Begins a block with this head, which ends in its brace and may be long.
    pub(crate) fn open_code(&mut self, head: &Code) {
        self.commented(head, None);
        self.indent += STEP;
        self.fresh = true;
    }

    /// Begins a block with this head, which ends in its brace, and adds a comment beside it.
    pub(crate) fn open_beside(&mut self, head: &str, beside: &str) {
        self.commented(&Code::from(head), Some(beside));
        self.indent += STEP;
        self.fresh = true;
    }

    /// Ends a block.
    pub fn close(&mut self) {
        self.indent -= STEP;
        self.line("}");
    }

    /// Ends a block and begins another one: `} else {`.
    pub fn reopen(&mut self, between: &str) {
        self.indent -= STEP;
        self.open(between);
    }

    /// Adds a statement that is inside what the one before it begins: the statements of a `case`.
    pub fn inner(&mut self, code: &str) {
        self.indent += STEP;
        self.line(code);
        self.indent -= STEP;
    }

    /// The lines that come now are as far to the left as the head of the block: the `case`s of a `switch`.
    pub fn back(&mut self) {
        self.indent -= STEP;
    }

    /// Sets off what comes now by a blank line, unless a block has just begun.
    pub(crate) fn set_off(&mut self) {
        if !self.fresh {
            self.text.push('\n');
        }
    }

    /// Adds a comment on separate lines, wrapped where it is too long.
    pub fn comment(&mut self, comment: &str) {
        text::block(&mut self.text, self.indent, comment);
        self.fresh = false;
    }
}
