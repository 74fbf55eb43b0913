//! Instructions that change their own operand, driven by something that stays on for many scans.

use super::Code;
use super::drives::{Drive, Drives, Lasts};
use super::skips::Skips;
use super::structure::{NONE, Nesting, Routine};
use crate::accesses::{self, Access};
use rungc_catalogue::{ArithOp, Form, Forms, Lower};
use rungc_syntax::{Device, Diagnostic, Diagnostics, Fix, Operand, codes};
use std::collections::BTreeMap;

/// Instructions whose result depends on what they have done before, whatever their operands are.
const STEPPING: &[&str] = &[
    "ALT", "NEG", "SWAP", "XCH", "ROR", "ROL", "RCR", "RCL", "SFTR", "SFTL", "WSFR", "WSFL",
    "SFWR", "SFRD", "SFR", "SFL", "POP",
];

/// Collects such instructions.
#[derive(Default)]
pub(super) struct EveryScan {
    /// By what is changed.
    found: BTreeMap<Device, Vec<Change>>,
}

/// An instruction that changes its own operand.
struct Change {
    at: usize,
    /// Number of devices that it changes.
    count: u32,
    drive: Drive,
}

impl EveryScan {
    /// Takes instruction `i` and what drives it.
    pub(super) fn note(
        &mut self,
        code: &Code,
        i: usize,
        drive: Drive,
        nesting: &Nesting,
        skips: &Skips,
    ) {
        let enclosing = nesting.of(i);
        // Code that a loop, a routine, a state or a jump runs occasionally may be intended.
        let each_scan = enclosing.routine == Routine::Main
            && (enclosing.inner_loop, enclosing.state) == (NONE, NONE)
            && skips.mark(i) == 0;
        if drive.lasts != Lasts::Long || !each_scan || pulse_form(code, i).is_none() {
            return;
        }
        let Some(operand) = changed(code, i) else {
            return;
        };
        let access = accesses::of(code.resolved, i).find(|access| access.span == operand.span);
        if let Some((access, count)) = access.and_then(|access| Some((access, access.count?))) {
            let change = Change {
                at: i,
                count: count.max(1),
                drive,
            };
            self.found.entry(access.first).or_default().push(change);
        }
    }

    /// Warns of each device that is changed in every scan.
    pub(super) fn report(mut self, code: &Code, out: &mut Diagnostics) {
        self.leave_out_computed(code);
        let mut found: Vec<_> = self.found.into_iter().collect();
        found.sort_by_key(|(_, changes)| changes.first().map(|change| change.at));
        for (device, changes) in &found {
            out.extend(report(code, *device, changes));
        }
    }

    /// Removes the devices that another instruction writes anew whenever they are changed: their value is the result of
    /// both.
    fn leave_out_computed(&mut self, code: &Code) {
        let counts = self.found.values().flatten().map(|change| change.count);
        let Some(longest) = counts.max() else {
            return;
        };
        let mut drives = Drives::default();
        for i in 0..code.len {
            let Some(drive) = drives.next(code, i) else {
                continue;
            };
            for access in accesses::of(code.resolved, i).filter(Access::writes) {
                let computed = self.computed(i, drive, &access, longest);
                for device in computed {
                    self.found.remove(&device);
                }
            }
        }
    }

    /// The changed devices that an access of instruction `i` writes whenever they are changed.
    fn computed(&self, i: usize, drive: Drive, access: &Access, longest: u32) -> Vec<Device> {
        let Some(count) = access.count.filter(|&count| count > 0) else {
            return Vec::new();
        };
        let (class, number) = (access.first.class, access.first.number);
        let first = number.saturating_sub(longest - 1);
        let last = number.saturating_add(count - 1);
        let near = self.found.range(
            Device {
                class,
                number: first,
            }..=Device {
                class,
                number: last,
            },
        );
        let written = |device: &Device, change: &Change| {
            let together = drive.lasts == Lasts::Always || drive == change.drive;
            together && device.number.saturating_add(change.count) > number
        };
        near.filter(|(device, changes)| {
            let own = changes.iter().any(|change| change.at == i);
            !own && changes.iter().any(|change| written(device, change))
        })
        .map(|(device, _)| *device)
        .collect()
    }
}

/// The operand that an instruction changes on from what it is.
fn changed<'a>(code: &Code<'a>, i: usize) -> Option<&'a Operand> {
    let inst = code.inst(i)?;
    let operands = &code.instr(i).operands;
    let own = |at: usize| {
        let sources = operands.get(..at)?;
        let own = operands.get(at)?;
        sources
            .iter()
            .any(|source| source.kind == own.kind)
            .then_some(own)
    };
    match code.lower(i)? {
        Lower::Arith(op) | Lower::ArithSaturating(op) => match op {
            ArithOp::Inc | ArithOp::Dec | ArithOp::Neg => operands.first(),
            ArithOp::Add | ArithOp::Sub | ArithOp::Mul | ArithOp::Div | ArithOp::Xor => own(2),
            ArithOp::And | ArithOp::Or => None,
        },
        Lower::MoveNot => own(1),
        _ if STEPPING.contains(&inst.name) => {
            let shifted = matches!(inst.name, "SFTR" | "SFTL" | "WSFR" | "WSFL" | "SFWR");
            operands.get(usize::from(shifted))
        }
        _ => None,
    }
}

/// The spelling of an instruction's pulse form, if it is not written in it and the model has it.
fn pulse_form(code: &Code, i: usize) -> Option<String> {
    let inst = code.inst(i)?;
    let form = code.resolved.instrs[i].form;
    let has = inst.forms_on(code.model().id).has(Forms::PULSE);
    (has && !form.pulse).then(|| {
        inst.spelling_of(Form {
            pulse: true,
            ..form
        })
    })?
}

fn report(code: &Code, device: Device, changes: &[Change]) -> Option<Diagnostic> {
    let (first, others) = changes.split_first()?;
    let mnemonic = &code.instr(first.at).mnemonic;
    let pulse = pulse_form(code, first.at)?;
    let message =
        format!("`{mnemonic}` changes `{device}` in every scan while its contacts are closed");
    let mut diagnostic = codes::EVERY_SCAN
        .at(code.span(first.at), message)
        .label("runs in every scan")
        .help(format!("`{pulse}` runs once each time its contacts close"));
    let mut fix = Fix::suggested("write the pulse form");
    for change in changes {
        if let Some(pulse) = pulse_form(code, change.at) {
            fix = fix.replace(code.instr(change.at).mnemonic_span, pulse);
        }
    }
    for change in others {
        diagnostic = diagnostic.other(code.span(change.at), "so does this");
    }
    Some(diagnostic.fix(fix))
}
