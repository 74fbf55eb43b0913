//! Sizes of expressions, and what is below them.

use rungc_ir::Module;
use rungc_ir::node::{Expr, ExprId, TempId};
use rungc_ir::walk::operands;
use typed_index_collections::TiVec;

/// Size and depth of every expression as it is written out.
pub struct Sizes {
    size: TiVec<ExprId, u32>,
    depth: TiVec<ExprId, u32>,
}

/// From which size on a shared operand may make the written expression much larger than what is stored.
const LARGE: u32 = 256;

impl Sizes {
    /// Measures them all.
    pub fn new(module: &Module) -> Self {
        let mut sizes = Sizes {
            size: TiVec::with_capacity(module.exprs.len()),
            depth: TiVec::with_capacity(module.exprs.len()),
        };
        for expr in &module.exprs {
            let (mut size, mut depth) = (1u32, 0);
            for e in operands(expr) {
                size = size.saturating_add(sizes.size[e]);
                // Chains of one operator are written side by side.
                let same = std::mem::discriminant(expr) == std::mem::discriminant(module.expr(e));
                let chain = same && matches!(expr, Expr::And(..) | Expr::Or(..));
                depth = depth.max(sizes.depth[e] + u32::from(!chain));
            }
            sizes.size.push(size);
            sizes.depth.push(depth);
        }
        sizes
    }

    /// Number of operations.
    pub fn size(&self, e: ExprId) -> u64 {
        self.size[e].into()
    }

    /// Depth of nesting.
    pub fn depth(&self, e: ExprId) -> u32 {
        self.depth[e]
    }

    /// Returns true if it is large enough that sharing inside matters.
    pub(crate) fn is_large(&self, e: ExprId) -> bool {
        self.size[e] > LARGE
    }
}

/// All expressions below `expr`, itself included, each once, in ascending order, into `found`.
pub fn below(module: &Module, expr: ExprId, found: &mut Vec<ExprId>) {
    found.clear();
    let mut seen = std::collections::HashSet::new();
    let mut todo = vec![expr];
    while let Some(e) = todo.pop() {
        if seen.insert(e) {
            found.push(e);
            todo.extend(operands(module.expr(e)));
        }
    }
    found.sort();
}

/// Calls `f` with each temporary that an expression uses: once for each use, but in a large expression once for each
/// node.
pub fn temps(
    module: &Module,
    sizes: &Sizes,
    expr: ExprId,
    buffer: &mut Vec<ExprId>,
    mut f: impl FnMut(TempId),
) {
    if sizes.is_large(expr) {
        below(module, expr, buffer);
        for &e in buffer.iter() {
            if let Expr::Temp(temp) = *module.expr(e) {
                f(temp);
            }
        }
        return;
    }
    buffer.clear();
    buffer.push(expr);
    while let Some(e) = buffer.pop() {
        if let Expr::Temp(temp) = *module.expr(e) {
            f(temp);
        }
        buffer.extend(operands(module.expr(e)));
    }
}
