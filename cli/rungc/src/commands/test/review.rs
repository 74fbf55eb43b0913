//! Accepting and rejecting traces.

use super::super::{Context, Failure, print_text};
use crate::args::TestArgs;
use crate::output::rewrite;
use rungc_sim::plctest::{self, Outcome, Report, Suite, Trace};
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, BufRead};
use std::path::PathBuf;

/// Decision about a trace that differs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Decision {
    Accept,
    Reject,
    Later,
}

/// Accepts or rejects traces that differ, as asked; else leaves them beside those that are accepted. A case whose trace
/// is accepted passes.
pub fn traces(
    args: &TestArgs,
    suite: &Suite,
    report: &mut Report,
    cx: Context,
) -> Result<(), Failure> {
    let mut decided: BTreeSet<PathBuf> = BTreeSet::new();
    let mut end = false;
    for outcome in &mut report.outcomes {
        let case = &suite.files()[outcome.id.file].cases[outcome.id.case];
        let Some(trace) = &case.trace else {
            continue;
        };
        let Some(plctest::Failure::Trace { actual, .. }) = outcome.failure.clone() else {
            forget(trace);
            continue;
        };
        // Other engines have the same trace, or fail once the first one is accepted.
        if !decided.insert(trace.path.clone()) {
            let accepted = fs::read_to_string(&trace.path).ok();
            if accepted.as_deref() == Some(&actual) {
                outcome.failure = None;
            }
            continue;
        }
        let decision = match (args.accept, args.reject) {
            (true, _) => Decision::Accept,
            (_, true) => Decision::Reject,
            _ if args.review && !end => prompt(outcome, suite, &mut end)?,
            _ => Decision::Later,
        };
        match decision {
            Decision::Accept => {
                rewrite(&trace.path, actual.as_bytes())?;
                forget(trace);
                cx.note(&format!("    Accepted {}", trace.path.display()));
                outcome.failure = None;
            }
            Decision::Reject => {
                forget(trace);
                cx.note(&format!("    Rejected {}", trace.path.display()));
            }
            Decision::Later => rewrite(&trace.pending(), actual.as_bytes())?,
        }
    }
    Ok(())
}

/// Deletes a run that was left beside the accepted one.
fn forget(trace: &Trace) {
    // Most often there is none.
    let _ = fs::remove_file(trace.pending());
}

/// Shows how a trace differs and asks what to do. An unknown answer is asked for again; the end of the input leaves
/// all that follows.
fn prompt(outcome: &Outcome, suite: &Suite, end: &mut bool) -> Result<Decision, Failure> {
    print_text(&format!("{}\n", outcome.describe(suite)))?;
    if let Some(plctest::Failure::Trace { actual, .. }) = &outcome.failure {
        print_text(&format!("{actual}\n"))?;
    }
    loop {
        print_text("accept (a), reject (r) or leave (l) this run? ")?;
        let mut answer = String::new();
        if io::stdin().lock().read_line(&mut answer)? == 0 {
            *end = true;
            print_text("\n")?;
            return Ok(Decision::Later);
        }
        match answer.trim() {
            "a" | "accept" => return Ok(Decision::Accept),
            "r" | "reject" => return Ok(Decision::Reject),
            "l" | "leave" => return Ok(Decision::Later),
            _ => {}
        }
    }
}
