//! Checks of a text before it is understood: how deep it nests, and which keywords and semicolons are missing.

use crate::ast::{Body, Closed, Stmt, StmtKind, Text, UnitKind};
use crate::parse;
use crate::token::{Lexeme, Token};
use rungc_syntax::{Diagnostic, Span, codes, phrase};

/// Depth of parentheses, and of IF, CASE and loops with their ELSIF.
const DEEPEST: usize = 48;
/// Number of tokens of a statement.
const LONGEST: usize = 800;

/// Rejects texts that nest deeper than anyone reads.
pub(crate) fn nesting(tokens: &[Lexeme], found: &mut Vec<Diagnostic>) {
    let (mut brackets, mut blocks, mut length) = (0usize, Vec::new(), 0usize);
    for lexeme in tokens {
        length += 1;
        match lexeme.token {
            Token::Sign("(" | "[") => brackets += 1,
            Token::Sign(")" | "]") => brackets = brackets.saturating_sub(1),
            Token::Sign(";") => (brackets, length) = (0, 0),
            token
                if ["IF", "CASE", "FOR", "WHILE", "REPEAT"]
                    .iter()
                    .any(|word| token.is(word)) =>
            {
                length = 0;
                blocks.push(1);
            }
            token if token.is("ELSIF") => {
                length = 0;
                if let Some(last) = blocks.last_mut() {
                    *last += 1;
                }
            }
            token
                if ["END_IF", "END_CASE", "END_FOR", "END_WHILE", "END_REPEAT"]
                    .iter()
                    .any(|word| token.is(word)) =>
            {
                blocks.pop();
            }
            token
                if ["THEN", "ELSE", "OF", "DO"]
                    .iter()
                    .any(|word| token.is(word)) =>
            {
                length = 0
            }
            _ => {}
        }
        let deep = brackets > DEEPEST || blocks.iter().sum::<usize>() > DEEPEST;
        let what = if deep {
            phrase!("this nests deeper than {most} levels", most = DEEPEST)
        } else if length > LONGEST {
            phrase!(
                "this statement has more than {most} words and signs",
                most = LONGEST
            )
        } else {
            continue;
        };
        let error = codes::ST_UNSUPPORTED.at(lexeme.span, what);
        found.push(error.help("assign parts to labels, or split the statement"));
        return;
    }
}

/// Reports keywords in the place of a name: before the type of a label, structure or function, or after the first word
/// of a unit.
pub(crate) fn names(tokens: &[Lexeme], found: &mut Vec<Diagnostic>) {
    for (at, lexeme) in tokens
        .iter()
        .enumerate()
        .filter(|(_, one)| parse::is_keyword(one.token))
    {
        let word = lexeme.token.text().to_ascii_uppercase();
        let ends = word == "ELSE" || word.starts_with("END_") || word.starts_with("VAR");
        let next = tokens.get(at + 1).map(|next| next.token);
        let before = at.checked_sub(1).map(|before| tokens[before].token);
        let begins = ["PROGRAM", "FUNCTION", "FUNCTION_BLOCK"];
        let is_unit = before.is_some_and(|before| begins.iter().any(|word| before.is(word)));
        if !ends && (is_unit || next == Some(Token::Sign(":"))) {
            let name = lexeme.token.text();
            let what = phrase!("`{name}` is a keyword, which cannot be a name", name);
            let error = codes::ST_DECLARED_TWICE.at(lexeme.span, what);
            found.push(error.help("choose another name"));
        }
    }
}

/// Reports keywords and semicolons that are missing.
pub(crate) fn endings(text: &Text, found: &mut Vec<Diagnostic>) {
    let sections = text.units.iter().flat_map(|unit| &unit.sections);
    for section in text
        .globals
        .iter()
        .chain(sections)
        .filter(|section| !section.is_closed)
    {
        let last = section
            .variables
            .last()
            .map_or(section.keyword.span, |last| last.span);
        found.push(missing("END_VAR", last, section.keyword.span));
    }
    for one in text.structures.iter().filter(|one| !one.is_closed) {
        let last = one.members.last().map_or(one.name.span, |last| last.span);
        found.push(missing("END_STRUCT", last, one.name.span));
    }
    for unit in &text.units {
        body(&unit.body, found);
        if !unit.is_closed {
            let keyword = match unit.kind {
                UnitKind::Program => "END_PROGRAM",
                UnitKind::Function => "END_FUNCTION",
                UnitKind::Block => "END_FUNCTION_BLOCK",
            };
            let last = unit.body.last().map_or(unit.name.span, |last| last.span);
            found.push(missing(keyword, last, unit.head));
        }
    }
}

/// A keyword is missing after a place; what it would end begins at another.
fn missing(keyword: &str, after: Span, begins: Span) -> Diagnostic {
    let at = Span::new(after.end, after.end);
    let error = codes::ST_SYNTAX.at(at, phrase!("`{keyword}` is missing", keyword));
    error
        .label("expected at the latest here")
        .other(begins, "this is not closed")
}

fn body(statements: &Body, found: &mut Vec<Diagnostic>) {
    for stmt in statements {
        statement(stmt, found);
    }
}

fn statement(stmt: &Stmt, found: &mut Vec<Diagnostic>) {
    if !stmt.is_ended {
        let at = Span::new(stmt.span.end, stmt.span.end);
        let error = codes::ST_SYNTAX.at(at, "a statement ends in `;`");
        found.push(error.label("`;` is missing here"));
    }
    let mut closed = |closed: &Closed, keyword: &str| {
        if !closed.is_closed {
            found.push(missing(keyword, stmt.span, closed.head));
        }
    };
    match &stmt.kind {
        StmtKind::If(arms, otherwise, end) => {
            closed(end, "END_IF");
            arms.iter()
                .map(|arm| &arm.body)
                .chain(otherwise)
                .for_each(|inner| body(inner, found));
        }
        StmtKind::Case(_, arms, otherwise, end) => {
            closed(end, "END_CASE");
            arms.iter()
                .map(|arm| &arm.body)
                .chain(otherwise)
                .for_each(|inner| body(inner, found));
        }
        StmtKind::For(for_) => {
            closed(&for_.closed, "END_FOR");
            body(&for_.body, found);
        }
        StmtKind::While(_, inner, end) => {
            closed(end, "END_WHILE");
            body(inner, found);
        }
        StmtKind::Repeat(inner, _, end) => {
            closed(end, "END_REPEAT");
            body(inner, found);
        }
        _ => {}
    }
}
