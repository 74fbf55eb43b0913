//! The power supply and the battery, as special devices show them (h1u-h2u-programming §8.1, §8.9).

use crate::cx::Cx;
use crate::fault::Done;
use crate::special::{
    D_BATTERY, D_BATTERY_LOW, D_POWER_FAILURE_MS, D_POWER_FAILURES, M_BATTERY_HAS_BEEN_LOW,
    M_BATTERY_LOW, M_FORCED_STOP, M_POWER_FAILS, M_POWER_FAILURE,
};

/// Words of the memory: whether the supply fails, and since when, in milliseconds; whether M8007 has come on; whether
/// the PLC was stopped; whether the battery has been low.
const FAILS: usize = 0;
const SINCE: usize = 1;
const SHOWN: usize = 2;
const STOPPED: usize = 3;
const HAS_BEEN_LOW: usize = 4;

/// After how many milliseconds of failing power M8007 and M8008 come on.
const SHOWN_AFTER_MS: i32 = 5;

/// Shows the power supply and the battery, once a scan before the program. Once the battery was low, M8006 is on up to
/// power-off: a program cannot reset it (h1u-h2u-programming §8.9). When the supply has failed for 5 ms, M8007
/// and M8008 come on, and D8007 counts that. Once it has failed for longer than D8008 says, M8008 goes off, and the PLC
/// goes to STOP at the end of the scan. Where the supply comes back before the PLC has lost its memory, its host starts
/// it again.
pub fn power_supply(cx: &mut Cx) -> Done {
    if let Some(tenths) = cx.hal().battery() {
        let low = tenths < cx.special_word(D_BATTERY_LOW) as u16;
        cx.set_special_word(D_BATTERY, tenths as i16);
        cx.set_special(M_BATTERY_LOW, low);
        cx.state().0[HAS_BEEN_LOW] |= i32::from(low);
        if cx.state().0[HAS_BEEN_LOW] != 0 {
            cx.set_special(M_BATTERY_HAS_BEEN_LOW, true);
        }
    }
    let Some(fails) = cx.hal().power_fails() else {
        return Ok(());
    };
    let now = cx.plc.sys().now_ms as i32;
    if !fails {
        cx.state().0[..=STOPPED].fill(0);
        cx.set_special(M_POWER_FAILS, false);
        cx.set_special(M_POWER_FAILURE, false);
        return Ok(());
    }
    let state = cx.state();
    if core::mem::replace(&mut state.0[FAILS], 1) == 0 {
        state.0[SINCE] = now;
    }
    let passed = now.wrapping_sub(state.0[SINCE]);
    if passed >= SHOWN_AFTER_MS && core::mem::replace(&mut state.0[SHOWN], 1) == 0 {
        cx.set_special(M_POWER_FAILS, true);
        cx.set_special(M_POWER_FAILURE, true);
        let count = cx.special_word(D_POWER_FAILURES).saturating_add(1);
        cx.set_special_word(D_POWER_FAILURES, count);
    }
    if passed > i32::from(cx.special_word(D_POWER_FAILURE_MS))
        && core::mem::replace(&mut cx.state().0[STOPPED], 1) == 0
    {
        cx.set_special(M_POWER_FAILURE, false);
        cx.set_special(M_FORCED_STOP, true);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::RtFn;
    use crate::double::Double;
    use crate::plc::{Class, Plc};

    #[test]
    fn a_short_failure_is_shown_and_a_long_one_stops_the_plc() {
        let mut plc = Double::new();
        plc.set_d(8008, &[20]);
        let mut scan = |fails: bool| {
            plc.hal.set_power_fails(fails);
            plc.scan(5, true, RtFn::PowerSupply, &[]).unwrap();
            let relays = [8007, 8008, 8037].map(|n| plc.bit(Class::M, n).unwrap());
            (relays, plc.d(8007, 1)[0])
        };
        assert_eq!(scan(false), ([false, false, false], 0));
        assert_eq!(scan(true), ([false, false, false], 0));
        assert_eq!(scan(true), ([true, true, false], 1));
        assert_eq!(scan(false), ([false, false, false], 1));
        for _ in 0..5 {
            scan(true);
        }
        assert_eq!(scan(true), ([true, false, true], 2));
    }

    #[test]
    fn a_program_cannot_reset_m8006() {
        let mut plc = Double::new();
        plc.set_d(8006, &[26]);
        let mut scan = |tenths: u16, reset: bool| {
            plc.hal.set_battery(Some(tenths));
            plc.scan(5, true, RtFn::PowerSupply, &[]).unwrap();
            let relays = [8005, 8006].map(|n| plc.bit(Class::M, n).unwrap());
            if reset {
                plc.set_bit(Class::M, 8006, false).unwrap();
            }
            relays
        };
        assert_eq!(scan(30, false), [false, false]);
        assert_eq!(scan(25, true), [true, true]);
        assert_eq!(scan(30, true), [false, true]);
        assert_eq!(scan(30, false), [false, true]);
    }
}
