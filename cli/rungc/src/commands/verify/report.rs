//! Verdicts as text.

use crate::commands::Outcome;
use crate::commands::properties::ExternalWrites;
use crate::report::junit::{self, Case, Problem, Properties};
use rungc_ir::Module;
use rungc_sim::property::Property;
use rungc_syntax::codes;
use rungc_verify::model::Key;
use rungc_verify::prove::{Decision, Options, Verdict};
use rungc_verify::words;
pub use rungc_verify::words::{assumptions, changes, devices, gaps, names, reason, write_story};
use std::fmt::Write;
use std::time::Duration;

/// A property and what was found of it.
pub struct Result<'a> {
    /// The property as requested.
    pub requested: &'a str,
    pub property: &'a Property,
    pub decision: &'a Decision,
    /// Devices that may be written from outside the program.
    pub external: &'a ExternalWrites,
    /// Duration.
    pub time: Duration,
}

impl Result<'_> {
    /// Outcome for the exit code.
    pub fn outcome(&self) -> Outcome {
        match (&self.decision.verdict, self.property.is_wanted()) {
            (Verdict::Undecided(_), _) => Outcome::Undecided,
            (Verdict::Proved, false) | (Verdict::Found(_), true) => Outcome::Success,
            (Verdict::Proved, true) | (Verdict::Found(_), false) => Outcome::Failed,
        }
    }

    /// The verdict in a word.
    pub fn word(&self) -> &'static str {
        words::word(self.decision, self.property)
    }

    /// The verdict as a case of a test report.
    pub fn case(&self, file: &str, module: &Module) -> Case {
        let outcome = self.outcome();
        let problem = (outcome != Outcome::Success).then(|| {
            let mut text = self.sentence();
            text.push('\n');
            self.describe(&mut text, module);
            Problem {
                result: match outcome {
                    Outcome::Undecided => junit::Result::Error,
                    _ => junit::Result::Failed,
                },
                kind: match outcome {
                    Outcome::Undecided => codes::PROPERTY_UNDECIDED.name,
                    _ => codes::PROPERTY_VIOLATED.name,
                },
                message: self.sentence(),
                text: text.trim_end().to_string(),
            }
        });
        Case {
            name: self.requested.to_string(),
            class: file.to_string(),
            time: self.time,
            properties: Properties::new(),
            problem,
        }
    }

    /// Describes the grounds of the verdict, and its dependencies.
    fn describe(&self, text: &mut String, module: &Module) {
        let decided = (self.property, self.decision);
        words::describe(text, module, decided, self.external);
    }

    /// Devices that something other than the program writes and that the property depends on, by what names them.
    pub fn outside(&self, module: &Module) -> Vec<(&'static str, Vec<Key>)> {
        words::outside(self.decision, self.external, module)
    }

    /// The verdict as a diagnostic says it.
    pub fn sentence(&self) -> String {
        words::sentence(self.requested, self.decision, self.property)
    }
}

/// Number of properties that hold, or are reached: `2 of 3 hold`.
pub fn summary(results: &[Result]) -> String {
    let good = results.iter().map(Result::outcome);
    let good = good.filter(|outcome| *outcome == Outcome::Success).count();
    format!("{good} of {} hold", results.len())
}

/// All verdicts as readable text.
pub fn human(
    results: &[Result],
    module: &Module,
    options: &Options,
    (assumed, external): (&[String], &ExternalWrites),
) -> String {
    let mut text = String::new();
    for result in results {
        let seconds = result.time.as_secs_f64();
        let _ = writeln!(
            text,
            "{:<11} {} ({seconds:.2} s)",
            result.word(),
            result.requested
        );
        if let Verdict::Undecided(why) = &result.decision.verdict {
            let _ = writeln!(text, "            {}", reason(why));
        }
        result.describe(&mut text, module);
    }
    if results
        .iter()
        .any(|result| result.word() == "proved" || result.word() == "not reachable")
    {
        let _ = writeln!(text, "Proved for this model under these assumptions:");
        for line in assumptions(&options.world, assumed, external) {
            let _ = writeln!(text, "  - {line}");
        }
    }
    text
}
