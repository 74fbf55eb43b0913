//! Proofs by induction, and bounded search for counterexamples.

use crate::effort::Limit;
use crate::model::{Input, Key, device_of};
use crate::sat::{Answer, Solver};
use crate::system::System;
use crate::unroll::Unroller;
use rungc_models::runs::is_counter32;
use std::collections::BTreeMap;

/// A run that the model allows: what it begins with, and the inputs of each scan.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Trace {
    /// Initial values of latched memory.
    pub start: BTreeMap<Key, i64>,
    /// Events before each scan.
    pub scans: Vec<Scan>,
}

/// Events before a scan.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Scan {
    /// Milliseconds since the scan before.
    pub ms: u32,
    /// Duration of the scan before, in units of 0.1 ms.
    pub scan_time: u32,
    /// The PLC was in STOP before it.
    pub restart: bool,
    /// Devices that something other than the program sets.
    pub set: BTreeMap<Key, i64>,
}

/// Searches from power-on, scan by scan.
pub(crate) struct Bounded<'s> {
    system: &'s System,
    limit: Limit,
    unroller: Unroller<'s>,
    solver: Solver,
    /// Supposes what a replay needs: scans of at least a millisecond and the like.
    replay_assumptions: bool,
}

impl<'s> Bounded<'s> {
    /// A search; `replay_assumptions` leaves out what a replay cannot show.
    pub fn new(system: &'s System, replay_assumptions: bool, limit: &Limit) -> Self {
        Bounded {
            limit: limit.clone(),
            system,
            unroller: Unroller::new(system, true),
            solver: Solver::new(limit),
            replay_assumptions,
        }
    }

    /// Number of scans searched.
    pub fn scans(&self) -> usize {
        self.unroller.len()
    }

    /// Searches one scan further.
    pub fn step(&mut self) -> Step {
        self.limit.charge(self.system.aig.nodes().len());
        self.unroller.extend();
        let scan = self.unroller.len() - 1;
        let replay_assumptions = self
            .system
            .replay_assumptions
            .iter()
            .filter(|_| self.replay_assumptions);
        let first = self.system.first_replay_assumptions.iter();
        let first = first.filter(|_| self.replay_assumptions && scan == 0);
        for &holds in self
            .system
            .constraints
            .iter()
            .chain(replay_assumptions)
            .chain(first)
        {
            let holds = self.unroller.at(scan, holds);
            let holds = self.solver.lit(&self.unroller.aig, holds);
            self.solver.clause(&[holds]);
        }
        let bad = self.unroller.at(scan, self.system.bad);
        let bad = self.solver.lit(&self.unroller.aig, bad);
        match self.solver.solve(&[bad]) {
            Answer::Sat => Step::Violated(self.trace()),
            Answer::Unknown => Step::TimeUp,
            Answer::Unsat => {
                self.solver.clause(&[!bad]);
                match self.solver.solve(&[]) {
                    Answer::Sat => Step::Holds,
                    Answer::Unsat => Step::Impossible,
                    Answer::Unknown => Step::TimeUp,
                }
            }
        }
    }

    /// The run that the solver has found.
    fn trace(&self) -> Trace {
        let mut trace = Trace::default();
        for latch in self
            .system
            .latches
            .iter()
            .filter(|latch| latch.init.is_none())
        {
            let on = self.solver.value(self.unroller.at(0, latch.now));
            *trace.start.entry(latch.key).or_default() |= i64::from(on) << latch.bit;
        }
        for scan in 0..self.unroller.len() {
            let mut happens = Scan::default();
            for &(lit, input) in &self.system.inputs {
                let on = self.solver.value(self.unroller.at(scan, lit));
                match input {
                    Input::Device(key, bit) => {
                        *happens.set.entry(key).or_default() |= i64::from(on) << bit;
                    }
                    Input::Time(digit, bit) => {
                        happens.ms += (u32::from(on) << bit) * digit.milliseconds();
                    }
                    Input::ScanTime(bit) => happens.scan_time |= u32::from(on) << bit,
                    Input::Restart => happens.restart = on,
                    Input::Shown(..) | Input::Gap(_) => {}
                }
            }
            happens.set.iter_mut().for_each(with_sign);
            trace.scans.push(happens);
        }
        trace.start.iter_mut().for_each(with_sign);
        trace
    }
}

/// Gives the bits of a word their meaning as a signed number.
pub(crate) fn with_sign((key, value): (&Key, &mut i64)) {
    *value = match device_of(*key) {
        Some((class, number)) if is_counter32(class, number) => (*value as i32).into(),
        _ => (*value as i16).into(),
    };
}

/// Result of one more scan.
#[derive(Clone, PartialEq, Debug)]
pub enum Step {
    /// It cannot violate the property.
    Holds,
    /// This run may.
    Violated(Trace),
    /// There is no such scan: what is assumed contradicts itself.
    Impossible,
    /// The limit is reached.
    TimeUp,
}

/// Induction: if no scan of several in a row violates the property, the next one does not.
pub struct Induction<'s> {
    system: &'s System,
    limit: Limit,
    unroller: Unroller<'s>,
    solver: Solver,
}

impl<'s> Induction<'s> {
    /// Before the first step.
    pub fn new(system: &'s System, limit: &Limit) -> Self {
        Induction {
            system,
            limit: limit.clone(),
            unroller: Unroller::new(system, false),
            solver: Solver::new(limit),
        }
    }

    /// Supposes one scan more; whether the next one cannot violate the property then.
    pub fn step(&mut self) -> bool {
        self.limit.charge(self.system.aig.nodes().len());
        self.unroller.extend();
        let scan = self.unroller.len() - 1;
        for &holds in &self.system.constraints {
            let holds = self.unroller.at(scan, holds);
            let holds = self.solver.lit(&self.unroller.aig, holds);
            self.solver.clause(&[holds]);
        }
        let bad = self.unroller.at(scan, self.system.bad);
        let bad = self.solver.lit(&self.unroller.aig, bad);
        let proved = self.solver.solve(&[bad]) == Answer::Unsat;
        self.solver.clause(&[!bad]);
        proved
    }
}
