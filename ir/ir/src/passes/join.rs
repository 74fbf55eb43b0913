//! Neighbouring branches of one condition, which are one branch where nothing in the first changes the condition.
//!
//! A ladder names the condition in each rung. Whoever writes the same in C or Rust names it once, with what depends on
//! it below, and what depends on the opposite as its `else`.

use super::effects::{Reads, Writes, writes};
use crate::node::{Body, Branch, Expr, ExprId, Module, Stmt, TempId};
use crate::walk::{assigned, bodies_mut, operands, operands_mut, statements};

/// Joins branches in all functions.
pub(super) fn run(module: &mut Module) {
    for n in 0..module.functions.len() {
        let body = std::mem::take(&mut module.functions[n].body);
        module.functions[n].body = joined(module, body);
    }
}

#[expect(clippy::wildcard_enum_match_arm, reason = "others are not joined")]
fn joined(module: &Module, body: Body) -> Body {
    let mut out = Body::with_capacity(body.len());
    // The branch that the next one may continue, with only headings of networks after it.
    let mut open: Option<usize> = None;
    for stmt in body {
        match stmt {
            Stmt::Network(_) => out.push(stmt),
            Stmt::If(branch) => {
                let rest = match open {
                    Some(at) => join(module, &mut out, at, branch),
                    None => Some(branch),
                };
                if let Some(branch) = rest {
                    open = Some(out.len());
                    out.push(Stmt::If(branch));
                }
            }
            stmt => {
                open = None;
                out.push(stmt);
            }
        }
    }
    for stmt in &mut out {
        for inner in bodies_mut(stmt) {
            *inner = joined(module, std::mem::take(inner));
        }
    }
    out
}

/// Continues the branch at a position with the next one; else gives that back.
fn join(module: &Module, out: &mut Body, at: usize, next: Branch) -> Option<Branch> {
    let headings = out.split_off(at + 1);
    if let Some(Stmt::If(first)) = out.last_mut()
        && next.otherwise.is_empty()
        && first.otherwise.is_empty()
        && is_lasting(module, first)
    {
        if is_same(module, first.cond, next.cond) {
            first.then.extend(headings);
            first.then.extend(next.then);
            return None;
        }
        if is_opposite(module, first.cond, next.cond) {
            first.otherwise = headings;
            first.otherwise.extend(next.then);
            return None;
        }
    }
    out.extend(headings);
    Some(next)
}

/// Returns true if the condition of a branch is the same after it, whichever way it went.
#[expect(clippy::wildcard_enum_match_arm, reason = "others have no bodies")]
fn is_lasting(module: &Module, branch: &Branch) -> bool {
    let reads = Reads::of(&module.exprs, module.model, branch.cond);
    let mut temps = Vec::new();
    collect_temps(module, branch.cond, &mut temps);
    let mut lasts = true;
    statements(&branch.then, &mut |stmt| {
        let writes = match stmt {
            // What is inside comes, too.
            Stmt::If(_) | Stmt::Parts(_) | Stmt::Repeat(_) | Stmt::Steps(_) | Stmt::For { .. } => {
                Writes::Nothing
            }
            stmt => writes(module.model, &module.exprs, stmt),
        };
        let assigns = assigned(stmt).is_some_and(|temp| temps.contains(&temp));
        let leaves = matches!(stmt, Stmt::Return | Stmt::Goto(_));
        lasts &= !assigns && !leaves && !reads.disturbed_by(writes);
    });
    lasts
}

fn collect_temps(module: &Module, id: ExprId, temps: &mut Vec<TempId>) {
    let expr = module.expr(id);
    if let Expr::Temp(temp) = expr {
        temps.push(*temp);
    }
    for operand in operands(expr) {
        collect_temps(module, operand, temps);
    }
}

fn is_opposite(module: &Module, one: ExprId, other: ExprId) -> bool {
    match (module.expr(one), module.expr(other)) {
        (Expr::Not(inner), _) if is_same(module, *inner, other) => true,
        (_, Expr::Not(inner)) => is_same(module, one, *inner),
        _ => false,
    }
}

/// Returns true if two expressions are the same.
fn is_same(module: &Module, one: ExprId, other: ExprId) -> bool {
    let (mut like, with) = (*module.expr(one), *module.expr(other));
    let mut both = operands(&like).zip(operands(&with));
    let same = both.all(|(a, b)| is_same(module, a, b));
    for (operand, others) in operands_mut(&mut like).zip(operands(&with)) {
        *operand = others;
    }
    same && like == with
}
