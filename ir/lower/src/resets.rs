//! The reset state of timers and counters.
//!
//! While the RST that was executed last was driven, a timer or counter does not time, count or compare: RST in a
//! routine, or one that a jump skips from then on, holds it (FX3 programming manual 7.13, 8.2.1). Only a device
//! that has both RST and a coil needs a memory of that, and mostly its coil is one already.

use super::operand::Guards;
use super::{Lowerer, basic_of};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::Basic;
use rungc_ir::node::{
    Action, BinOp, Expr, ExprId, FlagId, Module, Place, SetEntry, Table, TableId,
};
use rungc_ir::reset_name;
use rungc_models::{Model, high_speed};
use rungc_rt::CmpOp;
use rungc_syntax::DeviceClass::{self, C, T};
use rungc_syntax::{Device, Index, OperandKind};
use std::collections::BTreeMap;

/// Memory of a reset state.
#[derive(Clone, Copy)]
enum Memory {
    /// The coil of a counter: RST and OUT are executed in turn, so an RST has an effect on one execution of the coil.
    Coil,
    /// The drive of the RST, which a scan executes before each of the coils.
    Drive,
    /// A flag.
    Flag(FlagId),
}

/// The reset states of a program.
#[derive(Default)]
pub(super) struct Resets {
    devices: BTreeMap<(DeviceClass, u32), Memory>,
    /// Entries by number, of a class with an index at an RST or coil.
    tables: BTreeMap<DeviceClass, TableId>,
    /// The entries that are named: the number without the index, and the index.
    pub(super) entries: Vec<Entry>,
    /// Drives of the RSTs that were lowered, of [`Memory::Drive`].
    drives: BTreeMap<(DeviceClass, u32), ExprId>,
}

/// An entry of a table: the number without the index, and the index.
pub(super) type Entry = (TableId, u32, Option<ExprId>);

/// RSTs and coils of one device, or of a class.
#[derive(Default)]
struct Uses {
    resets: Vec<usize>,
    coils: Vec<usize>,
}

impl Uses {
    fn holds(&self) -> bool {
        !self.resets.is_empty() && !self.coils.is_empty()
    }
}

/// The timer or counter that an RST or OUT names.
fn used(resolved: &Resolved, i: usize) -> Option<(Basic, Device, Option<Index>)> {
    let basic = basic_of(resolved, i).filter(|basic| matches!(basic, Basic::Rst | Basic::Out))?;
    let OperandKind::Device(device, index) = resolved.program.instrs[i].operands.first()?.kind
    else {
        return None;
    };
    matches!(device.class, T | C).then_some((basic, device, index))
}

/// Returns true if a scan passes both instructions, or none of them, as often.
fn in_one_stretch(resolved: &Resolved, a: usize, b: usize) -> bool {
    let mut between = a.min(b)..=a.max(b);
    between.all(|i| {
        !matches!(
            basic_of(resolved, i),
            Some(
                Basic::Label
                    | Basic::Cj
                    | Basic::Stl
                    | Basic::Ret
                    | Basic::For
                    | Basic::Next
                    | Basic::Fend
                    | Basic::Sret
                    | Basic::Iret
                    | Basic::Proc
                    | Basic::Pend
                    | Basic::Pret
                    | Basic::End
            )
        )
    })
}

impl Lowerer<'_> {
    /// Finds the timers and counters with a reset state, and its memory.
    pub(super) fn find_resets(&mut self) {
        let mut devices: BTreeMap<(DeviceClass, u32), Uses> = BTreeMap::new();
        let mut classes: BTreeMap<DeviceClass, (Uses, bool)> = BTreeMap::new();
        for i in 0..self.resolved.instrs.len() {
            let Some((basic, device, index)) = used(self.resolved, i) else {
                continue;
            };
            if basic == Basic::Rst && !self.rst_holds(i) {
                continue;
            }
            let (class, indexed) = classes.entry(device.class).or_default();
            *indexed |= index.is_some();
            let device = devices.entry((device.class, device.number)).or_default();
            for uses in [class, device] {
                if basic == Basic::Rst {
                    uses.resets.push(i);
                } else {
                    uses.coils.push(i);
                }
            }
        }
        for (class, (uses, indexed)) in classes {
            if indexed && uses.holds() {
                let table = Table {
                    name: reset_name(class, None),
                    meaning: "which of them RST holds at 0",
                    length: end(self.model, class),
                };
                let table = self.module.tables.push_and_get_key(table);
                self.resets.tables.insert(class, table);
            }
        }
        for ((class, number), uses) in devices {
            if uses.holds() && !self.resets.tables.contains_key(&class) {
                let memory = self.reset_memory(class, number, &uses);
                self.resets.devices.insert((class, number), memory);
            }
        }
    }

    fn reset_memory(&mut self, class: DeviceClass, number: u32, uses: &Uses) -> Memory {
        let counter = class == C && number < high_speed::FIRST;
        if let (true, &[reset], &[coil]) = (counter, &*uses.resets, &*uses.coils)
            && in_one_stretch(self.resolved, reset, coil)
        {
            return Memory::Coil;
        }
        let timing = self.model.timer(number).filter(|_| class == T);
        let ends = timing.is_some_and(|kind| kind.free_running && self.flow.skips());
        if let (T, false, &[reset]) = (class, ends, &*uses.resets)
            && (uses.coils.iter())
                .all(|&coil| reset < coil && in_one_stretch(self.resolved, reset, coil))
        {
            return Memory::Drive;
        }
        let name = reset_name(class, Some(number));
        let flag = self.flag(name, "RST holds it at 0", None);
        self.module.flags[flag].retained =
            self.model.latch_key.is_none() && self.module.is_latched(class, number);
        Memory::Flag(flag)
    }

    /// M8031 and M8032 release the devices that they clear.
    pub(super) fn release_cleared(&mut self, latched: bool) {
        let devices = self.resets.devices.iter();
        let flags: Vec<FlagId> = devices
            .filter(|&(&(class, number), _)| self.module.is_latched(class, number) == latched)
            .filter_map(|(_, memory)| match memory {
                Memory::Flag(flag) => Some(*flag),
                Memory::Coil | Memory::Drive => None,
            })
            .collect();
        for flag in flags {
            self.set_flag_to(flag, false);
        }
    }

    /// Returns true if the RST at `i` has a reset state. Interrupts come at any time: on models other than those of
    /// Mitsubishi, whose manual warns of it, RST in their routines only acts when it is executed.
    fn rst_holds(&self, i: usize) -> bool {
        self.model.rst_holds_in_interrupts || !self.flow.is_interrupt(i)
    }

    /// RST of a timer or counter.
    pub(super) fn reset_device(&mut self, device: Device, index: Option<Index>) {
        let drive = self.drive();
        let mut guards = Guards::default();
        let place = self.place(device, index, 1, false, &mut guards);
        let holds = self.rst_holds(self.at);
        if let Some(&table) = self.resets.tables.get(&device.class).filter(|_| holds) {
            let drive = self.settled(drive);
            return self.guarded_while(guards, Some(drive), |this| {
                let state = this.add(Expr::BitToInt(drive));
                let value = this.add(Expr::Widen(state));
                let entry = this.entry(table, place);
                this.emit(Action::SetEntry(SetEntry {
                    table,
                    index: entry,
                    value,
                }));
                this.when(drive, |this| this.reset_driven(device, index, place, false));
            });
        }
        let key = (device.class, device.number);
        let memory = self.resets.devices.get(&key).copied();
        let memory = memory.filter(|_| holds);
        let holds = matches!(memory, Some(Memory::Coil));
        let cond = match memory {
            Some(Memory::Flag(flag)) => {
                self.emit(Action::SetFlag(flag, drive));
                match self.known_bit(drive) {
                    Some(_) => drive,
                    None => self.add(Expr::Flag(flag)),
                }
            }
            Some(Memory::Drive) => {
                let drive = self.settled(drive);
                self.resets.drives.insert(key, drive);
                drive
            }
            Some(Memory::Coil) | None => drive,
        };
        self.when(cond, |this| {
            this.guarded(guards, |this| {
                this.reset_driven(device, index, place, holds)
            });
        });
    }

    /// RST that is driven.
    fn reset_driven(&mut self, device: Device, index: Option<Index>, place: Place, holds: bool) {
        self.emit(Action::Reset { place, holds });
        if index.is_none() && device.class == C {
            self.read_captures(device.number);
        }
    }

    /// Sets the value of a timer or counter to 0 and opens its contact, once.
    pub(super) fn reset(&mut self, place: Place) {
        self.emit(Action::Reset {
            place,
            holds: false,
        });
    }

    /// Resets a timer or counter again whose coil was executed in its reset state.
    pub(super) fn reset_if_held(&mut self, place: Place) {
        if let Some(held) = self.held_by_rst(place) {
            self.when(held, |this| this.reset(place));
        }
    }

    /// Condition that a timer or counter is in its reset state; `None` if it never is, or its coil shows it.
    pub(super) fn held_by_rst(&mut self, place: Place) -> Option<ExprId> {
        if let Some(&table) = self.resets.tables.get(&place.class) {
            let index = self.entry(table, place);
            let state = self.add(Expr::Entry(table, index));
            let free = self.add(Expr::I32(0));
            return Some(self.add(Expr::Cmp(CmpOp::Ne, state, free)));
        }
        let key = (place.class, place.number);
        match self.resets.devices.get(&key) {
            Some(&Memory::Flag(flag)) => Some(self.add(Expr::Flag(flag))),
            Some(Memory::Drive) => self.resets.drives.get(&key).copied(),
            Some(Memory::Coil) | None => None,
        }
    }

    /// The index of a device's entry.
    fn entry(&mut self, table: TableId, place: Place) -> ExprId {
        self.resets.entries.push((table, place.number, place.index));
        let number = self.add(Expr::I32(place.number as i32));
        match place.index {
            Some(index) => self.add(Expr::Bin(BinOp::Add, number, index)),
            None => number,
        }
    }
}

/// Ends the tables where their entries do, now that it is known where the indexes lead.
pub(super) fn shorten_tables(module: &mut Module, entries: &[Entry]) {
    let mut ends: BTreeMap<TableId, i64> = BTreeMap::new();
    for &(table, number, index) in entries {
        let last = match index.map(|index| *module.expr(index)) {
            Some(Expr::Within { high, .. }) => i64::from(high),
            _ => 0,
        };
        let end = ends.entry(table).or_default();
        *end = (*end).max(i64::from(number) + last + 1);
    }
    for (table, end) in ends {
        let length = &mut module.tables[table].length;
        *length = u32::try_from(end).map_or(1, |end| end.clamp(1, *length));
    }
}

/// One past the last number of a class.
fn end(model: &Model, class: DeviceClass) -> u32 {
    let lasts = model.ranges_of(class).map(|range| range.last + 1);
    lasts.max().unwrap_or(1)
}
