//! PID control: FNC 88, h1u-h2u-programming §4.3.9, hm-motion-controller §5.4.57. L01S: see [`super::pid_thermal`].
//!
//! S1 target, S2 measured value, S3 parameters and work area, D output. The formulas give the change of the output, so
//! control begins without a jump from whatever D holds.

use crate::cx::Cx;
use crate::fault::{Done, Fault};

/// Offsets in S3 that H1U/H2U and FX share with HM.
mod at {
    pub const TS: i32 = 0;
    pub const ACT: i32 = 1;
    pub const FILTER: i32 = 2;
    pub const KP: i32 = 3;
    pub const TI: i32 = 4;
    pub const KD: i32 = 5;
    pub const TD: i32 = 6;
    /// Clearing this word starts control anew.
    pub const STARTED: i32 = 7;
    pub const PV1: i32 = 8;
    pub const PV2: i32 = 10;
    pub const D1: i32 = 12;
    pub const MV: i32 = 14;
    pub const EV1: i32 = 16;
    pub const ELAPSED: i32 = 18;
    pub const RAW_PV: i32 = 19;
    pub const INPUT_RISE: i32 = 20;
    pub const INPUT_FALL: i32 = 21;
    pub const OUTPUT_RISE_OR_UPPER: i32 = 22;
    pub const OUTPUT_FALL_OR_LOWER: i32 = 23;
    pub const ALARMS: i32 = 24;
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
}

const OPERAND_S3: usize = 2;
const OPERAND_D: usize = 3;

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

/// Reads the settings; each that is out of range has a separate error (table of errors of §4.3.9).
fn settings(cx: &Cx, ti_unit_ms: f32, td_unit_ms: f32, kd_max: i16) -> Result<Settings, Fault> {
    let word = |offset, range: core::ops::RangeInclusive<i16>, code| {
        let value = cx.word(OPERAND_S3, offset)?;
        if range.contains(&value) {
            Ok(value)
        } else {
            Err(Fault(code))
        }
    };
    Ok(Settings {
        ts: word(at::TS, 1..=i16::MAX, 6730)?.unsigned_abs().into(),
        act: cx.word(OPERAND_S3, at::ACT)?,
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
    control(cx)
}

/// PID S1 S2 S3 D of FX: as [`pid`], with auto-tuning by step response (ACT bit 4). Tuning by limit cycle (bit 6) is
/// rejected with 6750.
pub fn pid_tuning(cx: &mut Cx) -> Done {
    let action = cx.word(OPERAND_S3, at::ACT)?;
    if action & act::TUNE_LIMIT_CYCLE != 0 {
        return Err(Fault(6750));
    }
    if action & act::TUNE != 0 {
        tune(cx)
    } else {
        control(cx)
    }
}

/// Adds the time since the last scan; returns whether a sample is due. A sampling time not above the scan time is error
/// 6740, and each scan is a sample then.
fn sample_due(cx: &mut Cx, ts: u32, error: &mut Option<Fault>) -> Result<Option<f32>, Fault> {
    let dt = cx.plc.sys().dt_ms;
    if dt > 0 && ts <= dt {
        error.get_or_insert(Fault(6740));
        return Ok(Some(dt as f32));
    }
    let elapsed = u32::from(cx.word(OPERAND_S3, at::ELAPSED)? as u16).saturating_add(dt);
    let due = elapsed >= ts;
    let rest = if due {
        (elapsed - ts).min(ts - 1)
    } else {
        elapsed
    };
    cx.set_word(
        OPERAND_S3,
        at::ELAPSED,
        rest.min(u32::from(u16::MAX)) as u16 as i16,
    )?;
    Ok(due.then_some(ts as f32))
}

fn control(cx: &mut Cx) -> Done {
    let s = settings(cx, 100.0, 10.0, 200)?;
    cx.check_words(OPERAND_S3, at::ALARMS + 1)?;
    let target = f32::from(cx.word(0, 0)?);
    let measured = f32::from(cx.word(1, 0)?);
    if cx.word(OPERAND_S3, at::STARTED)? == 0 {
        return start(cx, &s, target, measured);
    }
    let mut error = None;
    let Some(ts) = sample_due(cx, s.ts, &mut error)? else {
        return Ok(());
    };
    let pv1 = cx.float(OPERAND_S3, at::PV1)?;
    let pv2 = cx.float(OPERAND_S3, at::PV2)?;
    let pv = measured + s.filter * (pv1 - measured);
    held(pv - pv1, 6742, &mut error);
    let deviation = held(deviation(&s, target, pv), 6743, &mut error);
    let integral = if s.ti_ms > 0.0 {
        held(ts / s.ti_ms * deviation, 6744, &mut error)
    } else {
        0.0
    };
    let derivative = derivative(cx, &s, ts, pv, pv1, pv2, &mut error)?;
    let change = s.kp * (deviation - cx.float(OPERAND_S3, at::EV1)? + integral + derivative);
    let mut mv = held(cx.float(OPERAND_S3, at::MV)? + change, 6747, &mut error);
    if s.act & act::LIMITS != 0 {
        let upper = f32::from(cx.word(OPERAND_S3, at::OUTPUT_RISE_OR_UPPER)?);
        let lower = f32::from(cx.word(OPERAND_S3, at::OUTPUT_FALL_OR_LOWER)?);
        mv = mv.min(upper).max(lower);
    }
    alarms(cx, &s, measured, mv)?;
    store(cx, pv, pv1, derivative, deviation, mv)?;
    cx.set_word(OPERAND_S3, at::RAW_PV, measured as i16)?;
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

fn derivative(
    cx: &Cx,
    s: &Settings,
    ts: f32,
    pv: f32,
    pv1: f32,
    pv2: f32,
    error: &mut Option<Fault>,
) -> Result<f32, Fault> {
    if s.td_ms <= 0.0 {
        return Ok(0.0);
    }
    let filtered = s.kd * s.td_ms;
    let curve = pv - 2.0 * pv1 + pv2;
    let curve = if s.act & act::REVERSE != 0 {
        -curve
    } else {
        curve
    };
    let fresh = held(s.td_ms / (ts + filtered) * curve, 6745, error);
    Ok(held(
        fresh + filtered / (ts + filtered) * cx.float(OPERAND_S3, at::D1)?,
        6746,
        error,
    ))
}

/// First execution: takes the measured value and D over, so that the output begins where it is.
fn start(cx: &mut Cx, s: &Settings, target: f32, measured: f32) -> Done {
    let mv = f32::from(cx.word(OPERAND_D, 0)?);
    store(
        cx,
        measured,
        measured,
        0.0,
        deviation(s, target, measured),
        mv,
    )?;
    cx.set_word(OPERAND_S3, at::RAW_PV, measured as i16)?;
    cx.set_word(OPERAND_S3, at::ELAPSED, 0)?;
    cx.set_word(OPERAND_S3, at::STARTED, 1)
}

fn store(cx: &mut Cx, pv: f32, pv1: f32, derivative: f32, deviation: f32, mv: f32) -> Done {
    cx.set_float(OPERAND_S3, at::PV1, pv)?;
    cx.set_float(OPERAND_S3, at::PV2, pv1)?;
    cx.set_float(OPERAND_S3, at::D1, derivative)?;
    cx.set_float(OPERAND_S3, at::EV1, deviation)?;
    cx.set_float(OPERAND_S3, at::MV, mv)
}

/// Alarm bits: 0 and 1 for the measured value rising or falling by more than its limit in a sample, 2 and 3 for the
/// output.
fn alarms(cx: &mut Cx, s: &Settings, measured: f32, mv: f32) -> Done {
    let mut bits = 0;
    let over = |cx: &Cx, change: f32, rise, fall| -> Result<i16, Fault> {
        let (rise, fall) = (
            f32::from(cx.word(OPERAND_S3, rise)?),
            f32::from(cx.word(OPERAND_S3, fall)?),
        );
        Ok(i16::from(change > rise) | i16::from(-change > fall) << 1)
    };
    if s.act & act::INPUT_ALARM != 0 {
        let change = measured - f32::from(cx.word(OPERAND_S3, at::RAW_PV)?);
        bits |= over(cx, change, at::INPUT_RISE, at::INPUT_FALL)?;
    }
    if s.act & act::OUTPUT_ALARM != 0 && s.act & act::LIMITS == 0 {
        let change = mv - cx.float(OPERAND_S3, at::MV)?;
        bits |= over(
            cx,
            change,
            at::OUTPUT_RISE_OR_UPPER,
            at::OUTPUT_FALL_OR_LOWER,
        )? << 2;
    }
    if s.act & (act::INPUT_ALARM | act::OUTPUT_ALARM) != 0 {
        cx.set_word(OPERAND_S3, at::ALARMS, bits)?;
    }
    Ok(())
}

/// Offsets of the work area while tuning, in place of those of control.
mod tuning_at {
    /// Measured value at the start.
    pub const PV0: i32 = 8;
    /// Time since the start in milliseconds.
    pub const TIME: i32 = 10;
    /// Steepest slope so far, per millisecond.
    pub const SLOPE: i32 = 12;
    /// Where the steepest tangent leaves the start value, in milliseconds.
    pub const DELAY: i32 = 14;
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
fn tune(cx: &mut Cx) -> Done {
    let ts = cx.word(OPERAND_S3, at::TS)?;
    if ts <= 0 {
        return Err(Fault(6730));
    }
    cx.check_words(OPERAND_S3, at::ALARMS + 1)?;
    let target = f32::from(cx.word(0, 0)?);
    let measured = f32::from(cx.word(1, 0)?);
    if cx.word(OPERAND_S3, at::STARTED)? == 0 {
        if libm::fabsf(target - measured) <= TUNE_MIN_DISTANCE {
            return Err(Fault(6750));
        }
        for offset in [tuning_at::TIME, tuning_at::SLOPE, tuning_at::DELAY] {
            cx.set_float(OPERAND_S3, offset, 0.0)?;
        }
        cx.set_float(OPERAND_S3, tuning_at::PV0, measured)?;
        cx.set_word(OPERAND_S3, at::RAW_PV, measured as i16)?;
        cx.set_word(OPERAND_S3, at::ELAPSED, 0)?;
        return cx.set_word(OPERAND_S3, at::STARTED, 1);
    }
    let mut error = None;
    let Some(step_ms) = sample_due(cx, ts.unsigned_abs().into(), &mut error)? else {
        return Ok(());
    };
    let start = cx.float(OPERAND_S3, tuning_at::PV0)?;
    let time = cx.float(OPERAND_S3, tuning_at::TIME)? + step_ms;
    cx.set_float(OPERAND_S3, tuning_at::TIME, time)?;
    let towards = if target > start { 1.0 } else { -1.0 };
    let gone = (measured - start) * towards;
    let slope = (measured - f32::from(cx.word(OPERAND_S3, at::RAW_PV)?)) * towards / step_ms;
    cx.set_word(OPERAND_S3, at::RAW_PV, measured as i16)?;
    if slope > cx.float(OPERAND_S3, tuning_at::SLOPE)? {
        cx.set_float(OPERAND_S3, tuning_at::SLOPE, slope)?;
        cx.set_float(OPERAND_S3, tuning_at::DELAY, time - gone / slope)?;
    }
    if gone < -TUNE_MIN_DISTANCE {
        return Err(Fault(6751));
    }
    if gone * 3.0 >= libm::fabsf(target - start) {
        return finish_tuning(cx);
    }
    error.map_or(Ok(()), Err)
}

fn finish_tuning(cx: &mut Cx) -> Done {
    let step = libm::fabsf(f32::from(cx.word(OPERAND_D, 0)?));
    let slope = cx.float(OPERAND_S3, tuning_at::SLOPE)?;
    let tuned = Tuned::new(step, slope, cx.float(OPERAND_S3, tuning_at::DELAY)?);
    let action = cx.word(OPERAND_S3, at::ACT)?;
    cx.set_word(OPERAND_S3, at::KP, setting(tuned.kp * 100.0))?;
    cx.set_word(OPERAND_S3, at::TI, setting(tuned.ti_ms / 100.0))?;
    cx.set_word(OPERAND_S3, at::TD, setting(tuned.td_ms / 10.0))?;
    cx.set_word(OPERAND_S3, at::ACT, action & !act::TUNE)?;
    cx.set_word(OPERAND_S3, at::STARTED, 0)
}

/// Offsets of HM's work area; its settings are where FX has them.
mod hm_at {
    pub const DEVIATION: i32 = 7;
    pub const CHANGE: i32 = 9;
    pub const CURVE: i32 = 11;
    pub const PV: i32 = 13;
    pub const DERIVATIVE: i32 = 15;
    pub const INCREMENT: i32 = 17;
    pub const OUTPUT: i32 = 19;
    pub const UPPER_ALARM: i32 = 20;
    pub const LOWER_ALARM: i32 = 21;
    pub const UPPER_LIMIT: i32 = 22;
    pub const LOWER_LIMIT: i32 = 23;
    pub const ALARMS: i32 = 24;
}

/// PID S1 S2 S3 D of HM: one computation per execution; the program calls it once per sampling time. Times are in
/// milliseconds, direction 1 (the recommended one) raises the output while the measured value is below the target.
pub fn pid_hm(cx: &mut Cx) -> Done {
    let s = settings(cx, 1.0, 1.0, i16::MAX)?;
    cx.check_words(OPERAND_S3, hm_at::ALARMS + 1)?;
    let target = f32::from(cx.word(0, 0)?);
    let measured = f32::from(cx.word(1, 0)?);
    let before = cx.float(OPERAND_S3, hm_at::DEVIATION)?;
    let pv = if before == 0.0 {
        measured
    } else {
        measured + s.filter * (cx.float(OPERAND_S3, hm_at::PV)? - measured)
    };
    let deviation = if s.act & 1 != 0 {
        target - pv
    } else {
        pv - target
    };
    let change = deviation - before;
    let curve = change - cx.float(OPERAND_S3, hm_at::CHANGE)?;
    let ts = s.ts as f32;
    let integral = if s.ti_ms > 0.0 {
        ts / s.ti_ms * deviation
    } else {
        0.0
    };
    let filtered = s.kd * s.td_ms;
    let derivative = if s.td_ms > 0.0 && s.kd > 0.0 {
        (s.td_ms * curve + filtered * cx.float(OPERAND_S3, hm_at::DERIVATIVE)?) / (ts + filtered)
    } else {
        0.0
    };
    let increment = s.kp * (change + integral + derivative);
    let wanted = f32::from(cx.word(OPERAND_S3, hm_at::OUTPUT)?) + increment;
    let limit = |cx: &Cx, offset| cx.word(OPERAND_S3, offset).map(f32::from);
    let (upper, lower) = (
        limit(cx, hm_at::UPPER_LIMIT)?,
        limit(cx, hm_at::LOWER_LIMIT)?,
    );
    let output = wanted.min(upper).max(lower).clamp(-32768.0, 32767.0);
    let alarms = i16::from(output >= limit(cx, hm_at::UPPER_ALARM)?)
        | i16::from(output <= limit(cx, hm_at::LOWER_ALARM)?) << 1
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
        cx.set_float(OPERAND_S3, offset, value)?;
    }
    cx.set_word(OPERAND_S3, hm_at::ALARMS, alarms)?;
    cx.set_word(OPERAND_S3, hm_at::OUTPUT, libm::roundf(output) as i16)?;
    cx.set_word(OPERAND_D, 0, libm::roundf(output) as i16)
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
