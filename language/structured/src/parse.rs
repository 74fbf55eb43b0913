//! Grammar of structured text, over tokens. A statement or declaration that cannot be read is reported and left out up
//! to its semicolon; keywords and semicolons that are missing are noted in the tree, where a later pass reports them.

mod declarations;
mod expressions;
mod statements;

use crate::ast::{Name, Text};
use crate::token::{Lexeme, Token};
use chumsky::error::{RichPattern, RichReason};
use chumsky::input::MapExtra;
use chumsky::inspector::SimpleState;
use chumsky::prelude::*;
use rungc_syntax::{Diagnostic, Phrase, Span, codes, phrase};

type Tokens<'t> = &'t [Lexeme<'t>];
type State<'t> = SimpleState<Tokens<'t>>;
type Extra<'t> = extra::Full<Rich<'t, Lexeme<'t>>, State<'t>, ()>;
type Rule<'t, O> = Boxed<'t, 't, Tokens<'t>, O, Extra<'t>>;
type Matched<'t, 'p> = MapExtra<'t, 'p, Tokens<'t>, Extra<'t>>;

/// Words that name nothing.
const KEYWORDS: [&str; 47] = [
    "CONFIGURATION",
    "END_CONFIGURATION",
    "PROGRAM",
    "END_PROGRAM",
    "FUNCTION",
    "END_FUNCTION",
    "FUNCTION_BLOCK",
    "END_FUNCTION_BLOCK",
    "TYPE",
    "END_TYPE",
    "STRUCT",
    "END_STRUCT",
    "VAR",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR_IN_OUT",
    "VAR_GLOBAL",
    "VAR_EXTERNAL",
    "VAR_TEMP",
    "VAR_CONSTANT",
    "END_VAR",
    "ARRAY",
    "OF",
    "IF",
    "THEN",
    "ELSIF",
    "ELSE",
    "END_IF",
    "CASE",
    "END_CASE",
    "FOR",
    "TO",
    "BY",
    "DO",
    "END_FOR",
    "WHILE",
    "END_WHILE",
    "REPEAT",
    "UNTIL",
    "END_REPEAT",
    "EXIT",
    "RETURN",
    "AND",
    "OR",
    "XOR",
    "NOT",
    "MOD",
];

/// Keywords that end a part of the text: a statement that cannot be read ends before them.
const ENDS: [&str; 23] = [
    "END_PROGRAM",
    "END_FUNCTION",
    "END_FUNCTION_BLOCK",
    "END_TYPE",
    "END_STRUCT",
    "END_VAR",
    "ELSIF",
    "ELSE",
    "END_IF",
    "END_CASE",
    "END_FOR",
    "END_WHILE",
    "UNTIL",
    "END_REPEAT",
    "PROGRAM",
    "FUNCTION",
    "FUNCTION_BLOCK",
    "CONFIGURATION",
    "TYPE",
    "VAR",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR_GLOBAL",
];

/// Returns true for a word that names nothing.
pub(crate) fn is_keyword(token: Token) -> bool {
    is_any(token, &KEYWORDS)
}

fn is_any(token: Token, keywords: &[&str]) -> bool {
    keywords.iter().any(|keyword| token.is(keyword))
}

/// Place of what a rule has matched; of nothing, the place after the previous token.
fn place(matched: &mut Matched) -> Span {
    let span: SimpleSpan = matched.span();
    place_in(matched.state().0, span)
}

fn place_in(tokens: &[Lexeme], span: SimpleSpan) -> Span {
    let end = |at: usize| {
        let last = at
            .checked_sub(1)
            .map(|at| at.min(tokens.len().saturating_sub(1)));
        let last = last.and_then(|at| tokens.get(at));
        let first = || tokens.first().map_or(0, |first| first.span.start);
        last.map_or_else(first, |lexeme| lexeme.span.end)
    };
    if span.start >= span.end {
        let at = end(span.start);
        return Span::new(at, at);
    }
    let start = tokens.get(span.start);
    let start = start.map_or_else(|| end(span.start), |lexeme| lexeme.span.start);
    Span::new(start, end(span.end))
}

fn sign<'t>(sign: &'static str) -> Rule<'t, ()> {
    any()
        .filter(move |lexeme: &Lexeme| lexeme.token == Token::Sign(sign))
        .ignored()
        .labelled(format!("`{sign}`"))
        .boxed()
}

fn keyword<'t>(keyword: &'static str) -> Rule<'t, Span> {
    any()
        .filter(move |lexeme: &Lexeme| lexeme.token.is(keyword))
        .map(|lexeme: Lexeme| lexeme.span)
        .labelled(format!("`{keyword}`"))
        .boxed()
}

/// True if the keyword is there.
fn closing<'t>(word: &'static str) -> Rule<'t, bool> {
    keyword(word).or_not().map(|found| found.is_some()).boxed()
}

/// True if the semicolon is there. Where a word follows that may begin something else, it is missing; before other
/// tokens, what stands there is wrong.
fn semicolon<'t>() -> Rule<'t, bool> {
    const INNER: [&str; 10] = [
        "AND", "OR", "XOR", "NOT", "MOD", "THEN", "DO", "OF", "TO", "BY",
    ];
    let next = any().filter(|lexeme: &Lexeme| {
        matches!(lexeme.token, Token::Word(_)) && !is_any(lexeme.token, &INNER)
    });
    let missing = choice((next.rewind().ignored(), end())).to(false);
    choice((sign(";").to(true), missing.boxed())).boxed()
}

/// Word that is not a keyword.
fn name<'t>() -> Rule<'t, Name> {
    any()
        .filter(|lexeme: &Lexeme| {
            matches!(lexeme.token, Token::Word(_)) && !is_any(lexeme.token, &KEYWORDS)
        })
        .map(|lexeme: Lexeme| Name {
            text: lexeme.token.text().into(),
            span: lexeme.span,
        })
        .labelled("a name")
        .boxed()
}

/// Takes what cannot be read up to its semicolon, at least one token.
fn rest<'t>() -> Rule<'t, ()> {
    let inner = any()
        .filter(|lexeme: &Lexeme| lexeme.token != Token::Sign(";") && !is_any(lexeme.token, &ENDS));
    choice((
        inner
            .repeated()
            .at_least(1)
            .then(sign(";").or_not())
            .ignored(),
        sign(";"),
    ))
    .boxed()
}

/// Reads tokens. What cannot be read is reported.
pub(crate) fn parse(tokens: &[Lexeme], found: &mut Vec<Diagnostic>) -> Text {
    let mut state = SimpleState(tokens);
    let grammar = declarations::text();
    let (text, errors) = grammar
        .parse_with_state(tokens, &mut state)
        .into_output_errors();
    found.extend(errors.iter().map(|error| diagnostic(error, tokens)));
    text.unwrap_or_default()
}

fn diagnostic(error: &Rich<Lexeme>, tokens: &[Lexeme]) -> Diagnostic {
    let at = place_in(tokens, *error.span());
    let wanted: Vec<String> = match error.reason() {
        RichReason::ExpectedFound { expected, .. } => expected.iter().filter_map(label).collect(),
        RichReason::Custom(_) => Vec::new(),
    };
    let found = tokens.get(error.span().start);
    let message = match found {
        Some(lexeme) => phrase!("`{token}` cannot follow here", token = lexeme.token.text()),
        None => phrase!("the text ends here"),
    };
    let message = match (found.map(|lexeme| lexeme.token), error.found()) {
        (Some(Token::Open("(*")), _) => phrase!("this comment is not closed"),
        (Some(Token::Open(_)), _) => phrase!("these quotation marks are not closed on the line"),
        (Some(Token::Stray(text)), _) => {
            phrase!("`{text}` has no meaning in structured text", text)
        }
        _ => message,
    };
    let mut wanted = wanted;
    wanted.sort();
    wanted.dedup();
    let error = codes::ST_SYNTAX.at(at, message);
    match list(wanted.iter().map(|word| part(word))) {
        Some(wanted) => error.label(phrase!("expected {wanted}", wanted)),
        None => error,
    }
}

fn label(pattern: &RichPattern<Lexeme>) -> Option<String> {
    match pattern {
        RichPattern::Label(label) => Some(label.to_string()),
        _ => None,
    }
}

/// `a`, `b` or `c`.
fn list(words: impl DoubleEndedIterator<Item = Phrase>) -> Option<Phrase> {
    let mut words = words;
    let last = words.next_back()?;
    let before = words.reduce(|before, next| phrase!("{before}, {next}", before, next));
    Some(match before {
        Some(before) => phrase!("{before} or {last}", before, last),
        None => last,
    })
}

/// A part of a text that is expected.
fn part(label: &str) -> Phrase {
    match label {
        "a device" => phrase!("a device"),
        "a name" => phrase!("a name"),
        "a statement" => phrase!("a statement"),
        "a type" => phrase!("a type"),
        "an expression" => phrase!("an expression"),
        "an operator" => phrase!("an operator"),
        NUMBERED => phrase!("the name of a member or the number of a bit"),
        // A keyword or sign in back quotes.
        other => other.to_owned().into(),
    }
}

/// What follows the dot after a name.
const NUMBERED: &str = "the name of a member or the number of a bit";
