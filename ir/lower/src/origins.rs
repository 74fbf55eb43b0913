//! The instructions at which faults can occur, for hosts that report them.

use super::operand::indexed;
use rungc_analysis::resolve::Resolved;
use rungc_ir::node::{Module, Origin};
use rungc_ir::walk::{fault_step, statements};
use std::collections::BTreeSet;

/// Finds them in a program that is lowered.
pub(super) fn find(module: &Module, resolved: &Resolved) -> Vec<Origin> {
    let mut steps = BTreeSet::new();
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            steps.extend(fault_step(stmt));
        });
    }
    let origins = steps.into_iter().filter_map(|step| origin(resolved, step));
    origins.collect()
}

/// The instruction at a step. What the scan itself does has the step of no instruction, or of the first one.
fn origin(resolved: &Resolved, step: u32) -> Option<Origin> {
    let end = resolved.instrs.partition_point(|instr| instr.step <= step);
    let mut known = (0..end).rev();
    let at = known.find(|&i| resolved.instrs[i].inst.is_some())?;
    let instr = resolved.program.instrs.get(at)?;
    let text = resolved.program.source.text.get(instr.span.range())?;
    let operands = instr.operands.iter();
    Some(Origin {
        step,
        text: text.split_whitespace().collect::<Vec<_>>().join(" "),
        indexed: operands.filter_map(|o| indexed(&o.kind)).collect(),
    })
}
