//! High-speed counters: they count at the edges of their inputs, and comparisons act at the count.

use super::Lowerer;
use super::operand::{Guards, fixed};
use crate::catalogue::{Basic, CmpOp, Comparison};
use crate::high_speed::{
    self, COMPARE_AT_RESET, Counter, EDGE_RESET, Kind, NO_RESET, RESET_RELAYS,
};
use crate::interrupts::Source;
use crate::model::ModelId;
use crate::node::{CellId, EdgeKind, Expr, ExprId, FlagId, Place, Stmt};
use rungc_syntax::{Device, DeviceClass, OperandKind, codes};

/// Relay of a counter: its direction, or what shows it.
const DIRECTION: u32 = 8000;
/// Relays that choose a table for DHSZ instead of a zone.
const TABLE_MODES: [u32; 2] = [8130, 8132];

/// A counter that the program drives.
struct Used {
    counter: &'static Counter,
    /// Its coil is on.
    on: FlagId,
    preset: CellId,
}

/// A comparison that the program makes.
struct Compare {
    /// Number of the counter.
    counter: u32,
    /// It is driven.
    armed: FlagId,
    /// What the counter is compared with: one value, or the ends of a zone.
    values: Vec<CellId>,
    action: Action,
}

/// What a comparison does.
enum Action {
    /// Switches a bit.
    Switch(OperandKind, bool),
    /// Resets the counter itself.
    Reset,
    /// Requests an interrupt.
    Request(FlagId),
    /// Shows the zone in three bits.
    Zone(OperandKind),
}

/// The high-speed counters of a program.
#[derive(Default)]
pub(super) struct HighSpeed {
    used: Vec<Used>,
    compares: Vec<Compare>,
}

impl Lowerer<'_> {
    /// Finds the counters that the program drives.
    pub(super) fn find_counters(&mut self) {
        if self.model.id == ModelId::Hm {
            return;
        }
        for i in 0..self.resolved.instrs.len() {
            let coil = self.basic_at(i) == Some(Basic::Out);
            let operand = self.resolved.program.instrs[i].operands.first();
            let Some(OperandKind::Device(device, None)) = operand.map(|o| &o.kind) else {
                continue;
            };
            let known = |used: &Used| used.counter.number == device.number;
            if !coil || device.class != DeviceClass::C || self.high_speed.used.iter().any(known) {
                continue;
            }
            let table = high_speed::counters(self.model.id);
            if let Some(counter) = table.iter().find(|counter| counter.number == device.number) {
                let number = counter.number;
                let on = self.flag(format!("c{number}_on"), "its coil is on", None);
                let preset = self.cell(format!("c{number}_preset"), "its set value");
                self.high_speed.used.push(Used {
                    counter,
                    on,
                    preset,
                });
            }
        }
    }

    /// OUT C235 and up: while the coil is on it counts, outside the scan.
    pub(super) fn high_speed_coil(&mut self, device: Device) {
        let used = &self.high_speed.used;
        let Some(used) = used.iter().find(|u| u.counter.number == device.number) else {
            let span = self.instr().span;
            let message = format!("`OUT {device}` is not implemented yet: high-speed counters");
            return self.report(codes::NOT_IMPLEMENTED.at(span, message));
        };
        let (on, preset) = (used.on, used.preset);
        let drive = self.drive();
        self.with_preset(true, |this, value| {
            this.emit(Stmt::SetCell(preset, value));
            this.emit(Stmt::SetFlag(on, drive));
        });
    }

    /// HSCS, HSCR, HSZ: while driven, the comparison is armed with its values.
    pub(super) fn high_speed_compare(&mut self, comparison: Comparison) {
        let values = if comparison == Comparison::Zone { 2 } else { 1 };
        let (Some(OperandKind::Device(counter, None)), Some(target)) = (
            self.operand(values).cloned(),
            self.operand(values + 1).cloned(),
        ) else {
            return self.cannot_compare();
        };
        let Some(action) = self.action(comparison, counter, &target) else {
            return self.cannot_compare();
        };
        let n = self.high_speed.compares.len() + 1;
        let armed = self.flag(
            format!("compare{n}"),
            "a comparison at the count is driven",
            None,
        );
        let drive = self.drive();
        let mut guards = Guards::default();
        let mut cells = Vec::new();
        for i in 0..values {
            let Some(operand) = self.operand(i) else {
                return;
            };
            let value = self.value(operand, true, &mut guards);
            let end = ["value", "end"][i];
            let cell = self.cell(
                format!("compare{n}_{end}"),
                "what the count is compared with",
            );
            cells.push((cell, value));
        }
        let stored: Vec<CellId> = cells.iter().map(|&(cell, _)| cell).collect();
        let set = self.body(|this| {
            this.guarded(guards, |this| {
                for (cell, value) in cells {
                    this.emit(Stmt::SetCell(cell, value));
                }
                this.set_flag_to(armed, true);
            });
        });
        match self.expr(drive) {
            Expr::Bit(true) => set.into_iter().for_each(|stmt| self.emit(stmt)),
            _ => {
                let otherwise = self.body(|this| this.set_flag_to(armed, false));
                self.emit(Stmt::If {
                    cond: drive,
                    then: set,
                    otherwise,
                });
            }
        }
        self.high_speed.compares.push(Compare {
            counter: counter.number,
            armed,
            values: stored,
            action,
        });
    }

    fn cannot_compare(&mut self) {
        let span = self.instr().span;
        let message = format!("`{}` is not implemented yet in this form", self.instr());
        self.report(codes::NOT_IMPLEMENTED.at(span, message));
    }

    fn action(
        &mut self,
        comparison: Comparison,
        counter: Device,
        target: &OperandKind,
    ) -> Option<Action> {
        let device = match *target {
            OperandKind::Device(device, None) => device,
            OperandKind::WordBit(_, _, None) if comparison != Comparison::Zone => {
                let on = comparison == Comparison::Set;
                return Some(Action::Switch(target.clone(), on));
            }
            _ => return None,
        };
        Some(match (comparison, device.class) {
            (Comparison::Zone, DeviceClass::M) if TABLE_MODES.contains(&device.number) => {
                return None;
            }
            (Comparison::Zone, _) => Action::Zone(target.clone()),
            (Comparison::Set, DeviceClass::I) => {
                let pointer = device.number;
                Action::Request(self.request_flag(Source::Comparison { pointer })?)
            }
            (Comparison::Reset, DeviceClass::C) if device == counter => Action::Reset,
            (_, DeviceClass::C | DeviceClass::I) => return None,
            _ => Action::Switch(target.clone(), comparison == Comparison::Set),
        })
    }

    /// What the edges of the counters' inputs do.
    pub(super) fn counter_edges(&mut self) {
        let HighSpeed { used, compares } = std::mem::take(&mut self.high_speed);
        for used in &used {
            let number = used.counter.number;
            let compares: Vec<&Compare> = compares.iter().filter(|c| c.counter == number).collect();
            self.count_edges(used, &compares);
            if let Some(reset) = used.counter.reset {
                self.reset_edge(used, reset, &compares);
            }
        }
    }

    fn count_edges(&mut self, used: &Used, compares: &[&Compare]) {
        let number = used.counter.number;
        let relay = |this: &mut Self, number| match this.specials.has(DeviceClass::M, number) {
            true => this.add(Expr::ReadBit(fixed(DeviceClass::M, number))),
            false => this.bit_const(false),
        };
        match (used.counter.kind, used.counter.counts) {
            (Kind::One, &[input]) => self.on_edge(input, EdgeKind::Rising, |this| {
                let down = relay(this, DIRECTION + number);
                this.count(used, down, compares);
            }),
            (Kind::UpDown, &[up, down]) => {
                for (input, is_down) in [(up, false), (down, true)] {
                    self.on_edge(input, EdgeKind::Rising, |this| {
                        let down = this.bit_const(is_down);
                        this.count(used, down, compares);
                    });
                }
            }
            (Kind::Phases, &[a, b]) => {
                let four_fold = high_speed::four_fold(self.model.id, number);
                for (input, other) in [(a, b), (b, a)] {
                    for kind in [EdgeKind::Rising, EdgeKind::Falling] {
                        self.on_edge(input, kind, |this| {
                            // Forward, A rises while B is off, B while A is on; falling is the other way round.
                            let rises = kind == EdgeKind::Rising;
                            let four_fold = four_fold
                                .filter(|&number| this.specials.has(DeviceClass::M, number))
                                .map(|number| relay(this, number));
                            let level = this.level(other);
                            let (counts, down) = match four_fold {
                                Some(four_fold) => {
                                    let down = if (input == a) == rises {
                                        level
                                    } else {
                                        this.not(level)
                                    };
                                    let counts = if input == b {
                                        this.or(level, four_fold)
                                    } else {
                                        four_fold
                                    };
                                    (counts, down)
                                }
                                // Counted once, an edge of B counts while A is on.
                                None if input == b => (level, this.bit_const(!rises)),
                                None => return,
                            };
                            this.when(counts, |this| this.count(used, down, compares));
                        });
                    }
                }
            }
            _ => {}
        }
    }

    /// Counts, if the counter is on, started and not held at 0.
    fn count(&mut self, used: &Used, down: ExprId, compares: &[&Compare]) {
        let number = used.counter.number;
        let mut counts = self.add(Expr::Flag(used.on));
        if let Some(start) = used.counter.start {
            let start = self.level(start);
            counts = self.and(counts, start);
        }
        if let (Some(reset), true) = (used.counter.reset, RESET_RELAYS.has(self.model.id)) {
            let mut held = self.level(reset);
            for relay in [EDGE_RESET, NO_RESET] {
                if self.specials.has(DeviceClass::M, relay) {
                    let relay = self.add(Expr::ReadBit(fixed(DeviceClass::M, relay)));
                    let relay = self.not(relay);
                    held = self.and(held, relay);
                }
            }
            let free = self.not(held);
            counts = self.and(counts, free);
        }
        self.when(counts, |this| {
            let preset = this.add(Expr::Cell(used.preset));
            this.emit(Stmt::Count {
                number,
                down,
                preset,
            });
            let shown = DIRECTION + number;
            if used.counter.kind != Kind::One && this.specials.has(DeviceClass::M, shown) {
                this.write_device(DeviceClass::M, shown, down);
            }
            for compare in compares {
                this.act_at_count(compare);
            }
        });
    }

    fn reset_edge(&mut self, used: &Used, reset: u32, compares: &[&Compare]) {
        let relay = |this: &mut Self, number| {
            let known = this.specials.has(DeviceClass::M, number);
            known.then(|| this.add(Expr::ReadBit(fixed(DeviceClass::M, number))))
        };
        let place = counter_place(used.counter.number);
        self.on_edge(reset, EdgeKind::Rising, |this| {
            let mut resets = this.add(Expr::Flag(used.on));
            if RESET_RELAYS.has(this.model.id)
                && let Some(off) = relay(this, NO_RESET)
            {
                let acts = this.not(off);
                resets = this.and(resets, acts);
            }
            this.when(resets, |this| {
                this.emit(Stmt::Reset(place));
                if let Some(compares_too) = relay(this, COMPARE_AT_RESET) {
                    this.when(compares_too, |this| {
                        for compare in compares {
                            this.act_at_count(compare);
                        }
                    });
                }
            });
        });
    }

    /// One comparison, at a count.
    fn act_at_count(&mut self, compare: &Compare) {
        let count = self.add(Expr::ReadPair(counter_place(compare.counter)));
        let values: Vec<ExprId> = compare
            .values
            .iter()
            .map(|&cell| self.add(Expr::Cell(cell)))
            .collect();
        let armed = self.add(Expr::Flag(compare.armed));
        match (&compare.action, values.as_slice()) {
            (Action::Zone(target), &[low, high]) => {
                let below = self.add(Expr::Cmp(CmpOp::Lt, count, low));
                let above = self.add(Expr::Cmp(CmpOp::Gt, count, high));
                let outside = self.or(below, above);
                let inside = self.not(outside);
                self.when(armed, |this| {
                    let mut guards = Guards::default();
                    let Some(target) = this.bit_target(target, 3, false, &mut guards) else {
                        return;
                    };
                    this.guarded(guards, |this| {
                        for (offset, state) in (0..).zip([below, inside, above]) {
                            this.store_bit(target, offset, state);
                        }
                    });
                });
            }
            (action, &[value, ..]) => {
                let equal = self.add(Expr::Cmp(CmpOp::Eq, count, value));
                let acts = self.and(armed, equal);
                self.when(acts, |this| match action {
                    Action::Switch(target, on) => {
                        let on = this.bit_const(*on);
                        this.write_bits(target, on);
                    }
                    Action::Request(flag) => this.set_flag_to(*flag, true),
                    Action::Reset => this.emit(Stmt::Reset(counter_place(compare.counter))),
                    Action::Zone(_) => {}
                });
            }
            _ => {}
        }
    }
}

fn counter_place(number: u32) -> Place {
    fixed(DeviceClass::C, number)
}
