//! What the PLC itself does around the program: special relays and registers, END processing. Only for devices that something
//! looks at.

use super::Lowerer;
use super::operand::fixed;
use super::stl::ANNUNCIATORS;
use crate::catalogue::{self, CmpOp, Lower};
use crate::node::{BinOp, Body, Expr, ExprId, Place, Stmt, SysValue, TempId, Ty};
use crate::special::{self, Status};
use rungc_rt::RtFn;
use rungc_syntax::DeviceClass::{self, D, M, S};

/// Clock relays and their periods in milliseconds; on in the second half of each.
const CLOCKS: [(u32, i32); 4] = [(8011, 10), (8012, 100), (8013, 1000), (8014, 60_000)];
/// Scan time now, least, most (0.1 ms).
const SCAN_TIME: u32 = 8010;
const LEAST_SCAN_TIME: u32 = 8011;
const MOST_SCAN_TIME: u32 = 8012;
/// Relays that stand for an error of the run that is over.
const ERRORS: [u32; 2] = [8004, 8067];
/// Relay and step of an operation error as the runtime reports it.
const OPERATION_ERROR: (u32, u32) = (8067, 8069);
/// Relay and step of a run error of HM.
const RUN_ERROR: (u32, u32) = (8006, 8006);
/// Clears the general, the latched devices.
const CLEAR: [(u32, bool); 2] = [(8031, false), (8032, true)];
/// Relay and register of the ring counter.
const RING_COUNTER: (u32, u32) = (8099, 8099);
/// Milliseconds since power-on, low and high word.
const TICK: [u32; 2] = [8008, 8009];
/// Second, minute, hour, day, month, year, weekday.
const CLOCK_REGISTERS: std::ops::RangeInclusive<u32> = 8013..=8019;
/// Stop and set, hold, round; an error in what was set.
const CLOCK_RELAYS: [u32; 4] = [8015, 8016, 8017, 8019];
/// Real-time clock fitted.
const CLOCK_FITTED: u32 = 8018;

/// A list of active S devices that END processing keeps.
struct Monitor {
    /// Relay that asks for it.
    enable: u32,
    /// Relay: any is active.
    any: u32,
    /// Registers for the numbers of the lowest ones.
    registers: std::ops::RangeInclusive<u32>,
}

/// Active states.
const STATES: Monitor = Monitor {
    enable: 8047,
    any: 8046,
    registers: 8040..=8047,
};
/// Active annunciators.
const ALARMS: Monitor = Monitor {
    enable: 8049,
    any: 8048,
    registers: 8049..=8049,
};

impl Lowerer<'_> {
    pub(super) fn begin_function(&mut self) -> Body {
        self.body(|this| {
            this.run_flags();
            this.forget_errors();
            this.clocks();
            this.scan_times();
            this.tick();
            this.ring_counter();
            this.real_time_clock();
        })
    }

    pub(super) fn end_function(&mut self) -> Body {
        self.body(|this| {
            this.monitor(&STATES);
            this.monitor(&ALARMS);
            this.run_error();
            for (relay, latched) in CLEAR {
                if this.keeps(M, relay) {
                    let asked = this.add(Expr::ReadBit(fixed(M, relay)));
                    this.when(asked, |this| this.emit(Stmt::Clear { latched }));
                }
            }
        })
    }

    /// Whether a special device is one that the scan keeps on this model, and something looks at it.
    fn keeps(&self, class: DeviceClass, number: u32) -> bool {
        self.specials.has(class, number)
            && special::find(self.model.id, class, number)
                .is_some_and(|row| matches!(row.status, Status::Scan))
    }

    /// M8000 to M8003.
    fn run_flags(&mut self) {
        let running = Expr::Sys(SysValue::Running);
        let first = Expr::Sys(SysValue::FirstScan);
        for (relay, state, inverted) in [
            (8000, running, false),
            (8001, running, true),
            (8002, first, false),
            (8003, first, true),
        ] {
            if self.keeps(M, relay) {
                let mut state = self.add(state);
                if inverted {
                    state = self.not(state);
                }
                self.write_device(M, relay, state);
            }
        }
    }

    /// The errors of the last run are forgotten when RUN begins; their latches are not.
    fn forget_errors(&mut self) {
        let errors: Vec<u32> = ERRORS
            .into_iter()
            .filter(|&relay| self.keeps(M, relay))
            .collect();
        if errors.is_empty() {
            return;
        }
        let first = self.add(Expr::Sys(SysValue::FirstScan));
        self.when(first, |this| {
            let off = this.bit_const(false);
            for relay in errors {
                this.write_device(M, relay, off);
            }
        });
    }

    /// M8011 to M8014: the time since power-on, without its sign bit, tells where in its period each is.
    fn clocks(&mut self) {
        for (relay, period) in CLOCKS {
            if !self.keeps(M, relay) {
                continue;
            }
            let now = self.add(Expr::Sys(SysValue::NowMs));
            let mask = self.add(Expr::I32(i32::MAX));
            let now = self.add(Expr::Bin(BinOp::And, now, mask));
            let length = self.add(Expr::I32(period));
            let part = self.add(Expr::Bin(BinOp::Rem, now, length));
            let half = self.add(Expr::I32(period / 2));
            let on = self.add(Expr::Cmp(CmpOp::Ge, part, half));
            self.write_device(M, relay, on);
        }
    }

    /// D8010 to D8012. Before the first scan has ended there is no time to show.
    fn scan_times(&mut self) {
        if ![SCAN_TIME, LEAST_SCAN_TIME, MOST_SCAN_TIME]
            .iter()
            .any(|&register| self.keeps(D, register))
        {
            return;
        }
        let time = self.add(Expr::Sys(SysValue::Scan100us));
        let time = self.add(Expr::Narrow(time));
        let zero = self.int(0, false);
        let known = self.add(Expr::Cmp(CmpOp::Gt, time, zero));
        self.when(known, |this| {
            if this.keeps(D, SCAN_TIME) {
                this.emit(Stmt::WriteWord(fixed(D, SCAN_TIME), time));
            }
            if this.keeps(D, LEAST_SCAN_TIME) {
                let least = this.add(Expr::ReadWord(fixed(D, LEAST_SCAN_TIME)));
                let unset = this.add(Expr::Cmp(CmpOp::Eq, least, zero));
                let less = this.add(Expr::Cmp(CmpOp::Lt, time, least));
                let better = this.or(unset, less);
                this.when(better, |this| {
                    this.emit(Stmt::WriteWord(fixed(D, LEAST_SCAN_TIME), time));
                });
            }
            if this.keeps(D, MOST_SCAN_TIME) {
                let most = this.add(Expr::ReadWord(fixed(D, MOST_SCAN_TIME)));
                let more = this.add(Expr::Cmp(CmpOp::Gt, time, most));
                this.when(more, |this| {
                    this.emit(Stmt::WriteWord(fixed(D, MOST_SCAN_TIME), time));
                });
            }
        });
    }

    /// D8008 and D8009 (HM): the milliseconds since power-on.
    fn tick(&mut self) {
        let [low, high] = TICK.map(|register| self.keeps(D, register));
        let now = self.add(Expr::Sys(SysValue::NowMs));
        if low {
            let word = self.add(Expr::Narrow(now));
            self.emit(Stmt::WriteWord(fixed(D, TICK[0]), word));
        }
        if high {
            let word = self.add(Expr::HighWord(now));
            self.emit(Stmt::WriteWord(fixed(D, TICK[1]), word));
        }
    }

    /// D8099 counts tenths of milliseconds up to 32767 and from 0 again while M8099 is on.
    fn ring_counter(&mut self) {
        let (relay, register) = RING_COUNTER;
        if !self.keeps(M, relay) || !self.keeps(D, register) {
            return;
        }
        let counts = self.add(Expr::ReadBit(fixed(M, relay)));
        self.when(counts, |this| {
            let count = this.add(Expr::ReadWord(fixed(D, register)));
            let passed = this.add(Expr::Sys(SysValue::Scan100us));
            let passed = this.add(Expr::Narrow(passed));
            let count = this.add(Expr::Bin(BinOp::Add, count, passed));
            let mask = this.int(i32::from(i16::MAX), false);
            let count = this.add(Expr::Bin(BinOp::And, count, mask));
            this.emit(Stmt::WriteWord(fixed(D, register), count));
        });
    }

    /// M8015 to M8019 and D8013 to D8019.
    fn real_time_clock(&mut self) {
        if self.keeps(M, CLOCK_FITTED) {
            let on = self.bit_const(true);
            self.write_device(M, CLOCK_FITTED, on);
        }
        let registers = CLOCK_REGISTERS.map(|register| (D, register));
        let mut devices = registers.chain(CLOCK_RELAYS.map(|relay| (M, relay)));
        if !devices.any(|(class, number)| self.keeps(class, number)) {
            return;
        }
        // All seven registers make a moment, even if the program looks at one.
        self.specials
            .flags
            .extend(CLOCK_REGISTERS.map(|register| (D, register)));
        let drive = self.bit_const(true);
        self.module.states = self.module.states.saturating_add(1);
        self.emit(Stmt::Call {
            function: self.clock_function(),
            wide: false,
            args: Vec::new(),
            drive: Some(drive),
            slot: self.module.states,
            step: 0,
        });
    }

    /// The year has as many digits as TRD reads.
    fn clock_function(&self) -> RtFn {
        match catalogue::find("TRD").map(|found| found.inst.lower_on_model(self.model.id)) {
            Some(Lower::Call(RtFn::TrdShort)) => RtFn::ClockRefreshShort,
            _ => RtFn::ClockRefresh,
        }
    }

    /// HM shows an operation error in M8006 and D8006. The runtime reports it in the devices that the rest of the family has for it;
    /// on HM these mask interrupts, so a program that uses them for that is shown no error.
    fn run_error(&mut self) {
        let [relay, register] = [(M, RUN_ERROR.0), (D, RUN_ERROR.1)];
        let (shows, tells) = (
            self.keeps(relay.0, relay.1),
            self.keeps(register.0, register.1),
        );
        if !shows && !tells || self.specials.has(M, OPERATION_ERROR.0) {
            return;
        }
        self.specials.flags.push((M, OPERATION_ERROR.0));
        self.specials.flags.push((D, OPERATION_ERROR.1));
        let error = self.add(Expr::ReadBit(fixed(M, OPERATION_ERROR.0)));
        self.when(error, |this| {
            if shows {
                let on = this.bit_const(true);
                this.write_device(M, relay.1, on);
            }
            if tells {
                let step = this.add(Expr::ReadWord(fixed(D, OPERATION_ERROR.1)));
                this.emit(Stmt::WriteWord(fixed(D, register.1), step));
            }
        });
    }

    /// While it is enabled, lists the lowest active S devices. A register without one keeps its value.
    fn monitor(&mut self, monitor: &Monitor) {
        let registers: Vec<u32> = monitor
            .registers
            .clone()
            .map(
                |register| {
                    if self.keeps(D, register) { register } else { 0 }
                },
            )
            .collect();
        let any = self.keeps(M, monitor.any);
        if !self.keeps(M, monitor.enable) || !any && registers.iter().all(|&register| register == 0)
        {
            return;
        }
        let enabled = self.add(Expr::ReadBit(fixed(M, monitor.enable)));
        let runs = self.monitored(monitor);
        self.when(enabled, |this| {
            let zero = this.add(Expr::I32(0));
            let found = this.temp(Ty::I32);
            this.emit(Stmt::Let(found, zero));
            for (first, last) in runs {
                this.list_active(first, last, found, &registers);
            }
            if any {
                let found = this.add(Expr::Temp(found));
                let some = this.add(Expr::Cmp(CmpOp::Gt, found, zero));
                this.write_device(M, monitor.any, some);
            }
        });
        if any {
            let disabled = self.not(enabled);
            self.when(disabled, |this| {
                let off = this.bit_const(false);
                this.write_device(M, monitor.any, off);
            });
        }
    }

    /// The runs of S devices that a monitor looks at.
    fn monitored(&self, monitor: &Monitor) -> Vec<(u32, u32)> {
        let (from, to) = (*ANNUNCIATORS.start(), *ANNUNCIATORS.end());
        let mut runs = Vec::new();
        for &(first, last) in &self.runs[S as usize] {
            let parts = if monitor.enable == ALARMS.enable {
                vec![(first.max(from), last.min(to))]
            } else {
                vec![(first, last.min(from - 1)), (first.max(to + 1), last)]
            };
            runs.extend(parts.into_iter().filter(|(first, last)| first <= last));
        }
        runs
    }

    /// Goes through S devices in order; writes the number of the nth active one to the nth register and counts them.
    fn list_active(&mut self, first: u32, last: u32, found: TempId, registers: &[u32]) {
        let zero = self.add(Expr::I32(0));
        let one = self.add(Expr::I32(1));
        let offset = self.temp(Ty::I32);
        self.emit(Stmt::Let(offset, zero));
        let index = self.add(Expr::Temp(offset));
        let count = self.int((last - first + 1) as i32, false);
        let body = self.body(|this| {
            let on = this.add(Expr::ReadBit(Place {
                class: S,
                number: first,
                index: Some(index),
            }));
            this.when(on, |this| {
                let base = this.add(Expr::I32(first as i32));
                let number = this.add(Expr::Bin(BinOp::Add, base, index));
                let number = this.add(Expr::Narrow(number));
                this.note_active(number, found, registers);
                let so_far = this.add(Expr::Temp(found));
                let next = this.add(Expr::Bin(BinOp::Add, so_far, one));
                this.emit(Stmt::Let(found, next));
            });
            let next = this.add(Expr::Bin(BinOp::Add, index, one));
            this.emit(Stmt::Let(offset, next));
        });
        self.emit(Stmt::For { count, body });
    }

    fn note_active(&mut self, number: ExprId, found: TempId, registers: &[u32]) {
        for (n, &register) in registers.iter().enumerate() {
            if register == 0 {
                continue;
            }
            let so_far = self.add(Expr::Temp(found));
            let n = self.add(Expr::I32(n as i32));
            let here = self.add(Expr::Cmp(CmpOp::Eq, so_far, n));
            self.when(here, |this| {
                this.emit(Stmt::WriteWord(fixed(D, register), number));
            });
        }
    }
}
