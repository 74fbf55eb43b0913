//! Output of the program's state by defmt.

use crate::MACHINE;
use defmt::{Format, Formatter, intern, write};
use rungc_rt::{Plc, Program, Stop};

/// RUN or STOP, what put the PLC in STOP, and the last operation error.
impl Format for MACHINE {
    fn format(&self, to: Formatter) {
        let (running, error) = (self.sys().running, self.last_error());
        let mode = match error.stop {
            _ if running => intern!("RUN"),
            Stop::No => intern!("STOP"),
            Stop::Program => intern!("STOP by M8037"),
            Stop::Watchdog => intern!("STOP by the watchdog"),
        };
        match (error.stop, error.code) {
            (Stop::Watchdog, 0) => write!(to, "NAME: {=istr} at step {=u16}", mode, error.stop_step),
            (Stop::Watchdog, code) => write!(
                to,
                "NAME: {=istr} at step {=u16}, operation error {=u16} at step {=u16}",
                mode, error.stop_step, code, error.step
            ),
            (_, 0) => write!(to, "NAME: {=istr}", mode),
            (_, code) => write!(
                to,
                "NAME: {=istr}, operation error {=u16} at step {=u16}",
                mode, code, error.step
            ),
        }
    }
}
