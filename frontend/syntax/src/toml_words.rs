//! Mistakes in TOML files, in the words of TOML rather than of Rust: those of test files, machines and boards alike.

use crate::diag;

/// Maximum number of characters of a line that a report shows.
const LINE_SHOWN: usize = 100;

/// A line of a file, with a mark below a place in it, both from 1; empty if the place is beyond what is shown.
pub fn marked(line: &str, (number, column): (u32, u32)) -> String {
    let text: String = line.replace('\t', " ").chars().take(LINE_SHOWN).collect();
    let before = column as usize - 1;
    if text.trim().is_empty() || before > text.chars().count() {
        return String::new();
    }
    let number = number.to_string();
    let margin = " ".repeat(number.len());
    let mark = " ".repeat(before);
    format!("\n {number} | {text}\n {margin} | {mark}^")
}

/// Message of the TOML reader, in the words of TOML rather than of Rust; for an unknown field with the name that is
/// meant, if it is known.
pub fn message(message: &str) -> String {
    if message.contains("$__toml_private") {
        return "write a date or a time in quotes".to_string();
    }
    let unknown = message
        .strip_prefix("unknown field `")
        .and_then(|rest| rest.split_once('`'));
    if let Some((field, known)) = unknown {
        let known = known.split('`').skip(1).step_by(2);
        let longer = known.clone().find(|known| known.starts_with(field));
        if let Some(near) = diag::did_you_mean(field, known).or(longer) {
            return format!("unknown field `{field}`: did you mean `{near}`?");
        }
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
        (
            "invalid type: map, expected a sequence",
            "write tables of this name in double brackets",
        ),
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
    words
        .iter()
        .fold(message, |text, (from, to)| text.replace(from, to))
}

#[cfg(test)]
mod tests {
    use super::{marked, message};

    #[test]
    fn whole_numbers_have_their_range() {
        let of_serde = "invalid value: integer `-5`, expected u32";
        let said = "invalid value: integer `-5`, expected a whole number from 0 to 4294967295";
        assert_eq!(message(of_serde), said);
    }

    #[test]
    fn a_mark_stands_below_its_column() {
        assert_eq!(marked("a = 1", (12, 5)), "\n 12 | a = 1\n    |     ^");
        assert_eq!(marked("", (1, 1)), "");
    }
}
