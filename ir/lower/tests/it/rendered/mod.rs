//! Findings about a program as plain text, for snapshots.

use rungc_analysis::check::check;
use rungc_analysis::resolve::resolve;
use rungc_frontend::{Read, read_bytes, read_text};
use rungc_models::{Model, ModelId};
use rungc_syntax::{Diagnostic, Source, SourceKind};
use std::fmt::Write;

/// All findings about a program, with its source.
pub fn findings(model: ModelId, text: &str) -> (Source, Vec<Diagnostic>) {
    let is_structured = |read: Read| matches!(read.program.kind, SourceKind::StructuredText);
    if read_bytes("program", text.as_bytes()).is_ok_and(is_structured) {
        return findings_in_text(model, text);
    }
    let read = read_text("program", text);
    let (resolved, mut found) = resolve(&read.program, Model::get(model));
    found.extend(check(&resolved).sorted());
    let mut diagnostics = read.diagnostics;
    diagnostics.refine(&found);
    let sorted = diagnostics.sorted();
    (read.program.source, sorted)
}

/// What is found in structured text, before and after it is a list.
fn findings_in_text(model: ModelId, text: &str) -> (Source, Vec<Diagnostic>) {
    let read = read_bytes("program.st", text.as_bytes());
    let mut read = read.expect("a text");
    let model = Model::get(model);
    let mut found = rungc_structured::compile(&mut read.program, model);
    let (resolved, more) = resolve(&read.program, model);
    found.extend(more.sorted());
    found.extend(check(&resolved).sorted());
    (read.program.source, found.sorted())
}

/// Findings as plain text: code, place, message, quoted text, other places, help, the PLC's number.
pub fn render(source: &Source, diagnostics: &[Diagnostic]) -> String {
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
        if let Some(fix) = &diagnostic.fix {
            let kind = if fix.certain { "fix" } else { "suggestion" };
            let edits = fix.edits.iter().map(|edit| {
                let (at, quoted) = (place(edit.span.start), source.slice(edit.span));
                format!("{at} {quoted:?} to {:?}", edit.text)
            });
            let edits = edits.collect::<Vec<_>>().join(", ");
            writeln!(text, "    {kind}: {}: {edits}", fix.title).expect("a string");
        }
    }
    text
}

/// Findings as text.
pub fn shown(model: ModelId, text: &str) -> String {
    let (source, diagnostics) = findings(model, text);
    render(&source, &diagnostics)
}
