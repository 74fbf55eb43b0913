//! Properties as statements. Their words are none of conditions, so that they stand out; what stands in quotes is a
//! comment of a device.

use rungc_project::Named;
use rungc_project::property::PropertyKind;
use rungc_sim::property::ParseError;
use rungc_syntax::Span;

/// How statements are written.
const FORMS: &str = "a property is `never A`, `always A`, `reachable A`, `whenever A then B within 500ms` or \
                     `stays A after B until C`";

/// Words with which a statement begins, and those that divide it.
const WORDS: [(&str, &[&str]); 5] = [
    ("never", &[]),
    ("always", &[]),
    ("reachable", &[]),
    ("whenever", &["then", "within"]),
    ("stays", &["after", "until"]),
];

/// Reads a statement. The places of its conditions are those in the text.
pub(super) fn read(text: &str) -> Result<PropertyKind, ParseError> {
    let mut words = words(text).into_iter();
    let form = |at| ParseError {
        at,
        why: FORMS.to_string(),
    };
    let (begin, first) = words.next().ok_or_else(|| form(0))?;
    let known = WORDS.iter().find(|(word, _)| *word == first);
    let (_, divide) = known.ok_or_else(|| form(begin))?;
    let mut begun: Vec<(usize, &str)> = vec![(begin, first)];
    for (at, word) in words.filter(|(_, word)| divide.contains(word)) {
        if begun.iter().any(|(_, other)| *other == word) {
            let why = format!("`{word}` stands here twice; {FORMS}");
            return Err(ParseError { at, why });
        }
        begun.push((at, word));
    }
    let ends = begun.iter().skip(1).map(|(at, _)| *at).chain([text.len()]);
    let parts = begun.iter().zip(ends).map(|(&(at, word), end)| {
        let from = at + word.len();
        (word, part(text, from, end))
    });
    let mut parts: Vec<(&str, Named)> = parts.collect();
    let mut take = |wanted: &str| {
        let at = parts.iter().position(|(word, _)| *word == wanted)?;
        Some(parts.remove(at).1)
    };
    let required = |part: Option<Named>| part.ok_or_else(|| form(text.len()));
    Ok(match first {
        "never" => PropertyKind::Never(required(take(first))?),
        "always" => PropertyKind::Always(required(take(first))?),
        "reachable" => PropertyKind::Reachable(required(take(first))?),
        "whenever" => PropertyKind::Whenever {
            when: required(take(first))?,
            then: required(take("then"))?,
            within: take("within"),
        },
        _ => PropertyKind::Stays {
            holds: required(take(first))?,
            after: take("after"),
            until: take("until"),
        },
    })
}

/// A part of the text, without the spaces around it.
fn part(text: &str, from: usize, end: usize) -> Named {
    let inner = &text[from..end];
    let from = from + (inner.len() - inner.trim_start().len());
    let inner = inner.trim();
    let place = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
    Named {
        text: inner.to_string(),
        span: Span::new(place(from), place(from + inner.len())),
    }
}

/// The words outside quotes, with their places.
fn words(text: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut at = 0;
    for (n, piece) in text.split('"').enumerate() {
        let mut from = at;
        let is_other = |c: char| !(c.is_alphanumeric() || c == '_' || c == '.');
        for run in piece.split_inclusive(is_other).filter(|_| n % 2 == 0) {
            let word = run.trim_end_matches(is_other);
            found.extend((!word.is_empty()).then_some((from, word)));
            from += run.len();
        }
        at += piece.len() + 1;
    }
    found
}

#[cfg(test)]
mod tests {
    use crate::request::Reader;
    use rungc_lower::compile::CompileOptions;
    use rungc_sim::property::Property;

    /// A statement as it is read, or its mistake under it.
    fn read(text: &str) -> String {
        let program =
            rungc_frontend::read_text("a.il", ";! M1 = \"then\"\nLD X000\nOUT Y000\nEND\n");
        let reader = Reader {
            program: &program.program,
            options: &CompileOptions::default(),
        };
        match reader.statement(text) {
            Ok(property) => match property {
                Property::Whenever { within_ms, .. } => format!("whenever, {within_ms} ms"),
                Property::Stays { after, .. } => format!("stays, after: {}", after.is_some()),
                other => format!("{} conditions", other.conditions().len()),
            },
            Err(error) => format!("{}^ {}", " ".repeat(error.at), error.why),
        }
    }

    #[test]
    fn statements_are_read_whole() {
        for (text, expected) in [
            ("never Y000 & X001", "1 conditions"),
            ("  always !Y000 | X000", "1 conditions"),
            ("reachable Y000", "1 conditions"),
            ("whenever X000 then Y000", "whenever, 0 ms"),
            ("whenever (X000) then (Y000) within 2s", "whenever, 2000 ms"),
            ("stays Y000", "stays, after: false"),
            ("stays Y000 until X001 after X000", "stays, after: true"),
        ] {
            assert_eq!(read(text), expected, "{text}");
        }
    }

    #[test]
    fn mistakes_in_statements_have_a_place() {
        let texts = [
            "",
            "Y000 & Y001",
            "never",
            "never Y000 &",
            "never Y777",
            "whenever X000",
            "whenever X000 then Y000 then Y001",
            "whenever X000 then Y000 within soon",
            "whenever X000 then X000 | !X000",
            "stays Y000 until X9 until",
            "never \"then",
        ];
        let all = texts.map(|text| format!("{text}\n{}\n", read(text)));
        insta::assert_snapshot!(all.concat());
    }
}
