//! Pulses at input terminals: trains that a search lets come between two scans, for high-speed counters, SPD, and
//! interrupts of inputs.

use crate::cover::{Cells, value};
use crate::task::{Step, Task};
use fastrand::Rng;
use rungc_interp::{Machine, rt_class};
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Action, Expr, ExprId, FunctionKind, Stmt};
use rungc_ir::walk::statements;
use rungc_models::Model;
use rungc_models::high_speed::Kind;
use rungc_rt::{Class, Plc};
use rungc_sim::Target;
use rungc_sim::wire::{self, Change, Signal};
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// The most pulses in a millisecond: about what the fastest inputs of these PLCs count.
pub(crate) const MOST_A_MS: u32 = 100;
/// As many pulses take about as long as a scan of a small machine's program.
const PULSES_A_SCAN: u64 = 32;
/// Longer trains come the less often the longer they are, or a search would do little else.
const SHORT: u32 = 2_000;

/// Terminals that receive pulses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum At {
    /// At a terminal X.
    Input(u32),
    /// At the terminals of an encoder's two phases, A and B: cycles, backward if their number is below 0.
    Encoder(u32, u32),
}

/// A source of pulses in a search.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Source {
    /// Terminals.
    pub at: At,
    /// High-speed counters that count there.
    pub counters: Vec<u32>,
}

/// Value that a program compares a counter with.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Goal {
    Constant(i32),
    /// A register, or the first of a pair.
    Register(DeviceClass, u32, bool),
}

/// Selection of the next pulses.
pub(crate) struct Trains<'t> {
    sources: &'t [Source],
    /// By counter.
    goals: Vec<(u32, Goal)>,
    model: &'static Model,
}

impl At {
    /// This many pulses or cycles, all of them in `scan_ms` milliseconds.
    pub fn signal(self, count: i32, scan_ms: u32) -> Signal {
        let hz = hertz(count, scan_ms).into();
        match self {
            At::Input(input) => Signal::Pulses {
                input,
                count: count.unsigned_abs(),
                hz,
            },
            At::Encoder(a, b) => Signal::Encoder { a, b, count, hz },
        }
    }

    /// Returns true if pulses may come to both in one step.
    fn may_coincide(self, other: At) -> bool {
        let both = matches!((self, other), (At::Encoder(..), At::Encoder(..)));
        let mut inputs = other.inputs();
        !both && inputs.all(|input| self.inputs().all(|own| own != input))
    }

    /// The terminals.
    pub fn inputs(self) -> impl Iterator<Item = u32> + Clone {
        let (first, second) = match self {
            At::Input(input) => (input, None),
            At::Encoder(a, b) => (a, Some(b)),
        };
        [first].into_iter().chain(second)
    }
}

/// A frequency that people expect, at which as many pulses pass in the time.
pub fn hertz(count: i32, scan_ms: u32) -> u32 {
    let needed = u64::from(count.unsigned_abs()) * 1000;
    let fits = |hz: &u32| u64::from(*hz) * u64::from(scan_ms) >= needed;
    let decades = [1_000, 10_000, 100_000].into_iter();
    let mut usual = decades.flat_map(|decade| [decade, 2 * decade, 5 * decade]);
    usual.find(fits).unwrap_or(1_000_000)
}

/// Returns true if the pulses of a step fit in the time of its first scan, and a terminal has one train, a step of a
/// test file one encoder.
pub(crate) fn are_possible(task: &Task, step: &Step) -> bool {
    let most = step.scan_ms.saturating_mul(MOST_A_MS);
    let mut trains = step.pulses.iter().enumerate();
    trains.all(|(i, &(source, count))| {
        let at = task.sources[source].at;
        let before = step.pulses[..i].iter();
        let mut before = before.map(|&(other, _)| task.sources[other].at);
        count.unsigned_abs() <= most && before.all(|other| at.may_coincide(other))
    })
}

/// The terminals at which a program notices each edge, and encoders of its counters; without those that a machine
/// drives.
pub fn sources(module: &Module, driven: &dyn Fn((DeviceClass, u32)) -> bool) -> Vec<Source> {
    let mut inputs: BTreeSet<u32> = BTreeSet::new();
    let mut counted: BTreeSet<(u32, u32)> = BTreeSet::new();
    for function in &module.functions {
        let FunctionKind::InputEdge { input, .. } = function.kind else {
            continue;
        };
        inputs.insert(input);
        statements(&function.body, &mut |stmt| {
            if let Stmt::Do(Action::Count(count)) = stmt {
                counted.insert((count.number, input));
            }
        });
    }
    let encoders = counted.iter().filter_map(|&(number, _)| {
        let counter = module.model.high_speed.counter(number)?;
        match (counter.kind, counter.counts) {
            (Kind::Phases, &[a, b]) => Some((At::Encoder(a, b), number)),
            _ => None,
        }
    });
    let mut encoders: Vec<(At, u32)> = encoders.collect();
    encoders.dedup();
    let of_input = |input: u32| {
        let here = counted.iter().filter(|&&(_, at)| at == input);
        let numbers = here.map(|&(number, _)| number);
        // Pulses at one phase take an encoder nowhere.
        let numbers = numbers.filter(|number| encoders.iter().all(|(_, other)| other != number));
        (At::Input(input), numbers.collect())
    };
    let mut found: Vec<(At, Vec<u32>)> = inputs.into_iter().map(of_input).collect();
    for &(at, number) in &encoders {
        match found.iter_mut().find(|(other, _)| *other == at) {
            Some((_, counters)) => counters.push(number),
            None => found.push((at, vec![number])),
        }
    }
    let is_free = |at: &At| at.inputs().all(|input| !driven((DeviceClass::X, input)));
    let found = found.into_iter().filter(|(at, _)| is_free(at));
    let found = found.map(|(at, counters)| Source { at, counters });
    found.collect()
}

/// The changes of inputs that a step's pulses are, in order. `on`: whether an input is on before.
pub fn changes(task: &Task, step: &Step, on: &dyn Fn(u32) -> bool) -> Vec<Change> {
    let signals = step.pulses.iter();
    let signals =
        signals.map(|&(source, count)| task.sources[source].at.signal(count, step.scan_ms));
    let signals: Vec<Signal> = signals.collect();
    let mut now: Vec<(u32, bool)> = Vec::new();
    let mut changes = wire::changes(&signals);
    changes.retain(|change| {
        let known = now.iter_mut().find(|(input, _)| *input == change.input);
        match known {
            Some((_, before)) => std::mem::replace(before, change.on) != change.on,
            None => {
                now.push((change.input, change.on));
                on(change.input) != change.on
            }
        }
    });
    changes
}

/// The inputs of a search that are off once a step's pulses have come.
pub(crate) fn left_off<'a>(
    task: &'a Task,
    pulses: &'a [(usize, i32)],
) -> impl Iterator<Item = usize> + 'a {
    let terminals = pulses
        .iter()
        .flat_map(|&(source, _)| task.sources[source].at.inputs());
    terminals.filter_map(|terminal| {
        let target = Target::Bit(DeviceClass::X, terminal);
        task.inputs.iter().position(|input| input.target == target)
    })
}

/// Cost of a step's pulses, in scans.
pub fn cost(pulses: &[(usize, i32)]) -> u64 {
    let counts = pulses.iter().map(|(_, count)| count.unsigned_abs());
    counts.map(u64::from).sum::<u64>() / PULSES_A_SCAN
}

impl<'t> Trains<'t> {
    /// Of a search.
    pub fn new(task: &'t Task<'t>) -> Self {
        Trains {
            sources: &task.sources,
            goals: goals(task.module),
            model: task.module.model,
        }
    }

    /// Those of a step, whose scans may become longer to hold them, up to `most_ms`.
    pub fn next(
        &self,
        machine: &Machine,
        rng: &mut Rng,
        (scan_ms, most_ms): (&mut u32, u32),
    ) -> Vec<(usize, i32)> {
        if self.sources.is_empty() {
            return Vec::new();
        }
        let count = match rng.u32(..100) {
            0..=59 => 0,
            60..=94 => 1,
            _ => 2,
        };
        let mut pulses: Vec<(usize, i32)> = Vec::new();
        for _ in 0..count {
            let source = rng.usize(..self.sources.len());
            let at = self.sources[source].at;
            let mut others = pulses.iter().map(|&(other, _)| self.sources[other].at);
            if others.all(|other| at.may_coincide(other)) {
                let count = self.count(&self.sources[source], machine, rng, (scan_ms, most_ms));
                pulses.push((source, count));
            }
        }
        pulses.sort_unstable();
        pulses
    }

    /// Number of pulses: often the distance of a counter to a number that it is compared with.
    fn count(
        &self,
        source: &Source,
        machine: &Machine,
        rng: &mut Rng,
        (scan_ms, most_ms): (&mut u32, u32),
    ) -> i32 {
        let missing = self.missing(source, machine, rng);
        let is_taken = |missing: &i32, rng: &mut Rng| {
            let most = most_ms.max(*scan_ms).saturating_mul(MOST_A_MS);
            let count = missing.unsigned_abs().min(most);
            rng.u32(..4) != 0 && rng.u32(..count.max(SHORT)) < SHORT
        };
        if let Some(missing) = missing.filter(|missing| is_taken(missing, rng)) {
            let needed = missing.unsigned_abs().div_ceil(MOST_A_MS);
            *scan_ms = needed.clamp(*scan_ms, most_ms.max(*scan_ms));
            let most = scan_ms.saturating_mul(MOST_A_MS) as i32;
            return match missing.clamp(-most, most) {
                0 => 1,
                count => count,
            };
        }
        let most = scan_ms.saturating_mul(MOST_A_MS).min(SHORT);
        let count = match rng.u32(..8) {
            0..=2 => 1,
            3..=4 => rng.u32(2..=10),
            5..=6 => rng.u32(11..=100),
            _ => rng.u32(1..=most),
        };
        let count = count.min(most) as i32;
        match source.at {
            At::Encoder(..) if rng.bool() => -count,
            _ => count,
        }
    }

    /// Number of pulses that bring a counter near a number that it is compared with.
    fn missing(&self, source: &Source, machine: &Machine, rng: &mut Rng) -> Option<i32> {
        let counter = *rng.choice(&source.counters)?;
        let goals = self.goals.iter().filter(|(number, _)| *number == counter);
        let goals: Vec<Goal> = goals.map(|(_, goal)| *goal).collect();
        let goal = match *rng.choice(&goals)? {
            Goal::Constant(goal) => goal,
            Goal::Register(class, n, wide) => register(machine, (class, n), wide)?,
        };
        let four_fold = self.model.high_speed.four_fold(counter);
        let four_fold = four_fold.and_then(|relay| machine.bit(Class::M, relay.number()));
        let mut missing = goal.wrapping_sub(value(machine, (Class::C, counter)));
        if four_fold == Some(true) {
            missing /= 4;
        }
        let missing = missing.saturating_add(rng.i32(-1..=1));
        match source.at {
            At::Encoder(..) => Some(missing),
            At::Input(_) if missing >= 0 => Some(missing),
            // Most counters of one input count up; past the number, only a direction leads back to it.
            At::Input(_) => (rng.u32(..4) == 0).then(|| missing.saturating_abs()),
        }
    }
}

/// Value of a register, or a pair.
fn register(machine: &Machine, (class, n): (DeviceClass, u32), wide: bool) -> Option<i32> {
    let class = rt_class(class)?;
    let low = machine.word(class, n)?;
    if !wide {
        return Some(low.into());
    }
    let high = machine.word(class, n + 1)?;
    Some(i32::from(high) << 16 | i32::from(low as u16))
}

/// Values that a program compares its high-speed counters with, by counter.
fn goals(module: &Module) -> Vec<(u32, Goal)> {
    let cells = Cells::of(module);
    let mut found = BTreeSet::new();
    let mut add = |counter: u32, id: ExprId| {
        let goals = cells.behind(module, id).filter_map(|id| goal(module, id));
        found.extend(goals.map(|goal| (counter, goal)));
    };
    for expr in &module.exprs {
        if let Expr::Cmp(_, a, b) = *expr {
            for (a, b) in [(a, b), (b, a)] {
                if let Some(counter) = counter(module, a) {
                    add(counter, b);
                }
            }
        }
    }
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            if let Stmt::Do(Action::Count(count)) = stmt {
                add(count.number, count.preset);
            }
        });
    }
    found.into_iter().collect()
}

/// The counter that an expression reads.
fn counter(module: &Module, id: ExprId) -> Option<u32> {
    match *module.expr(id) {
        Expr::Read(access) if access.kind == AccessKind::Pair && access.place.index.is_none() => {
            (access.place.class == DeviceClass::C).then_some(access.place.number)
        }
        _ => None,
    }
}

fn goal(module: &Module, id: ExprId) -> Option<Goal> {
    if let Some(constant) = crate::cover::constant(module, id) {
        return Some(Goal::Constant(constant));
    }
    let Expr::Read(access) = *module.expr(id) else {
        return None;
    };
    let wide = access.kind == AccessKind::Pair;
    let plain = wide || access.kind == AccessKind::Word;
    let of_register = plain && access.place.index.is_none() && access.place.class != DeviceClass::C;
    of_register.then_some(Goal::Register(
        access.place.class,
        access.place.number,
        wide,
    ))
}
