//! Parts of expressions that get a separate name, because expressions would nest too deep or be written out too often.

use crate::measure::{Sizes, below};
use rungc_ir::Module;
use rungc_ir::node::ExprId;
use rungc_ir::walk::operands;
use rustc_hash::FxHashMap;

/// Limits of an expression written inline.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Largest depth of nesting: readers and compilers have limits.
    pub depth: u32,
    /// From how many operations on a part that occurs several times gets a name.
    pub shared: u64,
    /// In an expression of up to this many operations, no part gets one only because it occurs several times.
    pub plain: u64,
}

/// The parts that get names in a statement that evaluates `roots`, each after those inside it. Evaluating one of them
/// before the statement changes nothing: expressions have no effects.
pub fn named(module: &Module, sizes: &Sizes, roots: &[ExprId], limits: Limits) -> Vec<ExprId> {
    let is_plain =
        |root: ExprId| sizes.depth(root) <= limits.depth && sizes.size(root) <= limits.plain;
    let mut names = Vec::new();
    for &root in roots.iter().filter(|&&root| !is_plain(root)) {
        let mut found = Vec::new();
        below(module, root, &mut found);
        let mut parents: FxHashMap<ExprId, u32> = FxHashMap::default();
        for &e in &found {
            for operand in operands(module.expr(e)) {
                *parents.entry(operand).or_default() += 1;
            }
        }
        let mut depth: FxHashMap<ExprId, u32> = FxHashMap::default();
        for &e in found.iter().filter(|&&e| e != root) {
            let expr = module.expr(e);
            let mut own = 0;
            for operand in operands(expr) {
                let inner = module.expr(operand);
                let same = std::mem::discriminant(expr) == std::mem::discriminant(inner);
                own = own.max(depth.get(&operand).copied().unwrap_or(0) + u32::from(!same));
            }
            let is_shared =
                parents.get(&e).is_some_and(|&n| n > 1) && sizes.size(e) > limits.shared;
            if own < limits.depth && !is_shared {
                depth.insert(e, own);
            } else if !names.contains(&e) {
                names.push(e);
            }
        }
    }
    names
}
