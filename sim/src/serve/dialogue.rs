//! What one connection has said, and what it is answered.

use super::Speech;
use rungc_rt::Ports;
use rungc_rt::comm::modbus::{Profile, tcp};
use rungc_rt::comm::{Cut, Frame, Map, mc};
use rungc_rt::comm::{Memory, fx_port};

/// More characters than an answer of any service has.
const LONGEST_REPLY: usize = 8192;

/// What a server speaks.
#[derive(Clone, Copy, Debug)]
pub enum Service {
    /// Modbus TCP, with the address table of a model.
    Modbus(&'static Profile),
    /// MC protocol, frames 1E and 3E in binary.
    Mc,
    /// The programming port's protocol, as a model speaks it.
    ProgrammingPort(fx_port::Settings),
}

impl Service {
    /// Modbus TCP of a model: its family, and what its D8001 shows.
    pub fn modbus(family: Ports, type_code: u16) -> Self {
        Service::Modbus(family.modbus(type_code))
    }

    /// The programming port of a model.
    pub fn programming_port(family: Ports) -> Self {
        Service::ProgrammingPort(family.programming_port())
    }

    /// What its frames are.
    pub fn speech(&self) -> Speech {
        match self {
            Service::Modbus(_) => Speech::ModbusTcp,
            Service::Mc => Speech::Mc,
            Service::ProgrammingPort(_) => Speech::ProgrammingPort,
        }
    }

    /// Whether the characters so far are a request.
    fn cut(&self, received: &[u8]) -> Cut {
        match self {
            Service::Modbus(_) => tcp::cut(received),
            Service::Mc => mc::cut(received),
            Service::ProgrammingPort(_) => fx_port::cut(received),
        }
    }

    /// Whether a character that begins no request ends the connection: nothing says where the next request begins.
    fn is_lost_after_drop(&self) -> bool {
        !matches!(self, Service::ProgrammingPort(_))
    }
}

/// One connection to a PLC.
#[derive(Debug)]
pub struct Dialogue {
    service: Service,
    /// The request so far.
    received: Vec<u8>,
    memory: Memory,
}

/// What a connection does next.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reaction {
    /// What it sends.
    pub reply: Vec<u8>,
    /// Whether it closes: what came is not a request.
    pub closes: bool,
    /// The requests that were carried out or rejected.
    pub exchanges: Vec<Exchange>,
}

/// A request and its answer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Exchange {
    /// What was asked.
    pub request: Vec<u8>,
    /// The answer; empty if there is none.
    pub reply: Vec<u8>,
}

impl Dialogue {
    /// A new connection.
    pub fn new(service: Service) -> Self {
        Dialogue {
            service,
            received: Vec::new(),
            memory: Memory::new(),
        }
    }

    /// Takes what has come, and carries out and answers each request in it.
    pub fn receive(&mut self, bytes: &[u8], map: &mut dyn Map) -> Reaction {
        let mut reaction = Reaction::default();
        for &byte in bytes {
            self.received.push(byte);
            let mut cut = self.service.cut(&self.received);
            if cut == Cut::Restart {
                self.received.clear();
                self.received.push(byte);
                cut = self.service.cut(&self.received);
            }
            match cut {
                Cut::More | Cut::Restart => {}
                Cut::Whole => {
                    let reply = self.answer(map);
                    reaction.reply.extend_from_slice(&reply);
                    let request = std::mem::take(&mut self.received);
                    reaction.exchanges.push(Exchange { request, reply });
                }
                Cut::Drop => {
                    let request = std::mem::take(&mut self.received);
                    if self.service.is_lost_after_drop() {
                        let reply = Vec::new();
                        reaction.exchanges.push(Exchange { request, reply });
                        reaction.closes = true;
                        return reaction;
                    }
                }
            }
        }
        reaction
    }

    fn answer(&mut self, map: &mut dyn Map) -> Vec<u8> {
        let mut bytes = [0; LONGEST_REPLY];
        let mut frame = Frame::new(&mut bytes);
        let request = &self.received;
        // What is wrong with a request the answer says; a PLC has no register for errors of a network.
        let _ = match self.service {
            Service::Modbus(profile) => tcp::answer(profile, request, map, &mut frame),
            Service::Mc => mc::answer(request, map, &mut frame),
            Service::ProgrammingPort(settings) => {
                fx_port::answer(settings, &mut self.memory, request, map, &mut frame)
            }
        };
        frame.as_slice().to_vec()
    }
}
