//! Settings of the codecs that answer.

use super::computer_link::{self, Dialect};
use super::fx_port::{self, Space};
use super::link::Role;
use super::modbus::{self, Framing, Profile};
use super::wiring::{Ports, Protocol};

/// A port's partner is answered like this.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slave {
    /// The family of models.
    pub(super) family: Ports,
    /// Content of D8001.
    pub(super) type_code: u16,
    /// Own station number.
    pub(super) station: u16,
    /// The format word.
    pub(super) format: u16,
    /// Devices that the model serves as a Modbus slave.
    pub(super) profile: &'static Profile,
}

/// Types of H1U begin so (h1u-h2u-programming §8.3, D8001).
pub(super) const H1U: u16 = 26;

impl Protocol {
    /// Returns true if a port sends and receives frames by it, false if characters.
    pub const fn has_frames(self) -> bool {
        !matches!(self, Protocol::Free)
    }

    /// Returns true if silence ends its frames; those of others have an end.
    pub const fn ends_by_silence(self) -> bool {
        matches!(
            self,
            Protocol::ModbusRtu | Protocol::MasterRtu | Protocol::MasterTable
        )
    }
}

/// Role of a port on a link that PLCs maintain by themselves; `area` is the first register of HM's work area.
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
    /// Settings of a Modbus slave, by the registers.
    pub(super) fn modbus(&self, framing: Framing) -> modbus::Settings {
        modbus::Settings {
            framing,
            station: self.station,
            profile: self.profile,
        }
    }

    /// Returns true if the model answers QLink.
    pub(super) fn has_qlink(&self) -> bool {
        matches!(self.family, Ports::Inovance)
    }

    /// Maximum number of devices of a QLink block (h1u-h2u-programming §5.7.3).
    pub(super) fn qlink_devices(&self) -> u16 {
        if self.type_code / 1000 == H1U {
            50
        } else {
            120
        }
    }

    /// Settings of a computer link, by the model and the format word.
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
}

impl Ports {
    /// Devices that a model of the family serves as a Modbus slave; `type_code` is the content of its D8001.
    pub fn modbus(self, type_code: u16) -> &'static Profile {
        match self {
            Ports::Inovance if type_code / 1000 == H1U => &modbus::H1U,
            Ports::Inovance | Ports::Without => &modbus::H2U,
            Ports::L01s => &modbus::L01S,
            Ports::Hm => &modbus::HM,
            Ports::Fx | Ports::Fx3 | Ports::Fx3g | Ports::Board2n | Ports::Board3u => &modbus::FX3U,
        }
    }

    /// Settings of the programming port's protocol for a model of the family.
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
