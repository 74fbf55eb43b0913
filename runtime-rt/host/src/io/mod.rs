//! The terminals and registers of a PLC that runs on a computer: what they are connected to.
//!
//! A [`Connection`] is what `[io.NAME]` of `rungc.toml` describes. Each has a thread, which exchanges values with the
//! other end in separate cycles; the scan takes and leaves values between two of its scans and never waits for a
//! thread ([`Io`]). While an end cannot be reached, the scan continues: a fault device is on, inputs have the values
//! that the description chooses, and the thread tries again.
//!
//! | file | what |
//! |---|---|
//! | `settings.rs` | connections from their keys and values |
//! | `overlap.rs` | rows that contradict each other |
//! | `text.rs` | the same from a file, for hosts without a library for TOML |
//! | `cycle.rs` | threads, and what they share with the scan |
//! | `modbus.rs` | remote I/O over Modbus: the requests, and TCP |
//! | `rtu.rs` | the same on a serial line |
//! | `mqtt.rs` | brokers, by a client of QoS 0 |
//! | `topics.rs`, `json.rs` | topics and payloads of brokers, by any client |
//! | `gpio.rs` | pins (Linux) |
//! | `files.rs` | files, standard input and output |
//! | `left_out.rs` | reports of input that fits no device |
//! | `sys.rs` | serial ports, and the calls of Linux that the standard library does not have |
//! | `no_serial.rs` | the same ports on other systems: none |
//! | `host.rs`, `log.rs` | what `--io` and `--log` of an executable do |

mod cycle;
mod files;
#[cfg(target_os = "linux")]
mod gpio;
mod host;
mod json;
mod left_out;
mod log;
mod modbus;
mod mqtt;
#[cfg(not(target_os = "linux"))]
mod no_serial;
mod overlap;
mod ports;
mod rtu;
mod settings;
#[cfg(target_os = "linux")]
#[allow(unsafe_code, reason = "ioctl and poll take pointers")]
mod sys;
#[cfg(test)]
mod tests;
mod text;
mod topics;

pub use cycle::{Driver, ExchangeError, GiveRow, Io, Of, Opener, TakeRow, Terminals};
pub use files::holds_numbers;
pub use host::Environment;
pub use left_out::LeftOut;
pub use log::timestamp;
pub use modbus::{Remote, Wire};
#[cfg(not(target_os = "linux"))]
pub use no_serial::SerialPort;
pub use overlap::{Overlap, overlap};
pub use ports::cannot_open;
pub use rtu::{Rtu, SerialLine, silence};
pub use settings::{Connection, End, Kind, Loss, Place, Row, SettingError, Table};
#[cfg(target_os = "linux")]
pub use sys::SerialPort;
pub use text::parse;
pub use topics::{LONGEST_PACKET, TOO_LONG, Topic, address, password, take, topics};

/// The driver of a connection that needs nothing but the standard library and the system.
///
/// # Errors
/// This system has none, or only rungc does.
pub fn opener(connection: &Connection) -> Result<Opener, String> {
    match connection.kind {
        Kind::ModbusTcp => Ok(modbus::open_tcp),
        Kind::Files => Ok(files::open_folder),
        Kind::Console => Ok(files::open_console),
        Kind::Mqtt => match connection.is_encrypted() {
            true => Err(String::from(
                "this program has no TLS; connect to a broker on this machine that forwards to the other (`rungc book linux`)",
            )),
            false => Ok(mqtt::open),
        },
        #[cfg(target_os = "linux")]
        Kind::ModbusRtu => Ok(sys::open_line),
        #[cfg(target_os = "linux")]
        Kind::Gpio => Ok(gpio::open),
        #[cfg(not(target_os = "linux"))]
        kind => Err(std::format!("`{}` exists only on Linux", kind.key())),
    }
}
