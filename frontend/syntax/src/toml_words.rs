//! Mistakes in TOML files, in the words of TOML rather than of Rust: those of test files, machines and boards alike.

use crate::{Span, diag};

/// The key, value or heading at a byte of a file: what a report marks.
pub fn token(text: &str, at: usize) -> Span {
    let rest = text.get(at..).unwrap_or_default();
    let line = rest.lines().next().unwrap_or_default();
    let length = match line.chars().next() {
        Some(quote @ ('"' | '\'')) => {
            let mut escaped = false;
            let end = line.char_indices().skip(1).find(|&(_, c)| {
                let ends = c == quote && !escaped;
                escaped = quote == '"' && c == '\\' && !escaped;
                ends
            });
            end.map(|(end, _)| end + 1)
        }
        Some('[') => line.rfind(']').map(|end| end + 1),
        Some('{') => line.rfind('}').map(|end| end + 1),
        _ => line.find(|c: char| c.is_whitespace() || "=,]}#".contains(c)),
    };
    let length = length.unwrap_or(line.trim_end().len());
    Span::new(at as u32, (at + length) as u32)
}

/// Message of the TOML reader about a place of the text, as [`message`] says it, with what the place shows.
pub fn message_at(text: &str, at: usize, of_reader: &str) -> (String, Option<String>) {
    let token = token(text, at);
    let token = text
        .get(token.start as usize..token.end as usize)
        .unwrap_or_default();
    let (said, help) = message(of_reader);
    // The reader points at the name of a heading, after its brackets.
    let is_heading = text.get(..at).is_some_and(|before| before.ends_with("[["));
    if is_moment(token) {
        (MOMENT.to_string(), None)
    } else if let Some((outer, _)) = token
        .rsplit_once('.')
        .filter(|_| said == LIST && is_heading)
    {
        (format!("`[[{token}]]` needs `[[{outer}]]` above it"), None)
    } else {
        (said, help)
    }
}

/// Returns true for a date or a time that is not in quotes.
fn is_moment(token: &str) -> bool {
    let separator = |at: usize| token.as_bytes().get(at).copied();
    let is_of = |c: char| c.is_ascii_digit() || "-:.TtZz+".contains(c);
    let is_marked = separator(4) == Some(b'-') && separator(7) == Some(b'-')
        || separator(2) == Some(b':') && separator(5) == Some(b':');
    is_marked && token.chars().all(is_of)
}

/// Message about a date or a time that is not in quotes.
const MOMENT: &str = "write a date or a time in quotes";

/// Message about a table in the place of a list of tables.
const LIST: &str = "write tables of this name in double brackets";

/// Message of the TOML reader, in the words of TOML rather than of Rust, and a help: for an unknown name the one that
/// is meant, or all that are known.
fn message(message: &str) -> (String, Option<String>) {
    if message.contains("$__toml_private") {
        return (MOMENT.to_string(), None);
    }
    if let Some(unknown) = unknown(message) {
        return unknown;
    }
    let words = [
        ("expected f64", "expected a number"),
        ("expected u8", "expected a whole number from 0 to 255"),
        ("expected u16", "expected a whole number from 0 to 65535"),
        (
            "expected u32",
            "expected a whole number from 0 to 4294967295",
        ),
        (
            "expected i32",
            "expected a whole number from -2147483648 to 2147483647",
        ),
        ("invalid type: map, expected a sequence", LIST),
        ("missing field `", "missing key `"),
        ("invalid type: map", "invalid type: table"),
        ("expected a map", "expected a table: `{ NAME = VALUE }`"),
        ("expected a sequence", "expected a list in brackets"),
    ];
    let message = match message.split_once("expected struct ") {
        Some((before, name)) => {
            let rest = name.trim_start_matches(|c: char| c.is_ascii_alphanumeric());
            format!("{before}expected a table: `{{ KEY = VALUE }}`{rest}")
        }
        None => message.to_string(),
    };
    let text = words
        .iter()
        .fold(message, |text, (from, to)| text.replace(from, to));
    (text, None)
}

/// The message and the help of a name that is not known.
fn unknown(message: &str) -> Option<(String, Option<String>)> {
    let words = [
        ("unknown field `", "there is no key"),
        ("unknown variant `", "unknown name"),
    ];
    let (rest, what) = words
        .into_iter()
        .find_map(|(from, what)| Some((message.strip_prefix(from)?, what)))?;
    let (name, known) = rest.split_once('`')?;
    let known: Vec<_> = known.split('`').skip(1).step_by(2).collect();
    let longer = || known.iter().find(|known| known.starts_with(name));
    let near = diag::did_you_mean(name, known.iter().copied());
    let help = match near.or_else(|| longer().copied()) {
        Some(near) => Some(format!("did you mean `{near}`?")),
        None if known.is_empty() => None,
        None => Some(format!("valid names: {}", known.join(", "))),
    };
    Some((format!("{what} `{name}`"), help))
}

#[cfg(test)]
mod tests {
    use super::{message, message_at, token};

    #[test]
    fn whole_numbers_have_their_range() {
        let of_serde = "invalid value: integer `-5`, expected u32";
        let said = "invalid value: integer `-5`, expected a whole number from 0 to 4294967295";
        assert_eq!(message(of_serde), (said.to_string(), None));
    }

    #[test]
    fn what_stands_at_the_place_decides() {
        let text = "clock = 2026-01-01T00:00:00\nat=07:30:00\nset = 2026\n[[case.step]]\n[case]\n";
        let list = "invalid type: map, expected a sequence";
        for (at, of_serde, said) in [
            (
                "2026-",
                "invalid type: map, expected a string",
                "write a date or a time in quotes",
            ),
            (
                "07:",
                "invalid type: map, expected a string",
                "write a date or a time in quotes",
            ),
            (
                "2026\n",
                "invalid type: map, expected a string",
                "invalid type: table, expected a string",
            ),
            (
                "case.step",
                list,
                "`[[case.step]]` needs `[[case]]` above it",
            ),
            (
                "[case]",
                list,
                "write tables of this name in double brackets",
            ),
        ] {
            let at = text.find(at).unwrap();
            assert_eq!(message_at(text, at, of_serde).0, said);
        }
    }

    #[test]
    fn unknown_names_have_a_help() {
        for (of_serde, said, help) in [
            (
                "unknown field `topik`, expected one of `model`, `topic`",
                "there is no key `topik`",
                Some("did you mean `topic`?"),
            ),
            (
                "unknown field `x`, expected one of `model`, `topic`",
                "there is no key `x`",
                Some("valid names: model, topic"),
            ),
            (
                "unknown field `x`, there are no fields",
                "there is no key `x`",
                None,
            ),
            (
                "unknown variant `z80`, expected `cmsdk` or `stm32f1`",
                "unknown name `z80`",
                Some("valid names: cmsdk, stm32f1"),
            ),
        ] {
            let help = help.map(str::to_string);
            assert_eq!(message(of_serde), (said.to_string(), help), "{of_serde}");
        }
    }

    #[test]
    fn a_token_is_what_stands_at_its_place() {
        let text = "a = \"x = \\\"1\\\"\" # b\n[[case]]\nb=[1, 2]\nc = { d = 1 }, e";
        for (at, marked) in [
            ("a", "a"),
            ("\"x", "\"x = \\\"1\\\"\""),
            ("[[", "[[case]]"),
            ("b=", "b"),
            ("[1", "[1, 2]"),
            ("2", "2"),
            ("{", "{ d = 1 }"),
        ] {
            let span = token(text, text.find(at).unwrap());
            assert_eq!(
                &text[span.start as usize..span.end as usize],
                marked,
                "{at}"
            );
        }
        assert_eq!(token(text, text.len()).start as usize, text.len());
    }
}
