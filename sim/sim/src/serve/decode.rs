//! Decoding of frames into human-readable form: function, address, count, exception, and the devices of a request.
//!
//! What a request reads and writes is not decoded a second time: the codec that answers it carries it out on a
//! [`Probe`].

mod mc;
mod modbus;
#[cfg(test)]
mod tests;

use super::probe::{Devices, Probe, ranges};
use rungc_rt::Ports;
use rungc_rt::comm::computer_link::{self, Dialect, Remote};
use rungc_rt::comm::modbus::Framing;
use rungc_rt::comm::service::ServerProtocol;
use rungc_rt::comm::{CanFrame, Frame, LineFault, Memory, Protocol, fx_port};
use std::fmt::Write;

/// Control characters of protocols in text, with their names.
const CONTROLS: [(u8, &str); 9] = [
    (0x02, "STX"),
    (0x03, "ETX"),
    (0x04, "EOT"),
    (0x05, "ENQ"),
    (0x06, "ACK"),
    (0x0a, "LF"),
    (0x0c, "CL"),
    (0x0d, "CR"),
    (0x15, "NAK"),
];

/// Rejects a request.
const NAK: u8 = 0x15;

/// Protocol of a server or a port.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LinkProtocol {
    /// A protocol over TCP.
    Tcp(ServerProtocol),
    /// Modbus over TCP, whose client is the PLC.
    Client,
    /// The protocol of a serial port.
    Serial(Protocol),
}

/// Direction of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Direction {
    /// To the PLC.
    In,
    /// From the PLC.
    Out,
}

/// Decoded frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Decoded {
    /// In human-readable form.
    pub text: String,
    /// It reports an error, or is one.
    pub error: Option<String>,
    /// The devices that it writes if it is carried out.
    pub written: Devices,
    /// It is for all stations, and not answered.
    pub broadcast: bool,
}

/// Reads frames of one PLC.
#[derive(Clone, Copy, Debug)]
pub struct Decoder {
    family: Ports,
    type_code: u16,
}

impl Decoder {
    /// For a model: its family, and what its D8001 shows.
    pub fn new(family: Ports, type_code: u16) -> Self {
        Decoder { family, type_code }
    }

    /// Decodes a frame; `before` is the last one in the other direction.
    pub fn decode(
        &self,
        link: LinkProtocol,
        direction: Direction,
        bytes: &[u8],
        before: Option<&[u8]>,
    ) -> Decoded {
        let is_request = direction == Direction::In;
        match link {
            LinkProtocol::Tcp(ServerProtocol::ModbusTcp) => {
                self.modbus_tcp(is_request, bytes, before)
            }
            LinkProtocol::Client => modbus::over_tcp(!is_request, bytes, before),
            LinkProtocol::Tcp(ServerProtocol::Mc) if is_request => self.mc_request(bytes),
            LinkProtocol::Tcp(ServerProtocol::Mc) => mc::reply(bytes),
            LinkProtocol::Tcp(ServerProtocol::ProgrammingPort) => {
                self.programming_port(is_request, bytes)
            }
            LinkProtocol::Serial(protocol) => match protocol {
                Protocol::ModbusRtu => self.modbus(Framing::Rtu, is_request, bytes, before),
                Protocol::ModbusAscii => self.modbus(Framing::Ascii, is_request, bytes, before),
                Protocol::MasterRtu | Protocol::MasterTable => {
                    modbus::master(Framing::Rtu, !is_request, bytes, before)
                }
                Protocol::MasterAscii => modbus::master(Framing::Ascii, !is_request, bytes, before),
                Protocol::ProgrammingPort => self.programming_port(is_request, bytes),
                Protocol::ComputerLink if is_request => self.computer_link(bytes),
                Protocol::Can => can(bytes),
                _ => plain(bytes),
            },
        }
    }

    fn programming_port(&self, is_request: bool, bytes: &[u8]) -> Decoded {
        if !is_request {
            return plain(bytes);
        }
        let settings = self.family.programming_port();
        let mut memory = Memory::new();
        self.carried_out(bytes, |map, reply| {
            fx_port::answer(settings, &mut memory, bytes, map, reply)
        })
    }

    fn computer_link(&self, bytes: &[u8]) -> Decoded {
        let station = bytes
            .get(1..3)
            .and_then(|digits| u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok());
        let settings = |sum| computer_link::Settings {
            station: station.unwrap_or(u8::MAX),
            sum,
            crlf: bytes.ends_with(b"\r\n"),
            dialect: match self.family {
                Ports::Hm => Dialect::Hm,
                _ => Dialect::Fx(*b"9D"),
            },
        };
        // The frame does not show whether there is a sum: the interpretation that makes sense is the right one.
        let decoded = [true, false].map(|sum| {
            self.carried_out(bytes, |map, reply| {
                computer_link::answer(settings(sum), &mut Remote::new(), bytes, map, reply)
            })
        });
        let [with, without] = decoded;
        match with.error {
            None => with,
            Some(_) => without,
        }
    }

    fn mc_request(&self, bytes: &[u8]) -> Decoded {
        let what = mc::command(bytes);
        let done = self.carried_out(bytes, |map, reply| {
            rungc_rt::comm::mc::answer(bytes, map, reply)
        });
        let text = match done.text.split_once(": ") {
            Some((_, devices)) => format!("{what}: {devices}"),
            None => what,
        };
        Decoded { text, ..done }
    }

    /// Carries a request out where nothing comes of it. The text is the request in characters, and its devices.
    fn carried_out(
        &self,
        request: &[u8],
        answer: impl FnOnce(&mut Probe, &mut Frame) -> Result<(), LineFault>,
    ) -> Decoded {
        let mut probe = Probe::new(self.type_code);
        let mut bytes = [0; 8192];
        let mut reply = Frame::new(&mut bytes);
        let done = answer(&mut probe, &mut reply);
        let mut text = characters(request);
        let about = about(&probe);
        if !about.is_empty() {
            text = format!("{text}: {about}");
        }
        Decoded {
            text,
            error: done.err().map(|fault| fault_name(fault).to_string()),
            written: probe.written,
            broadcast: false,
        }
    }
}

/// Description of a request's effect.
fn about(probe: &Probe) -> String {
    let read = probe.read();
    let mut parts = Vec::new();
    if !probe.written.is_empty() {
        parts.push(format!("writes {}", ranges(&probe.written)));
    } else if !read.is_empty() {
        parts.push(format!("reads {}", ranges(&read)));
    }
    if let Some(running) = probe.request {
        parts.push(if running { "RUN" } else { "STOP" }.to_string());
    }
    parts.join(", ")
}

/// A frame of a protocol in text.
fn plain(bytes: &[u8]) -> Decoded {
    let error = (bytes.first() == Some(&NAK)).then(|| "rejected (NAK)".to_string());
    Decoded {
        text: characters(bytes),
        error,
        ..Decoded::default()
    }
}

/// A frame on CAN as candump shows it, identifier and data: `200#1234`; an adapter's commands and answers as text.
fn can(bytes: &[u8]) -> Decoded {
    let Some(frame) = CanFrame::parse(bytes) else {
        return plain(bytes);
    };
    let mut text = match frame.id & CanFrame::EXTENDED {
        0 => format!("{:03X}#", frame.id),
        _ => format!("{:08X}#", frame.id & !CanFrame::EXTENDED),
    };
    for byte in frame.data.iter().take(frame.len.into()) {
        let _ = write!(text, "{byte:02X}");
    }
    Decoded {
        text,
        ..Decoded::default()
    }
}

/// Bytes as characters, with names for the control characters.
fn characters(bytes: &[u8]) -> String {
    let mut text = String::new();
    for &byte in bytes {
        let control = CONTROLS.iter().find(|(code, _)| *code == byte);
        let _ = match (control, byte) {
            (Some((_, name)), _) => write!(text, "<{name}>"),
            (None, b' '..=b'~') => write!(text, "{}", char::from(byte)),
            (None, _) => write!(text, "<{byte:02X}>"),
        };
    }
    text
}

/// Name of a frame's fault.
fn fault_name(fault: LineFault) -> &'static str {
    match fault {
        LineFault::Station => "wrong station",
        LineFault::Length => "wrong length",
        LineFault::Address => "no such device",
        LineFault::Sum => "wrong check code",
        LineFault::Command => "unknown command",
        LineFault::TimeOut => "no answer in time",
        LineFault::Data => "wrong count or value",
        LineFault::Overflow => "too long",
        LineFault::Form => "malformed",
        LineFault::Protocol => "another protocol",
        LineFault::Character => "wrong character",
        LineFault::Unknown => "unexpected character",
    }
}

impl LinkProtocol {
    /// Display name.
    pub fn name(self) -> &'static str {
        match self {
            LinkProtocol::Tcp(protocol) => protocol.name(),
            LinkProtocol::Client => ServerProtocol::ModbusTcp.name(),
            LinkProtocol::Serial(protocol) => protocol.name(),
        }
    }

    /// Returns true if the PLC sends the requests, and the other end answers.
    pub fn is_request(self) -> bool {
        match self {
            LinkProtocol::Tcp(_) => false,
            LinkProtocol::Client => true,
            LinkProtocol::Serial(protocol) => protocol.is_master(),
        }
    }
}
