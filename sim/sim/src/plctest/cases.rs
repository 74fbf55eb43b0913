//! Runs the cases of a suite.

use super::runner::run_steps;
use super::suite::Built;
use super::{Case, Check, Failure, Id, Outcome, Rejects, Report, Suite, Uncompiled};
use crate::engines::Engine;
use crate::threads::Threads;
use std::ops::ControlFlow;
use web_time::Instant;

/// Runs all cases. `progress` receives each result as it is known, and may cancel the run.
pub fn run(
    suite: &Suite,
    engine: &mut dyn Engine,
    progress: &mut dyn FnMut(&Outcome) -> ControlFlow<()>,
) -> Report {
    let mut report = Report::default();
    for case in suite.cases() {
        let outcome = outcome(suite, engine, case);
        let flow = progress(&outcome);
        report.outcomes.push(outcome);
        if flow.is_break() {
            break;
        }
    }
    report
}

/// As [`run`], in several threads, each on an engine from `start`. The outcomes are in the order of the cases.
pub fn run_in<'e>(
    suite: &Suite,
    threads: Threads,
    start: &(dyn Fn() -> Box<dyn Engine + 'e> + Sync),
    progress: &mut dyn FnMut(&Outcome) -> ControlFlow<()>,
) -> Report {
    let mut report = Report::default();
    let cases: Vec<_> = suite.cases().collect();
    let run = |engine: &mut Box<dyn Engine + 'e>, case: &_| outcome(suite, engine.as_mut(), *case);
    threads.each(&cases, start, run, |outcome| {
        let flow = progress(&outcome);
        report.outcomes.push(outcome);
        flow
    });
    report
}

/// Runs a case.
fn outcome(suite: &Suite, engine: &mut dyn Engine, (id, case): (Id, &Case)) -> Outcome {
    let begin = Instant::now();
    let built = suite.built(id);
    let result = match (&case.check, built) {
        (_, Built::Known) => Ok(()),
        (Check::Rejects(rejects), built) => check_rejects(*rejects, built),
        (Check::Steps { .. }, Built::Refused(plc, errors)) => {
            Err(Failure::Refused(Uncompiled::new(case, *plc, errors)))
        }
        (Check::Steps { .. }, Built::Modules(built)) => {
            let plcs = built
                .iter()
                .map(|&number| (number, &suite.modules()[number]));
            run_steps(engine, case, &plcs.collect::<Vec<_>>())
        }
    };
    Outcome {
        id,
        engine: engine.name().to_string(),
        failure: result.err(),
        cached: matches!(built, Built::Known),
        elapsed: begin.elapsed(),
    }
}

/// Checks that the compiler raised the error that a case expects.
fn check_rejects(rejects: Rejects, built: &Built) -> Result<(), Failure> {
    let wanted = match (rejects.code, rejects.line) {
        (0, None) => "an error".to_string(),
        (0, Some(line)) => format!("an error on line {line}"),
        (code, None) => format!("error {code}"),
        (code, Some(line)) => format!("error {code} on line {line}"),
    };
    let Built::Refused(_, errors) = built else {
        let message = format!("expected {wanted}, but the program compiles");
        return Err(Failure::Accepted(message));
    };
    let fits = |(code, line, _): &(Option<u16>, u32, String)| {
        (rejects.code == 0 || *code == Some(rejects.code))
            && rejects.line.is_none_or(|l| l == *line)
    };
    if errors.iter().any(fits) {
        return Ok(());
    }
    let found: Vec<String> = errors
        .iter()
        .map(|(code, line, message)| match code {
            Some(code) => format!("error {code} on line {line}: {message}"),
            None => format!("line {line}: {message}"),
        })
        .collect();
    let message = format!("expected {wanted}, found {}", found.join("; "));
    Err(Failure::Accepted(message))
}
