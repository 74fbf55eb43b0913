//! `rungc run --machine`: the terminals of the interpreter, as the machine is wired to them.

use super::recording::Recording;
use crate::commands::Failure;
use rungc_interp::Machine;
use rungc_rt::modules::Signal;
use rungc_rt::{Class, Plc, Program, VirtualHal, pass_pulses};
use rungc_sim::Channel;
use rungc_sim::plant::{Look, Terminals};
use rungc_sim::wire::Change;

/// A PLC between two scans.
pub struct Wiring<'a, 'm> {
    /// The PLC.
    pub machine: &'a mut Machine<'m>,
    /// Its hardware.
    pub hal: &'a mut VirtualHal,
    /// Where edges of inputs are recorded.
    pub recording: Option<&'a mut Recording>,
}

impl Terminals for Wiring<'_, '_> {
    type Error = Failure;

    fn look(&mut self, at: &[Look]) -> Result<Vec<i32>, Failure> {
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
    ) -> Result<(u32, Vec<i32>), Failure> {
        let reached = pass_pulses(self.machine, from, until, most);
        Ok((reached, self.look(at)?))
    }

    fn change(&mut self, change: Change) -> Result<(), Failure> {
        // The description was held to the model, so the input exists.
        let _ = self.machine.set_bit(Class::X, change.input, change.on);
        self.machine.input_edge(self.hal, change.input, change.on);
        self.machine.take_interrupts(self.hal);
        match &mut self.recording {
            Some(recording) => recording.edge(change),
            None => Ok(()),
        }
    }

    fn connect(&mut self, channel: Channel, millionths: i32) -> Result<(), Failure> {
        let signal = Signal {
            quantity: channel.quantity,
            millionths,
        };
        let connected = self.hal.set_signal(channel.unit, channel.number, signal);
        connected.ok_or_else(|| Failure::Because(channel.missing()))
    }
}
