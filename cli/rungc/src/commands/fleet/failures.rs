//! Operation errors in the summary, and reasons why PLCs stopped.

use crate::commands::counted;
use rungc_fleet::Failed;
use rungc_ir::Module;
use rungc_models::plc_errors;
use std::collections::BTreeMap;

/// Lines about a group at most.
const MOST_LINES: usize = 20;

/// Runs of numbers that a line has at most.
const MOST_RUNS: usize = 8;

/// Properties of a group beside its PLCs.
pub struct About<'m> {
    /// The program.
    pub module: &'m Module,
    /// The number of its first PLC.
    pub first: u32,
    /// Reason why its engine is nothing faster.
    pub why: Option<String>,
}

/// An error at an instruction, in all PLCs that had it.
struct Row {
    code: u16,
    step: u32,
    times: u64,
    /// Time and place of the first occurrence.
    first: Option<(u32, u32)>,
    plcs: Vec<u32>,
}

/// The lines about what has gone wrong in a group: the errors by when they happened first, then what stopped PLCs.
pub fn lines(failures: &[Failed], about: &About<'_>) -> Vec<String> {
    let rows = rows(failures, about.first);
    let mut lines: Vec<String> = rows
        .iter()
        .take(MOST_LINES)
        .map(|row| line(row, about.module))
        .collect();
    if let Some(more) = rows.len().checked_sub(MOST_LINES).filter(|&more| more > 0) {
        lines.push(format!("errors at {}", counted(more, "more instruction")));
    }
    if let Some(row) = rows.iter().find(|row| row.first.is_some()) {
        let (code, relay) = (row.code, about.module.model.error_relay.number());
        lines.push(format!(
            "a PLC reports operation errors in M{relay} and D{relay}; for more, run `rungc explain {code}`"
        ));
    }
    lines
}

fn rows(failures: &[Failed], first: u32) -> Vec<Row> {
    let mut rows = BTreeMap::new();
    for failed in failures {
        let number = first + failed.plc;
        let key = (failed.first_ms.is_none(), failed.step, failed.code);
        let row = rows.entry(key).or_insert_with(|| Row {
            code: failed.code,
            step: failed.step,
            times: 0,
            first: None,
            plcs: Vec::new(),
        });
        row.times += failed.times;
        row.plcs.push(number);
        let here = failed.first_ms.map(|ms| (ms, number));
        row.first = match (row.first, here) {
            (Some(known), Some(here)) => Some(known.min(here)),
            (known, here) => known.or(here),
        };
    }
    let mut rows: Vec<Row> = rows.into_values().collect();
    rows.sort_by_key(|row| row.first.map_or(u32::MAX, |(ms, _)| ms));
    rows
}

fn line(row: &Row, module: &Module) -> String {
    let Row { code, step, .. } = *row;
    let text = module.origin(step).map_or("", |origin| &origin.text);
    let what = format!(
        "step {step}: {text}: error {code}, {}",
        plc_errors::title(code, module.model.id)
    );
    let numbers = runs(&row.plcs);
    let plcs = counted(row.plcs.len(), "PLC");
    match row.first {
        Some((ms, plc)) => {
            let times = match row.times {
                1 => "once".to_string(),
                times => format!("{times} times"),
            };
            format!("{what}, {times} in {plcs} ({numbers}), first in PLC {plc} at {ms} ms")
        }
        None => format!("{what}, stopped {plcs} ({numbers})"),
    }
}

/// Ascending numbers as runs: `1-3, 7`.
fn runs(numbers: &[u32]) -> String {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => runs.push((number, number)),
        }
    }
    let shown = runs.iter().take(MOST_RUNS).map(|&(first, last)| {
        if first == last {
            first.to_string()
        } else {
            format!("{first}-{last}")
        }
    });
    let mut shown: Vec<String> = shown.collect();
    if runs.len() > MOST_RUNS {
        shown.push("…".to_string());
    }
    shown.join(", ")
}
