//! Makes expressions in their simplest form.

use crate::node::{BinOp, Expr, ExprId, TempId, Ty};
use crate::walk::operands;
use rungc_models::Model;
use rungc_rt::CmpOp;
use typed_index_collections::{TiSlice, TiVec};

/// An arena of expressions that are simplified as they are added.
pub(super) struct Arena<'m> {
    pub(super) exprs: TiVec<ExprId, Expr>,
    /// How deep each tree is.
    depths: TiVec<ExprId, u8>,
    temps: &'m TiSlice<TempId, Ty>,
    pub(super) model: &'static Model,
}

/// How far [`Arena::same`] looks into two expressions.
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
        match self.get(id) {
            Expr::Temp(temp) => Some(temp),
            _ => None,
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
            Expr::InRange { place, count } => {
                let (low, high) = match place.index.map(|index| self.get(index)) {
                    None => (0, 0),
                    Some(Expr::I32(index)) => (index, index),
                    Some(Expr::Within { low, high, .. }) => (low, high),
                    _ => return self.push(expr),
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
            _ => self.one(expr),
        }
    }

    fn one(&mut self, expr: Expr) -> ExprId {
        let get = |id: ExprId| self.get(id);
        let simple = match expr {
            Expr::Widen(a) => match get(a) {
                Expr::I16(value) => Expr::I32(i32::from(value)),
                _ => expr,
            },
            Expr::Within { value, .. } => match get(value) {
                Expr::I32(_) => return value,
                _ => expr,
            },
            Expr::Narrow(a) => match get(a) {
                Expr::I32(value) => Expr::I16(value as i16),
                Expr::Widen(inner) => return inner,
                _ => expr,
            },
            Expr::HighWord(a) => match get(a) {
                Expr::I32(value) => Expr::I16((value >> 16) as i16),
                _ => expr,
            },
            Expr::BitToInt(a) => match get(a) {
                Expr::Bit(value) => Expr::I16(i16::from(value)),
                _ => expr,
            },
            Expr::Complement(a) => match get(a) {
                Expr::I16(value) => Expr::I16(!value),
                Expr::I32(value) => Expr::I32(!value),
                Expr::Complement(inner) => return inner,
                _ => expr,
            },
            Expr::Neg(a) => match get(a) {
                Expr::I16(value) => Expr::I16(value.wrapping_neg()),
                Expr::I32(value) => Expr::I32(value.wrapping_neg()),
                Expr::Neg(inner) => return inner,
                _ => expr,
            },
            _ => expr,
        };
        self.push(simple)
    }

    pub(super) fn not(&mut self, a: ExprId) -> ExprId {
        match self.get(a) {
            Expr::Bit(value) => self.push(Expr::Bit(!value)),
            Expr::Not(inner) => inner,
            // A comparison of floats with NaN is false both ways.
            Expr::Cmp(op, x, y) if self.ty(x) != Ty::F32 => {
                self.push(Expr::Cmp(op.opposite(), x, y))
            }
            _ => self.push(Expr::Not(a)),
        }
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

    /// Whether two expressions, evaluated at the same moment, surely have one value.
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

/// What every value compares to a constant at the end of its type's range, if that is always the same.
fn at_border(op: CmpOp, constant: Expr) -> Option<bool> {
    let (lowest, highest) = match constant {
        Expr::I16(v) => (v == i16::MIN, v == i16::MAX),
        Expr::I32(v) => (v == i32::MIN, v == i32::MAX),
        _ => (false, false),
    };
    match op {
        CmpOp::Ge if lowest => Some(true),
        CmpOp::Lt if lowest => Some(false),
        CmpOp::Le if highest => Some(true),
        CmpOp::Gt if highest => Some(false),
        _ => None,
    }
}
