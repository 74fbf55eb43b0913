//! Results of tests as JUnit XML: a suite for each file; a case's class is its file and engine. The properties of
//! rungc.toml, which tests do not decide, are a suite of skipped cases.

use super::report::{Results, kind, message};
use crate::report::junit::{Case, Problem, Properties, Result, Suite, render_timed};
use rungc_sim::plctest::{Failure, Outcome};
use std::io;
use std::time::Duration;

/// The XML of a run.
pub fn junit(results: &Results) -> io::Result<String> {
    let files = 0..results.suite.files().len();
    let mut suites: Vec<Suite> = files.map(|file| suite(results, file)).collect();
    suites.extend(untested(results));
    render_timed("rungc test", &suites, results.elapsed)
}

/// The properties of the settings, if there are any.
fn untested(results: &Results) -> Option<Suite> {
    let untested = results.untested?;
    let class = untested.file.display().to_string();
    let rows = untested.properties.iter();
    let cases = rows.map(|row| Case {
        name: row.property.clone(),
        class: class.clone(),
        time: Duration::ZERO,
        properties: Vec::from_iter(row.requirement.clone().map(|id| ("requirement", id))),
        problem: Some(Problem {
            result: Result::Skipped,
            kind: "property",
            message: "`rungc verify` decides it".to_string(),
            text: String::new(),
        }),
    });
    Some(Suite {
        cases: cases.collect(),
        name: class.clone(),
        properties: Properties::new(),
    })
}

/// The cases of a file, which has this number.
fn suite(results: &Results, number: usize) -> Suite {
    let outcomes = results.report.outcomes.iter();
    let outcomes = outcomes.filter(|outcome| outcome.id.file == number);
    Suite {
        name: results.suite.files()[number].name.clone(),
        properties: Properties::new(),
        cases: outcomes.map(|outcome| case(results, outcome)).collect(),
    }
}

fn case(results: &Results, outcome: &Outcome) -> Case {
    let file = &results.suite.files()[outcome.id.file];
    let problem = outcome.failure.as_ref().map(|failure| Problem {
        result: match failure {
            // The test could not run.
            Failure::Engine { .. } => Result::Error,
            _ => Result::Failed,
        },
        kind: kind(failure),
        message: message(failure),
        text: outcome.describe(results.suite),
    });
    let case = &file.cases[outcome.id.case];
    let requirements = case.requirements.iter();
    Case {
        name: case.name.clone(),
        class: format!("{} [{}]", file.name, outcome.engine),
        time: outcome.elapsed,
        properties: requirements.map(|id| ("requirement", id.clone())).collect(),
        problem,
    }
}
