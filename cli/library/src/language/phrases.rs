//! What diagnostics say, in the language of the user.
//!
//! The sentence in English, as it is where the diagnostic is made, gives the identifier of its message in `phrases/`.

use super::{Language, messages};
use fluent_bundle::FluentArgs;
use rungc_syntax::{Argument, Phrase};
use std::borrow::Cow;

/// Words of a sentence in its identifier.
const WORDS: usize = 8;

/// Identifier of the message that translates a sentence: its first words, and a hash of the sentence.
pub fn identifier(sentence: &str) -> String {
    let words = sentence.split(|c: char| !c.is_ascii_alphanumeric());
    let words = words.filter(|word| !word.is_empty()).take(WORDS);
    let words: Vec<_> = words.map(str::to_ascii_lowercase).collect();
    // FNV-1a, 32 bits.
    let hash = sentence.bytes().fold(0x811C_9DC5_u32, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    });
    format!("t-{}-{hash:08x}", words.join("-"))
}

/// A text in a language, in English where the language lacks it.
pub fn phrase(language: Language, phrase: &Phrase) -> Cow<'_, str> {
    match translated(language, phrase) {
        Some(text) => Cow::Owned(text),
        None => Cow::Borrowed(phrase.as_str()),
    }
}

/// A sentence without arguments in a language, if the language has it.
pub fn sentence(language: Language, english: &str) -> Option<String> {
    if language == Language::English {
        return None;
    }
    let bundle = messages(language);
    let message = bundle.get_message(&identifier(english))?;
    let text = bundle.format_pattern(message.value()?, None, &mut Vec::new());
    Some(text.into_owned())
}

fn translated(language: Language, phrase: &Phrase) -> Option<String> {
    if language == Language::English || phrase.sentence().is_empty() {
        return None;
    }
    let bundle = messages(language);
    let message = bundle.get_message(&identifier(phrase.sentence()))?;
    let mut values = FluentArgs::new();
    for (name, argument) in phrase.arguments() {
        let value = match argument {
            Argument::Same(text) => text.clone(),
            Argument::Phrase(inner) => self::phrase(language, inner).into_owned(),
        };
        values.set(*name, value);
    }
    let text = bundle.format_pattern(message.value()?, Some(&values), &mut Vec::new());
    Some(text.into_owned())
}
