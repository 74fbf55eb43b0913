//! Text of users (comments, titles, names of files) on its way into something that would act on it.

use std::borrow::Cow;

/// Returns true if a character acts on the text around it instead of showing itself: control characters (C0, DEL, C1),
/// the line and paragraph separators, and the controls of bidirectional text, with which source can be made to read
/// otherwise than it compiles (Unicode Technical Report 36, §3.8; rustc rejects them in comments).
pub fn acts(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{061C}'
                | '\u{200E}'
                | '\u{200F}'
                | '\u{2028}'
                | '\u{2029}'
                | '\u{202A}'..='\u{202E}'
                | '\u{2066}'..='\u{2069}'
        )
}

/// The text on one line: a space for each character that [acts](acts).
pub fn one_line(text: &str) -> Cow<'_, str> {
    match text.contains(acts) {
        true => Cow::Owned(text.replace(acts, " ")),
        false => Cow::Borrowed(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_that_act_become_spaces() {
        let hostile = "a\u{1b}[31m\r\nb\u{9b}c\u{202e}d\u{2066}e\u{2028}f\u{200f}g\u{61c}h\u{7f}";
        assert_eq!(one_line(hostile), "a [31m  b c d e f g h ");
    }

    #[test]
    fn other_text_stays() {
        for text in ["", "a b", "往复　é", "שלום", "“…” ±5 °C"] {
            assert!(
                matches!(one_line(text), Cow::Borrowed(same) if same == text),
                "{text}"
            );
        }
    }
}
