//! Axes that follow a master of HM: GEAR and PTOUT (hm-motion-controller §8.4.1, §8.3.5). Each scan hands over as many
//! pulses as the master has moved on, which are spread over the time of a scan.
//!
//! IPL adds pulses (§8.3.6).
//!
//! Memory: words 0 and 1 see `axis_registers`; word 2 the pulses not handed over yet, word 3 the master, or the pulses
//! of IPL, before, word 4 the rest of a division or the place in the table, word 5 the position in the table.

use super::axis_registers::{Registers, error, motion, state};
use super::output::held;
use crate::axis_place as at;
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::operand::OperandKind;
use crate::plc::Class;
use crate::pulse::Train;
use crate::special::Register;
use crate::word::pair;

/// Words of the memory.
pub(super) const PENDING: usize = 2;
const MASTER: usize = 3;
const REST: usize = 4;
pub(super) const PLACE: usize = 5;

/// GEAR D1 D2 D3 D4 D5: axis D1 follows register D2, a count (D3 = 0) or what it has moved on (1), by D4 / D5. It stops
/// at once with its drive.
pub fn axis_gear(cx: &mut Cx) -> Done {
    motion(cx, 0, true, &begin_gear, &gear)
}

/// A register by its number.
pub(super) fn word(cx: &Cx, number: u32) -> Result<i16, Fault> {
    cx.plc.word(Class::D, number).ok_or(Fault::DEVICE)
}

/// A pair of registers by the number of its low word.
pub(super) fn long(cx: &Cx, number: u32) -> Result<i32, Fault> {
    Ok(pair(word(cx, number)?, word(cx, number + 1)?))
}

/// Count of the master: if it is named by the increment of an axis or input, this is the position, so that no increment
/// is lost.
fn count_of_master(cx: &Cx) -> Result<i32, Fault> {
    if let Some(position) = position_of_increment(cx) {
        return long(cx, position.number());
    }
    cx.dword(1, 0)
}

/// The position to which an increment belongs, if the master is one of an axis.
fn position_of_increment(cx: &Cx) -> Option<Register> {
    let operand = cx.ops.get(1)?;
    if operand.kind != OperandKind::Device || operand.class != Class::D {
        return None;
    }
    let named = u32::try_from(operand.value).ok()?;
    let mut inputs = at::INPUT_COUNTS.iter();
    if let Some((_, count)) = inputs.find(|(increment, _)| increment.number() == named) {
        return Some(*count);
    }
    let outputs = cx.plc.pulses().outputs().iter();
    let mut axes = outputs.filter_map(|wiring| wiring.axis);
    axes.find(|axis| axis.after(at::INCREMENT).number() == named)
        .map(|axis| axis.after(at::POSITION))
}

fn begin_gear(cx: &mut Cx, axis: Registers) -> Done {
    let master = count_of_master(cx)?;
    let state = cx.state();
    state.0[PENDING..].fill(0);
    state.0[MASTER] = master;
    axis.take(cx)
}

fn gear(cx: &mut Cx, axis: Registers) -> Done {
    let increments = cx.word(2, 0)? == 1 && position_of_increment(cx).is_none();
    let moved = if increments {
        cx.word(1, 0)?.into()
    } else {
        let master = count_of_master(cx)?;
        master.wrapping_sub(core::mem::replace(&mut cx.state().0[MASTER], master))
    };
    let [top, bottom] = [i64::from(cx.word(3, 0)?), i64::from(cx.word(4, 0)?)];
    let (top, bottom) = if bottom == 0 { (1, 1) } else { (top, bottom) };
    let whole = i64::from(moved) * top + i64::from(cx.state().0[REST]);
    cx.state().0[REST] = whole.rem_euclid(bottom) as i32;
    hand_over(cx, axis, whole.div_euclid(bottom) as i32)
}

/// PTOUT D1 D2 D3 D4 D5: axis D1 follows the table D2 while the master D3 moves through the range D4, once (D5 = 0) or
/// again and again. It stops at once with its drive.
pub fn axis_ptout(cx: &mut Cx) -> Done {
    motion(cx, 0, true, &begin_table, &table)
}

fn begin_table(cx: &mut Cx, axis: Registers) -> Done {
    let master = cx.dword(2, 0)?;
    let first = cx.dword(1, 2)?;
    let state = cx.state();
    state.0[PENDING..].fill(0);
    state.0[MASTER] = master;
    state.0[PLACE] = first;
    axis.take(cx)
}

fn table(cx: &mut Cx, axis: Registers) -> Done {
    let steps = i64::from(cx.dword(1, 0)?) - 1;
    let range = i64::from(cx.dword(3, 0)?);
    if steps < 1 || range < 1 {
        return Err(Fault::VALUE);
    }
    let again = cx.dword(4, 0)? == 1;
    let master = cx.dword(2, 0)?;
    let mut moved = i64::from(master.wrapping_sub(cx.state().0[MASTER])).max(0);
    let mut pulses = 0;
    let rounds = moved / range;
    if again && rounds > 0 {
        pulses += i64::from(go_to(cx, steps, range, range)?);
        let first = cx.dword(1, 2)?;
        let state = cx.state();
        let whole = i64::from(state.0[PLACE]) - i64::from(first);
        pulses += whole * (rounds - 1);
        state.0[MASTER] = state.0[MASTER].wrapping_add((rounds * range) as i32);
        state.0[PLACE] = first;
        moved -= rounds * range;
    }
    let moved = moved.min(range);
    pulses += i64::from(go_to(cx, steps, moved, range)?);
    let pulses = pulses.clamp(i64::from(i32::MIN), i64::from(i32::MAX));
    hand_over(cx, axis, pulses as i32)?;
    if moved == range && cx.state().0[PENDING] == 0 && !axis.generator(cx)?.is_busy() {
        axis.end(cx, state::DONE);
    }
    Ok(())
}

/// The pulses to the place in the table where the master has moved by this much of its range, between two of its
/// points.
pub(super) fn go_to(cx: &mut Cx, steps: i64, moved: i64, range: i64) -> Result<i32, Fault> {
    let point = |cx: &Cx, n: i64| -> Result<i64, Fault> {
        let offset = i32::try_from(2 + 2 * n).map_err(|_| Fault::DEVICE)?;
        cx.dword(1, offset).map(i64::from)
    };
    let along = moved * steps;
    let (n, part) = (along / range, along % range);
    let from = point(cx, n)?;
    let place = match part {
        0 => from,
        _ => from + (point(cx, n + 1)? - from) * part / range,
    };
    let place = place as i32;
    let before = core::mem::replace(&mut cx.state().0[PLACE], place);
    Ok(place.wrapping_sub(before))
}

/// Hands pulses over to the axis. Those in the other direction wait until it rests. More than its output could send in
/// the time of a scan are an error.
pub(super) fn hand_over(cx: &mut Cx, axis: Registers, pulses: i32) -> Done {
    let wanted = u64::from(pulses.unsigned_abs()) * 1_000_000 / cx.dt_ms().max(1) as u64;
    if wanted > axis.most(cx) {
        return axis.fail(cx, error::OVERSPEED);
    }
    let pending = cx.state().0[PENDING].wrapping_add(pulses);
    cx.state().0[PENDING] = pending;
    let reverse = pending < 0 && axis.can_reverse(cx);
    let generator = *axis.generator(cx)?;
    if pending == 0 || (generator.is_busy() && generator.is_reverse() != reverse) {
        return Ok(());
    }
    cx.state().0[PENDING] = 0;
    let count = pending.unsigned_abs();
    let left = u64::from(generator.remaining()) + u64::from(count);
    let wanted = left * 1_000_000 / cx.dt_ms().max(1) as u64;
    let train = axis.steady(cx, wanted, count);
    if generator.is_busy() {
        let generator = axis.generator(cx)?;
        generator.extend(count);
        generator.set_speed(train.speed);
        return Ok(());
    }
    axis.start(cx, train, reverse)
}

/// IPL D1 D2: inserts D2 pulses into what axis D1 sends, in the next millisecond, each time it is executed with its
/// drive on. Its highest speed does not limit them, and it may be running; more than its output can send in that time,
/// together with what it sends, are an error. Without a pause of one execution before it, a change of direction is
/// lost.
pub fn axis_ipl(cx: &mut Cx) -> Done {
    held(cx, insert)
}

fn insert(cx: &mut Cx) -> Done {
    let axis = Registers::of(cx, 0)?;
    if !axis.has_output(cx) {
        return Ok(());
    }
    let count = if cx.drive() {
        i32::from(cx.word(1, 0)?)
    } else {
        axis.forget_error(cx);
        0
    };
    let speed = u64::from(count.unsigned_abs()) * 1_000_000;
    if count != 0 && speed + axis.speed_of_motion(cx) > axis.most(cx) {
        cx.state().0[MASTER] = 0;
        return axis.fail(cx, error::OVERSPEED);
    }
    let before = core::mem::replace(&mut cx.state().0[MASTER], count);
    let turns = count.signum() * before.signum() < 0;
    let lost = turns && axis.has_direction(cx);
    let state = cx.state();
    if !lost {
        state.0[PENDING] = state.0[PENDING].wrapping_add(count);
    }
    let pending = state.0[PENDING];
    let reverse = pending < 0 && axis.can_reverse(cx);
    let generator = *axis.generator(cx)?;
    let busy = generator.is_busy();
    let takes_more = generator.remaining() > 0 && !generator.is_stopping();
    let waits = busy && (!takes_more || generator.is_reverse() != reverse);
    if pending == 0 || waits {
        return Ok(());
    }
    cx.state().0[PENDING] = 0;
    let count = pending.unsigned_abs();
    if busy {
        axis.generator(cx)?.extend(count);
        return Ok(());
    }
    let speed = (u64::from(count) * 1_000_000).min(axis.most(cx));
    axis.send(cx, Train::steady(speed as u32, count), reverse)
}
