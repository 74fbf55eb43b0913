//! Human-readable reports in the language of the user.
//!
//! A language has a folder in `locales/`, with files in the format of [Project Fluent](https://projectfluent.org). A
//! message in `codes/` has the identifier of a diagnostic code: its value is the title, and its attribute `text` the
//! explanation. `phrases/` has what diagnostics, `--help` and `rungc why` say, and `report.ftl` what surrounds them.
//! Above each translation, a comment repeats the English text that it is made from, so that a test finds those that no
//! longer fit.

use fluent_bundle::concurrent::FluentBundle;
use fluent_bundle::{FluentArgs, FluentResource, FluentValue};
pub use phrases::{identifier, phrase, sentence};
pub use rungc_project::Language;
use rungc_syntax::codes::Code;
use rungc_syntax::diag::grouped;
use std::borrow::Cow;
use std::sync::LazyLock;

/// The files of a language that hold the texts of codes.
macro_rules! codes_of {
    ($folder:literal) => {
        codes_of!($folder: "boards" "explore" "files" "fleets" "labels" "logic" "modules" "operands" "ports"
            "practice" "project" "properties" "reading" "structure" "structured" "vendor")
    };
    ($folder:literal: $($file:literal)*) => {
        [$(include_str!(concat!("../locales/", $folder, "/codes/", $file, ".ftl"))),*]
    };
}

/// The files of a language that hold what diagnostics say.
macro_rules! phrases_of {
    ($folder:literal) => {
        phrases_of!($folder: "checks" "help" "lowering" "operands" "project" "reading" "structured" "why")
    };
    ($folder:literal: $($file:literal)*) => {
        [$(include_str!(concat!("../locales/", $folder, "/phrases/", $file, ".ftl"))),*]
    };
}

const ENGLISH: [&str; 2] = [
    include_str!("../locales/en/report.ftl"),
    include_str!("../locales/en/document.ftl"),
];
const CHINESE: [&str; 2] = [
    include_str!("../locales/zh-CN/report.ftl"),
    include_str!("../locales/zh-CN/document.ftl"),
];
const CHINESE_CODES: [&str; 16] = codes_of!("zh-CN");
const CHINESE_PHRASES: [&str; 8] = phrases_of!("zh-CN");

type Bundle = FluentBundle<FluentResource>;

static IN_ENGLISH: LazyLock<Bundle> = LazyLock::new(|| bundle(Language::English, &ENGLISH));
static IN_CHINESE: LazyLock<Bundle> = LazyLock::new(|| {
    let files: Vec<_> = CHINESE
        .into_iter()
        .chain(CHINESE_CODES)
        .chain(CHINESE_PHRASES)
        .collect();
    bundle(Language::Chinese, &files)
});

/// Reads the files of a language. Tests hold them to the format; what a damaged one has before its error is used.
fn bundle(language: Language, files: &[&str]) -> Bundle {
    let locale = language.tag().parse().unwrap_or_default();
    let mut bundle = FluentBundle::new_concurrent(vec![locale]);
    // Terminals would show the marks around arguments.
    bundle.set_use_isolating(false);
    bundle.set_formatter(Some(|value, _| match value {
        FluentValue::Number(number) => Some(grouped(number.value as usize)),
        _ => None,
    }));
    for file in files {
        let read = FluentResource::try_new((*file).to_owned()).unwrap_or_else(|(read, _)| read);
        bundle.add_resource_overriding(read);
    }
    bundle
}

fn messages(language: Language) -> &'static Bundle {
    match language {
        Language::English => &IN_ENGLISH,
        Language::Chinese => &IN_CHINESE,
    }
}

/// Argument of a message.
#[derive(Clone, Copy, Debug)]
pub enum Argument<'a> {
    /// A number, which may choose a plural.
    Number(usize),
    /// A text as it is.
    Text(&'a str),
}

impl From<usize> for Argument<'_> {
    fn from(number: usize) -> Self {
        Argument::Number(number)
    }
}

impl<'a> From<&'a str> for Argument<'a> {
    fn from(text: &'a str) -> Self {
        Argument::Text(text)
    }
}

impl<'a> From<&'a String> for Argument<'a> {
    fn from(text: &'a String) -> Self {
        Argument::Text(text)
    }
}

/// A message of `report.ftl` with its arguments, in English where a language lacks it.
pub fn message(language: Language, id: &str, arguments: &[(&str, Argument)]) -> String {
    let mut values = FluentArgs::new();
    for &(name, argument) in arguments {
        values.set(
            name,
            match argument {
                Argument::Number(number) => FluentValue::from(number),
                Argument::Text(text) => FluentValue::from(text),
            },
        );
    }
    let formatted = [language, Language::English]
        .into_iter()
        .find_map(|language| {
            let bundle = messages(language);
            let pattern = bundle.get_message(id)?.value()?;
            let mut errors = Vec::new();
            let text = bundle.format_pattern(pattern, Some(&values), &mut errors);
            Some(text.into_owned())
        });
    formatted.unwrap_or_else(|| id.to_owned())
}

/// Title of a diagnostic code, in English where a language lacks it.
pub fn title(language: Language, code: &'static Code) -> Cow<'static, str> {
    translated(language, code, None).unwrap_or(Cow::Borrowed(code.title))
}

/// Explanation of a diagnostic code, in English where a language lacks it.
pub fn text(language: Language, code: &'static Code) -> Cow<'static, str> {
    translated(language, code, Some("text")).unwrap_or(Cow::Borrowed(code.text))
}

/// Value or attribute of the message of a code.
fn translated(
    language: Language,
    code: &'static Code,
    attribute: Option<&str>,
) -> Option<Cow<'static, str>> {
    if language == Language::English {
        return None;
    }
    let bundle = messages(language);
    let message = bundle.get_message(code.id)?;
    let pattern = match attribute {
        Some(attribute) => message.get_attribute(attribute)?.value(),
        None => message.value()?,
    };
    Some(bundle.format_pattern(pattern, None, &mut Vec::new()))
}

mod phrases;
#[cfg(test)]
mod tests;
