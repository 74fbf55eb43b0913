//! Searches scan by scan from power-on: for a run, and for an induction.

use super::{Answer, PLAIN, Question, Verdict, Why, shown};
use crate::effort::Limit;
use crate::model::World;
use crate::proof::{Method, Posed};
use crate::replay;
use crate::search::{Bounded, Induction, Step, Trace};
use crate::system::System;

/// Bounded search and induction side by side.
pub(super) struct ScanByScan<'a> {
    posed: &'a Posed,
    /// Runs that the interpreter confirms.
    pub hunt: Hunt<'a>,
    /// The same with what a replay cannot show, for which a proof must hold, too.
    complete: Bounded<'a>,
    induction: Induction<'a>,
    /// True if more scans show nothing more of a proof.
    pub ends: bool,
}

impl<'a> ScanByScan<'a> {
    /// Before the first scan.
    pub fn new(question: &'a dyn Question, world: &World, posed: &'a Posed, limit: &Limit) -> Self {
        ScanByScan {
            posed,
            hunt: Hunt::new(question, world, &posed.system, limit),
            complete: Bounded::new(&posed.system, false, limit),
            induction: Induction::new(&posed.system, limit),
            ends: false,
        }
    }

    /// Searches up to this many scans.
    pub fn search(&mut self, scans: usize, limit: &Limit) -> Option<Answer> {
        while !self.ends && self.complete.scans() < scans && !limit.is_over() {
            if let Some(verdict) = self.hunt.step() {
                return Some(verdict.into());
            }
            let step = self.complete.step();
            let scans = self.complete.scans();
            match step {
                Step::Holds if self.induction.step() => {
                    return Some(self.posed.proof(Method::Induction(scans)).into());
                }
                Step::Holds => {}
                Step::Impossible => {
                    return Some(Verdict::Undecided(Why::Contradiction { scans }).into());
                }
                Step::Violated(_) | Step::TimeUp => self.ends = true,
            }
        }
        None
    }
}

/// A search for a run that the interpreter confirms.
pub(super) struct Hunt<'a> {
    question: &'a dyn Question,
    /// The most milliseconds from one scan of the program to the next.
    scan_ms: u32,
    limit: Limit,
    bounded: Bounded<'a>,
    /// Length of the first run that the interpreter did not confirm.
    pub spurious: Option<usize>,
    /// True if a run was too long for the limit to be executed on the interpreter.
    pub is_too_long: bool,
}

impl<'a> Hunt<'a> {
    /// Before the first scan.
    pub fn new(
        question: &'a dyn Question,
        world: &World,
        system: &'a System,
        limit: &Limit,
    ) -> Self {
        Hunt {
            limit: limit.clone(),
            question,
            scan_ms: world.scan_ms,
            bounded: Bounded::new(system, true, limit),
            spurious: None,
            is_too_long: false,
        }
    }

    /// Returns true if nothing can be confirmed any more.
    pub fn has_ended(&self) -> bool {
        self.spurious.is_some() || self.is_too_long
    }

    /// Searches one scan further, unless nothing can be confirmed any more.
    pub fn step(&mut self) -> Option<Verdict> {
        if self.has_ended() {
            return None;
        }
        let Step::Violated(trace) = self.bounded.step() else {
            return None;
        };
        let happens = |trace: &Trace| shown(self.question, &self.limit, trace);
        let stretched = replay::stretched(&trace, self.scan_ms);
        let affords = |trace: &Trace| self.limit.affords(self.question.steps(trace));
        if stretched.as_ref().is_some_and(|trace| !affords(trace)) {
            self.is_too_long = true;
            return None;
        }
        let Some(trace) = stretched.filter(|trace| happens(trace).is_some()) else {
            self.spurious = Some(self.bounded.scans());
            return None;
        };
        let plain = replay::plain(&happens, self.scan_ms, trace, &self.limit.part(PLAIN));
        Some(Verdict::Found(plain))
    }

    /// Verdict if nothing is found.
    pub fn undecided(&self) -> Verdict {
        Verdict::Undecided(match self.spurious {
            Some(scans) => Why::Spurious { scans },
            None => {
                let scans = self.bounded.scans().saturating_sub(1);
                match self.limit.is_late() {
                    true => Why::Time { scans },
                    false => Why::Effort {
                        scans,
                        effort: self.limit.effort(),
                    },
                }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Hunt;
    use crate::effort::Limit;
    use crate::prove::{FOREVER_MS, OfProperty, Options, Question, Surroundings, system};
    use crate::tests::observing;
    use rungc_sim::property::{Property, parse};

    #[test]
    fn runs_that_the_limit_does_not_afford_are_not_executed() {
        // Three scans show that T0 expires after 2000 s; the interpreter counts pulses in each millisecond of them.
        let property = Property::Never(parse("T0", &|_| Vec::new()).unwrap());
        let list = "LD X000\nOUT T0 K20000\nLD X001\nPLSY K1000 K0 Y000\nEND\n";
        let module = observing(list, &property);
        let options = Options::default();
        let (encoder, logic) = system(&module, &property, &options);
        let question = OfProperty {
            module: &module,
            property: &property,
            options: &options,
            surroundings: Surroundings::new(&encoder, &logic, options.world.scan_ms),
        };
        let mut free = options.world.clone();
        free.scan_ms = FOREVER_MS;
        let posed = question.posed(&free);
        for (effort, is_afforded) in [(100, false), (100_000, true)] {
            let limit = Limit::new(effort, None);
            let mut hunt = Hunt::new(&question, &options.world, &posed.system, &limit);
            let found = (0..4).find_map(|_| hunt.step());
            assert_eq!(
                (found.is_some(), hunt.is_too_long),
                (is_afforded, !is_afforded)
            );
            assert!(!limit.is_over());
        }
    }
}
