//! Text of users (comments, titles, names of files) on its way into something that would act on it.

use std::borrow::Cow;

/// Returns true if a character acts on the text around it instead of showing itself: control characters (C0, DEL, C1),
/// the line and paragraph separators, the controls of bidirectional text, with which source can be made to read
/// otherwise than it compiles (Unicode Technical Report 36, §3.8; rustc rejects them in comments), and what shows
/// nothing: spaces without width, the byte order mark, tags. Joiners and variation selectors stay, which scripts and
/// emoji are written with.
pub fn acts(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{061C}'
                | '\u{180E}'
                | '\u{200B}'
                | '\u{200E}'
                | '\u{200F}'
                | '\u{2028}'
                | '\u{2029}'
                | '\u{202A}'..='\u{202E}'
                | '\u{2060}'..='\u{2064}'
                | '\u{2066}'..='\u{206F}'
                | '\u{FEFF}'
                | '\u{FFF9}'..='\u{FFFB}'
                | '\u{E0000}'..='\u{E007F}'
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
        let hostile = "a\u{1b}[31m\r\nb\u{9b}c\u{202e}d\u{2066}e\u{2028}f\u{200f}g\u{61c}h\u{7f}\
            i\u{200b}j\u{feff}k\u{e0041}l\u{2060}m\u{206a}n";
        assert_eq!(one_line(hostile), "a [31m  b c d e f g h i j k l m n");
    }

    #[test]
    fn other_text_stays() {
        for text in [
            "",
            "a b",
            "往复　é",
            "שלום",
            "“…” ±5 °C",
            "می\u{200c}خواهم",
            "⚠\u{fe0f}",
        ] {
            assert!(
                matches!(one_line(text), Cow::Borrowed(same) if same == text),
                "{text}"
            );
        }
    }
}
