//! Human-readable texts that can be said in other languages.
//!
//! What a diagnostic says stands in English where the diagnostic is made, as with `format!`. A [`Phrase`] keeps the
//! sentence as it stands there, which a translation is found by, and its arguments.

use crate::{Device, DeviceRun, Index, Instr, Number, OperandKind};
use std::borrow::Cow;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

/// A text in English, with the sentence and the arguments that it is made of.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Phrase {
    english: Cow<'static, str>,
    sentence: &'static str,
    arguments: Vec<(&'static str, Argument)>,
}

/// What a sentence has in place of `{name}`.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Argument {
    /// The same in all languages: a device, a number, an instruction, a name.
    Same(String),
    /// A text that is said in each language. Sentences of many parts share them.
    Phrase(Arc<Phrase>),
}

impl Argument {
    /// In English.
    fn english(&self) -> &str {
        match self {
            Argument::Same(text) => text,
            Argument::Phrase(phrase) => phrase,
        }
    }
}

/// Longest quotation of a source that a phrase repeats in full, in characters; commands and file names are shorter.
const LONGEST: usize = 100;
/// Length of the beginning of a longer one that a phrase shows.
const SHOWN: usize = 40;

/// Returns true if a quotation is longer than a reader needs to recognise it.
fn is_long(text: &str) -> bool {
    text.chars().nth(LONGEST).is_some()
}

/// The beginning of a long quotation.
fn beginning(text: &str) -> String {
    text.chars().take(SHOWN).chain(['…']).collect()
}

/// A text whose parts in back quotes are short enough.
fn shortened(text: String) -> String {
    if text.len() <= LONGEST || !text.split('`').skip(1).step_by(2).any(is_long) {
        return text;
    }
    let parts = text.split('`').enumerate().map(|(nth, part)| {
        if nth % 2 == 1 && is_long(part) {
            Cow::Owned(beginning(part))
        } else {
            Cow::Borrowed(part)
        }
    });
    parts.collect::<Vec<_>>().join("`")
}

/// Returns true if an argument of a sentence stands in back quotes.
fn is_quoted(sentence: &str, name: &str) -> bool {
    let place = sentence.find(&format!("{{{name}}}"));
    place.is_some_and(|at| sentence[..at].matches('`').count() % 2 == 1)
}

impl Phrase {
    /// A sentence with its arguments. Of a long argument that stands in back quotes, a quotation of the source, only
    /// the beginning is shown. [`phrase!`](crate::phrase!) writes the list of arguments.
    pub fn new(sentence: &'static str, arguments: Vec<(&'static str, Argument)>) -> Self {
        let mut arguments = arguments;
        for (name, argument) in &mut arguments {
            if let Argument::Same(text) = argument
                && is_long(text)
                && is_quoted(sentence, name)
            {
                *text = beginning(text);
            }
        }
        let english = match arguments.as_slice() {
            [] => Cow::Borrowed(sentence),
            _ => Cow::Owned(filled(sentence, &arguments)),
        };
        Phrase {
            english,
            sentence,
            arguments,
        }
    }

    /// The sentence with `{name}` for each argument; empty for a text that has no translation, such as an error of the
    /// system.
    pub fn sentence(&self) -> &'static str {
        self.sentence
    }

    /// Its arguments.
    pub fn arguments(&self) -> &[(&'static str, Argument)] {
        &self.arguments
    }

    /// In English.
    pub fn as_str(&self) -> &str {
        &self.english
    }
}

/// A sentence with its arguments in English.
fn filled(sentence: &'static str, arguments: &[(&'static str, Argument)]) -> String {
    let mut text = String::with_capacity(sentence.len() + 32);
    let mut rest = sentence;
    while let Some((before, after)) = rest.split_once('{') {
        let (name, after) = after.split_once('}').unwrap_or((after, ""));
        let argument = arguments.iter().find(|(known, _)| *known == name);
        text.push_str(before);
        text.push_str(argument.map_or("", |(_, argument)| argument.english()));
        rest = after;
    }
    text.push_str(rest);
    text
}

/// Returns true if each `{name}` of a sentence is an argument and each argument occurs.
#[doc(hidden)]
pub const fn fits(sentence: &str, names: &[&str]) -> bool {
    let text = sentence.as_bytes();
    let mut occurs = [false; 16];
    let mut at = 0;
    while at < text.len() {
        if text[at] == b'{' {
            let begin = at + 1;
            while at < text.len() && text[at] != b'}' {
                at += 1;
            }
            let mut found = false;
            let mut nth = 0;
            while nth < names.len() {
                if is_at(text, begin, at, names[nth].as_bytes()) {
                    occurs[nth] = true;
                    found = true;
                }
                nth += 1;
            }
            if !found {
                return false;
            }
        }
        at += 1;
    }
    let mut nth = 0;
    while nth < names.len() {
        if !occurs[nth] {
            return false;
        }
        nth += 1;
    }
    true
}

const fn is_at(text: &[u8], begin: usize, end: usize, name: &[u8]) -> bool {
    if end - begin != name.len() {
        return false;
    }
    let mut at = 0;
    while at < name.len() {
        if text[begin + at] != name[at] {
            return false;
        }
        at += 1;
    }
    true
}

/// A human-readable text: a sentence in English, and the arguments that stand in it as `{name}`, each as `name` or
/// `name = value`. It may be said in another language, where the sentence is found by what is written here.
///
/// ```
/// use rungc_syntax::phrase;
/// let wanted = 2;
/// let text = phrase!("`{name}` needs {wanted} operands", name = "MOV", wanted);
/// assert_eq!(text.as_str(), "`MOV` needs 2 operands");
/// ```
///
/// An argument that is missing, or that the sentence does not have, is an error of the compiler:
///
/// ```compile_fail
/// rungc_syntax::phrase!("`{name}` needs {wanted} operands", name = "MOV");
/// ```
#[macro_export]
macro_rules! phrase {
    ($sentence:literal $(, $name:ident $(= $value:expr)?)* $(,)?) => {{
        const _: () = assert!(
            $crate::fits($sentence, &[$(stringify!($name)),*]),
            "the arguments are not those of the sentence"
        );
        $crate::Phrase::new($sentence, vec![$((
            stringify!($name),
            $crate::Say::said(&$crate::phrase!(@value $name $(, $value)?)),
        )),*])
    }};
    (@value $name:ident) => { $name };
    (@value $name:ident, $value:expr) => { $value };
}

/// What can be an argument of a phrase.
pub trait Say {
    /// As an argument.
    fn said(&self) -> Argument;
}

impl Say for Phrase {
    fn said(&self) -> Argument {
        Argument::Phrase(Arc::new(self.clone()))
    }
}

impl<T: Say + ?Sized> Say for &T {
    fn said(&self) -> Argument {
        (**self).said()
    }
}

macro_rules! same_in_all_languages {
    ($($of:ty)*) => {
        $(impl Say for $of {
            fn said(&self) -> Argument {
                Argument::Same(self.to_string())
            }
        })*
    };
}

same_in_all_languages!(
    str String smol_str::SmolStr fmt::Arguments<'_> Cow<'_, str>
    char u8 u16 u32 u64 usize i16 i32 i64
    Device DeviceRun Index Instr Number OperandKind
);

/// As a text in English: data is the same in all languages.
impl serde::Serialize for Phrase {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl Default for Phrase {
    /// An empty text.
    fn default() -> Self {
        "".into()
    }
}

impl Deref for Phrase {
    type Target = str;

    fn deref(&self) -> &str {
        self.as_str()
    }
}

impl AsRef<str> for Phrase {
    fn as_ref(&self) -> &str {
        self.as_str()
    }
}

impl fmt::Display for Phrase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl PartialEq<str> for Phrase {
    fn eq(&self, other: &str) -> bool {
        self.as_str() == other
    }
}

impl PartialEq<&str> for Phrase {
    fn eq(&self, other: &&str) -> bool {
        self.as_str() == *other
    }
}

impl PartialEq<String> for Phrase {
    fn eq(&self, other: &String) -> bool {
        self.as_str() == other
    }
}

/// A text without a translation.
impl From<String> for Phrase {
    fn from(text: String) -> Self {
        Phrase {
            english: Cow::Owned(shortened(text)),
            sentence: "",
            arguments: Vec::new(),
        }
    }
}

/// A text without a translation.
impl From<&String> for Phrase {
    fn from(text: &String) -> Self {
        text.clone().into()
    }
}

impl From<&'static str> for Phrase {
    fn from(sentence: &'static str) -> Self {
        Phrase {
            english: Cow::Borrowed(sentence),
            sentence,
            arguments: Vec::new(),
        }
    }
}

impl From<Cow<'static, str>> for Phrase {
    fn from(text: Cow<'static, str>) -> Self {
        match text {
            Cow::Borrowed(sentence) => sentence.into(),
            Cow::Owned(text) => text.into(),
        }
    }
}
