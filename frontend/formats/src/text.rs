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

/// Appends another line.
pub(crate) fn append(lines: &mut Option<SmolStr>, more: SmolStr) {
    *lines = Some(match lines.take() {
        None => more,
        Some(first) => format!("{first}\n{more}").into(),
    });
}
