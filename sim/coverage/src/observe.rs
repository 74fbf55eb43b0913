//! Looking on while a program is executed.
//!
//! A contact decides where another state of it alone would give another result of the logic that it belongs to: what
//! MC/DC asks of conditions, with all other contacts as they are. The logic ends where a result is kept: at the branch
//! of MPS, at the coil, at the drive of an instruction.

use rungc_interp::{Machine, Observer};
use rungc_ir::node::{Action, Expr, ExprId, Stmt, Ty};
use rungc_ir::{Module, walk};
use rungc_lower::marks::{Mark, Marks};
use rungc_rt::{Class, Plc};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// The instruction was executed.
pub(crate) const EXECUTED: u8 = 1;
/// It was on: conducted, held, or was driven.
pub(crate) const ON: u8 = 1 << 1;
/// It was off.
pub(crate) const OFF: u8 = 1 << 2;
/// It decided while it was on.
pub(crate) const DECIDED_ON: u8 = 1 << 3;
/// It decided while it was off.
pub(crate) const DECIDED_OFF: u8 = 1 << 4;
/// Its timer expired.
pub(crate) const EXPIRED: u8 = 1 << 5;

/// Observations of each instruction.
pub(crate) struct Seen(Vec<AtomicU8>);

impl Seen {
    pub(crate) fn new(instrs: usize) -> Self {
        Seen((0..instrs).map(|_| AtomicU8::new(0)).collect())
    }

    fn add(&self, instr: u32, flags: u8) {
        if let Some(seen) = self.0.get(instr as usize) {
            seen.fetch_or(flags, Ordering::Relaxed);
        }
    }

    /// Returns the observations, and clears them.
    pub(crate) fn take(&self) -> Vec<u8> {
        self.0
            .iter()
            .map(|seen| seen.swap(0, Ordering::Relaxed))
            .collect()
    }
}

/// Looks on at nothing.
pub(crate) struct Nobody;

impl Observer for Nobody {
    fn before(&mut self, _: &Machine, _: &Stmt) {}
}

/// Looks on at a machine.
pub(crate) struct Watcher {
    marks: Arc<Marks>,
    seen: Arc<Seen>,
    /// The output whose statements are executed.
    output: Option<u32>,
    open: Vec<(ExprId, bool)>,
}

impl Watcher {
    pub(crate) fn new(marks: Arc<Marks>, seen: Arc<Seen>) -> Self {
        Watcher {
            marks,
            seen,
            output: None,
            open: Vec::new(),
        }
    }

    /// The instruction that an expression was made for.
    fn instr(&self, id: ExprId) -> Option<u32> {
        self.marks.exprs.get(id).copied()
    }

    /// Records the contacts in an expression of a statement: those of its logic, or of logic that is part of a number.
    fn expression(&mut self, machine: &Machine, root: ExprId) {
        let module = machine.module();
        if module.ty(root) == Ty::Bit {
            return self.logic(machine, root);
        }
        for part in walk::operands(module.expr(root)) {
            self.expression(machine, part);
        }
    }

    /// Records the contacts of logic.
    fn logic(&mut self, machine: &Machine, root: ExprId) {
        let module = machine.module();
        self.open.clear();
        self.open.push((root, true));
        while let Some((id, decides)) = self.open.pop() {
            match *module.expr(id) {
                Expr::Not(a) => self.open.push((a, decides)),
                Expr::And(a, b) => {
                    let values = [value(machine, module, a), value(machine, module, b)];
                    self.open.push((a, decides && values[1]));
                    self.open.push((b, decides && values[0]));
                }
                Expr::Or(a, b) => {
                    let values = [value(machine, module, a), value(machine, module, b)];
                    self.open.push((a, decides && !values[1]));
                    self.open.push((b, decides && !values[0]));
                }
                // A contact does not decide whether an index reaches a device.
                Expr::Bit(_) | Expr::InRange { .. } => {}
                _ => self.contact(machine, id, decides),
            }
        }
    }

    /// A contact or comparison, as the device is: that of a normally closed contact conducts while it is off.
    fn contact(&mut self, machine: &Machine, id: ExprId, decides: bool) {
        let is_contact = |instr: &u32| self.marks.contacts.get(*instr as usize) == Some(&true);
        let Some(instr) = self.instr(id).filter(is_contact) else {
            return;
        };
        let on = machine.is_on(id);
        let flags = match (on, decides) {
            (true, true) => ON | DECIDED_ON,
            (true, false) => ON,
            (false, true) => OFF | DECIDED_OFF,
            (false, false) => OFF,
        };
        self.seen.add(instr, EXECUTED | flags);
    }

    fn mark(&mut self, machine: &Machine, network: u32) {
        match self.marks.places.get(network as usize) {
            Some(&Mark::Network(instr)) => {
                self.seen.add(instr, EXECUTED);
                self.output = None;
            }
            Some(&Mark::Output { instr, drive }) => {
                let on = value(machine, machine.module(), drive);
                self.seen.add(instr, EXECUTED | if on { ON } else { OFF });
                self.output = Some(instr);
            }
            None => {}
        }
    }
}

/// The value of logic, with what joins contacts walked here.
fn value(machine: &Machine, module: &Module, id: ExprId) -> bool {
    match *module.expr(id) {
        Expr::Bit(on) => on,
        Expr::Not(a) => !value(machine, module, a),
        Expr::And(a, b) => value(machine, module, a) && value(machine, module, b),
        Expr::Or(a, b) => value(machine, module, a) || value(machine, module, b),
        _ => machine.is_on(id),
    }
}

impl Observer for Watcher {
    fn before(&mut self, machine: &Machine, stmt: &Stmt) {
        match stmt {
            Stmt::Network(network) => self.mark(machine, *network),
            // The contact of LDP decides where its result is used.
            Stmt::Do(Action::Edge(edge)) if self.marks.edges.contains(&edge.memory) => {}
            _ => walk::for_exprs(stmt, &mut |&id| self.expression(machine, id)),
        }
        if let Stmt::Do(Action::Timer(coil)) = stmt
            && let (Some(instr), Some(true)) = (self.output, machine.bit(Class::T, coil.number))
        {
            self.seen.add(instr, EXPIRED);
        }
    }
}
