//! Mistakes in the files that accompany programs: `rungc.toml` and test files.

use crate::Diagnostic;
use rungc_project::{Error, Project as Settings};
use rungc_sim::plctest;
use rungc_syntax::{Program, Span, codes};
use std::path::Path;

/// Mistakes in the text of a `rungc.toml`, which is or will be in this file.
pub fn in_settings(path: &Path, text: &str) -> Vec<Diagnostic> {
    match Settings::parse(path, text) {
        Ok(_) => Vec::new(),
        Err(error) => of(&error),
    }
}

/// Mistakes in the text of a test file. Paths in it begin at its folder.
pub fn in_test_file(path: &Path, text: &str) -> Vec<Diagnostic> {
    match plctest::parse(&path.to_string_lossy(), text) {
        Ok(_) => Vec::new(),
        Err(error) => of(&error.into()),
    }
}

/// Mistakes as data.
pub fn of(error: &Error) -> Vec<Diagnostic> {
    match error {
        Error::Io { path, .. } => {
            let why = codes::UNREADABLE_FILE.at(Span::default(), error.to_string());
            vec![Diagnostic::new(path, None, &[], &why)]
        }
        Error::Invalid {
            path,
            text,
            diagnostics,
        } => {
            let program = Program {
                source: (**text).clone(),
                ..Program::default()
            };
            let mistakes = diagnostics.clone().sorted().into_iter();
            mistakes
                .map(|mistake| Diagnostic::new(path, Some(&program), &[], &mistake))
                .collect()
        }
    }
}
