//! Results of tests as workflow commands of GitHub Actions.

use super::report::{Results, human, kind, message};
use crate::report::github;
use rungc::location::Location;
use rungc_sim::plctest::Outcome;
use std::collections::BTreeSet;

/// An annotation for each case that failed, and for each error of a program that does not compile, then what people
/// read in the log.
pub fn github(results: &Results) -> String {
    let mut text = String::new();
    let mut known = BTreeSet::new();
    for outcome in results.report.failures() {
        for annotation in annotations(results, outcome) {
            if known.insert(annotation.clone()) {
                text.push_str(&annotation);
            }
        }
    }
    text.push_str(&human(results));
    text
}

fn annotations(results: &Results, outcome: &Outcome) -> Vec<String> {
    if let Some((path, uncompiled)) = outcome.uncompiled() {
        let title = format!("{} does not compile", uncompiled.what);
        let errors = uncompiled.shown().iter();
        let errors = errors
            .map(|(line, message)| github::annotation("error", path, &at(*line), &title, message));
        return errors.collect();
    }
    let name = &results.suite.files()[outcome.id.file].cases[outcome.id.case].name;
    let failure = outcome.failure.as_ref();
    let title = format!("{name} [{}]: {}", outcome.engine, failure.map_or("", kind));
    let (path, line) = outcome.place(results.suite);
    let message = failure.map_or(String::new(), message);
    vec![github::annotation(
        "error",
        path,
        &at(line),
        &title,
        &message,
    )]
}

/// A line.
fn at(line: u32) -> Location {
    Location {
        line: Some(line),
        ..Location::default()
    }
}
