//! Operation errors: the instruction is skipped, the error is shown in the special devices, the scan goes on.

use crate::plc::{Class, Plc};

/// An operation error with the PLC's code for it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(transparent)]
pub struct Fault(pub u16);

impl Fault {
    /// A device lies outside the model's range (an index or a count led there).
    pub const DEVICE: Fault = Fault(6706);
    /// An argument lies outside a floating-point function's domain, or its value is no float; the manuals give the code of [`Fault::DEVICE`].
    pub const DOMAIN: Fault = Fault(6706);
    /// A value lies outside what the instruction takes.
    pub const VALUE: Fault = Fault(6707);
    /// A module is not there, or has no such buffer memory.
    pub const MODULE: Fault = Fault(6750);
}

/// What an instruction returns.
pub type Done = Result<(), Fault>;

/// Shows a fault at `step` as h1u-h2u-programming §8.1 says: M8067 and D8067 (code), D8069 (step), the latches M8068 and D8068,
/// and the summary M8004 with D8004.
pub fn report(plc: &mut dyn Plc, fault: Fault, step: u32) {
    let step = step as u16 as i16;
    // Special devices a program does not look at swallow the write, so a `None` here means nothing.
    if plc.bit(Class::M, 8068) != Some(true) {
        let _ = plc.set_bit(Class::M, 8068, true);
        let _ = plc.set_word(Class::D, 8068, step);
    }
    let _ = plc.set_bit(Class::M, 8067, true);
    let _ = plc.set_word(Class::D, 8067, fault.0 as i16);
    let _ = plc.set_word(Class::D, 8069, step);
    let _ = plc.set_bit(Class::M, 8004, true);
    let _ = plc.set_word(Class::D, 8004, 8067);
}

/// Shows that the watchdog has stopped the PLC: M8061, and D8061 = 6105 (h1u-h2u-programming §8.1).
pub fn trip_watchdog(plc: &mut dyn Plc) {
    let _ = plc.set_bit(Class::M, 8061, true);
    let _ = plc.set_word(Class::D, 8061, 6105);
}
