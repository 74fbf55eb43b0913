//! Rewriting of conditions for readability.

use rungc_ir::Module;
use rungc_ir::node::{Expr, ExprId, Ty};
use rungc_ir::walk::{operands, operands_mut};
use rungc_rt::CmpOp;

/// A comparison with a constant on the right, wherever the program has it.
pub fn comparison(module: &Module, op: CmpOp, a: ExprId, b: ExprId) -> (CmpOp, ExprId, ExprId) {
    let is_constant = |e: ExprId| {
        let expr = module.expr(e);
        matches!(expr, Expr::I16(_) | Expr::I32(_) | Expr::F32(_))
    };
    if is_constant(a) && !is_constant(b) {
        (op.mirrored(), b, a)
    } else {
        (op, a, b)
    }
}

/// The comparison that is the opposite of an expression, if that is a comparison of integers. With floats, not (a < b)
/// is not a >= b, for NaN.
pub fn opposite(module: &Module, e: ExprId) -> Option<(CmpOp, ExprId, ExprId)> {
    let Expr::Cmp(op, a, b) = *module.expr(e) else {
        return None;
    };
    (module.ty(a) != Ty::F32).then(|| (op.opposite(), a, b))
}

/// Returns true if a bit is made of bits that are numbers, 0 or 1, as those of grids are. `known` decides for
/// expressions that a backend has named or placed; it is called first, for each operand.
pub fn is_number(module: &Module, e: ExprId, known: &dyn Fn(ExprId) -> Option<bool>) -> bool {
    known(e).unwrap_or_else(|| {
        let expr = module.expr(e);
        let made_of_bits = matches!(expr, Expr::Not(_) | Expr::And(..) | Expr::Or(..));
        made_of_bits && operands(expr).any(|operand| is_number(module, operand, known))
    })
}

/// Returns true if two expressions are identical, so that they have the same value where they are side by side.
pub fn same(module: &Module, a: ExprId, b: ExprId) -> bool {
    let shell = |e: ExprId| {
        let mut expr = *module.expr(e);
        operands_mut(&mut expr).for_each(|operand| *operand = ExprId(0));
        expr
    };
    let operands = |e: ExprId| operands(module.expr(e));
    a == b
        || shell(a) == shell(b)
            && operands(a)
                .zip(operands(b))
                .all(|(a, b)| same(module, a, b))
}
