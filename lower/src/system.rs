//! What the PLC itself does around the program: special relays and registers, END processing. Only for devices that something
//! looks at.

use super::Lowerer;
use super::operand::fixed;
use super::stl::ANNUNCIATORS;
use rungc_catalogue::Lower;
use rungc_ir::node::{Arg, BinOp, Body, Expr, ExprId, Place, Stmt, SysValue, TempId, Ty};
use rungc_models::special;
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::DeviceClass::{self, D, M, S, X};

/// Clock relays and their periods in milliseconds; on in the second half of each.
const CLOCKS: [(u32, i32); 4] = [(8011, 10), (8012, 100), (8013, 1000), (8014, 60_000)];
/// Scan time now, least, most (0.1 ms).
const SCAN_TIME: u32 = 8010;
const LEAST_SCAN_TIME: u32 = 8011;
const MOST_SCAN_TIME: u32 = 8012;
/// Relay for any error of the run, and the register that tells which.
const ANY_ERROR: u32 = 8004;
/// Code of the last operation error.
const OPERATION_ERROR: u32 = 8067;
/// The error log of H1U/H2U: hours and codes, ten each; the running time in seconds; and the registers that tell which error and where.
const ERROR_LOG: std::ops::RangeInclusive<u32> = 8490..=8511;
const LAST_ERROR: [u32; 2] = [8067, 8069];
/// Values of the built-in analog inputs of L01S, and the register that switches them on.
const ANALOG_INPUTS: std::ops::RangeInclusive<u32> = 8030..=8045;
const ANALOG_ENABLE: u32 = 8114;
/// Positions of the potentiometers of FX3G.
const POTENTIOMETERS: std::ops::RangeInclusive<u32> = 8030..=8031;
/// Relays of HM that are the inputs from X014 on.
const VIRTUAL_INPUTS: (std::ops::RangeInclusive<u32>, u32) = (8160..=8163, 0o14);
/// Parameters and state of HM's oscilloscope.
const OSCILLOSCOPE: std::ops::RangeInclusive<u32> = 8030..=8043;
/// Clears the general, the latched devices.
const CLEAR: [(u32, bool); 2] = [(8031, false), (8032, true)];
/// Puts the PLC in STOP.
const FORCED_STOP: u32 = 8037;
/// Relay and register of the ring counter.
const RING_COUNTER: (u32, u32) = (8099, 8099);
/// Relay and registers of the ring counter of milliseconds; L01S has only the registers.
const SLOW_RING_COUNTER: (u32, [u32; 2]) = (8398, [8398, 8399]);
/// Units of 50 us since power-on.
const SHORT_TICK: u32 = 8007;
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
            this.first_levels();
            this.begin_clock();
            this.forget_comparisons();
            this.forget_stored();
            this.forget_exclusive();
            this.clear_in_stop();
            this.forget_errors();
            this.clocks();
            this.scan_times();
            this.tick();
            this.ring_counter();
            this.slow_ring_counter();
            this.analog_inputs();
            this.virtual_inputs();
            this.show_axes();
            this.axis_defaults();
            this.real_time_clock();
        })
    }

    pub(super) fn end_function(&mut self) -> Body {
        self.body(|this| {
            this.interruptible();
            this.begin_tables();
            this.begin_rows();
            this.first_captures();
            for (number, kind) in std::mem::take(&mut this.free_running) {
                this.emit(Stmt::TimerGoesOn { number, kind });
            }
            this.monitor(&STATES);
            this.monitor(&ALARMS);
            this.error_log();
            for (relay, latched) in CLEAR {
                if this.keeps(M, relay) {
                    let asked = this.add(Expr::ReadBit(fixed(M, relay)));
                    this.when(asked, |this| this.emit(Stmt::Clear { latched }));
                }
            }
            this.forced_stop();
        })
    }

    /// M8037 puts the PLC in STOP and goes off, so that the switch can start it again.
    fn forced_stop(&mut self) {
        if !self.keeps(M, FORCED_STOP) {
            return;
        }
        let asked = self.add(Expr::ReadBit(fixed(M, FORCED_STOP)));
        self.when(asked, |this| {
            let off = this.bit_const(false);
            this.write_device(M, FORCED_STOP, off);
            this.emit(Stmt::Stop);
        });
    }

    /// Whether a special device is one that the scan keeps on this model, and something looks at it.
    pub(super) fn keeps(&self, class: DeviceClass, number: u32) -> bool {
        self.specials.has(class, number) && self.scan_has(class, number)
    }

    /// Whether a special device is one that the scan keeps on this model.
    fn scan_has(&self, class: DeviceClass, number: u32) -> bool {
        special::find(self.model.id, class, number).is_some_and(special::Special::is_kept_by_scan)
    }

    /// Relays that STOP clears are off before the next scan.
    fn clear_in_stop(&mut self) {
        let relays: Vec<u32> = special::cleared_in_stop(self.model.id)
            .filter(|&relay| self.specials.has(M, relay))
            .collect();
        if relays.is_empty() {
            return;
        }
        let running = self.add(Expr::Sys(SysValue::Running));
        let stopped = self.not(running);
        self.when(stopped, |this| {
            for relay in relays {
                let off = this.bit_const(false);
                this.write_device(M, relay, off);
            }
        });
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
        let errors: Vec<u32> = [ANY_ERROR, self.model.error_relay]
            .into_iter()
            .filter(|&relay| self.keeps(M, relay))
            .collect();
        // The code of FX shows the last error as long as there was no other.
        let code = (!self.model.errors_last_a_scan).then_some(OPERATION_ERROR);
        let registers: Vec<u32> = [Some(ANY_ERROR), code]
            .into_iter()
            .flatten()
            .filter(|&register| self.keeps(D, register))
            .collect();
        if errors.is_empty() && registers.is_empty() {
            return;
        }
        let forget = |this: &mut Self| {
            let off = this.bit_const(false);
            for relay in errors {
                this.write_device(M, relay, off);
            }
            for register in registers {
                let none = this.int(0, false);
                this.emit(Stmt::WriteWord(fixed(D, register), none));
            }
        };
        let when = if self.model.errors_last_a_scan {
            SysValue::Running
        } else {
            SysValue::FirstScan
        };
        let when = self.add(Expr::Sys(when));
        self.when(when, forget);
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

    /// D8007 to D8009 (HM): the time since power-on in units of 50 us, and in milliseconds.
    fn tick(&mut self) {
        if self.keeps(D, SHORT_TICK) {
            let now = self.add(Expr::Sys(SysValue::NowMs));
            let units = self.add(Expr::I32(20));
            let now = self.add(Expr::Bin(BinOp::Mul, now, units));
            let word = self.add(Expr::Narrow(now));
            self.emit(Stmt::WriteWord(fixed(D, SHORT_TICK), word));
        }
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

    /// D8398 and D8399 count milliseconds; on the models that have M8398, while it is on.
    fn slow_ring_counter(&mut self) {
        let (relay, registers) = SLOW_RING_COUNTER;
        if !registers.iter().any(|&register| self.keeps(D, register)) {
            return;
        }
        let count = |this: &mut Self| this.call_system(RtFn::RingCounter, registers.into_iter());
        if !self.scan_has(M, relay) {
            count(self);
        } else if self.keeps(M, relay) {
            let counts = self.add(Expr::ReadBit(fixed(M, relay)));
            self.when(counts, count);
        }
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
        // All seven registers make a moment.
        self.call_system(self.clock_function(), CLOCK_REGISTERS);
    }

    /// Calls a function that keeps special registers. They are all stored, even if the program looks at one.
    fn call_system(&mut self, function: RtFn, registers: impl Iterator<Item = u32>) {
        self.call_system_with(function, registers, Vec::new());
    }

    fn call_system_with(
        &mut self,
        function: RtFn,
        registers: impl Iterator<Item = u32>,
        args: Vec<Arg>,
    ) {
        self.specials
            .flags
            .extend(registers.map(|register| (D, register)));
        let needs = function.needs();
        let drive = needs.always.then(|| self.bit_const(true));
        self.module.states = self.module.states.saturating_add(needs.state.into());
        self.emit(Stmt::Call {
            function,
            wide: false,
            args,
            drive,
            signal: false,
            slot: if needs.state { self.module.states } else { 0 },
            step: 0,
        });
    }

    /// D8030 to D8043 (HM): what is recorded, and where, is known only in a run.
    pub(super) fn oscilloscope(&mut self) {
        let clock = self.clock();
        let now = self.add(Expr::Cell(clock));
        let now = Arg::Const {
            value: 0,
            index: Some(now),
            wide: true,
        };
        let registers = Arg::Device {
            place: fixed(D, 0),
            extent: None,
        };
        self.call_system_with(RtFn::Oscilloscope, OSCILLOSCOPE, vec![now, registers]);
    }

    /// D8490 to D8511 (H1U/H2U).
    fn error_log(&mut self) {
        if ERROR_LOG
            .into_iter()
            .any(|register| self.keeps(D, register))
        {
            self.call_system(RtFn::ErrorLog, ERROR_LOG.chain(LAST_ERROR));
        }
    }

    /// D8030 to D8045: analog inputs where something switches them on (L01S), else potentiometers (FX3G).
    fn analog_inputs(&mut self) {
        let mut registers = ANALOG_INPUTS;
        if !registers.any(|register| self.keeps(D, register)) {
            return;
        }
        if self.scan_has(D, ANALOG_ENABLE) {
            self.call_system(RtFn::AnalogInputs, ANALOG_INPUTS.chain([ANALOG_ENABLE]));
        } else {
            self.call_system(RtFn::Potentiometers, POTENTIOMETERS);
        }
    }

    /// M8160 to M8163 (HM) stand for inputs without a terminal.
    fn virtual_inputs(&mut self) {
        let (relays, input) = VIRTUAL_INPUTS;
        for (relay, input) in relays.zip(input..) {
            if self.keeps(M, relay) {
                let on = self.add(Expr::ReadBit(fixed(M, relay)));
                self.write_device(X, input, on);
            }
        }
    }

    /// The year has as many digits as TRD reads.
    fn clock_function(&self) -> RtFn {
        match rungc_catalogue::find("TRD").map(|found| found.inst.lower_on_model(self.model.id)) {
            Some(Lower::Call(RtFn::TrdShort)) => RtFn::ClockRefreshShort,
            _ => RtFn::ClockRefresh,
        }
    }

    /// While it is enabled, lists the lowest active S devices. A register without one is 0.
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
            let none = this.int(0, false);
            for &register in registers.iter().filter(|&&register| register != 0) {
                this.emit(Stmt::WriteWord(fixed(D, register), none));
            }
            for (first, last) in runs {
                this.list_active(first, last, found, &registers);
            }
            if any {
                for (first, last) in this.also_active(monitor) {
                    this.list_active(first, last, found, &[]);
                }
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

    /// The runs of S devices that a monitor's relay shows but its registers do not list.
    fn also_active(&self, monitor: &Monitor) -> Vec<(u32, u32)> {
        if monitor.enable == STATES.enable && self.model.annunciators_are_states {
            self.monitored(&ALARMS)
        } else {
            Vec::new()
        }
    }

    /// The runs of S devices that a monitor lists.
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
