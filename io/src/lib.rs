//! Drivers of connections that need a library: brokers (MQTT), serial lines (Modbus RTU), pins (GPIO of Linux). Those
//! that need nothing but the standard library are the runtime's ([`rungc_rt::io`]), because emitted programs use them,
//! too.
//!
//! The crate must not know source formats or the IR. Start reading at [`opener`].
#![deny(missing_docs)]

#[cfg(target_os = "linux")]
mod gpio;
#[cfg(feature = "mqtt")]
mod mqtt;
mod rtu;

use rungc_rt::io::{Kind, Opener};

/// What opens the other end of a connection; `None` for a kind that this system or this build has no driver for.
pub fn opener(kind: Kind) -> Option<Opener> {
    match kind {
        #[cfg(target_os = "linux")]
        Kind::Gpio => Some(gpio::open),
        #[cfg(feature = "mqtt")]
        Kind::Mqtt => Some(mqtt::open),
        Kind::ModbusRtu => Some(rtu::open),
        kind => rungc_rt::io::opener(kind),
    }
}
