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
        }
    }

    /// Searches one scan further, unless nothing can be confirmed any more.
    pub fn step(&mut self) -> Option<Verdict> {
        if self.spurious.is_some() {
            return None;
        }
        let Step::Violated(trace) = self.bounded.step() else {
            return None;
        };
        let happens = |trace: &Trace| shown(self.question, &self.limit, trace);
        let stretched = replay::stretched(&trace, self.scan_ms);
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
