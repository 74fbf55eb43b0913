//! The control of temperatures by H2U-4PT-XP and H2U-4TC-XP (h1u-h2u-programming §6.6, items 11 to 14).
//!
//! Each channel has a main output, which heats (reverse action) or cools (direct action), and can have a second one for
//! the other direction. The manual names the settings and prints no formula: PID has the position form, with the
//! derivative of the measured value, and tuning is the step response of the instruction PID.

use super::unit::CHANNELS;
use super::{Module, Role, Term};
use crate::fnc::pid::{TUNE_MIN_DISTANCE, Tuned, setting};

/// Bits of the kind of control.
const DIGITAL: i16 = 1;
const ON_OFF: i16 = 1 << 1;
const TWO_SIDED: i16 = 1 << 2;
const REVERSE: i16 = 1 << 3;
const TUNE: i16 = 1 << 4;
const RAMP: i16 = 1 << 5;

/// Alarms that the step response has.
const TOO_CLOSE: i16 = 50;
const WRONG_WAY: i16 = 51;
const UP_AND_DOWN: i16 = 52;

/// Largest fall of the measured value that tuning tolerates, in 0.1 °C.
const MOST_FALL: f32 = TUNE_MIN_DISTANCE / 3.0;

/// Limits: the bit that switches them on, that of the warning, the alarm if they are the wrong way round, and their
/// words.
struct Limits {
    bit: i16,
    warning: i16,
    alarm: i16,
    upper: Term,
    lower: Term,
}

const fn limits(bit: u8, warning: u8, alarm: i16, upper: Term, lower: Term) -> Limits {
    Limits {
        bit: 1 << bit,
        warning: 1 << warning,
        alarm,
        upper,
        lower,
    }
}

const INPUT: Limits = limits(0, 0, 1, Term::UpperInput, Term::LowerInput);
const OUTPUT: Limits = limits(2, 2, 3, Term::UpperMain, Term::LowerMain);
const SETPOINT: Limits = limits(3, 1, 4, Term::UpperSetpoint, Term::LowerSetpoint);
const INPUT_CHANGE: Limits = limits(4, 4, 5, Term::UpperInputChange, Term::LowerInputChange);
const OUTPUT_CHANGE: Limits = limits(5, 5, 6, Term::UpperOutputChange, Term::LowerOutputChange);
const SECOND: Limits = limits(6, 6, 7, Term::UpperSecond, Term::LowerSecond);

/// The bit of the greatest deviation, in the word of limits and in that of warnings.
const DEVIATION: (i16, i16) = (1 << 1, 1 << 3);

/// State of a channel; the numbers are those of BFM 156.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum State {
    Stopped = 0,
    OnOff = 1,
    Tuning = 2,
    Pid = 3,
}

/// A relay of a channel.
#[derive(Clone, Copy, Debug)]
struct Relay {
    is_on: bool,
    /// Milliseconds of its period.
    phase_ms: i32,
    /// Milliseconds since it changed.
    still_ms: i32,
}

/// The control of a channel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Thermostat {
    state: State,
    /// True if an alarm keeps it stopped until it is started anew.
    is_barred: bool,
    since_ms: i32,
    ramp_ms: i32,
    target: f32,
    /// The last measured value.
    measured: f32,
    /// The integral part, before the gain.
    integral: f32,
    outputs: [f32; 2],
    /// Demand of on-off control for each output.
    demands: [bool; 2],
    relays: [Relay; 2],
    tuning: Tuning,
}

/// A step response under way.
#[derive(Clone, Copy, Debug)]
struct Tuning {
    start: f32,
    time_ms: f32,
    slope: f32,
    delay_ms: f32,
    furthest: f32,
}

impl Thermostat {
    /// A stopped channel.
    pub(super) const fn new() -> Self {
        let relay = Relay {
            is_on: false,
            phase_ms: 0,
            still_ms: i32::MAX,
        };
        Thermostat {
            state: State::Stopped,
            is_barred: false,
            since_ms: 0,
            ramp_ms: 0,
            target: 0.0,
            measured: 0.0,
            integral: 0.0,
            outputs: [0.0; 2],
            demands: [false; 2],
            relays: [relay; 2],
            tuning: Tuning {
                start: 0.0,
                time_ms: 0.0,
                slope: 0.0,
                delay_ms: 0.0,
                furthest: 0.0,
            },
        }
    }
}

/// A channel being controlled: its module's words, and what it remembers.
struct Control<'a> {
    module: &'a mut Module,
    channel: usize,
    own: Thermostat,
    /// The kind of control.
    mode: i16,
    /// The greatest output.
    full: f32,
    warnings: i16,
}

impl Module {
    /// A millisecond of all channels. Outputs go up to these values with a relay and with a digital output.
    pub(super) fn regulate(&mut self, relay: i16, digital: i16) {
        for channel in 0..CHANNELS {
            let Some(&own) = self.thermostats.get(channel) else {
                continue;
            };
            let starts = self.get(Role::Thermostat(Term::Start), channel) == 1;
            if !starts && own.state == State::Stopped && !own.is_barred {
                continue;
            }
            let mode = self.get(Role::Thermostat(Term::Mode), channel);
            let full = if mode & DIGITAL == 0 { relay } else { digital };
            let mut control = Control {
                module: self,
                channel,
                own,
                mode,
                full: full.into(),
                warnings: 0,
            };
            control.tick(starts);
            let own = control.own;
            if let Some(place) = self.thermostats.get_mut(channel) {
                *place = own;
            }
        }
    }
}

impl Control<'_> {
    fn get(&self, term: Term) -> i16 {
        self.module.get(Role::Thermostat(term), self.channel)
    }

    fn float(&self, term: Term) -> f32 {
        self.get(term).into()
    }

    fn set(&mut self, term: Term, value: i16) {
        self.module.set(Role::Thermostat(term), self.channel, value);
    }

    /// The measured temperature.
    fn temperature(&self) -> f32 {
        self.module.get(Role::Present, self.channel).into()
    }

    fn tick(&mut self, starts: bool) {
        match (starts, self.own.state) {
            (false, _) => self.stop(0),
            (true, State::Stopped) if self.own.is_barred => {}
            (true, State::Stopped) if !self.module.is_measured(self.channel) => {}
            (true, State::Stopped) => self.start(),
            (true, _) => {
                self.own.since_ms += 1;
                if self.own.since_ms >= self.get(Term::Ts).into() {
                    self.own.since_ms = 0;
                    self.sample();
                }
            }
        }
        self.put_out();
    }

    /// Control ends, with an alarm that is not 0 if it cannot continue.
    fn stop(&mut self, alarm: i16) {
        self.own = Thermostat::new();
        self.own.is_barred = alarm != 0;
        self.set(Term::State, 0);
        self.set(Term::Warnings, 0);
        if alarm != 0 {
            self.set(Term::Alarm, alarm);
        }
    }

    fn start(&mut self) {
        let alarm = self.wrong_setting();
        if alarm != 0 {
            return self.stop(alarm);
        }
        self.set(Term::Alarm, 0);
        let now = self.temperature();
        self.own.target = match self.mode & RAMP {
            0 => self.float(Term::Setpoint),
            _ => now,
        };
        self.own.measured = now;
        self.own.state = match (self.mode & ON_OFF != 0, self.mode & TUNE != 0) {
            (true, _) => State::OnOff,
            (false, true) => State::Tuning,
            (false, false) => State::Pid,
        };
        if self.own.state == State::Tuning {
            if libm::fabsf(self.float(Term::Setpoint) - now) < TUNE_MIN_DISTANCE {
                return self.stop(TOO_CLOSE);
            }
            self.own.tuning.start = now;
        }
        self.sample();
    }

    /// The alarm of the first setting that is wrong; 0 if none is.
    fn wrong_setting(&self) -> i16 {
        let switched = self.get(Term::Limits);
        let all = [INPUT, OUTPUT, SETPOINT, INPUT_CHANGE, OUTPUT_CHANGE, SECOND];
        let wrong = all.iter().find(|limits| {
            switched & limits.bit != 0 && self.get(limits.upper) < self.get(limits.lower)
        });
        let relay = self.mode & DIGITAL == 0;
        let two = self.mode & TWO_SIDED != 0;
        let pid = self.mode & ON_OFF == 0;
        let unit = self.get(Term::RampUnit);
        let ramp = self.mode & RAMP != 0;
        // Only H2U-4PT-XP has words for the periods of relays.
        let cycles = self.has(Term::MainCycle);
        let checks = [
            (wrong.is_some(), wrong.map_or(0, |limits| limits.alarm)),
            (
                switched & DEVIATION.0 != 0 && self.get(Term::Deviation) < 0,
                2,
            ),
            (
                ramp && (!(0..=1).contains(&unit) || self.get(Term::RampStep) <= 0),
                8,
            ),
            (cycles && relay && self.get(Term::MainCycle) <= 0, 9),
            (
                cycles && relay && two && self.get(Term::SecondCycle) <= 0,
                10,
            ),
            (self.get(Term::Ts) <= 0, 30),
            (!(0..=99).contains(&self.get(Term::Filter)), 31),
            (pid && self.mode & TUNE == 0 && self.get(Term::Kp) < 1, 32),
            (self.get(Term::SecondGain) < 0, 33),
            (self.get(Term::Ti) < 0, 34),
            (self.get(Term::Td) < 0, 35),
        ];
        let first = checks.into_iter().find(|(is_wrong, _)| *is_wrong);
        first.map_or(0, |(_, alarm)| alarm)
    }

    fn has(&self, term: Term) -> bool {
        let kind = self.module.kind();
        kind.with(Role::Thermostat(term)).is_some()
    }

    /// A value held between limits that are switched on; it warns if it had to be.
    fn held(&mut self, value: f32, limits: &Limits) -> f32 {
        if self.get(Term::Limits) & limits.bit == 0 {
            return value;
        }
        let held = value
            .min(self.float(limits.upper))
            .max(self.float(limits.lower));
        if held != value {
            self.warnings |= limits.warning;
        }
        held
    }

    fn sample(&mut self) {
        self.warnings = 0;
        let temperature = self.temperature();
        let last = self.own.measured;
        let measured = temperature + self.float(Term::Filter) / 100.0 * (last - temperature);
        let _ = self.held(temperature, &INPUT);
        self.follow_ramp();
        let deviation = self.own.target - measured;
        if self.get(Term::Limits) & DEVIATION.0 != 0
            && libm::fabsf(deviation) > self.float(Term::Deviation)
        {
            self.warnings |= DEVIATION.1;
        }
        let towards = if self.mode & REVERSE != 0 { 1.0 } else { -1.0 };
        match self.own.state {
            State::Stopped => {}
            State::OnOff => self.switch(towards * deviation),
            State::Tuning => self.tune(measured),
            State::Pid => {
                let _ = self.held(measured - last, &INPUT_CHANGE);
                self.compute(measured, towards);
            }
        }
        if self.own.state != State::Stopped {
            self.own.measured = measured;
            let (state, warnings) = (self.own.state, self.warnings);
            self.set(Term::State, state as i16);
            self.set(Term::Warnings, warnings);
        }
    }

    /// The target: the set temperature, or what a ramp has reached of it.
    fn follow_ramp(&mut self) {
        let wanted = self.float(Term::Setpoint);
        let wanted = self.held(wanted, &SETPOINT);
        if self.mode & RAMP == 0 {
            self.own.target = wanted;
            return;
        }
        let unit_ms = match self.get(Term::RampUnit) {
            0 => 60_000,
            _ => 1000,
        };
        self.own.ramp_ms += i32::from(self.get(Term::Ts));
        while self.own.ramp_ms >= unit_ms {
            self.own.ramp_ms -= unit_ms;
            let (target, step) = (self.own.target, self.float(Term::RampStep));
            self.own.target = match target < wanted {
                true => (target + step).min(wanted),
                false => (target - step).max(wanted),
            };
        }
        let target = libm::roundf(self.own.target) as i16;
        self.set(Term::Target, target);
    }

    /// On and off. `missing` is positive if the main output is wanted.
    fn switch(&mut self, missing: f32) {
        let hysteresis = [Term::MainHysteresis, Term::SecondHysteresis];
        for (n, term) in hysteresis.into_iter().enumerate() {
            let missing = if n == 0 { missing } else { -missing };
            let two_sided = n == 0 || self.mode & TWO_SIDED != 0;
            let wanted = missing > self.float(term).max(0.0);
            let Some(demand) = self.own.demands.get_mut(n) else {
                continue;
            };
            *demand = two_sided && (wanted || *demand && missing > 0.0);
            let on = *demand;
            self.give(n, if on { self.full } else { 0.0 });
        }
    }

    /// Gives an output a value, held in its range and its limits.
    fn give(&mut self, n: usize, value: f32) {
        let limits = if n == 0 { &OUTPUT } else { &SECOND };
        let mut held = value.clamp(0.0, self.full);
        if value > self.full {
            self.warnings |= limits.warning;
        }
        // An output that is off stays off, whatever its lower limit.
        if self.own.state != State::OnOff || held > 0.0 {
            held = self.held(held, limits);
        }
        if let Some(output) = self.own.outputs.get_mut(n) {
            *output = held;
        }
    }

    /// A sample of PID.
    fn compute(&mut self, measured: f32, towards: f32) {
        if self.get(Term::Pause) == 1 || self.module.is_open(self.channel) {
            let pause = self.float(Term::PauseOutput);
            self.give(0, pause);
            return self.give(1, 0.0);
        }
        let deviation = towards * (self.own.target - measured);
        let last = self.own.measured;
        let ts = self.float(Term::Ts);
        let (ti, td) = (self.float(Term::Ti) * 100.0, self.float(Term::Td) * 100.0);
        let integral = match ti > 0.0 {
            true => self.own.integral + ts / ti * deviation,
            false => 0.0,
        };
        let derivative = -towards * td / ts * (measured - last);
        let wanted = self.float(Term::Kp) / 100.0 * (deviation + integral + derivative);
        let [main, _] = self.own.outputs;
        let change = self.held(wanted - main, &OUTPUT_CHANGE);
        self.give(0, main + change);
        // The integral part does not drive an output further beyond its end.
        let [given, _] = self.own.outputs;
        let is_beyond = wanted > given && deviation > 0.0 || wanted < given && deviation < 0.0;
        if !is_beyond {
            self.own.integral = integral;
        }
        let beyond = -deviation - self.float(Term::SecondHysteresis).max(0.0);
        let second = match self.mode & TWO_SIDED != 0 && beyond > 0.0 {
            true => self.float(Term::SecondGain) / 100.0 * beyond,
            false => 0.0,
        };
        self.give(1, second);
        let stop = self.float(Term::StopDifference);
        if stop > 0.0 && -deviation > stop {
            self.give(0, 0.0);
        }
        if stop > 0.0 && deviation > stop {
            self.give(1, 0.0);
        }
    }

    /// A sample of the step response: when the measured value has gone a third of the way, the gains are known.
    fn tune(&mut self, measured: f32) {
        let step = match self.has(Term::TuneOutput) {
            true => self.float(Term::TuneOutput),
            false => self.full,
        };
        self.give(0, step);
        let ts = self.float(Term::Ts);
        let last = self.own.measured;
        let way = self.float(Term::Setpoint) - self.own.tuning.start;
        let towards = if way < 0.0 { -1.0 } else { 1.0 };
        let tuning = &mut self.own.tuning;
        tuning.time_ms += ts;
        let gone = (measured - tuning.start) * towards;
        let slope = (measured - last) * towards / ts;
        if slope > tuning.slope {
            tuning.slope = slope;
            tuning.delay_ms = tuning.time_ms - gone / slope;
        }
        tuning.furthest = tuning.furthest.max(gone);
        if tuning.furthest <= 0.0 && gone < -MOST_FALL {
            return self.stop(WRONG_WAY);
        }
        if gone < tuning.furthest - MOST_FALL {
            return self.stop(UP_AND_DOWN);
        }
        if gone * 3.0 < libm::fabsf(way) {
            return;
        }
        let [output, _] = self.own.outputs;
        let tuned = Tuned::new(output, self.own.tuning.slope, self.own.tuning.delay_ms);
        self.set(Term::Kp, setting(tuned.kp * 100.0));
        self.set(Term::Ti, setting(tuned.ti_ms / 100.0));
        self.set(Term::Td, setting(tuned.td_ms / 100.0));
        let mode = self.mode & !TUNE;
        self.set(Term::Mode, mode);
        self.own.state = State::Pid;
        (self.own.integral, self.own.outputs) = (0.0, [0.0; 2]);
    }

    /// Shows the outputs, and switches relays by their duty.
    fn put_out(&mut self) {
        let terms = [
            (
                Term::MainDigital,
                Term::MainRelay,
                Term::MainOutput,
                Term::MainCycle,
            ),
            (
                Term::SecondDigital,
                Term::SecondRelay,
                Term::SecondOutput,
                Term::SecondCycle,
            ),
        ];
        let dead_ms = i32::from(self.get(Term::DeadTime));
        for (n, (digital, relay, either, cycle)) in terms.into_iter().enumerate() {
            let output = self.own.outputs.get(n).copied().unwrap_or(0.0);
            // H2U-4TC-XP has no separate period: the duty is that of a sampling time.
            let cycle_ms = match self.has(cycle) {
                true => i32::from(self.get(cycle)) * 1000,
                false => self.get(Term::Ts).into(),
            };
            let mut is_on = false;
            if self.mode & DIGITAL == 0
                && let Some(relay) = self.own.relays.get_mut(n)
            {
                is_on = relay.tick(output / self.full, cycle_ms, dead_ms);
            }
            let value = libm::roundf(output) as i16;
            self.set(digital, value);
            self.set(relay, is_on.into());
            let both = if self.mode & DIGITAL == 0 {
                is_on.into()
            } else {
                value
            };
            self.set(either, both);
        }
    }
}

impl Relay {
    /// A millisecond with a duty from 0 to 1; returns whether it is on.
    fn tick(&mut self, duty: f32, cycle_ms: i32, dead_ms: i32) -> bool {
        self.still_ms = self.still_ms.saturating_add(1);
        let wanted = (self.phase_ms as f32) < duty * cycle_ms as f32;
        if wanted != self.is_on && self.still_ms >= dead_ms {
            (self.is_on, self.still_ms) = (wanted, 0);
        }
        self.phase_ms = match self.phase_ms + 1 < cycle_ms {
            true => self.phase_ms + 1,
            false => 0,
        };
        self.is_on
    }
}

#[cfg(test)]
mod tests;
