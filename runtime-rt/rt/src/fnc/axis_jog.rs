//! JOG of HM: hm-motion-controller §8.3.2.
//!
//! Its memory: words 0 and 1 see `axis_registers`; word 2 the stage, word 3 since when it waits.

use super::axis_registers::{Registers, error, motion, state};
use crate::axis_place as at;
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::pulse::Train;

/// Pause between the single pulses and continuous motion.
const PAUSE_MS: u32 = 500;

/// Word of the memory with the stage, and the one with the time.
const STAGE: usize = 2;
const SINCE: usize = 3;
/// It sends its pulses, in the direction in which it began.
const PULSES: i32 = 0;
/// It waits.
const PAUSES: i32 = 1;
/// It continues without end.
const GOES_ON: i32 = 2;

/// JOG D1 D2 D3 D4 D5: while an input of mask D4 (forward) or D5 (reverse, which prevails) is on, jogs axis D1 by D2
/// pulses and, if it is still on half a second later, continues at D3. It stops at once with its drive.
pub fn axis_jog(cx: &mut Cx) -> Done {
    motion(cx, 0, true, &begin, &go_on)
}

/// Direction that the inputs select: true for reverse.
fn direction(cx: &Cx, axis: Registers) -> Result<Option<bool>, Fault> {
    let [forward, reverse] = [cx.read(3)?, cx.read(4)?].map(|mask| mask as u16);
    Ok(match axis.is_on(cx, reverse, false) {
        true => Some(true),
        false => axis.is_on(cx, forward, false).then_some(false),
    })
}

/// Its speed in millihertz, and the speed that ramps begin with.
fn speeds(cx: &Cx, axis: Registers) -> Result<(u64, u64), Fault> {
    let wanted = axis.millihertz(cx, cx.read(2)?);
    let wanted = wanted.min(axis.speed(cx, at::HIGHEST));
    Ok((wanted, axis.speed(cx, at::FIRST)))
}

fn begin(cx: &mut Cx, axis: Registers) -> Done {
    let Some(reverse) = direction(cx, axis)? else {
        return Ok(());
    };
    let pulses = u32::from(cx.read(1)? as u16);
    let (wanted, first) = speeds(cx, axis)?;
    if pulses == 0 && wanted == 0 {
        return axis.refuse(cx, error::BELOW_FIRST);
    }
    if pulses == 0 {
        return run_on(cx, axis, reverse);
    }
    let train = Train::steady(wanted.max(first) as u32, pulses);
    cx.state().0[STAGE] = PULSES;
    axis.start(cx, train, reverse)
}

/// Continues without end: below the first speed at once, else with ramps.
fn run_on(cx: &mut Cx, axis: Registers, reverse: bool) -> Done {
    let (wanted, first) = speeds(cx, axis)?;
    let train = match wanted < first {
        true => Train::steady(wanted as u32, 0),
        false => axis.train(cx, wanted, 0, 0),
    };
    cx.state().0[STAGE] = GOES_ON;
    axis.start(cx, train, reverse)
}

fn go_on(cx: &mut Cx, axis: Registers) -> Done {
    let now_ms = cx.plc.sys().now_ms;
    let busy = axis.generator(cx)?.is_busy();
    let asked = direction(cx, axis)?;
    match (cx.state().0[STAGE], asked) {
        (PULSES, _) if !busy => {
            let state = cx.state();
            state.0[STAGE] = PAUSES;
            state.0[SINCE] = now_ms as i32;
        }
        (PAUSES, _) if now_ms.wrapping_sub(cx.state().0[SINCE] as u32) < PAUSE_MS => {}
        (PAUSES, Some(reverse)) if speeds(cx, axis)?.0 > 0 => return run_on(cx, axis, reverse),
        (PAUSES, _) => axis.end(cx, state::DONE),
        (GOES_ON, Some(reverse)) if !busy => return run_on(cx, axis, reverse),
        (GOES_ON, Some(reverse)) => {
            let turns = axis.can_reverse(cx) && axis.generator(cx)?.is_reverse() != reverse;
            if turns {
                axis.generator(cx)?.stop();
            }
        }
        _ => {}
    }
    Ok(())
}
