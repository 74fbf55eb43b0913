//! Gives instructions that sample, such as PID, the period of the timer interrupt in whose routine they are
//! ([`Call::period_ms`](rungc_ir::node::Call::period_ms)).
//!
//! A subroutine counts as part of a routine if all its calls come from routines with one period.

use rungc_ir::node::{Action, FunctionKind, Module, Stmt};
use rungc_ir::walk::{bodies_mut, statements};
use rungc_models::interrupts::Source;

/// Caller of a function.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Caller {
    /// None is known yet.
    Unknown,
    /// Timer interrupts with this period.
    Period(u16),
    /// The scan, other interrupts, or several periods.
    Other,
}

impl Caller {
    /// This and another one.
    fn and(self, other: Caller) -> Caller {
        match (self, other) {
            (Caller::Unknown, caller) | (caller, Caller::Unknown) => caller,
            _ if self == other => self,
            _ => Caller::Other,
        }
    }
}

/// Marks the calls of functions that sample.
pub(super) fn mark(module: &mut Module) {
    let mut any = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| any |= samples(stmt));
    }
    if !any {
        return;
    }
    let callers = callers(module);
    for (function, caller) in module.functions.iter_mut().zip(callers) {
        if let Caller::Period(ms) = caller {
            mark_body(&mut function.body, ms);
        }
    }
}

fn samples(stmt: &Stmt) -> bool {
    matches!(stmt, Stmt::Do(Action::Call(call)) if call.function.needs().sampled)
}

fn mark_body(body: &mut [Stmt], ms: u16) {
    for stmt in body {
        if samples(stmt)
            && let Stmt::Do(Action::Call(call)) = stmt
        {
            call.period_ms = ms;
        }
        for inner in bodies_mut(stmt) {
            mark_body(inner, ms);
        }
    }
}

/// The caller of each function.
fn callers(module: &Module) -> Vec<Caller> {
    let own: Vec<Caller> = module
        .functions
        .iter()
        .map(|function| match function.kind {
            FunctionKind::Interrupt(pointer) => period(module, pointer),
            FunctionKind::Subroutine(_) => Caller::Unknown,
            FunctionKind::Main
            | FunctionKind::Begin
            | FunctionKind::End
            | FunctionKind::TakeInterrupts
            | FunctionKind::InputEdge { .. }
            | FunctionKind::Signals => Caller::Other,
        })
        .collect();
    let mut callers = own.clone();
    // Knowledge of callers spreads by a level of calls in each round; there is no recursion.
    loop {
        let mut next = own.clone();
        for (function, &caller) in module.functions.iter().zip(&callers) {
            statements(&function.body, &mut |stmt| {
                if let Stmt::CallSub(callee) = *stmt
                    && own.get(callee as usize) == Some(&Caller::Unknown)
                    && let Some(callee) = next.get_mut(callee as usize)
                {
                    *callee = callee.and(caller);
                }
            });
        }
        if next == callers {
            return callers;
        }
        callers = next;
    }
}

/// What requests an interrupt routine.
fn period(module: &Module, pointer: u32) -> Caller {
    let found = module.model.interrupts.find(pointer);
    match found.and_then(|interrupt| interrupt.source) {
        Some(Source::Period { ms }) => u16::try_from(ms).map_or(Caller::Other, Caller::Period),
        _ => Caller::Other,
    }
}
