//! Letters, digits and what separates words.

use super::{Extra, Rule};
use chumsky::combinator::Repeated;
use chumsky::prelude::*;

/// A letter in upper or lower case.
pub(super) fn letter<'s>(upper: char) -> impl Rule<'s, char> {
    any().filter(move |c: &char| c.to_ascii_uppercase() == upper)
}

/// Decimal digits, at least one.
pub(super) fn digits<'s>() -> impl Rule<'s, &'s str> {
    any()
        .filter(char::is_ascii_digit)
        .repeated()
        .at_least(1)
        .to_slice()
}

/// Separator of words: white space, commas, and NUL, which some editors leave.
fn separator<'s>() -> impl Rule<'s, char> {
    any().filter(|c: &char| c.is_whitespace() || matches!(c, ',' | '\0'))
}

/// Any number of separators.
pub(super) fn separators<'s>() -> Repeated<impl Rule<'s, char>, char, &'s str, Extra> {
    separator().repeated()
}

/// White space within what should be one word.
pub(super) fn blanks<'s>() -> impl Rule<'s, ()> {
    text::whitespace().at_least(1)
}

/// `;` or `//`.
pub(super) fn comment_start<'s>() -> impl Rule<'s, ()> {
    choice((just(';').ignored(), just("//").ignored()))
}

/// Beginning of a comment in other languages.
pub(super) fn foreign_comment_start<'s>() -> impl Rule<'s, ()> {
    choice((just("(*").ignored(), just('#').ignored()))
}

/// The end of a word: a separator, a comment or the end of the line follows.
pub(super) fn word_end<'s>() -> impl Rule<'s, ()> {
    choice((separator().ignored(), end(), comment_start())).rewind()
}

/// Anything up to the end of the word; a string is one word with all its spaces.
pub(super) fn word<'s>() -> impl Rule<'s, &'s str> {
    let quoted = just('"')
        .then(none_of('"').repeated())
        .then(just('"').or_not());
    let plain = any().and_is(word_end().not());
    choice((quoted.ignored(), plain.ignored()))
        .repeated()
        .at_least(1)
        .to_slice()
}
