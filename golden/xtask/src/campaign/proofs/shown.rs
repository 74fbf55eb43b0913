//! Runs that the prover has found, as tests.

use super::draw::{Asked, Written};
use rungc_ir::Module;
use rungc_models::Model;
use rungc_verify::search::Trace;
use rungc_verify::written::{case, outcomes, quoted};

/// Registers of the duration of scans: in a run it is any, in a test the time until the next scan.
const DURATION: [&str; 3] = ["D8010", "D8011", "D8012"];

/// Contradiction between the test of a run and the verdict, if there is one. Programs that a test file cannot express
/// have no test.
pub fn contradiction(
    written: &Written,
    module: &Module,
    asked: &Asked,
    trace: &Trace,
) -> Option<String> {
    let names = |device: &str| written.text.contains(device) || asked.text.contains(device);
    if !written.latched.is_empty() || DURATION.into_iter().any(names) {
        return None;
    }
    let case = case("found", module, &asked.property, trace);
    let (model, program) = (Model::get(written.model).name, quoted(&written.text));
    let text = format!("topic = \"found\"\nmodel = \"{model}\"\nprogram = {program}\n{case}");
    let outcome = match outcomes("found.plctest.toml", &text) {
        Ok(outcomes) => outcomes.into_iter().next().flatten(),
        Err(why) => return Some(format!("the test cannot be read: {why}\n{case}")),
    };
    match (outcome, asked.property.is_wanted()) {
        (None, true) | (Some(_), false) => None,
        (Some(why), true) => Some(format!("the test fails: {why}\n{case}")),
        (None, false) => Some(format!("the test passes\n{case}")),
    }
}
