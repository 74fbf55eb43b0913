//! The words and signs of a text, with their places. Every text can be split: a character that begins nothing is a
//! separate token, which the parser reports.

use chumsky::error::EmptyErr;
use chumsky::prelude::*;
use rungc_syntax::Span;

/// A word or sign.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Token<'s> {
    /// Name, keyword, device or constant: `Start`, `IF`, `X010`, `K4M0`, `U0\G5`.
    Word(&'s str),
    /// Number without a type: `12`, `1.5`, `16#FF`.
    Number(&'s str),
    /// Value with its type: `T#5s`, `INT#5`, `WORD#16#FF`.
    Typed(&'s str),
    /// Address: `%MX0.5`.
    Address(&'s str),
    /// Characters in quotation marks.
    Text(&'s str),
    /// Operator or delimiter.
    Sign(&'s str),
    /// Beginning of a comment or text that does not end.
    Open(&'s str),
    /// Character that begins nothing.
    Stray(&'s str),
}

impl<'s> Token<'s> {
    /// The text that it was written as, without quotation marks.
    pub(crate) fn text(self) -> &'s str {
        match self {
            Token::Word(text)
            | Token::Number(text)
            | Token::Typed(text)
            | Token::Address(text)
            | Token::Text(text)
            | Token::Sign(text)
            | Token::Open(text)
            | Token::Stray(text) => text,
        }
    }

    /// Returns true for this keyword, in upper or lower case.
    pub(crate) fn is(self, keyword: &str) -> bool {
        matches!(self, Token::Word(word) if word.eq_ignore_ascii_case(keyword))
    }
}

/// A token and its place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Lexeme<'s> {
    pub token: Token<'s>,
    pub span: Span,
}

type Extra = extra::Err<EmptyErr>;

/// Operators and delimiters, longer ones first.
const SIGNS: [&str; 25] = [
    ":=", "=>", "<>", "<=", ">=", "**", "..", ";", ":", ",", "(", ")", "[", "]", "=", "<", ">",
    "+", "-", "*", "/", "&", ".", "#", "^",
];

fn is_word(c: &char) -> bool {
    c.is_alphanumeric() || *c == '_'
}

/// The tokens of a text; comments and white space are left out.
pub(crate) fn tokens(text: &str) -> Vec<Lexeme<'_>> {
    let digits = || {
        any()
            .filter(|c: &char| c.is_ascii_digit() || *c == '_')
            .repeated()
            .at_least(1)
    };
    let rest = || any().filter(is_word).repeated();
    let exponent = one_of("eE").then(one_of("+-").or_not()).then(digits());
    let fraction = just('.').then(digits());
    let based = just('#').then(any().filter(is_word).repeated().at_least(1));
    let number = one_of('0'..='9')
        .then(digits().or_not())
        .then(choice((
            based.ignored(),
            fraction.then(exponent.or_not()).ignored(),
            exponent.ignored(),
            empty(),
        )))
        .to_slice()
        .map(Token::Number);
    let value = any()
        .filter(|c: &char| is_word(c) || *c == '.')
        .repeated()
        .at_least(1);
    let signed = one_of("+-").or_not().then(value);
    let typed = any()
        .filter(|c: &char| c.is_alphabetic())
        .then(rest())
        .then(just('#'))
        .then(signed)
        .then(just('#').then(value).or_not())
        .to_slice()
        .map(Token::Typed);
    let word = any()
        .filter(|c: &char| c.is_alphabetic() || *c == '_')
        .then(rest())
        .then(
            just('\\')
                .then(any().filter(is_word).repeated().at_least(1))
                .or_not(),
        )
        .to_slice()
        .map(Token::Word);
    let address = just('%')
        .then(any().filter(|c: &char| is_word(c) || *c == '.').repeated())
        .to_slice()
        .map(Token::Address);
    let quoted = |quote| {
        // `$` begins a character that is written otherwise.
        let written = just('$').then(any().filter(|c| *c != '\n')).ignored();
        let plain = any().filter(move |c| *c != quote && *c != '\n').ignored();
        let content = written.or(plain).repeated();
        content.to_slice().delimited_by(just(quote), just(quote))
    };
    let text_token = choice((quoted('\''), quoted('"'))).map(Token::Text);
    let sign = choice(SIGNS.map(just)).to_slice().map(Token::Sign);
    let open = choice((just("(*").to_slice(), one_of("'\"").to_slice())).map(Token::Open);
    let stray = any().to_slice().map(Token::Stray);
    let token = choice((typed, word, number, address, text_token, open, sign, stray));

    let block = just("(*")
        .then(any().and_is(just("*)").not()).repeated())
        .then(just("*)"))
        .ignored();
    let line = just("//").then(none_of("\r\n").repeated()).ignored();
    let blank = any().filter(|c: &char| c.is_whitespace() || matches!(c, '\u{FEFF}' | '\0'));
    let space = choice((blank.ignored(), block, line)).repeated();

    let lexeme = token.map_with(|token, e| {
        let span: SimpleSpan = e.span();
        Lexeme {
            token,
            span: Span::new(span.start as u32, span.end as u32),
        }
    });
    let all = space.ignore_then(lexeme.then_ignore(space).repeated().collect::<Vec<_>>());
    let all: Boxed<'_, '_, &str, _, Extra> = all.boxed();
    all.parse(text).into_output().unwrap_or_default()
}
