//! Sets of protocols: what a port may speak, and how much memory that takes.

use super::memory::Memory;
use super::modbus::LONGEST_RTU;
use super::parts::{Progress, Status};
use super::port::FRAME;
use super::wiring::Protocol;

/// A set of protocols.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Protocols(u32);

impl Protocols {
    /// None.
    pub const NONE: Self = Protocols(0);

    /// QLink, which slaves by Modbus RTU of H1U and H2U also answer.
    pub const QLINK: Self = Protocols(1 << 31);

    /// CANlink, on the CAN card of a program that is a station of it.
    pub const CANLINK: Self = Protocols(1 << 30);

    /// Those of links that PLCs keep up by themselves.
    pub const LINKS: Self = Protocols::of(&[
        Protocol::ComputerLinkMaster,
        Protocol::ParallelMaster,
        Protocol::ParallelSlave,
        Protocol::NnMaster,
        Protocol::NnSlave,
        Protocol::EnhancedMaster,
        Protocol::EnhancedSlave,
    ]);

    /// Protocols that need the Modbus profile of a model.
    pub const MODBUS: Self = Protocols::of(&[
        Protocol::ModbusRtu,
        Protocol::ModbusAscii,
        Protocol::MasterRtu,
        Protocol::MasterAscii,
        Protocol::MasterTable,
    ])
    .or(Self::QLINK);

    /// Protocols with state between frames.
    const WITH_MEMORY: Self = Protocols::of(&[Protocol::ProgrammingPort])
        .or(Self::QLINK)
        .or(Self::CANLINK);

    /// Protocols that do more than answer, and so have progress between two calls.
    const WITH_PROGRESS: Self = Protocols::of(&[
        Protocol::Free,
        Protocol::MasterRtu,
        Protocol::MasterAscii,
        Protocol::MasterTable,
        Protocol::Can,
    ])
    .or(Self::LINKS);

    /// Those whose longest frame is that of Modbus RTU, or shorter, or that have no frames.
    const SHORT: Self = Protocols::of(&[
        Protocol::Off,
        Protocol::Free,
        Protocol::ModbusRtu,
        Protocol::MasterRtu,
        Protocol::MasterTable,
        Protocol::Can,
    ]);

    /// All that registers may choose.
    pub const ALL: Self = Protocols(!Self::CANLINK.0);

    /// The set of these.
    pub const fn of(protocols: &[Protocol]) -> Self {
        let mut set = 0;
        let mut i = 0;
        while i < protocols.len() {
            set |= 1 << protocols[i] as u32;
            i += 1;
        }
        Protocols(set)
    }

    /// This set and another.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Protocols(self.0 | other.0)
    }

    /// This set without another.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Protocols(self.0 & !other.0)
    }

    /// Returns true if it has a protocol in common with another.
    pub const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Returns true if it contains a protocol.
    pub const fn contains(self, protocol: Protocol) -> bool {
        self.0 & 1 << protocol as u32 != 0
    }

    /// Characters of the longest frame.
    pub const fn longest_frame(self) -> usize {
        match self.0 & !Self::SHORT.or(Self::CANLINK).0 {
            0 => LONGEST_RTU,
            _ => FRAME,
        }
    }

    /// Returns true if one of them has state between frames ([`super::Memory`]).
    pub const fn keeps_memory(self) -> bool {
        self.meets(Self::WITH_MEMORY)
    }

    /// Returns true if one of them does more than answer ([`Progress`]).
    pub const fn has_progress(self) -> bool {
        self.meets(Self::WITH_PROGRESS)
    }

    /// Bytes of a port that speaks them in a program's memory.
    pub const fn port_size(self) -> usize {
        let progress = match self.has_progress() {
            true => size_of::<Progress>(),
            false => 0,
        };
        let memory = match self.keeps_memory() {
            true => size_of::<Memory>(),
            false => 0,
        };
        size_of::<Status>() + progress + self.longest_frame() + memory
    }
}

impl FromIterator<Protocol> for Protocols {
    fn from_iter<T: IntoIterator<Item = Protocol>>(protocols: T) -> Self {
        let sets = protocols
            .into_iter()
            .map(|protocol| Protocols::of(&[protocol]));
        sets.fold(Protocols::NONE, Protocols::or)
    }
}
