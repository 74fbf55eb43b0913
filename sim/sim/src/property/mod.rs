//! Properties of a program: conditions over devices after a scan, what is required of them over time, and their
//! values in a run. Test files, replays, searches and proofs all read properties here; `rungc-verify` makes logic of
//! them.

mod parse;
mod watch;

pub use parse::{ParseError, parse};
pub use watch::{Deadline, Watcher};

use crate::Target;
use rungc_interp::{Machine, rt_class};
use rungc_ir::node::{AccessKind, Place};
use rungc_models::Model;
use rungc_models::runs::is_counter32;
use rungc_rt::{Class, CmpOp, Plc, Program};
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
    /// Both are on, or both off.
    Same(Box<Condition>, Box<Condition>),
    /// A comparison of numbers, which are signed as in the PLC's comparisons.
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
    /// The devices that it looks at.
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
            Condition::And(a, b) | Condition::Or(a, b) | Condition::Same(a, b) => {
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

    /// Returns true if it holds for the devices now.
    pub fn holds(&self, devices: &impl Devices) -> bool {
        match self {
            Condition::Constant(on) => *on,
            Condition::On(target) => read(devices, *target) != 0,
            Condition::Not(a) => !a.holds(devices),
            Condition::And(a, b) => a.holds(devices) && b.holds(devices),
            Condition::Or(a, b) => a.holds(devices) || b.holds(devices),
            Condition::Same(a, b) => a.holds(devices) == b.holds(devices),
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
pub fn access(target: Target) -> Option<(AccessKind, DeviceClass, u32)> {
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

/// Devices as conditions read them: those of a machine, or of one that is elsewhere.
pub trait Devices {
    /// A bit; off if it is not stored. An output is its terminal: pulses show there, and M8034 switches it off.
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
        match class {
            Class::Y => self.output(number),
            _ => self.bit(class, number).unwrap_or(false),
        }
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
        AccessKind::Nibbles { digits, .. } => {
            let bits = 0..4 * u32::from(digits);
            let value = bits.fold(0, |value, i| {
                value | i32::from(devices.bit_at(of, number + i)) << i
            });
            // Sixteen bits are a signed word.
            if digits == 4 {
                (value as i16).into()
            } else {
                value
            }
        }
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

    /// Values that it depends on, on a machine now, as [`Condition::values`]; each once.
    pub fn values(&self, machine: &Machine) -> Vec<(String, (DeviceClass, u32), i64)> {
        let mut found = Vec::new();
        for value in self
            .conditions()
            .into_iter()
            .flat_map(|of| of.values(machine))
        {
            if !found.contains(&value) {
                found.push(value);
            }
        }
        found
    }

    /// Returns true if the event is wanted: a run is then no violation but the answer.
    pub fn is_wanted(&self) -> bool {
        matches!(self, Property::Reachable(_))
    }
}
