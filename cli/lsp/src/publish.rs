//! Findings as the editor shows them.

use crate::document::Text;
use gen_lsp_types::{
    Code, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, Location, Message, Range,
    Uri,
};
use rungc::{Project, Severity};

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
    /// The range of a place; the first line if there is none.
    pub(crate) fn range(&self, place: Option<&rungc::Location>) -> Range {
        let span = place.map(|place| place.span).unwrap_or_default();
        match self.project {
            Some(project) => self.text.range_in(project.source(), span),
            None => self.text.range(span),
        }
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
                message: other.message.clone(),
            });
        let related: Vec<_> = related.collect();
        Diagnostic {
            range: self.range(finding.location.as_ref()),
            severity: Some(severity(finding.severity)),
            code: Some(Code::String(finding.code.to_owned())),
            code_description: None,
            source: Some("rungc".to_owned()),
            message: Message::String(message(finding)),
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
