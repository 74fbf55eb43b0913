//! Which codec answers under which protocol, and how it is set up.

use super::computer_link::{self, Dialect, Remote};
use super::fx_port::{self, Space};
use super::link::Role;
use super::modbus::{self, Framing, Profile};
use super::wiring::{Ports, Protocol};
use super::{Cut, Frame, LineFault, Map, Memory, can, qlink};

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
    pub const fn ends_by_silence(self) -> bool {
        matches!(
            self,
            Protocol::ModbusRtu | Protocol::MasterRtu | Protocol::MasterTable
        )
    }
}

/// What a port is on a link that PLCs keep up by themselves; `area` is the first register of HM's work area.
pub(super) fn role(protocol: Protocol, area: u16) -> Option<Role> {
    Some(match protocol {
        Protocol::ParallelMaster => Role::ParallelMaster,
        Protocol::ParallelSlave => Role::ParallelSlave,
        Protocol::NnMaster => Role::NnMaster { enhanced: false },
        Protocol::NnSlave => Role::NnSlave { enhanced: false },
        Protocol::EnhancedMaster => Role::NnMaster { enhanced: true },
        Protocol::EnhancedSlave => Role::NnSlave { enhanced: true },
        Protocol::ComputerLinkMaster => Role::ComputerLinkMaster { area },
        _ => return None,
    })
}

impl Slave {
    /// Whether the characters received so far are a frame.
    pub(super) fn cut(&self, received: &[u8]) -> Cut {
        match self.protocol {
            Protocol::ModbusAscii | Protocol::MasterAscii => modbus::cut_ascii(received),
            Protocol::ProgrammingPort => fx_port::cut(received),
            Protocol::Can => can::cut(received),
            Protocol::ComputerLink => computer_link::cut(self.computer_link(), received),
            _ => Cut::Drop,
        }
    }

    /// Answers a frame.
    pub(super) fn answer(
        &self,
        request: &[u8],
        memory: &mut Memory,
        remote: &mut Remote,
        map: &mut dyn Map,
        reply: &mut Frame,
    ) -> Result<(), LineFault> {
        match self.protocol {
            Protocol::ModbusRtu if self.has_qlink() && qlink::is_qlink(request) => {
                let settings = self.modbus_settings(Framing::Rtu);
                qlink::answer(&settings, self.qlink_devices(), memory, request, map, reply)
            }
            Protocol::ModbusRtu => self.modbus(Framing::Rtu, request, map, reply),
            Protocol::ModbusAscii => self.modbus(Framing::Ascii, request, map, reply),
            Protocol::ProgrammingPort => {
                let settings = self.family.programming_port();
                fx_port::answer(settings, memory, request, map, reply)
            }
            Protocol::ComputerLink => {
                let settings = self.computer_link();
                computer_link::answer(settings, remote, request, map, reply)
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
        modbus::answer(&self.modbus_settings(framing), request, map, reply)
    }

    fn modbus_settings(&self, framing: Framing) -> modbus::Settings {
        modbus::Settings {
            framing,
            station: self.station,
            profile: self.profile(),
        }
    }

    fn has_qlink(&self) -> bool {
        matches!(self.family, Ports::Inovance)
    }

    /// Most devices of a QLink block (h1u-h2u-programming §5.7.3).
    fn qlink_devices(&self) -> u16 {
        if self.type_code / 1000 == H1U {
            50
        } else {
            120
        }
    }

    /// What the model and the format word make of a computer link.
    pub(super) fn computer_link(&self) -> computer_link::Settings {
        const SUM: u16 = 1 << 13;
        const CR_LF: u16 = 1 << 15;
        let is_hm = self.family == Ports::Hm;
        computer_link::Settings {
            // A number that is not a station does not occur in a frame.
            station: u8::try_from(self.station).unwrap_or(u8::MAX),
            sum: is_hm || self.format & SUM != 0,
            crlf: !is_hm && self.format & CR_LF != 0,
            dialect: match self.family {
                Ports::Hm => Dialect::Hm,
                Ports::L01s => Dialect::Fx(*b"F4"),
                _ => Dialect::Fx(*b"9D"),
            },
        }
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
            Ports::Fx | Ports::Fx3 | Ports::Fx3g | Ports::Board2n | Ports::Board3u => &modbus::FX3U,
        }
    }

    /// What a model of the family makes of the programming port's protocol.
    pub fn programming_port(self) -> fx_port::Settings {
        fx_port::Settings {
            space: match self {
                Ports::L01s | Ports::Fx3 | Ports::Fx3g | Ports::Board3u => Space::Fx3,
                Ports::Without | Ports::Inovance | Ports::Hm | Ports::Fx | Ports::Board2n => {
                    Space::Fx2n
                }
            },
            fx_relays: self != Ports::Hm,
        }
    }
}
