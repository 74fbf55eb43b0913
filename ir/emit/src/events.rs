//! Events outside the scan, and the parts of the program that react to them.

use rungc_ir::Module;
use rungc_ir::node::{Action, Cell, FunctionKind, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::EdgeKind;
use std::collections::BTreeSet;

/// The edges that mean something: function of the module, terminal X, which.
pub fn edges(module: &Module) -> impl Iterator<Item = (usize, u32, EdgeKind)> {
    let functions = module.functions.iter().enumerate();
    let functions = functions.filter(|(_, function)| !function.body.is_empty());
    functions.filter_map(|(at, function)| {
        let FunctionKind::InputEdge { input, kind } = function.kind else {
            return None;
        };
        Some((at, input, kind))
    })
}

/// The input terminals whose edges mean something, each once.
pub fn inputs(module: &Module) -> BTreeSet<u32> {
    edges(module).map(|(_, input, _)| input).collect()
}

/// The cells that follow the time.
pub fn clocks(module: &Module) -> impl Iterator<Item = &Cell> {
    module.cells.iter().filter(|cell| cell.follows_time)
}

/// Returns true if time between scans affects the program.
pub fn follows_time(module: &Module) -> bool {
    module.sends_pulses()
        || module.has_ports()
        || module.periods().next().is_some()
        || clocks(module).next().is_some()
}

/// The flags that are set outside the scan, perhaps in an interrupt handler.
pub(crate) fn set_between_scans(module: &Module) -> BTreeSet<usize> {
    let mut found: BTreeSet<usize> = BTreeSet::new();
    for (at, _, _) in edges(module) {
        statements(&module.functions[at].body, &mut |stmt| {
            if let Stmt::Do(Action::SetFlag(flag, _)) = stmt {
                found.insert(usize::from(*flag));
            }
        });
    }
    let flags = module.flags.iter().enumerate();
    found.extend(
        flags
            .filter(|(_, flag)| flag.period_ms.is_some())
            .map(|(i, _)| i),
    );
    found
}

/// Returns true if edges only set flags, so that they may come at any time.
pub fn edges_only_note(module: &Module) -> bool {
    let mut only = true;
    for (at, _, _) in edges(module) {
        statements(&module.functions[at].body, &mut |stmt| {
            only &= matches!(stmt, Stmt::Do(Action::SetFlag(..)) | Stmt::If(_));
        });
    }
    only
}

/// The function of the module that takes interrupts.
pub fn interrupts(module: &Module) -> Option<usize> {
    let mut functions = module.functions.iter();
    functions.position(|f| f.kind == FunctionKind::TakeInterrupts)
}
