//! Instructions that use each device, and the kind of use.

use crate::accesses::{self, Access};
use crate::resolve::Resolved;
use rungc_catalogue::{Basic, Role, Shape};
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_syntax::{Device, DeviceClass, OperandKind};
use std::collections::{BTreeMap, BTreeSet};

/// Use of a device by an instruction.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum UseKind {
    /// A contact.
    Contact,
    /// A coil: OUT, PLS, PLF.
    Coil,
    /// SET.
    Set,
    /// RST.
    Reset,
    /// Its value is read.
    Read,
    /// Its value is written.
    Write,
    /// Its value is read and written.
    Change,
    /// A label, or the start of an interrupt routine.
    Label,
    /// A jump or call to the label.
    Jump,
    /// A nesting level.
    Level,
    /// It is named by an instruction that has no meaning here, which the check reports.
    Unclear,
}

impl UseKind {
    /// A word for it.
    pub fn word(self) -> &'static str {
        match self {
            UseKind::Contact => "contact",
            UseKind::Coil => "coil",
            UseKind::Set => "set",
            UseKind::Reset => "reset",
            UseKind::Read => "read",
            UseKind::Write => "write",
            UseKind::Change => "change",
            UseKind::Label => "label",
            UseKind::Jump => "jump",
            UseKind::Level => "level",
            UseKind::Unclear => "unclear",
        }
    }
}

/// Range of a use from its first device on.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Reach {
    /// This many devices.
    Count(u32),
    /// From the first on, as many as a register says when the program runs.
    Open,
    /// An index register decides which devices.
    Indexed,
}

/// One use of devices.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Use {
    /// Position of the instruction in the program.
    pub instr: usize,
    /// The first device.
    pub first: Device,
    /// Number of devices.
    pub reach: Reach,
    /// Kind of use.
    pub kind: UseKind,
}

impl Use {
    /// The number after the last device that it certainly concerns.
    pub fn end(&self) -> u32 {
        let count = match self.reach {
            Reach::Count(count) => count.max(1),
            Reach::Open | Reach::Indexed => 1,
        };
        self.first.number.saturating_add(count)
    }

    /// Returns true if it writes the device, or may: by an index, or by a number of devices that a register holds.
    pub fn may_write(&self, device: Device) -> bool {
        use UseKind::{Change, Coil, Reset, Set, Write};
        matches!(self.kind, Coil | Set | Reset | Write | Change) && self.may_concern(device)
    }

    /// Returns true if it concerns the device, or may.
    pub fn may_concern(&self, device: Device) -> bool {
        let begins = self.first.number <= device.number;
        let meets = match self.reach {
            Reach::Count(_) => begins && device.number < self.end(),
            Reach::Open => begins,
            Reach::Indexed => true,
        };
        self.first.class == device.class && meets
    }
}

/// Devices that the same uses concern.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Row {
    /// The first.
    pub first: Device,
    /// The last, of the same class.
    pub last: Device,
    /// Positions in [`CrossReference::uses`], in the order of the program.
    pub uses: Vec<usize>,
}

/// The uses of all devices of a program.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct CrossReference {
    /// All uses, in the order of the program.
    pub uses: Vec<Use>,
    /// The devices, by class and number; devices next to each other with the same uses share a row.
    pub rows: Vec<Row>,
}

impl CrossReference {
    /// The uses of the devices that a program names, also after its END.
    pub fn new(resolved: &Resolved) -> CrossReference {
        let count = resolved.program.instrs.len();
        let mut uses: Vec<Use> = (0..count).flat_map(|i| uses_of(resolved, i)).collect();
        let mut seen = BTreeSet::new();
        uses.retain(|one| seen.insert(*one));
        let rows = rows(&uses);
        CrossReference { uses, rows }
    }

    /// General devices of the model that no instruction names, of each class that the program uses, as first and last.
    /// Devices that only an index may reach count as unused.
    pub fn unused(&self, model: &Model) -> Vec<(Device, Device)> {
        const CLASSES: [DeviceClass; 7] = {
            use DeviceClass::*;
            [M, S, T, C, D, R, ER]
        };
        let mut unused = Vec::new();
        for class in CLASSES {
            let used = || self.rows.iter().filter(|row| row.first.class == class);
            if used().next().is_none() {
                continue;
            }
            let device = |number| Device { class, number };
            for (first, last) in model.runs(class) {
                if is_special(class, first) {
                    continue;
                }
                let mut next = first;
                let within = |row: &&Row| row.last.number >= first && row.first.number <= last;
                for row in used().filter(within) {
                    if row.first.number > next {
                        unused.push((device(next), device(row.first.number - 1)));
                    }
                    next = row.last.number.saturating_add(1);
                }
                if next <= last {
                    unused.push((device(next), device(last)));
                }
            }
        }
        unused
    }

    /// Areas that share some of their devices, neither within the other, as positions in `uses`: each with the nearest
    /// before it.
    pub fn overlaps(&self) -> Vec<(usize, usize)> {
        let mut areas: BTreeMap<(DeviceClass, u32, u32), usize> = BTreeMap::new();
        for (i, one) in self.uses.iter().enumerate() {
            if matches!(one.reach, Reach::Count(2..)) {
                // Wide areas first among those that begin together.
                let key = (one.first.class, one.first.number, u32::MAX - one.end());
                areas.entry(key).or_insert(i);
            }
        }
        let mut found = Vec::new();
        let mut open: Vec<usize> = Vec::new();
        for i in areas.into_values() {
            let area = self.uses[i];
            open.retain(|&other| {
                let other = self.uses[other];
                other.first.class == area.first.class && other.end() > area.first.number
            });
            let crossing = open.iter().rev().find(|&&other| {
                let other = self.uses[other];
                other.first.number < area.first.number && other.end() < area.end()
            });
            found.extend(crossing.map(|&other| (other, i)));
            open.push(i);
        }
        found
    }
}

/// The uses of instruction `i`.
fn uses_of(resolved: &Resolved, i: usize) -> Vec<Use> {
    let resolution = resolved.instrs[i];
    let operands = &resolved.program.instrs[i].operands;
    let one = |first: Device, kind: UseKind| Use {
        instr: i,
        first,
        reach: Reach::Count(1),
        kind,
    };
    let mut uses = Vec::new();
    uses.extend(resolution.label.map(|label| one(label, UseKind::Label)));
    if resolution.inst.is_none() || resolution.meant {
        let named = operands.iter().filter_map(|operand| named(&operand.kind));
        uses.extend(named.map(|device| one(device, UseKind::Unclear)));
        return uses;
    }
    let accesses = accesses::of(resolved, i).map(|access| Use {
        instr: i,
        first: access.first,
        reach: match access.count {
            Some(count) => Reach::Count(count),
            None if access.indexed => Reach::Indexed,
            None => Reach::Open,
        },
        kind: kind(resolution.basic(), &access),
    });
    uses.extend(accesses);
    for (operand, param) in operands.iter().zip(resolution.params) {
        if param.shape == Shape::Pointer {
            uses.extend(named(&operand.kind).map(|device| match device.class {
                DeviceClass::N => one(device, UseKind::Level),
                _ => one(device, UseKind::Jump),
            }));
        }
    }
    // The pair (Vn, Zn) in a 32-bit instruction, named by its Z.
    let is_pair = resolution.form.wide && resolved.model.z_pairs_with_v;
    for register in operands.iter().filter_map(|operand| index(&operand.kind)) {
        uses.push(one(register, UseKind::Read));
        if is_pair && register.class == DeviceClass::Z {
            let class = DeviceClass::V;
            uses.push(one(Device { class, ..register }, UseKind::Read));
        }
    }
    without_parts(uses)
}

/// Uses without those that are part of another one of the same kind: `ZRST D0 D9` names D9 within D0 to D9.
fn without_parts(uses: Vec<Use>) -> Vec<Use> {
    let is_part = |part: &Use| {
        uses.iter().any(|whole| {
            let within = whole.first.class == part.first.class
                && whole.first.number <= part.first.number
                && part.end() <= whole.end();
            let counted = |one: &Use| matches!(one.reach, Reach::Count(_));
            whole.kind == part.kind && within && whole != part && counted(whole) && counted(part)
        })
    };
    uses.iter().filter(|one| !is_part(one)).copied().collect()
}

fn kind(basic: Option<Basic>, access: &Access) -> UseKind {
    match (basic, access.role) {
        (Some(Basic::Out | Basic::Pls | Basic::Plf | Basic::Mc), Role::Write | Role::ReadWrite) => {
            UseKind::Coil
        }
        (Some(Basic::Set), Role::Write | Role::ReadWrite) => UseKind::Set,
        (Some(Basic::Rst), Role::Write | Role::ReadWrite) => UseKind::Reset,
        // The preset of a timer is read as a value.
        (Some(Basic::Out), Role::Read) => UseKind::Read,
        (Some(_), Role::Read) => UseKind::Contact,
        (_, Role::Read) => UseKind::Read,
        (_, Role::Write) => UseKind::Write,
        (_, Role::ReadWrite) => UseKind::Change,
    }
}

/// The device that an operand names.
fn named(kind: &OperandKind) -> Option<Device> {
    match *kind {
        OperandKind::Device(device, _)
        | OperandKind::Nibbles(_, device, _)
        | OperandKind::WordBit(device, ..) => Some(device),
        OperandKind::Unreadable(device) => device,
        _ => None,
    }
}

/// The register that an operand is indexed with.
fn index(kind: &OperandKind) -> Option<Device> {
    let index = match *kind {
        OperandKind::Device(_, index)
        | OperandKind::Nibbles(_, _, index)
        | OperandKind::WordBit(_, _, index)
        | OperandKind::Decimal(_, index)
        | OperandKind::Hex(_, index)
        | OperandKind::Buffer { index, .. } => index?,
        OperandKind::Float(_) | OperandKind::Text(_) | OperandKind::Unreadable(_) => return None,
    };
    Some(Device {
        class: index.class,
        number: index.number,
    })
}

/// Devices and the uses that concern them, by class and number.
fn rows(uses: &[Use]) -> Vec<Row> {
    let mut borders: BTreeMap<(DeviceClass, u32), (Vec<usize>, Vec<usize>)> = BTreeMap::new();
    for (i, one) in uses.iter().enumerate() {
        let class = one.first.class;
        borders
            .entry((class, one.first.number))
            .or_default()
            .0
            .push(i);
        borders.entry((class, one.end())).or_default().1.push(i);
    }
    let mut rows = Vec::new();
    let mut open = BTreeSet::new();
    let mut borders = borders.into_iter().peekable();
    while let Some(((class, number), (begin, end))) = borders.next() {
        for i in end {
            open.remove(&i);
        }
        open.extend(begin);
        // The uses that are open here end at a border of their class.
        if let Some(&((_, next), _)) = borders.peek()
            && !open.is_empty()
        {
            rows.push(Row {
                first: Device { class, number },
                last: Device {
                    class,
                    number: next - 1,
                },
                uses: open.iter().copied().collect(),
            });
        }
    }
    rows
}
