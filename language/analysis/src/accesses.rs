//! Devices that each instruction reads and writes.

use crate::resolve::Resolved;
use rungc_catalogue::{Comparison, Extent, Lower, Param, Role, Shape};
use rungc_models::high_speed::zone_table;
use rungc_syntax::{Classes, Device, DeviceClass, Operand, OperandKind, Span};
use std::ops::RangeInclusive;

/// One operand's access to a run of devices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Access {
    /// The first device.
    pub(crate) first: Device,
    /// Maximum number of devices; `None` if only the run decides, so that any device of the class may be meant.
    pub(crate) count: Option<u32>,
    /// Number of devices that it takes with any settings.
    pub(crate) least: Option<u32>,
    /// Number of devices per value: 2 for a 32-bit value in registers.
    pub(crate) each: u32,
    /// Kind of access.
    pub(crate) role: Role,
    /// True if an index register selects the devices.
    pub(crate) indexed: bool,
    /// Position of the operand.
    pub(crate) span: Span,
}

impl Access {
    /// To one device, whatever is done with it.
    pub(crate) fn whole(first: Device) -> Self {
        Access {
            first,
            count: Some(1),
            least: Some(1),
            each: 1,
            role: Role::ReadWrite,
            indexed: false,
            span: Span::default(),
        }
    }

    /// The devices; all from the first where their number is unknown.
    pub(crate) fn devices(&self) -> RangeInclusive<Device> {
        let count = self.count.unwrap_or(u32::MAX);
        let last = self.first.number.saturating_add(count.saturating_sub(1));
        let last = Device {
            number: last,
            ..self.first
        };
        self.first..=last
    }

    pub(crate) fn reads(&self) -> bool {
        matches!(self.role, Role::Read | Role::ReadWrite)
    }

    pub(crate) fn writes(&self) -> bool {
        matches!(self.role, Role::Write | Role::ReadWrite)
    }
}

/// The accesses of instruction `i` by its operands, without operands that do not belong there. An instruction that
/// could not be understood has none.
pub(crate) fn of(resolved: &Resolved, i: usize) -> impl Iterator<Item = Access> {
    let count = resolved.program.instrs[i].operands.len();
    (0..count).filter_map(move |n| at(resolved, i, n))
}

/// The access of instruction `i` by operand `n`, if it belongs there.
pub(crate) fn at(resolved: &Resolved, i: usize, n: usize) -> Option<Access> {
    let operands = &resolved.program.instrs[i].operands;
    let resolution = resolved.instrs[i];
    let (operand, param) = (operands.get(n)?, resolution.params.get(n)?);
    let fits = !resolution.meant
        && param.shape != Shape::Pointer
        && param.classes.meets(Classes::of(&operand.kind));
    let access = fits.then(|| access(operands, operand, param, resolution.form.wide))??;
    Some(match resolution.lower {
        Some(Lower::HighSpeed(Comparison::Zone)) => of_zone(access),
        _ => access,
    })
}

/// An access of HSZ. A relay that selects a table is itself meant, not the two after it.
fn of_zone(access: Access) -> Access {
    match zone_table(access.first) {
        Some(_) => Access {
            count: Some(1),
            least: Some(1),
            ..access
        },
        None => access,
    }
}

fn access(operands: &[Operand], operand: &Operand, param: &Param, wide: bool) -> Option<Access> {
    let (first, digits, indexed) = match operand.kind {
        OperandKind::Device(device, index) => (device, None, index.is_some()),
        OperandKind::Nibbles(digits, device, index) => (device, Some(digits), index.is_some()),
        OperandKind::WordBit(device, _, index) => (device, None, index.is_some()),
        _ => return None,
    };
    let word = matches!(
        first.class,
        DeviceClass::D | DeviceClass::R | DeviceClass::ER
    );
    let pair = is_pair(param, wide);
    let each = match digits {
        Some(digits) => 4 * u32::from(digits),
        None if pair && word => 2,
        None => 1,
    };
    let values = values(operands, operand, param).filter(|_| !indexed);
    let count = values.map(|values| values.saturating_mul(each));
    let least = match param.extent {
        Extent::Between { least, .. } => count.map(|_| least.saturating_mul(each)),
        _ => count,
    };
    Some(Access {
        first,
        count,
        least,
        each,
        role: param.role,
        indexed,
        span: operand.span,
    })
}

/// Number of words of buffer memory that an operand of instruction `i` takes, if known.
pub(crate) fn buffer_words(resolved: &Resolved, i: usize, n: usize) -> Option<u32> {
    let operands = &resolved.program.instrs[i].operands;
    let resolution = resolved.instrs[i];
    let (operand, param) = (operands.get(n)?, resolution.params.get(n)?);
    let each = if is_pair(param, resolution.form.wide) {
        2
    } else {
        1
    };
    Some(values(operands, operand, param)?.saturating_mul(each))
}

/// Returns true if a value of a parameter takes two words.
fn is_pair(param: &Param, wide: bool) -> bool {
    match param.shape {
        Shape::Value => wide,
        Shape::Pair | Shape::Float => true,
        Shape::Bit | Shape::Word | Shape::Text | Shape::Pointer | Shape::Mixed => false,
    }
}

/// Number of values of an operand, if known.
fn values(operands: &[Operand], operand: &Operand, param: &Param) -> Option<u32> {
    let constant = |operand: &Operand| operand.kind.constant();
    match param.extent_of(&operand.kind) {
        Extent::One => Some(1),
        Extent::Count(count) | Extent::Between { most: count, .. } => Some(count),
        Extent::Operand { i, extra } => {
            let count = constant(operands.get(i)?)?.checked_add(i64::from(extra))?;
            u32::try_from(count).ok()
        }
        Extent::Of(count) | Extent::Bits(count) => {
            let constants: Vec<_> = operands.iter().map(constant).collect();
            count(&constants)
        }
        Extent::Through(last) => {
            let last = device(operands.get(last)?)?;
            let first = device(operand)?;
            let further = last.number.saturating_sub(first.number);
            (first.class == last.class).then(|| further.saturating_add(1))
        }
    }
}

fn device(operand: &Operand) -> Option<Device> {
    match operand.kind {
        OperandKind::Device(device, None) | OperandKind::Nibbles(_, device, None) => Some(device),
        _ => None,
    }
}
