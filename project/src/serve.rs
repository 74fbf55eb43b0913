//! `[serve]`: what other machines reach of a running program, and where.

use crate::{Error, Project, Range};
use rungc_models::Model;
use rungc_syntax::{DeviceClass, Span, codes};
use std::fmt;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::str::FromStr;

/// Servers and serial lines of a running program, and devices that it serves beyond those that it names.
#[derive(Clone, Debug, Default)]
pub struct Serve {
    /// Addresses at which all devices are served by Modbus TCP.
    pub modbus_tcp: Vec<SocketAddr>,
    /// Addresses at which all devices are served by MC protocol.
    pub mc: Vec<SocketAddr>,
    /// Addresses at which all devices are served by the programming port's protocol.
    pub fx: Vec<SocketAddr>,
    /// What the serial ports are connected to.
    pub serial: Vec<SerialLine>,
    /// Devices that an emitted program stores, so that its ports serve them, in addition to those that the program
    /// names.
    pub devices: Vec<Range>,
}

/// A serial port in the file, with its place.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SerialLine {
    /// The port and its other end.
    pub line: Line,
    /// Where it is.
    pub span: Span,
}

/// A serial port of the PLC, and what it is connected to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Line {
    /// The number of the PLC's port, as in its manual.
    pub port: u8,
    /// What it is connected to.
    pub end: LineEnd,
}

/// What a serial port of the PLC is connected to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum LineEnd {
    /// The serial port of this machine at this path, `COM3` on Windows.
    Path(PathBuf),
    /// A new pseudo-terminal.
    Pty,
    /// A TCP server that passes characters on, such as a serial device server: host and port.
    Tcp(String),
    /// A TCP socket of this machine, whose client is the other end.
    TcpListen(SocketAddr),
}

impl LineEnd {
    /// Reads `/dev/ttyUSB0`, `pty`, `tcp:HOST:PORT` or `tcp-listen:ADDRESS`.
    ///
    /// # Errors
    /// How it is to be written.
    pub fn parse(text: &str) -> Result<Self, String> {
        if let Some(peer) = text.strip_prefix("tcp:") {
            let parts = peer.rsplit_once(':');
            let fits = parts
                .is_some_and(|(host, port)| !host.is_empty() && matches!(port.parse(), Ok(1u16..)));
            return match fits {
                true => Ok(LineEnd::Tcp(peer.to_string())),
                false => Err("a TCP server is written `tcp:HOST:PORT`".to_string()),
            };
        }
        if let Some(own) = text.strip_prefix("tcp-listen:") {
            return address(own).map(LineEnd::TcpListen);
        }
        match text {
            "" => {
                Err("a line ends at a device, `pty`, `tcp:HOST:PORT` or `tcp-listen:PORT`".into())
            }
            "pty" => Ok(LineEnd::Pty),
            path => Ok(LineEnd::Path(path.into())),
        }
    }
}

impl fmt::Display for LineEnd {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            LineEnd::Path(path) => path.display().fmt(f),
            LineEnd::Pty => f.write_str("a pseudo-terminal"),
            LineEnd::Tcp(peer) => write!(f, "tcp:{peer}"),
            LineEnd::TcpListen(address) => write!(f, "tcp-listen:{address}"),
        }
    }
}

impl FromStr for Line {
    type Err = String;

    /// Reads `COM1=/dev/ttyUSB0`.
    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=');
        let parts = parts.and_then(|(name, end)| Some((port(name)?, end)));
        let (port, end) = parts
            .ok_or("a line is written `COM1=/dev/ttyUSB0`, `COM1=pty` or `COM1=tcp:HOST:PORT`")?;
        let end = LineEnd::parse(end)?;
        Ok(Line { port, end })
    }
}

/// The number of a port from its name, `COM1`.
pub(crate) fn port(name: &str) -> Option<u8> {
    name.strip_prefix("COM")?.parse().ok()
}

/// Reads the address of a server: `127.0.0.1:5020`, or `5020`, a port of this machine alone.
///
/// # Errors
/// How it is to be written.
pub fn address(text: &str) -> Result<SocketAddr, String> {
    let known = rungc_rt::comm::service::address(text);
    known.ok_or_else(|| "an address is written `127.0.0.1:5020`, `[::1]:5020` or `5020`".into())
}

impl Serve {
    /// Whether there is a server or a line.
    pub fn any(&self) -> bool {
        !(self.modbus_tcp.is_empty()
            && self.mc.is_empty()
            && self.fx.is_empty()
            && self.serial.is_empty())
    }

    /// The devices that an emitted program stores in addition to those that it names.
    pub fn stored(&self) -> impl Iterator<Item = (DeviceClass, u32)> {
        let ranges = self.devices.iter();
        ranges.flat_map(|range| (range.first..=range.last).map(move |n| (range.class, n)))
    }
}

impl Project {
    /// What `[serve]` names that the model does not have is a mistake.
    pub(crate) fn check_served(&self, model: &Model) -> Result<(), Error> {
        for SerialLine { line, span } in &self.serve.serial {
            if model.ports.get(line.port).is_none() {
                let message = format!("{} has no port COM{}", model.title, line.port);
                let known = model.ports.all().iter();
                let known: Vec<_> = known.map(|port| format!("COM{}", port.number)).collect();
                let why = codes::PROJECT_VALUE.at(*span, message);
                let help = format!("its ports are {}", known.join(", "));
                return Err(self.mistake(why.help(help)));
            }
        }
        for range in &self.serve.devices {
            let mut numbers = range.first..=range.last;
            if let Some(missing) = numbers.find(|&number| !model.has(range.class, number)) {
                let device = range.class.number(missing);
                let message = format!("{device} does not exist on {}", model.title);
                return Err(self.mistake(codes::PROJECT_VALUE.at(range.span, message)));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_their_ends() {
        let line = |text: &str| text.parse::<Line>().map(|line| line.end.to_string());
        assert_eq!(line("COM1=/dev/ttyUSB0").unwrap(), "/dev/ttyUSB0");
        assert_eq!(line("COM0=pty").unwrap(), "a pseudo-terminal");
        assert_eq!(line("COM2=tcp:plc.local:502").unwrap(), "tcp:plc.local:502");
        let own = "tcp-listen:127.0.0.1:4001";
        assert_eq!(line("COM2=tcp-listen:4001").unwrap(), own);
        for wrong in [
            "COM1",
            "COM1=",
            "1=pty",
            "COMx=pty",
            "COM1=tcp:plc",
            "COM1=tcp::5",
            "COM1=tcp:a:0",
            "COM1=tcp-listen:plc",
        ] {
            assert!(line(wrong).is_err(), "{wrong}");
        }
    }
}
