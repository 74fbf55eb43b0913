//! Lookup of devices by number at run time.

use crate::storage::{Field, Storage};
use rungc_ir::Module;
use rungc_syntax::DeviceClass;

/// The runtime's order of classes, in which it searches: as the values of its enum. `None`: it has no such devices.
fn rank(class: DeviceClass) -> Option<usize> {
    use DeviceClass::*;
    let order = [X, Y, M, S, T, C, D, R, V, Z, ER];
    order.iter().position(|&c| c == class)
}

/// Devices of consecutive numbers that are side by side in the struct.
#[derive(Clone, Copy, Debug)]
pub struct Area<'a> {
    /// The field that they begin with.
    pub field: &'a Field,
    /// Number of devices.
    pub count: u32,
}

/// The areas of a program, in the runtime's order: arrays, and relays or words that follow each other.
pub fn areas<'a>(storage: &'a Storage<'_>) -> Vec<Area<'a>> {
    let mut order: Vec<(usize, &Field)> = storage.in_sections().into_iter().enumerate().collect();
    order.sort_by_key(|(_, f)| (rank(f.class), f.first));
    let mut areas: Vec<(usize, Area)> = Vec::new();
    for (place, field) in order {
        match areas.last_mut() {
            // Elements of one type that follow each other in the struct have no gap between them.
            Some((
                last,
                Area {
                    field: first,
                    count,
                },
            )) if *last + 1 == place
                && first.class == field.class
                && first.kind == field.kind
                && first.grid.is_none()
                && field.grid.is_none()
                && first.first + *count == field.first =>
            {
                *last = place;
                *count += field.count;
            }
            _ => areas.push((
                place,
                Area {
                    field,
                    count: field.count,
                },
            )),
        }
    }
    areas.into_iter().map(|(_, area)| area).collect()
}

/// Number of the area that holds a device, as operands give it ([`rungc_rt::Operand::area`]): counted from the last,
/// which is 1. `None`: no area holds it, or one too far from the last to be represented.
pub fn named(areas: &[Area], class: DeviceClass, number: u32) -> Option<u8> {
    let after = areas.partition_point(|area| {
        (rank(area.field.class), area.field.first) <= (rank(class), number)
    });
    let index = after.checked_sub(1)?;
    let area = areas.get(index)?;
    let holds = area.field.class == class && number - area.field.first < area.count;
    u8::try_from(areas.len() - index).ok().filter(|_| holds)
}

/// The model's devices in the runtime's order, neighbouring ranges joined: class, first and last number.
pub fn ranges(module: &Module) -> Vec<(DeviceClass, u32, u32)> {
    let ranges = module.model.ranges.iter();
    let mut sorted: Vec<_> = ranges.filter(|r| rank(r.class).is_some()).collect();
    sorted.sort_by_key(|r| (rank(r.class), r.first));
    let mut joined: Vec<(DeviceClass, u32, u32)> = Vec::new();
    for range in sorted {
        match joined.last_mut() {
            Some((class, _, last)) if *class == range.class && *last + 1 == range.first => {
                *last = range.last;
            }
            _ => joined.push((range.class, range.first, range.last)),
        }
    }
    joined
}
