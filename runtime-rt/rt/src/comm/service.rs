//! Services over TCP: the protocol of a server, and the state of one of its connections. They access no network: the
//! caller passes the characters received, and sends the answers.

use super::modbus::tcp;
use super::{Cut, Frame, LineFault, Map, Memory, Ports, fx_port, mc};
use core::net::{Ipv4Addr, SocketAddr};

/// Maximum number of characters of a request of any service.
pub const LONGEST_REQUEST: usize = 3882;

/// More characters than an answer of any service has.
pub const LONGEST_REPLY: usize = 8192;

const _: () = assert!(
    mc::LONGEST <= LONGEST_REQUEST
        && fx_port::LONGEST <= LONGEST_REQUEST
        && tcp::LONGEST <= LONGEST_REQUEST
);

/// Connections that a host's server has at once, by default.
pub const USUAL_CLIENTS: usize = 64;

/// Maximum number of connections that a host's server may be allowed.
pub const MAX_CLIENTS: usize = 256;

/// Seconds after which a silent connection gives way to a new one if a server has no more room. Clients that poll are
/// not silent for as long.
pub const IDLE_S: u32 = 60;

/// Seconds of silence after which an incomplete request ends its connection: what comes then begins another one, and
/// would be taken for the rest.
pub const REQUEST_S: u32 = 5;

/// The heading of a host's table of connections. Its columns are 21, 15, 16 and four times 8 characters wide, two
/// apart.
pub const TABLE_HEADING: &str = "server                 client           protocol          requests   answers  rejected     stops";

/// The protocols of servers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum ServerProtocol {
    /// Modbus TCP, with the address table of the model.
    ModbusTcp = 0,
    /// MC protocol, frames 1E and 3E, in binary and in ASCII.
    Mc = 1,
    /// The programming port's protocol, as the model speaks it.
    ProgrammingPort = 2,
}

impl ServerProtocol {
    /// All of them.
    pub const fn all() -> [Self; 3] {
        [Self::ModbusTcp, Self::Mc, Self::ProgrammingPort]
    }

    /// Display name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ModbusTcp => "Modbus TCP",
            Self::Mc => "MC protocol",
            Self::ProgrammingPort => "programming port",
        }
    }

    /// The option of a command line that opens such a server.
    pub const fn option(self) -> &'static str {
        match self {
            Self::ModbusTcp => "--modbus-tcp",
            Self::Mc => "--mc",
            Self::ProgrammingPort => "--fx",
        }
    }
}

/// Reads the address of a server: `127.0.0.1:5020`, or `5020`, a port of this machine alone.
pub fn address(text: &str) -> Option<SocketAddr> {
    // `parse` alone takes a sign.
    if text.bytes().all(|byte| byte.is_ascii_digit()) {
        let port = text.parse().ok()?;
        return Some((Ipv4Addr::LOCALHOST, port).into());
    }
    text.parse().ok()
}

/// Protocol of a server, for a model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct Service {
    /// Its protocol.
    pub protocol: ServerProtocol,
    /// The model's family.
    pub family: Ports,
    /// Code of model and version, which D8001 shows.
    pub type_code: u16,
}

impl Service {
    /// A protocol as a model of the family speaks it; `type_code` is what its D8001 shows.
    pub const fn new(protocol: ServerProtocol, family: Ports, type_code: u16) -> Self {
        Service {
            protocol,
            family,
            type_code,
        }
    }

    /// Decides whether the characters so far form a request.
    fn cut(self, received: &[u8]) -> Cut {
        match self.protocol {
            ServerProtocol::ModbusTcp => tcp::cut(received),
            ServerProtocol::Mc => mc::cut(received),
            ServerProtocol::ProgrammingPort => fx_port::cut(received),
        }
    }

    /// Returns true if a character that begins no request ends the connection: the beginning of the next request is
    /// unknown.
    fn is_lost_after_drop(self) -> bool {
        self.protocol != ServerProtocol::ProgrammingPort
    }
}

/// Effect of a character received by a connection.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum FeedResult {
    /// Part of a request that continues, or of none.
    More = 0,
    /// The last of a request, which has been carried out.
    Request = 1,
    /// The last of a request, which has been rejected.
    Rejected = 2,
    /// Not part of a request, or the last of one that is unknown or has a wrong length. Where the next request begins
    /// is not known, so the connection is to be closed after the answer.
    Lost = 3,
}

/// A connection to a server: what has come of a request, and what is kept from one to the next.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Connection {
    service: Service,
    /// Number of characters in `received`.
    length: u16,
    /// It is a request that is over.
    over: bool,
    /// Modes before and after the last request: the PLC is in RUN, or goes there.
    ran: bool,
    runs: bool,
    received: [u8; LONGEST_REQUEST],
    memory: Memory,
}

impl Connection {
    /// A new connection.
    pub const fn new(service: Service) -> Self {
        Connection {
            service,
            length: 0,
            over: false,
            ran: false,
            runs: false,
            received: [0; LONGEST_REQUEST],
            memory: Memory::new(),
        }
    }

    /// Takes a character. If it is the last of a request, that is carried out on `map` and answered in `reply`.
    pub fn feed(&mut self, byte: u8, map: &mut dyn Map, reply: &mut Frame) -> FeedResult {
        if core::mem::take(&mut self.over) {
            self.length = 0;
            self.ran = self.runs;
        }
        let mut cut = self.push(byte);
        if cut == Cut::Restart {
            self.length = 0;
            cut = self.push(byte);
        }
        let result = match cut {
            Cut::More | Cut::Restart => FeedResult::More,
            Cut::Whole => self.carry_out(map, reply),
            Cut::Drop if self.service.is_lost_after_drop() => FeedResult::Lost,
            Cut::Drop => {
                self.length = 0;
                FeedResult::More
            }
        };
        self.over = result != FeedResult::More;
        result
    }

    fn carry_out(&mut self, map: &mut dyn Map, reply: &mut Frame) -> FeedResult {
        let family = self.service.family;
        if let (ServerProtocol::ModbusTcp, Some(&unit)) =
            (self.service.protocol, self.request().get(tcp::UNIT))
        {
            // Several PLCs may share a port: it is the one that the request names.
            map.takes_unit(unit);
        }
        self.ran = family.will_run(map);
        let answered = self.answer(map, reply);
        self.runs = family.will_run(map);
        match answered {
            Ok(()) => FeedResult::Request,
            Err(LineFault::Length | LineFault::Form) if self.is_mc() => FeedResult::Lost,
            Err(_) => FeedResult::Rejected,
        }
    }

    fn is_mc(&self) -> bool {
        self.service.protocol == ServerProtocol::Mc
    }

    /// RUN or STOP, if the last request switches the PLC to it, by a command or by special relays.
    pub fn switched(&self) -> Option<bool> {
        (self.ran != self.runs).then_some(self.runs)
    }

    /// Returns true if a request has begun, and is not whole.
    pub const fn is_receiving(&self) -> bool {
        self.length > 0 && !self.over
    }

    /// Service of its server.
    pub const fn service(&self) -> Service {
        self.service
    }

    /// Characters of the request so far, whole after its last character.
    pub fn request(&self) -> &[u8] {
        let length = usize::from(self.length);
        self.received.get(..length).unwrap_or_default()
    }

    fn push(&mut self, byte: u8) -> Cut {
        let Some(place) = self.received.get_mut(usize::from(self.length)) else {
            return Cut::Drop;
        };
        *place = byte;
        self.length += 1;
        self.service.cut(self.request())
    }

    fn answer(&mut self, map: &mut dyn Map, reply: &mut Frame) -> Result<(), LineFault> {
        let Service {
            protocol,
            family,
            type_code,
        } = self.service;
        let length = usize::from(self.length);
        let request = self.received.get(..length).unwrap_or_default();
        match protocol {
            ServerProtocol::ModbusTcp => tcp::answer(family.modbus(type_code), request, map, reply),
            ServerProtocol::Mc => mc::answer(request, map, reply),
            ServerProtocol::ProgrammingPort => {
                let settings = family.programming_port();
                fx_port::answer(settings, &mut self.memory, request, map, reply)
            }
        }
    }
}
