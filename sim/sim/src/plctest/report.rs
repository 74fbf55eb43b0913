//! Results of the cases.

use super::{Case, CaseProgram, Id, RuleKind, Suite, Value};
use crate::target::Target;
use rungc_models::Model;
use rungc_syntax::diag::counted;
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Maximum number of errors of a program that a report shows.
const ERRORS_SHOWN: usize = 5;

/// Reason why a case failed.
#[derive(Clone, PartialEq, Debug)]
pub enum Failure {
    /// Its program does not compile.
    Refused(Uncompiled),
    /// Its program had to be rejected, and was not, or for another reason.
    Accepted(String),
    /// A device of it does not exist on the model.
    NoDevice {
        /// Step of the case, from 1; 0 for `init`.
        step: usize,
        /// The device.
        target: Target,
    },
    /// Devices do not hold what the case expects.
    Differs {
        /// Step of the case, from 1.
        step: usize,
        /// The step's line in the file.
        line: u32,
        /// Name, expected and actual value of each.
        values: Vec<(String, Value, Value)>,
    },
    /// Violation of a rule over time.
    Rule {
        /// Step of the case, from 1.
        step: usize,
        /// The rule's line in the file.
        line: u32,
        /// The rule.
        kind: RuleKind,
        /// Description of the violation.
        message: String,
    },
    /// The run is not the one that was accepted.
    Trace {
        /// Description of the difference.
        message: String,
        /// The run.
        actual: String,
    },
    /// The machine around the PLC was damaged, or the case does not fit it.
    Machine {
        /// Step of the case, from 1; 0 before the first.
        step: usize,
        /// Description of the error.
        message: String,
    },
    /// The engine failed.
    Engine {
        /// Step of the case, from 1; 0 for `init`.
        step: usize,
        /// Error message.
        message: String,
    },
}

/// A program that does not compile.
#[derive(Clone, PartialEq, Debug)]
pub struct Uncompiled {
    /// The file; `None` for a list in the test file.
    pub file: Option<PathBuf>,
    /// Description of the program: its PLC and what names the model, for a file.
    pub what: String,
    /// Line and message of each error.
    pub errors: Vec<(u32, String)>,
}

impl Uncompiled {
    /// The program of the case (0), or that of another PLC.
    pub(super) fn new(case: &Case, plc: usize, errors: &[(Option<u16>, u32, String)]) -> Self {
        let other = plc.checked_sub(1).and_then(|other| case.others.get(other));
        let (file, what) = match (other, &case.program) {
            (Some(other), _) => (None, format!("the program of the PLC `{}`", other.name)),
            (None, CaseProgram::List(_)) => (None, "the program".to_owned()),
            (None, CaseProgram::File(file)) => {
                let title = Model::get(case.model).title;
                let settings = file.settings.as_ref();
                let settings = settings.filter(|(_, model)| *model == case.model);
                let by = settings.map(|(path, _)| format!(", by {}", path.display()));
                let by = by.unwrap_or_default();
                let what = format!("{} ({title}{by})", file.path.display());
                (Some(file.path.clone()), what)
            }
        };
        Uncompiled {
            file,
            what,
            errors: errors.iter().map(|(_, l, m)| (*l, m.clone())).collect(),
        }
    }

    /// The errors that a report shows.
    pub fn shown(&self) -> &[(u32, String)] {
        &self.errors[..self.errors.len().min(ERRORS_SHOWN)]
    }
}

impl fmt::Display for Uncompiled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} does not compile:", self.what)?;
        for (line, message) in self.shown() {
            write!(f, " line {line}: {message};")?;
        }
        match (self.errors.len().saturating_sub(ERRORS_SHOWN), &self.file) {
            (0, _) => Ok(()),
            (more, Some(file)) => {
                let more = counted(more, "more error");
                write!(f, " and {more} (see `rungc check {}`)", file.display())
            }
            (more, None) => {
                write!(
                    f,
                    " and {} (see `rungc check`)",
                    counted(more, "more error")
                )
            }
        }
    }
}

impl Failure {
    /// Returns true if the program ran and its behaviour differs from the expectation.
    pub fn is_of_program(&self) -> bool {
        match self {
            Failure::Differs { .. }
            | Failure::Rule { .. }
            | Failure::Trace { .. }
            | Failure::Machine { .. } => true,
            Failure::Refused(_)
            | Failure::Accepted(_)
            | Failure::NoDevice { .. }
            | Failure::Engine { .. } => false,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Refused(uncompiled) => uncompiled.fmt(f),
            Failure::Accepted(message) => write!(f, "{message}"),
            Failure::NoDevice { step, target } => {
                write!(f, "step {step}: `{target}` does not exist on the model")
            }
            Failure::Differs { step, line, values } => {
                write!(f, "step {step} (line {line}):")?;
                values.iter().try_for_each(|(name, expected, actual)| {
                    write!(f, " {name} is {actual}, expected {expected};")
                })
            }
            Failure::Rule {
                step,
                line,
                kind,
                message,
            } => write!(f, "step {step} (line {line}): {}: {message}", kind.name()),
            Failure::Trace { message, .. } => write!(f, "{message}"),
            Failure::Machine { step: 0, message } => write!(f, "{message}"),
            Failure::Machine { step, message } | Failure::Engine { step, message } => {
                write!(f, "step {step}: {message}")
            }
        }
    }
}

/// The result of one case on one engine.
#[derive(Clone, PartialEq, Debug)]
pub struct Outcome {
    /// The case.
    pub id: Id,
    /// Name of the engine.
    pub engine: String,
    /// Reason for its failure, if it failed.
    pub failure: Option<Failure>,
    /// True if it did not run because it is known to pass.
    pub cached: bool,
    /// Duration.
    pub elapsed: Duration,
}

/// The results of all cases.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// In the order in which they ran.
    pub outcomes: Vec<Outcome>,
}

impl Report {
    /// Failed cases.
    pub fn failures(&self) -> impl Iterator<Item = &Outcome> {
        self.outcomes.iter().filter(|o| o.failure.is_some())
    }

    /// Number of cases passed.
    pub fn passed(&self) -> usize {
        self.outcomes.iter().filter(|o| o.failure.is_none()).count()
    }

    /// Returns true if all passed.
    pub fn is_success(&self) -> bool {
        self.failures().next().is_none()
    }

    /// Adds the results of another engine.
    pub fn extend(&mut self, other: Report) {
        self.outcomes.extend(other.outcomes);
    }
}

impl Outcome {
    /// The file and the line that the result is about: of the first error of a program that does not compile, else in
    /// the test file those of the step or rule that failed, else of the case.
    pub fn place<'s>(&'s self, suite: &'s Suite) -> (&'s Path, u32) {
        let file = &suite.files()[self.id.file];
        let line = match &self.failure {
            Some(Failure::Differs { line, .. } | Failure::Rule { line, .. }) => *line,
            Some(Failure::Refused(Uncompiled {
                file: Some(program),
                errors,
                ..
            })) => return (program, errors.first().map_or(1, |(line, _)| *line)),
            _ => file.cases[self.id.case].line,
        };
        (Path::new(&file.name), line)
    }

    /// The program file of the case, if it does not compile.
    pub fn uncompiled(&self) -> Option<(&Path, &Uncompiled)> {
        match &self.failure {
            Some(Failure::Refused(uncompiled)) => Some((uncompiled.file.as_deref()?, uncompiled)),
            _ => None,
        }
    }

    /// The case's place, name and engine, why it failed, and what it is based on.
    pub fn describe(&self, suite: &Suite) -> String {
        let file = &suite.files()[self.id.file];
        let case = &file.cases[self.id.case];
        let verdict = match &self.failure {
            Some(failure) => failure.to_string(),
            None => "passed".to_string(),
        };
        let mut text = format!(
            "{}:{}: {} [{}]: {}",
            file.name,
            case.line,
            case.name,
            self.engine,
            verdict.trim_end_matches(';')
        );
        if self.failure.is_some() && !case.source.is_empty() {
            text.push_str(&format!("\n    source: {}", case.source));
        }
        if self.failure.is_some() && !case.note.is_empty() {
            text.push_str(&format!("\n    note: {}", case.note));
        }
        text
    }
}
