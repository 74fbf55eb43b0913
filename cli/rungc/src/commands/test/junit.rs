//! Results of tests as JUnit XML: a suite for each file; a case's class is its file and engine.

use super::report::{Results, kind, message};
use crate::report::junit::{Case, Problem, Properties, Suite, render_timed};
use rungc_sim::plctest::{Failure, Outcome};
use std::io;

/// The XML of a run.
pub fn junit(results: &Results) -> io::Result<String> {
    let suites: Vec<Suite> = (0..results.suite.files().len())
        .map(|file| suite(results, file))
        .collect();
    render_timed("rungc test", &suites, results.elapsed)
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
        // The test could not run.
        is_error: matches!(failure, Failure::Engine { .. }),
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
