//! Special devices that the runtime writes: those of a function, of a pulse output, of a serial port. The runtime's
//! tables say which ([`RtFn::shown`], [`rungc_rt::Wiring`], [`rungc_rt::comm::PortWiring`]).

use super::{Encoder, Key};
use rungc_rt::comm::Choice;
use rungc_rt::special::{M_PORT_ERROR, M_PROGRAMMING_PORT_ERROR};
use rungc_rt::{Register, Relay, RtFn};
use rungc_syntax::DeviceClass;

/// Special devices that an instruction of the runtime may write: all but those that the scan alone maintains, M8000 to
/// M8003 and M8011 to M8014, and M8033 and M8034, which no instruction does.
const SPECIAL: [(DeviceClass, u32, u32); 4] = [
    (DeviceClass::M, 8004, 8010),
    (DeviceClass::M, 8015, 8032),
    (DeviceClass::M, 8035, u32::MAX),
    (DeviceClass::D, 8000, u32::MAX),
];

/// Devices written by an operation error.
const ERRORS: [(DeviceClass, u32, u32); 5] = [
    (DeviceClass::M, 8004, 8006),
    (DeviceClass::M, 8067, 8069),
    (DeviceClass::D, 8004, 8006),
    (DeviceClass::D, 8067, 8069),
    // The error log.
    (DeviceClass::D, 8490, 8509),
];

/// These relays and registers as runs of devices.
fn runs(
    relays: impl IntoIterator<Item = Relay>,
    registers: impl IntoIterator<Item = Register>,
) -> Vec<(DeviceClass, u32, u32)> {
    let relays = relays.into_iter();
    let relays = relays.map(|of| (DeviceClass::M, of.number(), of.number()));
    let registers = registers.into_iter();
    let registers = registers.map(|of| (DeviceClass::D, of.number(), of.number()));
    relays.chain(registers).collect()
}

impl Encoder<'_> {
    /// The special devices that the runtime may write. An index register is not one of them, even if a special
    /// register is another name for it.
    pub(super) fn specials(&self) -> Vec<Key> {
        let mut keys = self.named_in(&SPECIAL);
        keys.retain(|key| !matches!(key, Key::Word(DeviceClass::V | DeviceClass::Z, _)));
        keys
    }

    /// The devices that show operation errors.
    pub(super) fn of_errors(&self) -> Vec<Key> {
        self.named_in(&ERRORS)
    }

    /// The special devices that a function may write.
    pub(super) fn shown_by(&self, function: RtFn) -> Vec<Key> {
        let Some((relays, registers)) = function.shown() else {
            return self.specials();
        };
        let own = runs(relays.iter().copied(), registers.iter().copied());
        let mut keys = self.named_in(&own);
        let needs = function.needs();
        // These have no operand that could be wrong.
        if function != RtFn::Potentiometers {
            keys.extend(self.of_errors());
        }
        if needs.pulses {
            keys.extend(self.of_outputs());
        }
        if needs.port || needs.names_port {
            keys.extend(self.of_ports());
        }
        keys
    }

    /// The special devices in which the program's pulse outputs show what they do.
    pub(super) fn of_outputs(&self) -> Vec<Key> {
        let outputs = self.module.model.pulses.outputs();
        let numbers = self.module.pulse_outputs.iter();
        let wirings = numbers.filter_map(|&number| outputs.get(number as usize));
        let own = wirings.flat_map(|wiring| runs(wiring.shown_relays(), wiring.shown_registers()));
        self.named_in(&own.collect::<Vec<_>>())
    }

    /// The special devices in which the program's serial ports show what they do; all, if registers give a port more.
    pub(super) fn of_ports(&self) -> Vec<Key> {
        let numbers = self.module.ports.iter();
        let wirings = numbers.filter_map(|&number| self.module.model.ports.get(number));
        let mut keys = self.of_errors();
        for relay in [M_PROGRAMMING_PORT_ERROR, M_PORT_ERROR] {
            keys.extend(self.named_in(&runs([relay], [Register(relay.0)])));
        }
        for wiring in wirings {
            keys.extend(match wiring.choice {
                Choice::Can => self.specials(),
                // Its work area is anywhere.
                Choice::Uinit => self.named(DeviceClass::D, 0, u32::MAX),
                _ => Vec::new(),
            });
            keys.extend(self.named_in(&runs(wiring.shown_relays(), wiring.shown_registers())));
        }
        keys
    }
}

#[cfg(test)]
mod tests;
