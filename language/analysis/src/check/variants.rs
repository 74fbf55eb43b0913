//! Features missing from a variant or base unit of a PLC.

use super::Code;
use crate::resolve::Resolved;
use rungc_catalogue::Param;
use rungc_models::{Model, Variant};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, Phrase, Span, codes, phrase};
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
            let message = phrase!(
                "{variant} does not have `{inst}`",
                variant = variant.title,
                inst = inst.name
            );
            out.push(codes::NOT_ON_VARIANT.at(at, message).help(help(variant)));
        }
        devices(&code, i, variant, &mut beyond, &mut out);
    }
    out
}

/// Help for the user.
fn help(variant: &Variant) -> Phrase {
    let family = Model::get(variant.model).name;
    phrase!("`{family}` stands for all PLCs of the family", family)
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
        let param = code.params(i).get(n);
        if let Some(found) = param.and_then(|param| pulses(param, device, variant, operand.span)) {
            out.push(found);
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
            let message = phrase!(
                "`{device}` is not on {variant}",
                device,
                variant = variant.title
            );
            let found = codes::BEYOND_BASE_UNIT.at(operand.span, message);
            out.push(found.help(phrase!(
                "its last one is {last}; an extension module has others",
                last
            )));
        }
    }
    if let Some(label) = code.label(i) {
        lacking(variant, label, code.span(i), out);
    }
}

/// An output of pulses or of their direction that the variant does not have there.
fn pulses(param: &Param, device: Device, variant: &Variant, at: Span) -> Option<Diagnostic> {
    if device.class != DeviceClass::Y {
        return None;
    }
    let title = variant.title;
    let (message, help) = if param.sends_pulses && device.number >= variant.pulse_outputs {
        let last = DeviceClass::Y.number(variant.pulse_outputs - 1);
        (
            phrase!("{title} sends no pulses at `{device}`", title, device),
            phrase!("its pulse outputs are Y000 to {last}", last),
        )
    } else if param.directs_pulses && device.number < variant.no_direction {
        let first = DeviceClass::Y.number(variant.no_direction);
        (
            phrase!(
                "`{device}` of {title} cannot give the direction of pulses",
                device,
                title
            ),
            phrase!("use an output from {first} on", first),
        )
    } else {
        return None;
    };
    let found = codes::NO_DEVICE_ON_VARIANT.at(at, message);
    Some(found.help(help))
}

/// Reports a device that the variant does not have.
fn lacking(variant: &Variant, device: Device, span: Span, out: &mut Diagnostics) {
    if !variant.has(device.class, device.number) {
        let message = phrase!(
            "{variant} does not have `{device}`",
            variant = variant.title,
            device
        );
        out.push(
            codes::NO_DEVICE_ON_VARIANT
                .at(span, message)
                .help(help(variant)),
        );
    }
}
