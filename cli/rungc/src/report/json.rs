//! Diagnostics as one JSON object: of one program, or of several in its key `files`.

use super::Findings;
use super::visible::to_json;
use rungc::Diagnostic;
use rungc::location::named;
use rungc_analysis::check::ports::Setup;
use rungc_evidence::Evidence;
use rungc_firmware::report::Report as Takes;
use rungc_rt::comm::{Parity, Protocol};
use rungc_syntax::Severity;
use serde::Serialize;
use std::io;

/// All files.
#[derive(Serialize)]
struct Output {
    errors: usize,
    warnings: usize,
    notes: usize,
    files: Vec<File>,
}

/// One file.
#[derive(Serialize)]
pub struct File {
    file: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    steps: Option<u32>,
    errors: usize,
    warnings: usize,
    notes: usize,
    diagnostics: Vec<Diagnostic>,
    /// The serial ports that the program uses or sets up.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    ports: Vec<Port>,
    #[serde(skip_serializing_if = "Option::is_none")]
    report: Option<Takes>,
    /// Verdicts, and what they rest on.
    #[serde(skip_serializing_if = "Option::is_none")]
    verification: Option<Evidence>,
}

/// Port of a report; values that are not constant are left out.
#[derive(Serialize)]
struct Port {
    port: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    protocol: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    station: Option<u16>,
    #[serde(flatten)]
    line: Option<Line>,
}

/// The format of characters on a line.
#[derive(Serialize)]
struct Line {
    bits_per_second: u32,
    data_bits: u8,
    parity: &'static str,
    stop_bits: u8,
}

impl From<&Setup> for Port {
    fn from(setup: &Setup) -> Self {
        Port {
            port: format!("COM{}", setup.port),
            protocol: setup.protocol.map(Protocol::name),
            station: setup.station,
            line: setup.format.map(|format| Line {
                bits_per_second: format.bits_per_second,
                data_bits: format.data_bits,
                parity: match format.parity {
                    Parity::None => "none",
                    Parity::Odd => "odd",
                    Parity::Even => "even",
                },
                stop_bits: format.stop_bits,
            }),
        }
    }
}

/// Findings in one file.
pub fn file(findings: &Findings) -> File {
    File {
        file: named(findings.path),
        model: findings.size.map(|size| size.model),
        steps: findings.size.map(|size| size.steps),
        errors: findings.count(Severity::Error),
        warnings: findings.count(Severity::Warning),
        notes: findings.count(Severity::Note),
        diagnostics: findings
            .diagnostics
            .iter()
            .map(|d| Diagnostic::new(findings.path, findings.program, &findings.step_numbers, d))
            .collect(),
        ports: findings.ports.iter().map(Port::from).collect(),
        report: findings.takes.clone(),
        verification: findings.verification.clone(),
    }
}

impl File {
    /// Adds what was found later in the same program.
    fn extend(&mut self, later: File) {
        self.errors += later.errors;
        self.warnings += later.warnings;
        self.notes += later.notes;
        self.diagnostics.extend(later.diagnostics);
        self.model = later.model.or(self.model);
        self.steps = later.steps.or(self.steps);
        self.ports.extend(later.ports);
        self.report = later.report.or(self.report.take());
        self.verification = later.verification.or(self.verification.take());
    }
}

/// Adds the findings about a program. A command that reports on only one may do so in parts.
pub fn add(files: &mut Vec<File>, file: File, many: bool) {
    match files.last_mut() {
        Some(last) if !many && last.file == file.file => last.extend(file),
        _ => files.push(file),
    }
}

/// The object as pretty-printed text: of the only file, or of `many`.
pub fn render(files: Vec<File>, many: bool) -> io::Result<String> {
    if let ([file], false) = (&files[..], many) {
        return to_json(file);
    }
    let sum = |of: fn(&File) -> usize| files.iter().map(of).sum();
    to_json(&Output {
        errors: sum(|file| file.errors),
        warnings: sum(|file| file.warnings),
        notes: sum(|file| file.notes),
        files,
    })
}
