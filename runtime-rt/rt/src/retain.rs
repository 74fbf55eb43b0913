//! Latched devices that survive: what a program keeps over power-off, saved to flash or to a file and loaded when it
//! starts.
//!
//! A *record* holds the values of all latched devices, with the program's name, a sequence number and a checksum
//! (`record.rs` has the format). [`Slots`] writes records to two slots of flash, each an erasable run of it: record
//! after record into one slot until that is full, then the other slot is erased and takes the next. So power may fail
//! at any time: the newest complete record is either the one being written or the one before it, never a mix of both.
//! Where there are files, `rungc_host::retain::RetainFile` keeps a record in one.
//!
//! # Wear
//!
//! A part that allows N erasures takes N · [`Slots::saves_per_erasure`] · 2 saves. [`Slots::poll`] saves at most once
//! in an interval, and only if a latched device has changed.

mod parts;
pub mod record;
mod slots;
#[cfg(test)]
mod tests;

pub use parts::{Ram, Registers, Stm32f1, Stm32f4, f4_sectors};
pub use slots::{Flash, FlashFailed, Slots};

use crate::plc::Class;

/// Devices of consecutive numbers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RetainedRun {
    /// Their class.
    pub class: Class,
    /// The first number.
    pub first: u16,
    /// Number of devices.
    pub count: u16,
}

impl RetainedRun {
    /// `count` devices from a number on.
    pub const fn new(class: Class, first: u16, count: u16) -> Self {
        RetainedRun {
            class,
            first,
            count,
        }
    }
}

/// Data that a program retains over power-off.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Retained<'a> {
    /// The program and its model, as in `motor (fx3u)`: records of another program are not loaded. At most
    /// [`OWNER_MAX`] bytes.
    pub program: &'a str,
    /// Its latched devices; empty if there are none.
    pub runs: &'a [RetainedRun],
    /// True if the contacts of timers and counters are retained with their values.
    pub contacts: bool,
    /// On models with a latch key: the register D and what it must hold when power fails; else latched devices are
    /// lost.
    pub key: Option<(u32, i16)>,
}

impl Retained<'_> {
    /// Of a program that keeps nothing.
    pub const NOTHING: Retained<'static> = Retained {
        program: "",
        runs: &[],
        contacts: true,
        key: None,
    };

    /// Returns true if a device is among them.
    pub fn contains(&self, class: Class, number: u32) -> bool {
        self.runs.iter().any(|run| {
            let first = u32::from(run.first);
            run.class == class && (first..first + u32::from(run.count)).contains(&number)
        })
    }

    /// Length of a record of them, in bytes.
    pub fn record_len(&self) -> u32 {
        record::length(self)
    }
}

/// The longest name of a program in a record, in bytes.
pub const OWNER_MAX: usize = 47;

/// The program that a record belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Owner {
    bytes: [u8; OWNER_MAX],
    length: u8,
}

impl Owner {
    /// Its name and model, as in `motor (fx3u)`.
    pub fn as_str(&self) -> &str {
        let bytes = self.bytes.get(..usize::from(self.length));
        bytes
            .and_then(|bytes| core::str::from_utf8(bytes).ok())
            .unwrap_or("?")
    }
}

/// Result of loading.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Loaded {
    /// Nothing was saved yet: latched devices are as the PLC leaves the factory.
    Nothing,
    /// The saved devices are those of another program, and none was loaded.
    Foreign(Owner),
    /// The program's latched devices have their values again.
    Restored {
        /// Number of devices of the record that this version of the program does not retain; their values are gone with
        /// the next save.
        dropped: u32,
    },
}
