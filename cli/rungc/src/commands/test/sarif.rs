//! Failed cases as SARIF 2.1.0.

use super::report::{Results, kind, message};
use crate::report::sarif;
use rungc_sim::plctest::Outcome;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io;

/// The log of a run.
pub fn sarif(results: &Results) -> io::Result<String> {
    let failed = || results.report.failures();
    let kinds = failed().filter_map(|o| o.failure.as_ref()).map(kind);
    let used: BTreeSet<_> = kinds.collect();
    let rules = used.into_iter().map(rule).collect();
    let items = failed().map(|outcome| item(results, outcome)).collect();
    sarif::log(rules, items, Vec::new(), None)
}

/// Description of a kind of failure, for readers of the log alone.
fn rule(kind: &str) -> Value {
    let text = match kind {
        "does-not-compile" => "The program of a test case does not compile.",
        "not-rejected" => "A program that must be rejected was not, or for another reason.",
        "no-device" => "A test case names a device that the PLC does not have.",
        "differs" => "After a step, devices do not hold what the test case expects.",
        "never" => "What must never hold did.",
        "whenever" => "What must follow did not, or too late.",
        "within" => "What must come to hold within a time did not.",
        "until" => "What a step waits for did not come.",
        "trace" => "A run is not the one that was accepted.",
        "machine" => "The machine around the PLC was damaged, or does not fit the test case.",
        _ => "A test case could not run.",
    };
    json!({ "id": kind, "shortDescription": { "text": text } })
}

fn item(results: &Results, outcome: &Outcome) -> Value {
    let case = &results.suite.files()[outcome.id.file].cases[outcome.id.case];
    let (path, line) = outcome.place(results.suite);
    let failure = outcome.failure.as_ref();
    let why = failure.map_or(String::new(), message);
    json!({
        "ruleId": failure.map_or("", kind),
        "level": "error",
        "message": { "text": format!("{} [{}]: {why}", case.name, outcome.engine) },
        "locations": [{
            "physicalLocation": {
                "artifactLocation": { "uri": sarif::uri(path) },
                "region": { "startLine": line },
            },
            "logicalLocations": [{ "name": case.name, "kind": "function" }],
        }],
    })
}
