//! Making the body of a loop of its first iteration.

use crate::node::{
    Access, AccessKind, Action, Body, Branch, Counter16Coil, Edge, Expr, ExprId, IndexedCoil,
    Module, Place, Stmt, TempId, TimerCoil, Ty,
};
use crate::walk::{operands, operands_mut};
use rungc_syntax::DeviceClass;

/// The drive of a statement that only sets and resets bits, and what it does to each.
fn sets(module: &Module, stmt: &Stmt) -> Option<(ExprId, Vec<(Access, bool)>)> {
    let Stmt::If(Branch {
        cond,
        then,
        otherwise,
    }) = stmt
    else {
        return None;
    };
    let writes = then.iter().map(|stmt| {
        if let Stmt::Do(Action::Write(access, value)) = *stmt
            && access.kind == AccessKind::Bit
            && let Expr::Bit(on) = *module.expr(value)
        {
            Some((access, on))
        } else {
            None
        }
    });
    let writes: Vec<_> = writes.collect::<Option<_>>()?;
    (otherwise.is_empty() && !writes.is_empty()).then_some((*cond, writes))
}

/// Makes the body of a loop of a first iteration.
pub(super) struct Maker<'m, S> {
    pub(super) module: &'m mut Module,
    pub(super) iteration: TempId,
    /// Distances of the devices from those of the next iteration, in the order in which the iteration names them.
    pub(super) strides: S,
}

impl<S: Iterator<Item = u32>> Maker<'_, S> {
    pub(super) fn body(&mut self, body: &[Stmt]) -> Body {
        let mut out = Body::with_capacity(body.len());
        for stmt in body {
            match sets(self.module, stmt) {
                Some((cond, writes)) => self.sets(cond, writes, &mut out),
                None => out.push(self.stmt(stmt)),
            }
        }
        out
    }

    /// SET and RST as assignments, `M0 := M0 | drive`: compilers do not vectorise what is done on a condition.
    fn sets(&mut self, cond: ExprId, writes: Vec<(Access, bool)>, out: &mut Body) {
        let mut drive = self.expr(cond);
        if writes.len() > 1 {
            let temp = self.module.temps.push_and_get_key(Ty::Bit);
            out.push(Stmt::Do(Action::Let(temp, drive)));
            drive = self.module.add(Expr::Temp(temp));
        }
        for (access, on) in writes {
            let access = self.access(access);
            let before = self.module.add(Expr::Read(access));
            let after = match on {
                true => Expr::Or(before, drive),
                false => {
                    let others = self.module.add(Expr::Not(drive));
                    Expr::And(before, others)
                }
            };
            out.push(Stmt::Do(Action::Write(access, self.module.add(after))));
        }
    }

    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "others have nothing of an iteration, or no shape admits them"
    )]
    fn stmt(&mut self, stmt: &Stmt) -> Stmt {
        match stmt {
            Stmt::Do(action) => Stmt::Do(self.action(action)),
            Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }) => Stmt::If(Branch {
                cond: self.expr(*cond),
                then: self.body(then),
                otherwise: self.body(otherwise),
            }),
            _ => stmt.clone(),
        }
    }

    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "others have nothing of an iteration, or no shape admits them"
    )]
    fn action(&mut self, action: &Action) -> Action {
        match action {
            Action::Let(temp, value) => Action::Let(*temp, self.expr(*value)),
            &Action::Edge(edge) => Action::Edge(Edge {
                index: self.index(),
                input: self.expr(edge.input),
                ..edge
            }),
            Action::Write(access, value) => {
                let access = self.access(*access);
                Action::Write(access, self.expr(*value))
            }
            Action::Timer(coil) => self.timer(*coil),
            Action::Counter16(coil) => self.counter16(*coil),
            Action::Reset { place, holds } => Action::Reset {
                place: self.place(*place),
                holds: *holds,
            },
            _ => action.clone(),
        }
    }

    fn expr(&mut self, id: ExprId) -> ExprId {
        let mut expr = *self.module.expr(id);
        if let Expr::Read(access) = &mut expr {
            *access = self.access(*access);
        } else if operands(&expr).next().is_none() {
            return id;
        } else {
            operands_mut(&mut expr).for_each(|operand| *operand = self.expr(*operand));
        }
        self.module.add(expr)
    }

    /// The coil of a timer. All iterations have one kind of timers, so its number decides it.
    fn timer(&mut self, coil: TimerCoil) -> Action {
        let place = self.place(Place::fixed(DeviceClass::T, coil.number));
        let (drive, preset) = (self.expr(coil.drive), self.expr(coil.preset));
        if place.index.is_some() {
            Action::TimerAt(IndexedCoil {
                place,
                drive,
                preset,
            })
        } else {
            Action::Timer(TimerCoil {
                drive,
                preset,
                ..coil
            })
        }
    }

    fn counter16(&mut self, coil: Counter16Coil) -> Action {
        let place = self.place(Place::fixed(DeviceClass::C, coil.number));
        let (drive, preset) = (self.expr(coil.drive), self.expr(coil.preset));
        if place.index.is_some() {
            Action::Counter16At(IndexedCoil {
                place,
                drive,
                preset,
            })
        } else {
            Action::Counter16(Counter16Coil {
                drive,
                preset,
                ..coil
            })
        }
    }

    fn access(&mut self, access: Access) -> Access {
        let place = self.place(access.place);
        Access { place, ..access }
    }

    fn place(&mut self, place: Place) -> Place {
        let index = self.index();
        Place { index, ..place }
    }

    /// Index from the next device or edge named in the first iteration to that of the present one, if it is another.
    fn index(&mut self) -> Option<ExprId> {
        let stride = self.strides.next().unwrap_or_default();
        (stride > 0).then(|| self.module.add(Expr::Stride(self.iteration, stride)))
    }
}
