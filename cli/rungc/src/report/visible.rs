//! Text of programs, file names and test cases on its way to a terminal.

use rungc_syntax::text::acts;
use serde::Serialize;
use std::borrow::Cow;
use std::io;

/// A text in which all that a terminal would act on is written out, as `\u{1b}`. Line feeds and tabs stay.
pub fn visible(text: &str) -> Cow<'_, str> {
    replaced(text, |c, out| match c {
        '\n' | '\t' => out.push(c),
        c => out.extend(c.escape_unicode()),
    })
}

/// As [`visible`], for a text on one line.
pub fn visible_line(text: &str) -> Cow<'_, str> {
    replaced(text, |c, out| match c {
        '\n' => out.push_str("\\n"),
        '\t' => out.push(' '),
        c => out.extend(c.escape_unicode()),
    })
}

/// Returns true if a name would be more than one line.
pub fn breaks_lines(name: &str) -> bool {
    name.contains(['\n', '\r'])
}

/// A JSON document in which the same characters are written as JSON escapes them. They occur only in strings; the line
/// feeds between the tokens stay.
fn visible_json(document: &str) -> Cow<'_, str> {
    replaced(document, |c, out| match c {
        '\n' => out.push(c),
        c => {
            let mut units = [0; 2];
            for unit in c.encode_utf16(&mut units) {
                out.push_str(&format!("\\u{unit:04x}"));
            }
        }
    })
}

/// An XML document in which the same characters are written as references. They occur only in texts and values.
pub fn visible_xml(document: &str) -> Cow<'_, str> {
    replaced(document, |c, out| match c {
        '\n' | '\t' => out.push(c),
        c => out.push_str(&format!("&#x{:X};", u32::from(c))),
    })
}

/// A value as a JSON document, on several lines, in which nothing acts on a terminal.
pub fn to_json(value: &impl Serialize) -> io::Result<String> {
    let document = serde_json::to_string_pretty(value)?;
    Ok(format!("{}\n", visible_json(&document)))
}

fn replaced(text: &str, mut write: impl FnMut(char, &mut String)) -> Cow<'_, str> {
    let Some(first) = text.find(acts) else {
        return Cow::Borrowed(text);
    };
    let (clean, rest) = text.split_at(first);
    let mut out = String::with_capacity(text.len() + 16);
    out.push_str(clean);
    for c in rest.chars() {
        if acts(c) {
            write(c, &mut out);
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_acts_on_a_terminal() {
        let hostile = "a\u{1b}[31mb\u{9b}2J\u{7}\r\u{202e}c\u{2066}\u{2028}\u{7f}d\u{200f}";
        let shown = visible_line(hostile);
        assert!(!shown.chars().any(acts), "{shown}");
        assert_eq!(visible("\u{1b}[0m\n\tx"), "\\u{1b}[0m\n\tx");
        assert_eq!(visible_line("a\tb\nc"), "a b\\nc");
        assert!(matches!(visible("Ж 电 ok"), Cow::Borrowed(_)));
    }

    #[test]
    fn json_stays_the_same_document() {
        let text = "a\u{9b}\u{202e}\u{1b}";
        let document = serde_json::to_string_pretty(&[text]).unwrap();
        let shown = visible_json(&document);
        assert!(!shown.replace('\n', "").chars().any(acts), "{shown}");
        let back: Vec<String> = serde_json::from_str(&shown).unwrap();
        assert_eq!(back, [text]);
    }
}
