//! Selection of the protocol of FX's ports, and Modbus on the channels of FX3.

use super::{Choice, M_PARALLEL_MASTER, M_PARALLEL_SLAVE, PortWiring, Protocol, value};
use crate::comm::LineFault;
use crate::plc::Plc;
use crate::special::{Register, Relay};

/// N:N links: own station, number of slaves (FX data communication manual, part B).
const D_STATION: Register = Register(8176);
const D_SLAVES: Register = Register(8177);
/// The registers that set a link up.
pub(super) const LINKS: [Register; 2] = [D_STATION, D_SLAVES];
/// The parallel link, the N:N link is on channel 2 (FX3).
const M_PARALLEL_CHANNEL_2: Relay = Relay(8178);
const M_NN_CHANNEL_2: Relay = Relay(8179);
/// Mode of channel 1 (FX3).
const D_CHANNEL_1: Register = Register(8401);

/// Registers and relays of Modbus on a channel of FX3, from this number on (FX3U MODBUS manual §6.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModbusWiring(pub(super) u16);

impl ModbusWiring {
    const fn relay(self, after: u16) -> Relay {
        Relay(self.0 + after)
    }

    const fn register(self, after: u16) -> Register {
        Register(self.0 + after)
    }

    /// Relays that exchanges write.
    pub(super) fn relays(self) -> [Relay; 5] {
        let [busy, failed, since_run] = [self.busy(), self.failed(), self.failed_since_run()];
        [busy, failed, since_run, self.tried(), self.late()]
    }

    /// All registers.
    pub(super) fn registers(self) -> [Register; 13] {
        Register(self.0).run()
    }

    /// Relay: ADPRW is in work.
    pub(crate) const fn busy(self) -> Relay {
        self.relay(1)
    }

    /// Relay: the last exchange has failed; its code is in the register of this number.
    pub(crate) const fn failed(self) -> Relay {
        self.relay(2)
    }

    /// Relay: an exchange has failed since RUN began; details are in the register of this number.
    pub(crate) const fn failed_since_run(self) -> Relay {
        self.relay(3)
    }

    /// Register: step of the instruction that failed first.
    pub(crate) const fn failed_step(self) -> Register {
        self.register(4)
    }

    /// Register: step of the last instruction.
    pub(crate) const fn step(self) -> Register {
        self.register(7)
    }

    /// Relay: the request has been sent again.
    pub(crate) const fn tried(self) -> Relay {
        self.relay(8)
    }

    /// Register: how often.
    pub(crate) const fn tries(self) -> Register {
        self.register(8)
    }

    /// Relay: no answer has come.
    pub(crate) const fn late(self) -> Relay {
        self.relay(9)
    }

    /// Time that slaves need for a broadcast, in microseconds.
    pub(crate) fn after_broadcast_us(self, plc: &dyn Plc) -> u32 {
        match self.register(10).value(plc) {
            0 => 400_000,
            ms => u32::from(ms) * 1000,
        }
    }

    /// The least silence between messages, in microseconds.
    pub(crate) fn silence_us(self, plc: &dyn Plc) -> u32 {
        const MOST_MS: u16 = 16_382;
        u32::from(self.register(11).value(plc).min(MOST_MS)) * 1000
    }

    /// Number of retries of a request without an answer.
    pub(crate) fn retries(self, plc: &dyn Plc) -> u8 {
        const MOST: u16 = 20;
        self.register(12).value(plc).min(MOST) as u8
    }

    /// Forgets the errors.
    pub(crate) fn clear(self, plc: &mut dyn Plc) {
        self.failed().set(plc, false);
        self.failed_since_run().set(plc, false);
        for after in 2..=4 {
            self.register(after).set(plc, 0);
        }
    }
}

impl PortWiring {
    /// The link between PLCs that a program of FX sets up on this port (FX data communication manual, parts B and C).
    pub(super) fn fx_link(&self, plc: &dyn Plc) -> Option<Protocol> {
        let nn = self.has_link(plc, M_NN_CHANNEL_2);
        let parallel = self.has_link(plc, M_PARALLEL_CHANNEL_2);
        let [master, slave] = [M_PARALLEL_MASTER, M_PARALLEL_SLAVE].map(|relay| relay.is_on(plc));
        match (D_STATION.value(plc), D_SLAVES.value(plc)) {
            (1.., _) if nn => Some(Protocol::NnSlave),
            (0, 1..) if nn => Some(Protocol::NnMaster),
            _ if parallel && master && slave => Some(Protocol::Off),
            _ if parallel && master => Some(Protocol::ParallelMaster),
            _ if parallel && slave => Some(Protocol::ParallelSlave),
            _ => None,
        }
    }

    /// Returns true if this is the port of a link that a relay puts on channel 2 (FX3).
    fn has_link(&self, plc: &(impl Plc + ?Sized), on_channel_2: Relay) -> bool {
        let channel_2 = plc.ports().is_fx3() && on_channel_2.is_on(plc);
        channel_2 == (self.number == 2)
    }

    /// Returns true if M8070 and M8071 set up a parallel link on this port.
    pub(crate) fn has_parallel_link(&self, plc: &(impl Plc + ?Sized)) -> bool {
        match self.choice {
            Choice::Com1 => true,
            Choice::Format | Choice::Channel => self.has_link(plc, M_PARALLEL_CHANNEL_2),
            _ => false,
        }
    }

    /// A channel of FX3 (FX3U MODBUS manual §6.1, D8401): bit 0 Modbus, bit 4 slave, bit 8 ASCII. Channel 1 precedes
    /// channel 2.
    pub(super) fn channel(&self, plc: &dyn Plc) -> Protocol {
        let [mode, format] = [self.protocol, self.format].map(|register| value(plc, register));
        let taken = self.number != 1 && D_CHANNEL_1.value(plc) & 1 != 0;
        match (mode & 1 != 0, mode >> 4 & 1 != 0, mode >> 8 & 1 != 0) {
            (true, ..) if taken => Protocol::Off,
            (true, false, false) => Protocol::MasterRtu,
            (true, false, true) => Protocol::MasterAscii,
            (true, true, false) => Protocol::ModbusRtu,
            (true, true, true) => Protocol::ModbusAscii,
            (false, ..) => match self.fx_link(plc) {
                Some(link) => link,
                None if format & 1 << 14 != 0 => Protocol::ComputerLink,
                None => Protocol::Free,
            },
        }
    }

    /// Shows an error of Modbus on FX3 (FX3U MODBUS manual §12.6).
    pub(crate) fn note_modbus(&self, plc: &mut dyn Plc, code: u16, details: u16) {
        /// The code of all errors of Modbus in D8063 and D8438.
        const MODBUS: u16 = 21;
        if let Some(place) = self.error {
            place.show(plc, self.codes + MODBUS);
        }
        if let Some(modbus) = self.modbus {
            modbus.failed().set(plc, true);
            modbus.failed_since_run().set(plc, true);
            modbus.register(2).set(plc, code);
            modbus.register(3).set(plc, details);
        }
    }
}

impl LineFault {
    /// The code of an error of Modbus on FX3 (FX3U MODBUS manual §12.6).
    pub(super) fn of_fx3(self, master: bool) -> u16 {
        match self {
            LineFault::Character => 204,
            LineFault::Sum => 205,
            LineFault::Overflow => 206,
            LineFault::Length | LineFault::Data => 207,
            LineFault::Form | LineFault::Unknown => 208,
            LineFault::Command if master => 214,
            LineFault::Command => 209,
            LineFault::Address => 210,
            LineFault::TimeOut => 211,
            LineFault::Station => 213,
            LineFault::Protocol => 202,
        }
    }
}
