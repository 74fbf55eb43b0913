//! The terminals of the interpreter, as a machine is wired to them: one place for all who let a program run beside a
//! machine.

use super::{Look, Plant, Terminals};
use crate::target::Channel;
use crate::wire::Change;
use rungc_interp::Machine;
use rungc_rt::modules::Signal;
use rungc_rt::{Class, Plc, Program, VirtualHal, pass_pulses};

/// A PLC between two scans.
pub struct Wired<'a, 'm, E> {
    /// The PLC.
    pub machine: &'a mut Machine<'m>,
    /// Its hardware.
    pub hal: &'a mut VirtualHal,
    /// Is called with each change of an input, once the program has taken it.
    pub changed: &'a mut dyn FnMut(Change) -> Result<(), E>,
}

impl<E: From<String>> Wired<'_, '_, E> {
    /// The machine is connected before the first scan: its switches and sensors show where it is. Fails if the PLC
    /// lacks an input that a sensor is connected to.
    pub fn connect(&mut self, plant: &mut Plant) -> Result<(), E> {
        for (number, on) in plant.inputs() {
            // The description was held to the model, so the input exists.
            let _ = self.machine.set_bit(Class::X, number, on);
        }
        plant.measure(self)
    }
}

impl<E: From<String>> Terminals for Wired<'_, '_, E> {
    type Error = E;

    fn look(&mut self, at: &[Look]) -> Result<Vec<i32>, E> {
        let value = |look: &Look| match *look {
            Look::Output(output) => i32::from(self.machine.output(output)),
            Look::Pulses(output) => self.machine.pulses_sent(output),
            Look::Channel(Channel {
                unit,
                number,
                quantity,
            }) => self.hal.signal(unit, number, quantity).unwrap_or(0),
        };
        Ok(at.iter().map(value).collect())
    }

    fn pass(
        &mut self,
        [from, until]: [u32; 2],
        most: u32,
        at: &[Look],
    ) -> Result<(u32, Vec<i32>), E> {
        let reached = pass_pulses(self.machine, from, until, most);
        Ok((reached, self.look(at)?))
    }

    fn change(&mut self, change: Change) -> Result<(), E> {
        // The description was held to the model, so the input exists.
        let _ = self.machine.set_bit(Class::X, change.input, change.on);
        self.machine.input_edge(self.hal, change.input, change.on);
        self.machine.take_interrupts(self.hal);
        (self.changed)(change)
    }

    fn connect(&mut self, channel: Channel, millionths: i32) -> Result<(), E> {
        let signal = Signal {
            quantity: channel.quantity,
            millionths,
        };
        let connected = self.hal.set_signal(channel.unit, channel.number, signal);
        connected.ok_or_else(|| E::from(channel.missing()))
    }
}
