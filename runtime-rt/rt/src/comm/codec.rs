//! What a port does under each protocol, as a table: a program links the codecs that its ports may need.

use super::line::{LineFormat, Received};
use super::modbus::{self, Framing, LONGEST_RTU};
use super::parts::{Progress, Status};
use super::port::{FRAME, Session};
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

/// What a port does under one protocol, or under several that belong together.
#[derive(Debug)]
pub struct Codec {
    /// Its name in emitted code.
    name: &'static str,
    protocols: Protocols,
    /// Whether the characters received so far are a frame, if it is not silence that ends them.
    cut: fn(&Status, &Progress, Slave, &[u8]) -> Cut,
    /// Takes a frame of this many characters.
    take: for<'a, 'b> fn(&'a mut Session<'b>, usize),
    /// Takes a character, in protocols that have no frames.
    character: Option<for<'a, 'b> fn(&'a mut Session<'b>, Received)>,
    /// Takes a frame of a CAN bus; false if it is not for this protocol.
    bus: fn(&mut dyn Plc, &CanFrame) -> bool,
    /// Does what is to be done by now: at the end of each call.
    advance: for<'a, 'b> fn(&'a mut Session<'b>),
    /// A frame has been sent.
    sent: for<'a, 'b> fn(&'a mut Session<'b>),
    /// The format of characters on the line.
    line: fn(&PortWiring, &dyn Plc, Protocol, [u16; 3]) -> LineFormat,
    /// Shows an error.
    note: fn(&PortWiring, &mut dyn Plc, Protocol, LineFault),
}

impl Codec {
    /// One that does nothing.
    const fn new(name: &'static str, protocols: Protocols) -> Self {
        Codec {
            name,
            protocols,
            cut: |_, _, _, _| Cut::Drop,
            take: |_, _| {},
            character: None,
            bus: |_, _| false,
            advance: |_| {},
            sent: |_| {},
            line: |wiring, plc, _, uinit| wiring.own_line(plc, uinit, false),
            note: |wiring, plc, _, fault| wiring.note_general(plc, fault),
        }
    }

    /// One for Modbus, by RTU frames or by ASCII.
    const fn of_modbus(name: &'static str, protocols: Protocols, framing: Framing) -> Self {
        Codec {
            line: match framing {
                Framing::Rtu => {
                    |wiring, plc, _, uinit| wiring.own_line(plc, uinit, false).eight_bits()
                }
                Framing::Ascii => |wiring, plc, _, uinit| wiring.own_line(plc, uinit, false),
            },
            note: |wiring, plc, protocol, fault| {
                wiring.note_of_modbus(plc, protocol.is_master(), fault);
            },
            ..Codec::new(name, protocols)
        }
    }

    /// The one for a protocol.
    pub(super) fn of(protocol: Protocol) -> Option<&'static Self> {
        let mut all = ALL.iter().copied();
        all.find(|codec| codec.protocols.contains(protocol))
    }

    pub(super) fn line(
        &self,
        wiring: &PortWiring,
        plc: &dyn Plc,
        protocol: Protocol,
        uinit: [u16; 3],
    ) -> LineFormat {
        (self.line)(wiring, plc, protocol, uinit)
    }

    pub(super) fn note(
        &self,
        wiring: &PortWiring,
        plc: &mut dyn Plc,
        protocol: Protocol,
        fault: LineFault,
    ) {
        (self.note)(wiring, plc, protocol, fault);
    }

    /// Its name in emitted code, in small letters.
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// The protocols that it is for.
    pub const fn protocols(&self) -> Protocols {
        self.protocols
    }

    /// Whether it takes characters rather than frames, and sends by itself.
    pub(super) const fn has_no_frames(&self) -> bool {
        self.character.is_some()
    }

    pub(super) fn cut(
        &self,
        status: &Status,
        progress: &Progress,
        slave: Slave,
        received: &[u8],
    ) -> Cut {
        (self.cut)(status, progress, slave, received)
    }

    pub(super) fn take(&self, session: &mut Session, received: usize) {
        (self.take)(session, received);
    }

    /// Takes a character; false if it belongs to a frame.
    pub(super) fn character(&self, session: &mut Session, character: Received) -> bool {
        if let Some(take) = self.character {
            take(session, character);
        }
        self.character.is_some()
    }

    /// Takes a frame of a CAN bus; false if it is not for this protocol.
    pub(super) fn take_from_bus(&self, plc: &mut dyn Plc, frame: &CanFrame) -> bool {
        (self.bus)(plc, frame)
    }

    pub(super) fn advance(&self, session: &mut Session) {
        (self.advance)(session);
    }

    pub(super) fn sent(&self, session: &mut Session) {
        (self.sent)(session);
    }
}

/// RS, RS2, USEND, URCV.
pub const FREE: Codec = Codec {
    line: |wiring, plc, _, uinit| wiring.own_line(plc, uinit, true),
    character: Some(|session, character| session.take_free(character)),
    advance: |session| session.advance_free(),
    ..Codec::new("free", Protocols::of(&[Protocol::Free]))
};

/// The programming port.
pub const PROGRAMMING_PORT: Codec = Codec {
    line: |wiring, _, _, _| LineFormat::seven_even(9600, wiring.one_pair),
    note: |_, plc, _, fault| note_programming_port(plc, fault),
    cut: |_, _, _, received| fx_port::cut(received),
    take: |session, received| {
        let mut asked = None;
        session.answer_with_memory::<FRAME>(received, |slave, request, memory, map, reply| {
            let settings = slave.family.programming_port();
            asked = fx_port::text_of(request).ok().and_then(fx_port::rate);
            fx_port::answer(settings, memory, request, map, reply)
        });
        session.status.rate = asked.unwrap_or(session.status.rate);
    },
    ..Codec::new(
        "programming_port",
        Protocols::of(&[Protocol::ProgrammingPort]),
    )
};

/// A slave by Modbus RTU.
pub const MODBUS_RTU: Codec = Codec {
    take: |session, received| match session.codec_of(Protocols::QLINK) {
        Some(qlink) if session.is_whole(qlink, received) => qlink.take(session, received),
        _ => session.answer::<LONGEST_RTU>(received, |slave, request, _, map, reply| {
            modbus::answer_rtu(&slave.modbus(Framing::Rtu), request, map, reply)
        }),
    },
    ..Codec::of_modbus(
        "modbus_rtu",
        Protocols::of(&[Protocol::ModbusRtu]),
        Framing::Rtu,
    )
};

/// QLink, which a slave by Modbus RTU of H1U and H2U answers, too.
pub const QLINK: Codec = Codec {
    cut: |_, _, slave, received| match slave.has_qlink() && qlink::is_qlink(received) {
        true => Cut::Whole,
        false => Cut::Drop,
    },
    take: |session, received| {
        session.answer_with_memory::<FRAME>(received, |slave, request, memory, map, reply| {
            let settings = slave.modbus(Framing::Rtu);
            qlink::answer(
                &settings,
                slave.qlink_devices(),
                memory,
                request,
                map,
                reply,
            )
        });
    },
    ..Codec::new("qlink", Protocols::QLINK)
};

/// A slave by Modbus ASCII.
pub const MODBUS_ASCII: Codec = Codec {
    cut: |_, _, _, received| modbus::cut_ascii(received),
    take: |session, received| {
        session.answer::<FRAME>(received, |slave, request, _, map, reply| {
            modbus::answer_ascii(&slave.modbus(Framing::Ascii), request, map, reply)
        });
    },
    ..Codec::of_modbus(
        "modbus_ascii",
        Protocols::of(&[Protocol::ModbusAscii]),
        Framing::Ascii,
    )
};

/// A master by Modbus RTU.
pub const MASTER_RTU: Codec = Codec {
    take: |session, received| session.take_answer::<LONGEST_RTU>(Framing::Rtu, received),
    advance: |session| session.advance_master::<LONGEST_RTU>(Framing::Rtu),
    ..Codec::of_modbus(
        "master_rtu",
        Protocols::of(&[Protocol::MasterRtu, Protocol::MasterTable]),
        Framing::Rtu,
    )
};

/// A master by Modbus ASCII.
pub const MASTER_ASCII: Codec = Codec {
    cut: |_, _, _, received| modbus::cut_ascii(received),
    take: |session, received| session.take_answer::<FRAME>(Framing::Ascii, received),
    advance: |session| session.advance_master::<FRAME>(Framing::Ascii),
    ..Codec::of_modbus(
        "master_ascii",
        Protocols::of(&[Protocol::MasterAscii]),
        Framing::Ascii,
    )
};

/// A slave of a computer link.
pub const COMPUTER_LINK: Codec = Codec {
    cut: |_, _, slave, received| computer_link::cut(slave.computer_link(), received),
    take: |session, received| {
        session.answer::<FRAME>(received, |slave, request, remote, map, reply| {
            computer_link::answer(slave.computer_link(), remote, request, map, reply)
        });
    },
    advance: |session| session.advance_on_demand(),
    sent: |session| session.end_on_demand(),
    ..Codec::new("computer_link", Protocols::of(&[Protocol::ComputerLink]))
};

/// Links that PLCs keep up by themselves.
pub const LINK: Codec = Codec {
    line: |wiring, plc, protocol, uinit| match protocol {
        Protocol::ComputerLinkMaster => wiring.own_line(plc, uinit, false),
        _ => wiring.linked(plc, protocol),
    },
    note: |wiring, plc, protocol, fault| wiring.note_of_link(plc, protocol, fault),
    cut: |status, progress, _, received| match role(status.protocol, status.uinit[2]) {
        Some(role) => progress.link.cut(role, received),
        None => Cut::Drop,
    },
    take: |session, received| session.take_linked(received),
    advance: |session| session.advance_link(),
    ..Codec::new("link", Protocols::LINKS)
};

/// Frames of CAN.
pub const CAN: Codec = Codec {
    line: |_, _, _, _| ADAPTER,
    cut: |_, _, _, received| can::cut(received),
    take: |session, received| session.take_can(received),
    ..Codec::new("can", Protocols::of(&[Protocol::Can]))
};

/// CANlink, beside frames of the program's own.
pub const CANLINK: Codec = Codec {
    bus: canlink::take,
    ..Codec::new("canlink", Protocols::CANLINK)
};

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
