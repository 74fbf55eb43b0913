//! Headings of matrices, in English, German and Chinese.

/// Kind of a column.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Heading {
    /// Names of causes, or their conditions.
    Cause,
    /// Conditions of causes, in addition to their names.
    Condition,
    /// Texts for readers; numbers.
    Description,
    /// No heading.
    Empty,
    /// An effect.
    Other,
}

/// Subject of a row that is not a cause.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum About {
    /// Conditions of the effects.
    Effects,
    /// Conditions that reset them.
    Reset,
    /// Time in which they follow their causes.
    Time,
    /// Texts for readers.
    Nothing,
}

const CAUSES: &[&str] = &["cause", "causes", "ursache", "ursachen", "原因"];

const CONDITIONS: &[&str] = &[
    "condition",
    "device",
    "input",
    "tag",
    "bedingung",
    "operand",
    "eingang",
    "gerät",
    "条件",
    "软元件",
    "输入",
];

const NUMBERS: &[&str] = &["no", "no.", "nr", "nr.", "#", "id", "序号"];

const DESCRIPTIONS: &[&str] = &[
    "description",
    "comment",
    "remark",
    "text",
    "beschreibung",
    "bezeichnung",
    "kommentar",
    "bemerkung",
    "说明",
    "注释",
];

const EFFECTS: &[&str] = &[
    "effect",
    "effects",
    "output",
    "device",
    "condition",
    "wirkung",
    "wirkungen",
    "auswirkung",
    "ausgang",
    "operand",
    "bedingung",
    "结果",
    "输出",
    "软元件",
];

const RESETS: &[&str] = &["reset", "rücksetzen", "quittierung", "quittieren", "复位"];

const TIMES: &[&str] = &["time", "within", "zeit", "时间"];

/// A word without the marks around it, in lower case.
fn plain(text: &str) -> String {
    let text = text.trim().trim_end_matches(':');
    text.trim().to_lowercase()
}

/// The kind of a column with this heading.
pub(super) fn heading(text: &str) -> Heading {
    let word = plain(text);
    let first = word
        .split(['/', '\\', '|'])
        .next()
        .unwrap_or_default()
        .trim();
    let is_among = |words: &[&str]| words.contains(&&*word);
    if word.is_empty() {
        Heading::Empty
    } else if CAUSES.contains(&first) {
        Heading::Cause
    } else if is_among(CONDITIONS) {
        Heading::Condition
    } else if is_among(DESCRIPTIONS) || is_among(NUMBERS) {
        Heading::Description
    } else {
        Heading::Other
    }
}

/// The subject of a row that begins with this; `None` for a cause.
pub(super) fn row(text: &str) -> Option<About> {
    let word = plain(text);
    let rows = [
        (EFFECTS, About::Effects),
        (RESETS, About::Reset),
        (TIMES, About::Time),
        (DESCRIPTIONS, About::Nothing),
    ];
    let found = rows.iter().find(|(words, _)| words.contains(&&*word));
    found.map(|(_, about)| *about)
}
