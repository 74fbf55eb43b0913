//! The walk that rewrites a module.

use super::effects::writes;
use super::fold::Arena;
use super::inline::{Counts, Temps};
use crate::node::{
    Action, Body, Branch, Expr, ExprId, LabelId, Module, Part, Repeat, Steps, Stmt, TempId,
};
use crate::walk::{assigned, bodies, for_exprs, for_exprs_mut, operands, operands_mut, statements};
use rustc_hash::FxHashSet;
use typed_index_collections::{TiSlice, TiVec};

/// Rewrites every function, with new expressions in `room`; gives the room of the old ones back.
pub(super) fn run(module: &mut Module, room: TiVec<ExprId, Expr>) -> TiVec<ExprId, Expr> {
    let counts = count(module);
    let mut functions = std::mem::take(&mut module.functions);
    let mut rewriter = Rewriter {
        old: &module.exprs,
        arena: Arena::new(&module.temps, module.model, room, module.exprs.len()),
        temps: Temps::new(counts),
        gotos: FxHashSet::default(),
    };
    for function in &mut functions {
        let body = std::mem::take(&mut function.body);
        rewriter.gotos.clear();
        rewriter.temps.set_available(Vec::new());
        function.body = rewriter.body(body);
        if function.body.last() == Some(&Stmt::Return) {
            function.body.pop();
        }
    }
    let exprs = rewriter.arena.exprs;
    module.functions = functions;
    std::mem::replace(&mut module.exprs, exprs)
}

/// Returns true if another pass may find something: a temporary that has fewer uses now, or a label that nothing jumps
/// to any more.
pub(super) fn may_gain(module: &Module) -> bool {
    if !module.temps.is_empty() {
        return true;
    }
    let mut parts = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            parts |= matches!(stmt, Stmt::Parts(_));
        });
    }
    parts
}

/// Counts how often each temporary is used and assigned.
fn count(module: &Module) -> Counts {
    let mut counts = Counts {
        uses: vec![0; module.temps.len()].into(),
        assignments: vec![0; module.temps.len()].into(),
    };
    if module.temps.is_empty() {
        return counts;
    }
    for function in &module.functions {
        count_body(module, &function.body, &mut counts);
    }
    counts
}

fn count_body(module: &Module, body: &Body, counts: &mut Counts) {
    for stmt in body {
        if let Some(temp) = assigned(stmt) {
            counts.assignments[temp] += 1;
        }
        for_exprs(stmt, &mut |expr| count_uses(module, *expr, counts));
        for inner in bodies(stmt) {
            count_body(module, inner, counts);
        }
    }
}

fn count_uses(module: &Module, id: ExprId, counts: &mut Counts) {
    let expr = module.expr(id);
    if let &Expr::Temp(temp) = expr {
        counts.uses[temp] += 1;
    }
    for operand in operands(expr) {
        count_uses(module, operand, counts);
    }
}

struct Rewriter<'m> {
    old: &'m TiSlice<ExprId, Expr>,
    arena: Arena<'m>,
    temps: Temps,
    /// Labels that are jumped to, of the code rewritten so far.
    gotos: FxHashSet<LabelId>,
}

impl Rewriter<'_> {
    fn body(&mut self, body: Body) -> Body {
        let mut out = Vec::with_capacity(body.len());
        self.into(body, &mut out);
        let rest = self.temps.all();
        assign(rest, &mut out);
        out
    }

    /// Rewrites statements after those in `out`; deferred ones stay deferred.
    fn into(&mut self, body: Body, out: &mut Body) {
        for stmt in body {
            if ends(out) {
                return;
            }
            self.stmt(stmt, out);
        }
    }

    fn stmt(&mut self, stmt: Stmt, out: &mut Body) {
        match stmt {
            Stmt::Do(Action::Let(temp, value)) => {
                let value = self.expr(value);
                let now = self.temps.assign(&mut self.arena, temp, value);
                if !now.is_empty() && !self.reads_temp(value, temp) {
                    drop_overwritten(temp, out);
                }
                assign(now, out);
            }
            Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }) => self.branch(cond, then, otherwise, out),
            Stmt::For { count, body } => {
                let count = self.expr(count);
                self.settle(out);
                self.temps.set_available(Vec::new());
                let body = self.body(body);
                self.temps.set_available(Vec::new());
                if body.iter().any(|stmt| !matches!(stmt, Stmt::Network(_))) {
                    out.push(Stmt::For { count, body });
                }
            }
            Stmt::Repeat(repeat) => {
                self.settle(out);
                self.temps.set_available(Vec::new());
                let body = self.body(repeat.body);
                self.temps.set_available(Vec::new());
                out.push(Stmt::Repeat(Repeat { body, ..repeat }));
            }
            Stmt::Steps(steps) => {
                self.settle(out);
                self.temps.set_available(Vec::new());
                let body = self.body(steps.body);
                self.temps.set_available(Vec::new());
                out.push(Stmt::Steps(Steps { body, ..steps }));
            }
            Stmt::Parts(parts) => {
                self.settle(out);
                self.parts(parts, out);
            }
            Stmt::Goto(label) => {
                self.gotos.insert(label);
                self.settle(out);
                out.push(stmt);
            }
            mut stmt @ (Stmt::Network(_)
            | Stmt::Do(_)
            | Stmt::CallSub(_)
            | Stmt::Return
            | Stmt::Watch { .. }) => {
                let writes = writes(self.arena.model, self.old, &stmt);
                let shared = self.temps.shared_before(writes);
                assign(shared, out);
                for_exprs_mut(&mut stmt, &mut |id| *id = self.expr(*id));
                let rest = self.temps.before(writes);
                assign(rest, out);
                out.push(stmt);
            }
        }
    }

    fn reads_temp(&self, value: ExprId, temp: TempId) -> bool {
        let expr = self.arena.get(value);
        let mut parts = operands(&expr);
        expr == Expr::Temp(temp) || parts.any(|part| self.reads_temp(part, temp))
    }

    fn settle(&mut self, out: &mut Body) {
        let rest = self.temps.all();
        assign(rest, out);
    }

    fn branch(&mut self, cond: ExprId, then: Body, otherwise: Body, out: &mut Body) {
        let shared = self.temps.before_condition();
        assign(shared, out);
        let mut cond = self.expr(cond);
        if let Expr::Bit(on) = self.arena.get(cond) {
            return self.into(if on { then } else { otherwise }, out);
        }
        self.settle(out);
        let available = self.temps.available();
        let mut then = self.body(then);
        self.temps.set_available(available);
        let mut otherwise = self.body(otherwise);
        self.temps.set_available(Vec::new());
        if then.is_empty() {
            if otherwise.is_empty() {
                return;
            }
            cond = self.arena.not(cond);
            std::mem::swap(&mut then, &mut otherwise);
        }
        if otherwise.is_empty() {
            then = match self.joined(cond, then, out) {
                Some(then) => then,
                None => return,
            };
        }
        out.push(Stmt::If(Branch {
            cond,
            then,
            otherwise,
        }));
    }

    /// Appends a branch to the one before it, if that has the same condition, a temporary's; else gives it back.
    fn joined(&self, cond: ExprId, then: Body, out: &mut Body) -> Option<Body> {
        match out.last_mut() {
            Some(Stmt::If(Branch {
                cond: before,
                then: first,
                otherwise,
            })) if otherwise.is_empty()
                && self
                    .arena
                    .temp(cond)
                    .is_some_and(|temp| self.temps.is_fixed(temp))
                && self.arena.temp(cond) == self.arena.temp(*before)
                && !ends(first) =>
            {
                first.extend(then);
                None
            }
            _ => Some(then),
        }
    }

    fn parts(&mut self, parts: Vec<Part>, out: &mut Body) {
        let rewritten: Vec<Part> = parts
            .into_iter()
            .map(|part| {
                self.temps.set_available(Vec::new());
                Part {
                    body: self.body(part.body),
                    ..part
                }
            })
            .collect();
        self.temps.set_available(Vec::new());
        // A part that nothing jumps to continues the one before it, or cannot be reached.
        let mut kept: Vec<Part> = Vec::with_capacity(rewritten.len());
        for part in rewritten {
            let reached = part.label.is_some_and(|label| self.gotos.contains(&label));
            match kept.last_mut() {
                Some(before) if !reached => {
                    if !ends(&before.body) {
                        before.body.extend(part.body);
                    }
                }
                _ => kept.push(Part {
                    label: part.label.filter(|_| reached),
                    name: part.name.filter(|_| reached),
                    ..part
                }),
            }
        }
        match kept.as_mut_slice() {
            [only] if only.label.is_none() => out.append(&mut only.body),
            _ => out.push(Stmt::Parts(kept)),
        }
    }

    fn expr(&mut self, id: ExprId) -> ExprId {
        let mut expr = self.old[id];
        if let Expr::Temp(temp) = expr {
            return match self.temps.value(temp) {
                Some(value) => value,
                None => self.arena.add(expr),
            };
        }
        for operand in operands_mut(&mut expr) {
            *operand = self.expr(*operand);
        }
        self.arena.add(expr)
    }
}

fn assign(assignments: Vec<(TempId, ExprId)>, out: &mut Body) {
    out.extend(
        assignments
            .into_iter()
            .map(|(t, e)| Stmt::Do(Action::Let(t, e))),
    );
}

/// Returns true if nothing after these statements is executed.
fn ends(body: &Body) -> bool {
    match body.last() {
        Some(Stmt::Return | Stmt::Goto(_)) => true,
        Some(Stmt::If(Branch {
            then, otherwise, ..
        })) => ends(then) && ends(otherwise),
        _ => false,
    }
}

/// Takes back the assignment to `temp` at the end of `out`, which the next one makes useless.
fn drop_overwritten(temp: TempId, out: &mut Body) {
    let trailing = out
        .iter()
        .rev()
        .take_while(|stmt| matches!(stmt, Stmt::Network(_)));
    let at = out.len() - trailing.count();
    if let Some(last) = at.checked_sub(1)
        && matches!(out.get(last), Some(Stmt::Do(Action::Let(before, _))) if *before == temp)
    {
        out.remove(last);
    }
}
