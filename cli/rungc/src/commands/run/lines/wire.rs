//! The end of a line on this machine: a serial port, a pseudo-terminal, or a TCP connection. A thread for each keeps it
//! open: what vanishes is opened again.

#[cfg(target_os = "linux")]
use super::can::Interface;
use rungc_io::ports;
use rungc_project::serve::LineEnd;
use rungc_rt::comm::service::IDLE_S;
use rungc_rt::comm::{LineFormat, Parity};
use serial2::{CharSize, SerialPort, Settings, StopBits};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream, ToSocketAddrs};
use std::sync::mpsc::{self, Sender};
use std::thread;
use std::time::{Duration, Instant};

/// Returns true if a port is an end of a pseudo-terminal, on which characters have no format.
#[cfg(target_os = "linux")]
fn is_pseudo_terminal(port: &SerialPort) -> bool {
    use std::os::fd::AsRawFd;
    let file = format!("/proc/self/fd/{}", port.as_raw_fd());
    std::fs::read_link(file).is_ok_and(|path| path.starts_with("/dev/pts"))
}

/// Other systems do not say so.
#[cfg(not(target_os = "linux"))]
fn is_pseudo_terminal(_: &SerialPort) -> bool {
    false
}

/// Time-out of a thread waiting for characters.
const PATIENCE: Duration = Duration::from_millis(100);

/// Time that the run waits for a line to accept characters; the rest waits for the next scan.
const WRITE_WAIT: Duration = Duration::from_millis(1);

/// The first and the longest pause before another attempt to open what has vanished.
const PAUSES: [Duration; 2] = [Duration::from_millis(200), Duration::from_secs(5)];

/// Timeout of an attempt to connect.
const CONNECT_WAIT: Duration = Duration::from_secs(3);

/// Time after which a silent client of a socket gives way to another.
const IDLE: Duration = Duration::from_secs(IDLE_S as u64);

/// Before the program has set up the line.
const USUAL_RATE: u32 = 9600;

/// An open end.
#[derive(Debug)]
pub enum Wire {
    /// A serial port.
    Serial(SerialPort),
    /// Our end of a pseudo-terminal, on which characters have no format.
    Terminal(SerialPort),
    /// A connection.
    Tcp(TcpStream),
    /// A CAN interface.
    #[cfg(target_os = "linux")]
    Can(Interface),
}

/// Event reported by a thread.
pub enum Event {
    /// The end is open.
    Up(Wire),
    /// The end has vanished, for this reason.
    Down(io::Error),
    /// Characters have come.
    Chunk(Chunk),
    /// A client is rejected, the first one since the present client has connected.
    Rejected(SocketAddr),
}

/// Characters that came together.
pub struct Chunk {
    /// Time of the last of them.
    pub at: Instant,
    /// The characters.
    pub bytes: Vec<u8>,
}

/// Source of a thread's connections.
enum Source {
    /// An end that can be opened again.
    Known(LineEnd),
    /// Clients of a socket, one at a time.
    Clients(TcpListener),
    /// A pseudo-terminal, with the end of its clients: open, so that clients can come and go.
    Pty { _clients: SerialPort },
}

/// Opens an end, and keeps it open. Returns what it is called and what happens to it.
///
/// # Errors
/// What the system says of an end of this machine. Another machine that does not answer is tried again.
pub fn keep(end: &LineEnd) -> io::Result<(String, mpsc::Receiver<Event>)> {
    let (name, source, wire) = match end {
        LineEnd::Path(_) | LineEnd::CanInterface(_) => {
            let wire = open(end)?;
            (end.to_string(), Source::Known(end.clone()), Some(wire))
        }
        LineEnd::CanAdapter(end, _) => return keep(end),
        LineEnd::Tcp(_) => (end.to_string(), Source::Known(end.clone()), None),
        LineEnd::TcpListen(address) => {
            let listener = TcpListener::bind(address)?;
            listener.set_nonblocking(true)?;
            let name = LineEnd::TcpListen(listener.local_addr()?).to_string();
            (name, Source::Clients(listener), None)
        }
        LineEnd::Pty => {
            let (ours, clients, name) = pseudo_terminal()?;
            let wire = Wire::Terminal(prepared(ours)?);
            (name, Source::Pty { _clients: clients }, Some(wire))
        }
    };
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || source.keep(wire, &sender));
    Ok((name, receiver))
}

/// The run no longer wants to know.
struct Over;

/// Reason why a thread stops reading a wire.
enum End {
    /// It has vanished.
    Failed(io::Error),
    /// This one has taken its place.
    Replaced(Wire),
}

impl Source {
    /// Reports what happens to the end, until the run no longer wants to know. `wire` is the end if it is open already.
    fn keep(&self, mut wire: Option<Wire>, events: &Sender<Event>) {
        let mut pause = PAUSES[0];
        // That no client has connected yet is not worth a word.
        let mut reported = matches!(self, Source::Clients(_));
        loop {
            let opened = match wire.take() {
                Some(wire) => Ok(wire),
                None => self.open(),
            };
            let error = match opened.and_then(|wire| Ok((wire.try_clone()?, wire))) {
                Ok((ours, theirs)) => {
                    reported = false;
                    pause = PAUSES[0];
                    if events.send(Event::Up(theirs)).is_err() {
                        return;
                    }
                    match ours.listen(events, self) {
                        Ok(End::Failed(error)) => error,
                        Ok(End::Replaced(newcomer)) => {
                            wire = Some(newcomer);
                            continue;
                        }
                        Err(Over) => return,
                    }
                }
                Err(error) => error,
            };
            // The missing end has been reported.
            if !reported && events.send(Event::Down(error)).is_err() {
                return;
            }
            reported = true;
            match self {
                Source::Clients(_) => thread::sleep(PATIENCE),
                Source::Known(_) | Source::Pty { .. } => {
                    thread::sleep(pause);
                    pause = (2 * pause).min(PAUSES[1]);
                }
            }
        }
    }

    /// A client that has connected.
    fn newcomer(&self) -> Option<(TcpStream, SocketAddr)> {
        match self {
            Source::Clients(listener) => listener.accept().ok(),
            Source::Known(_) | Source::Pty { .. } => None,
        }
    }

    fn open(&self) -> io::Result<Wire> {
        match self {
            Source::Known(end) => open(end),
            Source::Clients(listener) => connected(listener.accept()?.0),
            Source::Pty { .. } => Err(ErrorKind::NotFound.into()),
        }
    }
}

/// Opens an end that has a name.
///
/// # Errors
/// What the system says, or the machine that it connects to.
pub fn open(end: &LineEnd) -> io::Result<Wire> {
    match end {
        LineEnd::Path(path) => prepared(SerialPort::open(path, USUAL_RATE)?).map(Wire::Serial),
        LineEnd::Tcp(peer) => {
            let mut last = io::Error::from(ErrorKind::NotFound);
            for address in peer.to_socket_addrs()? {
                match TcpStream::connect_timeout(&address, CONNECT_WAIT) {
                    Ok(stream) => return connected(stream),
                    Err(error) => last = error,
                }
            }
            Err(last)
        }
        LineEnd::CanInterface(name) => interface(name),
        LineEnd::Pty | LineEnd::TcpListen(_) | LineEnd::CanAdapter(..) => {
            Err(ErrorKind::Unsupported.into())
        }
    }
}

/// Message for an end that cannot be opened; of a serial port, it says what to do.
pub fn cannot_open(end: &LineEnd, error: &io::Error) -> String {
    let why = match end {
        LineEnd::Path(_) => ports::cannot_open(error),
        LineEnd::CanAdapter(end, _) => return cannot_open(end, error),
        _ => error.to_string(),
    };
    format!("cannot open {end}: {why}")
}

#[cfg(target_os = "linux")]
fn interface(name: &str) -> io::Result<Wire> {
    Interface::open(name, PATIENCE, WRITE_WAIT).map(Wire::Can)
}

/// There is no SocketCAN here.
#[cfg(not(target_os = "linux"))]
fn interface(_name: &str) -> io::Result<Wire> {
    let why = "CAN interfaces (SocketCAN) exist only on Linux; an adapter is written `slcan:PORT`";
    Err(io::Error::new(ErrorKind::Unsupported, why))
}

fn prepared(mut port: SerialPort) -> io::Result<SerialPort> {
    port.set_read_timeout(PATIENCE)?;
    port.set_write_timeout(WRITE_WAIT)?;
    Ok(port)
}

fn connected(stream: TcpStream) -> io::Result<Wire> {
    // Some systems pass on that the socket does not block.
    stream.set_nonblocking(false)?;
    // A frame is one small packet: waiting for more only delays it.
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(WRITE_WAIT))?;
    Ok(Wire::Tcp(stream))
}

fn closed() -> io::Error {
    io::Error::new(ErrorKind::UnexpectedEof, "the line was closed")
}

/// A terminal whose other end has closed ends, or fails with EIO while it closes; so does an adapter pulled out.
fn is_hangup(error: &io::Error) -> bool {
    const EIO: i32 = 5;
    cfg!(unix) && error.raw_os_error() == Some(EIO)
}

impl Wire {
    fn try_clone(&self) -> io::Result<Wire> {
        Ok(match self {
            Wire::Serial(port) => Wire::Serial(port.try_clone()?),
            Wire::Terminal(port) => Wire::Terminal(port.try_clone()?),
            Wire::Tcp(stream) => Wire::Tcp(stream.try_clone()?),
            #[cfg(target_os = "linux")]
            Wire::Can(interface) => Wire::Can(interface.try_clone()?),
        })
    }

    /// Receives what has come, after at most [`PATIENCE`]; 0 when the other end has closed.
    ///
    /// # Errors
    /// What the system says; [`is_patience`] recognises that merely nothing has come.
    pub fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Wire::Serial(port) | Wire::Terminal(port) => port.read(buffer),
            Wire::Tcp(stream) => stream.read(buffer),
            #[cfg(target_os = "linux")]
            Wire::Can(interface) => interface.read(buffer),
        }
    }

    /// Sends what the other end takes now; how many characters.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = match self {
            Wire::Serial(port) | Wire::Terminal(port) => port.write(bytes),
            Wire::Tcp(stream) => stream.write(bytes),
            #[cfg(target_os = "linux")]
            Wire::Can(interface) => interface.write(bytes),
        };
        match written {
            Err(error) if is_patience(&error) => Ok(0),
            written => written,
        }
    }

    /// Sends all of the characters.
    ///
    /// # Errors
    /// What the system says, or that the line does not take them in `patience`.
    pub fn send(&mut self, mut bytes: &[u8], patience: Duration) -> io::Result<()> {
        let deadline = Instant::now() + patience;
        while !bytes.is_empty() {
            let sent = self.write(bytes);
            let sent = sent.map_err(|error| if is_hangup(&error) { closed() } else { error })?;
            bytes = &bytes[sent..];
            if !bytes.is_empty() && Instant::now() > deadline {
                let why = "the line takes no characters";
                return Err(io::Error::new(ErrorKind::TimedOut, why));
            }
        }
        Ok(())
    }

    /// Receives what has come, after at most [`PATIENCE`]; 0 if nothing has.
    ///
    /// # Errors
    /// What the system says, or that the other end has closed.
    pub fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.read(buffer) {
            Ok(0) => Err(closed()),
            Err(error) if is_patience(&error) => Ok(0),
            Err(error) if is_hangup(&error) => Err(closed()),
            received => received,
        }
    }

    /// Sets a serial port to a format of characters. Connections and pseudo-terminals have none.
    pub fn set_format(&mut self, format: LineFormat) -> io::Result<()> {
        let Wire::Serial(port) = self else {
            return Ok(());
        };
        let mut settings = port.get_configuration()?;
        apply(&mut settings, format)?;
        match port.set_configuration(&settings) {
            // It has eight data bits and no parity, whatever is set.
            Err(_) if is_pseudo_terminal(port) => Ok(()),
            set => set,
        }
    }

    /// Reports what comes, until the end fails or another takes its place: one that has been silent for long may be
    /// dead without notice. Until then, others are rejected.
    fn listen(mut self, events: &Sender<Event>, source: &Source) -> Result<End, Over> {
        let mut buffer = [0; 1024];
        let mut last_received = Instant::now();
        let mut has_rejected = false;
        loop {
            if let Some((stream, client)) = source.newcomer() {
                if last_received.elapsed() >= IDLE
                    && let Ok(wire) = connected(stream)
                {
                    return Ok(End::Replaced(wire));
                }
                if !std::mem::replace(&mut has_rejected, true) {
                    events.send(Event::Rejected(client)).map_err(|_| Over)?;
                }
            }
            let event = match self.read(&mut buffer) {
                Ok(0) => return Ok(End::Failed(ErrorKind::UnexpectedEof.into())),
                Ok(count) => Event::Chunk(Chunk {
                    at: Instant::now(),
                    bytes: buffer[..count].to_vec(),
                }),
                Err(error) if is_patience(&error) => continue,
                Err(error) => return Ok(End::Failed(error)),
            };
            last_received = Instant::now();
            events.send(event).map_err(|_| Over)?;
        }
    }
}

/// Returns true if the error is only a time-out.
pub fn is_patience(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted
    )
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
fn pseudo_terminal() -> io::Result<(SerialPort, SerialPort, String)> {
    let (ours, mut theirs) = SerialPort::pair()?;
    let mut settings = theirs.get_configuration()?;
    settings.set_raw();
    theirs.set_configuration(&settings)?;
    let path = rustix::termios::ttyname(&theirs, Vec::new())?;
    let path = path.to_string_lossy().into_owned();
    Ok((ours, theirs, path))
}

/// There are no pseudo-terminals here.
#[cfg(not(unix))]
fn pseudo_terminal() -> io::Result<(SerialPort, SerialPort, String)> {
    let why =
        "pseudo-terminals exist only on Linux and macOS; name a serial port or `tcp-listen:PORT`";
    Err(io::Error::new(ErrorKind::Unsupported, why))
}
