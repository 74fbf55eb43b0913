//! Finds the timers whose coils may be executed more than once in a scan: they count the time of a scan only once
//! ([`TimerKind::shared`](rungc_rt::TimerKind::shared)).
//!
//! A coil that occurs once, in code that a scan passes at most once, needs no memory of the scan in which it was
//! executed.

use rungc_ir::node::{Action, FunctionKind, LabelId, Module, Part, Stmt, TimerCoil};
use rungc_ir::walk::{bodies, bodies_mut, statements};
use std::collections::BTreeSet;

/// Maximum number of executions in a scan: none, one, or more.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Times {
    Never,
    Once,
    Often,
}

impl Times {
    /// This and once more.
    fn and(self, other: Times) -> Times {
        match (self, other) {
            (Times::Never, times) | (times, Times::Never) => times,
            _ => Times::Often,
        }
    }

    fn looped(self, looped: bool) -> Times {
        match self {
            Times::Once if looped => Times::Often,
            times @ Times::Never | times @ Times::Once | times @ Times::Often => times,
        }
    }
}

/// Marks the coils of timers that share the time of a scan.
pub(super) fn mark(module: &mut Module) {
    let has_timers = |stmt: &Stmt| matches!(stmt, Stmt::Do(Action::Timer(_) | Action::TimerAt(_)));
    let mut any = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| any |= has_timers(stmt));
    }
    if !any {
        return;
    }
    let times = function_times(module);
    let (mut seen, mut shared, mut indexed) = (BTreeSet::new(), BTreeSet::new(), false);
    for (function, &times) in module.functions.iter().zip(&times) {
        executed(&function.body, times, &mut |stmt, times| {
            if let Stmt::Do(Action::Timer(TimerCoil { number, .. })) = *stmt
                && (!seen.insert(number) || times == Times::Often)
            {
                shared.insert(number);
            }
            // It may lead to any timer.
            indexed |= matches!(stmt, Stmt::Do(Action::TimerAt(_)));
        });
    }
    if indexed || !shared.is_empty() {
        for function in &mut module.functions {
            mark_body(&mut function.body, &|number| {
                indexed || shared.contains(&number)
            });
        }
    }
}

fn mark_body(body: &mut [Stmt], is_shared: &impl Fn(u32) -> bool) {
    for stmt in body {
        if let Stmt::Do(Action::Timer(TimerCoil { number, kind, .. })) = stmt {
            kind.shared = is_shared(*number);
        }
        for inner in bodies_mut(stmt) {
            mark_body(inner, is_shared);
        }
    }
}

/// Maximum number of executions of each function in a scan. Interrupts come as often as they are requested.
fn function_times(module: &Module) -> Vec<Times> {
    let by_host: Vec<Times> = module
        .functions
        .iter()
        .map(|function| match function.kind {
            FunctionKind::Begin | FunctionKind::Main | FunctionKind::End => Times::Once,
            FunctionKind::Subroutine(_) => Times::Never,
            FunctionKind::Interrupt(_)
            | FunctionKind::TakeInterrupts
            | FunctionKind::InputEdge { .. }
            | FunctionKind::Signals => Times::Often,
        })
        .collect();
    let mut times = by_host.clone();
    // Knowledge of callers spreads by a level of calls in each round; there is no recursion.
    loop {
        let mut next = by_host.clone();
        for (function, &times) in module.functions.iter().zip(&times) {
            executed(&function.body, times, &mut |stmt, times| {
                if let Stmt::CallSub(callee) = *stmt
                    && let Some(callee) = next.get_mut(callee as usize)
                {
                    *callee = callee.and(times);
                }
            });
        }
        if next == times {
            return times;
        }
        times = next;
    }
}

/// Calls `visit` with each statement that is executed so often, and with how often that is.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "`bodies` matches all statements"
)]
fn executed<'m>(body: &'m [Stmt], times: Times, visit: &mut dyn FnMut(&'m Stmt, Times)) {
    for stmt in body {
        visit(stmt, times);
        match stmt {
            Stmt::For { body, .. } => executed(body, times.looped(true), visit),
            Stmt::Parts(parts) => {
                let looped = looped(parts);
                for (i, part) in parts.iter().enumerate() {
                    let looped = looped
                        .iter()
                        .any(|(first, last)| (*first..=*last).contains(&i));
                    executed(&part.body, times.looped(looped), visit);
                }
            }
            _ => bodies(stmt).for_each(|body| executed(body, times, visit)),
        }
    }
}

/// The first and the last part that each jump back repeats.
fn looped(parts: &[Part]) -> Vec<(usize, usize)> {
    let at = |label: LabelId| parts.iter().position(|part| part.label == Some(label));
    let mut looped = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        statements(&part.body, &mut |stmt| {
            if let Stmt::Goto(label) = *stmt
                && let Some(target) = at(label).filter(|&target| target <= i)
            {
                looped.push((target, i));
            }
        });
    }
    looped
}
