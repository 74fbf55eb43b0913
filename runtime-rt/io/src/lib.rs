//! Drivers of connections that need a library: brokers (MQTT, at least once and by TLS) and serial lines of systems
//! other than Linux. The others are in [`rungc_host::io`], because emitted programs use them, too.
//!
//! The crate must not know source formats or the IR. Start reading at [`opener`].
#![deny(missing_docs)]

#[cfg(feature = "mqtt")]
mod mqtt;
pub mod ports;
mod rtu;
#[cfg(feature = "tls")]
mod tls;

use rungc_host::io::{Connection, Kind, Opener};

/// Returns the opener of a connection's other end.
///
/// # Errors
///
/// This system or this build has no driver for it.
pub fn opener(connection: &Connection) -> Result<Opener, String> {
    match connection.kind {
        #[cfg(feature = "mqtt")]
        Kind::Mqtt => mqtt::opener(connection),
        Kind::ModbusRtu => Ok(rtu::open),
        _ => rungc_host::io::opener(connection),
    }
}
