//! Diagnostics for people, drawn by ariadne.

use super::Findings;
use ariadne::{CharSet, Color, Config, IndexType, Label, Report, ReportKind, Source};
use rungc_syntax::{Diagnostic, Severity, Span};
use std::io::{self, Write};

/// Prints at most `limit` diagnostics (0: all).
pub fn print(
    findings: &Findings,
    limit: usize,
    color: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    if findings.diagnostics.is_empty() {
        return Ok(());
    }
    let name = findings.program.source.name.as_str();
    let source = Source::from(findings.program.source.text.as_str());
    let shown = if limit == 0 {
        findings.diagnostics.len()
    } else {
        limit
    };
    for diagnostic in findings.diagnostics.iter().take(shown) {
        report(diagnostic, name, findings.program.source.text.len(), color)
            .write((name, &source), &mut *out)?;
        writeln!(out)?;
    }
    let hidden = findings.diagnostics.len().saturating_sub(shown);
    if hidden > 0 {
        writeln!(out, "… and {hidden} more (--limit 0 prints all)\n")?;
    }
    Ok(())
}

fn report<'a>(
    d: &Diagnostic,
    name: &'a str,
    length: usize,
    color: bool,
) -> Report<'a, (&'a str, std::ops::Range<usize>)> {
    let place = |span: Span| {
        let range = span.range();
        (
            name,
            range.start.min(length)..range.end.min(length).max(range.start.min(length)),
        )
    };
    let (kind, main_color) = match d.severity {
        Severity::Error => (ReportKind::Custom("error", Color::Red), Color::Red),
        Severity::Warning => (ReportKind::Custom("warning", Color::Yellow), Color::Yellow),
    };
    let main = Label::new(place(d.span)).with_color(main_color);
    let config = Config::default()
        .with_color(color)
        .with_index_type(IndexType::Byte)
        .with_char_set(CharSet::Unicode);
    let mut report = Report::build(kind, place(d.span))
        .with_config(config)
        .with_code(d.code)
        .with_message(&d.message)
        .with_label(if d.label.is_empty() {
            main.with_message("here")
        } else {
            main.with_message(&d.label)
        });
    for other in &d.others {
        report = report.with_label(
            Label::new(place(other.span))
                .with_message(&other.text)
                .with_color(Color::Blue),
        );
    }
    if let Some(help) = &d.help {
        report = report.with_help(help);
    }
    let plc = d
        .plc_error
        .map(|code| format!("the PLC reports this as error {code}; "))
        .unwrap_or_default();
    report
        .with_note(format!("{plc}`rungc explain {}` tells more", d.code))
        .finish()
}
