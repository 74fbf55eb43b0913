//! Conditions as they are written.

use super::{Condition, Number};
use rungc_rt::CmpOp;
use std::fmt;

/// What may stand in a place without parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    /// Anything.
    Any,
    /// No order and no duration.
    Or,
    /// No `|` either.
    And,
    /// One condition.
    Single,
    /// One word, or something in parentheses.
    Atom,
}

impl Condition {
    fn level(&self) -> Level {
        match self {
            Condition::Before(..) | Condition::For(..) => Level::Any,
            Condition::Or(..) => Level::Or,
            Condition::And(..) => Level::And,
            Condition::Not(_) | Condition::Same(..) | Condition::Compare(..) => Level::Single,
            Condition::Constant(_)
            | Condition::On(_)
            | Condition::WordBit(..)
            | Condition::Count { .. }
            | Condition::Was(_)
            | Condition::Rises(_)
            | Condition::Falls(_) => Level::Atom,
        }
    }
}

/// A condition in a place.
struct In<'c>(Level, &'c Condition);

impl fmt::Display for In<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let In(level, condition) = self;
        match condition.level() >= *level {
            true => condition.fmt(f),
            false => write!(f, "({condition})"),
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Condition::Constant(on) => write!(f, "{}", u8::from(*on)),
            Condition::On(target) => target.fmt(f),
            Condition::WordBit(word, bit) => write!(f, "{word}.{bit:X}"),
            Condition::Not(a) => write!(f, "!{}", In(Level::Atom, a)),
            Condition::And(a, b) => write!(f, "{} & {}", In(Level::And, a), In(Level::Single, b)),
            Condition::Or(a, b) => write!(f, "{} | {}", In(Level::Or, a), In(Level::And, b)),
            Condition::Same(a, b) => write!(f, "{} = {}", In(Level::Atom, a), In(Level::Atom, b)),
            Condition::Compare(op, a, b) => {
                let sign = match op {
                    CmpOp::Eq => "=",
                    other => other.symbol(),
                };
                write!(f, "{a} {sign} {b}")
            }
            Condition::Count { least, most, of } => {
                let all = of.len() as u32;
                match (*least, *most) {
                    (least, most) if least == most => write!(f, "exactly {least} of (")?,
                    (least, most) if most == all => write!(f, "at least {least} of (")?,
                    (_, most) => write!(f, "at most {most} of (")?,
                }
                for (i, a) in of.iter().enumerate() {
                    let comma = if i == 0 { "" } else { ", " };
                    write!(f, "{comma}{a}")?;
                }
                f.write_str(")")
            }
            Condition::Was(a) => write!(f, "was({a})"),
            Condition::Rises(a) => write!(f, "rises({a})"),
            Condition::Falls(a) => write!(f, "falls({a})"),
            Condition::For(a, ms) => write!(f, "{} for {ms}ms", In(Level::Atom, a)),
            Condition::Before(a, b) => {
                write!(f, "{} before {}", In(Level::Or, a), In(Level::Or, b))
            }
        }
    }
}

/// A number as an operand of arithmetic.
struct Operand<'n>(&'n Number);

impl fmt::Display for Operand<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Number::Calc(_) => write!(f, "({})", self.0),
            other => other.fmt(f),
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Number::Constant(value) => value.fmt(f),
            Number::Float(value) => write!(f, "{value:?}"),
            Number::Of(target) => target.fmt(f),
            Number::Was(of) => write!(f, "was({of})"),
            Number::Calc(calc) => {
                let (a, sign, b) = (Operand(&calc.a), calc.op.symbol(), Operand(&calc.b));
                write!(f, "{a} {sign} {b}")
            }
        }
    }
}
