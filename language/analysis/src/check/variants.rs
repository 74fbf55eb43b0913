//! Features missing from a variant or base unit of a PLC.

use super::Code;
use crate::resolve::Resolved;
use rungc_models::{Model, Variant};
use rungc_syntax::{Device, DeviceClass, Diagnostics, codes};
use std::collections::BTreeSet;

/// Holds a program to a variant of its model.
pub fn check(resolved: &Resolved, variant: &Variant) -> Diagnostics {
    let code = Code::new(resolved);
    let mut out = Diagnostics::new();
    let mut beyond = BTreeSet::new();
    for i in 0..code.len {
        if code.is_meant(i) {
            continue;
        }
        if let Some(inst) = code.inst(i)
            && !variant.has_instruction(inst.name)
        {
            let at = code.instr(i).mnemonic_span;
            let message = format!("{} does not have `{}`", variant.title, inst.name);
            out.push(codes::NOT_ON_VARIANT.at(at, message).help(help(variant)));
        }
        devices(&code, i, variant, &mut beyond, &mut out);
    }
    out
}

/// Help for the user.
fn help(variant: &Variant) -> String {
    let family = Model::get(variant.model).name;
    format!("`{family}` stands for all PLCs of the family")
}

/// The devices that instruction `i` names; `beyond` holds terminals that were reported.
fn devices(
    code: &Code,
    i: usize,
    variant: &Variant,
    beyond: &mut BTreeSet<Device>,
    out: &mut Diagnostics,
) {
    let operands = code.instr(i).operands.iter().enumerate();
    for (n, operand) in operands {
        let Some(device) = code.device(i, n) else {
            continue;
        };
        let sends = code
            .params(i)
            .get(n)
            .is_some_and(|param| param.sends_pulses);
        if sends && device.class == DeviceClass::Y && device.number >= variant.pulse_outputs {
            let last = DeviceClass::Y.number(variant.pulse_outputs - 1);
            let message = format!("{} sends no pulses at `{device}`", variant.title);
            let found = codes::NO_DEVICE_ON_VARIANT.at(operand.span, message);
            out.push(found.help(format!("its pulse outputs are Y000 to {last}")));
            continue;
        }
        lacking(variant, device, operand.span, out);
        let terminals = match device.class {
            DeviceClass::X => variant.inputs,
            DeviceClass::Y => variant.outputs,
            _ => None,
        };
        let Some(terminals) = terminals.filter(|&count| device.number >= count) else {
            continue;
        };
        if beyond.insert(device) {
            let last = device.class.number(terminals - 1);
            let message = format!("`{device}` is not on {}", variant.title);
            let found = codes::BEYOND_BASE_UNIT.at(operand.span, message);
            out.push(found.help(format!(
                "its last one is {last}; an extension module has others"
            )));
        }
    }
    if let Some(label) = code.label(i) {
        lacking(variant, label, code.span(i), out);
    }
}

/// Reports a device that the variant does not have.
fn lacking(variant: &Variant, device: Device, span: rungc_syntax::Span, out: &mut Diagnostics) {
    if !variant.has(device.class, device.number) {
        let message = format!("{} does not have `{device}`", variant.title);
        out.push(
            codes::NO_DEVICE_ON_VARIANT
                .at(span, message)
                .help(help(variant)),
        );
    }
}
