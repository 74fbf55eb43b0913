//! Positioning: FNC 150, 151, 156 to 159 (h1u-h2u-programming §4.3.11, §8.5, §8.7; l01s-programming §7.2). Positions
//! are counted in the registers of the output; forward counts up.

use super::output::{Output, Turn, held, unsigned};
use crate::axis::set_long;
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::pulse::Train;
use crate::special::Relay;

/// Word of the memory with the position in which a move began.
const BEGAN: usize = 4;

/// DRVI S1 S2 D1 D2 (FNC 158): moves by S1 pulses at S2 Hz with ramps; pulses on D1, D2 on if forward. It comes down
/// when its drive goes off. While the relay for that is on, S1 may change until it comes down.
pub fn drvi(cx: &mut Cx) -> Done {
    held(cx, |cx| move_by(cx, |cx, _, _| cx.read(0)))
}

/// DRVA S1 S2 D1 D2 (FNC 159): moves to position S1 as DRVI does.
pub fn drva(cx: &mut Cx) -> Done {
    held(cx, |cx| {
        move_by(cx, |cx, output, began| {
            let from = began.unwrap_or_else(|| output.position(cx));
            Ok(cx.read(0)?.saturating_sub(from))
        })
    })
}

/// `distance` is given where the move began, once it has begun.
fn move_by(
    cx: &mut Cx,
    distance: impl Fn(&mut Cx, Output, Option<i32>) -> Result<i32, Fault>,
) -> Done {
    let output = Output::of(cx, 2)?;
    match output.turn(cx)? {
        Turn::Start => {
            let distance = distance(cx, output, None)?;
            let hz = u32::try_from(cx.read(1)?).map_err(|_| Fault::VALUE)?;
            cx.state().0[BEGAN] = output.position(cx);
            cx.set_bit(3, 0, distance >= 0)?;
            if distance == 0 {
                output.finish(cx);
            } else {
                let ramp = output.ramp(cx);
                let train = ramp.train(hz, distance.unsigned_abs(), distance < 0);
                output.start(cx, train, output.wiring.position)?;
            }
        }
        Turn::Sends => {
            let began = cx.state().0[BEGAN];
            let distance = distance(cx, output, Some(began))?;
            let reverse = output.axis(cx)?.generator.is_reverse();
            if (distance < 0) == reverse {
                output.change_total(cx, distance.unsigned_abs())?;
            }
        }
        Turn::Released => output.axis(cx)?.generator.stop(),
        Turn::Rest => {}
    }
    output.show(cx)
}

/// Words of the memory of DVIT: whether its signal was there, how many pulses follow it, and whether it has come.
const SIGNAL_WAS_ON: usize = 5;
const PULSES: usize = 6;
const INTERRUPTED: usize = 7;

/// DVIT S1 S2 D1 D2 (FNC 151): runs at S2 Hz with ramps, D2 on if S1 is positive, forward. At the rising edge of its
/// interrupt signal it continues by
/// |S1| pulses, coming down to them; if they are too few for that, at once at a speed from which it can. It comes down when its drive goes
/// off.
pub fn dvit(cx: &mut Cx) -> Done {
    held(cx, do_dvit)
}

fn do_dvit(cx: &mut Cx) -> Done {
    let output = Output::of(cx, 2)?;
    match output.turn(cx)? {
        Turn::Start => {
            let (distance, hz) = (cx.read(0)?, cx.read(1)?);
            let hz = u32::try_from(hz).map_err(|_| Fault::VALUE)?;
            if distance == 0 {
                return Err(Fault::VALUE);
            }
            let is_on = output.is_interrupted(cx)?;
            let state = cx.state();
            state.0[SIGNAL_WAS_ON] = is_on.into();
            state.0[PULSES] = distance.saturating_abs();
            state.0[INTERRUPTED] = 0;
            cx.set_bit(3, 0, distance > 0)?;
            let train = output.ramp(cx).train(hz, 0, distance < 0);
            output.start(cx, train, output.wiring.position)?;
        }
        Turn::Sends => {
            let is_on = output.is_interrupted(cx)?;
            let state = cx.state();
            let was_on = core::mem::replace(&mut state.0[SIGNAL_WAS_ON], is_on.into()) != 0;
            if is_on && !was_on && state.0[INTERRUPTED] == 0 {
                state.0[INTERRUPTED] = 1;
                let pulses = state.0[PULSES].unsigned_abs();
                output.axis(cx)?.generator.end_in(pulses);
            }
        }
        Turn::Released => output.axis(cx)?.generator.stop(),
        Turn::Rest => {}
    }
    output.show(cx)
}

/// PLSV S D1 D2 (FNC 157): sends pulses of |S| Hz on D1 as long as it is driven; D2 is on if S is positive, forward. S
/// may change at any time: at once, or with ramps where the model has a relay for that and it is on.
pub fn plsv(cx: &mut Cx) -> Done {
    held(cx, do_plsv)
}

fn do_plsv(cx: &mut Cx) -> Done {
    let output = Output::of(cx, 1)?;
    match output.turn(cx)? {
        Turn::Start => begin_plsv(cx, output)?,
        Turn::Sends => {
            let speed = cx.read(0)?;
            let millihertz = output.millihertz(cx, speed.unsigned_abs());
            let slides = output.slides(cx);
            let generator = &mut output.axis(cx)?.generator;
            let turns = speed != 0 && generator.is_reverse() != (speed < 0);
            match generator.is_busy() {
                // A moving axis slows down before it reverses.
                true if generator.is_stopping() => {}
                true if !turns => generator.set_speed(millihertz),
                true if slides => generator.stop(),
                _ => begin_plsv(cx, output)?,
            }
        }
        Turn::Released if output.slides(cx) => output.axis(cx)?.generator.stop(),
        Turn::Released => output.axis(cx)?.generator.halt(),
        Turn::Rest => {}
    }
    output.show(cx)
}

/// Sends pulses of the speed and in the direction that PLSV says.
fn begin_plsv(cx: &mut Cx, output: Output) -> Done {
    let speed = cx.read(0)?;
    let reverse = speed < 0;
    cx.set_bit(2, 0, !reverse)?;
    let train = if output.slides(cx) {
        let ramp = output.ramp_for_all(cx);
        ramp.endless_train(speed.unsigned_abs(), reverse)
    } else {
        Train {
            reverse,
            ..Train::steady(output.millihertz(cx, speed.unsigned_abs()), 0)
        }
    };
    output.start(cx, train, output.wiring.position)
}

/// Word of the memory with the stage of a return.
const STAGE: usize = 4;

/// ZRN S1 S2 S3 D (FNC 156): runs back at S1 Hz until S3 is on, then at S2 Hz until it is off: there it stops at once,
/// the position is 0, and a clear signal is given if the relay for that is on.
pub fn zrn(cx: &mut Cx) -> Done {
    held(cx, do_zrn)
}

fn do_zrn(cx: &mut Cx) -> Done {
    let output = Output::of(cx, 3)?;
    output.end_clear_signal(cx, output.wiring.zrn_clear);
    let turn = output.turn(cx)?;
    match turn {
        Turn::Start | Turn::Sends => {
            let [fast, creep] = unsigned(cx)?;
            let near = cx.bit(2, 0)?;
            if turn == Turn::Start {
                let ramp = output.ramp_for_all(cx);
                let hz = if near { creep } else { fast };
                let train = ramp.endless_train(hz, true);
                output.start(cx, train, output.wiring.position)?;
                cx.state().0[STAGE] = near.into();
            }
            let creeps = cx.state().0[STAGE] != 0;
            if near && !creeps {
                let creep = output.millihertz(cx, creep);
                output.axis(cx)?.generator.set_speed(creep);
                cx.state().0[STAGE] = 1;
            } else if creeps && !near {
                home(cx, output)?;
                output.begin_clear_signal(cx, output.wiring.zrn_clear);
            }
        }
        Turn::Released => output.axis(cx)?.generator.stop(),
        Turn::Rest => {}
    }
    output.show(cx)
}

/// The output is at its origin.
fn home(cx: &mut Cx, output: Output) -> Done {
    output.axis(cx)?.generator.halt();
    output.count(cx);
    if let Some(position) = output.wiring.position {
        set_long(cx.plc, position, 0);
    }
    output.finish(cx);
    Ok(())
}

/// Stages of DSZR. Those that run against the direction of the return come first.
mod stage {
    /// Leaves the DOG against the direction of the return.
    pub const LEAVE: i32 = 0;
    /// Seeks the DOG against the direction of the return, from the limit.
    pub const SEEK_BACK: i32 = 1;
    /// Is over the DOG on that way.
    pub const OVER: i32 = 2;
    /// Comes to a halt, to turn round.
    pub const TURN: i32 = 3;
    /// Seeks the DOG.
    pub const SEEK: i32 = 4;
    /// Creeps over the DOG.
    pub const CREEP: i32 = 5;
    /// Waits for the zero signal after it.
    pub const ZERO: i32 = 6;
    /// Comes to a halt at the limit of the return, to seek back.
    pub const TURN_BACK: i32 = 7;
}

/// Word of the memory with whether the zero signal was on.
const ZERO_WAS_ON: usize = 5;

/// DSZR S1 S2 D1 D2 (FNC 150): returns to the origin at the speeds of special registers. It runs in the direction of
/// the return until the DOG S1 is on, creeps until S1 is off and then to the next rise of the zero signal S2, where it
/// stops at once. Begun over the DOG or past it, at the limit, it first runs back until the DOG is left. With S1 = S2
/// the fall of the DOG is the origin.
pub fn dszr(cx: &mut Cx) -> Done {
    held(cx, do_dszr)
}

fn do_dszr(cx: &mut Cx) -> Done {
    let output = Output::of(cx, 2)?;
    output.end_clear_signal(cx, output.wiring.home.and_then(|home| home.clear));
    match output.turn_resting(cx)? {
        Turn::Start => {
            let home = output.home_speeds(cx)?;
            let signals = Signals::read(cx, output)?;
            let first = match (signals.limit, signals.dog) {
                (true, _) => stage::SEEK_BACK,
                (false, true) => stage::LEAVE,
                (false, false) => stage::SEEK,
            };
            cx.state().0[ZERO_WAS_ON] = signals.zero.into();
            run(cx, output, home.ramp.endless_train(home.fast, false), first)?;
        }
        Turn::Sends => return_home(cx, output)?,
        Turn::Released => output.axis(cx)?.generator.stop(),
        Turn::Rest => {}
    }
    output.show(cx)
}

/// Signals that DSZR evaluates.
struct Signals {
    /// The DOG, its logic regarded.
    dog: bool,
    /// The zero signal likewise.
    zero: bool,
    /// The limit switch in the direction of the return.
    limit: bool,
    /// The one in the other direction.
    other_limit: bool,
    /// DOG and zero signal are one input.
    same: bool,
    /// The return runs forward.
    forward: bool,
}

impl Signals {
    fn read(cx: &Cx, output: Output) -> Result<Signals, Fault> {
        let home = output.wiring.home.ok_or(Fault::DEVICE)?;
        let on = |relay: Relay| output.has_on(cx, relay);
        let same = matches!(cx.ops, [dog, zero, ..] if dog == zero);
        let forward = on(home.forward);
        let [ahead, back] = [on(home.limits[0]), on(home.limits[1])];
        let dog = cx.bit(0, 0)? != output.has_on(cx, home.dog_inverted);
        Ok(Signals {
            dog,
            zero: if same {
                dog
            } else {
                cx.bit(1, 0)? != on(home.zero_inverted)
            },
            limit: if forward { ahead } else { back },
            other_limit: if forward { back } else { ahead },
            same,
            forward,
        })
    }
}

/// Runs a stage: against the direction of the return, or in it.
fn run(cx: &mut Cx, output: Output, train: Train, stage: i32) -> Done {
    let returns = stage >= stage::SEEK;
    let forward = Signals::read(cx, output)?.forward == returns;
    cx.set_bit(3, 0, forward)?;
    let train = Train {
        reverse: !forward,
        ..train
    };
    cx.state().0[STAGE] = stage;
    output.run(cx, train, output.wiring.position)
}

/// A scan of a return that has begun.
fn return_home(cx: &mut Cx, output: Output) -> Done {
    let signals = Signals::read(cx, output)?;
    let home = output.home_speeds(cx)?;
    let zero_was_on = core::mem::replace(&mut cx.state().0[ZERO_WAS_ON], signals.zero.into()) != 0;
    let zero_rises = signals.zero && !zero_was_on;
    let was = cx.state().0[STAGE];
    let runs_back = was < stage::TURN;
    if runs_back && signals.other_limit {
        output.axis(cx)?.generator.stop();
        return output.fail(cx);
    }
    let turns = |cx: &mut Cx, next: i32| -> Done {
        output.axis(cx)?.generator.stop();
        cx.state().0[STAGE] = next;
        Ok(())
    };
    match (was, signals.dog) {
        (stage::SEEK_BACK, true) => cx.state().0[STAGE] = stage::OVER,
        (stage::LEAVE | stage::OVER, false) => turns(cx, stage::TURN)?,
        (stage::SEEK, true) => {
            let creep = 1000 * home.creep;
            output.axis(cx)?.generator.set_speed(creep);
            cx.state().0[STAGE] = stage::CREEP;
        }
        (stage::SEEK, false) if signals.limit => turns(cx, stage::TURN_BACK)?,
        (stage::CREEP, false) if signals.same => origin(cx, output)?,
        (stage::CREEP, false) => cx.state().0[STAGE] = stage::ZERO,
        (stage::ZERO, _) if zero_rises => origin(cx, output)?,
        (stage::CREEP | stage::ZERO, _) if signals.limit => {
            output.axis(cx)?.generator.stop();
            return output.fail(cx);
        }
        _ => {}
    }
    let idle = !output.axis(cx)?.generator.is_busy();
    let next = match cx.state().0[STAGE] {
        stage::TURN if idle => stage::SEEK,
        stage::TURN_BACK if idle => stage::SEEK_BACK,
        _ => return Ok(()),
    };
    run(cx, output, home.ramp.endless_train(home.fast, false), next)
}

fn origin(cx: &mut Cx, output: Output) -> Done {
    home(cx, output)?;
    output.begin_clear_signal(cx, output.wiring.home.and_then(|home| home.clear));
    Ok(())
}
