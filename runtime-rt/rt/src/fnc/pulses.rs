//! Pulses without a position: FNC 57 to 59 (h1u-h2u-programming §4.3.6, §8.7; l01s-programming §7.2, §7.3). What an
//! instruction asks of an output continues between scans; see [`crate::Axis`].

use super::output::{LOWEST_HZ, Output, RAMP_MS, Turn, held, unsigned};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::pulse::Train;

/// PLSY S1 S2 D (FNC 57): sends S2 pulses of S1 Hz on D, or with S2 = 0 pulses without end, and stops at once with its
/// drive. S1 may change at any time, S2 while the relay for that is on.
pub fn plsy(cx: &mut Cx) -> Done {
    held(cx, do_plsy)
}

fn do_plsy(cx: &mut Cx) -> Done {
    let output = Output::of(cx, 2)?;
    match output.turn(cx)? {
        Turn::Start => {
            let [hz, count] = unsigned(cx)?;
            let hz = raised(cx, hz);
            let train = Train::steady(output.millihertz(cx, hz), count);
            output.start(cx, train, output.wiring.pulses)?;
        }
        Turn::Sends => {
            let [hz, count] = unsigned(cx)?;
            let hz = raised(cx, hz);
            let speed = output.millihertz(cx, hz);
            let changes = output.has_on(cx, output.wiring.changes);
            let generator = &mut output.axis(cx)?.generator;
            generator.set_speed(speed);
            if changes && count > 0 {
                generator.set_total(count);
            }
        }
        Turn::Released => output.axis(cx)?.generator.halt(),
        Turn::Rest => {}
    }
    output.show(cx)
}

/// A speed of PLSY that is at least the model's lowest; 0 sends nothing.
fn raised(cx: &Cx, hz: u32) -> u32 {
    match hz {
        0 => 0,
        _ => hz.max(cx.plc.pulses().lowest_hz()),
    }
}

/// PLSR S1 S2 S3 D (FNC 59): sends S2 pulses on D, in S3 ms up to S1 Hz and in as many down, and comes down when its
/// drive goes off. The ramps begin and end with √(S1 / 2·S3). While the relay for that is on, S2 may change until it
/// comes down, and the way down has its own time.
pub fn plsr(cx: &mut Cx) -> Done {
    held(cx, do_plsr)
}

fn do_plsr(cx: &mut Cx) -> Done {
    let output = Output::of(cx, 3)?;
    match output.turn(cx)? {
        Turn::Start => {
            let [hz, count] = unsigned(cx)?;
            if count < cx.plc.pulses().fewest_with_ramps() {
                return Err(Fault::VALUE);
            }
            let hz = hz.clamp(LOWEST_HZ, cx.plc.pulses().highest_hz());
            let up_ms = cx.read(2)?.clamp(RAMP_MS.0, RAMP_MS.1);
            let down_ms = output.own_down_ms(cx).unwrap_or(up_ms);
            let (up, down) = (
                Train::slope(hz, up_ms as u32),
                Train::slope(hz, down_ms as u32),
            );
            let train = Train {
                lowest: up / 4,
                up,
                down,
                ..Train::steady(1000 * hz, count)
            };
            output.start(cx, train, output.wiring.pulses)?;
        }
        Turn::Sends => {
            let count = u32::try_from(cx.read(1)?).unwrap_or(0);
            output.change_total(cx, count)?;
        }
        Turn::Released => output.axis(cx)?.generator.stop(),
        Turn::Rest => {}
    }
    output.show(cx)
}

/// PWM S1 S2 D (FNC 58): sends pulses of width S1 and period S2 on D, in milliseconds or in the unit that special
/// devices say, as long as it is driven. Both may change at any time.
pub fn pwm(cx: &mut Cx) -> Done {
    held(cx, do_pwm)
}

fn do_pwm(cx: &mut Cx) -> Done {
    let output = Output::of(cx, 2)?;
    match output.turn_resting(cx)? {
        turn @ (Turn::Start | Turn::Sends) => {
            let [width, period] = unsigned(cx)?;
            if width > period || period == 0 {
                return Err(Fault::VALUE);
            }
            if turn == Turn::Start {
                output.start(cx, Train::steady(0, 0), None)?;
            }
            let unit_us = output.pwm_unit_us(cx);
            let generator = &mut output.axis(cx)?.generator;
            generator.modulate(width, period, unit_us);
        }
        Turn::Released => output.axis(cx)?.generator.halt(),
        Turn::Rest => {}
    }
    output.show(cx)
}

/// Stops the pulses of D at once, because an input says so (h1u-h2u-programming §8.1, M8141 to M8143).
pub fn stop_pulses(cx: &mut Cx) -> Done {
    held(cx, |cx| {
        let output = Output::of(cx, 0)?;
        output.halt(cx)
    })
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Operand, Plc, RtFn, advance_pulses, d, k};

    fn scan(plc: &mut Double, ms: u32, drive: bool, function: RtFn, ops: &[Operand]) -> bool {
        plc.sys.now_ms += ms;
        let now_us = plc.sys.now_ms * 1000;
        advance_pulses(plc, now_us);
        plc.sys.first_scan = false;
        plc.scan(0, drive, function, ops).is_ok()
    }

    fn plsy(plc: &mut Double, ms: u32, drive: bool) {
        let ops = [reg(0), reg(2), d(Class::Y, 0)];
        assert!(scan(plc, ms, drive, RtFn::Plsy, &ops));
    }

    #[test]
    fn a_train_is_sent_between_scans_and_ends_exactly() {
        let mut plc = Double::wide().with_d(0, &[1000, 0, 25]);
        plsy(&mut plc, 0, true);
        plsy(&mut plc, 10, true);
        assert_eq!((plc.dd(8140), plc.m(8147, 1)), (10, "1".into()));
        plsy(&mut plc, 17, true);
        let shown = (plc.dd(8140), plc.dd(8136), plc.m(8147, 1), plc.m(8029, 1));
        assert_eq!(shown, (25, 25, "0".into(), "1".into()));
        assert!(plc.axis(0).unwrap().take_end());
        plsy(&mut plc, 10, false);
        assert_eq!(plc.m(8029, 1), "0");
    }

    #[test]
    fn a_drive_that_goes_off_stops_the_pulses_and_begins_anew() {
        let mut plc = Double::wide().with_d(0, &[1000, 0, 25]);
        plsy(&mut plc, 0, true);
        plsy(&mut plc, 10, false);
        plsy(&mut plc, 10, true);
        assert_eq!(plc.dd(8140), 10);
        plsy(&mut plc, 40, true);
        assert_eq!(plc.dd(8140), 35);
    }

    #[test]
    fn a_ramp_begins_with_the_lowest_frequency() {
        let mut plc = Double::wide();
        // The manual's example: 50000 Hz in 100 ms begin with 500 Hz.
        let ops = [k(50_000), k(100_000), k(100), d(Class::Y, 0)];
        assert!(scan(&mut plc, 0, true, RtFn::Plsr, &ops));
        assert_eq!(plc.axis(0).unwrap().generator.millihertz(), 500_000);
        assert!(scan(&mut plc, 110, true, RtFn::Plsr, &ops));
        assert_eq!(plc.axis(0).unwrap().generator.millihertz(), 50_000_000);
        assert!(scan(&mut plc, 10_000, true, RtFn::Plsr, &ops));
        assert_eq!((plc.dd(8140), plc.m(8029, 1)), (100_000, "1".into()));
    }

    #[test]
    fn few_pulses_are_not_sent_with_ramps() {
        let mut plc = Double::new();
        let ops = [k(1000), k(109), k(100), d(Class::Y, 0)];
        assert!(!scan(&mut plc, 0, true, RtFn::Plsr, &ops));
        assert!(!plc.axis(0).unwrap().generator.is_busy());
    }

    #[test]
    fn modulation_follows_its_operands() {
        let mut plc = Double::new().with_d(0, &[5]);
        let ops = [reg(0), k(10), d(Class::Y, 1)];
        for (width, fits) in [(5, true), (11, false), (3, true)] {
            plc.set_d(0, &[width]);
            assert_eq!(scan(&mut plc, 10, true, RtFn::Pwm, &ops), fits);
            let generator = plc.axis(1).unwrap().generator;
            assert_eq!(
                (generator.millihertz(), generator.modulates()),
                (100_000, true)
            );
        }
        assert!(scan(&mut plc, 10, false, RtFn::Pwm, &ops));
        assert!(!plc.axis(1).unwrap().generator.is_busy());
    }
}
