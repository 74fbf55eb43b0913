//! Text of comments, statements and notes in the one form that programs hold.

use smol_str::SmolStr;

/// One line of comment text: no control characters, no space at its ends, never empty.
pub(crate) fn clean(text: &str) -> Option<SmolStr> {
    let text = text.trim_matches(|c: char| c.is_whitespace() || c.is_control());
    match text {
        "" => None,
        _ if text.chars().any(char::is_control) => Some(
            text.chars()
                .map(|c| if c.is_control() { ' ' } else { c })
                .collect(),
        ),
        _ => Some(SmolStr::new(text)),
    }
}

/// Lines of a statement.
pub(crate) type Lines = Joined<'\n'>;

/// Comment text in parts, with a character between them.
#[derive(Default)]
pub(crate) struct Joined<const BETWEEN: char>(String);

impl<const BETWEEN: char> Joined<BETWEEN> {
    /// Appends a part that [`clean`] gives.
    pub fn push(&mut self, part: &str) {
        if !self.0.is_empty() {
            self.0.push(BETWEEN);
        }
        self.0.push_str(part);
    }

    /// Takes all of them as one text; `None` if there are none.
    pub fn take(&mut self) -> Option<SmolStr> {
        (!self.0.is_empty()).then(|| std::mem::take(&mut self.0).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_joined() {
        let mut lines = Lines::default();
        assert_eq!(lines.take(), None);
        lines.push("a");
        lines.push("b c");
        assert_eq!(lines.take().as_deref(), Some("a\nb c"));
        assert_eq!(lines.take(), None);
    }

    #[test]
    fn lines_are_moved_a_constant_number_of_times() {
        let mut lines = Lines::default();
        let mut moved = 0;
        for _ in 0..300_000 {
            let (before, room) = (lines.0.len(), lines.0.capacity());
            lines.push("a line of a long comment");
            moved += if lines.0.capacity() == room {
                0
            } else {
                before
            };
        }
        assert!(moved <= 2 * lines.0.len(), "{moved} bytes were moved");
    }
}
