//! `[serve]`: what other machines reach of a running program, and where.

use crate::{Error, Project, Range};
use rungc_models::Model;
use rungc_rt::comm::CAN_PORT;
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
    pub fx: Vec<FxEnd>,
    /// Position of the last of them.
    pub(crate) fx_span: Span,
    /// Address of the page.
    pub page: Option<SocketAddr>,
    /// Connections that each server has at once.
    pub clients: Option<u16>,
    /// Connections of the serial ports.
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
    /// Position in the file.
    pub span: Span,
}

/// A serial port of the PLC, and what it is connected to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Line {
    /// The number of the PLC's port, as in its manual.
    pub port: u8,
    /// Connection of the port.
    pub end: LineEnd,
}

/// Connection of a serial port of the PLC.
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
    /// The CAN interface of this machine that has this name (SocketCAN).
    CanInterface(String),
    /// An adapter that speaks SLCAN at the end of a line.
    CanAdapter(Box<LineEnd>, CanRate),
}

/// A bit rate of CAN that SLCAN has a command for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CanRate(usize);

impl CanRate {
    /// The rates in kbit/s; the place of each is the number of its command.
    const ALL: [u16; 9] = [10, 20, 50, 100, 125, 250, 500, 800, 1000];

    /// That of the CAN card with its switch 7 off (h1u-h2u-programming §5.9.2): 500 kbit/s.
    const USUAL: Self = CanRate(6);

    /// The rate in kbit/s, from its digits.
    fn parse(text: &str) -> Option<Self> {
        let rate = text.parse().ok()?;
        Self::ALL
            .iter()
            .position(|&known| known == rate)
            .map(CanRate)
    }

    /// Commands that open the channel of an adapter at this rate. It is closed first: an open one rejects a rate.
    /// Carriage returns before that end what the adapter may hold of an earlier line.
    fn opening(self) -> String {
        format!("\r\r\rC\rS{}\rO\r", self.0)
    }
}

impl fmt::Display for CanRate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        Self::ALL.get(self.0).unwrap_or(&0).fmt(f)
    }
}

impl LineEnd {
    /// Address of this machine that the end occupies.
    pub(crate) fn address(&self) -> Option<SocketAddr> {
        match self {
            LineEnd::TcpListen(address) => Some(*address),
            LineEnd::CanAdapter(end, _) => end.address(),
            _ => None,
        }
    }

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

    /// Reads what the CAN card is connected to: `can0`, or `slcan:/dev/ttyACM0`, where the rest is the end of a line
    /// and may have a rate in kbit/s after it: `slcan:/dev/ttyACM0,250`.
    ///
    /// # Errors
    /// How it is to be written.
    pub fn parse_can(text: &str) -> Result<Self, String> {
        let Some(adapter) = text.strip_prefix("slcan:") else {
            let fits = (1..=LONGEST_INTERFACE).contains(&text.len())
                && !text.contains(|c: char| c == '/' || c.is_whitespace());
            return match fits {
                true => Ok(LineEnd::CanInterface(text.to_string())),
                false => Err(
                    "a bus is a CAN interface (`can0`), or an adapter: `slcan:/dev/ttyACM0`".into(),
                ),
            };
        };
        let (end, rate) = match adapter.rsplit_once(',') {
            Some((end, rate)) => (end, CanRate::parse(rate).ok_or_else(rates)?),
            None => (adapter, CanRate::USUAL),
        };
        Ok(LineEnd::CanAdapter(Box::new(LineEnd::parse(end)?), rate))
    }

    /// Data sent to the end when it is open. A client of the PLC is not an adapter: it is the bus.
    pub fn opening(&self) -> String {
        match self {
            LineEnd::CanAdapter(end, rate) => match **end {
                LineEnd::Path(_) | LineEnd::Tcp(_) => rate.opening(),
                _ => String::new(),
            },
            _ => String::new(),
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
            LineEnd::CanInterface(name) => f.write_str(name),
            LineEnd::CanAdapter(end, rate) => write!(f, "{end}, SLCAN at {rate} kbit/s"),
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

impl Line {
    /// The CAN card, connected to `can0` or `slcan:/dev/ttyACM0`.
    ///
    /// # Errors
    /// How it is to be written.
    pub fn can(text: &str) -> Result<Self, String> {
        let end = LineEnd::parse_can(text)?;
        Ok(Line {
            port: CAN_PORT,
            end,
        })
    }

    /// Name of the port in reports: `COM1`, `CAN`.
    pub fn name(&self) -> String {
        port_name(self.port)
    }

    /// Error of the line on a model, and the remedy: the model does not have the port.
    pub fn missing(&self, model: &Model) -> Option<(String, String)> {
        missing_port(model, self.port)
    }
}

/// Error of a port that a model does not have, and the ports that it has.
pub fn missing_port(model: &Model, number: u8) -> Option<(String, String)> {
    if model.ports.get(number).is_some() {
        return None;
    }
    let message = format!("{} has no port {}", model.title, port_name(number));
    let known = model.ports.all().iter();
    let known: Vec<_> = known.map(|port| port_name(port.number)).collect();
    Some((message, format!("its ports are {}", known.join(", "))))
}

/// Name of a port in reports: `COM1`, `CAN`.
fn port_name(number: u8) -> String {
    match number {
        CAN_PORT => "CAN".to_string(),
        number => format!("COM{number}"),
    }
}

/// The longest name of an interface on Linux (`IFNAMSIZ`, without the zero after it).
const LONGEST_INTERFACE: usize = 15;

/// The rates that an adapter can be given.
fn rates() -> String {
    let rates = CanRate::ALL.map(|rate| rate.to_string());
    format!("a rate is one of {} (kbit/s)", rates.join(", "))
}

/// The number of a serial port from its name, `COM1`.
/// Where the programming port's protocol is served.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum FxEnd {
    /// At an address of this machine, over TCP.
    Address(SocketAddr),
    /// At the programming port itself, which is connected to this.
    Line(LineEnd),
}

impl FromStr for FxEnd {
    type Err = String;

    /// Reads an address, or the end of a line as after `COM0=`; a path contains a `/`, or is `COM3` as on Windows.
    fn from_str(text: &str) -> Result<Self, String> {
        let is_path = text.contains(['/', '\\']) || port(text).is_some();
        match address(text) {
            Ok(address) => Ok(FxEnd::Address(address)),
            Err(_) if is_path || text == "pty" || text.starts_with("tcp") => {
                LineEnd::parse(text).map(FxEnd::Line)
            }
            Err(why) => Err(format!("{why}; a line, `pty` or `/dev/ttyUSB0`")),
        }
    }
}

impl FxEnd {
    /// Address of this machine that it occupies.
    pub(crate) fn address(&self) -> Option<SocketAddr> {
        match self {
            FxEnd::Address(address) => Some(*address),
            FxEnd::Line(end) => end.address(),
        }
    }
}

impl Serve {
    /// The lines of the programming port of a model that `fx` names.
    pub fn fx_lines(fx: &[FxEnd], model: &Model) -> Vec<Line> {
        let ends = fx.iter().filter_map(|end| match end {
            FxEnd::Line(end) => Some(end.clone()),
            FxEnd::Address(_) => None,
        });
        let port = model.ports.of_programmer();
        ends.filter_map(|end| Some(Line { port: port?, end }))
            .collect()
    }
}

/// The number of a port from its name, `COM1`.
pub(crate) fn port(name: &str) -> Option<u8> {
    let number = name.strip_prefix("COM")?.parse().ok();
    number.filter(|&number| number != CAN_PORT)
}

/// Returns true if two servers cannot have these addresses at once. Port 0 is any free one.
pub(crate) fn collide(one: SocketAddr, other: SocketAddr) -> bool {
    let is_any = one.ip().is_unspecified() || other.ip().is_unspecified();
    let same_ip = one.ip() == other.ip() || is_any && one.is_ipv4() == other.is_ipv4();
    one.port() != 0 && one.port() == other.port() && same_ip
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
    /// Returns true if there is a server or a line.
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
    /// Checks `[serve]` against the model.
    pub(crate) fn check_served(&self, model: &Model) -> Result<(), Error> {
        for SerialLine { line, span } in &self.serve.serial {
            if let Some((message, help)) = line.missing(model) {
                let why = codes::PROJECT_VALUE.at(*span, message);
                return Err(self.error(why.help(help)));
            }
        }
        self.check_programming_port(model)?;
        let mut ranges = self.serve.devices.iter();
        ranges.try_for_each(|range| self.exists(range, model))
    }

    /// Checks that `fx` and `serial` do not both connect the programming port.
    fn check_programming_port(&self, model: &Model) -> Result<(), Error> {
        let of_fx = Serve::fx_lines(&self.serve.fx, model);
        let Some(line) = of_fx.first() else {
            return Ok(());
        };
        let of_serial = self.serve.serial.iter();
        let also = of_serial.filter(|serial| serial.line.port == line.port);
        if of_fx.len() + also.count() == 1 {
            return Ok(());
        }
        let name = line.name();
        let message = format!("{name} is connected to two lines");
        let why = codes::PROJECT_VALUE.at(self.serve.fx_span, message);
        let help = format!(
            "`fx` connects the programming port of {}, {name}",
            model.title
        );
        Err(self.error(why.help(help)))
    }

    /// Checks that a model has these devices.
    pub(crate) fn exists(&self, range: &Range, model: &Model) -> Result<(), Error> {
        let mut numbers = range.first..=range.last;
        let Some(missing) = numbers.find(|&number| !model.has(range.class, number)) else {
            return Ok(());
        };
        let device = range.class.number(missing);
        let message = format!("{device} does not exist on {}", model.title);
        Err(self.error(codes::PROJECT_VALUE.at(range.span, message)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_programming_port_is_an_address_or_a_line() {
        let fx = |text: &str| text.parse::<FxEnd>();
        let here = |port| Ok(FxEnd::Address(([127, 0, 0, 1], port).into()));
        assert_eq!(fx("5556"), here(5556));
        assert_eq!(fx("127.0.0.1:5556"), here(5556));
        assert_eq!(fx("pty"), Ok(FxEnd::Line(LineEnd::Pty)));
        let usb = LineEnd::Path("/dev/ttyUSB0".into());
        assert_eq!(fx("/dev/ttyUSB0"), Ok(FxEnd::Line(usb)));
        assert_eq!(fx("COM3"), Ok(FxEnd::Line(LineEnd::Path("COM3".into()))));
        for wrong in ["", "tty", "tcp:", "127.0.0.1:70000", "localhost:x"] {
            assert!(fx(wrong).is_err(), "{wrong}");
        }
    }

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
        // The CAN card is not a serial port.
        assert!(line("COM4=pty").is_err());
    }

    #[test]
    fn buses_of_the_can_card() {
        let bus = |text: &str| Line::can(text).map(|line| line.end.to_string());
        assert_eq!(bus("can0").unwrap(), "can0");
        let adapter = "/dev/ttyACM0, SLCAN at 500 kbit/s";
        assert_eq!(bus("slcan:/dev/ttyACM0").unwrap(), adapter);
        let slow = "tcp:gateway:3333, SLCAN at 125 kbit/s";
        assert_eq!(bus("slcan:tcp:gateway:3333,125").unwrap(), slow);
        let LineEnd::CanAdapter(_, rate) = Line::can("slcan:pty,125").unwrap().end else {
            panic!("an adapter");
        };
        assert_eq!(rate.opening(), "\r\r\rC\rS4\rO\r");
        for wrong in [
            "",
            "/dev/ttyACM0",
            "an interface of long name",
            "slcan:",
            "slcan:pty,300",
        ] {
            assert!(bus(wrong).is_err(), "{wrong}");
        }
    }
}
