//! Instructions that a program may hold only so often: as their rows say, and with some operands.

use super::Code;
use rungc_syntax::{Device, DeviceClass, Diagnostics, codes, phrase};
use std::collections::BTreeMap;

/// An instruction that may occur only once in a program with some operand.
struct Limit {
    /// The instruction, by the name of its row.
    inst: &'static str,
    /// Counted are those whose operand at this position …
    position: usize,
    /// … is this.
    which: Which,
}

/// Selection of the operands that count.
enum Which {
    /// This device.
    Exactly(Device),
    /// Any of this class, each device for itself.
    Each(DeviceClass),
}

const fn relay(number: u32) -> Which {
    let class = DeviceClass::M;
    Which::Exactly(Device { class, number })
}

const fn limit(inst: &'static str, position: usize, which: Which) -> Limit {
    Limit {
        inst,
        position,
        which,
    }
}

/// From the descriptions of the instructions (h1u-h2u-programming §4.3).
const LIMITS: &[Limit] = &[
    limit("HSZ", 3, relay(8130)),
    limit("HSZ", 3, relay(8132)),
    limit("HSCS", 2, Which::Each(DeviceClass::I)),
];

/// Checks how often a program uses instructions.
pub(super) fn check(code: &Code, out: &mut Diagnostics) {
    let mut by_name: BTreeMap<&str, (usize, Vec<usize>)> = BTreeMap::new();
    let mut by_operand: Vec<Vec<(usize, Device)>> = LIMITS.iter().map(|_| Vec::new()).collect();
    for i in 0..code.len {
        let Some(inst) = code.inst(i).filter(|inst| inst.fnc.is_some()) else {
            continue;
        };
        if let Some(max) = inst.max_uses {
            let places = by_name.entry(inst.name).or_default();
            places.0 = max as usize;
            places.1.push(i);
        }
        for (limit, places) in LIMITS.iter().zip(&mut by_operand) {
            if limit.inst != inst.name {
                continue;
            }
            let device = code.device(i, limit.position);
            places.extend(
                device
                    .filter(|one| limit.which.is(*one))
                    .map(|one| (i, one)),
            );
        }
    }
    for (max, places) in by_name.values() {
        report(code, *max, places, None, out);
    }
    for mut places in by_operand {
        places.sort_by_key(|&(_, device)| device);
        for same in places.chunk_by(|a, b| a.1 == b.1) {
            let at: Vec<_> = same.iter().map(|&(i, _)| i).collect();
            report(code, 1, &at, same.first().map(|&(_, device)| device), out);
        }
    }
}

impl Which {
    fn is(&self, device: Device) -> bool {
        match *self {
            Which::Exactly(wanted) => device == wanted,
            Which::Each(class) => device.class == class,
        }
    }
}

fn report(
    code: &Code,
    max: usize,
    places: &[usize],
    device: Option<Device>,
    out: &mut Diagnostics,
) {
    let (Some(&first), Some(&beyond)) = (places.first(), places.get(max)) else {
        return;
    };
    let with = device.map_or_else(|| "".into(), |device| phrase!(" with `{device}`", device));
    let often = match max {
        1 => phrase!("once"),
        n => phrase!("{n} times", n),
    };
    let message = phrase!(
        "`{mnemonic}`{with} may be used only {often} in a program",
        mnemonic = code.instr(beyond).mnemonic,
        with,
        often
    );
    let diagnostic = codes::TOO_OFTEN
        .at(code.span(beyond), message)
        .label("one too many")
        .other(code.span(first), "the first one");
    out.push(diagnostic);
}
