//! Remote I/O on a serial line of any system.

use crate::ports;
use rungc_host::io::{Connection, Driver, Rtu, SerialLine};
use serial2::{CharSize, Parity, SerialPort, StopBits};
use std::io;
use std::time::Duration;

/// A serial line of this machine.
struct Line(SerialPort);

/// Opens the line of a connection.
pub fn open(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let baud = connection.baud()?;
    let (parity, stop) = connection.format()?;
    let port = SerialPort::open(&connection.end, |mut settings: serial2::Settings| {
        settings.set_raw();
        settings.set_baud_rate(baud)?;
        settings.set_char_size(CharSize::Bits8);
        settings.set_parity(match parity {
            'E' => Parity::Even,
            'O' => Parity::Odd,
            _ => Parity::None,
        });
        settings.set_stop_bits(match stop {
            2 => StopBits::Two,
            _ => StopBits::One,
        });
        Ok(settings)
    });
    let mut port = port.map_err(|error| ports::cannot_open(&error))?;
    let timeout = Duration::from_millis(connection.timeout_ms);
    port.set_write_timeout(timeout)
        .map_err(|error| error.to_string())?;
    Rtu::driver(Line(port), connection)
}

impl SerialLine for Line {
    fn discard(&mut self) -> io::Result<()> {
        self.0.discard_input_buffer()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.0.set_read_timeout(wait)?;
        self.0.read(bytes)
    }
}
