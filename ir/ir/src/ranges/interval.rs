//! Sets of integers from one to another, and what operators make of them.

use crate::node::{BinOp, Ty};
use rungc_rt::CmpOp;

/// The integers from `low` to `high`, at least one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Interval {
    pub(crate) low: i32,
    pub(crate) high: i32,
}

impl Interval {
    /// All words.
    pub(crate) const WORD: Interval = Interval {
        low: i16::MIN as i32,
        high: i16::MAX as i32,
    };
    /// All `I32`.
    pub(crate) const LONG: Interval = Interval {
        low: i32::MIN,
        high: i32::MAX,
    };

    /// One number.
    pub(crate) fn of(value: i32) -> Self {
        Interval {
            low: value,
            high: value,
        }
    }

    /// All values of a type; those of a bit are 0 and 1.
    pub(crate) fn of_type(ty: Ty) -> Self {
        match ty {
            Ty::Bit => Interval { low: 0, high: 1 },
            Ty::I16 => Interval::WORD,
            Ty::I32 | Ty::F32 => Interval::LONG,
        }
    }

    /// The numbers between these ends, if they all fit into a type: else all that do, since results wrap.
    fn wrapped(low: i64, high: i64, all: Interval) -> Self {
        match (i32::try_from(low), i32::try_from(high)) {
            (Ok(low), Ok(high)) if low >= all.low && high <= all.high => Interval { low, high },
            _ => all,
        }
    }

    /// The least interval that holds both.
    #[must_use]
    pub(crate) fn join(self, other: Self) -> Self {
        Interval {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Intersection, if it is not empty.
    pub(crate) fn meet(self, other: Self) -> Option<Self> {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        (low <= high).then_some(Interval { low, high })
    }

    /// The one number, if there is only one.
    pub(crate) fn single(self) -> Option<i32> {
        (self.low == self.high).then_some(self.low)
    }

    /// The numbers plus `by`, without regard to a type's ends.
    pub(crate) fn shifted(self, by: i64) -> Self {
        let shift = |end: i32| (i64::from(end) + by).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
        Interval {
            low: shift(self.low),
            high: shift(self.high),
        }
    }

    /// Bounds of the operator's result for operands of a type.
    pub(crate) fn bin(op: BinOp, a: Self, b: Self, ty: Ty) -> Self {
        let all = Interval::of_type(ty);
        let (a0, a1, b0, b1) = (
            i64::from(a.low),
            i64::from(a.high),
            i64::from(b.low),
            i64::from(b.high),
        );
        let corners = |f: fn(i64, i64) -> i64| {
            let ends = [f(a0, b0), f(a0, b1), f(a1, b0), f(a1, b1)];
            let low = ends.iter().copied().min().unwrap_or(a0);
            let high = ends.iter().copied().max().unwrap_or(a1);
            Interval::wrapped(low, high, all)
        };
        let clamped = |low: i64, high: i64| {
            let (from, to) = (i64::from(all.low), i64::from(all.high));
            Interval::wrapped(low.clamp(from, to), high.clamp(from, to), all)
        };
        match op {
            BinOp::Add => Interval::wrapped(a0 + b0, a1 + b1, all),
            BinOp::Sub => Interval::wrapped(a0 - b1, a1 - b0, all),
            BinOp::SatAdd => clamped(a0 + b0, a1 + b1),
            BinOp::SatSub => clamped(a0 - b1, a1 - b0),
            BinOp::Min => Interval::wrapped(a0.min(b0), a1.min(b1), all),
            BinOp::Max => Interval::wrapped(a0.max(b0), a1.max(b1), all),
            BinOp::Mul => corners(|a, b| a * b),
            BinOp::Div if b0 > 0 => corners(|a, b| a / b),
            BinOp::Rem if b0 > 0 => {
                let low = if a0 < 0 { a0.max(1 - b1) } else { 0 };
                let high = if a1 > 0 { a1.min(b1 - 1) } else { 0 };
                Interval::wrapped(low, high, all)
            }
            BinOp::And if b0 >= 0 && a0 >= 0 => Interval::wrapped(0, a1.min(b1), all),
            BinOp::And if b0 >= 0 => Interval::wrapped(0, b1, all),
            BinOp::And if a0 >= 0 => Interval::wrapped(0, a1, all),
            BinOp::Or | BinOp::Xor if a0 >= 0 && b0 >= 0 => {
                let bits = 64 - (a1 | b1).leading_zeros();
                Interval::wrapped(0, (1 << bits) - 1, all)
            }
            BinOp::Div
            | BinOp::Rem
            | BinOp::And
            | BinOp::Or
            | BinOp::Xor
            | BinOp::MulHigh
            | BinOp::RotateLeft => all,
        }
    }

    /// Those of `self` for which `self op b` may hold for a number of `b`; `None` if there are none.
    pub(crate) fn that(self, op: CmpOp, b: Self) -> Option<Self> {
        let low = |low: i64| match i32::try_from(low) {
            Ok(low) => self.meet(Interval {
                low,
                high: i32::MAX,
            }),
            Err(_) => None,
        };
        let high = |high: i64| match i32::try_from(high) {
            Ok(high) => self.meet(Interval {
                low: i32::MIN,
                high,
            }),
            Err(_) => None,
        };
        match op {
            CmpOp::Eq => self.meet(b),
            CmpOp::Ne => match b.single() {
                Some(b) if self == Interval::of(b) => None,
                Some(b) if self.low == b => low(i64::from(b) + 1),
                Some(b) if self.high == b => high(i64::from(b) - 1),
                _ => Some(self),
            },
            CmpOp::Lt => high(i64::from(b.high) - 1),
            CmpOp::Le => high(b.high.into()),
            CmpOp::Gt => low(i64::from(b.low) + 1),
            CmpOp::Ge => low(b.low.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;
    use crate::node::{BinOp, Ty};
    use rungc_rt::CmpOp;

    fn to(low: i32, high: i32) -> Interval {
        Interval { low, high }
    }

    /// Every operator, on all pairs from small intervals around 0 and at the ends of the words.
    #[test]
    fn results_lie_in_their_intervals() {
        let ops = [
            BinOp::Add,
            BinOp::Sub,
            BinOp::Mul,
            BinOp::Div,
            BinOp::Rem,
            BinOp::And,
            BinOp::Or,
            BinOp::Xor,
            BinOp::SatAdd,
            BinOp::SatSub,
            BinOp::Min,
            BinOp::Max,
        ];
        let mut intervals = Vec::new();
        for base in [-32768, -9, -3, 0, 2, 7, 32763] {
            for length in [0, 1, 4] {
                intervals.push(to(base, base + length));
            }
        }
        for op in ops {
            for &a in &intervals {
                for &b in &intervals {
                    let found = Interval::bin(op, a, b, Ty::I16);
                    for x in a.low..=a.high {
                        for y in b.low..=b.high {
                            let Some(value) = op.of_i16(x as i16, y as i16) else {
                                continue;
                            };
                            let inside = found.meet(Interval::of(value.into())).is_some();
                            assert!(inside, "{x} {op:?} {y} = {value}, not in {found:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn comparisons_keep_every_number_of_which_they_hold() {
        let ops = [
            CmpOp::Eq,
            CmpOp::Ne,
            CmpOp::Lt,
            CmpOp::Le,
            CmpOp::Gt,
            CmpOp::Ge,
        ];
        for op in ops {
            for (a, b) in [
                (to(-3, 4), to(0, 2)),
                (to(1, 1), to(1, 1)),
                (to(0, 5), to(5, 9)),
            ] {
                let kept = a.that(op, b);
                for x in a.low..=a.high {
                    for y in b.low..=b.high {
                        assert_eq!(op.holds(x, y), op.mirrored().holds(y, x));
                        assert_ne!(op.holds(x, y), op.opposite().holds(x, y));
                        let is_kept = kept.is_some_and(|kept| kept.meet(Interval::of(x)).is_some());
                        assert!(is_kept || !op.holds(x, y), "{x} {op:?} {y}");
                    }
                }
            }
        }
        assert_eq!(to(0, 9).that(CmpOp::Lt, to(4, 4)), Some(to(0, 3)));
        assert_eq!(to(0, 9).that(CmpOp::Ne, to(0, 0)), Some(to(1, 9)));
        assert_eq!(to(5, 9).that(CmpOp::Lt, to(5, 5)), None);
    }
}
