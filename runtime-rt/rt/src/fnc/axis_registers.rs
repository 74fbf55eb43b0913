//! Common parts of HM's motion instructions: the registers of an axis (hm-motion-controller §8.2.3), its signals, and
//! its owner.
//!
//! An instruction's memory: word 0 keeps whether it was driven, word 1 how far it is.

use super::output::held;
use crate::axis::long;
use crate::axis_place as at;
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::plc::Class;
use crate::pulse::{Generator, Train};
use crate::special::{D_OUTPUT_USE, M_MOTION_INPUTS, Register};

/// States of an axis in its register.
pub(super) mod state {
    pub const IDLE: i16 = 0;
    pub const RUNS: i16 = 16;
    pub const DONE: i16 = 32;
    pub const ERROR: i16 = 64;
    pub const COMES_DOWN: i16 = 144;
    pub const STOPPED: i16 = 160;
}

/// Codes of errors in its register.
pub(super) mod error {
    pub const OVERSPEED: i16 = 1;
    pub const NO_OUTPUT: i16 = 2;
    pub const TOO_FAST: i16 = 3;
    pub const BELOW_FIRST: i16 = 4;
    pub const ABOVE_RETURN: i16 = 5;
    pub const BELOW_CREEP: i16 = 6;
    pub const FIRST_TOO_FAST: i16 = 7;
}

/// Bits of the register of events: for each signal whether it is looked at, and whether it is on where its input is
/// off.
pub(super) mod event {
    pub const DOG: (u8, u8) = (0, 4);
    pub const ZERO: (u8, u8) = (1, 5);
    pub const LEFT: (u8, u8) = (2, 6);
    pub const RIGHT: (u8, u8) = (3, 7);
    pub const INTERRUPT: (u8, u8) = (9, 8);
    pub const EMERGENCY: (u8, u8) = (11, 10);
    /// An emergency brings it down instead of stopping it at once.
    pub const COMES_DOWN: u8 = 12;
    /// Inputs X instead of the relays from M8096 on.
    pub const INPUTS: u8 = 13;
    /// A return counts from the front of the DOG on, not from its end.
    pub const FROM_FRONT: u8 = 14;
    /// A return ends with its pulses or with its zero signals, whichever come first.
    pub const EITHER: u8 = 15;
}

/// Outputs that send pulses, and all that an axis may be bound to: three more are only counted.
const PULSE_OUTPUTS: i16 = 6;
const OUTPUTS: i16 = 9;
/// Total frequency that the outputs in use share, in millihertz.
const HIGHEST: u64 = 600_000_000;
/// Values of [`D_OUTPUT_USE`] for an output used for pulses, for the direction.
const USE_PULSES: i16 = 2;
const USE_DIRECTION: i16 = 3;
/// The output of the direction of Y000; those of the others follow.
const DIRECTION: u32 = 0o10;

/// Progress of an instruction, as [`held`] tracks it.
const PHASE: usize = 1;
const WAITS: i32 = 0;
const RUNS: i32 = 1;
const ENDED: i32 = 2;

/// Action of an instruction in a scan in which it is driven and owns the axis.
type Step<'a> = &'a dyn Fn(&mut Cx, Registers) -> Done;

/// Runs a motion: `begin` once the axis of operand `i` is free, `go_on` in the scans after that. When its drive goes
/// off it comes down, or stops at once.
pub(super) fn motion(
    cx: &mut Cx,
    i: usize,
    at_once: bool,
    begin: Step<'_>,
    go_on: Step<'_>,
) -> Done {
    held(cx, |cx| {
        let axis = Registers::of(cx, i)?;
        let driven = cx.was_driven(0);
        let phase = cx.state().0[PHASE];
        match (cx.drive(), phase) {
            (true, WAITS) if axis.word(cx, at::STATE) == state::IDLE => match axis.error(cx) {
                Some(code) => axis.refuse(cx, code),
                None => begin(cx, axis),
            },
            // IPL may have failed on it.
            (true, RUNS) if axis.is_mine(cx) && axis.word(cx, at::STATE) != state::ERROR => {
                go_on(cx, axis)
            }
            (true, RUNS) => {
                cx.state().0[PHASE] = ENDED;
                Ok(())
            }
            (true, _) => Ok(()),
            (false, _) if driven || phase != WAITS => axis.release(cx, at_once),
            (false, _) => Ok(()),
        }
    })
}

/// An axis by its registers.
#[derive(Clone, Copy)]
pub(super) struct Registers {
    axis: u32,
    first: Register,
}

impl Registers {
    /// Those of the axis that operand `i` names.
    pub fn of(cx: &Cx, i: usize) -> Result<Registers, Fault> {
        let axis = u32::try_from(cx.read(i)?).map_err(|_| Fault::DEVICE)?;
        let wiring = cx.plc.pulses().outputs().get(axis as usize);
        let first = wiring.and_then(|wiring| wiring.axis);
        let first = first.ok_or(Fault::DEVICE)?;
        Ok(Registers { axis, first })
    }

    /// Number of the register at a place.
    pub fn register(self, offset: u32) -> Register {
        self.first.after(offset)
    }

    /// Its value.
    pub fn word(self, cx: &Cx, offset: u32) -> i16 {
        cx.special_word(self.register(offset))
    }

    /// Its position, with the pulses that are sent and not counted in the register yet.
    pub fn position(self, cx: &mut Cx) -> i32 {
        let counted = long(cx.plc, self.register(at::POSITION));
        let uncounted = cx.plc.axis(self.axis).map_or(0, |axis| axis.uncounted);
        counted.wrapping_add(uncounted)
    }

    /// Sets it.
    pub fn set(self, cx: &mut Cx, offset: u32, value: i16) {
        cx.set_special_word(self.register(offset), value);
    }

    /// Pulse generator of the axis.
    pub fn generator<'a>(self, cx: &'a mut Cx) -> Result<&'a mut Generator, Fault> {
        let axis = cx.plc.axis(self.axis).ok_or(Fault::DEVICE)?;
        Ok(&mut axis.generator)
    }

    /// Speed of the motion that an instruction carries out on the axis, in millihertz.
    pub fn speed_of_motion(self, cx: &mut Cx) -> u64 {
        let moves = [state::RUNS, state::COMES_DOWN].contains(&self.word(cx, at::STATE));
        let axis = cx.plc.axis(self.axis).filter(|_| moves);
        axis.map_or(0, |axis| axis.generator.millihertz().into())
    }

    fn is_mine(self, cx: &mut Cx) -> bool {
        let slot = cx.site.slot;
        cx.plc.axis(self.axis).is_some_and(|a| a.owner == slot)
    }

    fn unit_ms(self, cx: &Cx) -> u64 {
        u64::from(self.word(cx, at::UNIT) as u16).max(1)
    }

    /// A speed in millihertz.
    pub fn millihertz(self, cx: &Cx, speed: i32) -> u64 {
        u64::try_from(speed).unwrap_or(0) * 1_000_000 / self.unit_ms(cx)
    }

    /// A speed in a register, in millihertz.
    pub fn speed(self, cx: &Cx, offset: u32) -> u64 {
        self.millihertz(cx, self.word(cx, offset).into())
    }

    /// Increase of the square of a speed per pulse at the highest acceleration, in mHz².
    pub fn slope(self, cx: &Cx) -> u64 {
        let acceleration = u64::try_from(self.word(cx, at::ACCELERATION)).unwrap_or(0);
        let unit = self.unit_ms(cx);
        acceleration.max(1) * 2_000_000_000_000 / (unit * unit)
    }

    /// A train of `total` pulses at a speed in millihertz, at most the highest, with ramps from `first` on, of the
    /// highest acceleration.
    pub fn train(self, cx: &Cx, speed: u64, first: u64, total: u32) -> Train {
        let slope = self.slope(cx);
        Train {
            speed: speed.min(self.speed(cx, at::HIGHEST)) as u32,
            lowest: (first * first).max(slope / 4),
            up: slope,
            down: slope,
            total,
            reverse: false,
        }
    }

    /// A train of `total` pulses at one speed in millihertz, at most the highest.
    pub fn steady(self, cx: &Cx, speed: u64, total: u32) -> Train {
        let speed = speed.min(self.speed(cx, at::HIGHEST));
        Train::steady(speed as u32, total)
    }

    /// Returns true if a bit of the register of events is set.
    pub fn has(self, cx: &Cx, bit: u8) -> bool {
        self.word(cx, at::EVENTS) as u16 >> bit & 1 == 1
    }

    /// Returns true if a signal of the axis is active, whose inputs a register names.
    pub fn sees(self, cx: &Cx, inputs: u32, (enable, inverted): (u8, u8)) -> bool {
        let mask = self.word(cx, inputs) as u16;
        self.has(cx, enable) && self.is_on(cx, mask, self.has(cx, inverted))
    }

    /// Returns true if one of these inputs is on, or off if inverted. They may be relays.
    pub fn is_on(self, cx: &Cx, mask: u16, inverted: bool) -> bool {
        let (class, first) = match self.has(cx, event::INPUTS) {
            true => (Class::X, 0),
            false => (Class::M, M_MOTION_INPUTS.number()),
        };
        on_of(cx, class, first, mask, inverted)
    }

    /// Returns true if the zero signal is active, whose inputs are never relays.
    pub fn sees_zero(self, cx: &Cx) -> bool {
        let (enable, inverted) = event::ZERO;
        let mask = self.word(cx, at::ZERO) as u16;
        self.has(cx, enable) && on_of(cx, Class::X, 0, mask, self.has(cx, inverted))
    }

    /// Returns true if it is bound to an output.
    pub fn has_output(self, cx: &Cx) -> bool {
        (0..OUTPUTS).contains(&self.word(cx, at::OUTPUT))
    }

    /// The highest speed that the outputs in use leave it, in millihertz.
    pub fn most(self, cx: &Cx) -> u64 {
        if self.sends_pulses(cx) {
            HIGHEST / outputs_in_use(cx)
        } else {
            HIGHEST
        }
    }

    /// Error code for invalid parameters.
    fn error(self, cx: &Cx) -> Option<i16> {
        let (highest, first) = (self.word(cx, at::HIGHEST), self.word(cx, at::FIRST));
        if !self.has_output(cx) {
            Some(error::NO_OUTPUT)
        } else if highest <= 0 || self.millihertz(cx, highest.into()) > self.most(cx) {
            Some(error::TOO_FAST)
        } else if first < 0 || first > highest {
            Some(error::FIRST_TOO_FAST)
        } else {
            None
        }
    }

    /// Begins nothing, and shows why.
    pub fn refuse(self, cx: &mut Cx, code: i16) -> Done {
        self.set(cx, at::ERROR, code);
        self.end(cx, state::ERROR);
        Ok(())
    }

    /// Stops at once, and shows why.
    pub fn fail(self, cx: &mut Cx, code: i16) -> Done {
        self.set(cx, at::ERROR, code);
        self.stop(cx, state::ERROR)
    }

    /// The instruction has come to its end.
    pub fn end(self, cx: &mut Cx, state: i16) {
        cx.state().0[PHASE] = ENDED;
        self.set(cx, at::STATE, state);
    }

    /// Stops at once, at the end of the motion.
    pub fn stop(self, cx: &mut Cx, state: i16) -> Done {
        self.generator(cx)?.halt();
        self.end(cx, state);
        Ok(())
    }

    /// It comes down with its ramp, and is stopped then.
    pub fn come_down(self, cx: &mut Cx) -> Done {
        self.generator(cx)?.stop();
        self.set(cx, at::STATE, state::COMES_DOWN);
        Ok(())
    }

    /// Returns true if it sends pulses, and has an output for their direction.
    pub fn has_direction(self, cx: &Cx) -> bool {
        self.word(cx, at::DIRECTION) == 1 && self.sends_pulses(cx)
    }

    /// Returns true if it can run in reverse: a digital output only counts, and counts down, too; pulses without an
    /// output for their direction are all forward.
    pub fn can_reverse(self, cx: &Cx) -> bool {
        self.has_direction(cx) || !self.sends_pulses(cx)
    }

    /// Returns true if the output to which it is bound sends pulses.
    fn sends_pulses(self, cx: &Cx) -> bool {
        (0..PULSE_OUTPUTS).contains(&self.word(cx, at::OUTPUT))
    }

    /// The instruction has the axis from now on.
    pub fn take(self, cx: &mut Cx) -> Done {
        let output = self.word(cx, at::OUTPUT) as u16;
        let slot = cx.site.slot;
        cx.state().0[PHASE] = RUNS;
        self.set(cx, at::ERROR, 0);
        self.set(cx, at::STATE, state::RUNS);
        self.show_use(cx);
        let axis = cx.plc.axis(self.axis).ok_or(Fault::DEVICE)?;
        axis.owner = slot;
        axis.output = output;
        Ok(())
    }

    /// Shows that its outputs, for pulses and for the direction, are no longer the ladder's (hm-motion-controller
    /// §5.4.56, §5.7.2).
    fn show_use(self, cx: &mut Cx) {
        if !self.sends_pulses(cx) {
            return;
        }
        let output = self.word(cx, at::OUTPUT) as u32;
        cx.set_special_word(D_OUTPUT_USE.after(output), USE_PULSES);
        if self.has_direction(cx) {
            let direction = D_OUTPUT_USE.after(DIRECTION + output);
            cx.set_special_word(direction, USE_DIRECTION);
        }
    }

    /// Takes the axis and sends a train, in reverse if it is requested and there is an output for the direction.
    pub fn start(self, cx: &mut Cx, train: Train, reverse: bool) -> Done {
        self.take(cx)?;
        self.send(cx, train, reverse)
    }

    /// Sends a train, whoever has the axis.
    pub fn send(self, cx: &mut Cx, train: Train, reverse: bool) -> Done {
        let number = self.word(cx, at::OUTPUT) as u16;
        let reverse = reverse && self.can_reverse(cx);
        if self.has_direction(cx) {
            let output = DIRECTION + self.word(cx, at::OUTPUT) as u32;
            let _ = cx.plc.set_bit(Class::Y, output, !reverse);
        }
        let axis = cx.plc.axis(self.axis).ok_or(Fault::DEVICE)?;
        axis.output = number;
        axis.generator.start(Train { reverse, ..train });
        axis.show();
        Ok(())
    }

    /// The drive of an instruction that never owns the axis is off: an error that it has shown ends, unless another
    /// instruction has the axis.
    pub fn forget_error(self, cx: &mut Cx) {
        let failed = core::mem::replace(&mut cx.state().0[PHASE], WAITS) == ENDED;
        let is_free = cx.plc.axis(self.axis).is_some_and(|axis| axis.owner == 0);
        if failed && is_free {
            self.set(cx, at::STATE, state::IDLE);
        }
    }

    /// The drive is off: what runs comes down, and the axis is free once it is at rest.
    fn release(self, cx: &mut Cx, at_once: bool) -> Done {
        let slot = cx.site.slot;
        let axis = cx.plc.axis(self.axis).ok_or(Fault::DEVICE)?;
        if axis.owner == slot {
            match at_once {
                true => axis.generator.halt(),
                false => axis.generator.stop(),
            }
            axis.show();
            if axis.generator.is_busy() {
                self.set(cx, at::STATE, state::COMES_DOWN);
                return Ok(());
            }
            axis.owner = 0;
        }
        if cx.state().0[PHASE] != WAITS {
            cx.state().0[PHASE] = WAITS;
            self.set(cx, at::STATE, state::IDLE);
        }
        Ok(())
    }
}

/// Returns true if one of the devices from `first` on that a mask names is on, or off if inverted.
fn on_of(cx: &Cx, class: Class, first: u32, mask: u16, inverted: bool) -> bool {
    let mut named = (0..16).filter(|n| mask >> n & 1 == 1);
    named.any(|n| cx.plc.bit(class, first + n).unwrap_or(false) != inverted)
}

/// Number of pulse outputs that axes are bound to; at least 1.
fn outputs_in_use(cx: &Cx) -> u64 {
    let outputs = cx.plc.pulses().outputs().iter();
    let axes = outputs.filter_map(|wiring| wiring.axis);
    let bound = axes.map(|axis| cx.special_word(axis.after(at::OUTPUT)));
    let mask = bound
        .filter(|output| (0..PULSE_OUTPUTS).contains(output))
        .fold(0u32, |mask, output| mask | 1 << output);
    mask.count_ones().max(1).into()
}
