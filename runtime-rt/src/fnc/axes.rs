//! Motion of one axis by pulses, of HM: hm-motion-controller §8.3.7 to §8.3.12. An instruction names an axis, whose fifty registers
//! (§8.2.3) say to which output it is bound, and all but what the operands say.
//!
//! An instruction's memory: word 0 keeps whether it was driven, word 1 how far it is, word 2 the number of pulses, word 3 whether the
//! interrupt of DDVIT has come.

use super::output::held;
use crate::axis::{long, set_long};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::plc::Class;
use crate::pulse::{Generator, Train};
use crate::wiring::axis as at;

/// States of an axis in its register.
mod state {
    pub const IDLE: i16 = 0;
    pub const RUNS: i16 = 16;
    pub const DONE: i16 = 32;
    pub const ERROR: i16 = 64;
    pub const COMES_DOWN: i16 = 144;
    pub const STOPPED: i16 = 160;
}

/// Codes of errors in its register.
mod error {
    pub const NO_OUTPUT: i16 = 2;
    pub const TOO_FAST: i16 = 3;
    pub const BELOW_FIRST: i16 = 4;
    pub const FIRST_TOO_FAST: i16 = 7;
}

/// Bits of the register of events: for each signal whether it is looked at, and whether it is on where its input is off.
mod event {
    pub const LEFT: (u8, u8) = (2, 6);
    pub const RIGHT: (u8, u8) = (3, 7);
    pub const INTERRUPT: (u8, u8) = (9, 8);
    pub const EMERGENCY: (u8, u8) = (11, 10);
    /// An emergency brings it down instead of stopping it at once.
    pub const COMES_DOWN: u8 = 12;
    /// Inputs X instead of the relays from M8096 on.
    pub const INPUTS: u8 = 13;
}

/// The relays that stand for inputs.
const RELAYS: u32 = 8096;
/// Outputs that an axis may be bound to: six that send pulses, three that are only counted.
const OUTPUTS: i16 = 9;
/// The highest speed of the hardware in millihertz.
const HIGHEST: u64 = 600_000_000;
/// The output of the direction of Y000; those of the others follow.
const DIRECTION: u32 = 0o10;
/// Milliseconds that a ramp of DPLSR may last.
const RAMP_MS: (i32, i32) = (50, 5000);

/// How far an instruction is.
const PHASE: usize = 1;
const WAITS: i32 = 0;
const RUNS: i32 = 1;
const ENDED: i32 = 2;
/// Words with its number of pulses, and whether the interrupt has come.
const COUNT: usize = 2;
const INTERRUPTED: usize = 3;

/// What kind of motion it is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Motion {
    /// DPLSY: at one speed, which may change.
    Steady,
    /// DPLSR: with ramps of a given time.
    Timed,
    /// DDRVI, DDRVA: with the ramps of the axis.
    Move,
    /// DDVIT: until an interrupt, and so many pulses more.
    ToInterrupt,
    /// DPLSV: without end; the speed may change.
    Variable,
}

/// What an instruction asks for.
struct Order {
    motion: Motion,
    /// Speed in pulses a unit of time.
    speed: i32,
    /// Pulses, negative in reverse.
    count: i32,
    /// Time of a ramp, for [`Motion::Timed`].
    ramp_ms: i32,
}

/// An axis by its registers.
#[derive(Clone, Copy)]
struct Registers {
    axis: u32,
    first: u32,
}

/// DPLSY D1 D2 D3: sends D2 pulses of D1 on axis D3.
pub fn axis_plsy(cx: &mut Cx) -> Done {
    drive(cx, 2, |cx, _| {
        Ok(Order {
            motion: Motion::Steady,
            speed: cx.read(0)?,
            count: cx.read(1)?,
            ramp_ms: 0,
        })
    })
}

/// DPLSR D1 D2 D3 D4: sends D2 pulses of D1 on axis D4, with ramps of D3 ms.
pub fn axis_plsr(cx: &mut Cx) -> Done {
    drive(cx, 3, |cx, _| {
        Ok(Order {
            motion: Motion::Timed,
            speed: cx.read(0)?,
            count: cx.read(1)?,
            ramp_ms: cx.read(2)?.clamp(RAMP_MS.0, RAMP_MS.1),
        })
    })
}

/// DDRVI D1 D2 D3: moves axis D3 by D1 pulses at D2.
pub fn axis_drvi(cx: &mut Cx) -> Done {
    drive(cx, 2, |cx, _| {
        Ok(Order {
            motion: Motion::Move,
            speed: cx.read(1)?,
            count: cx.read(0)?,
            ramp_ms: 0,
        })
    })
}

/// DDRVA D1 D2 D3: moves axis D3 to position D1 at D2.
pub fn axis_drva(cx: &mut Cx) -> Done {
    drive(cx, 2, |cx, axis| {
        let position = long(cx.plc, axis.first + at::POSITION);
        Ok(Order {
            motion: Motion::Move,
            speed: cx.read(1)?,
            count: cx.read(0)?.saturating_sub(position),
            ramp_ms: 0,
        })
    })
}

/// DDVIT D1 D2 D3: runs axis D3 at D2 until its interrupt comes, and sends D1 pulses more.
pub fn axis_dvit(cx: &mut Cx) -> Done {
    drive(cx, 2, |cx, _| {
        Ok(Order {
            motion: Motion::ToInterrupt,
            speed: cx.read(1)?,
            count: cx.read(0)?,
            ramp_ms: 0,
        })
    })
}

/// DPLSV D1 D2: runs axis D2 at D1, which may change.
pub fn axis_plsv(cx: &mut Cx) -> Done {
    drive(cx, 1, |cx, _| {
        let speed = cx.read(0)?;
        Ok(Order {
            motion: Motion::Variable,
            speed: speed.saturating_abs(),
            count: speed,
            ramp_ms: 0,
        })
    })
}

/// What all of them do in a scan; operand `i` is the axis.
fn drive(
    cx: &mut Cx,
    i: usize,
    order: impl Fn(&mut Cx, Registers) -> Result<Order, Fault>,
) -> Done {
    held(cx, |cx| {
        let axis = Registers::of(cx, i)?;
        let driven = cx.was_driven(0);
        let phase = cx.state().0[PHASE];
        match (cx.drive(), phase) {
            (true, WAITS) if axis.word(cx, at::STATE) == state::IDLE => {
                let order = order(cx, axis)?;
                begin(cx, axis, &order)
            }
            (true, RUNS) => {
                let order = order(cx, axis)?;
                go_on(cx, axis, &order)
            }
            (true, _) => Ok(()),
            (false, _) if driven || phase != WAITS => release(cx, axis),
            (false, _) => Ok(()),
        }
    })
}

impl Registers {
    /// Those of the axis that operand `i` names.
    fn of(cx: &Cx, i: usize) -> Result<Registers, Fault> {
        let axis = u32::try_from(cx.read(i)?).map_err(|_| Fault::DEVICE)?;
        let wiring = cx.plc.pulses().outputs().get(axis as usize);
        let wiring = wiring.ok_or(Fault::DEVICE)?;
        Ok(Registers {
            axis,
            first: wiring.axis,
        })
    }

    fn word(self, cx: &Cx, offset: u32) -> i16 {
        cx.special_word(self.first + offset)
    }

    fn set(self, cx: &mut Cx, offset: u32, value: i16) {
        cx.set_special_word(self.first + offset, value);
    }

    fn generator<'a>(self, cx: &'a mut Cx) -> Result<&'a mut Generator, Fault> {
        let axis = cx.plc.axis(self.axis).ok_or(Fault::DEVICE)?;
        Ok(&mut axis.generator)
    }

    fn unit_ms(self, cx: &Cx) -> u64 {
        u64::from(self.word(cx, at::UNIT) as u16).max(1)
    }

    /// A speed in millihertz.
    fn millihertz(self, cx: &Cx, speed: i32) -> u64 {
        u64::try_from(speed).unwrap_or(0) * 1_000_000 / self.unit_ms(cx)
    }

    /// What the highest acceleration adds to the square of a speed at each pulse, in mHz².
    fn slope(self, cx: &Cx) -> u64 {
        let acceleration = u64::try_from(self.word(cx, at::ACCELERATION))
            .unwrap_or(0)
            .max(1);
        let unit = self.unit_ms(cx);
        acceleration * 2_000_000_000_000 / (unit * unit)
    }

    /// Whether a signal of the axis is there.
    fn sees(self, cx: &Cx, inputs: u32, (enable, inverted): (u8, u8)) -> bool {
        let events = self.word(cx, at::EVENTS) as u16;
        let has = |bit: u8| events >> bit & 1 == 1;
        if !has(enable) {
            return false;
        }
        let mask = self.word(cx, inputs) as u16;
        let is_on = |n: &u32| {
            let (class, number) = match has(event::INPUTS) {
                true => (Class::X, *n),
                false => (Class::M, RELAYS + n),
            };
            cx.plc.bit(class, number).unwrap_or(false) != has(inverted)
        };
        (0..16).filter(|n| mask >> n & 1 == 1).any(|n| is_on(&n))
    }

    /// What is wrong with the parameters.
    fn error(self, cx: &Cx, order: &Order) -> Option<i16> {
        let (highest, first) = (self.word(cx, at::HIGHEST), self.word(cx, at::FIRST));
        let output = self.word(cx, at::OUTPUT);
        if !(0..OUTPUTS).contains(&output) {
            Some(error::NO_OUTPUT)
        } else if highest <= 0 || self.millihertz(cx, highest.into()) > HIGHEST {
            Some(error::TOO_FAST)
        } else if first < 0 || first > highest {
            Some(error::FIRST_TOO_FAST)
        } else if order.speed < 0 || (order.speed == 0 && order.motion == Motion::Timed) {
            Some(error::BELOW_FIRST)
        } else {
            None
        }
    }

    /// The train that an order asks for, forward.
    fn train(self, cx: &Cx, order: &Order) -> Train {
        let parameter = |offset| i32::from(self.word(cx, offset));
        let highest = self.millihertz(cx, parameter(at::HIGHEST));
        let first = self.millihertz(cx, parameter(at::FIRST));
        let wanted = self.millihertz(cx, order.speed).min(highest);
        if order.motion == Motion::Steady {
            return Train::steady(wanted as u32, order.count.unsigned_abs());
        }
        let (first, speed) = match order.motion {
            Motion::Variable => (0, wanted),
            _ => (first, wanted.max(first)),
        };
        let most = self.slope(cx);
        let timed = match order.motion {
            Motion::Timed => 2_000_000 * speed.saturating_sub(first) / order.ramp_ms as u64,
            _ => 0,
        };
        let slope = if timed == 0 { most } else { timed.min(most) };
        Train {
            speed: speed as u32,
            lowest: (first * first).max(slope / 4),
            up: slope,
            down: slope,
            total: match order.motion {
                Motion::Variable | Motion::ToInterrupt => 0,
                _ => order.count.unsigned_abs(),
            },
            reverse: false,
        }
    }

    /// The instruction has come to its end.
    fn end(self, cx: &mut Cx, state: i16) {
        cx.state().0[PHASE] = ENDED;
        self.set(cx, at::STATE, state);
    }
}

/// The axis is free: the motion begins.
fn begin(cx: &mut Cx, axis: Registers, order: &Order) -> Done {
    if let Some(code) = axis.error(cx, order) {
        axis.set(cx, at::ERROR, code);
        axis.end(cx, state::ERROR);
        return Ok(());
    }
    axis.set(cx, at::ERROR, 0);
    if order.count == 0 && order.motion != Motion::Variable {
        axis.end(cx, state::DONE);
        return Ok(());
    }
    let output = axis.word(cx, at::OUTPUT) as u32;
    let has_direction = axis.word(cx, at::DIRECTION) == 1 && output < 6;
    let reverse = has_direction && order.count < 0;
    if has_direction {
        let _ = cx.plc.set_bit(Class::Y, DIRECTION + output, !reverse);
    }
    let train = Train {
        reverse,
        ..axis.train(cx, order)
    };
    let slot = cx.site.slot;
    let state = cx.state();
    state.0[PHASE] = RUNS;
    state.0[COUNT] = order.count;
    state.0[INTERRUPTED] = 0;
    let own = cx.plc.axis(axis.axis).ok_or(Fault::DEVICE)?;
    own.owner = slot;
    own.output = output as u16;
    own.generator.start(train);
    own.show();
    axis.set(cx, at::STATE, state::RUNS);
    watch(cx, axis, order)
}

/// A scan of a motion that has begun.
fn go_on(cx: &mut Cx, axis: Registers, order: &Order) -> Done {
    let slot = cx.site.slot;
    let own = cx.plc.axis(axis.axis).ok_or(Fault::DEVICE)?;
    let (mine, generator) = (own.owner == slot, own.generator);
    if !mine {
        cx.state().0[PHASE] = ENDED;
        return Ok(());
    }
    if !generator.is_busy() {
        if order.motion == Motion::Variable && axis.word(cx, at::STATE) == state::RUNS {
            return begin(cx, axis, order);
        }
        let stopped = axis.word(cx, at::STATE) == state::COMES_DOWN;
        axis.end(cx, if stopped { state::STOPPED } else { state::DONE });
        return Ok(());
    }
    watch(cx, axis, order)
}

/// Emergencies, limits, the interrupt, and changes of speed.
fn watch(cx: &mut Cx, axis: Registers, order: &Order) -> Done {
    if axis.word(cx, at::STATE) != state::RUNS {
        return Ok(());
    }
    let motion = order.motion;
    let reverse = axis.generator(cx)?.is_reverse();
    let limit = match reverse {
        true => axis.sees(cx, at::LEFT, event::LEFT),
        false => axis.sees(cx, at::RIGHT, event::RIGHT),
    };
    if axis.sees(cx, at::EMERGENCY, event::EMERGENCY) {
        let ramps = axis.word(cx, at::EVENTS) as u16 >> event::COMES_DOWN & 1 == 1;
        if !ramps || motion == Motion::Steady {
            axis.generator(cx)?.halt();
            axis.end(cx, state::STOPPED);
            return Ok(());
        }
        return come_down(cx, axis);
    }
    if limit && !matches!(motion, Motion::Steady | Motion::Timed) {
        return come_down(cx, axis);
    }
    match motion {
        Motion::ToInterrupt
            if cx.state().0[INTERRUPTED] == 0 && axis.sees(cx, at::INTERRUPT, event::INTERRUPT) =>
        {
            let position = long(cx.plc, axis.first + at::POSITION);
            set_long(cx.plc, axis.first + at::INTERRUPT_POSITION, position);
            let state = cx.state();
            state.0[INTERRUPTED] = 1;
            let count = state.0[COUNT].unsigned_abs();
            axis.generator(cx)?.end_in(count);
        }
        Motion::Steady | Motion::Variable => {
            let speed = axis.train(cx, order).speed;
            let turns = motion == Motion::Variable
                && axis.word(cx, at::DIRECTION) == 1
                && order.count != 0
                && (order.count < 0) != reverse;
            let generator = axis.generator(cx)?;
            match turns {
                // It comes down, and begins anew in the other direction.
                true => generator.stop(),
                false if generator.is_stopping() => {}
                false => generator.set_speed(speed),
            }
        }
        _ => {}
    }
    Ok(())
}

/// It comes down with its ramp, and is stopped then.
fn come_down(cx: &mut Cx, axis: Registers) -> Done {
    axis.generator(cx)?.stop();
    axis.set(cx, at::STATE, state::COMES_DOWN);
    Ok(())
}

/// The drive is off: what runs comes down, and the axis is free once it is at rest.
fn release(cx: &mut Cx, axis: Registers) -> Done {
    let slot = cx.site.slot;
    let own = cx.plc.axis(axis.axis).ok_or(Fault::DEVICE)?;
    let mine = own.owner == slot;
    if mine {
        own.generator.stop();
        own.show();
    }
    if mine && own.generator.is_busy() {
        axis.set(cx, at::STATE, state::COMES_DOWN);
        return Ok(());
    }
    if mine {
        own.owner = 0;
    }
    if cx.state().0[PHASE] != WAITS {
        cx.state().0[PHASE] = WAITS;
        axis.set(cx, at::STATE, state::IDLE);
    }
    Ok(())
}
