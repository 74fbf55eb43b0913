//! Properties and assumptions: how they are written, and what they are of a scan.

mod parse;

pub use parse::{ParseError, parse};

use crate::aig::Lit;
use crate::bits::{Bits, constant, signed};
use crate::model::Encoder;
use rungc_interp::{Machine, rt_class};
use rungc_ir::node::{AccessKind, Place};
use rungc_models::Model;
use rungc_models::runs::is_counter32;
use rungc_rt::{Class, CmpOp, Plc};
use rungc_sim::Target;
use rungc_syntax::DeviceClass;

/// A condition over devices, as they are after a scan.
#[derive(Clone, PartialEq, Debug)]
pub enum Condition {
    /// A constant.
    Constant(bool),
    /// A bit device is on.
    On(Target),
    /// Not.
    Not(Box<Condition>),
    /// Both.
    And(Box<Condition>, Box<Condition>),
    /// At least one.
    Or(Box<Condition>, Box<Condition>),
    /// A comparison of numbers.
    Compare(CmpOp, Number, Number),
}

/// A number in a comparison.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Number {
    /// A constant.
    Constant(i32),
    /// Value of a device.
    Of(Target),
}

/// A property.
#[derive(Clone, PartialEq, Debug)]
pub enum Property {
    /// The condition holds after no scan.
    Never(Condition),
    /// The condition holds after every scan.
    Always(Condition),
    /// There is a run after which the condition holds.
    Reachable(Condition),
    /// A condition that must be followed by another after the same scan, or after one at most this many milliseconds
    /// later.
    Whenever {
        /// Triggering condition.
        when: Condition,
        /// Condition that must follow.
        then: Condition,
        /// Time limit in milliseconds.
        within_ms: u32,
    },
    /// Once the condition holds, it holds after every later scan, until one after which the other holds.
    Stays {
        /// Condition that must keep holding.
        holds: Condition,
        /// Condition that ends it.
        until: Condition,
    },
}

impl Condition {
    /// The devices that it looks at, each with how many from it on.
    pub fn devices(&self) -> Vec<(DeviceClass, u32)> {
        let mut found = Vec::new();
        self.targets(&mut |target| {
            let (class, first, count) = target.devices(0);
            found.extend((first..first + count).map(|number| (class, number)));
        });
        found.sort();
        found.dedup();
        found
    }

    /// Calls `f` with everything that it looks at.
    pub fn targets(&self, f: &mut impl FnMut(Target)) {
        match self {
            Condition::Constant(_) => {}
            Condition::On(target) => f(*target),
            Condition::Not(a) => a.targets(f),
            Condition::And(a, b) | Condition::Or(a, b) => {
                a.targets(f);
                b.targets(f);
            }
            Condition::Compare(_, a, b) => {
                for number in [a, b] {
                    if let Number::Of(target) = number {
                        f(*target);
                    }
                }
            }
        }
    }

    /// Values that it depends on, on a machine now: names as in test files, first devices, values.
    pub fn values(&self, machine: &Machine) -> Vec<(String, (DeviceClass, u32), i64)> {
        let mut found = Vec::new();
        self.targets(&mut |target| {
            let (class, first, _) = target.devices(0);
            let device = class.number(first);
            let name = match target {
                Target::Current(..) => format!("{device}.value"),
                Target::Pair(..) => format!("{device}.i32"),
                Target::Nibbles(digits, ..) => format!("K{digits}{device}"),
                _ => device.to_string(),
            };
            let value = (name, (class, first), read(machine, target).into());
            if !found.contains(&value) {
                found.push(value);
            }
        });
        found
    }

    /// Value after the scan, as logic.
    pub fn encode(&self, encoder: &mut Encoder) -> Lit {
        match self {
            Condition::Constant(on) => (*on).into(),
            Condition::On(target) => value(encoder, *target)[0],
            Condition::Not(a) => !a.encode(encoder),
            Condition::And(a, b) => {
                let (a, b) = (a.encode(encoder), b.encode(encoder));
                encoder.aig.and(a, b)
            }
            Condition::Or(a, b) => {
                let (a, b) = (a.encode(encoder), b.encode(encoder));
                encoder.aig.or(a, b)
            }
            Condition::Compare(op, a, b) => {
                let [a, b] = [a, b].map(|number| match *number {
                    Number::Constant(value) => constant(value.into(), 32),
                    Number::Of(target) => signed(&value(encoder, target), 32),
                });
                encoder.compare_bits(*op, &a, &b)
            }
        }
    }

    /// Returns true if it holds for the devices now.
    pub fn holds(&self, devices: &impl Devices) -> bool {
        match self {
            Condition::Constant(on) => *on,
            Condition::On(target) => read(devices, *target) != 0,
            Condition::Not(a) => !a.holds(devices),
            Condition::And(a, b) => a.holds(devices) && b.holds(devices),
            Condition::Or(a, b) => a.holds(devices) || b.holds(devices),
            Condition::Compare(op, a, b) => {
                let [a, b] = [a, b].map(|number| match *number {
                    Number::Constant(value) => value,
                    Number::Of(target) => read(devices, target),
                });
                op.holds(a, b)
            }
        }
    }
}

/// Access to a target; `None` if conditions cannot use it.
fn access(target: Target) -> Option<(AccessKind, DeviceClass, u32)> {
    Some(match target {
        Target::Bit(class, number) => (AccessKind::Bit, class, number),
        Target::Word(class, number) => (AccessKind::Word, class, number),
        Target::Current(class, number) if is_counter32(class, number) => {
            (AccessKind::Pair, class, number)
        }
        Target::Current(class, number) => (AccessKind::Word, class, number),
        Target::Pair(class, number) => (AccessKind::Pair, class, number),
        Target::Nibbles(digits, class, number) => {
            let wide = digits > 4;
            (AccessKind::Nibbles { digits, wide }, class, number)
        }
        Target::Float(..)
        | Target::Text(..)
        | Target::Pulses(_)
        | Target::Frequency(_)
        | Target::Channel(_) => return None,
    })
}

fn value(encoder: &mut Encoder, target: Target) -> Bits {
    match access(target) {
        Some((kind, class, number)) => encoder.read_at(kind, class, number),
        None => constant(0, 32),
    }
}

/// Devices as conditions read them: those of a machine, or of one that is elsewhere.
pub trait Devices {
    /// A bit; off if it is not stored.
    fn bit_at(&self, class: Class, number: u32) -> bool;
    /// 16 bits; 0 if they are not stored.
    fn word_at(&self, class: Class, number: u32) -> i16;
    /// The value of a counter with 32 bits.
    fn counter32_at(&self, number: u32) -> Option<i32>;
    /// The PLC's model.
    fn model(&self) -> &'static Model;
}

impl Devices for Machine<'_> {
    fn bit_at(&self, class: Class, number: u32) -> bool {
        self.bit(class, number).unwrap_or(false)
    }

    fn word_at(&self, class: Class, number: u32) -> i16 {
        self.word(class, number).unwrap_or(0)
    }

    fn counter32_at(&self, number: u32) -> Option<i32> {
        self.counter32(number)
    }

    fn model(&self) -> &'static Model {
        self.module().model
    }
}

/// Value of devices; 0 for targets that conditions cannot use.
pub fn read(devices: &impl Devices, target: Target) -> i32 {
    let Some((kind, class, number)) = access(target) else {
        return 0;
    };
    let Some(of) = rt_class(class) else {
        return 0;
    };
    match kind {
        AccessKind::Bit | AccessKind::WordBit(_) => devices.bit_at(of, number).into(),
        AccessKind::Word => devices.word_at(of, number).into(),
        AccessKind::Pair | AccessKind::Float => {
            if let (Class::C, Some(value)) = (of, devices.counter32_at(number)) {
                return value;
            }
            let high = Place::fixed(class, number).high_word(devices.model());
            let high_word = rt_class(high.class).map_or(0, |of| devices.word_at(of, high.number));
            i32::from(high_word) << 16 | i32::from(devices.word_at(of, number) as u16)
        }
        AccessKind::Nibbles { digits, .. } => (0..4 * u32::from(digits)).fold(0, |value, i| {
            value | i32::from(devices.bit_at(of, number + i)) << i
        }),
    }
}

impl Property {
    /// The conditions in it.
    pub fn conditions(&self) -> Vec<&Condition> {
        match self {
            Property::Never(a) | Property::Always(a) | Property::Reachable(a) => vec![a],
            Property::Whenever { when, then, .. } => vec![when, then],
            Property::Stays { holds, until } => vec![holds, until],
        }
    }

    /// Returns true if the event is wanted: a run is then no violation but the answer.
    pub fn is_wanted(&self) -> bool {
        matches!(self, Property::Reachable(_))
    }

    /// Event that must not happen, or is searched for, as logic.
    pub fn encode(&self, encoder: &mut Encoder) -> Lit {
        let bad = match self {
            Property::Never(condition) | Property::Reachable(condition) => {
                condition.encode(encoder)
            }
            Property::Always(condition) => !condition.encode(encoder),
            Property::Whenever {
                when,
                then,
                within_ms,
            } => {
                let (when, then) = (when.encode(encoder), then.encode(encoder));
                late(encoder, when, then, *within_ms)
            }
            Property::Stays { holds, until } => {
                let (holds, until) = (holds.encode(encoder), until.encode(encoder));
                let (memory, before) = encoder.monitor(1, 0);
                let kept = encoder.aig.and(holds, !until);
                encoder.remember(memory, vec![kept]);
                encoder.aig.all([before[0], !holds, !until])
            }
        };
        let running = encoder.running();
        encoder.aig.and(bad, running)
    }
}

/// Bit that is on if the required condition is late: more milliseconds have passed since the trigger.
fn late(encoder: &mut Encoder, when: Lit, then: Lit, within_ms: u32) -> Lit {
    if within_ms == 0 {
        return encoder.aig.and(when, !then);
    }
    let elapsed = encoder.elapsed();
    let width = elapsed
        .len()
        .max((u32::BITS - within_ms.leading_zeros()) as usize)
        + 1;
    let (was_on, before) = encoder.monitor(1, 0);
    encoder.remember(was_on, vec![when]);
    let (waits, waiting) = encoder.monitor(1, 0);
    let (clock, passed) = encoder.monitor(width, 0);
    let elapsed = crate::bits::unsigned(&elapsed, width);
    let aig = &mut encoder.aig;
    let begins = aig.and(when, !before[0]);
    let begins = aig.and(begins, !waiting[0]);
    let passed = aig.add(&passed, &elapsed);
    let most = constant(within_ms.into(), width);
    let over = aig.below(&most, &passed);
    let late = aig.all([waiting[0], over, !then]);
    let still = aig.or(waiting[0], begins);
    let still = aig.and(still, !then);
    // The clock stands where it is too late anyway.
    let held = aig.select(over, &most, &passed);
    let zero = constant(0, width);
    let next = aig.select(waiting[0], &held, &zero);
    encoder.remember(waits, vec![still]);
    encoder.remember(clock, next);
    late
}

/// Follows a property over the scans of a machine.
#[derive(Clone)]
pub struct Watcher<'p> {
    property: &'p Property,
    was_on: bool,
    waited_ms: Option<u64>,
}

impl<'p> Watcher<'p> {
    /// Before the first scan.
    pub fn new(property: &'p Property) -> Self {
        Watcher {
            property,
            was_on: false,
            waited_ms: None,
        }
    }

    /// Returns true if the event has happened in the scan that has just ended, which began `elapsed_ms` after the one
    /// before.
    pub fn happened(&mut self, devices: &impl Devices, elapsed_ms: u32) -> bool {
        match self.property {
            Property::Never(condition) | Property::Reachable(condition) => condition.holds(devices),
            Property::Always(condition) => !condition.holds(devices),
            Property::Whenever {
                when,
                then,
                within_ms,
            } => {
                let (when, then) = (when.holds(devices), then.holds(devices));
                let begins = when && !std::mem::replace(&mut self.was_on, when);
                if *within_ms == 0 {
                    return when && !then;
                }
                let waited = self.waited_ms.map(|ms| ms + u64::from(elapsed_ms));
                let late = waited.is_some_and(|ms| ms > u64::from(*within_ms)) && !then;
                self.waited_ms = waited.or(begins.then_some(0)).filter(|_| !then);
                late
            }
            Property::Stays { holds, until } => {
                let (holds, until) = (holds.holds(devices), until.holds(devices));
                std::mem::replace(&mut self.was_on, holds && !until) && !holds && !until
            }
        }
    }
}
