//! The registers of HM's input axes (hm-motion-controller §8.2.2), as far as something looks at them.

use super::Lowerer;
use super::high_speed::{Counted, counter_place};
use rungc_catalogue::Lower;
use rungc_ir::node::{Access, Action, BinOp, CellId, Expr};
use rungc_models::high_speed::{Axis, Counter, Kind};
use rungc_models::interrupts::Source;
use rungc_rt::special::M_COUNTER_DIRECTION;
use rungc_rt::{CmpOp, Register, RtFn};
use rungc_syntax::{Device, DeviceClass, OperandKind};

impl Lowerer<'_> {
    /// The registers of an input axis show the count.
    pub(super) fn show_on_axis(&mut self, counter: &Counter) {
        let Some(axis) = self.axis(counter) else {
            return;
        };
        let count = self.add(Expr::Read(Access::pair(counter_place(counter.number))));
        if self.looks_at_pair(axis.count) || self.is_master(axis) {
            self.emit(Action::Write(Access::pair(axis.count), count));
        }
        if self.looks_at_pair(axis.upper) {
            let zero = self.add(Expr::I32(0));
            let negative = self.add(Expr::Cmp(CmpOp::Lt, count, zero));
            let negative = self.add(Expr::BitToInt(negative));
            let negative = self.add(Expr::Widen(negative));
            let upper = self.add(Expr::Neg(negative));
            self.emit(Action::Write(Access::pair(axis.upper), upper));
        }
    }

    /// The input axis of a counter's input.
    fn axis(&self, counter: &Counter) -> Option<&'static Axis> {
        let input = counter.counts.first();
        let mut axes = self.model.high_speed.axes.iter();
        axes.find(|axis| Some(&axis.input) == input)
    }

    /// Before each scan, input axes show what their counters hold, how these count, and the pulses of the last
    /// millisecond, too.
    pub(super) fn show_axes(&mut self) {
        let counters = self.high_speed.used.iter().map(|u| (u.counter, u.on));
        for (counter, on) in counters.collect::<Vec<_>>() {
            self.show_on_axis(counter);
            self.show_last_millisecond(counter);
            let Some(axis) = self.axis(counter).filter(|axis| self.looks_at(axis.mode)) else {
                continue;
            };
            let on = self.add(Expr::Flag(on));
            self.when(on, |this| {
                let mode = match counter.kind {
                    Kind::Phases => this.int(0, false),
                    Kind::Direction => this.int(1, false),
                    Kind::One | Kind::UpDown => {
                        let up = this.int(2, false);
                        let relay = M_COUNTER_DIRECTION.after(counter.number);
                        match this.specials.has(relay) {
                            true => {
                                let down = this.add(Expr::Read(Access::bit(relay)));
                                let down = this.add(Expr::BitToInt(down));
                                this.add(Expr::Bin(BinOp::Add, up, down))
                            }
                            false => up,
                        }
                    }
                };
                this.emit(Action::Write(Access::word(axis.mode), mode));
            });
        }
    }

    /// If another millisecond has begun, a register shows the pulses of the last one.
    pub(super) fn show_last_millisecond(&mut self, counter: &Counter) {
        let Some(axis) = self.axis(counter).filter(|axis| self.looks_at(axis.per_ms)) else {
            return;
        };
        let [last, base] = self.millisecond_of(axis);
        let clock = self.clock();
        let now = self.add(Expr::Cell(clock));
        let before = self.add(Expr::Cell(last));
        let passed = self.add(Expr::Bin(BinOp::Sub, now, before));
        let zero = self.add(Expr::I32(0));
        let another = self.add(Expr::Cmp(CmpOp::Ne, passed, zero));
        self.when(another, |this| {
            let count = this.add(Expr::Read(Access::pair(counter_place(counter.number))));
            let begin = this.add(Expr::Cell(base));
            let pulses = this.add(Expr::Bin(BinOp::Sub, count, begin));
            let pulses = this.add(Expr::Narrow(pulses));
            // Longer ago, they belong to an older millisecond.
            let one = this.add(Expr::I32(1));
            let recent = this.add(Expr::Cmp(CmpOp::Eq, passed, one));
            let recent = this.add(Expr::BitToInt(recent));
            let mask = this.add(Expr::Neg(recent));
            let pulses = this.add(Expr::Bin(BinOp::And, pulses, mask));
            this.emit(Action::Write(Access::word(axis.per_ms), pulses));
            this.emit(Action::SetCell(base, count));
            this.emit(Action::SetCell(last, now));
        });
    }

    fn millisecond_of(&mut self, axis: &Axis) -> [CellId; 2] {
        if let Some(&cells) = self.high_speed.milliseconds.get(&axis.input) {
            return cells;
        }
        let name = |what: &str| format!("x{:03o}_{what}", axis.input);
        let cells = [
            self.cell(name("ms"), "the millisecond of its last pulse"),
            self.cell(name("count"), "the count when that began"),
        ];
        self.high_speed.milliseconds.insert(axis.input, cells);
        cells
    }

    /// An edge of an input interrupts: the registers of its axis show the count.
    pub(super) fn capture_count(&mut self, input: u32) {
        let mut axes = self.model.high_speed.axes.iter();
        let Some(axis) = axes.find(|axis| axis.capture.contains(&input)) else {
            return;
        };
        let used = &self.high_speed.used;
        let counter = used
            .iter()
            .find(|used| used.counter.counts.first() == Some(&axis.input));
        if let Some(number) = counter.map(|used| used.counter.number) {
            self.capture(number, axis.captured);
        }
    }

    /// A comparison of a counter requests an interrupt: the registers of its axis show the count.
    pub(super) fn capture_at_comparison(&mut self, counted: Counted) {
        let Counted::Counter(number) = counted else {
            return;
        };
        let counter = self.model.high_speed.counter(number);
        if let Some(axis) = counter.and_then(|counter| self.axis(counter)) {
            self.capture(number, axis.compared);
        }
    }

    fn capture(&mut self, counter: u32, register: Register) {
        if self.looks_at_pair(register) {
            let count = self.add(Expr::Read(Access::pair(counter_place(counter))));
            self.emit(Action::Write(Access::pair(register), count));
        }
    }

    /// Returns true if a relay requests an interrupt that the ladder and comparisons request.
    pub(super) fn is_request(&self, target: &OperandKind) -> bool {
        let OperandKind::Device(
            Device {
                class: DeviceClass::M,
                number,
            },
            None,
        ) = *target
        else {
            return false;
        };
        let pointers = self.model.ranges_of(DeviceClass::I);
        let mut pointers = pointers.flat_map(|range| range.first..=range.last);
        pointers.any(|pointer| {
            let interrupt = self.model.interrupts.find(pointer);
            interrupt.is_some_and(|interrupt| {
                let asked = interrupt.request.is_some_and(|r| r.number() == number);
                asked && !matches!(interrupt.source, Some(Source::Input { .. }))
            })
        })
    }

    /// An axis that follows the increment of an input reads the input's count.
    pub(super) fn use_counts_of_inputs(&mut self) {
        for axis in self.model.high_speed.axes {
            if self.is_master(axis) {
                let pair = axis.count.run::<2>();
                let pair = pair.map(|register| (DeviceClass::D, register.number()));
                self.specials.flags.extend(pair);
            }
        }
    }

    /// Returns true if an axis may follow the increment of an input.
    fn is_master(&self, axis: &Axis) -> bool {
        let mut instrs = self.resolved.instrs.iter();
        self.names(axis.per_ms)
            && instrs.any(|instr| matches!(instr.lower, Some(Lower::Call(RtFn::AxisGear))))
    }

    fn looks_at_pair(&self, register: Register) -> bool {
        self.looks_at(register) || self.looks_at(register.after(1))
    }
}
