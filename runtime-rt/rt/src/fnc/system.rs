//! Updates of special registers by the scan in addition to the program: the running time of H1U/H2U
//! (h1u-h2u-programming §8.2.2) and the built-in analog inputs of L01S (l01s-programming §5.1) and potentiometers of
//! FX3G.

use crate::cx::Cx;
use crate::fault::Done;
use crate::special::{D_ANALOG_ENABLE, D_ANALOG_INPUTS, D_RUN_TIME, D_SLOW_RING_COUNTER};
use crate::word::{pair, words};

/// The running time, once a scan after the program. Memory: milliseconds of the second.
pub fn run_time(cx: &mut Cx) -> Done {
    let dt = cx.dt_ms();
    let ms = cx.state().0[0].saturating_add(dt);
    cx.state().0[0] = ms % 1000;
    let [low, high] = D_RUN_TIME.run().map(|register| cx.special_word(register));
    let seconds = pair(low, high).wrapping_add(ms / 1000);
    for (register, word) in D_RUN_TIME.run::<2>().into_iter().zip(words(seconds)) {
        cx.set_special_word(register, word);
    }
    Ok(())
}

/// An error that the program itself found enters the log.
pub fn log_error(cx: &mut Cx) -> Done {
    let code = cx.read(0)?;
    cx.log_error(code as u16);
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
    fn the_running_time_counts_seconds() {
        let mut plc = Double::new();
        for _ in 0..3 {
            plc.scan(3_600_000, true, RtFn::RunTime, &[]).unwrap();
        }
        assert_eq!(plc.dd(8510), 3 * 3600);
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
