//! Findings as the editor shows them.

use crate::document::Text;
use crate::uri;
use gen_lsp_types::{
    Code, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, Location, Message, Range,
    Uri,
};
use rungc::{Project, Severity};
use rungc_syntax::{Part, Span};
use std::path::Path;

/// Ranges of places in a text, as far as it was read as a program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Places<'a> {
    /// Address of the text.
    pub(crate) uri: &'a Uri,
    /// The text.
    pub(crate) text: &'a Text,
    /// The program.
    pub(crate) project: Option<&'a Project>,
}

impl Places<'_> {
    /// The range of a place; the first line if there is none, or if it is in another file of the program.
    pub(crate) fn range(&self, place: Option<&rungc::Location>) -> Range {
        let span = place.map(|place| place.span).unwrap_or_default();
        let Some(project) = self.project else {
            return self.text.range(span);
        };
        let program = project.source();
        match program.source.part(span.start) {
            Some(part) if self.is_here(part) => {
                let within = |at: u32| at.saturating_sub(part.start);
                self.text
                    .range(Span::new(within(span.start), within(span.end)))
            }
            Some(_) => self.text.range(Span::default()),
            None => self.text.range_in(program, span),
        }
    }

    /// Returns true for the file of a program that this text is.
    fn is_here(&self, part: &Part) -> bool {
        uri::path(self.uri).is_some_and(|path| path.ends_with(&part.path))
    }

    /// The file and line of a place in another file of the program, as the head of a message: `Fill.st:3: `.
    fn elsewhere(&self, place: Option<&rungc::Location>) -> String {
        let part = place.zip(self.project).and_then(|(place, project)| {
            let part = project.source().source.part(place.span.start)?;
            Some((part, place.line?))
        });
        let other = part.filter(|(part, _)| !self.is_here(part));
        other.map_or_else(String::new, |(part, line)| {
            let name = Path::new(&part.path).file_name().unwrap_or_default();
            format!("{}:{line}: ", name.to_string_lossy())
        })
    }

    /// A finding for the editor.
    pub(crate) fn diagnostic(&self, finding: &rungc::Diagnostic) -> Diagnostic {
        let related = finding
            .related
            .iter()
            .map(|other| DiagnosticRelatedInformation {
                location: Location {
                    uri: self.uri.clone(),
                    range: self.range(other.location.as_ref()),
                },
                message: format!(
                    "{}{}",
                    self.elsewhere(other.location.as_ref()),
                    other.message
                ),
            });
        let related: Vec<_> = related.collect();
        Diagnostic {
            range: self.range(finding.location.as_ref()),
            severity: Some(severity(finding.severity)),
            code: Some(Code::String(finding.code.to_owned())),
            code_description: None,
            source: Some("rungc".to_owned()),
            message: Message::String(format!(
                "{}{}",
                self.elsewhere(finding.location.as_ref()),
                message(finding)
            )),
            tags: None,
            related_information: (!related.is_empty()).then_some(related),
            data: None,
        }
    }
}

fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::Error,
        Severity::Warning => DiagnosticSeverity::Warning,
        Severity::Note => DiagnosticSeverity::Information,
    }
}

/// What is wrong and what to do, a line each.
fn message(finding: &rungc::Diagnostic) -> String {
    let mut text = finding.message.clone();
    if !finding.label.is_empty() {
        text = format!("{text} ({})", finding.label);
    }
    if let Some(help) = &finding.help {
        text = format!("{text}\nhelp: {help}");
    }
    if let Some(code) = finding.plc_error {
        text = format!("{text}\nthe PLC reports this as error {code}");
    }
    text
}
