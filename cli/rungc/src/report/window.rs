//! The part of a line of source text that is drawn.

use super::visible::visible_line;
use rungc_syntax::Span;
use std::borrow::Cow;

/// Number of characters of a line that are drawn.
const WIDTH: usize = 120;
/// Number of them before the mark, if the line begins further to the left.
const BEFORE: usize = 40;

/// Longer instructions, in bytes, are not drawn whole.
const MAX_ROWS: usize = 2 * WIDTH;

/// A part of a line, or an instruction that spans several rows of a table.
pub struct Window<'t> {
    text: &'t str,
    /// Start in the source.
    start: usize,
    /// True if the line begins further to the left.
    cut_before: bool,
    /// True if the line continues.
    cut_behind: bool,
}

impl<'t> Window<'t> {
    /// The part of the line around a byte of the source, however long the line is. `listing`: lines begin with the
    /// number of the step, which is left out.
    pub fn around(source: &'t str, at: usize, listing: bool) -> Self {
        let at = floor(source, at);
        let breaks = |&(_, c): &(usize, char)| c == '\n';
        let before = source[..at].char_indices().rev();
        let mut before: Vec<_> = before.take_while(|c| !breaks(c)).take(WIDTH).collect();
        let mut cut_before = before.len() == WIDTH;
        let all = source[at..].char_indices().take_while(|c| !breaks(c));
        let after = all.take(WIDTH + 1).count();
        if before.len() + after > WIDTH && before.len() > BEFORE {
            before.truncate(BEFORE);
            cut_before = true;
        }
        let mut start = before.last().map_or(at, |&(first, _)| first);
        if listing && !cut_before {
            start += listed(&source[start..at]);
        }
        let mut rest = source[start..]
            .char_indices()
            .take_while(|c| !breaks(c))
            .skip(WIDTH);
        let end = rest.next().map(|(end, _)| start + end);
        let end_of_line = || {
            source[start..]
                .find('\n')
                .map_or(source.len(), |len| start + len)
        };
        let text = &source[start..end.unwrap_or_else(end_of_line)];
        Window {
            text: text.strip_suffix('\r').unwrap_or(text),
            start,
            cut_before,
            cut_behind: end.is_some(),
        }
    }

    /// An instruction whose operands have separate rows, if this is one; its rows are drawn as one line.
    pub fn of_rows(source: &'t str, span: Span) -> Option<Self> {
        let text = source.get(span.range())?;
        let short = text.len() <= MAX_ROWS && text.contains('\n');
        short.then_some(Window {
            text,
            start: span.start as usize,
            cut_before: false,
            cut_behind: false,
        })
    }

    /// Returns true if a byte of the source lies in it, or at its end.
    pub fn holds(&self, at: usize) -> bool {
        (self.start..=self.start + self.text.len()).contains(&at)
    }

    /// The character of what is drawn, from 0, that stands for a byte of the source; what lies outside is drawn at the
    /// edge.
    pub fn column(&self, at: usize) -> usize {
        let within = at.saturating_sub(self.start).min(self.text.len());
        let before = &self.text[..floor(self.text, within)];
        usize::from(self.cut_before) + one_line(before).chars().count()
    }

    /// Text to draw.
    pub fn shown(&self) -> String {
        let sign = |cut| if cut { "…" } else { "" };
        let text = one_line(self.text);
        format!("{}{text}{}", sign(self.cut_before), sign(self.cut_behind))
    }
}

/// A text with its rows joined and all written out that a terminal would act on.
fn one_line(text: &str) -> Cow<'_, str> {
    if !text.contains('\n') {
        return visible_line(text);
    }
    let rows: Vec<_> = text.split('\n').collect();
    let rows = rows.iter().enumerate().map(|(n, row)| match n {
        0 => row.trim_end(),
        _ => row.trim(),
    });
    visible_line(&rows.collect::<Vec<_>>().join(" "))
        .into_owned()
        .into()
}

/// The start of the character that holds a byte.
fn floor(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    (0..=at)
        .rev()
        .find(|&at| text.is_char_boundary(at))
        .unwrap_or(0)
}

/// Length of the step's number at the beginning of a line of a listing.
fn listed(line: &str) -> usize {
    let rest = match line.strip_prefix("step ") {
        Some(rest) => rest.trim_start_matches(|c: char| !c.is_whitespace()),
        None => line,
    };
    line.len() - rest.trim_start().len()
}

#[cfg(test)]
mod tests {
    use super::Window;
    use rungc_syntax::Span;

    #[test]
    fn a_short_line_is_drawn_whole() {
        let window = Window::around("LD X0\nOUT Y0 ; 电机\r\nEND", 10, false);
        assert_eq!(window.shown(), "OUT Y0 ; 电机");
        assert_eq!((window.column(6), window.column(10)), (0, 4));
        assert!(window.holds(6) && !window.holds(5));
    }

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let source = format!("{}X9{}", "a".repeat(1_000), "b".repeat(1_000_000));
        let window = Window::around(&source, 1_000, false);
        let shown = window.shown();
        assert!(shown.starts_with("…a") && shown.ends_with("b…"), "{shown}");
        assert_eq!(shown.chars().count(), 122);
        assert_eq!(window.column(1_000), 41);
    }

    #[test]
    fn the_step_of_a_listing_is_left_out() {
        let window = Window::around("step 12     LD X009", 15, true);
        assert_eq!(window.shown(), "LD X009");
        assert_eq!(window.column(15), 3);
    }

    #[test]
    fn an_instruction_in_several_rows_is_one_line() {
        let source = "step 4      MOV K5\n            X1   ; note\n";
        let window = Window::of_rows(source, Span::new(12, 33)).unwrap();
        assert_eq!(window.shown(), "MOV K5 X1");
        assert_eq!((window.column(31), window.column(33)), (7, 9));
        assert!(Window::of_rows(source, Span::new(12, 18)).is_none());
    }

    #[test]
    fn signs_that_act_are_as_wide_as_they_are_drawn() {
        let window = Window::around("A\u{1b}B", 2, false);
        assert_eq!(window.shown(), "A\\u{1b}B");
        assert_eq!(window.column(2), 7);
    }
}
