//! Shape of statements that differ in their devices only, as a number to compare them by.

use crate::node::{
    Access, AccessKind, Action, Branch, Counter16Coil, Edge, Expr, ExprId, Module, Place, Stmt,
    TimerCoil,
};
use crate::walk::operands;
use rungc_models::runs::is_counter32;
use rungc_syntax::DeviceClass;
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// Maximum number of operations in a statement of an iteration.
const LARGEST_STATEMENT: u64 = 500;

/// Shape of statements that differ in their devices only.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    hash: u64,
    /// Number of operations.
    pub(super) size: u64,
}

/// The shape of a statement that a loop may have; `None` for any other.
pub(super) fn shape(module: &Module, stmt: &Stmt) -> Option<Shape> {
    let mut hasher = FxHasher::default();
    let mut size = 0;
    add_stmt(module, stmt, &mut hasher, &mut size)?;
    Some(Shape {
        hash: hasher.finish(),
        size,
    })
}

#[expect(clippy::wildcard_enum_match_arm, reason = "others are not compared")]
fn add_stmt(module: &Module, stmt: &Stmt, hasher: &mut FxHasher, size: &mut u64) -> Option<()> {
    std::mem::discriminant(stmt).hash(hasher);
    *size += 1;
    match stmt {
        Stmt::Network(_) => *size -= 1,
        Stmt::Do(action) => add_action(module, action, hasher, size)?,
        Stmt::If(Branch {
            cond,
            then,
            otherwise,
        }) => {
            add_expr(module, *cond, hasher, size)?;
            for body in [then, otherwise] {
                body.len().hash(hasher);
                for stmt in body {
                    add_stmt(module, stmt, hasher, size)?;
                }
            }
        }
        _ => return None,
    }
    Some(())
}

#[expect(clippy::wildcard_enum_match_arm, reason = "others are not compared")]
fn add_action(
    module: &Module,
    action: &Action,
    hasher: &mut FxHasher,
    size: &mut u64,
) -> Option<()> {
    std::mem::discriminant(action).hash(hasher);
    match action {
        Action::Let(_, value) => add_expr(module, *value, hasher, size)?,
        Action::Edge(Edge { input, .. }) => add_expr(module, *input, hasher, size)?,
        Action::Write(access, value) => {
            add_access(*access, hasher)?;
            add_expr(module, *value, hasher, size)?;
        }
        Action::Timer(TimerCoil { drive, preset, .. })
        | Action::Counter16(Counter16Coil { drive, preset, .. }) => {
            add_expr(module, *drive, hasher, size)?;
            add_expr(module, *preset, hasher, size)?;
        }
        Action::Reset { place, holds } => {
            holds.hash(hasher);
            add_place(*place, hasher)?;
        }
        _ => return None,
    }
    Some(())
}

#[expect(clippy::wildcard_enum_match_arm, reason = "others are not compared")]
fn add_expr(module: &Module, id: ExprId, hasher: &mut FxHasher, size: &mut u64) -> Option<()> {
    let expr = module.expr(id);
    std::mem::discriminant(expr).hash(hasher);
    *size += 1;
    if *size > LARGEST_STATEMENT {
        return None;
    }
    match expr {
        Expr::Read(access) => add_access(*access, hasher),
        Expr::Bit(_)
        | Expr::I16(_)
        | Expr::I32(_)
        | Expr::Temp(_)
        | Expr::Sys(_)
        | Expr::Flag(_)
        | Expr::Not(_)
        | Expr::And(..)
        | Expr::Or(..)
        | Expr::Cmp(..)
        | Expr::Bin(..)
        | Expr::Complement(_)
        | Expr::Neg(_)
        | Expr::Widen(_)
        | Expr::Narrow(_)
        | Expr::HighWord(_)
        | Expr::BitToInt(_) => {
            operands(expr).try_for_each(|operand| add_expr(module, operand, hasher, size))
        }
        _ => None,
    }
}

fn add_access(access: Access, hasher: &mut FxHasher) -> Option<()> {
    access.kind.hash(hasher);
    let may = matches!(access.kind, AccessKind::Bit | AccessKind::Word);
    add_place(access.place, hasher).filter(|()| may)
}

fn add_place(place: Place, hasher: &mut FxHasher) -> Option<()> {
    use DeviceClass::{C, D, M, R, S, T, X, Y};
    place.class.hash(hasher);
    let may = matches!(place.class, X | Y | M | S | T | C | D | R);
    let counter32 = is_counter32(place.class, place.number);
    (place.index.is_none() && may && !counter32).then_some(())
}
