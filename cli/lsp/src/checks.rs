//! Checks of open texts, beside the answers to the editor.

use crate::document::{Document, Kind, Opened, Text};
use crossbeam_channel::Sender;
use gen_lsp_types::Uri;
use rungc::{Diagnostic, Project, Severity, Unsaved, mistakes};
use rungc_syntax::{Span, codes};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

/// A text is checked when nothing has changed for this long.
pub(crate) const PAUSE: Duration = Duration::from_millis(150);

/// A text to check.
pub(crate) struct Job {
    uri: Uri,
    path: PathBuf,
    has_file: bool,
    kind: Kind,
    version: i32,
    revision: u64,
    text: Text,
    unsaved: Unsaved,
}

/// Result of a check.
#[derive(Debug)]
pub(crate) struct Checked {
    /// The address of the text.
    pub(crate) uri: Uri,
    /// Its version.
    pub(crate) version: i32,
    /// Its revision.
    pub(crate) revision: u64,
    /// The text.
    pub(crate) text: Text,
    /// The program, if it is one that could be read.
    pub(crate) project: Option<Project>,
    /// The findings in it.
    pub(crate) findings: Vec<Diagnostic>,
    /// Findings in its settings.
    pub(crate) mistakes: Vec<Diagnostic>,
}

impl Job {
    pub(crate) fn of(document: &Document, unsaved: &Unsaved) -> Self {
        Job {
            uri: document.uri.clone(),
            path: document.path.clone(),
            has_file: document.has_file,
            kind: document.kind,
            version: document.version,
            revision: document.revision,
            text: document.now.clone(),
            unsaved: unsaved.clone(),
        }
    }

    /// Checks in a thread of the process, which sends the result. A check that fails has no findings.
    pub(crate) fn start(self, results: Sender<Checked>) {
        thread::spawn(move || {
            let mut failed = self.failed();
            let run = std::panic::AssertUnwindSafe(|| self.run());
            let checked = std::panic::catch_unwind(run).unwrap_or_else(|_| {
                let why = "the check failed: this is an error in rungc, please report it";
                failed.findings.push(unread(&failed.uri.0, why));
                failed
            });
            // The editor has closed the connection.
            let _ = results.send(checked);
        });
    }

    fn failed(&self) -> Checked {
        Checked {
            uri: self.uri.clone(),
            version: self.version,
            revision: self.revision,
            text: self.text.clone(),
            project: None,
            findings: Vec::new(),
            mistakes: Vec::new(),
        }
    }

    /// Checks it now.
    pub(crate) fn run(self) -> Checked {
        let mut checked = self.failed();
        let text = self.text.content();
        match self.kind {
            Kind::Settings => checked.findings = mistakes::in_settings(&self.path, text),
            Kind::Test => checked.findings = mistakes::in_test_file(&self.path, text),
            Kind::Other => {}
            Kind::Program => {
                let opened = Opened::of(&self.path, self.has_file, &self.unsaved);
                checked.findings = opened
                    .mistakes
                    .first()
                    .map(without_settings)
                    .into_iter()
                    .collect();
                checked.mistakes = opened.mistakes;
                match opened.project {
                    Ok(project) => {
                        checked.findings.extend(project.check().diagnostics);
                        checked.project = Some(project);
                    }
                    Err(error) => {
                        let path = self.path.to_string_lossy();
                        checked.findings.push(unread(&path, &error.to_string()));
                    }
                }
            }
        }
        checked
    }
}

/// That a text cannot be read.
fn unread(path: &str, why: &str) -> Diagnostic {
    let finding = codes::UNREADABLE_FILE.at(Span::default(), why.to_owned());
    Diagnostic::new(Path::new(path), None, &[], &finding)
}

/// That the settings of a program do not hold because of a mistake.
fn without_settings(mistake: &Diagnostic) -> Diagnostic {
    Diagnostic {
        severity: Severity::Warning,
        message: format!(
            "the settings in `{}` do not apply: {}",
            mistake.file, mistake.message
        ),
        location: None,
        label: "".into(),
        related: Vec::new(),
        fix: None,
        ..mistake.clone()
    }
}
