//! Instructions that change their own operand, driven by something that stays on for many scans.

use super::Code;
use super::drives::{Drive, Drives, Lasts};
use super::skips::Skips;
use super::structure::{NONE, Nesting, Routine};
use crate::accesses::{self, Access};
use rungc_catalogue::{Form, Forms, Neutral, Repeat, Shape};
use rungc_syntax::{Device, Diagnostic, Diagnostics, Fix, Operand, OperandKind, codes, phrase};
use std::collections::BTreeMap;

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
        if let Some(access) = changed(code, i).filter(|access| !access.indexed) {
            let change = Change {
                at: i,
                count: access.count.unwrap_or(1).max(1),
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

/// The operand that an instruction changes again each time it runs.
fn changed(code: &Code, i: usize) -> Option<Access> {
    let inst = code.inst(i)?;
    let access = |n: usize| accesses::at(code.resolved, i, n);
    if let Repeat::Changes(n) = inst.repeat {
        return access(n);
    }
    if has_neutral(code, i, inst.neutral) {
        return None;
    }
    let count = code.instr(i).operands.len();
    let results = (0..count).rev().filter_map(|n| Some((n, access(n)?)));
    let mut results = results.filter(|(_, access)| access.writes());
    let (_, result) = results.find(|(at, result)| {
        let sources = (0..count)
            .filter(|n| n != at)
            .filter_map(|n| Some((n, access(n)?)));
        let mut sources = sources.filter(|(_, access)| access.reads());
        sources.any(|(n, source)| feeds(code, i, (n, &source), (*at, result)))
    })?;
    Some(result)
}

/// Returns true if a constant of the instruction leaves the other source as it is.
fn has_neutral(code: &Code, i: usize, neutral: Neutral) -> bool {
    let operands = &code.instr(i).operands;
    let is_neutral = |operand: &Operand| match operand.kind {
        OperandKind::Float(value) => f64::from(value) == neutral.value as f64,
        ref kind => kind.constant() == Some(neutral.value),
    };
    let mut constants = neutral.operands.iter().filter_map(|&n| operands.get(n));
    constants.any(is_neutral)
}

/// Returns true if the result of an instruction, each with its position, differs the next time because it has changed a
/// source.
fn feeds(code: &Code, i: usize, source: (usize, &Access), result: (usize, &Access)) -> bool {
    let ((n, source), (at, result)) = (source, result);
    if source.first.class != result.first.class || source.indexed || result.indexed {
        return false;
    }
    let same = source.first == result.first;
    let is_text = [n, at].map(|n| code.params(i)[n].shape == Shape::Text) != [false; 2];
    let reaches = |one: &Access, other: &Access| {
        let from = one.first.number;
        let until = one.count.map(|count| from.saturating_add(count));
        let known = until.filter(|_| !is_text);
        from == other.first.number
            || known.is_some_and(|until| (from..until).contains(&other.first.number))
    };
    let overlap = reaches(source, result) || reaches(result, source);
    match code.inst(i).map(|inst| inst.repeat) {
        Some(Repeat::Overlapping) => overlap,
        Some(Repeat::OverlappingWide) => overlap && code.wide(i),
        Some(Repeat::Replacing) => same,
        Some(Repeat::Shifting) => overlap && !same,
        Some(Repeat::Digits) => same && shifts_digits(code, i),
        Some(Repeat::Same | Repeat::Changes(_)) | None => false,
    }
}

/// Returns true if SMOV writes digits of a word to other digits of it that it takes too.
fn shifts_digits(code: &Code, i: usize) -> bool {
    let operands = &code.instr(i).operands;
    let constant = |n: usize| operands.get(n)?.kind.constant();
    match (constant(1), constant(2), constant(4)) {
        (Some(from), Some(count), Some(to)) => from != to && (from - to).abs() < count,
        _ => false,
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
    let message = phrase!(
        "`{mnemonic}` changes `{device}` in every scan while its contacts are closed",
        mnemonic,
        device
    );
    let mut diagnostic = codes::EVERY_SCAN
        .at(code.span(first.at), message)
        .label("runs in every scan")
        .help(phrase!(
            "`{pulse}` runs once each time its contacts close",
            pulse
        ));
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
