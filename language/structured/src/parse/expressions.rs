//! Expressions, with the precedence of IEC 61131-3.

use super::{Rule, keyword, name, place, sign};
use crate::ast::{Arg, Expr, ExprKind, Op};
use crate::token::{Lexeme, Token};
use chumsky::prelude::*;
use rungc_syntax::Span;

/// An expression.
pub(super) fn expression<'t>() -> Rule<'t, Expr> {
    recursive(|expression| {
        let expression = expression.boxed();
        let unary = unary(primary(expression));
        let power = level(unary, vec![("**", Op::Power)], vec![]);
        let product = level(
            power,
            vec![("*", Op::Mul), ("/", Op::Div)],
            vec![("MOD", Op::Mod)],
        );
        let sum = level(product, vec![("+", Op::Add), ("-", Op::Sub)], vec![]);
        let order = level(
            sum,
            vec![("<=", Op::Le), (">=", Op::Ge), ("<", Op::Lt), (">", Op::Gt)],
            vec![],
        );
        let equal = level(order, vec![("=", Op::Eq), ("<>", Op::Ne)], vec![]);
        let and = level(equal, vec![("&", Op::And)], vec![("AND", Op::And)]);
        let xor = level(and, vec![], vec![("XOR", Op::Xor)]);
        level(xor, vec![], vec![("OR", Op::Or)])
    })
    .labelled("an expression")
    .boxed()
}

/// Operands of one precedence, from left to right.
fn level<'t>(
    operand: Rule<'t, Expr>,
    signs: Vec<(&'static str, Op)>,
    words: Vec<(&'static str, Op)>,
) -> Rule<'t, Expr> {
    let of_sign = |(text, op)| sign(text).to(op).boxed();
    let of_word = |(text, op)| keyword(text).to(op).boxed();
    let signs = signs.into_iter().map(of_sign);
    let all: Vec<Rule<'t, Op>> = signs.chain(words.into_iter().map(of_word)).collect();
    let operator = choice(all).labelled("an operator");
    operand
        .clone()
        .foldl(operator.then(operand).repeated(), |left, (op, right)| {
            let span = left.span.to(right.span);
            Expr {
                kind: ExprKind::Binary(op, Box::new(left), Box::new(right)),
                span,
            }
        })
        .boxed()
}

/// `NOT` and signs in front of an operand. Two of a kind cancel each other.
fn unary<'t>(operand: Rule<'t, Expr>) -> Rule<'t, Expr> {
    let plus = sign("+").map_with(|(), e| (None, place(e)));
    let minus = sign("-").map_with(|(), e| (Some(false), place(e)));
    let not = keyword("NOT").map(|span| (Some(true), span));
    let prefixes = choice((plus, minus, not)).repeated().collect::<Vec<_>>();
    prefixes
        .then(operand)
        .map(|(prefixes, operand): (Vec<(Option<bool>, Span)>, Expr)| {
            let mut kept: Vec<(bool, Span)> = Vec::new();
            for (prefix, span) in prefixes {
                let Some(prefix) = prefix else { continue };
                match kept.last() {
                    Some((last, _)) if *last == prefix => drop(kept.pop()),
                    _ => kept.push((prefix, span)),
                }
            }
            kept.into_iter()
                .rev()
                .fold(operand, |operand, (is_not, span)| {
                    let span = span.to(operand.span);
                    let operand = Box::new(operand);
                    let kind = match is_not {
                        true => ExprKind::Not(operand),
                        false => ExprKind::Neg(operand),
                    };
                    Expr { kind, span }
                })
        })
        .labelled("an expression")
        .boxed()
}

enum Suffix {
    Member(smol_str::SmolStr, Span),
    Index(Vec<Expr>, Span),
    Call(Vec<Arg>, Span),
}

/// A name with its members, indexes and arguments, a constant, or an expression in parentheses.
fn primary<'t>(expression: Rule<'t, Expr>) -> Rule<'t, Expr> {
    let constant = select! {
        Lexeme { token: Token::Number(text), span } => Expr { kind: ExprKind::Number(text.into()), span },
        Lexeme { token: Token::Typed(text), span } => Expr { kind: ExprKind::Typed(text.into()), span },
        Lexeme { token: Token::Text(text), span } => Expr { kind: ExprKind::Text(text.into()), span },
    };
    let bracketed = expression.clone().delimited_by(sign("("), sign(")"));
    let bracketed = bracketed.map_with(|inner: Expr, e| Expr {
        span: place(e),
        ..inner
    });
    choice((variable(expression), constant.boxed(), bracketed.boxed())).boxed()
}

/// A name or address with its members, indexes and arguments.
pub(super) fn variable<'t>(expression: Rule<'t, Expr>) -> Rule<'t, Expr> {
    let named = name().map(|name| Expr {
        kind: ExprKind::Name(name.text),
        span: name.span,
    });
    let address = any()
        .filter(|lexeme: &Lexeme| matches!(lexeme.token, Token::Address(_)))
        .map(|lexeme: Lexeme| Expr {
            kind: ExprKind::Address(lexeme.token.text().into()),
            span: lexeme.span,
        });
    let member = any()
        .filter(|lexeme: &Lexeme| matches!(lexeme.token, Token::Word(_) | Token::Number(_)))
        .map_with(|lexeme: Lexeme, e| Suffix::Member(lexeme.token.text().into(), place(e)))
        .labelled(super::NUMBERED);
    let list = expression.clone().separated_by(sign(",")).at_least(1);
    let index = list
        .collect::<Vec<_>>()
        .delimited_by(sign("["), sign("]"))
        .map_with(|indexes, e| Suffix::Index(indexes, place(e)));
    let named_arg = name().then_ignore(choice((sign(":="), sign("=>"))));
    let arg = named_arg
        .or_not()
        .then(expression)
        .map(|(name, value)| Arg { name, value });
    let args = arg.separated_by(sign(",")).collect::<Vec<_>>();
    let call = args
        .delimited_by(sign("("), sign(")"))
        .map_with(|args, e| Suffix::Call(args, place(e)));
    let suffix = choice((
        sign(".").ignore_then(member).boxed(),
        index.boxed(),
        call.boxed(),
    ));
    choice((named.boxed(), address.boxed()))
        .foldl(suffix.repeated(), |of, suffix| {
            let (span, of) = (of.span, Box::new(of));
            let (kind, end) = match suffix {
                Suffix::Member(name, end) => (ExprKind::Member(of, name), end),
                Suffix::Index(indexes, end) => (ExprKind::Index(of, indexes), end),
                Suffix::Call(args, end) => (ExprKind::Call(of, args), end),
            };
            let span = span.to(end);
            Expr { kind, span }
        })
        .boxed()
}
