//! The terminals and registers of a PLC that runs on a computer: what they are connected to. For hosts with a standard
//! library (feature `std`).
//!
//! A [`Connection`] is what `[io.NAME]` of `rungc.toml` describes. Each has a thread, which exchanges values with the
//! other end in separate cycles; the scan takes and leaves values between two of its scans and never waits for a
//! thread ([`Io`]). While an end cannot be reached, the scan continues: a fault device is on, inputs have the values
//! that the description chooses, and the thread tries again.
//!
//! | file | what |
//! |---|---|
//! | `settings.rs` | connections from their keys and values |
//! | `text.rs` | the same from a file, for hosts without a library for TOML |
//! | `cycle.rs` | threads, and what they share with the scan |
//! | `modbus.rs` | remote I/O over Modbus: the requests, and TCP |
//! | `files.rs` | files, standard input and output |

mod cycle;
mod files;
mod modbus;
mod settings;
#[cfg(test)]
mod tests;
mod text;

pub use cycle::{Driver, Io, Opener, Trouble};
pub use modbus::{Remote, Wire};
pub use settings::{Connection, End, Kind, Loss, Mistake, Place, Row, Table, overlap, time};
pub use text::parse;

/// The drivers that need nothing but the standard library.
pub fn opener(kind: Kind) -> Option<Opener> {
    match kind {
        Kind::ModbusTcp => Some(modbus::open_tcp),
        Kind::Files => Some(files::open_folder),
        Kind::Console => Some(files::open_console),
        Kind::ModbusRtu | Kind::Mqtt | Kind::Gpio => None,
    }
}
