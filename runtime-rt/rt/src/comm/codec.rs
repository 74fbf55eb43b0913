//! Protocols of serial ports as a table: a program links the codecs that its ports may need.

use super::line::{LineFormat, Received};
use super::modbus::{self, Framing, LONGEST_RTU};
use super::parts::{Progress, Status};
use super::port::{FRAME, Session};
use super::port_protocol::GIVEN_UP_US;
use super::slaves::{Slave, role};
use super::wiring::{PortWiring, note_programming_port};
use super::{
    CanFrame, Cut, LineFault, Protocol, Protocols, can, canlink, computer_link, fx_port, qlink,
};
use crate::plc::Plc;

/// The format of characters on the way to a CAN adapter; USB adapters ignore it.
const ADAPTER: LineFormat = LineFormat {
    bits_per_second: 1_000_000,
    ..LineFormat::new()
};

/// An entry of the table: a protocol, or several that belong together.
pub struct Codec {
    protocols: Protocols,
    /// Implementation of the protocol.
    pub(super) handler: &'static dyn Handler,
}

impl Codec {
    const fn new(protocols: Protocols, handler: &'static dyn Handler) -> Self {
        Codec { protocols, handler }
    }

    /// The one for a protocol.
    pub(super) fn of(protocol: Protocol) -> Option<&'static Self> {
        let mut all = ALL.iter().copied();
        all.find(|codec| codec.protocols.contains(protocol))
    }

    /// Its name in emitted code, in small letters. Programs do not carry it.
    pub fn name(&self) -> &'static str {
        let mut names = ALL.iter().zip(NAMES);
        let named = names.find(|(codec, _)| codec.protocols == self.protocols);
        named.map_or("", |(_, name)| name)
    }

    /// The protocols that it is for.
    pub const fn protocols(&self) -> Protocols {
        self.protocols
    }
}

/// Behaviour of a port under a protocol. What is not overridden does nothing.
pub(super) trait Handler: Sync {
    /// Format of characters on the line.
    fn line(
        &self,
        wiring: &PortWiring,
        plc: &dyn Plc,
        _protocol: Protocol,
        uinit: [u16; 3],
    ) -> LineFormat {
        wiring.own_line(plc, uinit, false)
    }

    /// Shows an error in the special devices of the port.
    fn show_error(
        &self,
        wiring: &PortWiring,
        plc: &mut dyn Plc,
        _protocol: Protocol,
        fault: LineFault,
    ) {
        wiring.note_general(plc, fault);
    }

    /// End of the frame that the characters received so far begin, if it is not silence that ends frames.
    fn cut(&self, _status: &Status, _progress: &Progress, _slave: Slave, _received: &[u8]) -> Cut {
        Cut::Drop
    }

    /// Handles a frame of `length` characters.
    fn receive(&self, _session: &mut Session, _length: usize) {}

    /// Handles a character, in protocols without frames.
    fn receive_character(&self, _session: &mut Session, _character: Received) {}

    /// Handles a frame of a CAN bus. Returns false if it is not for this protocol.
    fn receive_can(&self, _plc: &mut dyn Plc, _frame: &CanFrame) -> bool {
        false
    }

    /// Silence after which a frame that has a length or an end is given up, in microseconds.
    fn given_up_us(&self, _wiring: &PortWiring, _plc: &dyn Plc) -> u32 {
        GIVEN_UP_US
    }

    /// Takes notice that the rest of a frame of `length` characters has not come.
    fn give_up(&self, _session: &mut Session, _length: usize) {}

    /// Does what is due, at the end of each call.
    fn poll(&self, _session: &mut Session) {}

    /// Takes notice that a frame has been sent.
    fn sent(&self, _session: &mut Session) {}
}

struct Free;

impl Handler for Free {
    fn line(&self, wiring: &PortWiring, plc: &dyn Plc, _: Protocol, uinit: [u16; 3]) -> LineFormat {
        wiring.own_line(plc, uinit, true)
    }

    fn receive_character(&self, session: &mut Session, character: Received) {
        session.take_free(character);
    }

    fn poll(&self, session: &mut Session) {
        session.advance_free();
    }
}

struct ProgrammingPort;

impl Handler for ProgrammingPort {
    fn line(&self, wiring: &PortWiring, _: &dyn Plc, _: Protocol, _: [u16; 3]) -> LineFormat {
        LineFormat::seven_even(9600, wiring.one_pair)
    }

    fn show_error(&self, _: &PortWiring, plc: &mut dyn Plc, _: Protocol, fault: LineFault) {
        note_programming_port(plc, fault);
    }

    fn cut(&self, _: &Status, _: &Progress, _: Slave, received: &[u8]) -> Cut {
        fx_port::cut(received)
    }

    fn receive(&self, session: &mut Session, length: usize) {
        let mut rate = None;
        session.answer_with_memory::<FRAME>(length, |slave, request, memory, map, reply| {
            let settings = slave.family.programming_port();
            rate = fx_port::text_of(request).ok().and_then(fx_port::rate);
            fx_port::answer(settings, memory, request, map, reply)
        });
        session.status.rate = rate.unwrap_or(session.status.rate);
    }
}

struct ModbusRtu;

impl Handler for ModbusRtu {
    fn line(&self, wiring: &PortWiring, plc: &dyn Plc, _: Protocol, uinit: [u16; 3]) -> LineFormat {
        wiring.own_line(plc, uinit, false).eight_bits()
    }

    fn show_error(&self, wiring: &PortWiring, plc: &mut dyn Plc, of: Protocol, fault: LineFault) {
        wiring.note_of_modbus(plc, of.is_master(), fault);
    }

    fn receive(&self, session: &mut Session, length: usize) {
        match session.codec_of(Protocols::QLINK) {
            Some(qlink) if session.is_whole(qlink, length) => {
                qlink.handler.receive(session, length);
            }
            _ => session.answer::<LONGEST_RTU>(length, |slave, request, _, map, reply| {
                modbus::answer_rtu(&slave.modbus(Framing::Rtu), request, map, reply)
            }),
        }
    }
}

struct Qlink;

impl Handler for Qlink {
    fn cut(&self, _: &Status, _: &Progress, slave: Slave, received: &[u8]) -> Cut {
        match slave.has_qlink() && qlink::is_qlink(received) {
            true => Cut::Whole,
            false => Cut::Drop,
        }
    }

    fn receive(&self, session: &mut Session, length: usize) {
        session.answer_with_memory::<FRAME>(length, |slave, request, memory, map, reply| {
            let settings = slave.modbus(Framing::Rtu);
            let devices = slave.qlink_devices();
            qlink::answer(&settings, devices, memory, request, map, reply)
        });
    }
}

struct ModbusAscii;

impl Handler for ModbusAscii {
    fn show_error(&self, wiring: &PortWiring, plc: &mut dyn Plc, of: Protocol, fault: LineFault) {
        wiring.note_of_modbus(plc, of.is_master(), fault);
    }

    fn cut(&self, _: &Status, _: &Progress, _: Slave, received: &[u8]) -> Cut {
        modbus::cut_ascii(received)
    }

    fn receive(&self, session: &mut Session, length: usize) {
        session.answer::<FRAME>(length, |slave, request, _, map, reply| {
            modbus::answer_ascii(&slave.modbus(Framing::Ascii), request, map, reply)
        });
    }
}

struct MasterRtu;

impl Handler for MasterRtu {
    fn line(&self, wiring: &PortWiring, plc: &dyn Plc, _: Protocol, uinit: [u16; 3]) -> LineFormat {
        wiring.own_line(plc, uinit, false).eight_bits()
    }

    fn show_error(&self, wiring: &PortWiring, plc: &mut dyn Plc, of: Protocol, fault: LineFault) {
        wiring.note_of_modbus(plc, of.is_master(), fault);
    }

    fn receive(&self, session: &mut Session, length: usize) {
        session.take_answer::<LONGEST_RTU>(Framing::Rtu, length);
    }

    fn poll(&self, session: &mut Session) {
        session.advance_master::<LONGEST_RTU>(Framing::Rtu);
    }
}

struct MasterAscii;

impl Handler for MasterAscii {
    fn show_error(&self, wiring: &PortWiring, plc: &mut dyn Plc, of: Protocol, fault: LineFault) {
        wiring.note_of_modbus(plc, of.is_master(), fault);
    }

    fn cut(&self, _: &Status, _: &Progress, _: Slave, received: &[u8]) -> Cut {
        modbus::cut_ascii(received)
    }

    fn receive(&self, session: &mut Session, length: usize) {
        session.take_answer::<FRAME>(Framing::Ascii, length);
    }

    fn poll(&self, session: &mut Session) {
        session.advance_master::<FRAME>(Framing::Ascii);
    }
}

struct ComputerLink;

impl Handler for ComputerLink {
    fn cut(&self, _: &Status, _: &Progress, slave: Slave, received: &[u8]) -> Cut {
        computer_link::cut(slave.computer_link(), received)
    }

    fn receive(&self, session: &mut Session, length: usize) {
        session.answer::<FRAME>(length, |slave, request, remote, map, reply| {
            computer_link::answer(slave.computer_link(), remote, request, map, reply)
        });
    }

    /// The time-out of the port (FX communication manual 12.4.2: the monitor timer).
    fn given_up_us(&self, wiring: &PortWiring, plc: &dyn Plc) -> u32 {
        wiring.time_out_us(plc)
    }

    fn give_up(&self, session: &mut Session, length: usize) {
        session.answer::<FRAME>(length, |slave, request, remote, map, reply| {
            computer_link::answer_late(slave.computer_link(), remote, request, map, reply)
        });
    }

    fn poll(&self, session: &mut Session) {
        session.advance_on_demand();
    }

    fn sent(&self, session: &mut Session) {
        session.end_on_demand();
    }
}

struct Link;

impl Handler for Link {
    fn line(
        &self,
        wiring: &PortWiring,
        plc: &dyn Plc,
        protocol: Protocol,
        uinit: [u16; 3],
    ) -> LineFormat {
        match protocol {
            Protocol::ComputerLinkMaster => wiring.own_line(plc, uinit, false),
            _ => wiring.linked(plc, protocol),
        }
    }

    fn show_error(&self, wiring: &PortWiring, plc: &mut dyn Plc, of: Protocol, fault: LineFault) {
        wiring.note_of_link(plc, of, fault);
    }

    fn cut(&self, status: &Status, progress: &Progress, _: Slave, received: &[u8]) -> Cut {
        match role(status.protocol, status.uinit[2]) {
            Some(role) => progress.link.cut(role, received),
            None => Cut::Drop,
        }
    }

    fn receive(&self, session: &mut Session, length: usize) {
        session.take_linked(length);
    }

    fn poll(&self, session: &mut Session) {
        session.advance_link();
    }
}

struct Can;

impl Handler for Can {
    fn line(&self, _: &PortWiring, _: &dyn Plc, _: Protocol, _: [u16; 3]) -> LineFormat {
        ADAPTER
    }

    fn cut(&self, _: &Status, _: &Progress, _: Slave, received: &[u8]) -> Cut {
        can::cut(received)
    }

    fn receive(&self, session: &mut Session, length: usize) {
        session.take_can(length);
    }
}

struct Canlink;

impl Handler for Canlink {
    fn receive_can(&self, plc: &mut dyn Plc, frame: &CanFrame) -> bool {
        canlink::take(plc, frame)
    }
}

/// RS, RS2, USEND, URCV.
pub const FREE: Codec = Codec::new(Protocols::of(&[Protocol::Free]), &Free);

/// The programming port.
pub const PROGRAMMING_PORT: Codec = Codec::new(
    Protocols::of(&[Protocol::ProgrammingPort]),
    &ProgrammingPort,
);

/// A slave by Modbus RTU.
pub const MODBUS_RTU: Codec = Codec::new(Protocols::of(&[Protocol::ModbusRtu]), &ModbusRtu);

/// QLink, which a slave by Modbus RTU of H1U and H2U answers, too.
pub const QLINK: Codec = Codec::new(Protocols::QLINK, &Qlink);

/// A slave by Modbus ASCII.
pub const MODBUS_ASCII: Codec = Codec::new(Protocols::of(&[Protocol::ModbusAscii]), &ModbusAscii);

/// A master by Modbus RTU.
pub const MASTER_RTU: Codec = Codec::new(
    Protocols::of(&[Protocol::MasterRtu, Protocol::MasterTable]),
    &MasterRtu,
);

/// A master by Modbus ASCII.
pub const MASTER_ASCII: Codec = Codec::new(Protocols::of(&[Protocol::MasterAscii]), &MasterAscii);

/// A slave of a computer link.
pub const COMPUTER_LINK: Codec =
    Codec::new(Protocols::of(&[Protocol::ComputerLink]), &ComputerLink);

/// Links that PLCs keep up by themselves.
pub const LINK: Codec = Codec::new(Protocols::LINKS, &Link);

/// Frames of CAN.
pub const CAN: Codec = Codec::new(Protocols::of(&[Protocol::Can]), &Can);

/// CANlink, beside frames of the program's own.
pub const CANLINK: Codec = Codec::new(Protocols::CANLINK, &Canlink);

/// All of them.
pub const ALL: &[&Codec] = &[
    &FREE,
    &PROGRAMMING_PORT,
    &MODBUS_RTU,
    &QLINK,
    &MODBUS_ASCII,
    &MASTER_RTU,
    &MASTER_ASCII,
    &COMPUTER_LINK,
    &LINK,
    &CAN,
    &CANLINK,
];

/// Their names in the same order.
const NAMES: [&str; ALL.len()] = [
    "free",
    "programming_port",
    "modbus_rtu",
    "qlink",
    "modbus_ascii",
    "master_rtu",
    "master_ascii",
    "computer_link",
    "link",
    "can",
    "canlink",
];
