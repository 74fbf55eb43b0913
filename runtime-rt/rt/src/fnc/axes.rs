//! Motion of one axis by pulses, of HM: hm-motion-controller §8.3.3 and §8.3.7 to §8.3.12. An instruction names an
//! axis, whose fifty registers (§8.2.3) say to which output it is bound, and all but what the operands say.
//!
//! An instruction's memory: words 0 and 1 see `axis_registers`; word 2 keeps the number of pulses, word 3 whether the
//! interrupt of DDVIT has come.

use super::axis_registers::{Registers, error, event, motion, state};
use crate::axis::set_long;
use crate::axis_place as at;
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::pulse::Train;

/// Milliseconds that a ramp of DPLSR may last.
const RAMP_MS: (i32, i32) = (50, 5000);

/// Words with its number of pulses, and whether the interrupt has come.
const COUNT: usize = 2;
const INTERRUPTED: usize = 3;

/// Kind of motion.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// DPLSY: at one speed, which may change.
    Steady,
    /// DPLSR: with ramps of a given time.
    Timed,
    /// PSOUT: at the highest speed.
    Highest,
    /// DDRVI, DDRVA: with the ramps of the axis.
    Move,
    /// DDVIT: until an interrupt, and this many more pulses.
    ToInterrupt,
    /// DPLSV: without end; the speed may change.
    Variable,
}

/// Motion that an instruction requests.
struct Order {
    kind: Kind,
    /// Speed in pulses a unit of time.
    speed: i32,
    /// Pulses, negative in reverse.
    count: i32,
    /// Time of a ramp, for [`Kind::Timed`].
    ramp_ms: i32,
}

impl Order {
    const fn new(kind: Kind, speed: i32, count: i32) -> Self {
        Order {
            kind,
            speed,
            count,
            ramp_ms: RAMP_MS.0,
        }
    }
}

/// DPLSY D1 D2 D3: sends D2 pulses of D1 on axis D3. D1 may change; only an emergency stops it, at once.
pub fn axis_plsy(cx: &mut Cx) -> Done {
    drive(cx, 2, |cx, _| {
        Ok(Order::new(Kind::Steady, cx.read(0)?, cx.read(1)?))
    })
}

/// DPLSR D1 D2 D3 D4: sends D2 pulses of D1 on axis D4, with ramps of D3 ms, but none steeper than those of the axis.
pub fn axis_plsr(cx: &mut Cx) -> Done {
    drive(cx, 3, |cx, _| {
        Ok(Order {
            ramp_ms: cx.read(2)?.clamp(RAMP_MS.0, RAMP_MS.1),
            ..Order::new(Kind::Timed, cx.read(0)?, cx.read(1)?)
        })
    })
}

/// PSOUT D1 D2: moves axis D1 by D2 pulses, at its highest speed with its ramps, which here are straight. It stops at
/// once with its drive.
pub fn axis_psout(cx: &mut Cx) -> Done {
    drive(cx, 0, |cx, _| Ok(Order::new(Kind::Highest, 0, cx.read(1)?)))
}

/// DDRVI D1 D2 D3: moves axis D3 by D1 pulses at D2.
pub fn axis_drvi(cx: &mut Cx) -> Done {
    drive(cx, 2, |cx, _| {
        Ok(Order::new(Kind::Move, cx.read(1)?, cx.read(0)?))
    })
}

/// DDRVA D1 D2 D3: moves axis D3 to position D1 at D2.
pub fn axis_drva(cx: &mut Cx) -> Done {
    drive(cx, 2, |cx, axis| {
        let position = axis.position(cx);
        let distance = cx.read(0)?.saturating_sub(position);
        Ok(Order::new(Kind::Move, cx.read(1)?, distance))
    })
}

/// DDVIT D1 D2 D3: runs axis D3 at D2 until its interrupt comes, and sends D1 pulses more.
pub fn axis_dvit(cx: &mut Cx) -> Done {
    drive(cx, 2, |cx, _| {
        Ok(Order::new(Kind::ToInterrupt, cx.read(1)?, cx.read(0)?))
    })
}

/// DPLSV D1 D2: runs axis D2 at D1, which may change.
pub fn axis_plsv(cx: &mut Cx) -> Done {
    drive(cx, 1, |cx, _| {
        let speed = cx.read(0)?;
        Ok(Order::new(Kind::Variable, speed.saturating_abs(), speed))
    })
}

/// Executes one of them in a scan; operand `i` is the axis.
fn drive(
    cx: &mut Cx,
    i: usize,
    order: impl Fn(&mut Cx, Registers) -> Result<Order, Fault>,
) -> Done {
    let first = |cx: &mut Cx, axis| {
        let order = order(cx, axis)?;
        begin(cx, axis, &order)
    };
    let next = |cx: &mut Cx, axis| {
        let order = order(cx, axis)?;
        go_on(cx, axis, &order)
    };
    // PSOUT names its axis first.
    motion(cx, i, i == 0, &first, &next)
}

/// The train that an order asks for.
fn train(cx: &Cx, axis: Registers, order: &Order) -> Train {
    let first = axis.speed(cx, at::FIRST);
    let wanted = axis.millihertz(cx, order.speed);
    let total = order.count.unsigned_abs();
    match order.kind {
        Kind::Steady => axis.steady(cx, wanted, total),
        Kind::Timed => {
            let train = axis.train(cx, wanted.max(first), first, total);
            let rise = u64::from(train.speed).saturating_sub(first);
            let slope = 2_000_000 * rise / order.ramp_ms.max(1) as u64;
            let slope = if slope == 0 {
                train.up
            } else {
                slope.min(train.up)
            };
            Train {
                lowest: (first * first).max(slope / 4),
                up: slope,
                down: slope,
                ..train
            }
        }
        Kind::Highest => axis.train(cx, u64::from(u32::MAX), first, total),
        Kind::Move => axis.train(cx, wanted.max(first), first, total),
        Kind::ToInterrupt => axis.train(cx, wanted.max(first), first, 0),
        Kind::Variable => axis.train(cx, wanted, 0, 0),
    }
}

/// The axis is free: the motion begins.
fn begin(cx: &mut Cx, axis: Registers, order: &Order) -> Done {
    if order.speed < 0 || (order.speed == 0 && order.kind == Kind::Timed) {
        return axis.refuse(cx, error::BELOW_FIRST);
    }
    let is_endless = matches!(order.kind, Kind::ToInterrupt | Kind::Variable);
    if order.count == 0 && !is_endless {
        axis.set(cx, at::ERROR, 0);
        axis.end(cx, state::DONE);
        return Ok(());
    }
    let reverse = order.count < 0 && axis.can_reverse(cx);
    if axis.sees(cx, at::EMERGENCY, event::EMERGENCY) || at_limit(cx, axis, order.kind, reverse) {
        axis.set(cx, at::ERROR, 0);
        axis.end(cx, state::STOPPED);
        return Ok(());
    }
    let train = train(cx, axis, order);
    axis.start(cx, train, order.count < 0)?;
    let state = cx.state();
    state.0[COUNT] = order.count;
    state.0[INTERRUPTED] = 0;
    watch(cx, axis, order)
}

/// Returns true if the limit of a direction is reached, and this kind of motion ends there.
fn at_limit(cx: &Cx, axis: Registers, kind: Kind, reverse: bool) -> bool {
    matches!(kind, Kind::Move | Kind::ToInterrupt | Kind::Variable)
        && match reverse {
            true => axis.sees(cx, at::LEFT, event::LEFT),
            false => axis.sees(cx, at::RIGHT, event::RIGHT),
        }
}

/// A scan of a motion that has begun.
fn go_on(cx: &mut Cx, axis: Registers, order: &Order) -> Done {
    if axis.generator(cx)?.is_busy() {
        return watch(cx, axis, order);
    }
    match axis.word(cx, at::STATE) {
        state::COMES_DOWN => axis.end(cx, state::STOPPED),
        // It has come down to turn round.
        state::RUNS if order.kind == Kind::Variable => return begin(cx, axis, order),
        _ => axis.end(cx, state::DONE),
    }
    Ok(())
}

/// Emergencies, limits, the interrupt, and changes of speed.
fn watch(cx: &mut Cx, axis: Registers, order: &Order) -> Done {
    let kind = order.kind;
    if axis.sees(cx, at::EMERGENCY, event::EMERGENCY) {
        let comes_down = axis.has(cx, event::COMES_DOWN) && kind != Kind::Steady;
        return match (comes_down, axis.word(cx, at::STATE)) {
            (false, _) => axis.stop(cx, state::STOPPED),
            (true, state::RUNS) => axis.come_down(cx),
            (true, _) => Ok(()),
        };
    }
    if axis.word(cx, at::STATE) != state::RUNS {
        return Ok(());
    }
    let reverse = axis.generator(cx)?.is_reverse();
    if at_limit(cx, axis, kind, reverse) {
        return axis.come_down(cx);
    }
    match kind {
        Kind::ToInterrupt
            if cx.state().0[INTERRUPTED] == 0 && axis.sees(cx, at::INTERRUPT, event::INTERRUPT) =>
        {
            let position = axis.position(cx);
            set_long(cx.plc, axis.register(at::INTERRUPT_POSITION), position);
            let state = cx.state();
            state.0[INTERRUPTED] = 1;
            let count = state.0[COUNT].unsigned_abs();
            if count == 0 {
                return axis.stop(cx, state::DONE);
            }
            axis.generator(cx)?.end_in(count);
        }
        Kind::Steady | Kind::Variable => {
            let speed = train(cx, axis, order).speed;
            let turns = kind == Kind::Variable
                && axis.can_reverse(cx)
                && order.count != 0
                && (order.count < 0) != reverse;
            let generator = axis.generator(cx)?;
            match turns {
                true => generator.stop(),
                false if generator.is_stopping() => {}
                false => generator.set_speed(speed),
            }
        }
        _ => {}
    }
    Ok(())
}
