//! High-speed counters: they count at the edges of their inputs, and comparisons act at the count.

use super::Lowerer;
use super::count_table::Rows;
use super::operand::{Guards, fixed};
use rungc_catalogue::{Basic, Comparison, Lower};
use rungc_ir::node::{
    Access, Action, BinOp, Branch, CellId, Count, Expr, ExprId, FlagId, Place, Stmt, SysValue,
};
use rungc_models::high_speed::{self, Counter, Kind};
use rungc_models::interrupts::Source;
use rungc_rt::special::{M_COMPARE_AT_RESET, M_COUNTER_DIRECTION};
use rungc_rt::{CmpOp, EdgeKind, Relay};
use rungc_syntax::{Device, DeviceClass, OperandKind, codes};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// More comparisons are driven than may be.
const TOO_MANY_COMPARISONS: u16 = 6760;

/// A counter that the program drives.
pub(super) struct Used {
    pub(super) counter: &'static Counter,
    /// Its coil is on.
    pub(super) on: FlagId,
    preset: CellId,
}

/// Value that a comparison observes.
#[derive(Clone, Copy)]
pub(super) enum Counted {
    /// A high-speed counter, by its number: at each count.
    Counter(u32),
    /// Something else, in the scan.
    Value(ExprId),
}

/// A comparison that the program makes.
pub(super) struct Compare {
    pub(super) counted: Counted,
    /// It is driven.
    pub(super) armed: FlagId,
    /// Values that the count is compared with: one value, or the ends of a zone.
    pub(super) values: Vec<CellId>,
    /// State of the comparison: the count was not below the value; `None` if only an equal count acts.
    pub(super) reached: Option<FlagId>,
    pub(super) effect: Effect,
    /// Its instruction.
    pub(super) at: usize,
}

/// Effect of a comparison.
pub(super) enum Effect {
    /// Switches a bit.
    Switch(OperandKind, bool),
    /// Resets the counter itself.
    Reset,
    /// Requests an interrupt.
    Request(FlagId),
    /// Shows the zone in three bits.
    Zone(OperandKind),
    /// Continues in a table.
    Rows(Rows),
}

/// The high-speed counters of a program.
#[derive(Default)]
pub(super) struct HighSpeed {
    pub(super) used: Vec<Used>,
    /// Of input axes, by their inputs: the millisecond that it was last, and the count when it began.
    pub(super) milliseconds: BTreeMap<u32, [CellId; 2]>,
    pub(super) compares: Vec<Compare>,
    /// States of all comparisons.
    armed: Vec<FlagId>,
    /// Tables that begin when a scan ends.
    pub(super) tables: Vec<Rows>,
    /// Number of driven comparisons, and its limit, in a program that has more.
    limit: Option<(CellId, u32)>,
}

impl Lowerer<'_> {
    /// Finds the counters that the program drives.
    pub(super) fn find_counters(&mut self) {
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
            if let Some(counter) = self.counter_with_number(device.number) {
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

    /// Counts the comparisons that are driven, if the program has more than may be.
    pub(super) fn limit_comparisons(&mut self) {
        let instrs = self.resolved.instrs.iter();
        let compares = instrs.filter(|instr| matches!(instr.lower, Some(Lower::HighSpeed(_))));
        let count = compares.count();
        let most = self.model.high_speed.most_comparisons;
        if let Some(most) = most.filter(|&most| count > most as usize) {
            let driven = self.cell("comparisons".to_string(), "how many are driven");
            self.high_speed.limit = Some((driven, most));
        }
    }

    /// None is driven when RUN begins.
    pub(super) fn forget_comparisons(&mut self) {
        if let Some((driven, _)) = self.high_speed.limit {
            let first = self.add(Expr::Sys(SysValue::FirstScan));
            let none = self.add(Expr::I32(0));
            self.when(first, |this| this.emit(Action::SetCell(driven, none)));
        }
    }

    /// Relay and register of the comparisons that are driven.
    pub(super) fn comparisons_executed(&mut self) {
        let Some((relay, register)) = self.model.high_speed.executed else {
            return;
        };
        let armed = std::mem::take(&mut self.high_speed.armed);
        if self.specials.has(relay) {
            let mut any = self.bit_const(false);
            for &flag in &armed {
                let flag = self.add(Expr::Flag(flag));
                any = self.or(any, flag);
            }
            self.write_relay(relay, any);
        }
        if self.specials.has(register) {
            let mut sum = self.int(0, false);
            for &flag in &armed {
                let flag = self.add(Expr::Flag(flag));
                let one = self.add(Expr::BitToInt(flag));
                sum = self.add(Expr::Bin(BinOp::Add, sum, one));
            }
            self.emit(Action::Write(Access::word(register), sum));
        }
    }

    /// Emits the statements of `make`, executed if one more comparison may be driven; else the instruction faults.
    pub(super) fn one_more(&mut self, make: impl FnOnce(&mut Self)) {
        let Some((driven, most)) = self.high_speed.limit else {
            return make(self);
        };
        let count = self.add(Expr::Cell(driven));
        let most = self.add(Expr::I32(most as i32));
        let cond = self.add(Expr::Cmp(CmpOp::Lt, count, most));
        let then = self.body(|this| {
            this.change_driven(driven, BinOp::Add);
            make(this);
        });
        let step = self.step();
        let otherwise = vec![Stmt::Do(Action::Fault {
            code: TOO_MANY_COMPARISONS,
            step,
        })];
        self.emit(Stmt::If(Branch {
            cond,
            then,
            otherwise,
        }));
    }

    fn change_driven(&mut self, driven: CellId, op: BinOp) {
        let count = self.add(Expr::Cell(driven));
        let one = self.add(Expr::I32(1));
        let count = self.add(Expr::Bin(op, count, one));
        self.emit(Action::SetCell(driven, count));
    }

    /// A comparison is not driven.
    pub(super) fn disarm(&mut self, armed: FlagId) {
        if let Some((driven, _)) = self.high_speed.limit {
            let was = self.add(Expr::Flag(armed));
            self.when(was, |this| this.change_driven(driven, BinOp::Sub));
        }
        self.set_flag_to(armed, false);
    }

    /// OUT C235 and up: while the coil is on it counts, outside the scan. The checks reject one that counts no input.
    pub(super) fn high_speed_coil(&mut self, device: Device) {
        let used = &self.high_speed.used;
        let Some(used) = used.iter().find(|u| u.counter.number == device.number) else {
            return;
        };
        let (counter, on, preset) = (used.counter, used.on, used.preset);
        let drive = self.drive();
        self.with_preset(true, Guards::default(), |this, value| {
            this.emit(Action::SetCell(preset, value));
            this.emit(Action::SetFlag(on, drive));
        });
        // A written or retained value does not outlast a reset input that is on.
        if let Some(held) = self.held(counter) {
            let resets = self.and(drive, held);
            let place = counter_place(counter.number);
            self.when(resets, |this| this.reset(place));
        }
        self.reset_if_held(counter_place(counter.number));
    }

    /// HSCS, HSCR, HSZ, HSCT: while driven, the comparison is armed with its values.
    pub(super) fn high_speed_compare(&mut self, comparison: Comparison) {
        if self.compare_at_count(comparison).is_none() {
            let span = self.instr().span;
            let message = format!("`{}` cannot be compiled in this form", self.instr());
            self.report(codes::NOT_IMPLEMENTED.at(span, message));
        }
    }

    fn compare_at_count(&mut self, comparison: Comparison) -> Option<()> {
        let values = match comparison {
            Comparison::Set | Comparison::Reset => 1,
            Comparison::Zone | Comparison::Table => 2,
        };
        let mut guards = Guards::default();
        let counted = self.counted(values, &mut guards)?;
        let target = self.operand(values + 1)?.clone();
        let table = match (comparison, &target) {
            (Comparison::Table, _) => Some(&self.model.high_speed.patterns),
            (Comparison::Zone, &OperandKind::Device(relay, None)) => high_speed::zone_table(relay),
            _ => None,
        };
        if let Some(mode) = table {
            return self.count_table(mode, counted);
        }
        let effect = self.effect(comparison, counted, &target)?;
        let n = self.high_speed.compares.len() + 1;
        let meaning = "a comparison at the count is driven";
        let armed = self.flag(format!("compare{n}"), meaning, None);
        let crossing = self.model.high_speed.crossing_zones.clone();
        let reached = (crossing.is_some() && comparison != Comparison::Zone).then(|| {
            let meaning = "the count was not below the value";
            self.flag(format!("compare{n}_reached"), meaning, None)
        });
        let drive = self.drive();
        let mut cells = Vec::new();
        for i in 0..values {
            let value = self.value(self.operand(i)?, true, &mut guards);
            let end = ["value", "end"][i];
            let meaning = "what the count is compared with";
            cells.push((self.cell(format!("compare{n}_{end}"), meaning), value));
        }
        if let Some(zones) = crossing.clone() {
            self.demand_zone(values + 2, zones, &mut guards);
        }
        let compare = Compare {
            counted,
            armed,
            values: cells.iter().map(|&(cell, _)| cell).collect(),
            reached,
            effect,
            at: self.at,
        };
        let then = self.body(|this| {
            this.guarded(guards, |this| {
                for (cell, value) in cells {
                    this.emit(Action::SetCell(cell, value));
                }
                this.arm(&compare);
                if crossing.is_some() {
                    this.act(&compare);
                }
            });
        });
        match self.known_bit(drive) {
            Some(true) => then.into_iter().for_each(|stmt| self.emit(stmt)),
            Some(false) | None => {
                let otherwise = self.body(|this| this.disarm(armed));
                self.emit(Stmt::If(Branch {
                    cond: drive,
                    then,
                    otherwise,
                }));
            }
        }
        self.high_speed.compares.push(compare);
        Some(())
    }

    /// Value that operand `i` names for comparison.
    fn counted(&mut self, i: usize, guards: &mut Guards) -> Option<Counted> {
        let operand = self.operand(i)?;
        if let OperandKind::Device(device, None) = *operand
            && device.class == DeviceClass::C
            && self.counter_with_number(device.number).is_some()
        {
            return Some(Counted::Counter(device.number));
        }
        let crossing = self.model.high_speed.crossing_zones.is_some();
        crossing.then(|| Counted::Value(self.value(operand, true, guards)))
    }

    /// The high-speed counter of this number.
    fn counter_with_number(&self, number: u32) -> Option<&'static Counter> {
        self.model.high_speed.counter(number)
    }

    /// The zone in which a comparison runs is one of those that there are.
    fn demand_zone(&mut self, operand: usize, zones: RangeInclusive<i32>, guards: &mut Guards) {
        let zone = match self.operand(operand) {
            Some(zone @ OperandKind::Device(..)) => self.value(zone, true, guards),
            _ => return,
        };
        for (op, end) in [(CmpOp::Ge, *zones.start()), (CmpOp::Le, *zones.end())] {
            let end = self.add(Expr::I32(end));
            let holds = self.add(Expr::Cmp(op, zone, end));
            guards.demand(holds);
        }
    }

    /// A comparison is driven. One that acts when the value is crossed begins with the state at hand.
    fn arm(&mut self, compare: &Compare) {
        if let (Some(reached), &[value]) = (compare.reached, compare.values.as_slice()) {
            let armed = self.add(Expr::Flag(compare.armed));
            let begins = self.not(armed);
            let count = self.count_of(compare);
            let value = self.add(Expr::Cell(value));
            let now = self.add(Expr::Cmp(CmpOp::Ge, count, value));
            self.when(begins, |this| this.emit(Action::SetFlag(reached, now)));
        }
        if self.high_speed.limit.is_none() {
            return self.set_flag_to(compare.armed, true);
        }
        let armed = self.add(Expr::Flag(compare.armed));
        let begins = self.not(armed);
        self.when(begins, |this| {
            this.one_more(|this| this.set_flag_to(compare.armed, true));
        });
    }

    /// Current value of a comparison's count.
    fn count_of(&mut self, compare: &Compare) -> ExprId {
        match compare.counted {
            Counted::Counter(number) => self.add(Expr::Read(Access::pair(counter_place(number)))),
            Counted::Value(value) => value,
        }
    }

    fn effect(
        &mut self,
        comparison: Comparison,
        counted: Counted,
        target: &OperandKind,
    ) -> Option<Effect> {
        let device = match *target {
            OperandKind::Device(device, None) => device,
            // The index counts at the moment of the comparison.
            OperandKind::Device(device, Some(_)) if is_coil(device.class) => device,
            OperandKind::WordBit(_, _, None) if comparison != Comparison::Zone => {
                let on = comparison == Comparison::Set;
                return Some(Effect::Switch(target.clone(), on));
            }
            OperandKind::Device(..)
            | OperandKind::WordBit(..)
            | OperandKind::Nibbles(..)
            | OperandKind::Decimal(..)
            | OperandKind::Hex(..)
            | OperandKind::Float(_)
            | OperandKind::Text(_)
            | OperandKind::Buffer { .. }
            | OperandKind::Unreadable(_) => return None,
        };
        let counts_itself = matches!(counted, Counted::Counter(number) if number == device.number);
        Some(match (comparison, device.class) {
            (Comparison::Zone, _) => Effect::Zone(target.clone()),
            (Comparison::Set, DeviceClass::I) => {
                let pointer = device.number;
                Effect::Request(self.request_flag(Source::Comparison { pointer })?)
            }
            (Comparison::Reset, DeviceClass::C) if counts_itself => Effect::Reset,
            (_, DeviceClass::C | DeviceClass::I) => return None,
            _ => Effect::Switch(target.clone(), comparison == Comparison::Set),
        })
    }

    /// Emits the actions at edges of the counters' inputs.
    pub(super) fn counter_edges(&mut self) {
        let used = std::mem::take(&mut self.high_speed.used);
        let compares = std::mem::take(&mut self.high_speed.compares);
        self.high_speed.armed = compares.iter().map(|compare| compare.armed).collect();
        for used in &used {
            let number = used.counter.number;
            let looks =
                |compare: &&Compare| matches!(compare.counted, Counted::Counter(n) if n == number);
            let compares: Vec<&Compare> = compares.iter().filter(looks).collect();
            self.count_edges(used, &compares);
            if let Some(reset) = used.counter.reset {
                self.reset_edge(used, reset, &compares);
            }
        }
        self.high_speed.used = used;
    }

    fn count_edges(&mut self, used: &Used, compares: &[&Compare]) {
        let number = used.counter.number;
        let relay = |this: &mut Self, relay: Relay| match this.specials.has(relay) {
            true => this.add(Expr::Read(Access::bit(relay))),
            false => this.bit_const(false),
        };
        match (used.counter.kind, used.counter.counts) {
            (Kind::One, &[input]) => self.on_edge(input, EdgeKind::Rising, |this| {
                let down = relay(this, M_COUNTER_DIRECTION.after(number));
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
            (Kind::Direction, &[input, direction]) => {
                self.on_edge(input, EdgeKind::Rising, |this| {
                    let down = this.level(direction);
                    this.count(used, down, compares);
                });
            }
            (Kind::Phases, &[a, b]) => {
                let four_fold = self.model.high_speed.four_fold(number);
                for (input, other) in [(a, b), (b, a)] {
                    for kind in [EdgeKind::Rising, EdgeKind::Falling] {
                        self.on_edge(input, kind, |this| {
                            // Forward, A rises while B is off, B while A is on; falling is the other way round.
                            let rises = kind == EdgeKind::Rising;
                            let four_fold = four_fold
                                .filter(|&number| this.specials.has(number))
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
        let by_rst = self.held_by_rst(counter_place(number));
        for held in [self.held(used.counter), by_rst].into_iter().flatten() {
            let free = self.not(held);
            counts = self.and(counts, free);
        }
        self.when(counts, |this| {
            this.show_last_millisecond(used.counter);
            let preset = this.add(Expr::Cell(used.preset));
            this.emit(Action::Count(Count {
                number,
                down,
                preset,
            }));
            this.show_on_axis(used.counter);
            let shown = M_COUNTER_DIRECTION.after(number);
            if used.counter.kind != Kind::One && this.specials.has(shown) {
                this.write_relay(shown, down);
            }
            for compare in compares {
                this.act(compare);
            }
            this.rows_at_count(number, down);
        });
    }

    /// Condition that its reset input holds a counter at 0; `None` if none does so.
    fn held(&mut self, counter: &Counter) -> Option<ExprId> {
        let reset = counter
            .reset
            .filter(|_| self.model.high_speed.held_by_reset)?;
        let mut held = self.level(reset);
        if let Some(relays) = self.model.high_speed.reset_relays {
            for relay in [relays.edge, relays.off] {
                if self.specials.has(relay) {
                    let relay = self.add(Expr::Read(Access::bit(relay)));
                    let relay = self.not(relay);
                    held = self.and(held, relay);
                }
            }
        }
        Some(held)
    }

    fn reset_edge(&mut self, used: &Used, reset: u32, compares: &[&Compare]) {
        let relay = |this: &mut Self, relay: Relay| {
            let known = this.specials.has(relay);
            known.then(|| this.add(Expr::Read(Access::bit(relay))))
        };
        let place = counter_place(used.counter.number);
        self.on_edge(reset, EdgeKind::Rising, |this| {
            let mut resets = this.add(Expr::Flag(used.on));
            if let Some(relays) = this.model.high_speed.reset_relays
                && let Some(off) = relay(this, relays.off)
            {
                let acts = this.not(off);
                resets = this.and(resets, acts);
            }
            this.when(resets, |this| {
                this.reset(place);
                if this.model.special_works(M_COMPARE_AT_RESET)
                    && let Some(compares_too) = relay(this, M_COMPARE_AT_RESET)
                {
                    this.when(compares_too, |this| {
                        for compare in compares {
                            this.act(compare);
                        }
                    });
                }
            });
        });
    }

    /// A comparison looks at the count.
    pub(super) fn act(&mut self, compare: &Compare) {
        // An error is one of the instruction, wherever it shows itself.
        let at = std::mem::replace(&mut self.at, compare.at);
        self.act_now(compare);
        self.at = at;
    }

    fn act_now(&mut self, compare: &Compare) {
        let count = self.count_of(compare);
        let values: Vec<ExprId> = compare
            .values
            .iter()
            .map(|&cell| self.add(Expr::Cell(cell)))
            .collect();
        match (&compare.effect, values.as_slice()) {
            (Effect::Rows(rows), _) => self.row_at_count(rows, count),
            (Effect::Zone(target), &[low, high]) => {
                let below = self.add(Expr::Cmp(CmpOp::Lt, count, low));
                let above = self.add(Expr::Cmp(CmpOp::Gt, count, high));
                self.show_zone(compare.armed, target, below, above);
            }
            (_, &[value, ..]) => {
                let armed = self.add(Expr::Flag(compare.armed));
                let Some(reached) = compare.reached else {
                    let equal = self.add(Expr::Cmp(CmpOp::Eq, count, value));
                    let acts = self.and(armed, equal);
                    return self.when(acts, |this| this.take_effect(compare));
                };
                let now = self.add(Expr::Cmp(CmpOp::Ge, count, value));
                let before = self.add(Expr::Flag(reached));
                let crossed = self.differ(before, now);
                let acts = self.and(armed, crossed);
                self.when(acts, |this| {
                    this.emit(Action::SetFlag(reached, now));
                    this.take_effect(compare);
                });
            }
            _ => {}
        }
    }

    /// Condition that exactly one of two bits is on.
    fn differ(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let (not_a, not_b) = (self.not(a), self.not(b));
        let first = self.and(a, not_b);
        let second = self.and(not_a, b);
        self.or(first, second)
    }

    fn take_effect(&mut self, compare: &Compare) {
        match &compare.effect {
            Effect::Switch(target, on) => {
                if *on && self.is_request(target) {
                    self.capture_at_comparison(compare.counted);
                }
                let on = self.bit_const(*on);
                self.write_bits(target, on);
            }
            Effect::Request(flag) => {
                self.capture_at_comparison(compare.counted);
                self.set_flag_to(*flag, true);
            }
            Effect::Reset => {
                if let Counted::Counter(number) = compare.counted {
                    self.reset(counter_place(number));
                }
            }
            Effect::Zone(_) | Effect::Rows(_) => {}
        }
    }

    /// Three bits show where the count is.
    fn show_zone(&mut self, armed: FlagId, target: &OperandKind, below: ExprId, above: ExprId) {
        let outside = self.or(below, above);
        let inside = self.not(outside);
        let armed = self.add(Expr::Flag(armed));
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
}

/// Returns true if a class has bits that a program switches.
fn is_coil(class: DeviceClass) -> bool {
    matches!(class, DeviceClass::Y | DeviceClass::M | DeviceClass::S)
}

pub(super) fn counter_place(number: u32) -> Place {
    fixed(DeviceClass::C, number)
}
