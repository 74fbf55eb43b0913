//! Evidence in words.

use crate::{
    Case, Change, Evidence, Gap, Inputs, Method, Number, Requirement, Run, Setting, Share, Value,
    Verified,
};
use rungc_syntax::diag::counted;
use std::fmt;

/// Statement below the heading of a report: what a proof is about, and what not.
pub(crate) const SCOPE: &str = "A proof is a statement about every run of the program in this model, under these \
     assumptions. It says nothing of the machine: a welded contact or a valve that sticks is not in the model. It does \
     not replace safety functions in hardware.";

/// Verdict as a sentence.
pub(crate) fn verdict(verified: &Verified) -> String {
    let reason = verified.reason.as_deref();
    match (verified.verdict, verified.holds) {
        ("proved", _) => "Proved for this model under these assumptions.".to_string(),
        ("not reachable", _) => {
            "Not reachable: proved for this model under these assumptions.".to_string()
        }
        ("the same", _) => {
            "The same in both programs: proved for this model under these assumptions.".to_string()
        }
        ("differs", _) => format!("Differs in the run below: {}.", reason.unwrap_or_default()),
        ("reached", _) => "Reached: the run below ends with it.".to_string(),
        (_, Some(false)) => "Violated by the run below.".to_string(),
        ("vacuous", _) => format!("Vacuous: {}.", reason.unwrap_or("no reason is known")),
        _ => format!("Not decided: {}.", reason.unwrap_or("no reason is known")),
    }
}

impl Verified {
    /// Grounds of the verdict in words; `None` if the verdict says all.
    pub fn method(&self) -> Option<String> {
        method(self)
    }
}

fn method(verified: &Verified) -> Option<String> {
    let verb = match verified.verdict {
        "not reachable" => "reaches",
        "the same" => "breaks",
        _ => "violates",
    };
    Some(match &verified.method {
        Method::Induction { scans: 1, bits } => format!(
            "induction over 1 scan: no scan {verb} it, from whatever state of memory ({})",
            counted(*bits, "bit")
        ),
        Method::Induction { scans, bits } => format!(
            "induction over {scans} scans: no run of {scans} scans from power-on {verb} it, and no scan that follows {} \
             without that does, from whatever state of memory ({})",
            counted(scans.saturating_sub(1), "scan"),
            counted(*bits, "bit")
        ),
        Method::Invariant { clauses, bits } => format!(
            "invariant of {} over {} of memory, found by property-directed reachability (PDR) and confirmed by a second \
             run of the solver",
            counted(*clauses, "clause"),
            counted(*bits, "bit")
        ),
        Method::Common => "induction over all memory that both programs have in common".to_string(),
        Method::Run => format!(
            "run of {}, replayed on {}",
            counted(verified.run.as_ref()?.scans, "scan"),
            verified.run.as_ref()?.engines.join(", ")
        ),
        Method::Bounded { scans } => format!(
            "bounded search: no run of up to {}; longer ones are unknown",
            counted(*scans, "scan")
        ),
        Method::None => return None,
    })
}

impl fmt::Display for Inputs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let devices = self.devices.join(", ");
        match self.named_by {
            Some(by) => write!(f, "written from outside ({by}): {devices}"),
            None => write!(f, "nothing in the program writes: {devices}"),
        }
    }
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)?;
        match (self.step, self.is_instruction) {
            (Some(step), true) => write!(f, " (step {step})"),
            (Some(step), false) => write!(f, " (network at step {step})"),
            (None, _) => Ok(()),
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Number::Integer(value) => value.fmt(f),
            Number::Float(value) => write!(f, "{value:?}"),
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name, self.value)
    }
}

impl fmt::Display for Run {
    /// On one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = steps(self)
            .into_iter()
            .map(|[scans, begins, set]| match begins.is_empty() {
                true => format!("{scans}: {set}"),
                false => format!("scan {scans} ({begins}): {set}"),
            });
        f.write_str(&rows.collect::<Vec<_>>().join("; "))
    }
}

impl fmt::Display for Case {
    /// With its place and its result.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}:{}): ", self.name, self.file, self.line)?;
        match &self.failure {
            None => f.write_str("passed"),
            Some(failure) => write!(f, "failed: {failure}"),
        }
    }
}

/// The scans of a change: `1`, or `2 to 9`.
pub(crate) fn scans(change: &Change) -> String {
    match change.scans {
        0 | 1 => change.scan.to_string(),
        n => format!("{} to {}", change.scan, change.scan + n - 1),
    }
}

/// Values: `X000 = 1 (start button), X001 = 0`.
pub(crate) fn values(values: &[Value]) -> String {
    let values = values.iter().map(|value| {
        let set = format!("{} = {}", value.device, value.value);
        match &value.comment {
            Some(comment) => format!("{set} ({comment})"),
            None => set,
        }
    });
    values.collect::<Vec<_>>().join(", ")
}

/// The rows of a run: scans, time, what is set, and in the last row the values at its end.
pub(crate) fn steps(run: &Run) -> Vec<[String; 3]> {
    let mut rows = Vec::new();
    if !run.start.is_empty() {
        rows.push(["at power-on".to_string(), String::new(), values(&run.start)]);
    }
    for change in &run.changes {
        let set = match (change.restart, change.set.is_empty()) {
            (true, true) => "STOP, then RUN".to_string(),
            (true, false) => format!("STOP, then RUN, {}", values(&change.set)),
            (false, true) => "no change".to_string(),
            (false, false) => values(&change.set),
        };
        rows.push([scans(change), format!("{} ms", change.at_ms), set]);
    }
    if !run.end.is_empty() {
        rows.push(["then".to_string(), String::new(), values(&run.end)]);
    }
    rows
}

/// Sentences about a requirement that nothing of a kind shows.
pub(crate) fn lacks(evidence: &Evidence, requirement: &Requirement) -> Vec<&'static str> {
    let tests = requirement.tests;
    let is_untested = tests.is_none_or(|tests| tests.passed + tests.failed == 0);
    let properties = evidence.properties.iter();
    let mut own = properties.filter(|p| p.requirement.as_deref() == Some(&requirement.id));
    let mut lines = Vec::new();
    if requirement.properties == 0 {
        lines.push("No property of the program shows that it is met.");
    } else if own.next().is_none() {
        lines.push("Its properties were not part of this run.");
    }
    match tests {
        None => lines.push("Tests: not run."),
        Some(_) if is_untested => lines.push("No test case names it."),
        Some(_) => {}
    }
    lines
}

/// A share: `12 of 30 (40 %)`.
pub(crate) fn share(share: Share) -> String {
    match share.all {
        0 => "nothing to reach".to_string(),
        all => format!(
            "{} of {all} ({} %)",
            share.reached,
            100 * share.reached / all
        ),
    }
}
