//! Looking on while a program is executed.
//!
//! A contact decides where another state of it alone would give another result of the logic that it belongs to: what
//! MC/DC asks of conditions, with all other contacts as they are. The logic ends where a result is kept: at the branch
//! of MPS, at the coil, at the drive of an instruction.

use rungc_interp::{Machine, Observer};
use rungc_ir::Module;
use rungc_ir::node::{Expr, ExprId, Stmt, Ty};
use rungc_lower::marks::{Mark, Marks};
use rungc_rt::{Class, Plc};
use std::sync::Arc;
use std::sync::atomic::{AtomicU16, Ordering};

/// The instruction was executed.
pub(crate) const EXECUTED: u16 = 1;
/// It was on: conducted, held, or was driven.
pub(crate) const ON: u16 = 1 << 1;
/// It was off.
pub(crate) const OFF: u16 = 1 << 2;
/// It decided while it was on.
pub(crate) const DECIDED_ON: u16 = 1 << 3;
/// It decided while it was off.
pub(crate) const DECIDED_OFF: u16 = 1 << 4;
/// Its timer expired.
pub(crate) const EXPIRED: u16 = 1 << 5;

/// What was seen of each instruction.
pub(crate) struct Seen(Vec<AtomicU16>);

impl Seen {
    pub(crate) fn new(instrs: usize) -> Self {
        Seen((0..instrs).map(|_| AtomicU16::new(0)).collect())
    }

    fn add(&self, instr: u32, flags: u16) {
        if let Some(seen) = self.0.get(instr as usize) {
            seen.fetch_or(flags, Ordering::Relaxed);
        }
    }

    /// What was seen, which is forgotten.
    pub(crate) fn take(&self) -> Vec<u16> {
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
    marks: Marks,
    seen: Arc<Seen>,
    /// The output whose statements are executed.
    output: Option<u32>,
    open: Vec<(ExprId, bool)>,
}

impl Watcher {
    pub(crate) fn new(marks: &Marks, seen: Arc<Seen>) -> Self {
        Watcher {
            marks: marks.clone(),
            seen,
            output: None,
            open: Vec::new(),
        }
    }

    /// The instruction that an expression was made for.
    fn instr(&self, id: ExprId) -> Option<u32> {
        self.marks.exprs.get(id).copied()
    }

    /// What the logic of a statement says of its contacts.
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
                Expr::Bit(_) => {}
                _ => self.contact(machine, id, decides),
            }
        }
    }

    /// A contact or comparison, as the device is: that of a normally closed contact conducts while it is off.
    fn contact(&mut self, machine: &Machine, id: ExprId, decides: bool) {
        let Some(instr) = self.instr(id) else {
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
        let module = machine.module();
        match stmt {
            Stmt::Network(network) => self.mark(machine, *network),
            &Stmt::Let(_, id) if module.ty(id) == Ty::Bit => self.logic(machine, id),
            // A single contact is that of LDP or another edge: it decides where its result is used.
            Stmt::Edge(edge) if is_joined(module, edge.input) => self.logic(machine, edge.input),
            &Stmt::Write(_, id) if module.ty(id) == Ty::Bit => self.logic(machine, id),
            Stmt::Timer(coil) => {
                self.logic(machine, coil.drive);
                if let (Some(instr), Some(true)) = (self.output, machine.bit(Class::T, coil.number))
                {
                    self.seen.add(instr, EXPIRED);
                }
            }
            Stmt::Counter16(coil) => self.logic(machine, coil.drive),
            Stmt::Counter32(coil) => self.logic(machine, coil.drive),
            Stmt::TimerAt(coil) | Stmt::Counter16At(coil) => self.logic(machine, coil.drive),
            Stmt::If(branch) => self.logic(machine, branch.cond),
            Stmt::Call(call) => {
                if let Some(drive) = call.drive {
                    self.logic(machine, drive);
                }
            }
            _ => {}
        }
    }
}

fn is_joined(module: &Module, id: ExprId) -> bool {
    match *module.expr(id) {
        Expr::Not(a) => is_joined(module, a),
        ref expr => matches!(expr, Expr::And(..) | Expr::Or(..)),
    }
}
