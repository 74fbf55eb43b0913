//! Findings as data.

use crate::location::{Location, named};
use rungc_project::Check;
use rungc_syntax::{Diagnostic as Finding, Diagnostics, Label, Program, Severity, codes, phrase};
use serde::{Serialize, Serializer};
use std::fmt;
use std::path::Path;

/// Something that is wrong with a program, or worth knowing. Its serialised form is that of
/// `rungc check --format json`.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Diagnostic {
    /// The file, as it was named.
    #[serde(skip)]
    pub file: String,
    /// Its code: `W0203`. `rungc explain W0203` describes it.
    pub code: &'static str,
    /// Name of the code: `double-coil`.
    pub name: &'static str,
    /// Its severity; only errors keep a program from being compiled.
    #[serde(serialize_with = "by_name")]
    pub severity: Severity,
    /// Description of the finding.
    pub message: String,
    /// Its place; `None` if nothing could be read.
    #[serde(flatten)]
    pub location: Option<Location>,
    /// Text at the place; empty if the message is enough.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub label: String,
    /// Other places that it is about.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub related: Vec<Related>,
    /// All devices that it is about, where the message names only some.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub devices: Vec<String>,
    /// What to do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub help: Option<String>,
    /// The change of the text that the help proposes, where the source is a text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fix: Option<Proposal>,
    /// The error code that a PLC shows for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plc_error: Option<u16>,
}

/// Another place that a diagnostic is about.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Related {
    /// What is there.
    pub message: String,
    /// The place; `None` if nothing could be read.
    #[serde(flatten)]
    pub location: Option<Location>,
}

/// A proposed change of the text.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Proposal {
    /// Effect, in the imperative: `write INCP`.
    pub title: String,
    /// True if `rungc check --fix` applies it.
    pub certain: bool,
    /// The replacements.
    pub edits: Vec<Replacement>,
}

/// A piece of text to replace.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Replacement {
    /// The piece.
    #[serde(flatten)]
    pub location: Option<Location>,
    /// The new text.
    pub text: String,
}

fn by_name<S: Serializer>(severity: &Severity, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(severity.name())
}

impl Diagnostic {
    /// A finding in a file. `program` is `None` if nothing could be read; its instructions have these step numbers if
    /// they have been counted.
    pub fn new(
        file: &Path,
        program: Option<&Program>,
        step_numbers: &[u32],
        finding: &Finding,
    ) -> Self {
        let at = |span| program.map(|program| Location::of(program, step_numbers, span));
        let list = program.filter(|program| program.kind.is_list());
        let fix = finding.fix.clone().zip(list);
        let fix = fix.map(|(fix, list)| fix.with_line_ends_of(&list.source.text));
        Diagnostic {
            file: named(file),
            code: finding.code,
            name: codes::find(finding.code).map_or("", |code| code.name),
            severity: finding.severity,
            message: finding.message.to_string(),
            location: at(finding.span),
            label: finding.label.to_string(),
            related: finding
                .others
                .iter()
                .map(|other| Related {
                    message: other.text.to_string(),
                    location: at(other.span),
                })
                .collect(),
            devices: finding.devices.iter().map(ToString::to_string).collect(),
            help: finding.help.as_deref().map(str::to_owned),
            fix: fix.map(|fix| Proposal {
                title: fix.title.to_string(),
                certain: fix.certain,
                edits: fix
                    .edits
                    .into_iter()
                    .map(|edit| Replacement {
                        location: at(edit.span),
                        text: edit.text,
                    })
                    .collect(),
            }),
            plc_error: finding.plc_error,
        }
    }
}

impl fmt::Display for Diagnostic {
    /// `motor.il:3:1: warning[W0203]: …`, on one line, with a second one for the help.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = self.location.as_ref();
        let place = place.map_or_else(|| self.file.clone(), |place| place.headed(&self.file));
        let (severity, code) = (self.severity.name(), self.code);
        write!(f, "{place}: {severity}[{code}]: {}", self.message)?;
        match &self.help {
            Some(help) => write!(f, "\n  help: {help}"),
            None => Ok(()),
        }
    }
}

/// Which findings count, and how much: what the caller asks for, which takes precedence, and the settings.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    /// Codes of warnings and notes that are left out.
    pub allow: Vec<&'static str>,
    /// Codes of warnings that are errors.
    pub deny: Vec<&'static str>,
    /// All warnings are errors.
    pub deny_warnings: bool,
    /// `[check]` of the settings.
    pub rules: Check,
}

impl Levels {
    /// The findings that count, each as severe as it is here, in the order of their places.
    pub fn apply(&self, diagnostics: Diagnostics) -> Vec<Finding> {
        let mut diagnostics = joined_labels(diagnostics.sorted());
        diagnostics.retain_mut(|d| match self.level(d) {
            Some(severity) => {
                d.severity = severity;
                true
            }
            None => false,
        });
        diagnostics
    }

    /// Severity of a finding; `None` leaves it out. Errors and notes stay what they are, but for notes that are left
    /// out.
    fn level(&self, d: &Finding) -> Option<Severity> {
        match d.severity {
            Severity::Error => Some(Severity::Error),
            _ if self.allow.contains(&d.code) => None,
            _ if self.deny.contains(&d.code) => Some(Severity::Error),
            _ if self.rules.allow.contains(&d.code) => None,
            Severity::Note => Some(Severity::Note),
            Severity::Warning if self.deny_warnings || self.rules.deny.contains(&d.code) => {
                Some(Severity::Error)
            }
            Severity::Warning => Some(Severity::Warning),
        }
    }
}

/// One error for all operands that are labels: a program with labels has hundreds of them.
fn joined_labels(mut diagnostics: Vec<Finding>) -> Vec<Finding> {
    let is_label = |d: &Finding| d.code == codes::LABEL_OPERAND.id;
    let more: Vec<Finding> = diagnostics.extract_if(.., |d| is_label(d)).collect();
    let mut more = more.into_iter();
    let Some(mut first) = more.next() else {
        return diagnostics;
    };
    if more.len() > 0 {
        first.message = phrase!(
            "{first}, and so are {count} more operands",
            first = first.message,
            count = more.len()
        );
    }
    first.others.extend(more.map(|d| Label {
        span: d.span,
        text: "a label too".into(),
    }));
    let at = diagnostics.partition_point(|d| d.span < first.span);
    diagnostics.insert(at, first);
    diagnostics
}
