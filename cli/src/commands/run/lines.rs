//! `rungc run --serial COM1=/dev/ttyUSB0`: serial ports of this machine as those of the PLC, in real time.
//!
//! A thread for each port notes when characters come in. The run is late by at most one scan, so that they reach the program's ports at
//! their own times, and the end of a frame is where the line was silent.

use crate::args::{SerialArg, SerialDevice};
use crate::commands::{Failure, tell};
use rungc_models::Model;
use rungc_rt::VirtualHal;
use rungc_rt::comm::{LineFormat, Parity, Received};
use serial2::{CharSize, SerialPort, Settings, StopBits};
use std::io;
use std::sync::mpsc::{self, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

/// How long a thread waits for characters before it looks whether the run still wants them.
const PATIENCE: Duration = Duration::from_millis(100);

/// Before the program has set up the line.
const USUAL_RATE: u32 = 9600;

/// The serial lines of a run.
#[derive(Default)]
pub struct Lines(Vec<Line>);

/// A port of the PLC, and the port of this machine that it is.
struct Line {
    number: u8,
    port: SerialPort,
    /// The other end of a pseudo-terminal: open, so that clients can come and go.
    _client_end: Option<SerialPort>,
    incoming: mpsc::Receiver<io::Result<Chunk>>,
    format: LineFormat,
    /// When the last character was in.
    last_us: u32,
    /// It no longer works, which was reported.
    dead: bool,
}

/// Characters that came together.
struct Chunk {
    at: Instant,
    bytes: Vec<u8>,
}

impl Lines {
    /// Opens all ports, and reports them.
    ///
    /// # Errors
    /// A port that the model does not have, and one that cannot be opened.
    pub fn open(args: &[SerialArg], model: &Model) -> Result<Self, Failure> {
        args.iter()
            .map(|arg| Line::open(arg, model))
            .collect::<Result<_, _>>()
            .map(Lines)
    }

    /// What has come in since the last call reaches the ports, at its times but not before `from_ms`; the run began at `begin`.
    pub fn receive(&mut self, hal: &mut VirtualHal, begin: Instant, from_ms: u64) {
        for line in self.0.iter_mut().filter(|line| !line.dead) {
            line.follow_format(hal);
            line.receive(hal, begin, from_ms);
        }
    }

    /// What the ports have sent by now goes out.
    pub fn send(&mut self, hal: &mut VirtualHal, now_ms: u64) {
        for line in self.0.iter_mut().filter(|line| !line.dead) {
            line.send(hal, now_ms);
        }
    }
}

impl Line {
    fn open(arg: &SerialArg, model: &Model) -> Result<Line, Failure> {
        let number = arg.port;
        if model.ports.get(number).is_none() {
            let known = model.ports.all().iter();
            let known: Vec<_> = known.map(|port| format!("COM{}", port.number)).collect();
            let message = format!(
                "--serial: {} has no port COM{number}; its ports are {}",
                model.title,
                known.join(", ")
            );
            return Err(Failure::Because(message));
        }
        let opened = match &arg.device {
            SerialDevice::Path(path) => {
                let name = path.display().to_string();
                SerialPort::open(path, USUAL_RATE).map(|port| (port, None, name))
            }
            SerialDevice::Pty => pseudo_terminal(),
        };
        let (mut port, client_end, name) = opened.map_err(|error| {
            Failure::Because(format!("--serial: cannot open {}: {error}", arg.device))
        })?;
        let incoming = port
            .set_read_timeout(PATIENCE)
            .and_then(|()| port.try_clone())
            .map_err(|error| Failure::Because(format!("--serial: {name}: {error}")))?;
        tell(&format!("rungc: COM{number} at {name}"));
        Ok(Line {
            number,
            port,
            _client_end: client_end,
            incoming: listen(incoming),
            format: LineFormat::new(),
            last_us: 0,
            dead: false,
        })
    }

    /// The line has the format that the program has set up.
    fn follow_format(&mut self, hal: &mut VirtualHal) {
        let Some(line) = hal.line(self.number) else {
            return;
        };
        let format = line.format();
        if format == self.format || format.bits_per_second == 0 {
            return;
        }
        self.format = format;
        let set = self.port.get_configuration().and_then(|mut settings| {
            apply(&mut settings, format)?;
            self.port.set_configuration(&settings)
        });
        if let Err(error) = set {
            tell(&format!(
                "rungc: COM{}: the line cannot be set to {} bit/s, {} data bits: {error}",
                self.number, format.bits_per_second, format.data_bits
            ));
        }
    }

    fn receive(&mut self, hal: &mut VirtualHal, begin: Instant, from_ms: u64) {
        loop {
            let chunk = match self.incoming.try_recv() {
                Ok(Ok(chunk)) => chunk,
                Ok(Err(error)) => return self.fail(&error),
                Err(TryRecvError::Empty | TryRecvError::Disconnected) => return,
            };
            let character_us = self.format.character_us();
            let came_us = chunk.at.saturating_duration_since(begin).as_micros() as u32;
            let before = chunk.bytes.len().saturating_sub(1) as u32;
            // The characters of a chunk came one after the other; the system shows when the last of them was in.
            let mut at_us = came_us.wrapping_sub(character_us.wrapping_mul(before));
            for byte in chunk.bytes {
                let earliest = [
                    (from_ms * 1000) as u32,
                    self.last_us.wrapping_add(character_us),
                ];
                for earliest in earliest {
                    if (at_us.wrapping_sub(earliest) as i32) < 0 {
                        at_us = earliest;
                    }
                }
                let character = Received {
                    at_us,
                    byte,
                    ..Received::new()
                };
                if let Some(line) = hal.line(self.number) {
                    // What does not fit is lost, as in the receiver of a PLC that is not asked in time.
                    let _ = line.feed(character);
                }
                self.last_us = at_us;
                at_us = at_us.wrapping_add(character_us);
            }
        }
    }

    fn send(&mut self, hal: &mut VirtualHal, now_ms: u64) {
        let now_us = (now_ms * 1000) as u32;
        let line = hal.line(self.number);
        let sent = line.map(|line| std::iter::from_fn(|| line.take(now_us)).map(|sent| sent.byte));
        let bytes: Vec<u8> = sent.into_iter().flatten().collect();
        if !bytes.is_empty()
            && let Err(error) = self.port.write_all(&bytes)
        {
            self.fail(&error);
        }
    }

    /// The program runs on without the line.
    fn fail(&mut self, error: &io::Error) {
        self.dead = true;
        tell(&format!(
            "rungc: COM{}: {error}; nothing is received or sent on it any more",
            self.number
        ));
    }
}

/// Notes what comes in, until the run no longer asks or the port fails.
fn listen(port: SerialPort) -> mpsc::Receiver<io::Result<Chunk>> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut buffer = [0; 1024];
        loop {
            let incoming = match port.read(&mut buffer) {
                Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
                Ok(count) => Ok(Chunk {
                    at: Instant::now(),
                    bytes: buffer[..count].to_vec(),
                }),
                Err(error) if error.kind() == io::ErrorKind::TimedOut => continue,
                Err(error) => Err(error),
            };
            let failed = incoming.is_err();
            if sender.send(incoming).is_err() || failed {
                return;
            }
        }
    });
    receiver
}

/// Sets a port to a format of characters.
fn apply(settings: &mut Settings, format: LineFormat) -> io::Result<()> {
    settings.set_raw();
    settings.set_baud_rate(format.bits_per_second)?;
    settings.set_char_size(match format.data_bits {
        7 => CharSize::Bits7,
        _ => CharSize::Bits8,
    });
    settings.set_parity(match format.parity {
        Parity::None => serial2::Parity::None,
        Parity::Odd => serial2::Parity::Odd,
        Parity::Even => serial2::Parity::Even,
    });
    settings.set_stop_bits(match format.stop_bits {
        2 => StopBits::Two,
        _ => StopBits::One,
    });
    Ok(())
}

/// A new pseudo-terminal: our end, the end of its clients, and the path by which they open it.
#[cfg(unix)]
fn pseudo_terminal() -> io::Result<(SerialPort, Option<SerialPort>, String)> {
    let (ours, mut theirs) = SerialPort::pair()?;
    let mut settings = theirs.get_configuration()?;
    settings.set_raw();
    theirs.set_configuration(&settings)?;
    let path = rustix::termios::ttyname(&theirs, Vec::new())?;
    let path = path.to_string_lossy().into_owned();
    Ok((ours, Some(theirs), path))
}

/// There are no pseudo-terminals here.
#[cfg(not(unix))]
fn pseudo_terminal() -> io::Result<(SerialPort, Option<SerialPort>, String)> {
    Err(io::ErrorKind::Unsupported.into())
}
