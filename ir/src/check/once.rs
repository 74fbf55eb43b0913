//! Instructions that a program may hold only so often.

use super::Code;
use rungc_syntax::{Device, DeviceClass, Diagnostics, codes};

/// How often an instruction may stand in a program.
struct Limit {
    /// The instruction, by the name of its row.
    inst: &'static str,
    /// Counted are only those whose operand at this position is …
    operand: Option<(usize, Which)>,
    /// How many there may be.
    max: usize,
}

/// Which operands count.
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

const fn limit(inst: &'static str, max: usize) -> Limit {
    let operand = None;
    Limit { inst, operand, max }
}

const fn limit_of(inst: &'static str, position: usize, which: Which, max: usize) -> Limit {
    let operand = Some((position, which));
    Limit { inst, operand, max }
}

/// From the descriptions of the instructions (h1u-h2u-programming §4.3).
const LIMITS: &[Limit] = &[
    limit("ROTC", 1),
    limit("SEGL", 2),
    limit("IST", 1),
    limit_of("HSZ", 3, relay(8130), 1),
    limit_of("HSZ", 3, relay(8132), 1),
    limit_of("HSCS", 2, Which::Each(DeviceClass::I), 1),
];

/// Checks how often instructions stand in a program.
pub(super) fn check(code: &Code, out: &mut Diagnostics) {
    let mut places: Vec<Vec<(usize, Option<Device>)>> = LIMITS.iter().map(|_| Vec::new()).collect();
    for i in 0..code.len {
        let Some(inst) = code.inst(i).filter(|inst| inst.fnc.is_some()) else {
            continue;
        };
        for (limit, places) in LIMITS.iter().zip(&mut places) {
            if limit.inst != inst.name {
                continue;
            }
            let device = limit
                .operand
                .as_ref()
                .and_then(|&(at, _)| code.device(i, at));
            let counts = match &limit.operand {
                None => true,
                Some((_, Which::Exactly(wanted))) => device == Some(*wanted),
                Some((_, Which::Each(class))) => {
                    device.is_some_and(|device| device.class == *class)
                }
            };
            if counts {
                places.push((i, device));
            }
        }
    }
    for (limit, mut places) in LIMITS.iter().zip(places) {
        places.sort_by_key(|&(_, device)| device);
        for same in places.chunk_by(|a, b| a.1 == b.1) {
            report(code, limit, same, out);
        }
    }
}

fn report(code: &Code, limit: &Limit, places: &[(usize, Option<Device>)], out: &mut Diagnostics) {
    let (Some(&(first, _)), Some(&(beyond, device))) = (places.first(), places.get(limit.max))
    else {
        return;
    };
    let with = device.map_or_else(String::new, |device| format!(" with `{device}`"));
    let often = match limit.max {
        1 => "once".to_owned(),
        n => format!("{n} times"),
    };
    let message = format!(
        "`{}`{with} may stand only {often} in a program",
        code.instr(beyond).mnemonic
    );
    let diagnostic = codes::TOO_OFTEN
        .at(code.span(beyond), message)
        .label("one too many")
        .other(code.span(first), "the first one");
    out.push(diagnostic);
}
