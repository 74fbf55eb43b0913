//! Pulses: FNC 57 (h1u-h2u-programming §4.3.6, §8.7). What an instruction asks of an output goes on between scans; see [`crate::Axis`].

use super::output::{Output, Turn};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::pulse::Train;

/// PLSY S1 S2 D (FNC 57): sends S2 pulses of S1 Hz on D, or with S2 = 0 pulses without end, and stops at once with its drive. S1 may
/// change at any time, S2 while the relay for that is on.
pub fn plsy(cx: &mut Cx) -> Done {
    let output = Output::of(cx, 2)?;
    match output.turn(cx)? {
        Turn::Start => {
            let (speed, count) = plsy_operands(cx, output)?;
            let train = Train::steady(speed, count);
            output.start(cx, train, output.wiring.pulses);
        }
        Turn::Sends => {
            let (speed, count) = plsy_operands(cx, output)?;
            let changes = cx.special(output.wiring.changes);
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

/// Speed and number.
fn plsy_operands(cx: &Cx, output: Output) -> Result<(u32, u32), Fault> {
    let [hz, count] = [cx.read(0)?, cx.read(1)?].map(u32::try_from);
    let (Ok(hz), Ok(count)) = (hz, count) else {
        return Err(Fault::VALUE);
    };
    Ok((output.millihertz(cx, hz), count))
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Plc, RtFn, advance_pulses, d};

    fn scan(plc: &mut Double, ms: u32, drive: bool) {
        plc.sys.now_ms += ms;
        let now_us = plc.sys.now_ms * 1000;
        advance_pulses(plc, now_us);
        plc.sys.first_scan = false;
        let ops = [reg(0), reg(2), d(Class::Y, 0)];
        plc.scan(0, drive, RtFn::Plsy, &ops).unwrap();
    }

    #[test]
    fn a_train_is_sent_between_scans_and_ends_exactly() {
        let mut plc = Double::wide().with_d(0, &[1000, 0, 25]);
        scan(&mut plc, 0, true);
        scan(&mut plc, 10, true);
        assert_eq!((plc.dd(8140), plc.m(8147, 1)), (10, "1".into()));
        scan(&mut plc, 17, true);
        let shown = (plc.dd(8140), plc.dd(8136), plc.m(8147, 1), plc.m(8029, 1));
        assert_eq!(shown, (25, 25, "0".into(), "1".into()));
        assert!(plc.axis(0).unwrap().take_end());
        scan(&mut plc, 10, false);
        assert_eq!(plc.m(8029, 1), "0");
    }

    #[test]
    fn a_drive_that_goes_off_stops_the_pulses_and_begins_anew() {
        let mut plc = Double::wide().with_d(0, &[1000, 0, 25]);
        scan(&mut plc, 0, true);
        scan(&mut plc, 10, false);
        scan(&mut plc, 10, true);
        assert_eq!(plc.dd(8140), 10);
        scan(&mut plc, 40, true);
        assert_eq!(plc.dd(8140), 35);
    }
}
