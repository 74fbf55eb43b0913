//! Text in C source: comments and wrapped lines.

use crate::code::Code;
use rungc_syntax::text::acts;

/// Longest line.
pub const WIDTH: usize = 120;
/// Longest line of a comment on separate lines: what most engineers write above a network stays on one.
const COMMENT_WIDTH: usize = 200;
/// Column of comments beside statements.
const COMMENT_COLUMN: usize = 64;

/// Makes a user's text safe inside a comment: no end of the comment, no line breaks, no characters that turn text
/// around.
pub fn comment(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    let mut last = ' ';
    for c in text.chars() {
        let c = if acts(c) { ' ' } else { c };
        match (last, c) {
            (' ', ' ') => continue,
            ('*', '/') | ('/', '*') | ('?', '?') => safe.push(' '),
            _ => {}
        }
        safe.push(c);
        last = c;
    }
    safe.trim().to_string()
}

/// Appends a line of code, broken where it is too long, and a comment beside it.
pub fn line(out: &mut String, indent: usize, code: &Code, beside: Option<&str>) {
    let start = out.len();
    let (mut from, mut indent) = (0, indent);
    loop {
        push_indent(out, indent);
        let room = WIDTH.saturating_sub(indent).max(40);
        let Some(at) = code.break_at(from, room) else {
            out.push_str(&code.as_str()[from..]);
            break;
        };
        out.push_str(code.as_str()[from..at].trim_end());
        out.push('\n');
        if from == 0 {
            indent += 4;
        }
        from = at;
    }
    if let Some(text) = beside {
        let text = comment(text);
        if !text.is_empty() {
            let last = out[start..].rfind('\n').map_or(start, |i| start + i + 1);
            let column = out.len() - last;
            push_indent(out, COMMENT_COLUMN.saturating_sub(column).max(1));
            out.push_str("/* ");
            out.push_str(&text);
            out.push_str(" */");
        }
    }
    out.push('\n');
}

/// Appends a comment on separate lines, wrapped where it is too long.
pub fn block(out: &mut String, indent: usize, text: &str) {
    push_indent(out, indent);
    out.push_str("/*");
    let mut column = indent + 2;
    for word in text.split(' ') {
        let length = word.chars().count() + 1;
        // The end of the comment needs room, too.
        if column + length + 3 > COMMENT_WIDTH && column > indent + 2 {
            out.push('\n');
            push_indent(out, indent + 2);
            column = indent + 2;
        }
        out.push(' ');
        out.push_str(word);
        column += length;
    }
    out.push_str(" */\n");
}

/// Appends spaces.
pub(crate) fn push_indent(out: &mut String, mut indent: usize) {
    const SPACES: &str = "                                ";
    while indent > SPACES.len() {
        out.push_str(SPACES);
        indent -= SPACES.len();
    }
    out.push_str(&SPACES[..indent]);
}

/// Appends a number.
pub(crate) fn push_number(out: &mut String, number: impl itoa::Integer) {
    out.push_str(itoa::Buffer::new().format(number));
}

/// Appends a number in octal.
pub(crate) fn push_octal(out: &mut String, number: u32) {
    let digits = number.max(1).ilog2() / 3;
    for digit in (0..=digits).rev() {
        out.push(char::from(b'0' + (number >> (3 * digit) & 7) as u8));
    }
}

/// Writes a text into a string literal.
pub(crate) fn string_literal(text: &str) -> String {
    use std::fmt::Write;
    let mut out = String::from("\"");
    for b in text.bytes() {
        let _ = match b {
            b'"' | b'\\' => write!(out, "\\{}", b as char),
            // A trigraph otherwise.
            b'?' => write!(out, "\\?"),
            0x20..0x7f => write!(out, "{}", b as char),
            // Three octal digits end by themselves.
            _ => write!(out, "\\{b:03o}"),
        };
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_cannot_end_early() {
        assert_eq!(comment("a */ b /* c"), "a * / b / * c");
        assert_eq!(comment("two\r\nlines"), "two lines");
        assert_eq!(comment("what??/"), "what? ?/");
        assert_eq!(comment("a\u{202e}b"), "a b");
    }

    #[test]
    fn long_comments_are_wrapped() {
        let mut out = String::new();
        block(
            &mut out,
            4,
            &format!("step 0: {}", "a word ".repeat(80).trim()),
        );
        assert!(out.lines().count() > 2, "{out}");
        assert!(out.lines().all(|line| line.len() <= COMMENT_WIDTH), "{out}");
        assert!(out.starts_with("    /* step 0: a word"), "{out}");
        assert!(
            out.lines()
                .skip(1)
                .all(|line| line.starts_with("       a") || line.starts_with("       word")),
            "{out}"
        );
        let words = |text: &str| text.split_whitespace().filter(|w| *w == "word").count();
        assert_eq!(words(&out), 80);
    }

    #[test]
    fn long_lines_break_at_the_outermost_operator() {
        let mut out = String::new();
        let mut code = Code::default();
        code.open("plc->M0 = (");
        for i in 0..9 {
            if i > 0 {
                code.operator("|");
            }
            code.push_str("plc->X0");
        }
        code.close(")");
        for _ in 0..9 {
            code.operator("&");
            code.push_str("plc->X1");
        }
        code.push_str(";");
        line(&mut out, 4, &code, Some("coil"));
        assert!(out.lines().all(|l| l.len() <= WIDTH), "{out}");
        assert!(out.contains("\n        & plc->X1"), "{out}");
        assert!(out.ends_with("/* coil */\n"));
    }

    #[test]
    fn octal_numbers_have_no_zeros_in_front() {
        for number in [0, 1, 7, 8, 63, 64, 0o377, u32::MAX] {
            let mut out = String::new();
            push_octal(&mut out, number);
            assert_eq!(out, format!("{number:o}"));
        }
    }

    #[test]
    fn literals_hold_any_text() {
        assert_eq!(string_literal("a\"\\?é1"), "\"a\\\"\\\\\\?\\303\\2511\"");
    }
}
