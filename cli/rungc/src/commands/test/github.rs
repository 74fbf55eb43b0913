//! Results of tests as workflow commands of GitHub Actions.

use super::report::{Results, human, kind, message};
use rungc_sim::plctest::Outcome;
use std::path::Path;

/// An annotation for each case that failed, then what people read in the log.
pub fn github(results: &Results) -> String {
    let failed = results.report.failures();
    let mut text: String = failed.map(|outcome| annotation(results, outcome)).collect();
    text.push_str(&human(results));
    text
}

fn annotation(results: &Results, outcome: &Outcome) -> String {
    let file = &results.suite.files()[outcome.id.file];
    let name = &file.cases[outcome.id.case].name;
    let failure = outcome.failure.as_ref();
    let title = format!("{name} [{}]: {}", outcome.engine, failure.map_or("", kind));
    crate::report::github::annotation(
        "error",
        Path::new(&file.name),
        Some(outcome.line(results.suite)),
        &title,
        &failure.map_or(String::new(), message),
    )
}
