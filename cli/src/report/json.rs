//! Diagnostics as one JSON object.

use super::Findings;
use rungc_firmware::report::Report as Takes;
use rungc_syntax::{Severity, Span, codes};
use serde::Serialize;
use std::io;

#[derive(Serialize)]
struct Output<'a> {
    file: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    steps: Option<u32>,
    errors: usize,
    warnings: usize,
    notes: usize,
    diagnostics: Vec<Item<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    report: Option<&'a Takes>,
}

#[derive(Serialize)]
struct Item<'a> {
    code: &'a str,
    name: &'a str,
    severity: &'static str,
    message: &'a str,
    #[serde(flatten)]
    place: Option<Place>,
    #[serde(skip_serializing_if = "str::is_empty")]
    label: &'a str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    related: Vec<Related<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plc_error: Option<u16>,
}

#[derive(Serialize)]
struct Related<'a> {
    message: &'a str,
    #[serde(flatten)]
    place: Option<Place>,
}

/// 1-based lines and columns (in characters), the end column past the last character; the step where the source states it.
#[derive(Serialize)]
struct Place {
    line: u32,
    column: u32,
    end_line: u32,
    end_column: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<u32>,
}

/// `None` if the file could not be read.
fn place(findings: &Findings, span: Span) -> Option<Place> {
    let source = &findings.program?.source;
    let (line, column) = source.line_col(span.start);
    let (end_line, end_column) = source.line_col(span.end);
    Some(Place {
        line,
        column,
        end_line,
        end_column,
        step: findings.step_at(span.start),
    })
}

/// The object as pretty-printed text.
pub fn render(findings: &Findings) -> io::Result<String> {
    let output = Output {
        file: findings.path.display().to_string(),
        model: findings.size.map(|size| size.model),
        steps: findings.size.map(|size| size.steps),
        errors: findings.count(Severity::Error),
        warnings: findings.count(Severity::Warning),
        notes: findings.count(Severity::Note),
        diagnostics: findings
            .diagnostics
            .iter()
            .map(|d| Item {
                code: d.code,
                name: codes::find(d.code).map_or("", |code| code.name),
                severity: d.severity.name(),
                message: &d.message,
                place: place(findings, d.span),
                label: &d.label,
                related: d
                    .others
                    .iter()
                    .map(|o| Related {
                        message: &o.text,
                        place: place(findings, o.span),
                    })
                    .collect(),
                help: d.help.as_deref(),
                plc_error: d.plc_error,
            })
            .collect(),
        report: findings.takes.as_ref(),
    };
    Ok(serde_json::to_string_pretty(&output)?)
}
