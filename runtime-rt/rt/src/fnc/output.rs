//! Common parts of the instructions for pulse outputs: when an instruction begins, and the owner of the output.
//!
//! An instruction's memory: word 0 keeps whether it was driven, word 1 how far it is, word 2 the relay with which it
//! begins anew, word 3 whether it has shown that it is driven; words 6 and 7 the output of its clear signal plus one,
//! negative until a scan has seen it on, and since when that is on.

use crate::axis::{self, Axis, any_is_on, long, set_relays};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::plc::Class;
use crate::pulse::Train;
use crate::pulse_side;
use crate::special::{M_COMPLETE, Register, Relay};
use crate::wiring::{Clear, Ramps, Wiring};

/// Progress of an instruction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(i32)]
enum Phase {
    /// It has not begun, was stopped, or had the output taken from it.
    Idle = 0,
    /// It sends.
    Sends = 1,
    /// It is done.
    Done = 2,
    /// It is to begin; its operands may keep it from that.
    Begins = 3,
}

/// Action in a scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Turn {
    /// Nothing.
    Rest,
    /// The instruction begins.
    Start,
    /// It sends.
    Sends,
    /// It sent, and its drive has gone off.
    Released,
}

/// Runs an instruction while no interrupt sends pulses. A signal concerns it only while it sends.
pub(super) fn held(cx: &mut Cx, instruction: impl FnOnce(&mut Cx) -> Done) -> Done {
    if cx.site.signal {
        let [driven, phase, ..] = cx.state().0;
        if driven == 0 || phase != Phase::Sends as i32 {
            return Ok(());
        }
    }
    cx.hal().hold_pulses(true);
    pulse_side::take(cx.plc, *cx.hal.get_mut());
    let done = instruction(cx);
    pulse_side::give(cx.plc, *cx.hal.get_mut());
    cx.hal().hold_pulses(false);
    done
}

/// The first two operands, which are not negative.
pub(super) fn unsigned(cx: &Cx) -> Result<[u32; 2], Fault> {
    match [cx.read(0)?, cx.read(1)?].map(u32::try_from) {
        [Ok(first), Ok(second)] => Ok([first, second]),
        _ => Err(Fault::VALUE),
    }
}

/// The output of an instruction.
#[derive(Clone, Copy)]
pub(super) struct Output {
    number: u32,
    /// Its special devices.
    pub wiring: &'static Wiring,
}

/// Limits of the times of ramps, in milliseconds (h1u-h2u-programming §4.3.11).
pub(super) const RAMP_MS: (i32, i32) = (50, 5000);
/// Lowest speed of a train with ramps, in Hz.
pub(super) const LOWEST_HZ: u32 = 10;
/// Lowest speeds of DSZR but for the base and the creep speed, in Hz.
const LOWEST_RETURN_HZ: i32 = 715;

/// A register that says no interrupt input.
const NO_INTERRUPT_INPUT: Fault = Fault(6763);

/// Speeds and times of ramps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ramp {
    /// Speed that ramps begin and end with, in Hz.
    base: u32,
    /// Highest speed, in Hz.
    highest: u32,
    up_ms: u32,
    down_ms: u32,
    raises_speeds: bool,
}

impl Ramp {
    /// A train of `total` pulses at `hz`, at most the highest speed; a speed that ramps cannot begin with is raised, if
    /// the model does so.
    pub fn train(&self, hz: u32, total: u32, reverse: bool) -> Train {
        let train = self.endless_train(hz.max(LOWEST_HZ), reverse);
        let lowest = train.up / 4;
        let raised = self.raises_speeds && u64::from(train.speed).pow(2) < lowest;
        Train {
            speed: if raised {
                (lowest - 1).isqrt() as u32 + 1
            } else {
                train.speed
            },
            total,
            ..train
        }
    }

    /// A train without end at `hz`, at most the highest speed.
    pub fn endless_train(&self, hz: u32, reverse: bool) -> Train {
        let up = Train::slope(self.highest, self.up_ms);
        let base = 1000 * u64::from(self.base);
        Train {
            speed: 1000 * hz.min(self.highest),
            // Speed after one pulse at a steady acceleration: √(highest speed / 2·time).
            lowest: (base * base).max(up / 4),
            up,
            down: Train::slope(self.highest, self.down_ms),
            total: 0,
            reverse,
        }
    }
}

/// Speeds of DSZR.
pub(super) struct HomeSpeeds {
    /// Its ramps.
    pub ramp: Ramp,
    /// Speed of the return, in Hz.
    pub fast: u32,
    /// Speed over the DOG, in Hz.
    pub creep: u32,
}

impl Output {
    /// That of operand `i`.
    pub fn of(cx: &Cx, i: usize) -> Result<Output, Fault> {
        let operand = cx.ops.get(i).ok_or(Fault::DEVICE)?;
        let number = u32::try_from(operand.value).map_err(|_| Fault::DEVICE)?;
        let wiring = cx.plc.pulses().outputs().get(number as usize);
        let wiring = wiring.ok_or(Fault::DEVICE)?;
        Ok(Output { number, wiring })
    }

    /// Axis of the output.
    pub fn axis<'a>(self, cx: &'a mut Cx) -> Result<&'a mut Axis, Fault> {
        cx.plc.axis(self.number).ok_or(Fault::DEVICE)
    }

    /// Returns true if the model has a special relay, and it is on.
    pub fn has_on(self, cx: &Cx, relay: impl Into<Option<Relay>>) -> bool {
        any_is_on(cx.plc, &[relay.into()])
    }

    /// Its position; 0 if it keeps none.
    pub fn position(self, cx: &Cx) -> i32 {
        let position = self.wiring.position;
        position.map_or(0, |position| long(cx.plc, position))
    }

    /// A speed in the model's range, in millihertz; 0 remains 0.
    pub fn millihertz(self, cx: &Cx, hz: u32) -> u32 {
        1000 * hz.min(cx.plc.pulses().highest_hz())
    }

    /// Action of the instruction in this scan. It takes an output that another instruction uses only while the relay
    /// for that is on. It is done when its train is.
    pub fn turn(self, cx: &mut Cx) -> Result<Turn, Fault> {
        let turn = self.turn_resting(cx)?;
        let axis = *self.axis(cx)?;
        if turn != Turn::Sends {
            return Ok(turn);
        }
        if axis.generator.is_complete() {
            self.enter(cx, Phase::Done);
            return Ok(Turn::Rest);
        }
        if self.is_at_limit(cx, axis.generator.is_reverse()) {
            self.axis(cx)?.generator.stop();
            self.fail(cx)?;
            return Ok(Turn::Rest);
        }
        Ok(Turn::Sends)
    }

    /// Action of the instruction in this scan, if the instruction itself decides when it is done.
    pub fn turn_resting(self, cx: &mut Cx) -> Result<Turn, Fault> {
        let (drive, slot) = (cx.drive(), cx.site.slot);
        let was_driven = cx.was_driven(0);
        let restart = self.has_on(cx, self.wiring.restart);
        let had_restart = core::mem::replace(&mut cx.state().0[2], restart.into()) != 0;
        let axis = *self.axis(cx)?;
        let mine = axis.owner == slot;
        if !drive {
            return Ok(match (was_driven, mine) {
                (true, true) => Turn::Released,
                _ => Turn::Rest,
            });
        }
        let phase = cx.state().0[1];
        if !was_driven || (restart && !had_restart) || phase == Phase::Begins as i32 {
            self.enter(cx, Phase::Idle);
            cx.set_special(M_COMPLETE, false);
            set_relays(cx.plc, &[self.wiring.aborted], false);
            if any_is_on(cx.plc, &self.wiring.stop) {
                return Ok(Turn::Rest);
            }
            if axis.generator.is_busy() && !restart {
                return Err(Fault(cx.plc.pulses().conflict()));
            }
            self.enter(cx, Phase::Begins);
            return Ok(Turn::Start);
        }
        if phase == Phase::Sends as i32 && mine {
            return Ok(Turn::Sends);
        }
        if phase == Phase::Sends as i32 {
            self.enter(cx, Phase::Idle);
        }
        Ok(Turn::Rest)
    }

    fn enter(self, cx: &mut Cx, phase: Phase) {
        cx.state().0[1] = phase as i32;
    }

    /// The instruction is done.
    pub fn finish(self, cx: &mut Cx) {
        self.enter(cx, Phase::Done);
    }

    /// The instruction has come to an end before its time.
    pub fn fail(self, cx: &mut Cx) -> Done {
        self.enter(cx, Phase::Idle);
        set_relays(cx.plc, &[self.wiring.aborted], true);
        self.axis(cx)?.owner = 0;
        Ok(())
    }

    fn is_at_limit(self, cx: &Cx, reverse: bool) -> bool {
        any_is_on(cx.plc, &[self.wiring.limits[usize::from(reverse)]])
    }

    /// The instruction sends a train, whose pulses are counted in the pair of registers `counter`, unless a limit
    /// switch forbids it.
    pub fn start(self, cx: &mut Cx, train: Train, counter: Option<Register>) -> Done {
        if self.is_at_limit(cx, train.reverse) {
            return self.fail(cx);
        }
        self.run(cx, train, counter)
    }

    /// The same without regard to limit switches.
    pub fn run(self, cx: &mut Cx, train: Train, counter: Option<Register>) -> Done {
        let slot = cx.site.slot;
        self.enter(cx, Phase::Sends);
        let axis = self.axis(cx)?;
        axis.generator.start(train);
        axis.owner = slot;
        axis.counter = counter.map_or(0, |register| register.0);
        axis.ended = false;
        axis.show();
        Ok(())
    }

    /// Shows in the special relays how far the instruction is. One whose drive is off has nothing to show but that it
    /// has gone off.
    pub fn show(self, cx: &mut Cx) -> Done {
        let (slot, drive) = (cx.site.slot, cx.drive());
        let axis = self.axis(cx)?;
        let busy = axis.generator.millihertz() > 0;
        axis.show();
        if !drive && axis.owner == slot {
            axis.owner = 0;
        }
        set_relays(cx.plc, &self.wiring.busy, busy);
        let phase = cx.state().0[1];
        if cx.site.signal {
            // The state of the instruction itself is shown in the scan.
            return Ok(());
        }
        if drive {
            cx.set_special(M_COMPLETE, phase == Phase::Done as i32);
            if phase != Phase::Idle as i32 {
                cx.state().0[3] = 1;
                set_relays(cx.plc, &[self.wiring.driven], true);
            }
            return Ok(());
        }
        if phase != Phase::Idle as i32 {
            self.enter(cx, Phase::Idle);
            cx.set_special(M_COMPLETE, false);
        }
        if core::mem::take(&mut cx.state().0[3]) != 0 {
            set_relays(cx.plc, &[self.wiring.driven, self.wiring.aborted], false);
        }
        Ok(())
    }

    /// Changes how many pulses the train has, if the relay for that is on and it does not come down yet.
    pub fn change_total(self, cx: &mut Cx, total: u32) -> Done {
        if total > 0 && self.has_on(cx, self.wiring.changes) {
            let generator = &mut self.axis(cx)?.generator;
            if !generator.is_ending() {
                generator.set_total(total);
            }
        }
        Ok(())
    }

    /// Ramps of positioning: those of this output alone while the relay for that is on.
    pub fn ramp(self, cx: &Cx) -> Ramp {
        match self.own(cx) {
            Some(own) => self.ramp_of(cx, Some(own)),
            None => self.ramp_for_all(cx),
        }
    }

    /// Ramps of positioning, whatever that relay says.
    pub fn ramp_for_all(self, cx: &Cx) -> Ramp {
        self.ramp_of(cx, self.wiring.ramps)
    }

    fn own(self, cx: &Cx) -> Option<Ramps> {
        self.wiring
            .own
            .filter(|_| self.has_on(cx, self.wiring.changes))
    }

    /// Time of the way down of this output alone, while the relay for that is on.
    pub fn own_down_ms(self, cx: &Cx) -> Option<i32> {
        self.own(cx).map(|own| ramp_ms(cx, own.down) as i32)
    }

    /// Without registers a ramp is as if they held 0.
    fn ramp_of(self, cx: &Cx, ramps: Option<Ramps>) -> Ramp {
        let most = cx.plc.pulses().highest_hz();
        let highest = ramps.map_or(0, |ramps| long(cx.plc, ramps.highest));
        let highest = u32::try_from(highest).unwrap_or(0).clamp(LOWEST_HZ, most);
        let base = ramps.map_or(0, |ramps| cx.special_word(ramps.base));
        let base = u32::try_from(base).unwrap_or(0);
        let ms = |time: fn(Ramps) -> Register| {
            ramps.map_or(RAMP_MS.0 as u32, |ramps| ramp_ms(cx, time(ramps)))
        };
        Ramp {
            base: base.min(highest / 10),
            highest,
            up_ms: ms(|ramps| ramps.up),
            down_ms: ms(|ramps| ramps.down),
            raises_speeds: cx.plc.pulses().raises_speeds(),
        }
    }

    /// Speeds of DSZR. Those that contradict each other are an error, others are held in their limits
    /// (h1u-h2u-programming §4.3.11).
    pub fn home_speeds(self, cx: &Cx) -> Result<HomeSpeeds, Fault> {
        let home = self.wiring.home.ok_or(Fault::DEVICE)?;
        let most = cx.plc.pulses().highest_hz() as i32;
        let highest = long(cx.plc, home.ramps.highest);
        let base = i32::from(cx.special_word(home.ramps.base));
        let creep = i32::from(cx.special_word(home.creep));
        let fast = long(cx.plc, home.speed);
        if creep < 0 || creep < base || fast < base || highest < creep {
            return Err(Fault::DEVICE);
        }
        let highest = highest.clamp(LOWEST_RETURN_HZ, most);
        Ok(HomeSpeeds {
            ramp: Ramp {
                base: base.clamp(0, highest) as u32,
                highest: highest as u32,
                up_ms: ramp_ms(cx, home.ramps.up),
                down_ms: ramp_ms(cx, home.ramps.down),
                raises_speeds: false,
            },
            fast: fast.clamp(LOWEST_RETURN_HZ, highest) as u32,
            creep: creep.clamp(LOWEST_HZ as i32, highest) as u32,
        })
    }

    /// Returns true if PLSV has ramps.
    pub fn slides(self, cx: &Cx) -> bool {
        self.has_on(cx, self.wiring.slides)
    }

    /// Unit of PWM.
    pub fn pwm_unit_us(self, cx: &Cx) -> u32 {
        match self.wiring.unit {
            None if self.has_on(cx, self.wiring.micro) => 1,
            None => 1000,
            Some(unit) => match cx.special_word(unit) {
                0 | 1 => 10,
                3 => 10_000,
                _ => 1000,
            },
        }
    }

    /// Counts the pulses that were sent by now, between two scans too.
    pub fn count(self, cx: &mut Cx) {
        axis::count(cx.plc, self.number, self.wiring);
    }

    /// Stops the pulses at once, whoever sends them.
    pub fn halt(self, cx: &mut Cx) -> Done {
        self.axis(cx)?.halt();
        Ok(())
    }

    /// Returns true if the signal that DVIT waits for is active.
    pub fn is_interrupted(self, cx: &Cx) -> Result<bool, Fault> {
        let interrupt = self.wiring.interrupt;
        let input = |number: u32| {
            let on = cx.plc.bit(Class::X, number).unwrap_or(false);
            on != self.has_on(cx, interrupt.inverted)
        };
        let chooses = self.has_on(cx, interrupt.chooses);
        let Some(register) = interrupt.register.filter(|_| chooses) else {
            return Ok(input(interrupt.input));
        };
        let digits = cx.special_word(register) as u16;
        match u32::from(digits >> (4 * self.number) & 15) {
            number @ 0..=7 => Ok(input(number)),
            8 => Ok(self.has_on(cx, interrupt.relay)),
            _ => Err(NO_INTERRUPT_INPUT),
        }
    }

    /// Gives a clear signal, if the relay for that is on.
    pub fn begin_clear_signal(self, cx: &mut Cx, clear: Option<Clear>) {
        let Some(clear) = clear.filter(|clear| self.has_on(cx, clear.enable)) else {
            return;
        };
        let chosen = clear.chooses.is_none() || self.has_on(cx, clear.chooses);
        let number = clear.register.filter(|_| chosen);
        let output = match number.map(|register| cx.special_word(register) as u16) {
            None => Some(clear.output),
            Some(number) => clear.named(number),
        };
        if let Some(output) = output
            && cx.plc.set_bit(Class::Y, output, true).is_some()
        {
            let seen = !cx.site.signal;
            self.keep_clear_signal(cx, output as i32 + 1, seen);
        }
    }

    fn keep_clear_signal(self, cx: &mut Cx, output: i32, seen: bool) {
        let now_ms = cx.plc.sys().now_ms as i32;
        let state = cx.state();
        state.0[6] = if seen { output } else { -output };
        state.0[7] = now_ms;
    }

    /// Ends it when its time is over.
    pub fn end_clear_signal(self, cx: &mut Cx, clear: Option<Clear>) {
        let ms = clear.map_or(0, |clear| clear.ms);
        let now_ms = cx.plc.sys().now_ms;
        let [.., output, since] = cx.state().0;
        if output < 0 && !cx.site.signal {
            self.keep_clear_signal(cx, -output, true);
        } else if output > 0 && now_ms.wrapping_sub(since as u32) > ms {
            cx.state().0[6] = 0;
            let _ = cx.plc.set_bit(Class::Y, output as u32 - 1, false);
        }
    }
}

/// The time of a ramp in a register.
fn ramp_ms(cx: &Cx, register: Register) -> u32 {
    i32::from(cx.special_word(register)).clamp(RAMP_MS.0, RAMP_MS.1) as u32
}
