//! Remote I/O on a serial line: Modbus RTU, as its master.

use super::cycle::Driver;
use super::modbus::{Remote, Wire};
use super::settings::Connection;
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

/// A serial line that is open and has its format.
pub trait SerialLine: Send {
    /// Forgets what has come.
    ///
    /// # Errors
    /// The line is lost.
    fn discard(&mut self) -> io::Result<()>;

    /// Sends all characters.
    ///
    /// # Errors
    /// The line is lost, or does not take them.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Waits at most so long for characters, and returns how many have come: 0 is the end of the line.
    ///
    /// # Errors
    /// The line is lost; `TimedOut` if nothing has come.
    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> io::Result<usize>;
}

/// A serial line to slaves.
pub struct Rtu<L> {
    line: L,
    timeout: Duration,
    /// The silence before a request.
    silence: Duration,
}

/// Time for which a line is silent before a request, at a bit rate other than 0: three and a half characters.
pub fn silence(baud: u32) -> Duration {
    if baud > FAST {
        LEAST_SILENCE
    } else {
        Duration::from_secs(1) * CHARACTER * 7 / 2 / baud
    }
}

impl<L: SerialLine + 'static> Rtu<L> {
    /// The slave of a connection at the end of a line.
    ///
    /// # Errors
    /// A unit or a rate that does not exist.
    pub fn driver(line: L, connection: &Connection) -> Result<Box<dyn Driver>, String> {
        let rtu = Rtu {
            line,
            timeout: Duration::from_millis(connection.timeout_ms),
            silence: silence(connection.baud()?),
        };
        Ok(Box::new(Remote::new(rtu, connection)?))
    }
}

impl<L: SerialLine> Wire for Rtu<L> {
    fn request(&mut self, request: &[u8]) -> io::Result<Vec<u8>> {
        thread::sleep(self.silence);
        // The rest of a late answer belongs to no request.
        self.line.discard()?;
        self.line.send(request)?;
        let until = Instant::now() + self.timeout;
        let mut reply = Vec::new();
        while length(&reply).is_none_or(|length| reply.len() < length) {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(io::Error::new(ErrorKind::TimedOut, "no answer in time"));
            }
            let mut bytes = [0; LONGEST];
            match self.line.receive(&mut bytes, left) {
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

/// Length of a reply that begins with these bytes, including its checksum; `None` if not yet known.
fn length(reply: &[u8]) -> Option<usize> {
    match *reply {
        [_, function, ..] if function & 0x80 != 0 => Some(5),
        [_, 0x01..=0x04, count, ..] => Some(5 + usize::from(count)),
        [_, 0x01..=0x04] => None,
        [_, _, ..] => Some(8),
        _ => None,
    }
}
