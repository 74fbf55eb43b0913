//! Statements: assignments, branches and loops.

use crate::Outcome;
use crate::ast::{Arm, Body, Expr, ExprKind, For, Label, Op, Stmt, StmtKind};
use crate::conditions::{Cond, Join};
use crate::emit::{Compiler, Made, both, fail};
use crate::fold;
use crate::literal::Const;
use crate::types::Ty;
use crate::values::constant_operand;
use rungc_syntax::{Device, Operand, OperandKind, Span, codes, phrase};
use std::rc::Rc;

/// Characters of a statement that stand above its rung.
const HEADING: usize = 72;

impl Compiler<'_> {
    /// Compiles statements. What is wrong in one keeps no other from being compiled.
    pub(crate) fn body(&mut self, body: &Body) {
        let mut left: Option<Span> = None;
        let free = self.supply.clone();
        for stmt in body {
            if let Some(by) = left.take() {
                let warning = codes::ST_UNREACHABLE.at(stmt.span, "this is never run");
                self.found.push(
                    warning
                        .label("never run")
                        .other(by, "this leaves before it"),
                );
            }
            if matches!(stmt.kind, StmtKind::Exit | StmtKind::Return) {
                left = Some(stmt.span);
            }
            self.span = head(stmt);
            self.heading = self.shown(self.span);
            let at = self.statements.len();
            self.statements.push(Outcome {
                span: self.span,
                is_compiled: false,
            });
            self.supply.release(&free);
            let before = self.instrs.len();
            match self.statement(stmt) {
                Ok(()) => self.statements[at].is_compiled = stmt.kind != StmtKind::Unread,
                Err(errors) => {
                    self.found.extend(errors);
                    // Half a statement is worth nothing.
                    self.instrs.truncate(before);
                    self.is_powered = false;
                }
            }
        }
        self.heading = None;
    }

    /// The text of a statement for the ladder, on one line.
    fn shown(&self, span: Span) -> Option<smol_str::SmolStr> {
        let text = self.text.get(span.range())?;
        let mut line = String::new();
        for word in text.split_whitespace() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
            if line.chars().count() > HEADING {
                let cut: String = line.chars().take(HEADING).collect();
                return Some(format!("{cut}…").into());
            }
        }
        (!line.is_empty()).then(|| line.into())
    }

    fn statement(&mut self, stmt: &Stmt) -> Made<()> {
        match &stmt.kind {
            StmtKind::Assign(target, value) => self.assign(target, value),
            StmtKind::Call(call) => self.call(call),
            StmtKind::If(arms, otherwise, _) => {
                self.warn_constant(arms, otherwise.as_ref());
                self.branch(arms, otherwise.as_ref(), None)
            }
            StmtKind::Case(of, arms, otherwise, _) => self.case(of, arms, otherwise.as_ref()),
            StmtKind::For(for_) => self.count(for_),
            StmtKind::While(when, body, _) => self.while_(when, body),
            StmtKind::Repeat(body, until, _) => self.repeat(body, until),
            StmtKind::Exit => match self.loops.last() {
                Some(end) => {
                    self.goto(*end);
                    Ok(())
                }
                None => fail(codes::ST_NO_LOOP.at(stmt.span, "EXIT stands in no loop")),
            },
            StmtKind::Return => {
                let end = match self.end {
                    Some(end) => end,
                    None => self.pointer()?,
                };
                self.end = Some(end);
                self.goto(end);
                Ok(())
            }
            StmtKind::Empty | StmtKind::Unread => Ok(()),
        }
    }

    /// Warns of alternatives that are never run, or never left out.
    fn warn_constant(&mut self, arms: &[Arm<Expr>], otherwise: Option<&Body>) {
        for (at, arm) in arms.iter().enumerate() {
            let Some((Const::Bool(is_on), _)) = fold::constant(&self.labels, &arm.when) else {
                continue;
            };
            let dead = match is_on {
                false => arm.body.first(),
                true => {
                    let next = arms.get(at + 1).and_then(|arm| arm.body.first());
                    next.or_else(|| otherwise.and_then(|body| body.first()))
                }
            };
            if let Some(dead) = dead {
                let warning = codes::ST_UNREACHABLE.at(dead.span, "this is never run");
                let always = if is_on {
                    "this is always true"
                } else {
                    "this is never true"
                };
                self.found
                    .push(warning.label("never run").other(arm.when.span, always));
            }
        }
    }

    /// Warns of a loop that is never run.
    fn warn_never(&mut self, when: &Expr, body: &Body) {
        let constant = fold::constant(&self.labels, when);
        if let (Some((Const::Bool(false), _)), Some(first)) = (constant, body.first()) {
            let warning = codes::ST_UNREACHABLE.at(first.span, "this is never run");
            let warning = warning.label("never run");
            self.found
                .push(warning.other(when.span, "this is never true"));
        }
    }

    /// Jumps where a condition does not hold.
    fn jump_unless(&mut self, cond: &Cond, is_equality: bool, span: Span, to: Device) -> Made<()> {
        if cond.is_single() || is_equality {
            self.load(&cond.opposite_of_equality(is_equality));
        } else {
            self.load(cond);
            let bit = self.in_bit(span)?;
            self.load(&bit.opposite());
        }
        self.jump(to);
        Ok(())
    }

    /// IF, and ELSIF as an IF in the ELSE of the one before, with the same end.
    fn branch(
        &mut self,
        arms: &[Arm<Expr>],
        otherwise: Option<&Body>,
        end: Option<Device>,
    ) -> Made<()> {
        let Some((first, rest)) = arms.split_first() else {
            if let Some(body) = otherwise {
                self.body(body);
            }
            return Ok(());
        };
        self.span = first.span;
        let cond = self.condition(&first.when);
        let cond = match cond {
            Ok(cond) => cond,
            Err(errors) => {
                // The statements inside are examined nevertheless.
                self.found.extend(errors);
                self.body(&first.body);
                return self.branch(rest, otherwise, end);
            }
        };
        if rest.is_empty() && otherwise.is_none() {
            let after = match end {
                Some(end) => end,
                None => self.pointer()?,
            };
            let is_equality = self.is_equality(&first.when);
            self.jump_unless(&cond, is_equality, first.when.span, after)?;
            self.body(&first.body);
            if end.is_none() {
                self.span = first.span;
                self.label(after);
            }
            return Ok(());
        }
        let then = self.pointer()?;
        self.load(&cond);
        self.jump(then);
        let after = match end {
            Some(end) => end,
            None => self.pointer()?,
        };
        self.is_powered = false;
        self.branch(rest, otherwise, Some(after))?;
        self.span = first.span;
        self.goto(after);
        self.label(then);
        self.body(&first.body);
        if end.is_none() {
            self.span = first.span;
            self.label(after);
        }
        Ok(())
    }

    /// Returns true for `=` and `<>` of conditions, of which one is just the opposite of the other.
    pub(crate) fn is_equality(&self, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Binary(Op::Eq | Op::Ne, left, _) => self.ty(left).is_ok_and(Ty::is_bit),
            _ => false,
        }
    }

    fn case(&mut self, of: &Expr, arms: &[Arm<Vec<Label>>], otherwise: Option<&Body>) -> Made<()> {
        let checked = self.ty(of).and_then(|ty| match ty.is_whole() {
            true => Ok(ty),
            false => fail(codes::ST_TYPE.at(
                of.span,
                phrase!("CASE takes a whole number, and this is {ty}", ty),
            )),
        });
        let ty = match checked {
            Ok(Ty::Integer) => Ty::Int,
            Ok(ty) => ty,
            Err(errors) => {
                self.found.extend(errors);
                self.bodies(arms, otherwise);
                return Ok(());
            }
        };
        let selector = self.kept_operand(of, ty)?;
        let mut seen: Vec<(i64, i64, Span)> = Vec::new();
        let mut end = None;
        let head = self.span;
        for (at, arm) in arms.iter().enumerate() {
            self.span = arm.span;
            let is_last = at + 1 == arms.len() && otherwise.is_none();
            let cond = match self.labels_of(arm, (&selector, ty), &mut seen) {
                Ok(cond) => cond,
                Err(errors) => {
                    self.found.extend(errors);
                    self.body(&arm.body);
                    continue;
                }
            };
            let next = self.pointer()?;
            self.jump_unless(&cond, false, arm.span, next)?;
            self.body(&arm.body);
            self.span = arm.span;
            if !is_last {
                let to = match end {
                    Some(end) => end,
                    None => self.pointer()?,
                };
                end = Some(to);
                self.goto(to);
            }
            self.label(next);
        }
        if let Some(body) = otherwise {
            self.body(body);
        }
        self.span = head;
        if let Some(end) = end {
            self.label(end);
        }
        Ok(())
    }

    /// Examines the branches of a CASE that cannot be compiled.
    fn bodies(&mut self, arms: &[Arm<Vec<Label>>], otherwise: Option<&Body>) {
        for body in arms.iter().map(|arm| &arm.body).chain(otherwise) {
            self.body(body);
        }
    }

    /// The condition of a branch of CASE.
    fn labels_of(
        &mut self,
        arm: &Arm<Vec<Label>>,
        (selector, ty): (&Operand, Ty),
        seen: &mut Vec<(i64, i64, Span)>,
    ) -> Made<Cond> {
        let mut all: Option<Cond> = None;
        for (first, last) in &arm.when {
            let span = last
                .as_ref()
                .map_or(first.span, |last| first.span.to(last.span));
            let low = self.case_value(first, ty)?;
            let high = match last {
                Some(last) => self.case_value(last, ty)?,
                None => low,
            };
            if high < low {
                let what = phrase!("this range is empty: its end is below its beginning");
                return fail(codes::ST_LITERAL.at(span, what));
            }
            if let Some((.., before)) = seen.iter().find(|(a, b, _)| low <= *b && *a <= high) {
                let error = codes::ST_CASE_TWICE.at(span, "CASE lists this value twice");
                return fail(error.label("again here").other(*before, "first here"));
            }
            seen.push((low, high, span));
            let mut compare = |op, expr: &Expr, value| {
                let value = Operand {
                    span: expr.span,
                    kind: constant_operand(Const::Int(value), ty)
                        .unwrap_or(OperandKind::Decimal(value, None)),
                };
                self.compared(op, selector, &value, ty)
            };
            let one = match last {
                None => compare(Op::Eq, first, low)?,
                Some(last) => {
                    Cond::both(compare(Op::Ge, first, low)?, compare(Op::Le, last, high)?)
                }
            };
            all = Some(match all {
                Some(all) => Cond::Joined(Join::Or, Rc::new(all), Rc::new(one)),
                None => one,
            });
        }
        all.ok_or_else(Vec::new)
    }

    fn case_value(&self, expr: &Expr, ty: Ty) -> Made<i64> {
        match fold::constant(&self.labels, expr) {
            Some(literal @ (Const::Int(value), _)) => {
                let fits = crate::labels::value_in(literal, ty, expr.span);
                fits.map(|_| value).map_err(|error| vec![*error])
            }
            _ => {
                // An unknown name is worth more than that it is not constant.
                self.ty(expr)?;
                fail(codes::ST_LITERAL.at(expr.span, "a label of CASE is a constant whole number"))
            }
        }
    }

    /// `FOR`: the counter is compared before each round, and the end is computed each time.
    fn count(&mut self, for_: &For) -> Made<()> {
        let head = self.span;
        let checked = self.target(&for_.variable).and_then(|counter| {
            let (ty, span) = (counter.ty, for_.variable.span);
            if !ty.is_whole() || ty.is_unsigned() {
                let what = phrase!("FOR counts an INT or DINT, and this is {ty}", ty);
                return fail(codes::ST_TYPE.at(span, what));
            }
            if counter.is_variable() {
                let what = phrase!("a counter of FOR with a variable index is not compiled yet");
                return fail(codes::ST_UNSUPPORTED.at(span, what));
            }
            let kind = counter.operand;
            Ok((Operand { span, kind }, ty))
        });
        let step = match &for_.by {
            None => Ok(1),
            Some(by) => match fold::constant(&self.labels, by) {
                Some((Const::Int(step), _)) if step != 0 && i16::try_from(step).is_ok() => Ok(step),
                _ => fail(
                    codes::ST_LITERAL.at(by.span, "the step of FOR is a constant other than 0"),
                ),
            },
        };
        let ((counter, ty), step) = match both(checked, step) {
            Ok(found) => found,
            Err(errors) => {
                self.found.extend(errors);
                self.looped(&for_.body)?;
                return Ok(());
            }
        };
        self.expect(&for_.from, ty)?;
        self.compute(&for_.from, ty, Some(&counter))?;
        let (again, end) = (self.pointer()?, self.pointer()?);
        self.label(again);
        let last = self.kept_operand(&for_.to, ty)?;
        let op = if step > 0 { Op::Gt } else { Op::Lt };
        let is_wide = ty.is_wide();
        self.load(&Cond::Compare {
            op,
            is_wide,
            operands: [counter.clone(), last],
        });
        self.jump(end);
        self.loops.push(end);
        self.body(&for_.body);
        self.loops.pop();
        self.span = head;
        let step = self.here(OperandKind::Decimal(step, None));
        self.always(&Self::sized("ADD", ty), [step, counter.clone(), counter]);
        self.is_powered = false;
        self.goto(again);
        self.label(end);
        Ok(())
    }

    /// Examines the body of a loop that cannot be compiled.
    fn looped(&mut self, body: &Body) -> Made<()> {
        let end = self.pointer()?;
        self.loops.push(end);
        self.body(body);
        self.loops.pop();
        Ok(())
    }

    fn while_(&mut self, when: &Expr, body: &Body) -> Made<()> {
        self.warn_never(when, body);
        let head = self.span;
        let (again, end) = (self.pointer()?, self.pointer()?);
        self.label(again);
        let cond = match self.condition(when) {
            Ok(cond) => cond,
            Err(errors) => {
                self.found.extend(errors);
                return self.looped(body);
            }
        };
        let is_equality = self.is_equality(when);
        self.jump_unless(&cond, is_equality, when.span, end)?;
        self.loops.push(end);
        self.body(body);
        self.loops.pop();
        self.span = head;
        self.is_powered = false;
        self.goto(again);
        self.label(end);
        Ok(())
    }

    fn repeat(&mut self, body: &Body, until: &Expr) -> Made<()> {
        let head = self.span;
        let (again, end) = (self.pointer()?, self.pointer()?);
        self.label(again);
        self.loops.push(end);
        self.body(body);
        self.loops.pop();
        self.span = head;
        let cond = self.condition(until)?;
        let is_equality = self.is_equality(until);
        self.jump_unless(&cond, is_equality, until.span, again)?;
        self.label(end);
        Ok(())
    }
}

impl Cond {
    /// The opposite; of `=` and `<>` of conditions with the contacts in the order of the other operator.
    pub(crate) fn opposite_of_equality(&self, is_equality: bool) -> Cond {
        match self {
            Cond::Joined(Join::Or, first, second) if is_equality => {
                let turned = |pair: &Cond| match pair {
                    Cond::Joined(Join::And, a, b) => {
                        Cond::Joined(Join::And, Rc::clone(a), Rc::new(b.opposite()))
                    }
                    other => other.clone(),
                };
                Cond::Joined(Join::Or, Rc::new(turned(first)), Rc::new(turned(second)))
            }
            other => other.opposite(),
        }
    }
}

/// The part of a statement that its first instructions stand for.
fn head(stmt: &Stmt) -> Span {
    match &stmt.kind {
        StmtKind::If(arms, ..) => arms.first().map_or(stmt.span, |arm| arm.span),
        StmtKind::Case(of, _, _, closed) => closed.head.to(of.span),
        StmtKind::For(for_) => for_.span,
        StmtKind::While(when, _, closed) => closed.head.to(when.span),
        StmtKind::Repeat(_, _, closed) => closed.head,
        _ => stmt.span,
    }
}
