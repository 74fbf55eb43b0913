//! Recognition of structured text. Its instructions depend on the model, so they come when it is compiled for one.

use crate::Read;
use rungc_syntax::{Program, Source, SourceKind};

/// Keywords that a text of declarations and statements begins with.
const FIRST: [&str; 5] = [
    "PROGRAM",
    "FUNCTION",
    "FUNCTION_BLOCK",
    "TYPE",
    "VAR_GLOBAL",
];

/// Returns true for a file that is called one of structured text.
pub(crate) fn is_named(name: &str) -> bool {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending);
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("st"))
}

/// Returns true for structured text, by its name or by what it begins with and holds. Units of other languages have
/// declarations, too, but no statements that end in `;`.
pub(crate) fn detect(name: &str, text: &str) -> bool {
    const END_OF_DECLARATIONS: &str = "END_VAR";
    let body = || {
        let declared = text.to_ascii_uppercase().rfind(END_OF_DECLARATIONS);
        declared.map_or(text, |at| &text[at + END_OF_DECLARATIONS.len()..])
    };
    is_named(name) || begins(text) && body().contains(';')
}

/// Returns true if the first word that is not a comment begins a unit.
fn begins(text: &str) -> bool {
    let mut rest = text.trim_start_matches('\u{FEFF}').trim_start();
    while let Some(comment) = rest.strip_prefix("(*") {
        let Some((_, after)) = comment.split_once("*)") else {
            return false;
        };
        rest = after.trim_start();
    }
    let word = rest
        .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .next();
    word.is_some_and(|word| FIRST.iter().any(|first| word.eq_ignore_ascii_case(first)))
}

/// A program whose instructions are not there yet.
pub(crate) fn read(name: &str, text: &str) -> Read {
    Read {
        program: Program {
            source: Source::new(name, text),
            kind: SourceKind::StructuredText,
            unread: vec![0],
            ..Program::default()
        },
        ..Read::default()
    }
}
