//! Printing diagnostics: for people, as JSON, as SARIF.

mod human;
mod json;
mod sarif;

use crate::args::{Format, Reporting};
use rungc_firmware::report::Report as Takes;
use rungc_ir::compile::Compiled;
use rungc_syntax::{Diagnostic, Diagnostics, Program, Severity};
use std::io::{self, Write};
use std::path::Path;

/// What was found about one file.
pub struct Findings<'a> {
    /// The file as named on the command line.
    pub path: &'a Path,
    /// The program, for its source text and steps; `None` if nothing could be read.
    pub program: Option<&'a Program>,
    /// What was compiled or checked, if it came to that.
    pub size: Option<Size>,
    /// The findings that count, ordered by place.
    pub diagnostics: Vec<Diagnostic>,
    /// What it takes on a machine, if that was asked for.
    pub takes: Option<Takes>,
}

/// What a program is for, and how long it is.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// Name of the model.
    pub model: &'static str,
    /// Length in steps.
    pub steps: u32,
}

impl From<&Compiled> for Size {
    fn from(compiled: &Compiled) -> Self {
        Size {
            model: compiled.model.name,
            steps: compiled.steps,
        }
    }
}

impl<'a> Findings<'a> {
    /// Takes the diagnostics that `reporting` lets through; with `--deny-warnings` warnings become errors, notes stay notes.
    pub fn new(
        path: &'a Path,
        program: &'a Program,
        diagnostics: Diagnostics,
        reporting: &Reporting,
    ) -> Self {
        let mut diagnostics = diagnostics.sorted();
        let allowed = |d: &Diagnostic| reporting.allow.contains(&d.code);
        diagnostics.retain(|d| d.severity == Severity::Error || !allowed(d));
        if reporting.deny_warnings {
            diagnostics
                .iter_mut()
                .filter(|d| d.severity == Severity::Warning)
                .for_each(|d| d.severity = Severity::Error);
        }
        Findings {
            path,
            program: Some(program),
            size: None,
            diagnostics,
            takes: None,
        }
    }

    /// Of a file that could not be read at all, and why.
    pub fn unread(path: &'a Path, why: Diagnostic) -> Self {
        Findings {
            path,
            program: None,
            size: None,
            diagnostics: vec![why],
            takes: None,
        }
    }

    /// How many have this severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.diagnostics
            .iter()
            .filter(|d| d.severity == severity)
            .count()
    }

    /// Whether the program cannot be compiled.
    pub fn failed(&self) -> bool {
        self.count(Severity::Error) > 0
    }

    /// Step number of the instruction that holds a place in the source, where the source states steps.
    fn step_at(&self, offset: u32) -> Option<u32> {
        let instrs = &self.program?.instrs;
        let next = instrs.partition_point(|instr| instr.span.start <= offset);
        instrs.get(next.checked_sub(1)?)?.step
    }
}

/// Prints the findings: text for people to standard error; JSON and SARIF to standard output, or to standard error as well if
/// standard output is `taken` by what the command makes.
pub fn print(
    findings: &Findings,
    reporting: &Reporting,
    color: bool,
    taken: bool,
) -> io::Result<()> {
    let object = match reporting.format {
        Format::Human => {
            // That nobody reads it is no reason to stop.
            return human::print(findings, reporting.limit, color, &mut io::stderr().lock())
                .or_else(|error| match error.kind() {
                    io::ErrorKind::BrokenPipe => Ok(()),
                    _ => Err(error),
                });
        }
        Format::Json => json::render(findings)?,
        Format::Sarif => sarif::render(findings)?,
    };
    if taken {
        writeln!(io::stderr(), "{object}")
    } else {
        writeln!(io::stdout(), "{object}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_syntax::{Source, Span};

    /// A report of one note in every form, with `--deny-warnings`.
    #[test]
    fn notes_are_reported_and_never_fail() {
        let program = Program {
            source: Source::new("a.il", "END"),
            ..Program::default()
        };
        let note = Diagnostic::new(Severity::Note, "N0000", Span::new(0, 3), "worth knowing");
        let mut diagnostics = Diagnostics::new();
        diagnostics.push(note);
        let reporting = |allow: &[&'static str]| Reporting {
            format: Format::Human,
            deny_warnings: true,
            allow: allow.to_vec(),
            limit: 0,
        };
        let found = |allow| {
            let diagnostics = diagnostics.clone();
            Findings::new(Path::new("a.il"), &program, diagnostics, &reporting(allow))
        };
        assert_eq!(found(&["N0000"]).count(Severity::Note), 0);
        let findings = found(&[]);
        assert!(!findings.failed());
        let mut text = Vec::new();
        human::print(&findings, 0, false, &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.starts_with("note[N0000]: worth knowing"), "{text}");
        let json: serde_json::Value =
            serde_json::from_str(&json::render(&findings).unwrap()).unwrap();
        assert_eq!((&json["notes"], &json["errors"]), (&1.into(), &0.into()));
        assert_eq!(json["diagnostics"][0]["severity"], "note");
        let sarif: serde_json::Value =
            serde_json::from_str(&sarif::render(&findings).unwrap()).unwrap();
        assert_eq!(sarif["runs"][0]["results"][0]["level"], "note");
    }
}
