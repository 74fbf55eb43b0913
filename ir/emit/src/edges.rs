//! Edges that only the next statement asks for: they are written in it.

use crate::measure;
use crate::plan::{Node, Plan};
use crate::storage::Storage;
use crate::temps::Home;
use rungc_ir::Module;
use rungc_ir::node::{
    AccessKind, Action, Counter16Coil, Counter32Coil, Edge, Expr, ExprId, Stmt, TempId, TimerCoil,
};

/// User of an edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Asker {
    /// An expression that is the edge alone: a condition, a value, a drive.
    Whole(ExprId),
    /// An operand somewhere in a condition or a value.
    Operand(ExprId),
}

/// The part of `next` that uses the edge before it, if nothing else does and `next` evaluates it exactly once.
pub fn user_of_edge(
    module: &Module,
    plan: &Plan,
    storage: &Storage,
    edge: &Edge,
    next: &Node,
) -> Option<Asker> {
    let temp = plan.temp(edge.out);
    if temp.used != 1 || temp.home() == Home::Field {
        return None;
    }
    let is_it = |e: ExprId| *module.expr(e) == Expr::Temp(edge.out);
    match next {
        Node::If { cond: value, .. } => {
            whole(is_it, *value).or_else(|| operand(module, *value, edge.out))
        }
        Node::Stmt(Stmt::Do(Action::Write(access, value))) if access.kind == AccessKind::Bit => {
            let (class, number) = access.device()?;
            storage.find(class, number)?;
            whole(is_it, *value).or_else(|| operand(module, *value, edge.out))
        }
        Node::Stmt(Stmt::Do(
            Action::Timer(TimerCoil { drive, .. })
            | Action::Counter16(Counter16Coil { drive, .. })
            | Action::Counter32(Counter32Coil { drive, .. }),
        )) => whole(is_it, *drive),
        Node::Stmt(_)
        | Node::For { .. }
        | Node::Repeat(_)
        | Node::Steps { .. }
        | Node::Parts { .. }
        | Node::Outlined(_) => None,
    }
}

fn whole(is_it: impl Fn(ExprId) -> bool, value: ExprId) -> Option<Asker> {
    is_it(value).then_some(Asker::Whole(value))
}

fn operand(module: &Module, value: ExprId, temp: TempId) -> Option<Asker> {
    let mut below = Vec::new();
    measure::below(module, value, &mut below);
    let mut found = below.into_iter();
    let found = found.find(|&e| *module.expr(e) == Expr::Temp(temp));
    found.map(Asker::Operand)
}
