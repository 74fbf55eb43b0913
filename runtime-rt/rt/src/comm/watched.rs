//! Devices for the tests of codecs, which notice what a frame does to them.

use super::{Frame, LineFault, Map};
use crate::double::Double;
use crate::plc::{Class, Plc};
use std::string::String;
use std::vec::Vec;

/// The devices of a [`Double`] as a codec sees them.
pub(super) struct Watched {
    /// The devices.
    pub(super) plc: Double,
    /// Number of devices written.
    pub(super) writes: usize,
    /// Number of writes to devices that do not exist.
    pub(super) strays: usize,
    /// Last request for the RUN/STOP switch.
    pub(super) request: Option<bool>,
    /// Content of D8001.
    pub(super) type_code: u16,
    /// Program memory, if partners may read it.
    pub(super) program: Option<Vec<u8>>,
}

impl Watched {
    /// An H2U in RUN, everything 0.
    pub(super) fn new() -> Self {
        Self::of(Double::new())
    }

    /// These devices.
    pub(super) fn of(plc: Double) -> Self {
        Watched {
            plc,
            writes: 0,
            strays: 0,
            request: None,
            type_code: 24120,
            program: None,
        }
    }

    fn wrote(&mut self, done: Option<()>) -> Option<()> {
        match done {
            Some(()) => self.writes += 1,
            None => self.strays += 1,
        }
        done
    }
}

impl Map for Watched {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        self.plc.bit(class, number)
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        let done = self.plc.set_bit(class, number, value);
        self.wrote(done)
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        self.plc.word(class, number)
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        let done = self.plc.set_word(class, number, value);
        self.wrote(done)
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.plc.counter32(number)
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        let done = self.plc.set_counter32(number, value);
        self.wrote(done)
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        let done = self.plc.reset(class, number);
        self.wrote(done)
    }

    fn running(&self) -> bool {
        self.plc.sys.running
    }

    fn request_running(&mut self, running: bool) {
        self.request = Some(running);
        self.plc.sys.running = running;
    }

    fn type_code(&self) -> u16 {
        self.type_code
    }

    fn program_byte(&self, offset: u32) -> Option<u8> {
        let program = self.program.as_ref()?;
        Some(program.get(offset as usize).copied().unwrap_or(0xff))
    }
}

/// The bytes that a text of hexadecimal pairs names.
pub(super) fn bytes(hex: &str) -> Vec<u8> {
    hex.split_whitespace()
        .map(|pair| u8::from_str_radix(pair, 16).unwrap())
        .collect()
}

/// A text of hexadecimal pairs.
pub(super) fn hex(bytes: &[u8]) -> String {
    let pairs: Vec<String> = bytes.iter().map(|b| std::format!("{b:02X}")).collect();
    pairs.join(" ")
}

/// Contents of a frame of 1024 characters that a codec fills, and the fault that it reports.
pub(super) fn reply_of(
    codec: impl FnOnce(&mut Frame) -> Result<(), LineFault>,
) -> (Vec<u8>, Result<(), LineFault>) {
    let mut buffer = [0; 1024];
    let mut frame = Frame::new(&mut buffer);
    let outcome = codec(&mut frame);
    assert!(!frame.overflows());
    (frame.as_slice().to_vec(), outcome)
}
