//! Updates of special registers by the scan in addition to the program: the built-in analog inputs of L01S
//! (l01s-programming §5.1) and potentiometers of FX3G; and errors that the program itself finds.

use crate::cx::Cx;
use crate::fault::Done;
use crate::special::{D_ANALOG_ENABLE, D_ANALOG_INPUTS};

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

#[cfg(test)]
mod tests {
    use crate::RtFn;
    use crate::double::Double;

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
