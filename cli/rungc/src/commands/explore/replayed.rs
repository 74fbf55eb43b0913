//! Runs that were found, on the engines: their tests must fail on each of them as on the interpreter.

use super::{Searched, Shown};
use crate::args::EngineChoice;
use crate::commands::Failure;
use crate::commands::test::{BuildFolder, engines};
use crate::progress;
use rungc_sim::engines::{EngineKind, build};
use rungc_sim::plctest::{self, Suite};
use std::ops::ControlFlow;
use std::path::Path;

impl Searched<'_> {
    /// Differences between an engine and the findings of the search.
    pub fn replay(&self, shown: &[Shown]) -> Result<Vec<String>, Failure> {
        if shown.is_empty() || self.subject.file == Path::new("-") {
            return Ok(Vec::new());
        }
        let path = self.subject.file.with_file_name("found.plctest.toml");
        let text = self.test_file(&path, shown);
        let file = plctest::parse(&path.to_string_lossy(), &text);
        let file = file.map_err(|error| Failure::Because(error.to_string()))?;
        let suite = Suite::compile(vec![file], &[]);
        let mut differing = Vec::new();
        for kind in engines(self.args.replay) {
            let folder = match kind {
                EngineKind::Interp => BuildFolder::None,
                EngineKind::C | EngineKind::Rust => BuildFolder::take()?,
            };
            let built = progress::spin("building the engine", || {
                build(kind, suite.modules(), folder.path())
            });
            let mut engine = built.map_err(|error| Failure::Because(error.to_string()))?;
            let report = plctest::run(&suite, engine.as_mut(), &mut |_| ControlFlow::Continue(()));
            for (shown, outcome) in shown.iter().zip(&report.outcomes) {
                let as_found = match &outcome.failure {
                    Some(failure) => failure.is_of_program() && self.is_fault(&shown.found),
                    None => !self.is_fault(&shown.found),
                };
                if !as_found {
                    let title = self.title(&shown.found.what);
                    let what = match &outcome.failure {
                        Some(failure) => failure.to_string(),
                        None => "it does not happen there".to_string(),
                    };
                    differing.push(format!("`{title}` on {}: {what}", kind.name()));
                }
            }
        }
        Ok(differing)
    }

    /// The engines that the runs were replayed on, for the report.
    pub fn replayed(&self) -> &'static str {
        match self.args.replay {
            EngineChoice::Interp => "the interpreter",
            EngineChoice::C => "emitted C",
            EngineChoice::Rust => "emitted Rust",
            EngineChoice::All => "the interpreter, emitted C and emitted Rust",
        }
    }
}
