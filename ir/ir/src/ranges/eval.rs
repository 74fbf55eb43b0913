//! Values that expressions can have, and the implications of a condition for the words in it.

use super::interval::Interval;
use super::state::{Known, Mask, State, Words, join, temp_bit};
use crate::node::{
    Access, AccessKind, Action, BinOp, Expr, ExprId, Module, Place, Stmt, TempId, Ty,
};
use crate::walk::{operands, statements};
use rungc_rt::CmpOp;

/// Looks at the expressions of a module.
pub(super) struct Eval<'m> {
    pub(super) module: &'m Module,
    pub(super) words: Words,
}

impl Eval<'_> {
    /// Bounds of an integer's value.
    #[expect(clippy::wildcard_enum_match_arm, reason = "nothing is known of others")]
    pub(super) fn value(&self, state: &State, id: ExprId) -> Interval {
        let expr = *self.module.expr(id);
        let all = || Interval::of_type(self.module.ty(id));
        match expr {
            Expr::I16(value) => Interval::of(value.into()),
            Expr::I32(value) => Interval::of(value),
            Expr::Temp(temp) => match state.temp(temp) {
                Some(Known::Value(value)) => value,
                _ => all(),
            },
            Expr::Read(access) => self.read(state, access),
            Expr::Bin(op, a, b) => {
                let (a, b) = (self.value(state, a), self.value(state, b));
                Interval::bin(op, a, b, self.module.ty(id))
            }
            Expr::Complement(a) => {
                let a = self.value(state, a);
                Interval {
                    low: !a.high,
                    high: !a.low,
                }
            }
            Expr::Neg(a) => {
                let (zero, ty) = (Interval::of(0), self.module.ty(id));
                Interval::bin(BinOp::Sub, zero, self.value(state, a), ty)
            }
            Expr::Widen(a) => self.value(state, a),
            Expr::Narrow(a) => {
                let a = self.value(state, a);
                match a.meet(Interval::WORD) {
                    Some(same) if same == a => a,
                    _ => all(),
                }
            }
            Expr::HighWord(a) => {
                let a = self.value(state, a);
                Interval {
                    low: a.low >> 16,
                    high: a.high >> 16,
                }
            }
            Expr::Within { value, low, high } => {
                let value = self.value(state, value);
                value.meet(Interval { low, high }).unwrap_or(value)
            }
            _ => all(),
        }
    }

    fn read(&self, state: &State, access: Access) -> Interval {
        let (place, all) = (access.place, Interval::of_type(access.ty()));
        match access.kind {
            AccessKind::Word => self.word(state, place),
            AccessKind::Pair => {
                let low = self.word(state, place);
                let high = self.word(state, self.words.high_word(place));
                // The high word is the sign of a value that fits into the low one.
                match high.single() {
                    Some(0) if low.low >= 0 => low,
                    Some(-1) if low.high < 0 => low,
                    _ => all,
                }
            }
            AccessKind::Nibbles { digits, wide } if digits < if wide { 8 } else { 4 } => Interval {
                low: 0,
                high: (1 << (4 * digits)) - 1,
            },
            AccessKind::Bit
            | AccessKind::WordBit(_)
            | AccessKind::Float
            | AccessKind::Nibbles { .. } => all,
        }
    }

    fn word(&self, state: &State, place: Place) -> Interval {
        let slot = self.words.slot(place);
        slot.map_or(Interval::WORD, |slot| state.words[slot])
    }

    /// On which tracked words an expression depends, and (bits for) the temporaries.
    pub(super) fn reads(&self, id: ExprId) -> (Mask, u64) {
        let expr = self.module.expr(id);
        let of = |place: Place| self.words.slot(place).map_or(0, |slot| 1 << slot);
        let (mut words, mut temps) = (0, 0);
        if let Expr::Read(Access { place, kind }) = *expr {
            words = match kind {
                AccessKind::Word => of(place),
                AccessKind::Pair => of(place) | of(self.words.high_word(place)),
                AccessKind::Bit
                | AccessKind::WordBit(_)
                | AccessKind::Float
                | AccessKind::Nibbles { .. } => 0,
            };
        } else if let Expr::Temp(temp) = *expr {
            temps = temp_bit(temp);
        }
        for operand in operands(expr) {
            let (more, more_temps) = self.reads(operand);
            words |= more;
            temps |= more_temps;
        }
        (words, temps)
    }

    /// The state where a condition is on (or off); `None` if it cannot be.
    #[expect(clippy::wildcard_enum_match_arm, reason = "others tell nothing")]
    pub(super) fn when(&self, mut state: State, cond: ExprId, on: bool) -> Option<State> {
        match *self.module.expr(cond) {
            Expr::Bit(value) => (value == on).then_some(state),
            Expr::Not(a) => self.when(state, a, !on),
            Expr::And(a, b) if on => self.when(self.when(state, a, true)?, b, true),
            Expr::Or(a, b) if !on => self.when(self.when(state, a, false)?, b, false),
            Expr::And(a, b) | Expr::Or(a, b) => {
                let first = self.when(state.clone(), a, on);
                join(first, self.when(state, b, on))
            }
            Expr::Cmp(op, a, b) if self.module.ty(a) != Ty::F32 => {
                let op = if on { op } else { op.opposite() };
                let limit = self.value(&state, a).that(op, self.value(&state, b))?;
                self.limit(&mut state, a, limit)?;
                let op = op.mirrored();
                let limit = self.value(&state, b).that(op, self.value(&state, a))?;
                self.limit(&mut state, b, limit)?;
                Some(state)
            }
            Expr::Temp(temp) => match state.temp(temp) {
                Some(Known::Condition(cond, ..)) => self.when(state, cond, on),
                _ => Some(state),
            },
            Expr::InRange { place, count, .. } if on => {
                if let Some(index) = place.index {
                    let limit = self.leads_to_devices(place, count)?;
                    let limit = self.value(&state, index).meet(limit)?;
                    self.limit(&mut state, index, limit)?;
                }
                Some(state)
            }
            _ => Some(state),
        }
    }

    /// Between which values an index leads from a place to devices that the model has.
    pub(super) fn leads_to_devices(&self, place: Place, count: u32) -> Option<Interval> {
        let runs = self.module.model.runs(place.class);
        let (first, last) = (runs.first()?.0, runs.last()?.1);
        let last = (i64::from(last) - i64::from(count) + 1) as i32;
        let all = Interval {
            low: first as i32,
            high: last.max(first as i32),
        };
        Some(all.shifted(-i64::from(place.number)))
    }

    /// An expression's value lies there; `None` if it cannot.
    #[expect(clippy::wildcard_enum_match_arm, reason = "others limit nothing")]
    fn limit(&self, state: &mut State, id: ExprId, limit: Interval) -> Option<()> {
        match *self.module.expr(id) {
            Expr::Read(Access {
                place,
                kind: AccessKind::Word,
            }) => {
                if let Some(slot) = self.words.slot(place) {
                    state.words[slot] = state.words[slot].meet(limit)?;
                }
            }
            Expr::Temp(temp) => self.limit_temp(state, temp, limit),
            Expr::Widen(a) | Expr::Within { value: a, .. } => {
                let limit = self.value(state, a).meet(limit)?;
                self.limit(state, a, limit)?;
            }
            Expr::Bin(op @ (BinOp::Add | BinOp::Sub), a, b) => {
                let (of_a, of_b) = (self.value(state, a), self.value(state, b));
                let Some(by) = of_b.single() else {
                    return Some(());
                };
                let by = if op == BinOp::Add {
                    by
                } else {
                    by.saturating_neg()
                };
                let all = Interval::of_type(self.module.ty(id));
                let moved = of_a.shifted(by.into());
                // Nothing is known backwards of a sum that may wrap.
                if moved.meet(all) == Some(moved) {
                    let limit = of_a.meet(limit.shifted(-i64::from(by)))?;
                    self.limit(state, a, limit)?;
                }
            }
            _ => {}
        }
        Some(())
    }

    fn limit_temp(&self, state: &mut State, temp: TempId, limit: Interval) {
        if self.module.temps[temp] != Ty::Bit {
            state.limit_temp(temp, limit);
        }
    }

    /// Constants that tracked words are given, or compared with, and those beside the latter, in order.
    pub(super) fn thresholds(&self) -> Vec<i32> {
        let mut found = vec![-1, 0, 1];
        for function in &self.module.functions {
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(Action::Write(access, value)) = *stmt
                    && access.kind == AccessKind::Word
                    && self.words.slot(access.place).is_some()
                    && let Expr::I16(value) = *self.module.expr(value)
                {
                    found.push(value.into());
                }
            });
        }
        for expr in &self.module.exprs {
            let Expr::Cmp(op, a, b) = *expr else {
                continue;
            };
            if self.module.ty(a) == Ty::F32 || op == CmpOp::Ne {
                continue;
            }
            for (id, other) in [(a, b), (b, a)] {
                let Some(value) = self.module.expr(id).as_int() else {
                    continue;
                };
                let (words, temps) = self.reads(other);
                if (words != 0 || temps != 0) && i16::try_from(value).is_ok() {
                    found.extend([value - 1, value, value + 1]);
                }
            }
        }
        found.sort();
        found.dedup();
        found
    }
}
