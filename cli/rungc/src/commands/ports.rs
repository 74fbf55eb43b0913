//! Lines about a program's serial ports.

use super::subject::Subject;
use crate::args::{Emit, Plan};
use rungc_analysis::check::ports::Setup;
use rungc_project::Range;

/// Line about a serial port's set-up.
pub fn line(port: &Setup) -> String {
    format!("        Port {port}")
}

/// Line about the devices served by an emitted program's ports; `None` if none of them serves devices, or if the form
/// of output has no ports.
pub fn served(ports: &[Setup], plan: &Plan, subject: &Subject) -> Option<String> {
    // With servers, everything is stored.
    let emits = plan.emit.is_some_and(|emit| emit != Emit::Ir) && !plan.servers;
    if !emits || !ports.iter().any(Setup::serves) {
        return None;
    }
    let ranges = subject.project.iter();
    let ranges = ranges
        .flat_map(|project| &project.serve.devices)
        .map(|range| {
            let Range {
                class, first, last, ..
            } = *range;
            format!(", {}-{}", class.number(first), class.number(last))
        });
    let ranges: String = ranges.collect();
    Some(format!(
        "      Serves the devices that the program names{ranges}; requests for others are rejected (`[serve]` of rungc.toml adds ranges)"
    ))
}
