//! Properties of a program: conditions over devices after a scan, what is required of them over time, and their
//! values in a run. Test files, replays, searches and proofs all read properties here; `rungc-verify` makes logic of
//! them.

mod eval;
mod parse;
#[cfg(test)]
mod tests;
mod text;
mod token;
mod watch;

pub use parse::{ParseError, parse};
pub use watch::{Deadline, Monitor, Watcher};

use crate::Target;
use rungc_interp::{Machine, rt_class};
use rungc_ir::node::{AccessKind, Place};
use rungc_models::Model;
use rungc_models::runs::is_counter32;
use rungc_rt::{Class, CmpOp, Plc, Program};
use rungc_syntax::DeviceClass;
use std::fmt;

/// A condition over devices, as they are after a scan, and as they were after the scans before.
#[derive(Clone, PartialEq, Debug)]
pub enum Condition {
    /// A constant.
    Constant(bool),
    /// A bit device is on.
    On(Target),
    /// A bit of a word is on: 0 to 15.
    WordBit(Target, u8),
    /// Not.
    Not(Box<Condition>),
    /// Both.
    And(Box<Condition>, Box<Condition>),
    /// At least one.
    Or(Box<Condition>, Box<Condition>),
    /// Both hold, or neither does.
    Same(Box<Condition>, Box<Condition>),
    /// A comparison of numbers, which are signed as in the PLC's comparisons: two integers, or two floats.
    Compare(CmpOp, Number, Number),
    /// As many of several as this hold.
    Count {
        /// At least this many.
        least: u32,
        /// At most this many.
        most: u32,
        /// The conditions.
        of: Vec<Condition>,
    },
    /// It held after the scan before; before the first scan nothing does.
    Was(Box<Condition>),
    /// It holds, and did not after the scan before.
    Rises(Box<Condition>),
    /// It does not hold, and did after the scan before.
    Falls(Box<Condition>),
    /// It holds now and after every scan since one that began this many milliseconds ago, or earlier.
    For(Box<Condition>, u32),
    /// The second does not begin to hold unless the first has held: after the same scan, or after an earlier one since
    /// the second last held.
    Before(Box<Condition>, Box<Condition>),
}

/// A number in a comparison.
#[derive(Clone, PartialEq, Debug)]
pub enum Number {
    /// A constant.
    Constant(i32),
    /// A constant with a decimal point, or beside a float.
    Float(f32),
    /// Value of a device.
    Of(Target),
    /// Value after the scan before; in the first scan the value now.
    Was(Box<Number>),
    /// A result.
    Calc(Box<Calc>),
}

/// An arithmetic operation.
#[derive(Clone, PartialEq, Debug)]
pub struct Calc {
    /// The operation.
    pub op: CalcOp,
    /// Kind of the result, to whose width it wraps; never [`NumberKind::Constant`].
    pub kind: NumberKind,
    /// Left operand.
    pub a: Number,
    /// Right operand.
    pub b: Number,
}

/// Operators of arithmetic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CalcOp {
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// Quotient, of integers truncated towards 0; 0 if the divisor is 0.
    Div,
    /// Remainder with the sign of the dividend, of integers only; 0 if the divisor is 0.
    Rem,
}

impl CalcOp {
    /// As conditions write it.
    pub const fn symbol(self) -> &'static str {
        match self {
            CalcOp::Add => "+",
            CalcOp::Sub => "-",
            CalcOp::Mul => "*",
            CalcOp::Div => "/",
            CalcOp::Rem => "%",
        }
    }
}

/// Kind of a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NumberKind {
    /// An integer of any width.
    Constant,
    /// 16 bits, signed.
    Word,
    /// 32 bits, signed.
    Double,
    /// A float of 32 bits.
    Float,
}

impl NumberKind {
    /// Number of bits of an integer.
    pub const fn width(self) -> u32 {
        match self {
            NumberKind::Word => 16,
            NumberKind::Constant | NumberKind::Double | NumberKind::Float => 32,
        }
    }
}

impl Number {
    /// Its kind.
    pub fn kind(&self) -> NumberKind {
        match self {
            Number::Constant(_) => NumberKind::Constant,
            Number::Float(_) => NumberKind::Float,
            Number::Of(target) => match (access(*target), target) {
                (_, Target::Float(..)) => NumberKind::Float,
                (Some((AccessKind::Pair | AccessKind::Nibbles { wide: true, .. }, ..)), _) => {
                    NumberKind::Double
                }
                _ => NumberKind::Word,
            },
            Number::Was(of) => of.kind(),
            Number::Calc(calc) => calc.kind,
        }
    }

    /// Calls `f` with everything that it looks at.
    pub fn targets(&self, f: &mut impl FnMut(Target)) {
        match self {
            Number::Constant(_) | Number::Float(_) => {}
            Number::Of(target) => f(*target),
            Number::Was(of) => of.targets(f),
            Number::Calc(calc) => {
                calc.a.targets(f);
                calc.b.targets(f);
            }
        }
    }

    /// Number of cells of memory that it needs.
    fn cells(&self) -> usize {
        match self {
            Number::Constant(_) | Number::Float(_) | Number::Of(_) => 0,
            Number::Was(of) => 1 + of.cells(),
            Number::Calc(calc) => calc.a.cells() + calc.b.cells(),
        }
    }
}

/// Value of a device in a report.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Reading {
    /// A bit or an integer.
    Integer(i64),
    /// A float.
    Float(f32),
}

impl From<i64> for Reading {
    fn from(value: i64) -> Self {
        Reading::Integer(value)
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reading::Integer(value) => value.fmt(f),
            Reading::Float(value) => write!(f, "{value:?}"),
        }
    }
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
    /// Once `after` holds, the condition holds after that scan and every later one, until one after which the other
    /// holds. Without `after`, it must keep holding once it holds itself.
    Stays {
        /// Condition from which on it must hold.
        after: Option<Condition>,
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
            Condition::On(target) | Condition::WordBit(target, _) => f(*target),
            Condition::Compare(_, a, b) => {
                a.targets(f);
                b.targets(f);
            }
            _ => self.parts().into_iter().for_each(|part| part.targets(f)),
        }
    }

    /// The conditions that it joins.
    pub fn parts(&self) -> Vec<&Condition> {
        match self {
            Condition::Constant(_)
            | Condition::On(_)
            | Condition::WordBit(..)
            | Condition::Compare(..) => Vec::new(),
            Condition::Not(a)
            | Condition::Was(a)
            | Condition::Rises(a)
            | Condition::Falls(a)
            | Condition::For(a, _) => vec![a],
            Condition::And(a, b)
            | Condition::Or(a, b)
            | Condition::Same(a, b)
            | Condition::Before(a, b) => vec![a, b],
            Condition::Count { of, .. } => of.iter().collect(),
        }
    }

    /// Number of cells of memory that it needs.
    fn cells(&self) -> usize {
        let own = match self {
            Condition::Was(_) | Condition::Rises(_) | Condition::Falls(_) | Condition::For(..) => 1,
            Condition::Before(..) => 2,
            Condition::Compare(_, a, b) => a.cells() + b.cells(),
            _ => 0,
        };
        let parts = self.parts().into_iter().map(Condition::cells);
        own + parts.sum::<usize>()
    }

    /// Returns true if it depends on scans before the last one.
    pub fn has_memory(&self) -> bool {
        self.cells() > 0
    }

    /// Values that it depends on, by devices now: names as in test files, first devices, values.
    pub fn values(&self, devices: &impl Devices) -> Vec<(String, (DeviceClass, u32), Reading)> {
        let mut found = Vec::new();
        self.targets(&mut |target| {
            let (class, first, _) = target.devices(0);
            let value = read(devices, target);
            let value = match target {
                Target::Float(..) => Reading::Float(f32::from_bits(value as u32)),
                _ => Reading::Integer(value.into()),
            };
            let value = (target.to_string(), (class, first), value);
            if !found.contains(&value) {
                found.push(value);
            }
        });
        found
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
        Target::Float(class, number) => (AccessKind::Float, class, number),
        Target::Nibbles(digits, class, number) => {
            let wide = digits > 4;
            (AccessKind::Nibbles { digits, wide }, class, number)
        }
        Target::Text(..) | Target::Pulses(_) | Target::Frequency(_) | Target::Channel(_) => {
            return None;
        }
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

/// Value of devices, of a float its bits; 0 for targets that conditions cannot use.
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
            Property::Stays {
                after,
                holds,
                until,
            } => after.iter().chain([holds, until]).collect(),
        }
    }

    /// Values that it depends on, by devices now, as [`Condition::values`]; each once.
    pub fn values(&self, devices: &impl Devices) -> Vec<(String, (DeviceClass, u32), Reading)> {
        let mut found = Vec::new();
        for value in self
            .conditions()
            .into_iter()
            .flat_map(|of| of.values(devices))
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
