//! Operation errors: the instruction is skipped, the error is shown in the special devices, the scan continues.

use crate::plc::{Class, Plc};
use crate::special::{self, Register, Relay};

/// An operation error with the PLC's code for it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(transparent)]
pub struct Fault(pub u16);

impl Fault {
    /// A device lies outside the model's range (an index or a count led there).
    pub const DEVICE: Fault = Fault(6706);
    /// An argument lies outside a floating-point function's domain, or its value is not a float; the manuals give the
    /// code of [`Fault::DEVICE`].
    pub const DOMAIN: Fault = Fault(6706);
    /// A value lies outside what the instruction takes; models show it as [`Plc::value_error`].
    pub const VALUE: Fault = Fault(6707);
    /// A remote module has not answered in time (h1u-h2u-programming §5.9.5).
    pub const NO_ANSWER: Fault = Fault(6381);
    /// A module is not there, or has no such buffer memory; models show it as [`Plc::module_error`].
    pub const MODULE: Fault = Fault(6709);
}

/// Reason for STOP.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(u16)]
pub enum Stop {
    /// Nothing but the RUN/STOP switch.
    #[default]
    No = 0,
    /// The program, by M8037.
    Program = 1,
    /// The watchdog: a scan did not end.
    Watchdog = 6105,
}

/// The last operation error, and why the PLC stopped, since RUN began; whether the program looks at special devices or
/// not.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C)]
pub struct LastError {
    /// The PLC's code of the last operation error, e.g. 6706; 0 if there was none.
    pub code: u16,
    /// Step of the instruction that it happened to.
    pub step: u16,
    /// Reason why the PLC is in STOP.
    pub stop: Stop,
    /// Step of the loop or the jump that the watchdog found too long.
    pub stop_step: u16,
}

impl LastError {
    /// Nothing has happened.
    pub const NONE: LastError = LastError {
        code: 0,
        step: 0,
        stop: Stop::No,
        stop_step: 0,
    };
}

/// Result of an instruction.
pub type Done = Result<(), Fault>;

/// Shows a fault at `step` as h1u-h2u-programming §8.1 says: M8067 and D8067 (code), D8069 (step), the latches M8068
/// and D8068, and the summary M8004 with D8004. HM has only a relay and, under its number, a register for the step
/// (hm-motion-controller §5.7). The program clears M8067 and M8004 when RUN begins, on FX and L01S in each scan; the
/// latches stay.
pub fn report(plc: &mut dyn Plc, fault: Fault, step: u32) {
    let code = match fault {
        Fault::VALUE => plc.value_error(),
        Fault::MODULE => plc.module_error(),
        Fault(code) => code,
    };
    plc.note_error(code, step);
    let step = step as u16 as i16;
    let relay = plc.error_relay();
    // Special devices a program does not look at swallow the write, so a `None` here means nothing.
    let _ = plc.set_bit(Class::M, relay, true);
    if relay != special::M_OPERATION_ERROR.number() {
        let _ = plc.set_word(Class::D, relay, step);
        return;
    }
    if plc.bit(Class::M, special::M_FIRST_ERROR.number()) != Some(true) {
        set_relay(plc, special::M_FIRST_ERROR);
        set_register(plc, special::D_FIRST_ERROR_STEP, step);
    }
    set_register(plc, special::D_OPERATION_ERROR, code as i16);
    set_register(plc, special::D_ERROR_STEP, step);
    summarise(plc, special::OPERATION_ERROR_BCD);
}

/// Switches a relay on, if the program looks at it.
fn set_relay(plc: &mut dyn Plc, relay: Relay) {
    let _ = plc.set_bit(Class::M, relay.number(), true);
}

/// Writes a register, if the program looks at it.
fn set_register(plc: &mut dyn Plc, register: Register, value: i16) {
    let _ = plc.set_word(Class::D, register.number(), value);
}

/// M8004 and D8004: which error relay is on.
fn summarise(plc: &mut dyn Plc, relay_bcd: i16) {
    set_relay(plc, special::M_ANY_ERROR);
    set_register(plc, special::D_ANY_ERROR, relay_bcd);
}

/// Shows that the watchdog has stopped the PLC: M8061, its code in D8061, and the summary; on HM its only error relay.
pub fn trip_watchdog(plc: &mut dyn Plc) {
    let relay = plc.error_relay();
    if relay != special::M_OPERATION_ERROR.number() {
        let _ = plc.set_bit(Class::M, relay, true);
        return;
    }
    set_relay(plc, special::M_WATCHDOG);
    set_register(plc, special::D_WATCHDOG, special::WATCHDOG_CODE);
    summarise(plc, special::WATCHDOG_BCD);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::double::Double;

    #[test]
    fn the_first_error_is_latched() {
        let mut plc = Double::new();
        report(&mut plc, Fault::DEVICE, 12);
        report(&mut plc, Fault::VALUE, 30);
        assert_eq!((plc.m(8067, 2), plc.m(8004, 1)), ("11".into(), "1".into()));
        assert_eq!(
            (plc.d(8067, 3), plc.d(8004, 1)),
            ([6707, 12, 30].to_vec(), [0x8067_u16 as i16].to_vec())
        );
    }

    #[test]
    fn some_models_have_one_code_for_devices_and_values() {
        let mut plc = Double::new();
        plc.value_error = 6706;
        report(&mut plc, Fault::VALUE, 0);
        assert_eq!(plc.d(8067, 1), [6706]);
        report(&mut plc, Fault::MODULE, 0);
        assert_eq!(plc.d(8067, 1), [6708]);
        plc.value_error = 6707;
        report(&mut plc, Fault::MODULE, 0);
        assert_eq!(plc.d(8067, 1), [6750]);
    }

    #[test]
    fn hm_shows_errors_elsewhere() {
        let mut plc = Double::new();
        plc.error_relay = 8006;
        report(&mut plc, Fault::DEVICE, 12);
        assert_eq!(plc.error, (6706, 12));
        assert_eq!(
            (plc.m(8006, 1), plc.d(8006, 1)),
            ("1".into(), [12].to_vec())
        );
        assert_eq!(
            (plc.m(8067, 2), plc.d(8067, 3)),
            ("00".into(), [0; 3].to_vec())
        );
    }
}
