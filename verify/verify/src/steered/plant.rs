//! A program on the interpreter, with its property, as a subject of a search; and what may happen to it.

use super::{Levels, Outside, Run, State, Step, Subject, distance, value_of};
use crate::aig::Node;
use crate::effort::Limit;
use crate::model::{AFTER_STOP, Encoder, Input, Key, device_of, gaps_of};
use crate::replay::{self, Moment};
use crate::search::{Scan, Trace};
use crate::system::System;
use rungc_ir::Module;
use rungc_ir::node::Expr;
use rungc_rt::Program;
use rungc_sim::property::{Condition, Monitor, Property, Watcher};
use rungc_syntax::DeviceClass;
use std::collections::{BTreeMap, BTreeSet};

/// A program that follows steps of a run, and what is searched for in it.
pub(crate) struct Plant<'a> {
    run: replay::Run<'a>,
    at_first: Moment,
    property: &'a Property,
    assumed: &'a [Condition],
    watcher: Watcher<'a>,
    monitor: Monitor<'a>,
    limit: Limit,
    /// Steps of a scan, and of a millisecond before it, that count for the limit.
    steps: usize,
    steps_of_ms: usize,
}

impl<'a> Plant<'a> {
    /// Before the first scan. Each scan counts for the limit.
    pub fn new(
        module: &'a Module,
        property: &'a Property,
        assumed: &'a [Condition],
        limit: &Limit,
    ) -> Self {
        let run = replay::Run::new(module, &Trace::default());
        Plant {
            at_first: run.save(),
            run,
            property,
            assumed,
            watcher: Watcher::new(property),
            monitor: Monitor::new(assumed),
            limit: limit.clone(),
            steps: module.exprs.len() / EXECUTED.0 + EXECUTED.1,
            steps_of_ms: match module.takes_time() {
                true => replay::MILLISECOND,
                false => 0,
            },
        }
    }

    /// Begins to follow the property and the assumptions anew.
    fn forget(&mut self) {
        self.watcher = Watcher::new(self.property);
        self.monitor = Monitor::new(self.assumed);
    }
}

/// Expressions of a scan that are executed in a step of a search, and steps that every scan takes.
const EXECUTED: (usize, usize) = (4, 100);

/// A scan as traces have it.
fn scan(step: &Step) -> Scan {
    Scan {
        ms: step.ms,
        scan_time: step.scan_us / 100,
        restart: step.stop,
        set: step.set.iter().copied().collect(),
    }
}

impl Run {
    /// The run as a trace.
    pub(crate) fn trace(&self) -> Trace {
        Trace {
            start: self.start.iter().copied().collect(),
            scans: self.steps.iter().map(scan).collect(),
        }
    }
}

impl<'a> Subject for Plant<'a> {
    type Moment = (Moment, Watcher<'a>, Monitor<'a>);

    fn begin(&mut self, start: &[(Key, i64)]) {
        self.run.restore(&self.at_first);
        self.run.begin_with(start.iter().copied());
        self.forget();
    }

    fn step(&mut self, step: &Step) -> State {
        self.limit
            .charge(self.steps + self.steps_of_ms * step.ms as usize);
        if step.stop {
            self.forget();
        }
        let scan = scan(step);
        if self.run.is_early(&scan) {
            return State::Over;
        }
        let Some(elapsed) = self.run.scan(&scan) else {
            return State::Over;
        };
        if !self.monitor.all_hold(self.run.machine(), elapsed) {
            return State::Over;
        }
        match self.watcher.happened(self.run.machine(), elapsed) {
            true => State::Happened,
            false => State::Lives,
        }
    }

    fn save(&self) -> Self::Moment {
        (self.run.save(), self.watcher.clone(), self.monitor.clone())
    }

    fn restore(&mut self, (moment, watcher, monitor): &Self::Moment) {
        self.run.restore(moment);
        self.watcher = watcher.clone();
        self.monitor = monitor.clone();
    }

    fn constant_scan_ms(&self) -> u32 {
        self.run.machine().constant_scan_ms().unwrap_or(0).into()
    }

    fn programs(&self) -> usize {
        1
    }

    fn value(&self, _: usize, key: Key) -> i64 {
        value_of(self.run.machine(), key)
    }

    fn distance(&self) -> f64 {
        distance(self.property, self.run.machine())
    }
}

/// What may happen to a program, and what says how far a run has come.
#[derive(Clone)]
pub(crate) struct Surroundings {
    /// Events.
    pub outside: Outside,
    /// Memory on which the property depends.
    pub watched: Vec<Key>,
    /// True if the property depends on something that is not modelled.
    pub is_open: bool,
}

/// Levels beyond this count as this one.
const FARTHEST: u32 = 5;

/// Level of inputs whose edges run something, where that may lead to the event.
const EDGES: u32 = 1;

impl Surroundings {
    /// Those of a program, as far as a property depends on them.
    pub fn new(encoder: &Encoder, system: &System, scan_ms: u32) -> Self {
        let mut written = BTreeSet::from_iter(encoder.opened());
        let terminal = |key: &Key| matches!(key, Key::Bit(DeviceClass::X, _));
        written.extend(encoder.memory().map(|(key, ..)| key).filter(terminal));
        let edges = encoder
            .edges()
            .map(|number| Key::Bit(DeviceClass::X, number));
        written.extend(edges);
        let mut near = levels(system);
        near.values_mut()
            .for_each(|level| *level = FARTHEST.min(*level));
        // What is not modelled may depend on anything.
        let gaps = gaps_of(system, encoder);
        let is_open = gaps.iter().any(|gap| gap.what != AFTER_STOP);
        if is_open {
            let devices = encoder.memory().filter_map(|(key, ..)| device_of(key));
            for device in devices {
                near.entry(device).or_insert(FARTHEST);
            }
            for number in encoder.edges() {
                near.entry((DeviceClass::X, number)).or_insert(EDGES);
            }
        }
        let is_near = |key: &Key| device_of(*key).is_some_and(|of| near.contains_key(&of));
        let any = |key: &Key| device_of(*key).is_some() && encoder.initial(*key).is_none();
        let keys = || encoder.memory().map(|(key, ..)| key).filter(is_near);
        let is_inside = |key: &Key| !written.contains(key);
        Surroundings {
            is_open,
            watched: keys().filter(is_inside).collect(),
            outside: Outside {
                latched: keys().filter(any).collect(),
                written: written.iter().copied().filter(|key| is_near(key)).collect(),
                values: values(encoder.module()),
                near,
                scan_ms,
                stop: system
                    .inputs
                    .iter()
                    .any(|(_, input)| *input == Input::Restart),
                ..Outside::default()
            },
        }
    }
}

/// Constants of a program, and values at limits.
fn values(module: &Module) -> Vec<i64> {
    let constants = module.exprs.iter().filter_map(|expr| match *expr {
        Expr::I16(value) => Some(value.into()),
        Expr::I32(value) => Some(value.into()),
        _ => None,
    });
    let limits = [0, 1, -1, i16::MAX.into(), i16::MIN.into()];
    BTreeSet::from_iter(limits.into_iter().chain(constants))
        .into_iter()
        .collect()
}

/// Number of scans from each device to the event.
fn levels(system: &System) -> Levels {
    let latches = system.latch_numbers();
    let inputs: BTreeMap<usize, Input> = system
        .inputs
        .iter()
        .map(|(lit, input)| (lit.node(), *input))
        .collect();
    let mut seen = vec![false; system.aig.nodes().len()];
    let mut levels = Levels::new();
    let mut open = vec![system.bad.node()];
    for level in 0.. {
        let mut next = Vec::new();
        while let Some(node) = open.pop() {
            if std::mem::replace(&mut seen[node], true) {
                continue;
            }
            if let Node::And(a, b) = system.aig.nodes()[node] {
                open.extend([a.node(), b.node()]);
            }
            let key = match (latches.get(&node), inputs.get(&node)) {
                (Some(&latch), _) => {
                    next.push(system.latches[latch].next.node());
                    system.latches[latch].key
                }
                (None, Some(&(Input::Device(key, _) | Input::Shown(_, key, _)))) => key,
                _ => continue,
            };
            if let Some(device) = device_of(key) {
                levels.entry(device).or_insert(level);
            }
        }
        if next.is_empty() {
            break;
        }
        open = next;
    }
    levels
}

#[cfg(test)]
mod tests {
    use crate::prove::{Decision, EFFORT, Options, Verdict, decide};
    use crate::tests::observing;
    use rungc_sim::property::{Property, parse};

    /// Decision that a condition never holds in a program.
    fn decided(list: &str, condition: &str, effort: u64) -> Decision {
        let property = Property::Never(parse(condition, &|_| Vec::new()).unwrap());
        let module = observing(list, &property);
        let options = Options {
            effort,
            ..Options::default()
        };
        decide(&module, &property, &options)
    }

    /// Number of scans of a run after which it holds.
    fn found(list: &str, condition: &str, effort: u64) -> Option<usize> {
        match decided(list, condition, effort).verdict {
            Verdict::Found(trace) => Some(trace.scans.len()),
            _ => None,
        }
    }

    #[test]
    fn pulse_outputs_alone_show_that_pulses_end() {
        // Ten pulses at 1 Hz: they end after the five seconds of T0, not before.
        let list = "LD M8340\nANI M0\nOUT Y012\nLD> D8340 K100\nOUT Y013\nLD X000\nSET M0\nLD M0\n\
                    DPLSY K1 K10 Y000\nOUT T0 K50\nLD M8029\nMPS\nAND T0\nOUT Y010\nMPP\nANI T0\nAND M0\nOUT Y011\n\
                    END\n";
        assert!(found(list, "Y010", EFFORT).is_some_and(|scans| scans > 50));
        for (output, shown) in [("Y011", false), ("Y012", true), ("Y013", true)] {
            let decision = decided(list, output, 500);
            let verdict = &decision.verdict;
            assert!(
                matches!(verdict, Verdict::Undecided(_)),
                "{output}: {verdict:?}"
            );
            let mut gaps = decision.gaps.iter();
            let names = gaps.any(|gap| gap.what == "special devices of pulse outputs");
            assert_eq!(names, shown, "{output}: {:?}", decision.gaps);
        }
    }

    #[test]
    fn what_is_not_modelled_happens_on_the_interpreter() {
        let root =
            "LD M8000\nMOV K2X000 D0\nSQR D0 D1\nLD= D1 K4\nOUT Y004\nLD= D1 K16\nOUT Y005\nEND\n";
        assert!(found(root, "Y004", 1500).is_some());
        // The root of eight bits is never 16.
        assert_eq!(found(root, "Y005", 1500), None);
    }

    #[test]
    fn a_stretch_lasts_while_it_comes_to_something_new() {
        // Ten seconds of an input, counted by a clock and with another count that takes away.
        let list = "LD X003\nANDP M8012\nINC D4\nLDI X003\nANDP M8012\nDEC D4\nLD< D4 K0\nMOV K0 D4\n\
                    LD> D4 K100\nSET M3\nLD X001\nOUT T1 K50\nLD M3\nAND T1\nOUT Y003\nEND\n";
        assert!(found(list, "Y003", EFFORT).is_some_and(|scans| scans > 100));
    }
}
