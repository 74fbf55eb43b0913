//! What diagnostics look like: a snapshot of each code's wrong example, and of programs that show details. The right example of a
//! code has no error and not that code.

use rungc_frontend::read_text;
use rungc_ir::check::check;
use rungc_ir::model::{Model, ModelId};
use rungc_ir::resolve::resolve;
use rungc_syntax::{Diagnostic, Severity, Source, codes};
use std::fmt::Write;

/// All findings about a program, with its source.
fn findings(model: ModelId, text: &str) -> (Source, Vec<Diagnostic>) {
    let read = read_text("program", text);
    let (resolved, mut diagnostics) = resolve(&read.program, Model::get(model));
    diagnostics.extend(check(&resolved).sorted());
    diagnostics.extend(read.diagnostics.sorted());
    let sorted = diagnostics.sorted();
    (read.program.source, sorted)
}

/// Findings as plain text: code, place, message, what stands there, other places, help, the PLC's number.
fn render(source: &Source, diagnostics: &[Diagnostic]) -> String {
    let place = |start: u32| {
        let (line, column) = source.line_col(start);
        format!("{line}:{column}")
    };
    let mut text = String::new();
    for diagnostic in diagnostics {
        let quoted = source.slice(diagnostic.span);
        let plc = diagnostic
            .plc_error
            .map_or_else(String::new, |code| format!(" (PLC error {code})"));
        let at = place(diagnostic.span.start);
        writeln!(text, "{} {at} {}{plc}", diagnostic.code, diagnostic.message).expect("a string");
        writeln!(text, "    {at} `{quoted}` {}", diagnostic.label).expect("a string");
        for other in &diagnostic.others {
            let (at, quoted) = (place(other.span.start), source.slice(other.span));
            writeln!(text, "    {at} `{quoted}` {}", other.text).expect("a string");
        }
        if let Some(help) = &diagnostic.help {
            writeln!(text, "    help: {help}").expect("a string");
        }
    }
    text
}

fn shown(model: ModelId, text: &str) -> String {
    let (source, diagnostics) = findings(model, text);
    render(&source, &diagnostics)
}

/// The model that the examples of a code are for.
fn model_of(code: &codes::Code) -> ModelId {
    code.model.map_or(ModelId::Fx3u, |name| {
        ModelId::from_name(name).expect("a model")
    })
}

#[test]
fn wrong_examples_show_their_code() {
    let mut pages = String::new();
    for code in codes::all()
        .into_iter()
        .filter(|code| !code.wrong.is_empty())
    {
        let (source, diagnostics) = findings(model_of(code), code.wrong);
        let rendered = render(&source, &diagnostics);
        assert!(
            diagnostics
                .iter()
                .any(|diagnostic| diagnostic.code == code.id),
            "{} is not shown:\n{rendered}",
            code.id
        );
        write!(
            pages,
            "--- {} {}\n{}\n{rendered}\n",
            code.id, code.name, code.wrong
        )
        .expect("a string");
    }
    insta::assert_snapshot!(pages);
}

#[test]
fn right_examples_are_right() {
    for code in codes::all()
        .into_iter()
        .filter(|code| !code.right.is_empty())
    {
        let (source, diagnostics) = findings(model_of(code), code.right);
        let wrong = diagnostics
            .iter()
            .any(|diagnostic| diagnostic.severity == Severity::Error || diagnostic.code == code.id);
        assert!(!wrong, "{}:\n{}", code.id, render(&source, &diagnostics));
    }
}
