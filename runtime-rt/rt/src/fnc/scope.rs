//! The oscilloscope of HM (hm-motion-controller §5.6): it records registers, time after time, in other registers.

use crate::cx::Cx;
use crate::fault::Done;
use crate::special::{
    D_SCOPE_AREA_FIRST, D_SCOPE_AREA_LAST, D_SCOPE_CHANNELS, D_SCOPE_FIRST, D_SCOPE_MODE,
    D_SCOPE_PERIOD, D_SCOPE_SAMPLES, D_SCOPE_STATE, D_SCOPE_TAKEN, D_SCOPE_THRESHOLD,
    D_SCOPE_TRIGGER, Register,
};

/// The last register of a record.
const LAST_REGISTER: u16 = 7999;

/// Values of [`D_SCOPE_STATE`], and the one that starts the oscilloscope.
const WAITING: i16 = 0;
const SAMPLING: i16 = 1;
const WRONG: i16 = 2;
const DONE: i16 = 3;
const START: i16 = 4;

/// Registers that may be a trigger.
const TRIGGERS: core::ops::RangeInclusive<i16> = 0..=999;

/// Recording with the parameters at its start.
#[derive(Clone, Copy)]
struct Recording {
    /// In tenths of a millisecond.
    period: i32,
    samples: i32,
    /// Register of the next sample.
    next: i32,
    /// Words and first register of the channels.
    channels: [[i32; 2]; 2],
}

/// Advances to the time in operand 0, in milliseconds. Memory: the time of the last call and tenths of milliseconds
/// since the last sample; then the [`Recording`].
pub fn oscilloscope(cx: &mut Cx) -> Done {
    let now = cx.read(0)?;
    let passed = now.wrapping_sub(cx.state().0[0]);
    cx.state().0[0] = now;
    if cx.special_word(D_SCOPE_STATE) == START {
        start(cx);
    } else if cx.special_word(D_SCOPE_STATE) == SAMPLING {
        sample(cx, passed.clamp(0, i32::MAX / 10) * 10);
    }
    if cx.special_word(D_SCOPE_STATE) == WAITING && triggered(cx) {
        cx.set_special_word(D_SCOPE_STATE, SAMPLING);
    }
    Ok(())
}

/// Takes the parameters over, if they make sense.
fn start(cx: &mut Cx) {
    let number = |register| i32::from(cx.special_word(register));
    let [a, b, c, d] = D_SCOPE_CHANNELS.run().map(number);
    let recording = Recording {
        period: match number(D_SCOPE_PERIOD) {
            ..=0 => 1,
            1 => 5,
            2 => 10,
            n => 10 * (n + 1),
        },
        samples: number(D_SCOPE_SAMPLES),
        next: number(D_SCOPE_FIRST),
        channels: [[a, b], [c, d]],
    };
    let mode = number(D_SCOPE_MODE);
    let by_register = mode != 0;
    let words: i32 = recording.channels.iter().map(|[words, _]| words).sum();
    let last = i64::from(recording.samples) * i64::from(words) + i64::from(recording.next) - 1;
    let fits = (number(D_SCOPE_AREA_FIRST)..=number(D_SCOPE_AREA_LAST)).contains(&recording.next)
        && last <= i64::from(number(D_SCOPE_AREA_LAST));
    let right = (0..=2).contains(&mode)
        && (!by_register || TRIGGERS.contains(&cx.special_word(D_SCOPE_TRIGGER)))
        && recording.samples > 0
        && recording.channels.iter().all(|&[words, _]| words >= 0)
        && fits;
    cx.set_special_word(D_SCOPE_TAKEN, 0);
    cx.set_special_word(D_SCOPE_STATE, if right { WAITING } else { WRONG });
    recording.keep(cx);
}

/// Returns true if sampling begins.
fn triggered(cx: &Cx) -> bool {
    let trigger = cx.special_word(D_SCOPE_TRIGGER);
    let value = || u16::try_from(trigger).map_or(0, |n| cx.special_word(Register(n)));
    let threshold = cx.special_word(D_SCOPE_THRESHOLD);
    match cx.special_word(D_SCOPE_MODE) {
        0 => trigger != 0,
        1 => value() >= threshold,
        2 => value() <= threshold,
        _ => false,
    }
}

/// Takes the samples of this many tenths of a millisecond.
fn sample(cx: &mut Cx, passed: i32) {
    let mut recording = Recording::load(cx);
    let mut since = cx.state().0[1].saturating_add(passed);
    let mut taken = i32::from(cx.special_word(D_SCOPE_TAKEN));
    while since >= recording.period && taken < recording.samples {
        since -= recording.period;
        taken += 1;
        for [words, first] in recording.channels {
            for register in (first..).take(words as usize) {
                let value = u16::try_from(register).map_or(0, |n| cx.special_word(Register(n)));
                // Registers after the user's are not overwritten.
                if let Ok(next @ ..=LAST_REGISTER) = u16::try_from(recording.next) {
                    cx.set_special_word(Register(next), value);
                }
                recording.next += 1;
            }
        }
    }
    recording.keep(cx);
    cx.state().0[1] = since;
    cx.set_special_word(D_SCOPE_TAKEN, taken as i16);
    if taken >= recording.samples {
        cx.set_special_word(D_SCOPE_STATE, DONE);
    }
}

impl Recording {
    /// Puts it into the memory, where no time has passed since the last sample.
    fn keep(self, cx: &mut Cx) {
        let [[words_a, first_a], [words_b, first_b]] = self.channels;
        let both = |a: i32, b: i32| a << 16 | b & 0xffff;
        let state = cx.state();
        state.0[1..].copy_from_slice(&[
            0,
            self.period,
            self.samples,
            self.next,
            both(words_a, words_b),
            both(first_a, first_b),
            0,
        ]);
    }

    fn load(cx: &mut Cx) -> Self {
        let [_, _, period, samples, next, words, first, _] = cx.state().0;
        let low = |pair: i32| i32::from(pair as i16);
        Recording {
            period: period.max(1),
            samples,
            next,
            channels: [[words >> 16, first >> 16], [low(words), low(first)]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::double::{Double, reg};
    use crate::{Operand, RtFn};

    fn run(plc: &mut Double, ms: core::ops::RangeInclusive<i32>) {
        for now in ms {
            let time = Operand::constant(now);
            plc.call(RtFn::Oscilloscope, &[time, reg(0)]).unwrap();
        }
    }

    /// Ten samples of D100 and the pair D200, every millisecond, from D2000 on.
    fn ready() -> Double {
        let mut plc = Double::new();
        let start = i32::from(START);
        plc.set_d(
            D_SCOPE_MODE.number(),
            &[0, 1, 0, 2, 10, 2000, 2000, 2999, start, 0, 1, 100, 2, 200],
        );
        plc.set_d(100, &[7]);
        plc.set_d(200, &[8, 9]);
        plc
    }

    #[test]
    fn samples_are_words_of_both_channels_in_turn() {
        let mut plc = ready();
        run(&mut plc, 0..=5);
        assert_eq!(plc.d(D_SCOPE_STATE.number(), 2), [SAMPLING, 5]);
        run(&mut plc, 6..=20);
        assert_eq!(plc.d(D_SCOPE_STATE.number(), 2), [DONE, 10]);
        assert_eq!(plc.d(2027, 4), [7, 8, 9, 0]);
    }

    #[test]
    fn a_record_that_does_not_fit_is_refused() {
        let mut plc = ready();
        plc.set_d(D_SCOPE_AREA_LAST.number(), &[2028]);
        run(&mut plc, 0..=1);
        assert_eq!(plc.d(D_SCOPE_STATE.number(), 1), [WRONG]);
        plc.set_d(D_SCOPE_AREA_LAST.number(), &[2029, i32::from(START)]);
        run(&mut plc, 2..=2);
        assert_eq!(plc.d(D_SCOPE_STATE.number(), 1), [SAMPLING]);
    }

    #[test]
    fn ten_samples_a_millisecond() {
        let mut plc = ready();
        plc.set_d(D_SCOPE_PERIOD.number(), &[-1]);
        run(&mut plc, 0..=1);
        assert_eq!(plc.d(D_SCOPE_STATE.number(), 2), [DONE, 10]);
    }
}
