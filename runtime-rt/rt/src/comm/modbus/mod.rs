//! Modbus: slaves and masters over RTU and ASCII lines, slaves over TCP.
//!
//! What the manuals leave to the public standard, to which they refer, follows "MODBUS application protocol" 1.1b3 and
//! "MODBUS over serial line" 1.02. Choices where both are silent:
//!
//! * The low word of a 32-bit counter comes first, as that of a pair of registers does.
//! * A broadcast (station 0) is carried out if it writes, and never answered.
//! * What a frame may not write (inputs; on H1U and H2U C200 and up by function 06) is rejected as an address,
//!   exception 02.
//! * A request whose length does not fit its function is rejected with exception 03.
//! * A TCP server answers to the units 0, 1 and 255; another unit is a path that is not there, exception 0A.
//!
//! | file | what |
//! |---|---|
//! | `check.rs` | CRC-16 |
//! | `adu.rs` | frames: RTU, ASCII, TCP |
//! | `areas.rs` | address tables and limits of each model |
//! | `slave.rs`, `tcp.rs` | answers |
//! | `master.rs` | requests, and what answers mean |
//! | `client.rs` | a client over TCP, and the table of what it asks |
//! | `diagnosis.rs` | those of FX3's ADPRW beyond reading and writing |
//! | `exchange.rs` | one exchange after the other on a port, and whose turn it is |

mod adu;
mod areas;
mod check;
pub mod client;
mod diagnosis;
mod exchange;
mod master;
#[cfg(test)]
mod oracle_tests;
mod slave;
#[cfg(test)]
mod storm_tests;
pub mod tcp;

pub use adu::{Framing, LONGEST_ASCII, LONGEST_RTU, cut_ascii};
pub(super) use areas::place;
pub use areas::{ALL, Area, FX3U, Fill, H1U, H2U, HM, L01S, Limits, NOTHING, Place};
pub use check::{CRC_START, crc_step, crc16};
pub use exchange::{End, Exchange, Visit};
pub use master::{Buffer, Job, Layout, accept, refusal, request};
pub use slave::{Settings, answer};
pub(super) use slave::{answer_ascii, answer_rtu};

use super::LineFault;

/// Devices that a model serves as a slave.
#[derive(Clone, Copy, Debug)]
pub struct Profile {
    /// Its name in emitted code, in small letters.
    pub name: &'static str,
    /// Areas that 01 reads, 05 and 0F write.
    pub coils: &'static [Area],
    /// Areas that 02 reads.
    pub inputs: &'static [Area],
    /// Areas that 03 reads, 06 and 10 write.
    pub registers: &'static [Area],
    /// Areas that 04 reads.
    pub input_registers: &'static [Area],
    /// Limits of one frame.
    pub limits: Limits,
    /// True if 05 accepts any value but 0 for on, rather than FF00h alone.
    pub any_value_is_on: bool,
    /// Bytes of the shortest request as an RTU frame, which H1U and H2U say is one of five (h1u-h2u-programming §8.1,
    /// 63x1).
    pub shortest: usize,
    /// True if 06 writes half of a 32-bit counter.
    pub counters_by_06: bool,
}

/// Function codes.
mod function {
    pub const READ_COILS: u8 = 0x01;
    pub const READ_INPUTS: u8 = 0x02;
    pub const READ_REGISTERS: u8 = 0x03;
    pub const READ_INPUT_REGISTERS: u8 = 0x04;
    pub const WRITE_COIL: u8 = 0x05;
    pub const WRITE_REGISTER: u8 = 0x06;
    pub const WRITE_COILS: u8 = 0x0f;
    pub const WRITE_REGISTERS: u8 = 0x10;
    /// Marks an answer as a refusal.
    pub const REFUSED: u8 = 0x80;
}

/// Value that 05 sends to switch on.
const COIL_ON: u16 = 0xff00;

/// Reason why a slave rejects a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Exception {
    /// 01: a function that it does not know.
    Function,
    /// 02: an address at which there is nothing.
    Address,
    /// 03: a quantity, a length or a value.
    Value,
    /// 04 and all others: it cannot.
    Other(u8),
}

impl Exception {
    /// 0A: a gateway has no path to the unit.
    const NO_PATH: Self = Exception::Other(0x0a);

    fn code(self) -> u8 {
        match self {
            Exception::Function => 1,
            Exception::Address => 2,
            Exception::Value => 3,
            Exception::Other(code) => code,
        }
    }

    fn from_code(code: u8) -> Self {
        match code {
            1 => Exception::Function,
            2 => Exception::Address,
            3 => Exception::Value,
            _ => Exception::Other(code),
        }
    }

    /// Fault that a port records for it (h1u-h2u-programming §8.1: "standard error frame").
    fn fault(self) -> LineFault {
        match self {
            Exception::Function => LineFault::Command,
            Exception::Address => LineFault::Address,
            Exception::Value => LineFault::Data,
            Exception::Other(_) => LineFault::Form,
        }
    }
}
