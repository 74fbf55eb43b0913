//! A serial line to a boot loader.

use crate::commands::run::lines::wire::{self, Wire};
use crate::commands::{Failure, interruption, tell};
use rungc_firmware::flash::loader::Line;
use rungc_project::serve::LineEnd;
use rungc_rt::comm::{LineFormat, Parity};
use std::io;
use std::time::Duration;

/// Time-out of the line for the longest message.
const SENDING: Duration = Duration::from_secs(5);

/// An open line.
pub struct Port(Wire);

impl Port {
    /// Opens a line with the format of the boot loader: AN3155 §1, 8 data bits, even parity, 1 stop bit.
    pub fn open(end: &LineEnd, baud: u32) -> Result<Self, Failure> {
        let wire = wire::open(end);
        let mut wire =
            wire.map_err(|error| Failure::Because(format!("cannot open {end}: {error}")))?;
        let format = LineFormat {
            bits_per_second: baud,
            data_bits: 8,
            parity: Parity::Even,
            ..LineFormat::new()
        };
        if let Err(error) = wire.set_format(format) {
            // A pseudo-terminal has no parity, and needs none.
            tell(&format!(
                "rungc: {end} cannot be set to {baud} bit/s, 8 data bits, even parity: {error}"
            ));
        }
        Ok(Port(wire))
    }
}

impl Line for Port {
    fn may_continue(&mut self) -> io::Result<()> {
        match interruption::is_asked() {
            true => Err(io::Error::new(io::ErrorKind::Interrupted, "interrupted")),
            false => Ok(()),
        }
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.send(bytes, SENDING)
    }

    fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.receive(buffer)
    }
}
