//! Statements.

use super::expressions::{expression, variable};
use super::{ENDS, Rule, closing, is_any, keyword, place, rest, semicolon, sign};
use crate::ast::{Arm, Body, Closed, Expr, ExprKind, For, Label, Stmt, StmtKind};
use crate::token::{Lexeme, Token};
use chumsky::prelude::*;

/// Statements up to a keyword that ends them.
pub(super) fn body<'t>() -> Rule<'t, Body> {
    recursive(|body| {
        let body: Rule<'t, Body> = body.boxed();
        let expression = expression();
        let simple = simple(&expression);
        let kinds = choice((
            simple,
            if_(&expression, &body),
            case(&expression, &body),
            for_(&expression, &body),
            while_(&expression, &body),
            repeat(&expression, &body),
        ));
        let statement = kinds
            .then(semicolon())
            .map_with(|(kind, is_ended), e| Stmt {
                kind,
                span: place(e),
                is_ended,
            });
        let empty = sign(";").map_with(|(), e| Stmt {
            kind: StmtKind::Empty,
            span: place(e),
            is_ended: true,
        });
        let unread = rest().map_with(|(), e| Stmt {
            kind: StmtKind::Unread,
            span: place(e),
            is_ended: true,
        });
        let statement = choice((statement.boxed(), empty.boxed()));
        let statement = statement.recover_with(via_parser(unread));
        label_head()
            .not()
            .ignore_then(statement)
            .repeated()
            .collect()
            .boxed()
    })
    .labelled("a statement")
    .boxed()
}

/// Beginning of a label of CASE: a value and a colon, comma or dots after it.
fn label_head<'t>() -> Rule<'t, ()> {
    let value = any().filter(|lexeme: &Lexeme| {
        matches!(
            lexeme.token,
            Token::Word(_) | Token::Number(_) | Token::Typed(_)
        )
    });
    let after =
        any().filter(|lexeme: &Lexeme| matches!(lexeme.token, Token::Sign(":" | "," | "..")));
    sign("-").or_not().then(value).then(after).ignored().boxed()
}

/// Assignment, call, EXIT, RETURN.
fn simple<'t>(expression: &Rule<'t, Expr>) -> Rule<'t, StmtKind> {
    let assigned = sign(":=").ignore_then(expression.clone());
    let assign = variable(expression.clone())
        .then(assigned.or_not())
        .map(|(target, value)| match value {
            Some(value) => StmtKind::Assign(target, value),
            None => StmtKind::Call(target),
        });
    let exit = keyword("EXIT").to(StmtKind::Exit);
    let return_ = keyword("RETURN").to(StmtKind::Return);
    choice((assign.boxed(), exit.boxed(), return_.boxed())).boxed()
}

/// An expression and the keyword after it. What cannot be read up to the keyword is reported.
fn up_to<'t>(expression: &Rule<'t, Expr>, word: &'static str) -> Rule<'t, Expr> {
    let inner = any().filter(move |lexeme: &Lexeme| {
        lexeme.token != Token::Sign(";") && !lexeme.token.is(word) && !is_any(lexeme.token, &ENDS)
    });
    let unread = inner.repeated().then(keyword(word)).map_with(|_, e| Expr {
        kind: ExprKind::Unread,
        span: place(e),
    });
    expression
        .clone()
        .then_ignore(keyword(word))
        .recover_with(via_parser(unread))
        .boxed()
}

fn if_<'t>(expression: &Rule<'t, Expr>, body: &Rule<'t, Body>) -> Rule<'t, StmtKind> {
    let arm = |word| {
        keyword(word)
            .then(up_to(expression, "THEN"))
            .map_with(|(head, when), e| (head, when, place(e)))
            .then(body.clone())
            .map(|((head, when, span), body)| (head, Arm { when, body, span }))
    };
    let others = arm("ELSIF")
        .map(|(_, arm)| arm)
        .repeated()
        .collect::<Vec<_>>();
    let otherwise = keyword("ELSE").ignore_then(body.clone()).or_not();
    arm("IF")
        .then(others)
        .then(otherwise)
        .then(closing("END_IF"))
        .map(|((((head, first), others), otherwise), is_closed)| {
            let arms = std::iter::once(first).chain(others).collect();
            StmtKind::If(arms, otherwise, Closed { head, is_closed })
        })
        .boxed()
}

fn case<'t>(expression: &Rule<'t, Expr>, body: &Rule<'t, Body>) -> Rule<'t, StmtKind> {
    let label = expression
        .clone()
        .then(sign("..").ignore_then(expression.clone()).or_not())
        .map(|label: Label| label);
    let labels = label
        .separated_by(sign(","))
        .at_least(1)
        .collect::<Vec<_>>();
    let arm = labels
        .then_ignore(sign(":"))
        .map_with(|when, e| (when, place(e)))
        .then(body.clone())
        .map(|((when, span), body)| Arm { when, body, span });
    let otherwise = keyword("ELSE")
        .ignore_then(sign(":").or_not())
        .ignore_then(body.clone())
        .or_not();
    keyword("CASE")
        .then(up_to(expression, "OF"))
        .then(arm.repeated().collect::<Vec<_>>())
        .then(otherwise)
        .then(closing("END_CASE"))
        .map(|((((head, of), arms), otherwise), is_closed)| {
            StmtKind::Case(of, arms, otherwise, Closed { head, is_closed })
        })
        .boxed()
}

fn for_<'t>(expression: &Rule<'t, Expr>, body: &Rule<'t, Body>) -> Rule<'t, StmtKind> {
    let by = keyword("BY").ignore_then(expression.clone()).or_not();
    keyword("FOR")
        .then(variable(expression.clone()))
        .then_ignore(sign(":="))
        .then(expression.clone())
        .then_ignore(keyword("TO"))
        .then(expression.clone())
        .then(by)
        .then_ignore(keyword("DO"))
        .map_with(|parts, e| (parts, place(e)))
        .then(body.clone())
        .then(closing("END_FOR"))
        .map(|((parts, body), is_closed)| {
            let (((((head, variable), from), to), by), span) = parts;
            let closed = Closed { head, is_closed };
            StmtKind::For(Box::new(For {
                variable,
                from,
                to,
                by,
                body,
                closed,
                span,
            }))
        })
        .boxed()
}

fn while_<'t>(expression: &Rule<'t, Expr>, body: &Rule<'t, Body>) -> Rule<'t, StmtKind> {
    keyword("WHILE")
        .then(up_to(expression, "DO"))
        .then(body.clone())
        .then(closing("END_WHILE"))
        .map(|(((head, when), body), is_closed)| {
            StmtKind::While(when, body, Closed { head, is_closed })
        })
        .boxed()
}

fn repeat<'t>(expression: &Rule<'t, Expr>, body: &Rule<'t, Body>) -> Rule<'t, StmtKind> {
    keyword("REPEAT")
        .then(body.clone())
        .then_ignore(keyword("UNTIL"))
        .then(expression.clone())
        .then(closing("END_REPEAT"))
        .map(|(((head, body), until), is_closed)| {
            StmtKind::Repeat(body, until, Closed { head, is_closed })
        })
        .boxed()
}
