//! The expressions and bodies of a statement.

use crate::node::{Arg, Body, ExprId, Stmt};

/// Calls `f` with the bodies inside a statement.
pub(super) fn for_bodies(stmt: &Stmt, f: &mut impl FnMut(&Body)) {
    match stmt {
        Stmt::If {
            then, otherwise, ..
        } => {
            f(then);
            f(otherwise);
        }
        Stmt::For { body, .. } => f(body),
        Stmt::Parts(parts) => parts.iter().for_each(|part| f(&part.body)),
        _ => {}
    }
}

/// A function over the expressions that a statement evaluates, to look at them or to replace them.
macro_rules! for_exprs {
    ($(#[$doc:meta])* $name:ident, $iter:ident $(, $mutable:tt)?) => {
        $(#[$doc])*
        pub(crate) fn $name(stmt: &$($mutable)? Stmt, f: &mut impl FnMut(&$($mutable)? ExprId)) {
            match stmt {
                Stmt::WriteBit(place, value)
                | Stmt::WriteWord(place, value)
                | Stmt::WriteWordBit(place, _, value)
                | Stmt::WritePair(place, value)
                | Stmt::WriteFloat(place, value)
                | Stmt::WriteNibbles { place, value, .. } => {
                    place.index.$iter().for_each(&mut *f);
                    f(value);
                }
                Stmt::Let(_, value) => f(value),
                Stmt::Edge { input, .. } => f(input),
                Stmt::Timer { drive, preset, .. } | Stmt::Counter16 { drive, preset, .. } => {
                    f(drive);
                    f(preset);
                }
                Stmt::Counter32 { drive, down, preset, .. } => {
                    f(drive);
                    f(down);
                    f(preset);
                }
                Stmt::Reset(place) => place.index.$iter().for_each(f),
                Stmt::If { cond, .. } => f(cond),
                Stmt::For { count, .. } => f(count),
                Stmt::Call { args, drive, .. } => {
                    for arg in args {
                        match arg {
                            Arg::Const { index, .. } => index.$iter().for_each(&mut *f),
                            Arg::Device { place, .. }
                            | Arg::Nibbles { place, .. }
                            | Arg::WordBit { place, .. } => place.index.$iter().for_each(&mut *f),
                            Arg::Float(_) | Arg::Text(_) => {}
                        }
                    }
                    drive.$iter().for_each(f);
                }
                Stmt::Network(_)
                | Stmt::CallSub(_)
                | Stmt::Return
                | Stmt::Parts(_)
                | Stmt::Goto(_)
                | Stmt::Fault { .. }
                | Stmt::Stop
                | Stmt::Clear { .. } => {}
            }
        }
    };
}

for_exprs! {
    /// Calls `f` with the expressions that a statement itself evaluates, without those of the bodies inside it.
    for_exprs, iter
}
for_exprs! {
    /// Calls `f` with the expressions that a statement itself evaluates, to replace them.
    for_exprs_mut, iter_mut, mut
}
