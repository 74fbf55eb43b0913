//! Errors and what shows them: the only code that writes M8060 to M8069, D8060 to D8069, the summary M8004 with D8004,
//! and the log.
//!
//! After an operation error the instruction is skipped and the scan continues.

use crate::plc::{Class, Plc};
use crate::special::{self, D_LOGGED_CODES, D_LOGGED_HOURS, D_RUN_TIME, Register, Relay};
use crate::word::pair;

/// Capacity of the error log.
const LOGGED: u32 = 10;

/// Consequences of errors that differ between models.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ErrorRules {
    /// M8004 and D8004 show M8063, too (H1U/H2U; on FX an error of a port does not count).
    pub sums_up_ports: bool,
    /// Each error enters the log D8490 to D8509 (H1U/H2U).
    pub logs: bool,
}

impl ErrorRules {
    /// No further consequences.
    pub const NONE: ErrorRules = ErrorRules {
        sums_up_ports: false,
        logs: false,
    };
}

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
    if relay != special::M_OPERATION_ERROR.number() {
        let _ = plc.set_bit(Class::M, relay, true);
        let _ = plc.set_word(Class::D, relay, step);
        return;
    }
    if plc.bit(Class::M, special::M_FIRST_ERROR.number()) != Some(true) {
        set_relay(plc, special::M_FIRST_ERROR);
        set_register(plc, special::D_FIRST_ERROR_STEP, step);
    }
    set_register(plc, special::D_ERROR_STEP, step);
    show_error(plc, special::M_OPERATION_ERROR, code);
}

/// Shows an error: its relay, the code in the register of the same number, the summary M8004 with D8004, and the log.
#[inline(always)]
pub(crate) fn show_error(plc: &mut (impl Plc + ?Sized), relay: Relay, code: u16) {
    let number = relay.number();
    let _ = plc.set_bit(Class::M, number, true);
    let _ = plc.set_word(Class::D, number, code as i16);
    let rules = plc.error_rules();
    let sums_up = match relay {
        special::M_OPERATION_ERROR | special::M_WATCHDOG => true,
        special::M_PORT_ERROR => rules.sums_up_ports,
        special::M_PROGRAMMING_PORT_ERROR => false,
        // An error of a second channel has other numbers.
        _ => return,
    };
    if sums_up {
        let _ = plc.set_bit(Class::M, special::M_ANY_ERROR.number(), true);
        let _ = plc.set_word(Class::D, special::D_ANY_ERROR.number(), relay_in_bcd(relay));
    }
    if rules.logs {
        log_error(plc, code);
    }
}

/// Value of D8004 for an error relay: its number, in BCD.
pub const fn relay_in_bcd(relay: Relay) -> i16 {
    let n = relay.0;
    ((n / 1000 % 10) << 12 | (n / 100 % 10) << 8 | (n / 10 % 10) << 4 | (n % 10)) as i16
}

/// Enters an error in the log (h1u-h2u-programming §8.2.2): its code after the others, the oldest of ten making place;
/// a code that is there takes the new time and keeps its place.
pub fn log_error(plc: &mut (impl Plc + ?Sized), code: u16) {
    let [low, high] = D_RUN_TIME
        .run()
        .map(|register| register_word(plc, register));
    let hours = pair(low, high) / 3600;
    let place = (0..LOGGED).find(|&n| {
        let logged = register_word(plc, D_LOGGED_CODES.after(n));
        logged == 0 || logged == code as i16
    });
    if place.is_none() {
        for n in 0..LOGGED - 1 {
            for table in [D_LOGGED_HOURS, D_LOGGED_CODES] {
                let next = register_word(plc, table.after(n + 1));
                let _ = plc.set_word(Class::D, table.after(n).number(), next);
            }
        }
    }
    let place = place.unwrap_or(LOGGED - 1);
    let hours = (D_LOGGED_HOURS.after(place), hours as i16);
    for (register, value) in [hours, (D_LOGGED_CODES.after(place), code as i16)] {
        let _ = plc.set_word(Class::D, register.number(), value);
    }
}

/// Switches a relay on, if the program looks at it.
fn set_relay(plc: &mut dyn Plc, relay: Relay) {
    let _ = plc.set_bit(Class::M, relay.number(), true);
}

/// Writes a register, if the program looks at it.
fn set_register(plc: &mut dyn Plc, register: Register, value: i16) {
    let _ = plc.set_word(Class::D, register.number(), value);
}

/// Value of a register; 0 if the program does not store it.
fn register_word(plc: &(impl Plc + ?Sized), register: Register) -> i16 {
    plc.word(Class::D, register.number()).unwrap_or(0)
}

/// Shows that the watchdog has stopped the PLC: M8061, its code in D8061, and the summary; on HM its only error relay.
pub fn trip_watchdog(plc: &mut dyn Plc) {
    let relay = plc.error_relay();
    if relay != special::M_OPERATION_ERROR.number() {
        let _ = plc.set_bit(Class::M, relay, true);
        return;
    }
    show_error(plc, special::M_WATCHDOG, special::WATCHDOG_CODE);
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
    fn each_error_has_its_place() {
        for rules in [true, false] {
            let cases = [
                (special::M_WATCHDOG, true),
                (special::M_PROGRAMMING_PORT_ERROR, false),
                (special::M_PORT_ERROR, rules),
                (special::M_OPERATION_ERROR, true),
                (Relay(8438), false),
            ];
            for (relay, sums_up) in cases {
                let mut plc = Double::new();
                plc.error_rules = ErrorRules {
                    sums_up_ports: rules,
                    logs: rules,
                };
                show_error(&mut plc, relay, 6123);
                let number = relay.number();
                assert_eq!(plc.bit(Class::M, number), Some(true), "M{number}");
                assert_eq!(plc.d(number, 1), [6123], "M{number}");
                assert_eq!(plc.bit(Class::M, 8004), Some(sums_up), "M{number}");
                let shown = if sums_up { relay_in_bcd(relay) } else { 0 };
                assert_eq!(plc.d(8004, 1), [shown], "M{number}");
                let logged = rules && number < 8100;
                assert_eq!(plc.d(8500, 1), [if logged { 6123 } else { 0 }], "M{number}");
            }
        }
    }

    #[test]
    fn the_log_keeps_ten_codes() {
        let mut plc = Double::new();
        for (hour, code) in (1..).zip((6701..=6711).chain([6705])) {
            plc.set_dd(8510, hour * 3600);
            log_error(&mut plc, code);
        }
        let codes: std::vec::Vec<i16> = (6702..=6711).collect();
        assert_eq!(plc.d(8500, 10), codes);
        assert_eq!(plc.d(8490, 10), [2, 3, 4, 12, 6, 7, 8, 9, 10, 11]);
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
