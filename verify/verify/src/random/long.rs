//! Long runs: what counters and timers need many scans for.

use super::rarity::Rarity;
use super::{EVALUATED, Habits, Lanes, Random};
use crate::effort::Limit;
use crate::search::Trace;
use crate::system::System;

/// The most words that the inputs of a run take.
const WORDS: usize = 4_000_000;
/// The most scans of a run.
const SCANS: usize = 8192;
/// Runs that are shown and turn out not to happen before the search gives up.
const ATTEMPTS: usize = 16;

/// A search over long runs of 64 lanes in which inputs change often for some time and seldom for another, for what a
/// search scan by scan does not reach. In every other run, lanes that have come to what is rare continue in place of
/// those that have not.
pub(crate) struct LongRuns<'s> {
    system: &'s System,
    scan_ms: u32,
    random: Random,
    rarity: Rarity,
    /// The run under way.
    lanes: Option<Lanes<'s>>,
    runs: u32,
    failed: usize,
}

impl<'s> LongRuns<'s> {
    /// Before the first run.
    pub fn new(system: &'s System, scan_ms: u32) -> Self {
        LongRuns {
            system,
            scan_ms,
            random: Random::new(),
            rarity: Rarity::new(system),
            lanes: None,
            runs: 0,
            failed: 0,
        }
    }

    /// Returns true if too many runs were shown that do not happen.
    pub fn are_over(&self) -> bool {
        self.failed >= ATTEMPTS
    }

    /// Continues up to a limit; `happens` runs what was found on the interpreter.
    pub fn search(
        &mut self,
        limit: &Limit,
        happens: &mut dyn FnMut(&Trace) -> bool,
    ) -> Option<Trace> {
        let scans = SCANS.min(WORDS / self.system.inputs.len().max(1));
        while !limit.is_over() && !self.are_over() {
            let mut lanes = match self.lanes.take() {
                Some(lanes) => lanes,
                None => {
                    self.runs += 1;
                    Lanes::new(self.system, &mut self.random)
                }
            };
            if let Some(trace) = self.stretch(&mut lanes, limit, happens) {
                return Some(trace);
            }
            self.rarity.count(&lanes);
            if self.runs.is_multiple_of(2) {
                lanes.follow(self.rarity.chosen(&lanes));
            }
            self.lanes = Some(lanes).filter(|lanes| lanes.scans.len() < scans && lanes.alive != 0);
        }
        None
    }

    /// Some scans in which inputs keep their habits.
    fn stretch(
        &mut self,
        lanes: &mut Lanes<'s>,
        limit: &Limit,
        happens: &mut dyn FnMut(&Trace) -> bool,
    ) -> Option<Trace> {
        let random = &mut self.random;
        let habits = Habits::new(self.system, random);
        let ms = [1, 10, 10, 100][random.below(4) as usize].min(self.scan_ms);
        let length = 1 << (4 + 2 * random.below(4));
        for _ in 0..length {
            limit.charge(self.system.aig.nodes().len() / EVALUATED + self.system.inputs.len());
            let ms = if lanes.scans.is_empty() { 0 } else { ms };
            lanes.scan_by(ms, &habits, random);
            let bad = lanes.value(self.system.bad);
            if bad != 0 {
                let trace = lanes.trace(bad.trailing_zeros());
                if happens(&trace) {
                    return Some(trace);
                }
                self.failed += 1;
                if self.failed >= ATTEMPTS {
                    return None;
                }
                // A violation that cannot be shown ends this lane.
                lanes.alive &= !(bad & bad.wrapping_neg());
            }
        }
        None
    }
}
