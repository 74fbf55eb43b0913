//! Which codec answers under which protocol, and how it is set up.

use super::fx_port::{self, MonitorList, Space};
use super::modbus::{self, Framing, Profile};
use super::wiring::{Ports, Protocol};
use super::{Cut, Frame, LineFault, Map};

/// A port's partner is answered like this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slave {
    /// What the port speaks.
    pub(super) protocol: Protocol,
    /// The family of models.
    pub(super) family: Ports,
    /// What D8001 shows.
    pub(super) type_code: u16,
    /// Own station number.
    pub(super) station: u16,
    /// The format word.
    pub(super) format: u16,
}

/// Types of H1U begin so (h1u-h2u-programming §8.3, D8001).
const H1U: u16 = 26;

impl Protocol {
    /// Whether silence ends its frames; those of others have an end.
    pub(super) const fn ends_by_silence(self) -> bool {
        matches!(
            self,
            Protocol::ModbusRtu | Protocol::MasterRtu | Protocol::MasterTable
        )
    }
}

impl Slave {
    /// Whether the characters received so far are a frame.
    pub(super) fn cut(&self, received: &[u8]) -> Cut {
        match self.protocol {
            Protocol::ModbusAscii | Protocol::MasterAscii => modbus::cut_ascii(received),
            Protocol::ProgrammingPort => fx_port::cut(received),
            _ => Cut::Drop,
        }
    }

    /// Answers a frame.
    pub(super) fn answer(
        &self,
        request: &[u8],
        list: &mut MonitorList,
        map: &mut dyn Map,
        reply: &mut Frame,
    ) -> Result<(), LineFault> {
        match self.protocol {
            Protocol::ModbusRtu => self.modbus(Framing::Rtu, request, map, reply),
            Protocol::ModbusAscii => self.modbus(Framing::Ascii, request, map, reply),
            Protocol::ProgrammingPort => {
                let settings = self.family.programming_port();
                fx_port::answer(settings, list, request, map, reply)
            }
            _ => Ok(()),
        }
    }

    fn modbus(
        &self,
        framing: Framing,
        request: &[u8],
        map: &mut dyn Map,
        reply: &mut Frame,
    ) -> Result<(), LineFault> {
        let settings = modbus::Settings {
            framing,
            station: self.station,
            profile: self.profile(),
        };
        modbus::answer(&settings, request, map, reply)
    }

    /// What the model serves as a Modbus slave.
    pub(super) fn profile(&self) -> &'static Profile {
        self.family.modbus(self.type_code)
    }
}

impl Ports {
    /// What a model of the family serves as a Modbus slave; `type_code` is what its D8001 shows.
    pub fn modbus(self, type_code: u16) -> &'static Profile {
        match self {
            Ports::Inovance | Ports::Without if type_code / 1000 == H1U => &modbus::H1U,
            Ports::Inovance | Ports::Without => &modbus::H2U,
            Ports::L01s => &modbus::L01S,
            Ports::Hm => &modbus::HM,
            Ports::Fx | Ports::Board => &modbus::FX3U,
        }
    }

    /// What a model of the family makes of the programming port's protocol.
    pub fn programming_port(self) -> fx_port::Settings {
        fx_port::Settings {
            space: match self {
                Ports::L01s | Ports::Fx | Ports::Board => Space::Fx3,
                Ports::Without | Ports::Inovance | Ports::Hm => Space::Fx2n,
            },
            fx_relays: self != Ports::Hm,
        }
    }
}
