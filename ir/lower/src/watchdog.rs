//! Puts [`Stmt::Watch`] where a scan might not end: at what jumps back, and in loops that are long or as long as a
//! device says.
//!
//! Loops that are known to be short are left alone, so most programs have no watchdog at all.

use super::basic_of;
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::Basic;
use rungc_ir::node::{
    Action, Body, Branch, Expr, ExprId, Function, FunctionKind, LabelId, Module, Part, Steps, Stmt,
    SysValue,
};
use rungc_ir::walk::{bodies_mut, statements};
use rungc_ir::worst::lengths;
use rungc_syntax::OperandKind;
use std::collections::BTreeMap;

/// A loop that executes no more steps than these in all its iterations needs no watching: the fastest PLC takes some
/// milliseconds.
const SHORT: u64 = 20_000;

/// Properties of a function.
#[derive(Clone, Copy, Default)]
struct Known {
    /// Steps that a call of it executes at most, but for those that it watches itself.
    steps: u64,
    /// True if it may be cut short.
    watches: bool,
}

/// Puts watches into the functions of a module.
pub(super) fn watch(module: &mut Module, resolved: &Resolved) {
    let mut watcher = Watcher {
        lengths: lengths(module),
        module,
        resolved,
        known: BTreeMap::new(),
        step: 0,
        watches: false,
    };
    let count = watcher.module.functions.len();
    let known: Vec<Known> = (0..count).map(|number| watcher.function(number)).collect();
    // END processing belongs to a scan that comes to its end.
    if known.iter().any(|known| known.watches) {
        let leave = watcher.leave_if_stopped();
        let end = |function: &&mut Function| {
            function.kind == FunctionKind::End && !function.body.is_empty()
        };
        if let Some(end) = module.functions.iter_mut().find(end) {
            end.body.insert(0, leave);
        }
    } else {
        for function in &mut module.functions {
            drop_restarts(&mut function.body);
        }
    }
}

/// Removes WDT where there is no watchdog.
fn drop_restarts(body: &mut Body) {
    body.retain(|stmt| !matches!(stmt, Stmt::Do(Action::RestartWatchdog)));
    for stmt in body {
        for inner in bodies_mut(stmt) {
            drop_restarts(inner);
        }
    }
}

struct Watcher<'m> {
    module: &'m mut Module,
    resolved: &'m Resolved<'m>,
    /// Steps of each network.
    lengths: Vec<u64>,
    /// Functions that were looked at.
    known: BTreeMap<usize, Known>,
    /// Step of the network at hand.
    step: u32,
    /// True if the current function may be cut short.
    watches: bool,
}

impl Watcher<'_> {
    fn function(&mut self, number: usize) -> Known {
        if let Some(known) = self.known.get(&number) {
            return *known;
        }
        // There is no recursion; a function that is being looked at takes nothing once more.
        self.known.insert(number, Known::default());
        let Some(function) = self.module.functions.get_mut(number) else {
            return Known::default();
        };
        let body = std::mem::take(&mut function.body);
        let outer = (self.step, std::mem::take(&mut self.watches));
        let (body, steps) = self.body(body);
        let known = Known {
            steps,
            watches: self.watches,
        };
        (self.step, self.watches) = outer;
        self.module.functions[number].body = body;
        self.known.insert(number, known);
        known
    }

    /// The body with its watches, and how many steps it executes at most, in addition to those that they count.
    fn body(&mut self, body: Body) -> (Body, u64) {
        let mut out = Vec::with_capacity(body.len());
        let mut steps = 0u64;
        for stmt in body {
            let taken = match stmt {
                Stmt::Network(number) => {
                    if let Some(network) = self.module.networks.get(number as usize) {
                        self.step = network.step;
                    }
                    out.push(stmt);
                    self.lengths.get(number as usize).copied().unwrap_or(0)
                }
                Stmt::If(Branch {
                    cond,
                    then,
                    otherwise,
                }) => {
                    let (then, first) = self.body(then);
                    let (otherwise, second) = self.body(otherwise);
                    out.push(Stmt::If(Branch {
                        cond,
                        then,
                        otherwise,
                    }));
                    first.max(second)
                }
                Stmt::For { count, body } => self.repeated(count, body, &mut out),
                Stmt::Steps(steps) => {
                    let (body, taken) = self.body(steps.body);
                    out.push(Stmt::Steps(Steps { body, ..steps }));
                    taken
                }
                Stmt::Parts(parts) => self.parts(parts, &mut out),
                Stmt::CallSub(number) => {
                    out.push(stmt);
                    let known = self.function(number as usize);
                    let kind = self.module.functions.get(number as usize).map(|f| &f.kind);
                    if matches!(kind, Some(FunctionKind::Subroutine(_))) {
                        if known.watches {
                            self.watches = true;
                            let leave = self.leave_if_stopped();
                            out.push(leave);
                        }
                        known.steps
                    } else {
                        // Interrupts are rare, and if one is cut short, the scan continues.
                        0
                    }
                }
                stmt @ (Stmt::Do(_)
                | Stmt::Repeat(_)
                | Stmt::Return
                | Stmt::Goto(_)
                | Stmt::Watch { .. }) => {
                    out.push(stmt);
                    0
                }
            };
            steps = steps.saturating_add(taken);
        }
        (out, steps)
    }

    /// FOR: how many steps it executes, if it is not watched.
    fn repeated(&mut self, count: ExprId, body: Body, out: &mut Body) -> u64 {
        let at = self.step;
        let (mut body, iteration) = self.body(body);
        let iteration = iteration.max(1);
        let all = if let Expr::I16(count) = *self.module.expr(count) {
            Some(iteration.saturating_mul(count.max(1) as u64))
        } else {
            None
        };
        let short = all.filter(|&all| all <= SHORT);
        if short.is_none() {
            body.insert(0, self.watched(iteration, at));
        }
        out.push(Stmt::For { count, body });
        short.unwrap_or(0)
    }

    /// Parts: a jump back takes the steps that it repeats.
    fn parts(&mut self, parts: Vec<Part>, out: &mut Body) -> u64 {
        let (mut done, mut steps) = (Vec::with_capacity(parts.len()), Vec::new());
        let mut begins = Vec::with_capacity(parts.len());
        for part in parts {
            begins.push(self.step);
            let (body, taken) = self.body(part.body);
            done.push(Part { body, ..part });
            steps.push(taken);
        }
        let labels: Vec<Option<LabelId>> = done.iter().map(|part| part.label).collect();
        for (i, part) in done.iter_mut().enumerate() {
            let mut own = false;
            statements(&part.body, &mut |stmt| {
                own |= matches!(stmt, Stmt::Goto(label) if labels[..=i].contains(&Some(*label)));
            });
            if own {
                self.step = begins[i];
                self.jumps_back(&mut part.body, &labels[..=i], &steps[..=i]);
            }
        }
        out.push(Stmt::Parts(done));
        steps.into_iter().fold(0, u64::saturating_add)
    }

    /// Puts a watch in front of each jump to one of the labels.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "`bodies_mut` matches all statements"
    )]
    fn jumps_back(&mut self, body: &mut Body, labels: &[Option<LabelId>], steps: &[u64]) {
        let mut at = 0;
        while at < body.len() {
            match body[at] {
                Stmt::Network(number) => {
                    if let Some(network) = self.module.networks.get(number as usize) {
                        self.step = network.step;
                    }
                }
                Stmt::Goto(label) => {
                    if let Some(target) = labels.iter().position(|&other| other == Some(label)) {
                        let repeated = steps[target..]
                            .iter()
                            .fold(1, |sum: u64, &n| sum.saturating_add(n));
                        let jump = self.jump_to(label);
                        body.insert(at, self.watched(repeated, jump));
                        at += 1;
                    }
                }
                _ => {
                    for inner in bodies_mut(&mut body[at]) {
                        self.jumps_back(inner, labels, steps);
                    }
                }
            }
            at += 1;
        }
    }

    /// The step of the CJ in the network at hand that goes to a label; that of the network, if something else does.
    fn jump_to(&self, label: LabelId) -> u32 {
        let resolved = self.resolved;
        let from = resolved
            .instrs
            .partition_point(|instr| instr.step < self.step);
        let jump = (from..resolved.instrs.len()).find(|&i| {
            let names = |kind: &OperandKind| matches!(kind, OperandKind::Device(device, _) if device.number == label.0);
            let operand = resolved.program.instrs[i].operands.first();
            basic_of(resolved, i) == Some(Basic::Cj) && operand.is_some_and(|o| names(&o.kind))
        });
        jump.map_or(self.step, |i| resolved.instrs[i].step)
    }

    fn watched(&mut self, steps: u64, at: u32) -> Stmt {
        self.watches = true;
        Stmt::Watch {
            steps: steps.try_into().unwrap_or(u32::MAX),
            at,
        }
    }

    fn leave_if_stopped(&mut self) -> Stmt {
        let running = self.module.add(Expr::Sys(SysValue::Running));
        let cond = self.module.add(Expr::Not(running));
        Stmt::If(Branch {
            cond,
            then: vec![Stmt::Return],
            otherwise: Vec::new(),
        })
    }
}
