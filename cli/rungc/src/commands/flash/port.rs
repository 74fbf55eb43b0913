//! A serial line to a boot loader.

use crate::commands::run::lines::wire::{self, Wire};
use crate::commands::{Failure, eprint_line, interruption};
use rungc_firmware::flash::loader::Line;
use rungc_project::serve::LineEnd;
use rungc_rt::comm::{LineFormat, Parity};
use std::io;
use std::time::Duration;

/// Time-out of the line for the longest message.
const SENDING: Duration = Duration::from_secs(5);

/// Names how many times as long as usual an answer is waited for: on a machine that has no time for the other end.
const PATIENCE: &str = "RUNGC_PATIENCE";

/// An open line.
pub struct Port {
    wire: Wire,
    patience: u8,
}

impl Port {
    /// Opens a line with the format of the boot loader: AN3155 §1, 8 data bits, even parity, 1 stop bit.
    pub fn open(end: &LineEnd, baud: u32) -> Result<Self, Failure> {
        let wire = wire::open(end);
        let mut wire = wire.map_err(|error| Failure::Because(wire::cannot_open(end, &error)))?;
        let format = LineFormat {
            bits_per_second: baud,
            data_bits: 8,
            parity: Parity::Even,
            ..LineFormat::new()
        };
        if let Err(error) = wire.set_format(format) {
            // A pseudo-terminal has no parity, and needs none.
            eprint_line(&format!(
                "rungc: {end} cannot be set to {baud} bit/s, 8 data bits, even parity: {error}"
            ));
        }
        let patience = std::env::var(PATIENCE).ok();
        Ok(Port {
            wire,
            patience: patience.and_then(|times| times.parse().ok()).unwrap_or(1),
        })
    }
}

impl Line for Port {
    fn may_continue(&mut self) -> io::Result<()> {
        match interruption::is_requested() {
            true => Err(io::Error::new(io::ErrorKind::Interrupted, "interrupted")),
            false => Ok(()),
        }
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.wire.send(bytes, SENDING)
    }

    fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.wire.receive(buffer)
    }

    fn patience(&self, usual: Duration) -> Duration {
        usual * u32::from(self.patience)
    }
}
