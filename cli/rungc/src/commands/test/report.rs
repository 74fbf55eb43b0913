//! Results of tests, human-readable and for tools.

use super::broken::Mistake;
use crate::report::to_json;
use rungc::location::named;
use rungc_sim::plctest::{Failure, Outcome, Report, Suite, Value};
use rungc_syntax::diag::counted;
use serde::Serialize;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

/// Cases that ran, and their results.
pub struct Results<'a> {
    /// The cases.
    pub suite: &'a Suite,
    /// Their results.
    pub report: &'a Report,
    /// Duration, with compiling.
    pub elapsed: Duration,
    /// Properties of the settings, which tests do not decide.
    pub untested: Option<&'a Untested>,
}

/// The properties of rungc.toml.
pub struct Untested {
    /// The file.
    pub file: PathBuf,
    /// The properties, in its order.
    pub properties: Vec<Property>,
}

/// A property that `rungc verify` decides.
#[derive(Serialize)]
pub struct Property {
    /// As it is written, after its name.
    pub property: String,
    /// Identifier of the requirement that it belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub requirement: Option<String>,
}

/// The cases that failed, a paragraph each, and how many did. Those with one program that does not compile are one.
pub fn human(results: &Results) -> String {
    let mut failed: Vec<&Outcome> = results.report.failures().collect();
    let mut text = String::new();
    while let Some(outcome) = failed.first().copied() {
        let is_same = |other: &Outcome| {
            let (own, other) = (outcome.uncompiled(), other.uncompiled());
            own.is_some() && own == other
        };
        failed.remove(0);
        let same = failed.extract_if(.., |other| is_same(other)).count();
        text.push_str(&outcome.describe(results.suite));
        if same > 0 {
            let more = counted(same, "more case");
            text.push_str(&format!("\n    and {more} with this program"));
        }
        text.push('\n');
    }
    text.push_str(&format!(
        "{} passed, {} failed ({:.1} s)\n",
        results.report.passed(),
        results.report.failures().count(),
        results.elapsed.as_secs_f64()
    ));
    text
}

#[derive(Serialize)]
struct Document<'a> {
    passed: usize,
    failed: usize,
    seconds: f64,
    cases: Vec<Case<'a>>,
    /// What `rungc verify` decides.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    untested: &'a [Property],
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    mistakes: &'a [Mistake],
}

#[derive(Serialize)]
struct Case<'a> {
    file: &'a str,
    line: u32,
    name: &'a str,
    engine: &'a str,
    passed: bool,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    cached: bool,
    seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<Why<'a>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    requirements: &'a [String],
    #[serde(skip_serializing_if = "str::is_empty")]
    source: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    note: &'a str,
}

#[derive(Serialize)]
struct Why<'a> {
    kind: &'static str,
    message: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    program: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    values: Vec<Differs<'a>>,
}

#[derive(Serialize)]
struct Differs<'a> {
    name: &'a str,
    expected: serde_json::Value,
    actual: serde_json::Value,
}

/// One JSON object.
pub fn json(results: &Results) -> io::Result<String> {
    let outcomes = results.report.outcomes.iter();
    let document = Document {
        passed: results.report.passed(),
        failed: results.report.failures().count(),
        seconds: seconds(results.elapsed),
        cases: outcomes
            .map(|outcome| case(results.suite, outcome))
            .collect(),
        untested: results
            .untested
            .map_or(&[], |untested| &untested.properties),
        mistakes: &[],
    };
    to_json(&document)
}

/// One JSON object without cases, for test files that contain mistakes.
pub fn to_document(mistakes: &[Mistake]) -> io::Result<String> {
    to_json(&Document {
        passed: 0,
        failed: 0,
        seconds: 0.0,
        cases: Vec::new(),
        untested: &[],
        mistakes,
    })
}

/// A time to the microsecond.
fn seconds(time: Duration) -> f64 {
    time.as_micros() as f64 / 1e6
}

fn case<'a>(suite: &'a Suite, outcome: &'a Outcome) -> Case<'a> {
    let file = &suite.files()[outcome.id.file];
    let case = &file.cases[outcome.id.case];
    Case {
        file: &file.name,
        line: case.line,
        name: &case.name,
        engine: &outcome.engine,
        passed: outcome.failure.is_none(),
        cached: outcome.cached,
        seconds: seconds(outcome.elapsed),
        failure: outcome.failure.as_ref().map(why),
        requirements: &case.requirements,
        source: &case.source,
        note: &case.note,
    }
}

fn why(failure: &Failure) -> Why<'_> {
    let (step, line) = match failure {
        Failure::Differs { step, line, .. } | Failure::Rule { step, line, .. } => {
            (Some(*step), Some(*line))
        }
        Failure::NoDevice { step, .. }
        | Failure::Machine { step, .. }
        | Failure::Engine { step, .. } => (Some(*step), None),
        Failure::Refused(_) | Failure::Accepted(_) | Failure::Trace { .. } => (None, None),
    };
    let program = match failure {
        Failure::Refused(uncompiled) => uncompiled.file.as_deref(),
        _ => None,
    };
    let values = match failure {
        Failure::Differs { values, .. } => &values[..],
        _ => &[],
    };
    Why {
        kind: kind(failure),
        message: message(failure),
        step: step.filter(|step| *step > 0),
        line,
        program: program.map(named),
        values: values
            .iter()
            .map(|(name, expected, actual)| Differs {
                name,
                expected: value(expected),
                actual: value(actual),
            })
            .collect(),
    }
}

/// The name of a kind of failure in reports.
pub(super) fn kind(failure: &Failure) -> &'static str {
    match failure {
        Failure::Refused(_) => "does-not-compile",
        Failure::Accepted(_) => "not-rejected",
        Failure::NoDevice { .. } => "no-device",
        Failure::Differs { .. } => "differs",
        Failure::Rule { kind, .. } => kind.name(),
        Failure::Trace { .. } => "trace",
        Failure::Machine { .. } => "machine",
        Failure::Engine { .. } => "engine",
    }
}

pub fn message(failure: &Failure) -> String {
    failure.to_string().trim_end_matches(';').to_string()
}

fn value(value: &Value) -> serde_json::Value {
    match value {
        Value::Int(v) => (*v).into(),
        Value::Float(v) => (*v).into(),
        Value::Text(v) => v.as_str().into(),
    }
}
