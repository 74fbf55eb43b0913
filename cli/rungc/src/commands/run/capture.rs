//! Frames as a capture for Wireshark (pcapng, draft-ietf-opsawg-pcapng).
//!
//! Frames over TCP stand in packets of IP without the packets that open and close connections; frames of serial ports
//! under the link type of RTAC devices (LINKTYPE_RTAC_SERIAL), which has a direction.

use super::watch::Way;
use etherparse::{IpNumber, Ipv4Header, Ipv6FlowLabel, Ipv6Header, TcpHeader};
use rungc_sim::serve::{Direction, Seen};
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, ErrorKind, Write};
use std::net::SocketAddr;
use std::time::{SystemTime, UNIX_EPOCH};

/// Types of blocks.
const SECTION: u32 = 0x0a0d_0d0a;
const INTERFACE: u32 = 1;
const PACKET: u32 = 6;

/// Shows readers the order of bytes.
const BYTE_ORDER: u32 = 0x1a2b_3c4d;

/// Link types of interfaces: packets of IP; serial data with the header of RTAC devices.
const LINKTYPE_RAW: u16 = 101;
const LINKTYPE_RTAC_SERIAL: u16 = 250;

/// Options of an interface.
const OPTION_NAME: u16 = 2;

/// Kinds of events of RTAC devices: data sent and received.
const DATA_SENT: u8 = 1;
const DATA_RECEIVED: u8 = 2;

/// Time to live of a packet, and the window of a connection: both arbitrary here.
const HOPS: u8 = 64;
const WINDOW: u16 = u16::MAX;

/// A capture in the making.
pub struct Capture {
    file: File,
    /// Start of the run.
    begin_us: u64,
    /// Serial ports in the order of their interfaces; interface 0 is that of TCP.
    ports: Vec<String>,
    /// Bytes that client and server of a connection have sent.
    sent: HashMap<(SocketAddr, SocketAddr), [u32; 2]>,
}

impl Capture {
    /// Writes the head.
    ///
    /// # Errors
    /// What the system says.
    pub fn begin(file: File) -> io::Result<Self> {
        let begin = SystemTime::now().duration_since(UNIX_EPOCH);
        let mut capture = Capture {
            file,
            begin_us: begin.unwrap_or_default().as_micros() as u64,
            ports: Vec::new(),
            sent: HashMap::new(),
        };
        let mut section = BYTE_ORDER.to_le_bytes().to_vec();
        // Version 1.0, a section of unknown length.
        section.extend([1, 0, 0, 0]);
        section.extend([0xff; 8]);
        capture.block(SECTION, &section)?;
        capture.interface(LINKTYPE_RAW, "TCP")?;
        Ok(capture)
    }

    /// Appends a frame, seen `at_us` microseconds after the run began.
    ///
    /// # Errors
    /// What the system says.
    pub fn frame(&mut self, at_us: u64, way: Way, seen: Seen) -> io::Result<()> {
        let at_us = self.begin_us + at_us;
        let (interface, packet) = match way {
            Way::Serial => (self.port(&seen.place.port)?, serial(at_us, seen)),
            Way::Tcp { client, server } => (0, self.tcp(client, server, seen)?),
        };
        let mut block = Vec::new();
        let length = (packet.len() as u32).to_le_bytes();
        for number in [interface, (at_us >> 32) as u32, at_us as u32] {
            block.extend(number.to_le_bytes());
        }
        block.extend(length);
        block.extend(length);
        padded(&mut block, &packet);
        self.block(PACKET, &block)
    }

    /// The interface of a serial port, made if it is new.
    fn port(&mut self, name: &str) -> io::Result<u32> {
        let known = self.ports.iter().position(|port| port == name);
        if known.is_none() {
            self.interface(LINKTYPE_RTAC_SERIAL, name)?;
            self.ports.push(name.to_string());
        }
        Ok(known.unwrap_or(self.ports.len() - 1) as u32 + 1)
    }

    fn interface(&mut self, link_type: u16, name: &str) -> io::Result<()> {
        let mut block = link_type.to_le_bytes().to_vec();
        // No limit to the length of packets.
        block.extend([0; 6]);
        block.extend(OPTION_NAME.to_le_bytes());
        block.extend((name.len() as u16).to_le_bytes());
        padded(&mut block, name.as_bytes());
        block.extend([0; 4]);
        self.block(INTERFACE, &block)
    }

    fn block(&mut self, kind: u32, content: &[u8]) -> io::Result<()> {
        let length = (content.len() as u32 + 12).to_le_bytes();
        let block = [&kind.to_le_bytes(), &length, content, &length].concat();
        self.file.write_all(&block)
    }

    /// A packet of a connection.
    fn tcp(&mut self, client: SocketAddr, server: SocketAddr, seen: Seen) -> io::Result<Vec<u8>> {
        let sent = self.sent.entry((client, server)).or_default();
        let (from, to, [own, other]) = match seen.direction {
            Direction::In => (client, server, [sent[0], sent[1]]),
            Direction::Out => (server, client, [sent[1], sent[0]]),
        };
        let length = seen.bytes.len() as u32;
        let count = &mut sent[usize::from(seen.direction == Direction::Out)];
        *count = count.wrapping_add(length);
        let mut tcp = TcpHeader::new(from.port(), to.port(), own.wrapping_add(1), WINDOW);
        tcp.ack = true;
        tcp.psh = true;
        tcp.acknowledgment_number = other.wrapping_add(1);
        let too_long =
            |error: &dyn ToString| io::Error::new(ErrorKind::InvalidData, error.to_string());
        let mut packet = Vec::new();
        let carried = tcp.header_len() + seen.bytes.len();
        match (from, to) {
            (SocketAddr::V4(from), SocketAddr::V4(to)) => {
                let (from, to) = (from.ip().octets(), to.ip().octets());
                let carried = u16::try_from(carried).map_err(|error| too_long(&error))?;
                let mut ip = Ipv4Header::new(carried, HOPS, IpNumber::TCP, from, to)
                    .map_err(|error| too_long(&error))?;
                ip.header_checksum = ip.calc_header_checksum();
                tcp.checksum = tcp
                    .calc_checksum_ipv4(&ip, seen.bytes)
                    .map_err(|error| too_long(&error))?;
                ip.write(&mut packet)?;
            }
            (from, to) => {
                let octets = |address: SocketAddr| match address {
                    SocketAddr::V4(address) => address.ip().to_ipv6_mapped().octets(),
                    SocketAddr::V6(address) => address.ip().octets(),
                };
                let ip = Ipv6Header {
                    traffic_class: 0,
                    flow_label: Ipv6FlowLabel::ZERO,
                    payload_length: u16::try_from(carried).map_err(|error| too_long(&error))?,
                    next_header: IpNumber::TCP,
                    hop_limit: HOPS,
                    source: octets(from),
                    destination: octets(to),
                };
                tcp.checksum = tcp
                    .calc_checksum_ipv6(&ip, seen.bytes)
                    .map_err(|error| too_long(&error))?;
                ip.write(&mut packet)?;
            }
        }
        tcp.write(&mut packet)?;
        packet.extend(seen.bytes);
        Ok(packet)
    }
}

/// Serial data with its header: time, kind of event, state of the control lines, two bytes that mean nothing here.
fn serial(at_us: u64, seen: Seen) -> Vec<u8> {
    let event = match seen.direction {
        Direction::In => DATA_RECEIVED,
        Direction::Out => DATA_SENT,
    };
    let mut packet = ((at_us / 1_000_000) as u32).to_be_bytes().to_vec();
    packet.extend(((at_us % 1_000_000) as u32).to_be_bytes());
    packet.extend([event, 0, 0, 0]);
    packet.extend(seen.bytes);
    packet
}

/// Appends bytes up to a multiple of four.
fn padded(block: &mut Vec<u8>, bytes: &[u8]) {
    block.extend(bytes);
    block.resize(block.len().next_multiple_of(4), 0);
}
