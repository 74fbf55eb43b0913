//! Clocks of durations beside timers of the program: how far a clock can be ahead of a timer whose coil is on.
//!
//! A timer that ends what a duration limits never shows the same as the clock of that duration, as it begins a scan
//! later or stands where it has expired. No bit of the one is equal to a bit of the other then, and an invariant of
//! bits would have to name each value of both. What both differ by at most is one relation. Which of these relations
//! hold is found by an induction over all of them at once, from which those that a scan breaks are taken (C. Flanagan
//! and K. R. M. Leino, "Houdini, an annotation assistant for ESC/Java", 2001).

use crate::aig::{Aig, Lit};
use crate::bits::{Bits, constant, signed, unsigned};
use crate::effort::Limit;
use crate::model::{Key, TimerPart};
use crate::proof::Fact;
use crate::reduce::Reduced;
use crate::sat::{Answer, Solver};
use crate::system::System;
use rustc_hash::FxHashSet;

/// Relation between a clock and a timer: the clock shows no more than the timer and `most_ms`, and nothing unless it
/// runs and the coil of the timer is on. If it is never ahead, it runs only while the coil is on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Lag {
    /// Memory of the clock: units, milliseconds beyond, and whether it runs.
    pub clock: [Key; 3],
    /// Number of the timer.
    pub timer: u32,
    /// Unit of both in milliseconds.
    pub unit_ms: u16,
    /// Milliseconds by which the clock may be ahead.
    pub most_ms: u32,
    /// Of a timer that stands for a scan where it has expired, before the clock ends.
    pub expired: Option<Expired>,
}

/// Expiry of a timer with one preset. Once it has expired, the clock shows less than the preset and a scan, as the
/// timer had not reached the preset in the scan before.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Expired {
    /// The preset in units, a constant.
    pub preset: i16,
    /// The longest scan in milliseconds.
    pub scan_ms: u32,
}

/// Latch that has this value wherever a clock runs though a timer has expired: it ends the clock in the next scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Ending {
    /// Memory of whether the clock runs.
    pub running: Key,
    /// Number of the timer.
    pub timer: u32,
    /// The latch, by its number in the system.
    pub latch: usize,
    /// Its value.
    pub on: bool,
}

/// Number of bits of a number of units: more than those of a timer.
const UNITS: usize = 20;

/// Number of bits of milliseconds beyond them: two units.
const BEYOND: usize = 9;

impl Lag {
    /// The relation in terms of what latches hold: before a scan, or after it.
    pub(crate) fn holds(&self, system: &System, aig: &mut Aig, of: &dyn Fn(usize) -> Lit) -> Lit {
        let bits = |key: Key| bits(system, key, of);
        let timer = |part| bits(Key::Timer(self.timer, part));
        let [units, beyond, running] = self.clock.map(bits);
        let shown = (unsigned(&units, UNITS), unsigned(&beyond, BEYOND));
        let value = signed(&timer(TimerPart::Value), UNITS);
        let most = self.later(aig, &value, &timer(TimerPart::Part));
        let mut within = is_at_most(aig, &shown, &most);
        if let Some(expired) = self.expired {
            let preset = constant(expired.preset.into(), UNITS);
            let is_before = aig.less(&value, &preset);
            let before = aig.and(within, is_before);
            let most = self.most_after(&expired);
            let after = is_at_most(aig, &shown, &most);
            let done = aig.any(timer(TimerPart::Done));
            within = aig.mux(done, after, before);
        }
        // What is beyond a unit is never a unit, of timers by a constraint.
        let unit = constant(self.unit_ms.max(1).into(), BEYOND);
        let is_rest = aig.below(&shown.1, &unit);
        let within = aig.and(within, is_rest);
        let is_zero = [units, beyond].concat();
        let is_zero = !aig.any(is_zero);
        let running = aig.any(running);
        let coil = aig.any(timer(TimerPart::Coil));
        let both = aig.and(running, coil);
        let otherwise = match self.most_ms {
            0 => aig.and(is_zero, !running),
            _ => is_zero,
        };
        aig.mux(both, within, otherwise)
    }

    /// The time that is `most_ms` later: units, and milliseconds beyond.
    fn later(&self, aig: &mut Aig, units: &[Lit], beyond: &[Lit]) -> (Bits, Bits) {
        let unit = u32::from(self.unit_ms.max(1));
        let rest = constant((self.most_ms % unit).into(), BEYOND);
        let sum = aig.add(&unsigned(beyond, BEYOND), &rest);
        let whole = constant(unit.into(), BEYOND);
        let is_less = aig.below(&sum, &whole);
        let less = aig.sub(&sum, &whole);
        let whole_units = constant((self.most_ms / unit).into(), UNITS);
        let units = aig.add(units, &whole_units);
        let units = aig.add(&units, &unsigned(&[!is_less], UNITS));
        (units, aig.select(is_less, &sum, &less))
    }

    /// The most that the clock shows where the timer has expired: a moment before, it had less than the preset, and a
    /// scan has passed since.
    fn most_after(&self, expired: &Expired) -> (Bits, Bits) {
        let unit = i64::from(self.unit_ms.max(1));
        let preset = i64::from(expired.preset) * unit;
        let most = preset + i64::from(self.most_ms) + i64::from(expired.scan_ms) - 1;
        let most = most.max(0);
        (constant(most / unit, UNITS), constant(most % unit, BEYOND))
    }

    /// Returns true if another one is about the same clock and timer.
    fn is_between(&self, other: &Lag) -> bool {
        (self.clock, self.timer) == (other.clock, other.timer)
    }

    /// Returns true if clock and timer belong to a system.
    fn is_in(&self, system: &System) -> bool {
        let timer = Key::Timer(self.timer, TimerPart::Value);
        let has = |key| system.latches.iter().any(|latch| latch.key == key);
        has(timer) && has(self.clock[0])
    }
}

impl Ending {
    /// The relation in terms of what latches hold: before a scan, or after it.
    pub(crate) fn holds(&self, system: &System, aig: &mut Aig, of: &dyn Fn(usize) -> Lit) -> Lit {
        let stands = stands(system, aig, (self.running, self.timer), of);
        let other = of(self.latch).invert_if(self.on);
        !aig.and(stands, other)
    }
}

/// What the latches of a piece of memory hold.
fn bits(system: &System, key: Key, of: &dyn Fn(usize) -> Lit) -> Bits {
    let latches = system.latches.iter().enumerate();
    let own = latches.filter(|(_, latch)| latch.key == key);
    own.map(|(number, _)| of(number)).collect()
}

/// Returns a bit that is on where a clock runs though a timer has expired.
fn stands(
    system: &System,
    aig: &mut Aig,
    (running, timer): (Key, u32),
    of: &dyn Fn(usize) -> Lit,
) -> Lit {
    let running = aig.any(bits(system, running, of));
    let done = Key::Timer(timer, TimerPart::Done);
    let done = aig.any(bits(system, done, of));
    aig.and(running, done)
}

/// Returns a bit that is on if a time, in units and milliseconds beyond, is at most another.
fn is_at_most(aig: &mut Aig, time: &(Bits, Bits), most: &(Bits, Bits)) -> Lit {
    let is_less = aig.less(&time.0, &most.0);
    let is_same = aig.equal(&time.0, &most.0);
    let is_beyond = aig.below(&most.1, &time.1);
    let ends = aig.and(is_same, !is_beyond);
    aig.or(is_less, ends)
}

/// A relation in a system of which it is to be proved: before a scan, and after it.
struct Candidate {
    fact: Fact,
    now: Lit,
    next: Lit,
}

/// Finds the relations of a system that hold in all its runs, and supposes them in the smaller system made of it. The
/// limit may end that early, without any.
pub(crate) fn suppose(system: &System, reduced: &mut Reduced, limit: &Limit) -> Vec<Fact> {
    let lags = system.lags.iter().filter(|lag| lag.is_in(system));
    let (standing, running): (Vec<Lag>, Vec<Lag>) = lags.partition(|lag| lag.expired.is_some());
    let running = running.into_iter().map(Fact::Lag).collect();
    let mut facts = kept(system, reduced, running, limit);
    let is_known = |lag: &Lag| {
        let same = |fact: &Fact| matches!(fact, Fact::Lag(known) if known.is_between(lag));
        facts.iter().any(same)
    };
    let mut open = Vec::new();
    for lag in standing.into_iter().filter(|lag| !is_known(lag)) {
        let endings = endings(system, reduced, &lag, limit);
        open.extend(endings.into_iter().map(Fact::Ends));
        open.push(Fact::Lag(lag));
    }
    facts.extend(kept(system, reduced, open, limit));
    facts
}

/// Supposes those of these relations that hold in all runs; without a bound of a clock, none of them.
fn kept(system: &System, reduced: &mut Reduced, facts: Vec<Fact>, limit: &Limit) -> Vec<Fact> {
    let mut candidates: Vec<Candidate> = Vec::new();
    for fact in facts {
        let [now, next] = reduced.both(system, |aig, of| fact.holds(system, aig, of));
        if now != Lit::TRUE {
            candidates.push(Candidate { fact, now, next });
        }
    }
    let bounds = |of: &[Candidate]| of.iter().any(|kept| matches!(kept.fact, Fact::Lag(_)));
    if !keep_first(&mut candidates, &reduced.system, limit) {
        return Vec::new();
    }
    while bounds(&candidates) {
        match keep_inductive(&mut candidates, &reduced.system, limit) {
            None => return Vec::new(),
            Some(true) => {
                let holds = candidates.iter().map(|candidate| candidate.now);
                reduced.system.constraints.extend(holds);
                return candidates.iter().map(|kept| kept.fact).collect();
            }
            Some(false) => {}
        }
    }
    Vec::new()
}

/// Latches of which each alone ends a clock in the next scan where its timer has expired.
fn endings(system: &System, reduced: &mut Reduced, lag: &Lag, limit: &Limit) -> Vec<Ending> {
    let (running, timer) = (lag.clock[2], lag.timer);
    let [stands, _] = reduced.both(system, |aig, of| {
        self::stands(system, aig, (running, timer), of)
    });
    let [_, runs_on] = reduced.both(system, |aig, of| aig.any(bits(system, running, of)));
    let mut seen = FxHashSet::default();
    let cone = reduced.system.cone(runs_on);
    let latches = system.latches.iter().enumerate();
    let latches = latches
        .filter(|(_, latch)| matches!(latch.key, Key::Bit(..) | Key::Timer(_, TimerPart::Done)));
    let latches = latches.map(|(number, latch)| (number, reduced.lit(latch.now)));
    let latches = latches.filter(|(_, now)| cone[now.node()] && seen.insert(now.node()));
    let mut open: Vec<(usize, Lit, bool)> = latches
        .flat_map(|(number, now)| [true, false].map(|on| (number, now, on)))
        .collect();
    limit.charge(reduced.system.aig.nodes().len());
    let mut solver = Solver::new(limit);
    for &holds in &reduced.system.constraints {
        let holds = solver.lit(&reduced.system.aig, holds);
        solver.clause(&[holds]);
    }
    let [stands, runs_on] = [stands, runs_on].map(|lit| solver.lit(&reduced.system.aig, lit));
    let mut endings = Vec::new();
    while let Some((latch, now, on)) = open.pop() {
        let has = solver.lit(&reduced.system.aig, now.invert_if(!on));
        match solver.solve(&[stands, runs_on, has]) {
            Answer::Unsat => endings.push(Ending {
                running,
                timer,
                latch,
                on,
            }),
            // What holds in a scan in which the clock runs on does not end it.
            Answer::Sat => open.retain(|&(_, now, on)| solver.value(now) != on),
            Answer::Unknown => return Vec::new(),
        }
    }
    endings
}

/// Keeps what holds before the first scan; false if the limit is reached.
fn keep_first(candidates: &mut Vec<Candidate>, system: &System, limit: &Limit) -> bool {
    let mut solver = Solver::new(limit);
    for latch in &system.latches {
        if let Some(init) = latch.init {
            let known = solver.lit(&system.aig, latch.now.invert_if(!init));
            solver.clause(&[known]);
        }
    }
    candidates.retain(|candidate| {
        let fails = solver.lit(&system.aig, !candidate.now);
        solver.solve(&[fails]) == Answer::Unsat
    });
    !limit.is_over()
}

/// Takes away what a scan can break though all held before it. Returns true if that is nothing; `None`: the limit is
/// reached.
fn keep_inductive(candidates: &mut Vec<Candidate>, system: &System, limit: &Limit) -> Option<bool> {
    limit.charge(system.aig.nodes().len());
    let mut solver = Solver::new(limit);
    let held = candidates.iter().map(|candidate| candidate.now);
    for holds in system.constraints.iter().copied().chain(held) {
        let holds = solver.lit(&system.aig, holds);
        solver.clause(&[holds]);
    }
    let before = candidates.len();
    let mut is_over = false;
    candidates.retain(|candidate| {
        let breaks = solver.lit(&system.aig, !candidate.next);
        match solver.solve(&[breaks]) {
            Answer::Unsat => true,
            Answer::Sat => false,
            Answer::Unknown => {
                is_over = true;
                false
            }
        }
    });
    (!is_over).then_some(candidates.len() == before)
}

#[cfg(test)]
mod tests {
    use crate::certificate::formulas;
    use crate::effort::Limit;
    use crate::proof::Fact;
    use crate::prove::{Decision, Options, Verdict, decide};
    use crate::sat::{Answer, Solver};
    use crate::tests::module;
    use rungc_sim::property::{Property, parse};

    fn never(list: &str, condition: &str) -> Decision {
        let condition = parse(condition, &|_| Vec::new()).unwrap();
        decide(
            &module(list),
            &Property::Never(condition),
            &Options::default(),
        )
    }

    /// A movement that a timer ends, whose coil comes a scan later.
    const LATER: &str = "LD Y000\nOUT T0 K20\nLD X002\nINV\nAND M0\nOR T0\nOUT M0\nLD X000\nOR Y000\nANI X001\n\
                         ANI M0\nOUT Y000\nEND\n";

    /// The same where it comes in the same scan.
    const AT_ONCE: &str = "LD X000\nOUT T0 K20\nANI T0\nOUT Y000\nEND\n";

    /// A state in which a timer runs, whose contact ends it by a relay, in the next scan.
    const AFTER: &str =
        "LD X000\nANI M0\nOUT Y000\nOUT T0 K20\nLD T0\nOR M0\nAND X000\nOUT M0\nEND\n";

    #[test]
    fn a_state_that_a_timer_ends_is_as_short_as_the_timer() {
        for list in [LATER, AFTER] {
            let decision = never(list, "Y000 for 2200ms");
            assert_eq!(decision.verdict, Verdict::Proved);
            let proof = decision.proof.unwrap();
            assert!(proof.facts.iter().any(|fact| matches!(fact, Fact::Lag(_))));
            for (name, formula) in formulas(&proof) {
                let mut solver = Solver::new(&Limit::none());
                let all = formula.all.iter();
                let all: Vec<_> = all.map(|&lit| solver.lit(&formula.aig, lit)).collect();
                assert_eq!(solver.solve(&all), Answer::Unsat, "{name}");
            }
        }
        assert_eq!(never(AT_ONCE, "Y000 for 2s").verdict, Verdict::Proved);
        // Shorter than the timer, or than the timer and a scan.
        let short = [
            (LATER, "Y000 for 2100ms"),
            (AFTER, "Y000 for 2100ms"),
            (AT_ONCE, "Y000 for 1900ms"),
        ];
        for (list, condition) in short {
            let verdict = never(list, condition).verdict;
            assert!(
                matches!(verdict, Verdict::Found(_)),
                "{condition}: {verdict:?}"
            );
        }
    }
}
