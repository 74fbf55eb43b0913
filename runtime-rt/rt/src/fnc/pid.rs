//! PID control: FNC 88, h1u-h2u-programming §4.3.9, hm-motion-controller §5.4.57. L01S: see [`super::pid_thermal`].
//!
//! S1 target, S2 measured value, S3 parameters and work area, D output. The formulas give the change of the output, so
//! control begins without a jump from whatever D holds.

use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::word;
use core::ops::RangeInclusive;

/// Offsets in S3 that H1U/H2U and FX share with HM.
mod at {
    pub const TS: usize = 0;
    pub const ACT: usize = 1;
    pub const FILTER: usize = 2;
    pub const KP: usize = 3;
    pub const TI: usize = 4;
    pub const KD: usize = 5;
    pub const TD: usize = 6;
    /// Clearing this word starts control anew; [`super::FRESH`] until the first sample.
    pub const STARTED: usize = 7;
    pub const PV1: usize = 8;
    pub const PV2: usize = 10;
    pub const D1: usize = 12;
    pub const MV: usize = 14;
    pub const EV1: usize = 16;
    pub const ELAPSED: usize = 18;
    pub const RAW_PV: usize = 19;
    pub const INPUT_RISE: usize = 20;
    pub const INPUT_FALL: usize = 21;
    pub const OUTPUT_RISE_OR_UPPER: usize = 22;
    pub const OUTPUT_FALL_OR_LOWER: usize = 23;
    pub const ALARMS: usize = 24;
}

/// Bits of ACT.
mod act {
    /// Deviation is target − measured rather than measured − target.
    pub const REVERSE: i16 = 1;
    pub const INPUT_ALARM: i16 = 1 << 1;
    pub const OUTPUT_ALARM: i16 = 1 << 2;
    pub const TUNE: i16 = 1 << 4;
    pub const LIMITS: i16 = 1 << 5;
    pub const TUNE_LIMIT_CYCLE: i16 = 1 << 6;
    /// What takes words after the measured value.
    pub const EXTRAS: i16 = INPUT_ALARM | OUTPUT_ALARM | LIMITS;
}

/// Mark of a controller that has not computed a sample.
const FRESH: i16 = 2;

const OPERAND_S3: usize = 2;
const OPERAND_D: usize = 3;

/// Words of S3.
const WORDS: usize = at::ALARMS + 1;
/// Words of S3 without alarms and limits.
const BASIC_WORDS: usize = at::RAW_PV + 1;

/// A copy of S3, read and written at once.
struct Area([i16; WORDS]);

impl Area {
    fn read(cx: &Cx) -> Result<Area, Fault> {
        cx.words(OPERAND_S3).map(Area)
    }

    /// Reads as many words as the settings use; the others are 0.
    fn read_used(cx: &Cx) -> Result<Area, Fault> {
        if cx.word(OPERAND_S3, at::ACT as i32)? & act::EXTRAS != 0 {
            return Area::read(cx);
        }
        let basic: [i16; BASIC_WORDS] = cx.words(OPERAND_S3)?;
        let mut area = [0; WORDS];
        area[..BASIC_WORDS].copy_from_slice(&basic);
        Ok(Area(area))
    }

    /// Writes the words after the settings.
    fn write(&self, cx: &mut Cx) -> Done {
        cx.set_words(OPERAND_S3, at::STARTED as i32, &self.0[at::STARTED..])
    }

    /// Writes the words after the settings, as far as the settings use them.
    fn write_used(&self, cx: &mut Cx) -> Done {
        let used = match self.0[at::ACT] & act::EXTRAS {
            0 => BASIC_WORDS,
            _ => WORDS,
        };
        let words = &self.0[at::STARTED..used];
        cx.set_words(OPERAND_S3, at::STARTED as i32, words)
    }

    fn float(&self, offset: usize) -> f32 {
        word::float(self.0[offset], self.0[offset + 1])
    }

    fn set_float(&mut self, offset: usize, value: f32) {
        [self.0[offset], self.0[offset + 1]] = word::words(value.to_bits() as i32);
    }
}

/// The settings of S3, in percent and milliseconds.
struct Settings {
    ts: u32,
    act: i16,
    filter: f32,
    kp: f32,
    ti_ms: f32,
    kd: f32,
    td_ms: f32,
}

/// Takes the settings; each that is out of range has a separate error (table of errors of §4.3.9).
fn settings(area: &Area, ti_unit_ms: f32, td_unit_ms: f32, kd_max: i16) -> Result<Settings, Fault> {
    let word = |offset: usize, range: RangeInclusive<i16>, code| {
        let value = area.0[offset];
        if range.contains(&value) {
            Ok(value)
        } else {
            Err(Fault(code))
        }
    };
    Ok(Settings {
        ts: word(at::TS, 1..=i16::MAX, 6730)?.unsigned_abs().into(),
        act: area.0[at::ACT],
        filter: f32::from(word(at::FILTER, 0..=99, 6732)?) / 100.0,
        kp: f32::from(word(at::KP, 0..=i16::MAX, 6733)?) / 100.0,
        ti_ms: f32::from(word(at::TI, 0..=i16::MAX, 6734)?) * ti_unit_ms,
        kd: f32::from(word(at::KD, 0..=kd_max, 6735)?) / 100.0,
        td_ms: f32::from(word(at::TD, 0..=i16::MAX, 6736)?) * td_unit_ms,
    })
}

/// A value held in the range of a word; the first one that had to be held is remembered with its error code.
fn held(value: f32, code: u16, error: &mut Option<Fault>) -> f32 {
    if (-32768.0..=32767.0).contains(&value) {
        return value;
    }
    error.get_or_insert(Fault(code));
    if value.is_nan() {
        0.0
    } else {
        value.clamp(-32768.0, 32767.0)
    }
}

/// PID S1 S2 S3 D of H1U/H2U, whose firmware has no auto-tuning.
pub fn pid(cx: &mut Cx) -> Done {
    let area = Area::read(cx)?;
    control(cx, area, false)
}

/// PID S1 S2 S3 D of FX: as [`pid`], with auto-tuning by step response (ACT bit 4). Tuning by limit cycle (bit 6) is
/// rejected with 6750.
pub fn pid_tuning(cx: &mut Cx) -> Done {
    tune_or_control(cx, false)
}

/// PID S1 S2 S3 D of FX3: as [`pid_tuning`], with 20 words of S3 without alarms and limits (FX3 programming manual
/// 16.7); crossed limits of the output are exchanged and reported with 6748, and a negative alarm value, reported with
/// 6749, gives no alarm (FX analog control manual, PID §6.1).
pub fn pid_checked(cx: &mut Cx) -> Done {
    tune_or_control(cx, true)
}

fn tune_or_control(cx: &mut Cx, checked: bool) -> Done {
    let area = if checked {
        Area::read_used(cx)?
    } else {
        Area::read(cx)?
    };
    let action = area.0[at::ACT];
    if action & act::TUNE_LIMIT_CYCLE != 0 {
        return Err(Fault(6750));
    }
    if action & act::TUNE != 0 {
        tune(cx, area)
    } else {
        control(cx, area, checked)
    }
}

/// Adds the time since the last scan, once in a scan, or the period of the timer interrupt; returns the time that the
/// sample stands for, if one is due. A sampling time not above this time is error 6740, and each time is a sample then.
fn sample_due(cx: &mut Cx, area: &mut Area, ts: u32, error: &mut Option<Fault>) -> Option<f32> {
    let dt = cx.sampled_ms().unsigned_abs();
    if dt > 0 && ts <= dt {
        error.get_or_insert(Fault(6740));
        return Some(dt as f32);
    }
    let elapsed = u32::from(area.0[at::ELAPSED] as u16).saturating_add(dt);
    let due = elapsed >= ts;
    let rest = if due {
        (elapsed - ts).min(ts - 1)
    } else {
        elapsed
    };
    area.0[at::ELAPSED] = rest.min(u32::from(u16::MAX)) as u16 as i16;
    due.then_some(ts as f32)
}

/// One execution; `checked` reports crossed limits and negative alarm values.
fn control(cx: &mut Cx, mut area: Area, checked: bool) -> Done {
    let s = settings(&area, 100.0, 10.0, 200)?;
    let mut error = checked.then(|| area.contradiction(&s)).flatten();
    if area.0[at::STARTED] == 0 {
        start(cx, area, &s, checked)?;
        return error.map_or(Ok(()), Err);
    }
    let (target, measured) = (cx.word(0, 0)?, cx.word(1, 0)?);
    let Some(ts) = sample_due(cx, &mut area, s.ts, &mut error) else {
        cx.set_word(OPERAND_S3, at::ELAPSED as i32, area.0[at::ELAPSED])?;
        return error.map_or(Ok(()), Err);
    };
    if area.0[at::STARTED] == FRESH {
        area.0[at::STARTED] = 1;
        area.set_float(at::MV, cx.word(OPERAND_D, 0)?.into());
    }
    let raw = f32::from(measured);
    let pv1 = area.float(at::PV1);
    let pv = raw + s.filter * (pv1 - raw);
    held(pv - pv1, 6742, &mut error);
    let deviation = held(deviation(&s, target.into(), pv), 6743, &mut error);
    let integral = if s.ti_ms > 0.0 {
        held(ts / s.ti_ms * deviation, 6744, &mut error)
    } else {
        0.0
    };
    let derivative = derivative(&area, &s, ts, pv, &mut error);
    let change = s.kp * (deviation - area.float(at::EV1) + integral + derivative);
    let mut mv = held(area.float(at::MV) + change, 6747, &mut error);
    if s.act & act::LIMITS != 0 {
        let mut upper = f32::from(area.0[at::OUTPUT_RISE_OR_UPPER]);
        let mut lower = f32::from(area.0[at::OUTPUT_FALL_OR_LOWER]);
        if checked && upper < lower {
            core::mem::swap(&mut upper, &mut lower);
        }
        mv = mv.min(upper).max(lower);
    }
    if !checked || !area.has_negative_alarm(&s) {
        area.set_alarms(&s, raw, mv);
    }
    area.store([pv, pv1, derivative, mv, deviation]);
    area.0[at::RAW_PV] = measured;
    area.write_used(cx)?;
    cx.set_word(OPERAND_D, 0, libm::roundf(mv) as i16)?;
    error.map_or(Ok(()), Err)
}

/// The deviation whose sign ACT chooses. The prose calls heating forward, the formulas and the examples of errors
/// measure forward as measured − target: the formulas are taken.
fn deviation(s: &Settings, target: f32, pv: f32) -> f32 {
    if s.act & act::REVERSE != 0 {
        target - pv
    } else {
        pv - target
    }
}

fn derivative(area: &Area, s: &Settings, ts: f32, pv: f32, error: &mut Option<Fault>) -> f32 {
    if s.td_ms <= 0.0 {
        return 0.0;
    }
    let filtered = s.kd * s.td_ms;
    let curve = pv - 2.0 * area.float(at::PV1) + area.float(at::PV2);
    let curve = if s.act & act::REVERSE != 0 {
        -curve
    } else {
        curve
    };
    let fresh = held(s.td_ms / (ts + filtered) * curve, 6745, error);
    held(
        fresh + filtered / (ts + filtered) * area.float(at::D1),
        6746,
        error,
    )
}

/// First execution: takes the measured value and D over, so that the output begins where it is. On FX3 (`from_zero`),
/// the memory of a controller is cleared: its first sample answers to the whole deviation.
fn start(cx: &mut Cx, mut area: Area, s: &Settings, from_zero: bool) -> Done {
    let measured = cx.word(1, 0)?;
    let raw = f32::from(measured);
    area.store([raw, raw, 0.0, 0.0, 0.0]);
    if !from_zero {
        let (target, mv) = (cx.word(0, 0)?, cx.word(OPERAND_D, 0)?);
        area.set_float(at::MV, mv.into());
        area.set_float(at::EV1, deviation(s, target.into(), raw));
    }
    area.0[at::RAW_PV] = measured;
    area.0[at::ELAPSED] = 0;
    area.0[at::STARTED] = if from_zero { FRESH } else { 1 };
    area.write_used(cx)
}

impl Area {
    /// Keeps what the next sample needs: PV, the one before, the derivative, MV, the deviation.
    fn store(&mut self, values: [f32; 5]) {
        let offsets = [at::PV1, at::PV2, at::D1, at::MV, at::EV1];
        for (offset, value) in offsets.into_iter().zip(values) {
            self.set_float(offset, value);
        }
    }

    /// Error of limits that are crossed, or of negative alarm values.
    fn contradiction(&self, s: &Settings) -> Option<Fault> {
        let crossed = self.0[at::OUTPUT_RISE_OR_UPPER] < self.0[at::OUTPUT_FALL_OR_LOWER];
        if s.act & act::LIMITS != 0 && crossed {
            return Some(Fault(6748));
        }
        self.has_negative_alarm(s).then_some(Fault(6749))
    }

    /// Returns true if an alarm is on whose value is negative.
    fn has_negative_alarm(&self, s: &Settings) -> bool {
        let input = s.act & act::INPUT_ALARM != 0;
        let output = s.act & act::OUTPUT_ALARM != 0 && s.act & act::LIMITS == 0;
        let negative = |places: [usize; 2]| places.iter().any(|&at| self.0[at] < 0);
        input && negative([at::INPUT_RISE, at::INPUT_FALL])
            || output && negative([at::OUTPUT_RISE_OR_UPPER, at::OUTPUT_FALL_OR_LOWER])
    }

    /// Alarm bits: 0 and 1 for the measured value rising or falling by more than its limit in a sample, 2 and 3 for the
    /// output.
    fn set_alarms(&mut self, s: &Settings, measured: f32, mv: f32) {
        let mut bits = 0;
        let over = |change: f32, rise: usize, fall: usize| {
            let (rise, fall) = (f32::from(self.0[rise]), f32::from(self.0[fall]));
            i16::from(change > rise) | i16::from(-change > fall) << 1
        };
        if s.act & act::INPUT_ALARM != 0 {
            let change = measured - f32::from(self.0[at::RAW_PV]);
            bits |= over(change, at::INPUT_RISE, at::INPUT_FALL);
        }
        if s.act & act::OUTPUT_ALARM != 0 && s.act & act::LIMITS == 0 {
            let change = mv - self.float(at::MV);
            bits |= over(change, at::OUTPUT_RISE_OR_UPPER, at::OUTPUT_FALL_OR_LOWER) << 2;
        }
        if s.act & (act::INPUT_ALARM | act::OUTPUT_ALARM) != 0 {
            self.0[at::ALARMS] = bits;
        }
    }
}

/// Offsets of the work area while tuning, in place of those of control.
mod tuning_at {
    /// Measured value at the start.
    pub const PV0: usize = 8;
    /// Time since the start in milliseconds.
    pub const TIME: usize = 10;
    /// Steepest slope so far, per millisecond.
    pub const SLOPE: usize = 12;
    /// Time from the start to the intersection of the steepest tangent with the start value, in milliseconds.
    pub const DELAY: usize = 14;
}

/// Least distance from the target at which tuning may begin.
pub(crate) const TUNE_MIN_DISTANCE: f32 = 150.0;

/// Gains that a step response gives: of its steepest slope R (per millisecond) and its dead time L, Kp = 1.2 / (R L) of
/// the step, Ti = 2 L, Td = L / 2.
pub(crate) struct Tuned {
    pub(crate) kp: f32,
    pub(crate) ti_ms: f32,
    pub(crate) td_ms: f32,
}

impl Tuned {
    pub(crate) fn new(step: f32, slope: f32, delay_ms: f32) -> Self {
        let delay_ms = delay_ms.max(1.0);
        Tuned {
            kp: 1.2 / (slope * delay_ms) * step,
            ti_ms: 2.0 * delay_ms,
            td_ms: 0.5 * delay_ms,
        }
    }
}

/// A setting that a word of the work area can hold.
pub(crate) fn setting(value: f32) -> i16 {
    libm::roundf(value).clamp(1.0, 32767.0) as i16
}

/// Auto-tuning by step response: D stays at the step that the program has put there. When the measured value has gone a
/// third of the way to the target, the steepest slope R and the dead time L give Kp = 1.2 / (R L) of the step, Ti = 2
/// L, Td = L / 2; ACT bit 4 goes off and control begins.
fn tune(cx: &mut Cx, mut area: Area) -> Done {
    let ts = area.0[at::TS];
    if ts <= 0 {
        return Err(Fault(6730));
    }
    let target = f32::from(cx.word(0, 0)?);
    let raw = cx.word(1, 0)?;
    let measured = f32::from(raw);
    if area.0[at::STARTED] == 0 {
        if libm::fabsf(target - measured) < TUNE_MIN_DISTANCE {
            return Err(Fault(6750));
        }
        for offset in [tuning_at::TIME, tuning_at::SLOPE, tuning_at::DELAY] {
            area.set_float(offset, 0.0);
        }
        area.set_float(tuning_at::PV0, measured);
        area.0[at::RAW_PV] = raw;
        area.0[at::ELAPSED] = 0;
        area.0[at::STARTED] = 1;
        return area.write_used(cx);
    }
    let mut error = None;
    let due = sample_due(cx, &mut area, ts.unsigned_abs().into(), &mut error);
    let Some(step_ms) = due else {
        return area.write_used(cx);
    };
    let start = area.float(tuning_at::PV0);
    let time = area.float(tuning_at::TIME) + step_ms;
    area.set_float(tuning_at::TIME, time);
    let towards = if target > start { 1.0 } else { -1.0 };
    let gone = (measured - start) * towards;
    let slope = (measured - f32::from(area.0[at::RAW_PV])) * towards / step_ms;
    area.0[at::RAW_PV] = raw;
    if slope > area.float(tuning_at::SLOPE) {
        area.set_float(tuning_at::SLOPE, slope);
        area.set_float(tuning_at::DELAY, time - gone / slope);
    }
    area.write_used(cx)?;
    if gone < -TUNE_MIN_DISTANCE {
        return Err(Fault(6751));
    }
    if gone * 3.0 >= libm::fabsf(target - start) {
        return finish_tuning(cx, &area);
    }
    error.map_or(Ok(()), Err)
}

fn finish_tuning(cx: &mut Cx, area: &Area) -> Done {
    let step = libm::fabsf(f32::from(cx.word(OPERAND_D, 0)?));
    let tuned = Tuned::new(
        step,
        area.float(tuning_at::SLOPE),
        area.float(tuning_at::DELAY),
    );
    for (offset, value) in [
        (at::KP, setting(tuned.kp * 100.0)),
        (at::TI, setting(tuned.ti_ms / 100.0)),
        (at::TD, setting(tuned.td_ms / 10.0)),
        (at::ACT, area.0[at::ACT] & !act::TUNE),
        (at::STARTED, 0),
    ] {
        cx.set_word(OPERAND_S3, offset as i32, value)?;
    }
    Ok(())
}

/// Offsets of HM's work area; its settings are where FX has them.
mod hm_at {
    pub const DEVIATION: usize = 7;
    pub const CHANGE: usize = 9;
    pub const CURVE: usize = 11;
    pub const PV: usize = 13;
    pub const DERIVATIVE: usize = 15;
    pub const INCREMENT: usize = 17;
    pub const OUTPUT: usize = 19;
    pub const UPPER_ALARM: usize = 20;
    pub const LOWER_ALARM: usize = 21;
    pub const UPPER_LIMIT: usize = 22;
    pub const LOWER_LIMIT: usize = 23;
    pub const ALARMS: usize = 24;
}

/// PID S1 S2 S3 D of HM: one computation per execution; the program calls it once per sampling time. Times are in
/// milliseconds, direction 1 (the recommended one) raises the output while the measured value is below the target.
pub fn pid_hm(cx: &mut Cx) -> Done {
    let mut area = Area::read(cx)?;
    let s = settings(&area, 1.0, 1.0, i16::MAX)?;
    let target = f32::from(cx.word(0, 0)?);
    let measured = f32::from(cx.word(1, 0)?);
    let before = area.float(hm_at::DEVIATION);
    let pv = if before == 0.0 {
        measured
    } else {
        measured + s.filter * (area.float(hm_at::PV) - measured)
    };
    let deviation = if s.act & 1 != 0 {
        target - pv
    } else {
        pv - target
    };
    let change = deviation - before;
    let curve = change - area.float(hm_at::CHANGE);
    let ts = s.ts as f32;
    let integral = if s.ti_ms > 0.0 {
        ts / s.ti_ms * deviation
    } else {
        0.0
    };
    let filtered = s.kd * s.td_ms;
    let derivative = if s.td_ms > 0.0 && s.kd > 0.0 {
        (s.td_ms * curve + filtered * area.float(hm_at::DERIVATIVE)) / (ts + filtered)
    } else {
        0.0
    };
    let increment = s.kp * (change + integral + derivative);
    let wanted = f32::from(area.0[hm_at::OUTPUT]) + increment;
    let limit = |offset: usize| f32::from(area.0[offset]);
    let (upper, lower) = (limit(hm_at::UPPER_LIMIT), limit(hm_at::LOWER_LIMIT));
    let output = wanted.min(upper).max(lower).clamp(-32768.0, 32767.0);
    let alarms = i16::from(output >= limit(hm_at::UPPER_ALARM))
        | i16::from(output <= limit(hm_at::LOWER_ALARM)) << 1
        | i16::from(wanted >= upper) << 2
        | i16::from(wanted <= lower) << 3;
    for (offset, value) in [
        (hm_at::DEVIATION, deviation),
        (hm_at::CHANGE, change),
        (hm_at::CURVE, curve),
        (hm_at::PV, pv),
        (hm_at::DERIVATIVE, derivative),
        (hm_at::INCREMENT, increment),
    ] {
        area.set_float(offset, value);
    }
    let output = libm::roundf(output) as i16;
    area.0[hm_at::ALARMS] = alarms;
    area.0[hm_at::OUTPUT] = output;
    area.write(cx)?;
    cx.set_word(OPERAND_D, 0, output)
}

#[cfg(test)]
mod tests {
    use crate::double::Double;
    use crate::{Class, Fault, Operand, RtFn, d};

    fn ops() -> [Operand; 4] {
        [0, 1, 200, 130].map(|n| d(Class::D, n))
    }

    fn run(plc: &mut Double, function: RtFn, scans: u32) -> Result<(), Fault> {
        (0..scans).try_for_each(|_| plc.scan(10, true, function, &ops()))
    }

    #[test]
    fn proportional_action_follows_the_change_of_the_deviation() {
        let mut plc = Double::new()
            .with_d(0, &[500, 500])
            .with_d(200, &[100, 1, 0, 200]);
        run(&mut plc, RtFn::Pid, 30).unwrap();
        assert_eq!(plc.d(130, 1), [0]);
        plc.set_d(1, &[450]);
        run(&mut plc, RtFn::Pid, 30).unwrap();
        assert_eq!(plc.d(130, 1), [100]);
    }

    #[test]
    fn integral_action_ramps_and_stops_at_the_limits() {
        let settings = [100, 1 | 1 << 5, 0, 100, 10];
        let mut plc = Double::new()
            .with_d(0, &[100, 0])
            .with_d(200, &settings)
            .with_d(222, &[300, 0]);
        run(&mut plc, RtFn::Pid, 101).unwrap();
        assert_eq!(plc.d(130, 1), [100]);
        run(&mut plc, RtFn::Pid, 1000).unwrap();
        assert_eq!(plc.d(130, 1), [300]);
    }

    #[test]
    fn settings_out_of_range_have_their_codes() {
        for (offset, value, code) in [
            (0, 0, 6730),
            (2, 100, 6732),
            (3, -1, 6733),
            (4, -1, 6734),
            (5, 201, 6735),
            (6, -1, 6736),
        ] {
            let mut plc = Double::new().with_d(200, &[100, 1, 0, 100]);
            plc.set_d(200 + offset, &[value]);
            assert_eq!(
                run(&mut plc, RtFn::Pid, 1),
                Err(Fault(code)),
                "S3+{offset} = {value}"
            );
        }
    }

    #[test]
    fn tuning_by_step_response_sets_the_gains() {
        // A ramp of 1 per 10 ms after a dead time of 1 s, with an output step of 100.
        let mut plc = Double::new()
            .with_d(0, &[1000, 0])
            .with_d(200, &[100, 1 | 1 << 4])
            .with_d(130, &[100]);
        for scan in 0..450 {
            plc.set_d(1, &[(scan - 100).max(0)]);
            run(&mut plc, RtFn::PidTuning, 1).unwrap();
        }
        let [act, _, kp, ti, _, td] = plc.d(201, 6)[..] else {
            unreachable!()
        };
        assert_eq!(act, 1);
        // R = 0.1 per ms, L = 1000 ms: Kp = 1.2 / 100 * 100 = 120 %, Ti = 2 s, Td = 0.5 s.
        assert!((110..=130).contains(&kp), "{kp}");
        assert!((18..=21).contains(&ti), "{ti}");
        assert!((45..=52).contains(&td), "{td}");
        assert_eq!(plc.d(130, 1), [100]);
    }

    #[test]
    fn hm_computes_once_per_execution() {
        let mut plc = Double::new()
            .with_d(0, &[100, 0])
            .with_d(200, &[100, 1, 0, 100, 1000]);
        plc.set_d(220, &[20000, 0, 10000, 0]);
        run(&mut plc, RtFn::PidHm, 1).unwrap();
        assert_eq!(plc.d(130, 1), [110]);
        run(&mut plc, RtFn::PidHm, 1).unwrap();
        assert_eq!(plc.d(130, 1), [120]);
    }
}
