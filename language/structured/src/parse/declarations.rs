//! Units, sections of variables, and structures.

use super::expressions::expression;
use super::statements::body;
use super::{ENDS, Rule, closing, is_any, keyword, name, place, rest, semicolon, sign};
use crate::ast::{
    Body, Configuration, Expr, ExprKind, Name, Runs, Section, Stmt, StmtKind, Structure, Task,
    Text, TypeName, Unit, UnitKind, Variable,
};
use crate::token::{Lexeme, Token};
use chumsky::prelude::*;

enum Part {
    Unit(Box<Unit>),
    Globals(Section),
    Structures(Vec<Structure>),
    Configuration(Configuration),
    Unread,
}

/// A whole text.
pub(super) fn text<'t>() -> Rule<'t, Text> {
    let unread = any().map(|_| Part::Unread);
    let unit = choice((
        unit("PROGRAM", "END_PROGRAM", UnitKind::Program),
        unit("FUNCTION_BLOCK", "END_FUNCTION_BLOCK", UnitKind::Block),
        unit("FUNCTION", "END_FUNCTION", UnitKind::Function),
    ));
    let part = choice((
        unit.map(|unit| Part::Unit(Box::new(unit))).boxed(),
        section(true).map(Part::Globals).boxed(),
        structures().map(Part::Structures).boxed(),
        configuration().map(Part::Configuration).boxed(),
    ));
    let skipped = any()
        .filter(|lexeme: &Lexeme| !starts(lexeme.token))
        .repeated();
    let unread = unread.then_ignore(skipped);
    part.recover_with(via_parser(unread))
        .repeated()
        .collect::<Vec<_>>()
        .then_ignore(end())
        .map(|parts| {
            let mut text = Text::default();
            for part in parts {
                match part {
                    Part::Unit(unit) => text.units.push(*unit),
                    Part::Globals(section) => text.globals.push(section),
                    Part::Structures(all) => text.structures.extend(all),
                    Part::Configuration(one) => text.configurations.push(one),
                    Part::Unread => {}
                }
            }
            text
        })
        .boxed()
}

fn starts(token: Token) -> bool {
    is_any(
        token,
        &[
            "PROGRAM",
            "FUNCTION",
            "FUNCTION_BLOCK",
            "TYPE",
            "VAR_GLOBAL",
            "CONFIGURATION",
        ],
    )
}

/// `CONFIGURATION Line … END_CONFIGURATION`, with or without a RESOURCE around the tasks.
fn configuration<'t>() -> Rule<'t, Configuration> {
    enum Row {
        Task(Task),
        Program(Runs),
    }
    let setting = name().then_ignore(sign(":=")).then(expression());
    let settings = setting.separated_by(sign(",")).collect::<Vec<_>>();
    let settings = settings.delimited_by(sign("("), sign(")"));
    let task = keyword("TASK").ignore_then(name()).then(settings.or_not());
    let task = task.map(|(name, settings)| {
        let settings = settings.unwrap_or_default();
        Row::Task(Task { name, settings })
    });
    let of_task = keyword("WITH").ignore_then(name()).or_not();
    let program = keyword("PROGRAM").ignore_then(name()).then(of_task);
    let program = program.then(sign(":").ignore_then(name()).or_not());
    // An instance of a program has its type after a colon.
    let program = program.map(|((name, task), of)| {
        let program = of.unwrap_or(name);
        Row::Program(Runs { program, task })
    });
    let row = choice((task.boxed(), program.boxed())).then_ignore(semicolon());
    let rows = row.repeated().collect::<Vec<_>>();
    let resource = keyword("RESOURCE")
        .then(name())
        .then(keyword("ON").then(name()));
    let inside = resource
        .ignore_then(rows.clone())
        .then_ignore(keyword("END_RESOURCE"))
        .then_ignore(semicolon());
    keyword("CONFIGURATION")
        .then_ignore(name())
        .then(choice((inside.boxed(), rows.boxed())))
        .then_ignore(keyword("END_CONFIGURATION"))
        .then_ignore(semicolon())
        .map(|(head, rows)| {
            let mut all = Configuration {
                head,
                tasks: Vec::new(),
                programs: Vec::new(),
            };
            for row in rows {
                match row {
                    Row::Task(task) => all.tasks.push(task),
                    Row::Program(runs) => all.programs.push(runs),
                }
            }
            all
        })
        .boxed()
}

fn unit<'t>(first: &'static str, last: &'static str, kind: UnitKind) -> Rule<'t, Unit> {
    let of = sign(":").ignore_then(type_name()).or_not();
    keyword(first)
        .then(name())
        .then(of)
        .then_ignore(semicolon())
        .then(section(false).repeated().collect::<Vec<_>>())
        .then(whole_body())
        .then(closing(last))
        .map(
            move |(((((head, name), returns), sections), body), is_closed)| Unit {
                kind,
                name,
                returns,
                sections,
                body,
                head,
                is_closed,
                is_library: false,
            },
        )
        .boxed()
}

/// Statements of a unit. A keyword that ends nothing is reported and left out.
fn whole_body<'t>() -> Rule<'t, Body> {
    const INNER: [&str; 9] = [
        "ELSIF",
        "ELSE",
        "END_IF",
        "END_CASE",
        "END_FOR",
        "END_WHILE",
        "UNTIL",
        "END_REPEAT",
        "END_VAR",
    ];
    let stray = any()
        .filter(|lexeme: &Lexeme| is_any(lexeme.token, &INNER))
        .then(sign(";").or_not());
    let stray = stray.validate(|(lexeme, _), e, emitter| {
        let span: SimpleSpan = e.span();
        let at = SimpleSpan::from(span.start..span.start + 1);
        emitter.emit(Rich::custom(
            at,
            format!("`{}` ends nothing here", lexeme.token.text()),
        ));
        Vec::<Stmt>::new()
    });
    // The label of a CASE outside of one, where no statement begins.
    let other = any()
        .filter(|lexeme: &Lexeme| !is_any(lexeme.token, &ENDS))
        .rewind()
        .ignore_then(rest())
        .validate(|(), e, emitter| {
            let span: SimpleSpan = e.span();
            let at = SimpleSpan::from(span.start..span.start + 1);
            emitter.emit(Rich::custom(at, "this is not a statement"));
            let kind = StmtKind::Unread;
            let span = place(e);
            vec![Stmt {
                kind,
                span,
                is_ended: true,
            }]
        });
    let more = choice((stray.boxed(), other.boxed()))
        .then(body())
        .map(|(mut left, more)| {
            left.extend(more);
            left
        });
    body()
        .foldl(more.repeated(), |mut all, more: Body| {
            all.extend(more);
            all
        })
        .boxed()
}

fn section<'t>(global: bool) -> Rule<'t, Section> {
    const LOCAL: [&str; 7] = [
        "VAR",
        "VAR_INPUT",
        "VAR_OUTPUT",
        "VAR_IN_OUT",
        "VAR_TEMP",
        "VAR_EXTERNAL",
        "VAR_CONSTANT",
    ];
    const GLOBAL: [&str; 1] = ["VAR_GLOBAL"];
    let first = any()
        .filter(move |lexeme: &Lexeme| {
            is_any(lexeme.token, if global { &GLOBAL[..] } else { &LOCAL })
        })
        .map(|lexeme: Lexeme| Name {
            text: lexeme.token.text().to_ascii_uppercase().into(),
            span: lexeme.span,
        })
        .labelled(if global { "`VAR_GLOBAL`" } else { "`VAR`" });
    let kind = choice((keyword("CONSTANT").to(true), keyword("RETAIN").to(false)));
    first
        .then(kind.or_not())
        .then(variables())
        .then(closing("END_VAR"))
        .then_ignore(semicolon())
        .map(|(((keyword, kind), variables), is_closed)| Section {
            is_constant: kind == Some(true) || keyword.text == "VAR_CONSTANT",
            keyword,
            variables,
            is_closed,
        })
        .boxed()
}

fn variables<'t>() -> Rule<'t, Vec<Variable>> {
    let declared = variable()
        .map(Some)
        .recover_with(via_parser(rest().to(None)));
    declared
        .repeated()
        .collect::<Vec<_>>()
        .map(|all| all.into_iter().flatten().collect())
        .boxed()
}

fn variable<'t>() -> Rule<'t, Variable> {
    let names = name()
        .separated_by(sign(","))
        .at_least(1)
        .collect::<Vec<_>>();
    let member = name().then_ignore(sign(":=")).then(device());
    let members = member
        .separated_by(sign(","))
        .at_least(1)
        .collect::<Vec<_>>();
    let members = members.delimited_by(sign("("), sign(")"));
    let place_of = keyword("AT").ignore_then(choice((
        members.map(|members| (None, members)).boxed(),
        device().map(|device| (Some(device), Vec::new())).boxed(),
    )));
    let place_of = place_of.boxed();
    let initial = sign(":=").ignore_then(choice((expression(), values())));
    names
        .then(place_of.or_not())
        .then_ignore(sign(":"))
        .then(type_name())
        .then(initial.or_not())
        .then(semicolon())
        .map_with(|((((names, place_of), of), initial), is_ended), e| {
            let (stated, members) = place_of.unwrap_or_default();
            Variable {
                names,
                place: stated,
                members,
                of,
                initial,
                is_ended,
                span: place(e),
            }
        })
        .boxed()
}

/// Initial values of an array: `[8(0)]`, `[1, 2, 3]`.
fn values<'t>() -> Rule<'t, Expr> {
    let value = expression();
    let repeated = value.clone().delimited_by(sign("("), sign(")"));
    let one = value.then(repeated.or_not()).map(|(first, repeated)| {
        let value = match (first.kind, repeated) {
            // `8(0)` where 8 is a name would be a call.
            (_, Some(repeated)) => repeated.kind,
            (kind, None) => kind,
        };
        match value {
            ExprKind::Number(text) => text.chars().all(|c| matches!(c, '0' | '.')),
            ExprKind::Name(text) => text.eq_ignore_ascii_case("FALSE"),
            _ => false,
        }
    });
    let all = one.separated_by(sign(",")).collect::<Vec<_>>();
    all.delimited_by(sign("["), sign("]"))
        .map_with(|all, e| Expr {
            kind: ExprKind::Initial(all.iter().all(|is_zero| *is_zero)),
            span: place(e),
        })
        .boxed()
}

/// A device, its bit, or an address, as an expression.
fn device<'t>() -> Rule<'t, Expr> {
    super::expressions::variable(expression())
        .labelled("a device")
        .boxed()
}

fn type_name<'t>() -> Rule<'t, TypeName> {
    let bound = expression().then_ignore(sign("..")).then(expression());
    let bounds = bound
        .separated_by(sign(","))
        .at_least(1)
        .collect::<Vec<_>>();
    let array = keyword("ARRAY")
        .ignore_then(bounds.delimited_by(sign("["), sign("]")))
        .then_ignore(keyword("OF"));
    let length = any()
        .filter(|lexeme: &Lexeme| matches!(lexeme.token, Token::Number(_) | Token::Word(_)))
        .map(|lexeme: Lexeme| Name {
            text: lexeme.token.text().into(),
            span: lexeme.span,
        })
        .boxed();
    let length = choice((
        length.clone().delimited_by(sign("("), sign(")")),
        length.delimited_by(sign("["), sign("]")),
    ));
    array
        .or_not()
        .then(name())
        .then(length.or_not())
        .map_with(|((bounds, name), length), e| TypeName {
            name,
            bounds: bounds.unwrap_or_default(),
            length,
            span: place(e),
        })
        .labelled("a type")
        .boxed()
}

fn structures<'t>() -> Rule<'t, Vec<Structure>> {
    let one = name()
        .then_ignore(sign(":"))
        .then_ignore(keyword("STRUCT"))
        .then(variables())
        .then(closing("END_STRUCT"))
        .then_ignore(semicolon())
        .map(|((name, members), is_closed)| Structure {
            name,
            members,
            is_closed,
        });
    keyword("TYPE")
        .ignore_then(one.repeated().at_least(1).collect::<Vec<_>>())
        .then_ignore(keyword("END_TYPE"))
        .then_ignore(semicolon())
        .boxed()
}

impl Expr {
    /// The name alone, if the expression is one.
    pub(crate) fn name(&self) -> Option<&str> {
        match &self.kind {
            ExprKind::Name(name) => Some(name),
            _ => None,
        }
    }
}
