//! Devices that a program uses, for displays.

use super::Code;
use crate::accesses;
use crate::resolve::resolve;
use rungc_catalogue::Shape;
use rungc_models::Model;
use rungc_syntax::{Device, DeviceClass, Program};
use std::collections::BTreeMap;

/// Type of a device's value, as the instructions that name it use it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Holds {
    /// A bit, or a 16-bit value.
    Single,
    /// The low half of a 32-bit integer.
    Double,
    /// The low half of a float.
    Float,
}

/// Use of a device by a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Use {
    /// True if an instruction reads it.
    pub read: bool,
    /// True if an instruction writes it.
    pub written: bool,
    /// Type of its value.
    pub holds: Holds,
}

/// A longer run of devices that one operand names is not listed to its end.
const RUN: u32 = 16;

/// The devices that a program names, without those that only an index leads to. Of a 32-bit value it is the first.
pub fn uses(program: &Program, model: &'static Model) -> BTreeMap<Device, Use> {
    let (resolved, _) = resolve(program, model);
    let code = Code::new(&resolved);
    let mut uses = BTreeMap::new();
    for i in 0..code.len {
        let operands = &code.instr(i).operands;
        for access in accesses::of(code.resolved, i) {
            let place = operands.iter().position(|o| o.span == access.span);
            let param = place.and_then(|place| code.params(i).get(place));
            let is_float = param.is_some_and(|param| param.shape == Shape::Float);
            let is_bit = matches!(
                access.first.class,
                DeviceClass::X | DeviceClass::Y | DeviceClass::M | DeviceClass::S
            );
            let (holds, step) = match access.each {
                2 if !is_bit && is_float => (Holds::Float, 2),
                2 if !is_bit => (Holds::Double, 2),
                _ => (Holds::Single, 1),
            };
            let Some(count) = access.count else { continue };
            let numbers = (0..count.min(RUN)).step_by(step);
            for number in numbers.map(|n| access.first.number.saturating_add(n)) {
                let device = Device {
                    number,
                    ..access.first
                };
                let entry = uses.entry(device).or_insert(Use {
                    read: false,
                    written: false,
                    holds,
                });
                entry.read |= access.reads();
                entry.written |= access.writes();
                entry.holds = entry.holds.max(holds);
            }
        }
    }
    uses
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_models::ModelId;

    #[test]
    fn devices_are_used_as_their_instructions_say() {
        let list = "LD X0\nOUT Y0\nMOV D0 K2Y10\nDMOV D2 D4\nDEADD D6 D8 D10\nFMOV K5 D20 K2\nMOV D30Z0 D31\nEND\n";
        let read = rungc_frontend::read_text("a.il", list);
        let uses = uses(&read.program, Model::get(ModelId::Fx3u));
        let of = |name: &str| {
            let (_, u) = uses.iter().find(|(d, _)| d.to_string() == name)?;
            Some((u.read, u.written, u.holds))
        };
        assert_eq!(of("X000"), Some((true, false, Holds::Single)));
        assert_eq!(of("Y000"), Some((false, true, Holds::Single)));
        assert_eq!(of("Y017"), Some((false, true, Holds::Single)));
        assert_eq!(of("D4"), Some((false, true, Holds::Double)));
        assert_eq!(of("D5"), None);
        assert_eq!(of("D10"), Some((false, true, Holds::Float)));
        assert_eq!(of("D21"), Some((false, true, Holds::Single)));
        assert_eq!(of("D0"), Some((true, false, Holds::Single)));
        assert_eq!(of("D30"), None, "where an index leads is not known");
    }
}
