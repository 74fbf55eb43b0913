//! Remote I/O on a serial line: Modbus RTU.

use rungc_rt::io::{Connection, Driver, Remote, Wire};
use serial2::{CharSize, Parity, SerialPort, StopBits};
use std::io::{self, ErrorKind};
use std::thread;
use std::time::{Duration, Instant};

/// Bits of a character on the line: start, data, parity or a second stop bit, stop.
const CHARACTER: u32 = 11;

/// From this rate on, the silence between frames no longer shrinks ("MODBUS over serial line" 1.02 §2.5.1.1).
const FAST: u32 = 19_200;

/// The silence between frames then.
const LEAST_SILENCE: Duration = Duration::from_micros(1750);

/// The longest frame.
const LONGEST: usize = 256;

/// A serial line to slaves.
struct Line {
    port: SerialPort,
    timeout: Duration,
    /// The silence before a request.
    silence: Duration,
}

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
    let mut port = port.map_err(|error| error.to_string())?;
    let timeout = Duration::from_millis(connection.timeout_ms);
    port.set_write_timeout(timeout)
        .map_err(|error| error.to_string())?;
    let characters = Duration::from_secs(1) * CHARACTER * 7 / 2 / baud;
    let line = Line {
        port,
        timeout,
        silence: if baud > FAST {
            LEAST_SILENCE
        } else {
            characters
        },
    };
    Ok(Box::new(Remote::new(line, connection)?))
}

impl Wire for Line {
    fn ask(&mut self, request: &[u8]) -> io::Result<Vec<u8>> {
        thread::sleep(self.silence);
        // What is left of an answer that came too late belongs to no request.
        self.port.discard_input_buffer()?;
        self.port.write_all(request)?;
        let until = Instant::now() + self.timeout;
        let mut reply = Vec::new();
        while length(&reply).is_none_or(|length| reply.len() < length) {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(io::Error::new(ErrorKind::TimedOut, "no answer in time"));
            }
            self.port.set_read_timeout(left)?;
            let mut bytes = [0; LONGEST];
            match self.port.read(&mut bytes) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(count) => reply.extend_from_slice(&bytes[..count]),
                // Looked at again with the time that is left.
                Err(error)
                    if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(reply)
    }
}

/// How long an answer is that begins so, with its sum; `None` while that is not known.
fn length(reply: &[u8]) -> Option<usize> {
    match *reply {
        [_, function, ..] if function & 0x80 != 0 => Some(5),
        [_, 0x01..=0x04, count, ..] => Some(5 + usize::from(count)),
        [_, 0x01..=0x04] => None,
        [_, _, ..] => Some(8),
        _ => None,
    }
}
