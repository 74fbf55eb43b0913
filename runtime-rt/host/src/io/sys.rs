//! The calls of Linux that the standard library does not have: `ioctl` for serial lines and pins, `poll`.

use super::cycle::Driver;
use super::rtu::{Rtu, SerialLine};
use super::settings::Connection;
use rungc_rt::comm::{LineFormat, Parity};
use std::ffi::{c_int, c_ulong, c_void};
use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::{AsRawFd, FromRawFd, OwnedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::time::{Duration, Instant};

unsafe extern "C" {
    fn ioctl(file: c_int, request: c_ulong, ...) -> c_int;
    fn poll(files: *mut PollFile, count: c_ulong, timeout_ms: c_int) -> c_int;
}

/// `struct pollfd`.
#[repr(C)]
struct PollFile {
    file: c_int,
    events: i16,
    came: i16,
}

const POLLIN: i16 = 1;
const POLLOUT: i16 = 4;

/// `O_NOCTTY | O_NONBLOCK`, as Linux has them on all but MIPS, PowerPC and SPARC, where opening fails then.
const FLAGS: i32 = 0o400 | 0o4000;

/// `struct termios2` of the kernel, which any rate fits (asm-generic/termbits.h).
#[repr(C)]
#[derive(Default)]
struct Termios {
    input: u32,
    output: u32,
    control: u32,
    local: u32,
    discipline: u8,
    characters: [u8; 19],
    input_rate: u32,
    output_rate: u32,
}

/// Bits of `Termios::control`.
const CS7: u32 = 0o40;
const CS8: u32 = 0o60;
const CSTOPB: u32 = 0o100;
const CREAD: u32 = 0o200;
const PARENB: u32 = 0o400;
const PARODD: u32 = 0o1000;
const CLOCAL: u32 = 0o4000;
/// The rate is the number in `output_rate`.
const BOTHER: u32 = 0o10000;

/// Types exchanged with the kernel through a pointer.
///
/// # Safety
/// The type is that of the kernel's headers, and any bytes are a value of it.
pub(super) unsafe trait Passed {}

// SAFETY: as asm-generic/termbits.h has it.
unsafe impl Passed for Termios {}

/// A request to a file of the kernel (asm-generic/ioctl.h).
#[derive(Clone, Copy)]
pub(super) struct Request {
    direction: u32,
    group: u8,
    number: u8,
}

const SET_TERMIOS: Request = Request {
    direction: 1,
    group: b'T',
    number: 0x2b,
};

const GET_TERMIOS: Request = Request::answer(b'T', 0x2a);

impl Request {
    /// A request that returns a value.
    pub(super) const fn answer(group: u8, number: u8) -> Self {
        Request {
            direction: 2,
            group,
            number,
        }
    }

    /// A request that passes a value and returns one.
    pub(super) const fn exchange(group: u8, number: u8) -> Self {
        Request {
            direction: 3,
            group,
            number,
        }
    }

    /// Passes a value to a file, and takes what the kernel makes of it.
    pub(super) fn pass<T: Passed>(self, file: &impl AsRawFd, value: &mut T) -> io::Result<()> {
        let Request {
            direction,
            group,
            number,
        } = self;
        let size = size_of::<T>() as u32;
        let request = direction << 30 | size << 16 | u32::from(group) << 8 | u32::from(number);
        let value: *mut T = value;
        // SAFETY: the kernel reads and writes as many bytes as the request states, which are those of `value`.
        match unsafe { ioctl(file.as_raw_fd(), request as c_ulong, value.cast::<c_void>()) } {
            0.. => Ok(()),
            _ => Err(io::Error::last_os_error()),
        }
    }
}

/// Takes what a request has opened.
///
/// # Safety
/// `file` is open, and belongs to no one else.
pub(super) unsafe fn own(file: i32) -> OwnedFd {
    // SAFETY: the caller's.
    unsafe { OwnedFd::from_raw_fd(file) }
}

/// Waits until a file can be read or written; whether it can.
fn wait(file: &File, events: i16, wait: Duration) -> io::Result<bool> {
    let mut one = PollFile {
        file: file.as_raw_fd(),
        events,
        came: 0,
    };
    // A wait below a millisecond is not none.
    let milliseconds = wait.as_millis().clamp(1, 1_000_000) as c_int;
    // SAFETY: one entry, as the count says.
    match unsafe { poll(&mut one, 1, milliseconds) } {
        0 => Ok(false),
        1.. => Ok(true),
        _ => Err(io::Error::last_os_error()),
    }
}

/// A serial port of this machine, raw. Neither reading nor writing waits.
#[derive(Debug)]
pub struct SerialPort(File);

impl SerialPort {
    /// Opens the port at a path; it keeps its present format.
    ///
    /// # Errors
    /// It cannot be opened, or is not a serial port.
    pub fn open(path: &str) -> io::Result<SerialPort> {
        let mut options = File::options();
        options.read(true).write(true).custom_flags(FLAGS);
        let port = SerialPort(options.open(path)?);
        port.set(|settings| {
            settings.input = 0;
            settings.output = 0;
            settings.local = 0;
            settings.control |= CREAD | CLOCAL;
        })?;
        Ok(port)
    }

    /// Sets up the format of characters.
    ///
    /// # Errors
    /// The port does not have it.
    pub fn set_format(&self, format: LineFormat) -> io::Result<()> {
        self.set(|settings| {
            settings.control = CREAD | CLOCAL | BOTHER;
            settings.control |= if format.data_bits == 7 { CS7 } else { CS8 };
            settings.control |= match format.parity {
                Parity::None => 0,
                Parity::Even => PARENB,
                Parity::Odd => PARENB | PARODD,
            };
            if format.stop_bits == 2 {
                settings.control |= CSTOPB;
            }
            settings.input_rate = format.bits_per_second;
            settings.output_rate = format.bits_per_second;
        })
    }

    fn set(&self, change: impl FnOnce(&mut Termios)) -> io::Result<()> {
        let mut settings = Termios::default();
        GET_TERMIOS.pass(&self.0, &mut settings)?;
        change(&mut settings);
        SET_TERMIOS.pass(&self.0, &mut settings)
    }

    /// One more handle of the port.
    ///
    /// # Errors
    /// The system has no more.
    pub fn try_clone(&self) -> io::Result<SerialPort> {
        self.0.try_clone().map(SerialPort)
    }

    /// Waits until characters have come; 0 where the port has vanished.
    ///
    /// # Errors
    /// The port has vanished.
    pub fn receive(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            let received = match wait(&self.0, POLLIN, Duration::from_secs(60)) {
                Ok(true) => self.0.read(bytes),
                Ok(false) => continue,
                Err(error) => Err(error),
            };
            match received {
                Err(error)
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
                received => return received,
            }
        }
    }

    /// Sends the first characters, as many as the port has room for now, and returns their number.
    ///
    /// # Errors
    /// The port has vanished.
    pub fn send(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.0.write(bytes) {
            Err(error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) =>
            {
                Ok(0)
            }
            sent => sent,
        }
    }
}

/// A serial line to slaves.
struct Line {
    port: SerialPort,
    timeout: Duration,
}

/// Opens the line of a connection, to slaves.
pub(super) fn open_line(connection: &Connection) -> Result<Box<dyn Driver>, String> {
    let bits_per_second = connection.baud()?;
    let (parity, stop_bits) = connection.format()?;
    let mut format = LineFormat::new();
    format.bits_per_second = bits_per_second;
    format.stop_bits = stop_bits;
    format.parity = match parity {
        'E' => Parity::Even,
        'O' => Parity::Odd,
        _ => Parity::None,
    };
    let open = || {
        let port = SerialPort::open(&connection.end)?;
        port.set_format(format)?;
        Ok(port)
    };
    let port = open().map_err(|error: io::Error| error.to_string())?;
    let timeout = Duration::from_millis(connection.timeout_ms);
    Rtu::driver(Line { port, timeout }, connection)
}

impl SerialLine for Line {
    fn discard(&mut self) -> io::Result<()> {
        let mut bytes = [0; 256];
        loop {
            match self.port.0.read(&mut bytes) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(_) => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }

    fn send(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        let until = Instant::now() + self.timeout;
        while !bytes.is_empty() {
            let sent = self.port.send(bytes)?;
            bytes = &bytes[sent..];
            let left = until.saturating_duration_since(Instant::now());
            if sent == 0 && (left.is_zero() || !wait(&self.port.0, POLLOUT, left)?) {
                let why = "the line takes no characters";
                return Err(io::Error::new(ErrorKind::TimedOut, why));
            }
        }
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], longest: Duration) -> io::Result<usize> {
        match wait(&self.port.0, POLLIN, longest)? {
            true => self.port.0.read(bytes),
            false => Err(ErrorKind::TimedOut.into()),
        }
    }
}
