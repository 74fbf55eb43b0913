//! Comparing two iterations, statement by statement.

use crate::node::{Access, Action, Branch, Expr, ExprId, Module, Place, Stmt, TempId};
use crate::walk::{operands, operands_mut};
use rungc_syntax::DeviceClass;
use std::collections::HashMap;

/// Device or edge that an iteration names, and the distance to the number in the next iteration.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Named {
    pub(super) kind: Kind,
    pub(super) number: u32,
    pub(super) stride: u32,
}

/// Kind of item that can differ between iterations.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Device(DeviceClass),
    /// The memory of an edge.
    Edge,
}

/// Two iterations side by side.
pub(super) struct Pair<'m> {
    module: &'m Module,
    /// Temporaries of the first iteration, and what they are in the other.
    temps: HashMap<TempId, TempId>,
    /// Devices and edges that both name.
    named: Vec<Named>,
}

impl<'m> Pair<'m> {
    /// Devices and edges that two iterations name, in order, with the distances to the numbers of the other one; `None`
    /// if the iterations differ otherwise.
    pub(super) fn of(module: &'m Module, one: &[Stmt], other: &[Stmt]) -> Option<Vec<Named>> {
        let mut pair = Pair {
            module,
            temps: HashMap::new(),
            named: Vec::new(),
        };
        pair.body(one, other)?;
        Some(pair.named)
    }

    fn body(&mut self, one: &[Stmt], other: &[Stmt]) -> Option<()> {
        if one.len() != other.len() {
            return None;
        }
        let mut both = one.iter().zip(other);
        both.try_for_each(|(one, other)| self.stmt(one, other))
    }

    fn stmt(&mut self, one: &Stmt, other: &Stmt) -> Option<()> {
        match (one, other) {
            (Stmt::Network(_), Stmt::Network(_)) => Some(()),
            (&Stmt::Do(Action::Let(temp, value)), &Stmt::Do(Action::Let(with, other))) => {
                self.expr(value, other)?;
                self.temps.insert(temp, with);
                Some(())
            }
            (Stmt::Do(Action::Edge(edge)), Stmt::Do(Action::Edge(with))) => {
                (edge.kind == with.kind).then_some(())?;
                self.named(Kind::Edge, edge.memory.0, with.memory.0)?;
                self.expr(edge.input, with.input)?;
                self.temps.insert(edge.out, with.out);
                Some(())
            }
            (&Stmt::Do(Action::Write(access, value)), &Stmt::Do(Action::Write(to, other))) => {
                self.access(access, to)?;
                self.expr(value, other)
            }
            (Stmt::Do(Action::Timer(coil)), Stmt::Do(Action::Timer(with))) => {
                // A shared timer is driven in several places, which repeated rungs seldom do.
                (coil.kind == with.kind && !coil.kind.shared).then_some(())?;
                self.named(Kind::Device(DeviceClass::T), coil.number, with.number)?;
                self.expr(coil.drive, with.drive)?;
                self.expr(coil.preset, with.preset)
            }
            (Stmt::Do(Action::Counter16(coil)), Stmt::Do(Action::Counter16(with))) => {
                self.named(Kind::Device(DeviceClass::C), coil.number, with.number)?;
                self.expr(coil.drive, with.drive)?;
                self.expr(coil.preset, with.preset)
            }
            (
                &Stmt::Do(Action::Reset { place, holds }),
                &Stmt::Do(Action::Reset {
                    place: with,
                    holds: other,
                }),
            ) => {
                (holds == other).then_some(())?;
                self.place(place, with)
            }
            (
                Stmt::If(Branch {
                    cond,
                    then,
                    otherwise,
                }),
                Stmt::If(Branch {
                    cond: other_cond,
                    then: other_then,
                    otherwise: other_otherwise,
                }),
            ) => {
                self.expr(*cond, *other_cond)?;
                self.body(then, other_then)?;
                self.body(otherwise, other_otherwise)
            }
            _ => None,
        }
    }

    fn expr(&mut self, one: ExprId, other: ExprId) -> Option<()> {
        match (*self.module.expr(one), *self.module.expr(other)) {
            (Expr::Read(access), Expr::Read(with)) => self.access(access, with),
            (Expr::Temp(temp), Expr::Temp(with)) => {
                (self.temps.get(&temp).copied().unwrap_or(temp) == with).then_some(())
            }
            (one, other) => {
                // They are alike if they are the same with the same operands, and these are alike.
                let mut like_other = one;
                for (operand, others) in operands_mut(&mut like_other).zip(operands(&other)) {
                    *operand = others;
                }
                let mut both = operands(&one).zip(operands(&other));
                (like_other == other).then_some(())?;
                both.try_for_each(|(a, b)| self.expr(a, b))
            }
        }
    }

    fn access(&mut self, one: Access, other: Access) -> Option<()> {
        (one.kind == other.kind).then_some(())?;
        self.place(one.place, other.place)
    }

    fn place(&mut self, one: Place, other: Place) -> Option<()> {
        let same = one.class == other.class && one.index.is_none() && other.index.is_none();
        same.then_some(())?;
        self.named(Kind::Device(one.class), one.number, other.number)
    }

    fn named(&mut self, kind: Kind, number: u32, other: u32) -> Option<()> {
        let stride = other.checked_sub(number)?;
        self.named.push(Named {
            kind,
            number,
            stride,
        });
        Some(())
    }
}
