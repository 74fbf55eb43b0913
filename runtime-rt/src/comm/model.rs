//! What a model's serial ports are: their special devices, and what it serves as a Modbus slave. A program links that of its model.

use super::modbus::{self, Profile};
use super::wiring::{PortWiring, Ports};

/// The serial ports of a model.
#[derive(Debug)]
pub struct PortModel {
    /// Its name in emitted code.
    name: &'static str,
    pub(super) wiring: &'static [PortWiring],
    pub(super) profile: &'static Profile,
}

impl PortModel {
    const fn new(name: &'static str, family: Ports, profile: &'static Profile) -> Self {
        PortModel {
            name,
            wiring: family.all(),
            profile,
        }
    }

    /// That of a model of the family; `type_code` is what its D8001 shows.
    pub fn of(family: Ports, type_code: u16) -> &'static Self {
        match family {
            Ports::Inovance | Ports::Without if type_code / 1000 == super::slaves::H1U => &H1U,
            Ports::Inovance | Ports::Without => &H2U,
            Ports::L01s => &L01S,
            Ports::Hm => &HM,
            Ports::Fx => &FX,
            Ports::Fx3 => &FX3,
            Ports::Fx3g => &FX3G,
            Ports::Board2n => &BOARD_2N,
            Ports::Board3u => &BOARD_3U,
        }
    }

    /// Its name in emitted code, in small letters.
    pub const fn name(&self) -> &'static str {
        self.name
    }
}

/// H1U.
pub const H1U: PortModel = PortModel::new("h1u", Ports::Inovance, &modbus::H1U);
/// H2U.
pub const H2U: PortModel = PortModel::new("h2u", Ports::Inovance, &modbus::H2U);
/// L01S.
pub const L01S: PortModel = PortModel::new("l01s", Ports::L01s, &modbus::L01S);
/// HM.
pub const HM: PortModel = PortModel::new("hm", Ports::Hm, &modbus::HM);
/// FX1S, FX1N, FX2N.
pub const FX: PortModel = PortModel::new("fx", Ports::Fx, &modbus::FX3U);
/// FX3S, FX3U.
pub const FX3: PortModel = PortModel::new("fx3", Ports::Fx3, &modbus::FX3U);
/// FX3G.
pub const FX3G: PortModel = PortModel::new("fx3g", Ports::Fx3g, &modbus::FX3U);
/// Boards that are compatible with FX2N.
pub const BOARD_2N: PortModel = PortModel::new("board_2n", Ports::Board2n, &modbus::FX3U);
/// Boards that are compatible with FX3U.
pub const BOARD_3U: PortModel = PortModel::new("board_3u", Ports::Board3u, &modbus::FX3U);

/// All of them.
pub const ALL: &[&PortModel] = &[
    &H1U, &H2U, &L01S, &HM, &FX, &FX3, &FX3G, &BOARD_2N, &BOARD_3U,
];
