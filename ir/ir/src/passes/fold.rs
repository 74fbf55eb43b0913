//! Makes expressions in their simplest form.

use crate::node::{Access, AccessKind, BinOp, Expr, ExprId, Place, TempId, Ty};
use crate::walk::operands;
use rungc_models::Model;
use rungc_models::runs::is_counter32;
use rungc_rt::CmpOp;
use typed_index_collections::{TiSlice, TiVec};

/// An arena of expressions that are simplified as they are added.
pub(super) struct Arena<'m> {
    pub(super) exprs: TiVec<ExprId, Expr>,
    /// Depth of each tree.
    depths: TiVec<ExprId, u8>,
    temps: &'m TiSlice<TempId, Ty>,
    pub(super) model: &'static Model,
}

/// Depth to which [`Arena::same`] compares two expressions.
const SAME_DEPTH: u8 = 3;

impl<'m> Arena<'m> {
    /// An empty one, for about `capacity` expressions, in the room of others.
    pub(super) fn new(
        temps: &'m TiSlice<TempId, Ty>,
        model: &'static Model,
        mut room: TiVec<ExprId, Expr>,
        capacity: usize,
    ) -> Self {
        room.clear();
        room.reserve(capacity);
        Arena {
            exprs: room,
            depths: TiVec::with_capacity(capacity),
            temps,
            model,
        }
    }

    pub(super) fn get(&self, id: ExprId) -> Expr {
        self.exprs[id]
    }

    pub(super) fn depth(&self, id: ExprId) -> u8 {
        self.depths[id]
    }

    pub(super) fn is_constant(&self, id: ExprId) -> bool {
        matches!(
            self.get(id),
            Expr::Bit(_) | Expr::I16(_) | Expr::I32(_) | Expr::F32(_)
        )
    }

    pub(super) fn temp(&self, id: ExprId) -> Option<TempId> {
        if let Expr::Temp(temp) = self.get(id) {
            Some(temp)
        } else {
            None
        }
    }

    fn push(&mut self, expr: Expr) -> ExprId {
        let deepest = operands(&expr)
            .map(|id| self.depth(id).saturating_add(1))
            .max();
        self.depths.push(deepest.unwrap_or(0));
        self.exprs.push_and_get_key(expr)
    }

    /// The simplest expression with this value.
    pub(super) fn add(&mut self, expr: Expr) -> ExprId {
        match expr {
            Expr::Not(a) => self.not(a),
            Expr::And(a, b) => self.join(a, b, true),
            Expr::Or(a, b) => self.join(a, b, false),
            Expr::Cmp(op, a, b) => self.cmp(op, a, b),
            Expr::Bin(op, a, b) => self.bin(op, a, b),
            Expr::Widen(a) => self.widen(a),
            Expr::Narrow(a) => self.narrow(a),
            Expr::HighWord(a) => self.of_long(a, expr, |value| Expr::I16((value >> 16) as i16)),
            Expr::BitToInt(a) => match self.bit(a) {
                Some(value) => self.push(Expr::I16(value.into())),
                None => self.push(expr),
            },
            Expr::Complement(a) => self.complement(a),
            Expr::Neg(a) => self.neg(a),
            Expr::Within { value, low, high } => self.within(value, low, high),
            Expr::InRange {
                place,
                count,
                length: None,
            } => self.in_range(place, count),
            Expr::InRange {
                length: Some(_), ..
            } => self.push(expr),
            Expr::Bit(_)
            | Expr::I16(_)
            | Expr::I32(_)
            | Expr::F32(_)
            | Expr::Temp(_)
            | Expr::Read(_)
            | Expr::Sys(_)
            | Expr::Flag(_)
            | Expr::Cell(_)
            | Expr::Entry(..)
            | Expr::Stride(..)
            | Expr::Un(..)
            | Expr::Float(..) => self.push(expr),
        }
    }

    /// The value of a constant bit.
    fn bit(&self, id: ExprId) -> Option<bool> {
        if let Expr::Bit(value) = self.get(id) {
            Some(value)
        } else {
            None
        }
    }

    /// Folds an `I32`, if it is a constant; else adds the expression of it.
    fn of_long(&mut self, a: ExprId, expr: Expr, folded: impl Fn(i32) -> Expr) -> ExprId {
        if let Expr::I32(value) = self.get(a) {
            self.push(folded(value))
        } else {
            self.push(expr)
        }
    }

    fn widen(&mut self, a: ExprId) -> ExprId {
        if let Expr::I16(value) = self.get(a) {
            self.push(Expr::I32(value.into()))
        } else {
            self.push(Expr::Widen(a))
        }
    }

    fn narrow(&mut self, a: ExprId) -> ExprId {
        if let Expr::Widen(inner) = self.get(a) {
            return inner;
        }
        self.of_long(a, Expr::Narrow(a), |value| Expr::I16(value as i16))
    }

    fn complement(&mut self, a: ExprId) -> ExprId {
        if let Expr::Complement(inner) = self.get(a) {
            inner
        } else if let Expr::I16(value) = self.get(a) {
            self.push(Expr::I16(!value))
        } else {
            self.of_long(a, Expr::Complement(a), |value| Expr::I32(!value))
        }
    }

    fn neg(&mut self, a: ExprId) -> ExprId {
        if let Expr::Neg(inner) = self.get(a) {
            inner
        } else if let Expr::I16(value) = self.get(a) {
            self.push(Expr::I16(value.wrapping_neg()))
        } else {
            self.of_long(a, Expr::Neg(a), |value| Expr::I32(value.wrapping_neg()))
        }
    }

    /// A value in bounds. One that fits into a word needs no other than the low word of its pair.
    fn within(&mut self, value: ExprId, low: i32, high: i32) -> ExprId {
        let is_word = i16::try_from(low).is_ok() && i16::try_from(high).is_ok();
        let expr = self.get(value);
        if expr.as_int().is_some() {
            return value;
        }
        let word = if let Expr::Read(Access { place, kind }) = expr
            && is_word
            && kind == AccessKind::Pair
            && !is_counter32(place.class, place.number)
        {
            let word = self.push(Expr::Read(Access::word(place)));
            self.push(Expr::Widen(word))
        } else {
            value
        };
        self.push(Expr::Within {
            value: word,
            low,
            high,
        })
    }

    fn in_range(&mut self, place: Place, count: u32) -> ExprId {
        let expr = Expr::InRange {
            place,
            count,
            length: None,
        };
        let (low, high) = match place.index.map(|index| self.get(index)) {
            None => (0, 0),
            Some(Expr::I32(index)) => (index, index),
            Some(Expr::Within { low, high, .. }) => (low, high),
            Some(_) => return self.push(expr),
        };
        let first = i64::from(place.number) + i64::from(low);
        let span = u32::try_from(i64::from(high) - i64::from(low)).unwrap_or(u32::MAX);
        let holds = self
            .model
            .in_range(place.class, first, count.saturating_add(span));
        self.push(if holds || low == high {
            Expr::Bit(holds)
        } else {
            expr
        })
    }

    pub(super) fn not(&mut self, a: ExprId) -> ExprId {
        if let Expr::Bit(value) = self.get(a) {
            return self.push(Expr::Bit(!value));
        }
        if let Expr::Not(inner) = self.get(a) {
            return inner;
        }
        // A comparison of floats with NaN is false both ways.
        if let Expr::Cmp(op, x, y) = self.get(a)
            && self.ty(x) != Ty::F32
        {
            return self.push(Expr::Cmp(op.opposite(), x, y));
        }
        self.push(Expr::Not(a))
    }

    /// And (`all`) or or.
    fn join(&mut self, a: ExprId, b: ExprId, all: bool) -> ExprId {
        match (self.get(a), self.get(b)) {
            (Expr::Bit(value), _) => return if value == all { b } else { a },
            (_, Expr::Bit(value)) => return if value == all { a } else { b },
            (Expr::Not(inner), _) if self.same(inner, b, SAME_DEPTH) => {
                return self.push(Expr::Bit(!all));
            }
            (_, Expr::Not(inner)) if self.same(inner, a, SAME_DEPTH) => {
                return self.push(Expr::Bit(!all));
            }
            _ if self.same(a, b, SAME_DEPTH) => return a,
            _ => {}
        }
        self.push(if all { Expr::And(a, b) } else { Expr::Or(a, b) })
    }

    fn cmp(&mut self, op: CmpOp, a: ExprId, b: ExprId) -> ExprId {
        let (x, y) = match (self.get(a), self.get(b)) {
            (Expr::I16(x), Expr::I16(y)) => (i32::from(x), i32::from(y)),
            (Expr::I32(x), Expr::I32(y)) => (x, y),
            _ if self.ty(a) != Ty::F32 && self.same(a, b, SAME_DEPTH) => (0, 0),
            (x, y) => {
                let folded = at_border(op, y).or_else(|| at_border(op.mirrored(), x));
                return self.push(folded.map_or(Expr::Cmp(op, a, b), Expr::Bit));
            }
        };
        self.push(Expr::Bit(op.holds(x, y)))
    }

    fn bin(&mut self, op: BinOp, a: ExprId, b: ExprId) -> ExprId {
        let folded = match (self.get(a), self.get(b)) {
            (Expr::I16(x), Expr::I16(y)) => op.of_i16(x, y).map(Expr::I16),
            (Expr::I32(x), Expr::I32(y)) => op.of_i32(x, y).map(Expr::I32),
            (Expr::I16(0) | Expr::I32(0), _) if op == BinOp::Add => return b,
            (_, Expr::I16(0) | Expr::I32(0)) if matches!(op, BinOp::Add | BinOp::Sub) => return a,
            _ => None,
        };
        self.push(folded.unwrap_or(Expr::Bin(op, a, b)))
    }

    /// Type of an expression.
    pub(super) fn ty(&self, id: ExprId) -> Ty {
        crate::node::type_of(&self.exprs, self.temps, id)
    }

    /// Returns true if two expressions, evaluated at the same moment, are certain to have the same value.
    pub(super) fn same(&self, a: ExprId, b: ExprId, depth: u8) -> bool {
        if a == b {
            return true;
        }
        let Some(depth) = depth.checked_sub(1) else {
            return false;
        };
        let both = |x, y, z, w| self.same(x, z, depth) && self.same(y, w, depth);
        match (self.get(a), self.get(b)) {
            (Expr::And(x, y), Expr::And(z, w)) | (Expr::Or(x, y), Expr::Or(z, w)) => {
                both(x, y, z, w)
            }
            (Expr::Cmp(o, x, y), Expr::Cmp(p, z, w)) => o == p && both(x, y, z, w),
            (Expr::Bin(o, x, y), Expr::Bin(p, z, w)) => o == p && both(x, y, z, w),
            (Expr::Not(x), Expr::Not(y)) | (Expr::Widen(x), Expr::Widen(y)) => {
                self.same(x, y, depth)
            }
            (x, y) => x == y && operands(&x).next().is_none(),
        }
    }
}

/// Result of comparing any value to a constant at the end of its type's range, if it is always the same.
fn at_border(op: CmpOp, constant: Expr) -> Option<bool> {
    let (lowest, highest) = if let Expr::I16(v) = constant {
        (v == i16::MIN, v == i16::MAX)
    } else if let Expr::I32(v) = constant {
        (v == i32::MIN, v == i32::MAX)
    } else {
        (false, false)
    };
    match op {
        CmpOp::Ge => lowest.then_some(true),
        CmpOp::Lt => lowest.then_some(false),
        CmpOp::Le => highest.then_some(true),
        CmpOp::Gt => highest.then_some(false),
        CmpOp::Eq | CmpOp::Ne => None,
    }
}
