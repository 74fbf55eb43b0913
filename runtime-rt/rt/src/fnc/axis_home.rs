//! HOME of HM: hm-motion-controller §8.3.1.
//!
//! Its memory: words 0 and 1 see `axis_registers`; word 2 the stage, word 3 the zero signals that are still to come,
//! word 4 whether the zero signal was there, word 5 whether it has turned round at the limit.

use super::axis_registers::{Registers, error, event, motion, state};
use crate::axis_place as at;
use crate::cx::Cx;
use crate::fault::Done;

/// Words of the memory.
const STAGE: usize = 2;
const ZEROS: usize = 3;
const ZERO_WAS_ON: usize = 4;
const TURNED: usize = 5;

/// Stages. Those that run forward, against the direction of the return, come first.
mod stage {
    /// Leaves the DOG forward.
    pub const LEAVE: i32 = 0;
    /// Seeks the DOG forward, from the limit.
    pub const SEEK_FORWARD: i32 = 1;
    /// Comes to a halt, to return.
    pub const TURN: i32 = 2;
    /// Seeks the DOG.
    pub const SEEK: i32 = 3;
    /// Creeps over it.
    pub const CREEP: i32 = 4;
    /// Counts zero signals, or waits for the pulses that are left.
    pub const COUNTS: i32 = 5;
    /// Comes to a halt at the limit, to seek forward.
    pub const TURN_FORWARD: i32 = 6;
}

/// Signals that HOME evaluates.
struct Signals {
    /// The DOG, or the zero signal in its place.
    dog: bool,
    /// The zero signal has come.
    zero_rises: bool,
    left: bool,
    /// There is no DOG.
    only_zero: bool,
}

/// HOME D: runs axis D back until its DOG, creeps over it, and stops after as many pulses and zero signals as its
/// registers say; from the DOG or the left limit it first runs forward. Without a DOG it creeps until a zero signal. It
/// stops at once with its drive.
pub fn axis_home(cx: &mut Cx) -> Done {
    motion(cx, 0, true, &begin, &go_on)
}

fn signals(cx: &mut Cx, axis: Registers) -> Signals {
    let zero = axis.sees_zero(cx);
    let zero_was_on = core::mem::replace(&mut cx.state().0[ZERO_WAS_ON], zero.into()) != 0;
    let only_zero = !axis.has(cx, event::DOG.0);
    Signals {
        dog: if only_zero {
            zero
        } else {
            axis.sees(cx, at::DOG, event::DOG)
        },
        zero_rises: zero && !zero_was_on,
        left: axis.sees(cx, at::LEFT, event::LEFT),
        only_zero,
    }
}

fn begin(cx: &mut Cx, axis: Registers) -> Done {
    if !axis.has(cx, event::DOG.0) && !axis.has(cx, event::ZERO.0) {
        return axis.refuse(cx, 0);
    }
    if let Some(code) = wrong_speed(cx, axis) {
        return axis.refuse(cx, code);
    }
    let signals = signals(cx, axis);
    cx.state().0[TURNED] = 0;
    let first = match (signals.only_zero, signals.left, signals.dog) {
        (_, true, _) => stage::SEEK_FORWARD,
        (false, false, true) => stage::LEAVE,
        _ => stage::SEEK,
    };
    run(cx, axis, first, signals.only_zero)
}

/// Error code for invalid speeds of a return. The manual gives the time of each check and not its criterion: an axis
/// that starts faster than it is to return is above its speed, one that returns slower than it is to creep is below it,
/// and one that stands still never arrives.
fn wrong_speed(cx: &Cx, axis: Registers) -> Option<i16> {
    let [first, back, creep] = [at::FIRST, at::RETURN, at::CREEP].map(|at| axis.speed(cx, at));
    // Without a DOG it creeps from the beginning.
    let returns = axis.has(cx, event::DOG.0);
    if returns && first > back {
        Some(error::ABOVE_RETURN)
    } else if returns && back < creep {
        Some(error::BELOW_CREEP)
    } else if creep == 0 {
        Some(error::BELOW_FIRST)
    } else {
        None
    }
}

/// Runs a stage.
fn run(cx: &mut Cx, axis: Registers, stage: i32, creeps: bool) -> Done {
    let speed = match creeps {
        true => axis.speed(cx, at::CREEP),
        false => axis.speed(cx, at::RETURN),
    };
    let first = axis.speed(cx, at::FIRST);
    let train = axis.train(cx, speed, first, 0);
    cx.state().0[STAGE] = stage;
    axis.start(cx, train, stage >= stage::SEEK)
}

fn go_on(cx: &mut Cx, axis: Registers) -> Done {
    let signals = signals(cx, axis);
    if axis.sees(cx, at::EMERGENCY, event::EMERGENCY) {
        return axis.stop(cx, state::STOPPED);
    }
    let turned = cx.state().0[TURNED] != 0;
    match (cx.state().0[STAGE], signals.dog) {
        (stage::SEEK | stage::SEEK_FORWARD, _) if signals.only_zero && signals.zero_rises => {
            return count(cx, axis);
        }
        (stage::SEEK_FORWARD, true) if !signals.only_zero => cx.state().0[STAGE] = stage::LEAVE,
        (stage::LEAVE, false) => turn(cx, axis, stage::TURN)?,
        (stage::SEEK, true) if !signals.only_zero => {
            let creep = axis.speed(cx, at::CREEP).min(u64::from(u32::MAX)) as u32;
            axis.generator(cx)?.set_speed(creep);
            cx.state().0[STAGE] = stage::CREEP;
            if axis.has(cx, event::FROM_FRONT) {
                return count(cx, axis);
            }
        }
        (stage::SEEK, false) if signals.left && !turned => turn(cx, axis, stage::TURN_FORWARD)?,
        (stage::CREEP, false) => return count(cx, axis),
        (stage::COUNTS, _) => return arrive(cx, axis, signals.zero_rises),
        _ => {}
    }
    let idle = !axis.generator(cx)?.is_busy();
    match cx.state().0[STAGE] {
        stage::TURN if idle => run(cx, axis, stage::SEEK, false),
        stage::TURN_FORWARD if idle => {
            cx.state().0[TURNED] = 1;
            run(cx, axis, stage::SEEK_FORWARD, signals.only_zero)
        }
        _ => Ok(()),
    }
}

/// Comes down, to turn round.
fn turn(cx: &mut Cx, axis: Registers, next: i32) -> Done {
    axis.generator(cx)?.stop();
    cx.state().0[STAGE] = next;
    Ok(())
}

/// After the DOG: what is left are pulses, zero signals, or one after the other.
fn count(cx: &mut Cx, axis: Registers) -> Done {
    let zeros = i32::from(axis.word(cx, at::ZEROS) as u16);
    let either = axis.has(cx, event::EITHER);
    let state = cx.state();
    state.0[STAGE] = stage::COUNTS;
    state.0[ZEROS] = zeros;
    if zeros == 0 || either {
        return last_pulses(cx, axis);
    }
    Ok(())
}

/// The pulses after the DOG, or after the last zero signal.
fn last_pulses(cx: &mut Cx, axis: Registers) -> Done {
    match u32::from(axis.word(cx, at::BEHIND) as u16) {
        0 => axis.stop(cx, state::DONE),
        pulses => {
            axis.generator(cx)?.end_in(pulses);
            Ok(())
        }
    }
}

/// Counts zero signals; it has arrived when its pulses have ended.
fn arrive(cx: &mut Cx, axis: Registers, zero_rises: bool) -> Done {
    if !axis.generator(cx)?.is_busy() {
        axis.end(cx, state::DONE);
        return Ok(());
    }
    let state = cx.state();
    if zero_rises && state.0[ZEROS] > 0 {
        state.0[ZEROS] -= 1;
        if state.0[ZEROS] == 0 {
            return match axis.has(cx, event::EITHER) {
                true => axis.stop(cx, state::DONE),
                false => last_pulses(cx, axis),
            };
        }
    }
    Ok(())
}
