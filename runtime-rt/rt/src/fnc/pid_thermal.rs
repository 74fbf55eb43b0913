//! PID of L01S, made for temperatures: l01s-programming §4.3.1. Learns its gains from an oscillation around the target
//! and controls in bands. The manual names the parameters and what each band does, but prints no formula: the classic
//! ones are taken.

use crate::cx::Cx;
use crate::fault::{Done, Fault};

const S3: usize = 2;
const OUTPUT: usize = 3;

/// Offsets in S3, in words. (The manual's list of steps counts bytes: its "S3+48" is word 24.)
mod at {
    pub const TS: i32 = 0;
    pub const ACT: i32 = 1;
    pub const FILTER: i32 = 2;
    pub const P: i32 = 3;
    pub const I: i32 = 5;
    pub const D: i32 = 7;
    pub const STATE: i32 = 9;
    pub const COOLING: i32 = 10;
    pub const CROSSINGS: i32 = 11;
    pub const STEADY: i32 = 12;
    pub const ABOVE: i32 = 13;
    pub const BELOW: i32 = 15;
    pub const ERROR: i32 = 18;
    pub const HEAT: i32 = 19;
    pub const PEAK: i32 = 20;
    pub const VALLEY: i32 = 22;
    pub const LARGE_BAND: i32 = 24;
    pub const SMALL_BAND: i32 = 25;
    pub const FINE_BAND: i32 = 26;
    pub const COOLING_FACTOR: i32 = 27;
    pub const FULL_POWER: i32 = 28;
    pub const SUPPRESSION: i32 = 29;
    pub const SAME_AMPLITUDE: i32 = 31;
    pub const INITIAL_POWER: i32 = 32;
    pub const CONTROL_P: i32 = 35;
    pub const CONTROL_I: i32 = 37;
    pub const CONTROL_D: i32 = 39;
    pub const KU: i32 = 41;
    /// One past the last word.
    pub const END: i32 = 43;
}

/// Values of the state word.
mod state {
    pub const LEARNING: i16 = 2;
    pub const CONTROLLING: i16 = 4;
}

/// ACT: the table calls bit 3 the learning bit, the list of steps writes 16 (bit 4); both are taken.
const LEARN: i16 = 1 << 3 | 1 << 4;

/// Layout of the instruction's private memory: time since the last sample, the period's start, sum of the integral,
/// filtered value and last deviation.
mod memory {
    pub const ELAPSED: usize = 0;
    pub const PERIOD: usize = 1;
    pub const INTEGRAL: usize = 2;
    pub const MEASURED: usize = 3;
    pub const LAST: usize = 4;
    pub const AMPLITUDE: usize = 5;
}

fn load(cx: &mut Cx, i: usize) -> f32 {
    f32::from_bits(cx.state().0.get(i).copied().unwrap_or(0) as u32)
}

fn store(cx: &mut Cx, i: usize, value: f32) {
    if let Some(word) = cx.state().0.get_mut(i) {
        *word = value.to_bits() as i32;
    }
}

/// PID S1 S2 S3 D: every S3 milliseconds one step of learning (ACT 16) or control (ACT 0); D is the heating power 0 to
/// S3+28.
pub fn pid_thermal(cx: &mut Cx) -> Done {
    cx.check_words(S3, at::END)?;
    let ts = cx.word(S3, at::TS)?;
    if ts <= 0 {
        return Err(Fault(6730));
    }
    let filter = cx.word(S3, at::FILTER)?;
    if !(0..=99).contains(&filter) {
        return Err(Fault(6732));
    }
    let dt = cx.sampled_ms() as f32;
    let elapsed = load(cx, memory::ELAPSED) + dt;
    if elapsed < f32::from(ts) {
        store(cx, memory::ELAPSED, elapsed);
        return Ok(());
    }
    store(
        cx,
        memory::ELAPSED,
        (elapsed - f32::from(ts)).min(f32::from(ts) - 1.0),
    );
    let first = cx.word(S3, at::STATE)? == 0;
    let raw = f32::from(cx.word(1, 0)?);
    let measured = if first {
        raw
    } else {
        raw + f32::from(filter) / 100.0 * (load(cx, memory::MEASURED) - raw)
    };
    store(cx, memory::MEASURED, measured);
    let target = f32::from(cx.word(0, 0)?);
    if cx.word(S3, at::ACT)? & LEARN != 0 {
        learn(cx, target, measured, f32::from(ts))
    } else {
        control(cx, target, measured, f32::from(ts))
    }
}

fn full_power(cx: &Cx) -> Result<f32, Fault> {
    let power = cx.word(S3, at::FULL_POWER)?;
    Ok(f32::from(if power > 0 { power } else { i16::MAX }))
}

/// Heats below the target and not above it, and watches the oscillation: when two waves after the first have the same
/// amplitude (within S3+31), the gains follow from it (Ziegler and Nichols).
fn learn(cx: &mut Cx, target: f32, measured: f32, ts: f32) -> Done {
    if cx.word(S3, at::STATE)? != state::LEARNING {
        begin_learning(cx, measured)?;
    }
    let period = load(cx, memory::PERIOD) + ts;
    store(cx, memory::PERIOD, period);
    let peak = (cx.dword(S3, at::PEAK)? as f32).max(measured);
    let valley = (cx.dword(S3, at::VALLEY)? as f32).min(measured);
    cx.set_dword(S3, at::PEAK, peak as i32)?;
    cx.set_dword(S3, at::VALLEY, valley as i32)?;
    let cooling = measured > target;
    let was_cooling = cx.word(S3, at::COOLING)? != 0;
    let power = cx.word(S3, at::INITIAL_POWER)?;
    cx.set_word(S3, at::COOLING, i16::from(cooling))?;
    cx.set_word(S3, at::HEAT, if cooling { 0 } else { power })?;
    cx.set_word(OUTPUT, 0, if cooling { 0 } else { power })?;
    if cooling && !was_cooling {
        end_of_wave(cx, target, measured, peak, valley)
    } else {
        Ok(())
    }
}

fn begin_learning(cx: &mut Cx, measured: f32) -> Done {
    for offset in [at::COOLING, at::CROSSINGS, at::STEADY, at::ERROR] {
        cx.set_word(S3, offset, 0)?;
    }
    cx.set_dword(S3, at::PEAK, measured as i32)?;
    cx.set_dword(S3, at::VALLEY, measured as i32)?;
    store(cx, memory::PERIOD, 0.0);
    store(cx, memory::AMPLITUDE, 0.0);
    cx.set_word(S3, at::STATE, state::LEARNING)
}

/// The measured value has risen through the target: a wave is complete.
fn end_of_wave(cx: &mut Cx, target: f32, measured: f32, peak: f32, valley: f32) -> Done {
    let waves = cx.word(S3, at::CROSSINGS)?.saturating_add(1);
    let period = load(cx, memory::PERIOD);
    let amplitude = (peak - valley) / 2.0;
    let same = libm::fabsf(amplitude - load(cx, memory::AMPLITUDE))
        <= f32::from(cx.word(S3, at::SAME_AMPLITUDE)?);
    cx.set_word(S3, at::CROSSINGS, waves)?;
    cx.set_dword(S3, at::ABOVE, (peak - target) as i32)?;
    cx.set_dword(S3, at::BELOW, (target - valley) as i32)?;
    cx.set_word(S3, at::STEADY, i16::from(same))?;
    store(cx, memory::AMPLITUDE, amplitude);
    store(cx, memory::PERIOD, 0.0);
    cx.set_dword(S3, at::PEAK, measured as i32)?;
    cx.set_dword(S3, at::VALLEY, measured as i32)?;
    match waves {
        // The first wave is the warm-up.
        ..=2 => Ok(()),
        _ if same && amplitude > 0.0 => finish_learning(cx, amplitude, period),
        // The wave whose amplitude still differs: 11 in the second, 12 from the third on.
        waves => cx.set_word(S3, at::ERROR, if waves == 3 { 11 } else { 12 }),
    }
}

fn finish_learning(cx: &mut Cx, amplitude: f32, period_ms: f32) -> Done {
    let swing = f32::from(cx.word(S3, at::INITIAL_POWER)?) / 2.0;
    let ku = 4.0 * swing / (core::f32::consts::PI * amplitude);
    // Gains in percent, times in milliseconds.
    let gains = [
        (at::KU, ku * 100.0),
        (at::P, 0.6 * ku * 100.0),
        (at::I, 0.5 * period_ms),
        (at::D, 0.125 * period_ms),
    ];
    for (offset, value) in gains {
        cx.set_dword(S3, offset, libm::roundf(value) as i32)?;
    }
    let action = cx.word(S3, at::ACT)?;
    cx.set_word(S3, at::ERROR, 0)?;
    cx.set_word(S3, at::ACT, action & !LEARN)?;
    cx.set_word(S3, at::STATE, 0)
}

/// One step of control. Outside the large band only the proportional part acts, held down by S3+29 %; between the bands
/// the output is held down by S3+27 %; the integral works inside the large band, the derivative inside the fine one. A
/// band of 0 is not used.
fn control(cx: &mut Cx, target: f32, measured: f32, ts: f32) -> Done {
    let deviation = target - measured;
    if cx.word(S3, at::STATE)? != state::CONTROLLING {
        store(cx, memory::INTEGRAL, 0.0);
        store(cx, memory::LAST, deviation);
        for (from, to) in [
            (at::P, at::CONTROL_P),
            (at::I, at::CONTROL_I),
            (at::D, at::CONTROL_D),
        ] {
            let gain = cx.dword(S3, from)?;
            cx.set_dword(S3, to, gain)?;
        }
        cx.set_word(S3, at::STATE, state::CONTROLLING)?;
    }
    let gain = |cx: &Cx, offset| cx.dword(S3, offset).map(|v| v as u32 as f32);
    let (p, ti, td) = (
        gain(cx, at::CONTROL_P)? / 100.0,
        gain(cx, at::CONTROL_I)?,
        gain(cx, at::CONTROL_D)?,
    );
    let outside = |cx: &Cx, offset| -> Result<bool, Fault> {
        let band = f32::from(cx.word(S3, offset)?);
        Ok(band > 0.0 && libm::fabsf(deviation) > band)
    };
    let percent = |cx: &Cx, offset| -> Result<f32, Fault> {
        let value = f32::from(cx.word(S3, offset)?);
        Ok(if value > 0.0 { value / 100.0 } else { 1.0 })
    };
    let full = full_power(cx)?;
    let far = outside(cx, at::LARGE_BAND)?;
    if !far && ti > 0.0 {
        let sum = load(cx, memory::INTEGRAL) + p * ts / ti * deviation;
        store(cx, memory::INTEGRAL, sum.clamp(0.0, full));
    }
    let slope = if outside(cx, at::FINE_BAND)? {
        0.0
    } else {
        (deviation - load(cx, memory::LAST)) / ts
    };
    store(cx, memory::LAST, deviation);
    let integral = if far { 0.0 } else { load(cx, memory::INTEGRAL) };
    let held_down = if far {
        percent(cx, at::SUPPRESSION)?
    } else if outside(cx, at::SMALL_BAND)? {
        percent(cx, at::COOLING_FACTOR)?
    } else {
        1.0
    };
    let power = (p * (deviation + td * slope) + integral) * held_down;
    cx.set_word(OUTPUT, 0, libm::roundf(power.clamp(0.0, full)) as i16)
}

#[cfg(test)]
mod tests {
    use crate::double::Double;
    use crate::{Class, Fault, Operand, RtFn, d};

    fn ops() -> [Operand; 4] {
        [0, 1, 100, 90].map(|n| d(Class::D, n))
    }

    /// A heater that lags: temperature follows the power of 800 ms ago.
    fn simulate(plc: &mut Double, scans: usize) {
        let mut delay = [0f32; 8];
        let mut temperature = f32::from(plc.d(1, 1)[0]);
        for scan in 0..scans {
            plc.scan(100, true, RtFn::PidThermal, &ops()).unwrap();
            let slot = scan % delay.len();
            let power = delay[slot];
            delay[slot] = f32::from(plc.d(90, 1)[0]);
            temperature += power * 0.02 - (temperature - 200.0) * 0.01;
            plc.set_d(1, &[temperature as i32]);
        }
    }

    #[test]
    fn learns_from_an_oscillation_and_then_holds_the_target() {
        let mut plc = Double::new().with_d(0, &[500, 200]).with_d(100, &[100, 16]);
        plc.set_d(128, &[1000]);
        plc.set_d(131, &[20, 600]);
        simulate(&mut plc, 3000);
        assert_eq!(plc.d(101, 1), [0], "learning ends");
        assert_eq!(plc.d(118, 1), [0], "without an error");
        assert!(plc.dd(103) > 0 && plc.dd(105) > 0 && plc.dd(107) > 0);
        simulate(&mut plc, 3000);
        let temperature = plc.d(1, 1)[0];
        assert!((470..=530).contains(&temperature), "{temperature}");
    }

    #[test]
    fn bad_settings_are_refused() {
        let mut plc = Double::new();
        assert_eq!(
            plc.scan(10, true, RtFn::PidThermal, &ops()),
            Err(Fault(6730))
        );
        plc.set_d(100, &[100, 0, 100]);
        assert_eq!(
            plc.scan(10, true, RtFn::PidThermal, &ops()),
            Err(Fault(6732))
        );
    }
}
