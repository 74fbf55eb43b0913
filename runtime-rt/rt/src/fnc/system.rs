//! Updates of special registers by the scan in addition to the program: the running time and error log of H1U/H2U
//! (h1u-h2u-programming §8.2.2) and the built-in analog inputs of L01S (l01s-programming §5.1) and potentiometers of
//! FX3G.

use crate::cx::Cx;
use crate::fault::Done;
use crate::special::{
    D_ANALOG_ENABLE, D_ANALOG_INPUTS, D_ERROR_STEP, D_LOGGED_CODES, D_LOGGED_HOURS,
    D_OPERATION_ERROR, D_RUN_TIME, D_SLOW_RING_COUNTER,
};
use crate::word::{pair, words};

/// Capacity of the error log.
const ENTRIES: u32 = 10;

/// The running time and the error log, once a scan after the program. A new code of an operation error is added, the
/// oldest of ten making place; one that is there only takes the new time. Memory: code and step logged last;
/// milliseconds of the second.
pub fn error_log(cx: &mut Cx) -> Done {
    let dt = cx.dt_ms();
    let ms = cx.state().0[2].saturating_add(dt);
    cx.state().0[2] = ms % 1000;
    let [low, high] = D_RUN_TIME.run().map(|register| cx.special_word(register));
    let seconds = pair(low, high).wrapping_add(ms / 1000);
    for (register, word) in D_RUN_TIME.run::<2>().into_iter().zip(words(seconds)) {
        cx.set_special_word(register, word);
    }
    let (code, step) = (
        cx.special_word(D_OPERATION_ERROR),
        cx.special_word(D_ERROR_STEP),
    );
    let logged = [i32::from(code), i32::from(step)];
    let state = cx.state();
    if code == 0 || state.0[..2] == logged {
        return Ok(());
    }
    [state.0[0], state.0[1]] = logged;
    let place =
        (0..ENTRIES).find(|&n| [0, code].contains(&cx.special_word(D_LOGGED_CODES.after(n))));
    if place.is_none() {
        for n in 0..ENTRIES - 1 {
            for table in [D_LOGGED_HOURS, D_LOGGED_CODES] {
                let next = cx.special_word(table.after(n + 1));
                cx.set_special_word(table.after(n), next);
            }
        }
    }
    let place = place.unwrap_or(ENTRIES - 1);
    cx.set_special_word(D_LOGGED_HOURS.after(place), (seconds / 3600) as i16);
    cx.set_special_word(D_LOGGED_CODES.after(place), code);
    Ok(())
}

/// D8030 … from the analog inputs that D8114 switches on, once a scan before the program.
pub fn analog_inputs(cx: &mut Cx) -> Done {
    let enabled = cx.special_word(D_ANALOG_ENABLE);
    for channel in 0..8u8 {
        if enabled >> channel & 1 == 1
            && let Some(value) = cx.hal().analog(channel)
        {
            cx.set_special_word(D_ANALOG_INPUTS.after(channel.into()), value);
        }
    }
    Ok(())
}

/// D8030 and D8031 from the two potentiometers, which are the first analog inputs, once a scan before the program.
pub fn potentiometers(cx: &mut Cx) -> Done {
    for channel in 0..2u8 {
        if let Some(value) = cx.hal().analog(channel) {
            cx.set_special_word(D_ANALOG_INPUTS.after(channel.into()), value.clamp(0, 255));
        }
    }
    Ok(())
}

/// D8398 and D8399 count the milliseconds, once a scan before the program, up to 2147483647 and from 0 again.
pub fn ring_counter(cx: &mut Cx) -> Done {
    let [low, high] = D_SLOW_RING_COUNTER
        .run()
        .map(|register| cx.special_word(register) as u16);
    let count = u32::from(high) << 16 | u32::from(low);
    let count = count.wrapping_add(cx.dt_ms() as u32) & 0x7fff_ffff;
    cx.set_special_word(D_SLOW_RING_COUNTER, count as i16);
    cx.set_special_word(D_SLOW_RING_COUNTER.after(1), (count >> 16) as i16);
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::RtFn;
    use crate::double::Double;

    #[test]
    fn the_log_keeps_ten_codes() {
        let mut plc = Double::new();
        plc.scan(3_600_000, true, RtFn::ErrorLog, &[]).unwrap();
        assert_eq!(plc.d(8500, 1), [0]);
        for code in (6701..=6711).chain([6705]) {
            plc.set_d(8067, &[code]);
            plc.scan(3_600_000, true, RtFn::ErrorLog, &[]).unwrap();
        }
        assert_eq!(
            plc.d(8500, 10),
            (6702..=6711).collect::<std::vec::Vec<i16>>()
        );
        assert_eq!(plc.d(8490, 10), [3, 4, 5, 13, 7, 8, 9, 10, 11, 12]);
        assert_eq!(plc.dd(8510), 13 * 3600);
    }

    #[test]
    fn analog_inputs_work_once_switched_on() {
        let mut plc = Double::new();
        plc.hal.set_analog(1, 2000).unwrap();
        plc.call(RtFn::AnalogInputs, &[]).unwrap();
        assert_eq!(plc.d(8030, 3), [0; 3]);
        plc.set_d(8114, &[7]);
        plc.call(RtFn::AnalogInputs, &[]).unwrap();
        assert_eq!(plc.d(8030, 3), [0, 2000, 0]);
    }

    #[test]
    fn potentiometers_are_always_read() {
        let mut plc = Double::new();
        plc.hal.set_analog(1, 300).unwrap();
        plc.call(RtFn::Potentiometers, &[]).unwrap();
        assert_eq!(plc.d(8030, 2), [0, 255]);
    }
}
