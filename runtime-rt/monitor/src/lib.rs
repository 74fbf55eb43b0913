//! Reads the devices of a running PLC over its ports, and writes none: there is no request here that would change
//! anything in a PLC.
//!
//! Start reading at [`Plc`]: a programming port ([`fx`]), an Ethernet module ([`mc`]) or a Modbus slave ([`modbus`]). A
//! [`Line`] carries the characters.

mod client;
pub mod fx;
pub mod mc;
pub mod modbus;
mod plan;

pub use client::{Client, Patience, Reply, number};

use rungc_rt::Class;
use std::collections::BTreeMap;
use std::io;
use std::time::Duration;

/// A line to a PLC.
pub trait Line {
    /// Name of the line for users: `/dev/ttyUSB0`, `tcp:10.0.0.5:5551`.
    fn name(&self) -> String;

    /// Sends all of the characters.
    ///
    /// # Errors
    /// The system's, or the line does not take them within `patience`.
    fn send(&mut self, bytes: &[u8], patience: Duration) -> io::Result<()>;

    /// Receives what has come; 0 characters if nothing has for a while.
    ///
    /// # Errors
    /// The system's, the other end has closed the line, or the user has interrupted the command.
    fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize>;
}

/// Failure to read a PLC.
#[derive(Debug, thiserror::Error)]
#[error("{line}: {why}")]
pub struct Error {
    /// Name of the line.
    pub line: String,
    /// Reason.
    pub why: String,
}

/// A value of a PLC.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Item {
    /// A bit: of a timer or counter its contact.
    Bit(Class, u32),
    /// A word: of a timer or counter its current value, which has 32 bits from C200 on.
    Word(Class, u32),
}

/// Values that were read one after another, while the PLC continued its scans.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Sample {
    /// The values; a bit is 0 or 1.
    pub values: BTreeMap<Item, i32>,
    /// Values that the port does not show.
    pub hidden: Vec<Item>,
}

impl Sample {
    /// Enters what the PLC has shown of a value.
    fn enter(&mut self, item: Item, value: Option<i32>) {
        match value {
            Some(value) => drop(self.values.insert(item, value)),
            None => self.hidden.push(item),
        }
    }

    /// Adds what a later look has shown.
    pub fn extend(&mut self, later: Sample) {
        self.values.extend(later.values);
        self.hidden.extend(later.hidden);
    }
}

/// A PLC that can be read.
pub enum Plc<L> {
    /// At its programming port.
    Port(fx::Plc<L>),
    /// By the MC protocol.
    Mc(mc::Plc<L>),
    /// As a Modbus slave.
    Modbus(modbus::Plc<L>),
}

impl<L: Line> Plc<L> {
    /// Reads values, neighbours in one request. What the PLC does not show is hidden.
    ///
    /// # Errors
    /// No answer, or none that is whole.
    pub fn read(&mut self, items: impl IntoIterator<Item = Item>) -> Result<Sample, Error> {
        match self {
            Plc::Port(plc) => plc.read(items),
            Plc::Mc(plc) => plc.read(items),
            Plc::Modbus(plc) => plc.read(items),
        }
    }

    /// Name for users.
    pub fn title(&self) -> String {
        match self {
            Plc::Port(plc) => plc.title(),
            Plc::Mc(_) | Plc::Modbus(_) => "a PLC".to_string(),
        }
    }
}
