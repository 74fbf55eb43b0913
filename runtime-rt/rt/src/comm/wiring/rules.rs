//! Rules of ports by kind, as functions: a program links only those of the ports it has.

use super::{
    Choice, D_CARD, M_PARALLEL_MASTER, M_PARALLEL_SLAVE, M_PORT_2_MODBUS, M_PORT_2_SET_UP,
    M_PORT_3_SET_UP, PortWiring, Protocol, by_number, value,
};
use crate::comm::LineFault;
use crate::comm::line::LineFormat;
use crate::comm::port::Session;
use crate::comm::slaves::H1U;
use crate::plc::Plc;

/// Type of the CAN card.
const CAN_CARD: u16 = 7;

/// Rules of a kind of port.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// Protocol that the registers choose now; the words are the setup by UINIT.
    pub(super) protocol: fn(&PortWiring, &dyn Plc, [u16; 3]) -> Protocol,
    /// The format of characters that the registers choose, for the free protocol (true) or others.
    pub(super) line: fn(&PortWiring, &dyn Plc, [u16; 3], bool) -> LineFormat,
    /// Shows an error of Modbus, of a master (true) or a slave.
    pub(super) note_modbus: fn(&PortWiring, &mut dyn Plc, bool, LineFault),
    /// Serves a bus that may be there instead of a serial port; whether it is.
    pub(super) bus: Option<fn(&mut Session) -> bool>,
}

impl Rules {
    const fn new(protocol: fn(&PortWiring, &dyn Plc, [u16; 3]) -> Protocol) -> Self {
        Rules {
            protocol,
            line: |wiring, plc, _, free| by_word(wiring, plc, free),
            note_modbus: |wiring, plc, _, fault| wiring.note_usual(plc, fault),
            bus: None,
        }
    }

    /// Serves a bus that may be there instead of a serial port; whether it is.
    pub(in crate::comm) fn bus(&self, session: &mut Session) -> bool {
        self.bus.is_some_and(|bus| bus(session))
    }

    /// Those of ports whose protocol is chosen so.
    pub(super) const fn of(choice: Choice) -> &'static Self {
        match choice {
            Choice::Com0 => &COM0,
            Choice::Number => &NUMBER,
            Choice::Com1 => &COM1,
            Choice::ProgrammingPort => &PROGRAMMING_PORT,
            Choice::Can => &CAN,
            Choice::L01sPort2 => &L01S_PORT_2,
            Choice::L01sPort3 => &L01S_PORT_3,
            Choice::Uinit => &UINIT,
            Choice::Format => &FORMAT,
            Choice::Channel => &CHANNEL,
            Choice::Channel0 => &CHANNEL_0,
            Choice::Board => &BOARD,
        }
    }
}

/// The format of characters that the format word chooses.
#[inline(always)]
fn by_word(wiring: &PortWiring, plc: &(impl Plc + ?Sized), free: bool) -> LineFormat {
    let format = LineFormat::from_word(value(plc, wiring.format));
    match free && !wiring.one_pair {
        true => format,
        false => format.half_duplex(),
    }
}

impl PortWiring {
    /// Returns true if [`advance_slave`](crate::comm::advance_slave) supports the port: the inputs of its selection are
    /// all known when a program is built.
    pub const fn may_be_slave_alone(&self) -> bool {
        matches!(
            self.choice,
            Choice::Com0
                | Choice::Com1
                | Choice::Number
                | Choice::L01sPort2
                | Choice::L01sPort3
                | Choice::Uinit
        )
    }

    /// Protocol that the registers choose now on such a port, as [`Rules::protocol`] does for all; the words are the
    /// setup by UINIT.
    #[inline(always)]
    pub(in crate::comm) fn protocol_of(
        &self,
        plc: &(impl Plc + ?Sized),
        uinit: [u16; 3],
    ) -> Protocol {
        match self.choice {
            Choice::Com0 => com0(self, plc),
            Choice::Com1 => com1(self, plc),
            Choice::Number => by_number(self, plc),
            Choice::L01sPort2 => l01s_port_2(self, plc),
            Choice::L01sPort3 => l01s_port_3(self, plc),
            Choice::Uinit => by_uinit(uinit),
            _ => Protocol::Off,
        }
    }

    /// The format of characters of a slave on such a port.
    #[inline(always)]
    pub(in crate::comm) fn line_of(
        &self,
        plc: &(impl Plc + ?Sized),
        uinit: [u16; 3],
    ) -> LineFormat {
        match self.choice {
            Choice::Uinit => LineFormat::from_uinit(uinit[1], self.one_pair),
            _ => by_word(self, plc, false),
        }
    }
}

#[inline(always)]
fn com0(wiring: &PortWiring, plc: &(impl Plc + ?Sized)) -> Protocol {
    match value(plc, wiring.protocol) {
        2 if plc.sys().running => Protocol::ModbusRtu,
        3 if plc.sys().running => Protocol::ModbusAscii,
        _ => Protocol::ProgrammingPort,
    }
}

const COM0: Rules = Rules::new(|wiring, plc, _| com0(wiring, plc));

const NUMBER: Rules = Rules::new(|wiring, plc, _| by_number(wiring, plc));

#[inline(always)]
fn com1(wiring: &PortWiring, plc: &(impl Plc + ?Sized)) -> Protocol {
    match (M_PARALLEL_MASTER.is_on(plc), M_PARALLEL_SLAVE.is_on(plc)) {
        (true, true) => Protocol::Off,
        (true, false) => Protocol::ParallelMaster,
        (false, true) => Protocol::ParallelSlave,
        (false, false) => by_number(wiring, plc),
    }
}

const COM1: Rules = Rules::new(|wiring, plc, _| com1(wiring, plc));

const PROGRAMMING_PORT: Rules = Rules::new(|_, _, _| Protocol::ProgrammingPort);

const CAN: Rules = Rules {
    bus: Some(|session| session.advance_can()),
    ..Rules::new(
        |_, plc, _| match (plc.type_code() / 1000, D_CARD.value(plc)) {
            (H1U, card) if card != CAN_CARD => Protocol::Off,
            _ => Protocol::Can,
        },
    )
};

/// l01s-programming §9.2: a master of Modbus has station 255.
#[inline(always)]
fn l01s_port_2(wiring: &PortWiring, plc: &(impl Plc + ?Sized)) -> Protocol {
    const MASTER: u16 = 255;
    let format = value(plc, wiring.format);
    let ascii = format & 1 << 12 != 0;
    if !M_PORT_2_SET_UP.is_on(plc) {
        Protocol::ProgrammingPort
    } else if !M_PORT_2_MODBUS.is_on(plc) {
        match format >> 13 & 3 {
            3 => Protocol::ComputerLink,
            _ => Protocol::Free,
        }
    } else {
        match (value(plc, wiring.station) == MASTER, ascii) {
            (false, false) => Protocol::ModbusRtu,
            (false, true) => Protocol::ModbusAscii,
            (true, false) => Protocol::MasterRtu,
            (true, true) => Protocol::MasterAscii,
        }
    }
}

const L01S_PORT_2: Rules = Rules::new(|wiring, plc, _| l01s_port_2(wiring, plc));

#[inline(always)]
fn l01s_port_3(wiring: &PortWiring, plc: &(impl Plc + ?Sized)) -> Protocol {
    if !M_PORT_3_SET_UP.is_on(plc) {
        return Protocol::ProgrammingPort;
    }
    match value(plc, wiring.protocol) {
        0x000 => Protocol::Free,
        0x001 => Protocol::MasterRtu,
        0x011 => Protocol::ModbusRtu,
        0x101 => Protocol::MasterAscii,
        0x111 => Protocol::ModbusAscii,
        _ => Protocol::Off,
    }
}

const L01S_PORT_3: Rules = Rules::new(|wiring, plc, _| l01s_port_3(wiring, plc));

fn by_uinit(uinit: [u16; 3]) -> Protocol {
    match (uinit[0] >> 8, uinit[0] & 0xff) {
        (0, 0) | (1, _) => Protocol::ProgrammingPort,
        (2, _) => Protocol::ComputerLinkMaster,
        (3, _) => Protocol::ComputerLink,
        (4, 0) => Protocol::MasterRtu,
        (4, _) => Protocol::ModbusRtu,
        (5, _) => Protocol::Free,
        _ => Protocol::Off,
    }
}

const UINIT: Rules = Rules {
    line: |wiring, _, uinit, _| LineFormat::from_uinit(uinit[1], wiring.one_pair),
    ..Rules::new(|_, _, uinit| by_uinit(uinit))
};

const FORMAT: Rules = Rules::new(|wiring, plc, _| match wiring.fx_link(plc) {
    Some(link) => link,
    None if value(plc, wiring.format) & 1 << 14 != 0 => Protocol::ComputerLink,
    None => Protocol::Free,
});

const CHANNEL: Rules = Rules {
    note_modbus: |wiring, plc, master, fault| wiring.note_modbus(plc, fault.of_fx3(master), 0),
    ..Rules::new(|wiring, plc, _| wiring.channel(plc))
};

const CHANNEL_0: Rules = Rules::new(|wiring, plc, _| match value(plc, wiring.format) {
    0 => Protocol::ProgrammingPort,
    _ => Protocol::Free,
});

const BOARD: Rules = Rules::new(|wiring, plc, _| match value(plc, wiring.format) >> 14 {
    0b10 | 0b11 => Protocol::MasterRtu,
    0b01 => Protocol::ModbusRtu,
    _ => Protocol::Free,
});
