//! Bounds of integer expressions that are plain to see.

use crate::measure;
use crate::storage::{Field, Storage};
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, BinOp, Expr, ExprId, Place, Ty};

/// The least and the most that a value is.
pub type Bounds = (i64, i64);

const I16: Bounds = (i16::MIN as i64, i16::MAX as i64);
const I32: Bounds = (i32::MIN as i64, i32::MAX as i64);

/// Depth of operators to which operands are examined.
const DEPTH: u32 = 3;

/// Returns true if these bounds lie within 32 bits.
pub fn fits((low, high): Bounds) -> bool {
    low >= I32.0 && high <= I32.1
}

/// Returns true if an operator's result lies within 32 bits for all values of its operands, so that it needs no
/// wrapping. The divisor of a quotient is not 0.
pub fn is_exact(module: &Module, op: BinOp, a: ExprId, b: ExprId) -> bool {
    let (a, b) = (of(module, a, DEPTH), of(module, b, DEPTH));
    result(op, a, b).is_some_and(fits)
}

/// The array that holds all devices to which the index of a place leads, as its operators show, and the number that is
/// to be added to the index. A range that only the analysis of the whole program shows is not enough: compilers warn of
/// what they cannot see.
pub fn array<'s>(module: &Module, storage: &'s Storage, place: &Place) -> Option<(&'s Field, i64)> {
    let index = place.index?;
    let mut below = Vec::new();
    measure::below(module, index, &mut below);
    let unseen = |e: &ExprId| matches!(module.expr(*e), Expr::Stride(..) | Expr::Within { .. });
    if below.iter().any(unseen) {
        return None;
    }
    let (low, high) = of(module, index, DEPTH);
    let number = i64::from(place.number);
    let first = u32::try_from(number + low).ok()?;
    let last = u32::try_from(number + high).ok()?;
    let field = storage.array(place.class, first, last.checked_sub(first)? + 1)?;
    let plain = !module.model.has_alias(place.class, first, last);
    plain.then(|| (field, number - i64::from(field.first)))
}

/// Bounds of an operator's result, if it has such as these.
fn result(op: BinOp, (a0, a1): Bounds, (b0, b1): Bounds) -> Option<Bounds> {
    match op {
        BinOp::Add => Some((a0 + b0, a1 + b1)),
        BinOp::Sub => Some((a0 - b1, a1 - b0)),
        BinOp::Min => Some((a0.min(b0), a1.min(b1))),
        BinOp::Max => Some((a0.max(b0), a1.max(b1))),
        BinOp::Mul => {
            let ends = [a0 * b0, a0 * b1, a1 * b0, a1 * b1];
            Some((*ends.iter().min()?, *ends.iter().max()?))
        }
        BinOp::Div | BinOp::Rem if b0 > 0 => Some((a0.min(0), a1.max(0))),
        // Only MIN / -1 does not fit.
        BinOp::Div | BinOp::Rem if a0 > I32.0 || b0 > -1 || b1 < -1 => {
            Some((a0.min(-a1), a1.max(-a0)))
        }
        BinOp::Div
        | BinOp::Rem
        | BinOp::MulHigh
        | BinOp::And
        | BinOp::Or
        | BinOp::Xor
        | BinOp::SatAdd
        | BinOp::SatSub
        | BinOp::RotateLeft => None,
    }
}

/// Bounds of an integer expression, looking at most `depth` operators deep.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "others have the bounds of their types"
)]
pub fn of(module: &Module, e: ExprId, depth: u32) -> Bounds {
    let of_type = if module.ty(e) == Ty::I16 { I16 } else { I32 };
    match *module.expr(e) {
        Expr::I16(value) => (value.into(), value.into()),
        Expr::I32(value) => (value.into(), value.into()),
        Expr::Widen(a) => of(module, a, depth),
        Expr::Within { value, low, high } => {
            let (least, most) = of(module, value, depth);
            (least.max(low.into()), most.min(high.into()))
        }
        Expr::BitToInt(_) => (0, 1),
        Expr::Read(access) => match access.kind {
            AccessKind::Nibbles { digits: 1..4, .. } => (0, (1 << access.extent()) - 1),
            AccessKind::Bit
            | AccessKind::WordBit(_)
            | AccessKind::Word
            | AccessKind::Pair
            | AccessKind::Float
            | AccessKind::Nibbles { .. } => of_type,
        },
        Expr::Bin(BinOp::And, _, mask) if matches!(*module.expr(mask), Expr::I32(0..)) => {
            (0, of(module, mask, 0).1)
        }
        Expr::Bin(op @ (BinOp::Add | BinOp::Sub), a, b) if depth > 0 && of_type == I32 => {
            let (a, b) = (of(module, a, depth - 1), of(module, b, depth - 1));
            let bounds = result(op, a, b).filter(|&bounds| fits(bounds));
            bounds.unwrap_or(I32)
        }
        _ => of_type,
    }
}
