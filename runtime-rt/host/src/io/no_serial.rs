//! Serial ports of systems other than Linux: none.

use rungc_rt::comm::LineFormat;
use std::io::{self, ErrorKind};

/// A serial port, of which there is none.
#[derive(Debug)]
pub enum SerialPort {}

impl SerialPort {
    /// Reports that there is none.
    ///
    /// # Errors
    /// Always.
    pub fn open(_path: &str) -> io::Result<SerialPort> {
        let why = "executables in Rust have serial lines only on Linux; `rungc run` has them here";
        Err(io::Error::new(ErrorKind::Unsupported, why))
    }

    /// Sets up the format of characters.
    ///
    /// # Errors
    /// None.
    pub fn set_format(&self, _format: LineFormat) -> io::Result<()> {
        match *self {}
    }

    /// One more handle of the port.
    ///
    /// # Errors
    /// None.
    pub fn try_clone(&self) -> io::Result<SerialPort> {
        match *self {}
    }

    /// Waits until characters have come.
    ///
    /// # Errors
    /// None.
    pub fn receive(&mut self, _bytes: &mut [u8]) -> io::Result<usize> {
        match *self {}
    }

    /// Sends characters.
    ///
    /// # Errors
    /// None.
    pub fn send(&mut self, _bytes: &[u8]) -> io::Result<usize> {
        match *self {}
    }
}
