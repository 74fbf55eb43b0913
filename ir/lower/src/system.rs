//! Processing by the PLC itself around the program: special relays and registers, END processing. Emitted only for
//! devices that are used.

use super::Lowerer;
use super::operand::fixed;
use super::stl::ANNUNCIATORS;
use rungc_ir::node::{
    Access, Action, Arg, BinOp, Body, Call, Expr, ExprId, Place, Stmt, SysValue, TempId, Ty,
};
use rungc_models::special::{RunCommand, SpecialDevice};
use rungc_rt::special::*;
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::DeviceClass::{D, M, S, T, X};

/// Periods of the clock relays in milliseconds; they are on in the second half of each.
const CLOCK_PERIODS: [i32; 4] = [10, 100, 1000, 60_000];
/// Relays of HM that are the inputs from X014 on.
const VIRTUAL_INPUTS: ([Relay; 4], u32) = (M_VIRTUAL_INPUTS.run(), 0o14);
/// Parameters and state of HM's oscilloscope.
const OSCILLOSCOPE: [Register; 14] = D_SCOPE_MODE.run();
/// Clears the general, the latched devices.
const CLEAR: [(Relay, bool); 2] = [(M_CLEAR_GENERAL, false), (M_CLEAR_LATCHED, true)];
/// Second, minute, hour, day, month, year, weekday.
const CLOCK_REGISTERS: [Register; 7] = D_SECOND.run();
/// Stop and set, hold, round; an error in what was set.
const CLOCK_RELAYS: [Relay; 5] = [
    M_CLOCK_STOP,
    M_CLOCK_HOLD,
    M_CLOCK_ADJUST,
    M_CLOCK_FITTED,
    M_CLOCK_ERROR,
];

/// A list of active S devices that END processing keeps.
struct Monitor {
    /// Relay that asks for it.
    enable: Relay,
    /// Relay: any is active.
    any: Relay,
    /// Registers for the numbers of the lowest ones.
    registers: &'static [Register],
}

/// Active states.
const STATES: Monitor = Monitor {
    enable: M_STL_MONITOR,
    any: M_STATE_ON,
    registers: &D_STATES_ON.run::<8>(),
};
/// Active annunciators.
const ALARMS: Monitor = Monitor {
    enable: M_ANNUNCIATOR_MONITOR,
    any: M_ANNUNCIATOR_ON,
    registers: &[D_ANNUNCIATOR_ON],
};

impl Lowerer<'_> {
    pub(super) fn begin_function(&mut self) -> Body {
        self.body(|this| {
            this.run_flags();
            this.show_run();
            this.first_levels();
            this.begin_clock();
            this.forget_comparisons();
            this.forget_stored();
            this.forget_exclusive();
            this.clear_in_stop();
            this.forget_errors();
            this.sum_up_errors();
            this.clocks();
            this.scan_times();
            this.tick();
            this.ring_counter();
            this.slow_ring_counter();
            this.analog_inputs();
            this.begin_modules();
            this.virtual_inputs();
            this.show_axes();
            this.axis_defaults();
            this.real_time_clock();
            this.power_supply();
        })
    }

    pub(super) fn end_function(&mut self) -> Body {
        self.body(|this| {
            this.interruptible();
            this.end_modules();
            this.begin_tables();
            this.comparisons_executed();
            this.begin_rows();
            this.first_captures();
            for (number, kind) in std::mem::take(&mut this.free_running) {
                this.emit(Action::TimerGoesOn { number, kind });
                this.reset_if_held(fixed(T, number));
            }
            this.monitor(&STATES);
            this.monitor(&ALARMS);
            this.run_time();
            for (relay, latched) in CLEAR {
                if this.keeps(relay) {
                    let asked = this.add(Expr::Read(Access::bit(relay)));
                    this.when(asked, |this| {
                        this.emit(Action::Clear { latched });
                        this.release_cleared(latched);
                    });
                }
            }
            this.forced_stop();
        })
    }

    /// M8037, which a failing power supply sets, too, puts the PLC in STOP and goes off, so that the switch can start
    /// it again.
    fn forced_stop(&mut self) {
        let stop = (M, M_FORCED_STOP.number());
        if !self.keeps(M_FORCED_STOP) && !self.specials.flags.contains(&stop) {
            return;
        }
        let asked = self.add(Expr::Read(Access::bit(M_FORCED_STOP)));
        self.when(asked, |this| {
            let off = this.bit_const(false);
            this.write_relay(M_FORCED_STOP, off);
            this.emit(Action::Stop);
        });
    }

    /// Returns true if a special device is one that the scan updates on this model, and is used.
    pub(super) fn keeps<D: SpecialDevice>(&self, device: D) -> bool {
        self.specials.has(device) && self.model.scan_keeps(device)
    }

    /// Relays that STOP clears are off before the next scan.
    fn clear_in_stop(&mut self) {
        let relays = self.model.cleared_in_stop();
        let relays: Vec<_> = relays.filter(|&relay| self.specials.has(relay)).collect();
        if relays.is_empty() {
            return;
        }
        let running = self.add(Expr::Sys(SysValue::Running));
        let stopped = self.not(running);
        self.when(stopped, |this| {
            for relay in relays {
                let off = this.bit_const(false);
                this.write_relay(relay, off);
            }
        });
    }

    /// M8000 to M8003, M8038, M8411.
    fn run_flags(&mut self) {
        let running = Expr::Sys(SysValue::Running);
        let first = Expr::Sys(SysValue::FirstScan);
        for (relay, state, inverted) in [
            (M_RUNNING, running, false),
            (M_STOPPED, running, true),
            (M_FIRST_SCAN, first, false),
            (M_LINK_SET_UP, first, false),
            (M_MODBUS_SET_UP, first, false),
            (M_LATER_SCANS, first, true),
        ] {
            if self.keeps(relay) {
                let mut state = self.add(state);
                if inverted {
                    state = self.not(state);
                }
                self.write_relay(relay, state);
            }
        }
    }

    /// M8004 of HM shows RUN, unless it decides on it ([`RunCommand::Remote`]).
    fn show_run(&mut self) {
        let remote = self.model.run_command() == Some(RunCommand::Remote);
        if !remote || !self.keeps(M_REMOTE_RUN) {
            return;
        }
        let show = |this: &mut Self| {
            let running = this.add(Expr::Sys(SysValue::Running));
            this.write_relay(M_REMOTE_RUN, running);
        };
        if !self.keeps(D_REMOTE) || !self.keeps(M_LOCAL_CONTROL) {
            return show(self);
        }
        let register = self.add(Expr::Read(Access::word(D_REMOTE)));
        let key = self.int(REMOTE_KEY.into(), false);
        let locked = self.add(Expr::Cmp(CmpOp::Ne, register, key));
        let local = self.add(Expr::Read(Access::bit(M_LOCAL_CONTROL)));
        let shows = self.or(locked, local);
        self.when(shows, show);
    }

    /// M8011 to M8014: the time of the minute gives the position in its period of each.
    fn clocks(&mut self) {
        for (relay, period) in M_CLOCK_10_MS.run::<4>().into_iter().zip(CLOCK_PERIODS) {
            if !self.keeps(relay) {
                continue;
            }
            let minute = self.add(Expr::Sys(SysValue::MinuteMs));
            let length = self.add(Expr::I32(period));
            let part = self.add(Expr::Bin(BinOp::Rem, minute, length));
            let half = self.add(Expr::I32(period / 2));
            let on = self.add(Expr::Cmp(CmpOp::Ge, part, half));
            self.write_relay(relay, on);
        }
    }

    /// D8010 to D8012. Before the first scan has ended there is no time to show.
    fn scan_times(&mut self) {
        if ![D_SCAN_TIME, D_LEAST_SCAN_TIME, D_MOST_SCAN_TIME]
            .iter()
            .any(|&register| self.keeps(register))
        {
            return;
        }
        let time = self.add(Expr::Sys(SysValue::Scan100us));
        let time = self.add(Expr::Narrow(time));
        let zero = self.int(0, false);
        let known = self.add(Expr::Cmp(CmpOp::Gt, time, zero));
        self.when(known, |this| {
            if this.keeps(D_SCAN_TIME) {
                this.emit(Action::Write(Access::word(D_SCAN_TIME), time));
            }
            if this.keeps(D_LEAST_SCAN_TIME) {
                let least = this.add(Expr::Read(Access::word(D_LEAST_SCAN_TIME)));
                let unset = this.add(Expr::Cmp(CmpOp::Eq, least, zero));
                let less = this.add(Expr::Cmp(CmpOp::Lt, time, least));
                let better = this.or(unset, less);
                this.when(better, |this| {
                    this.emit(Action::Write(Access::word(D_LEAST_SCAN_TIME), time));
                });
            }
            if this.keeps(D_MOST_SCAN_TIME) {
                let most = this.add(Expr::Read(Access::word(D_MOST_SCAN_TIME)));
                let more = this.add(Expr::Cmp(CmpOp::Gt, time, most));
                this.when(more, |this| {
                    this.emit(Action::Write(Access::word(D_MOST_SCAN_TIME), time));
                });
            }
        });
    }

    /// D8007 to D8009 (HM): the time since power-on in units of 50 us, and in milliseconds.
    fn tick(&mut self) {
        if self.model.shows_power_supply() {
            return;
        }
        if self.keeps(D_SHORT_TICK) {
            let now = self.add(Expr::Sys(SysValue::NowMs));
            let units = self.add(Expr::I32(20));
            let now = self.add(Expr::Bin(BinOp::Mul, now, units));
            let word = self.add(Expr::Narrow(now));
            self.emit(Action::Write(Access::word(D_SHORT_TICK), word));
        }
        let tick = D_TICK.run();
        let [low, high] = tick.map(|register| self.keeps(register));
        let now = self.add(Expr::Sys(SysValue::NowMs));
        if low {
            let word = self.add(Expr::Narrow(now));
            self.emit(Action::Write(Access::word(tick[0]), word));
        }
        if high {
            let word = self.add(Expr::HighWord(now));
            self.emit(Action::Write(Access::word(tick[1]), word));
        }
    }

    /// D8099 counts tenths of milliseconds up to 32767 and from 0 again while M8099 is on.
    fn ring_counter(&mut self) {
        let (relay, register) = (M_RING_COUNTER, D_RING_COUNTER);
        if !self.keeps(relay) || !self.keeps(register) {
            return;
        }
        let counts = self.add(Expr::Read(Access::bit(relay)));
        self.when(counts, |this| {
            let count = this.add(Expr::Read(Access::word(register)));
            let passed = this.add(Expr::Sys(SysValue::Scan100us));
            let passed = this.add(Expr::Narrow(passed));
            let count = this.add(Expr::Bin(BinOp::Add, count, passed));
            let mask = this.int(i32::from(i16::MAX), false);
            let count = this.add(Expr::Bin(BinOp::And, count, mask));
            this.emit(Action::Write(Access::word(register), count));
        });
    }

    /// D8398 and D8399 count milliseconds; on the models that have M8398, while it is on.
    fn slow_ring_counter(&mut self) {
        let (relay, registers): (_, [_; 2]) = (M_SLOW_RING_COUNTER, D_SLOW_RING_COUNTER.run());
        if !registers.iter().any(|&register| self.keeps(register)) {
            return;
        }
        let count = |this: &mut Self| this.count_ring(registers);
        if !self.model.scan_keeps(relay) {
            count(self);
        } else if self.keeps(relay) {
            let counts = self.add(Expr::Read(Access::bit(relay)));
            self.when(counts, count);
        }
    }

    /// D8398 and D8399 are a number of 31 bits.
    fn count_ring(&mut self, registers: [Register; 2]) {
        self.specials
            .flags
            .extend(registers.map(|register| (D, register.number())));
        let pair = Access::pair(registers[0]);
        let count = self.add(Expr::Read(pair));
        let passed = self.add(Expr::Sys(SysValue::SinceScanMs));
        let count = self.add(Expr::Bin(BinOp::Add, count, passed));
        let mask = self.int(i32::MAX, true);
        let count = self.add(Expr::Bin(BinOp::And, count, mask));
        self.emit(Action::Write(pair, count));
    }

    /// M8015 to M8019 and D8013 to D8019.
    fn real_time_clock(&mut self) {
        if !CLOCK_REGISTERS.iter().any(|&register| self.keeps(register))
            && !CLOCK_RELAYS.iter().any(|&relay| self.keeps(relay))
        {
            return;
        }
        // All seven registers make a moment.
        self.call_system(self.clock_function(), &CLOCK_REGISTERS);
    }

    /// M8005 to M8008 and D8005 to D8008. A failure that lasts ends in STOP.
    fn power_supply(&mut self) {
        let battery = self.keeps(M_BATTERY_LOW)
            || self.keeps(M_BATTERY_HAS_BEEN_LOW)
            || self.keeps(D_BATTERY);
        let supply = self.keeps(M_POWER_FAILS)
            || self.keeps(M_POWER_FAILURE)
            || self.keeps(D_POWER_FAILURES);
        let shows = self.model.shows_power_supply();
        if !shows || !(battery || supply) {
            return;
        }
        if supply {
            let stop = (M, M_FORCED_STOP.number());
            self.specials.flags.push(stop);
        }
        let registers = [D_BATTERY_LOW, D_POWER_FAILURE_MS];
        self.call_system(RtFn::PowerSupply, &registers);
    }

    /// Calls a function that keeps special registers. They are all stored, even if the program looks at one.
    pub(super) fn call_system(&mut self, function: RtFn, registers: &[Register]) {
        self.call_system_with(function, registers, Vec::new());
    }

    pub(super) fn call_system_with(
        &mut self,
        function: RtFn,
        registers: &[Register],
        args: Vec<Arg>,
    ) {
        let registers = registers.iter().map(|register| (D, register.number()));
        self.specials.flags.extend(registers);
        let needs = function.needs();
        let drive = needs.always.then(|| self.bit_const(true));
        self.module.states = self.module.states.saturating_add(needs.state.into());
        self.emit(Action::Call(Call {
            function,
            wide: false,
            args,
            drive,
            signal: false,
            period_ms: 0,
            slot: if needs.state { self.module.states } else { 0 },
            step: 0,
        }));
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
        self.call_system_with(RtFn::Oscilloscope, &OSCILLOSCOPE, vec![now, registers]);
    }

    /// D8030 to D8045: analog inputs where something switches them on (L01S), else potentiometers (FX3G).
    fn analog_inputs(&mut self) {
        let values = D_ANALOG_INPUTS.run::<16>();
        if !values.iter().any(|&register| self.keeps(register)) {
            return;
        }
        if self.model.scan_keeps(D_ANALOG_ENABLE) {
            let registers = [&values[..], &[D_ANALOG_ENABLE]].concat();
            self.call_system(RtFn::AnalogInputs, &registers);
        } else {
            self.call_system(RtFn::Potentiometers, &values[..2]);
        }
    }

    /// M8160 to M8163 (HM) stand for inputs without a terminal.
    fn virtual_inputs(&mut self) {
        let (relays, input) = VIRTUAL_INPUTS;
        for (relay, input) in relays.into_iter().zip(input..) {
            if self.keeps(relay) {
                let on = self.add(Expr::Read(Access::bit(relay)));
                self.write_device(X, input, on);
            }
        }
    }

    /// The year has as many digits as the clock's registers show.
    fn clock_function(&self) -> RtFn {
        match self.model.two_digit_years {
            true => RtFn::ClockRefreshShort,
            false => RtFn::ClockRefresh,
        }
    }

    /// While it is enabled, lists the lowest active S devices. A register without one is 0.
    fn monitor(&mut self, monitor: &Monitor) {
        let registers: Vec<Option<Register>> = monitor
            .registers
            .iter()
            .map(|&register| self.keeps(register).then_some(register))
            .collect();
        let any = self.keeps(monitor.any);
        if !self.keeps(monitor.enable) || !any && registers.iter().all(Option::is_none) {
            return;
        }
        let enabled = self.add(Expr::Read(Access::bit(monitor.enable)));
        let runs = self.monitored(monitor);
        self.when(enabled, |this| {
            let zero = this.add(Expr::I32(0));
            let found = this.temp(Ty::I32);
            this.emit(Action::Let(found, zero));
            let none = this.int(0, false);
            for &register in registers.iter().flatten() {
                this.emit(Action::Write(Access::word(register), none));
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
                this.write_relay(monitor.any, some);
            }
        });
        if any {
            let disabled = self.not(enabled);
            self.when(disabled, |this| {
                let off = this.bit_const(false);
                this.write_relay(monitor.any, off);
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
    fn list_active(
        &mut self,
        first: u32,
        last: u32,
        found: TempId,
        registers: &[Option<Register>],
    ) {
        let zero = self.add(Expr::I32(0));
        let one = self.add(Expr::I32(1));
        let offset = self.temp(Ty::I32);
        self.emit(Action::Let(offset, zero));
        let index = self.add(Expr::Temp(offset));
        let count = self.int((last - first + 1) as i32, false);
        let body = self.body(|this| {
            let on = this.add(Expr::Read(Access::bit(Place {
                class: S,
                number: first,
                index: Some(index),
            })));
            this.when(on, |this| {
                let base = this.add(Expr::I32(first as i32));
                let number = this.add(Expr::Bin(BinOp::Add, base, index));
                let number = this.add(Expr::Narrow(number));
                this.note_active(number, found, registers);
                let so_far = this.add(Expr::Temp(found));
                let next = this.add(Expr::Bin(BinOp::Add, so_far, one));
                this.emit(Action::Let(found, next));
            });
            let next = this.add(Expr::Bin(BinOp::Add, index, one));
            this.emit(Action::Let(offset, next));
        });
        self.emit(Stmt::For { count, body });
    }

    fn note_active(&mut self, number: ExprId, found: TempId, registers: &[Option<Register>]) {
        for (n, register) in registers.iter().enumerate() {
            let Some(register) = *register else {
                continue;
            };
            let so_far = self.add(Expr::Temp(found));
            let n = self.add(Expr::I32(n as i32));
            let here = self.add(Expr::Cmp(CmpOp::Eq, so_far, n));
            self.when(here, |this| {
                this.emit(Action::Write(Access::word(register), number));
            });
        }
    }
}
