//! A program whose only port is nothing but a slave by Modbus RTU: all that this does not need is left out when it is
//! built, for microcontrollers.

use super::elements::{ByElement, Elements};
use super::line::{LineFormat, Received};
use super::modbus::{Framing, LONGEST_RTU, Settings, answer_rtu};
use super::port::{Session, keep};
use super::speech::{Spoken, end_of_frame_us};
use super::wiring::{PortWiring, Ports, Protocol};
use super::{Cut, LineFault};
use crate::hal::Hal;
use crate::plc::Plc;

/// A slave by Modbus RTU on a port of a family of models, both by their numbers.
struct SlaveAlone<const FAMILY: u8, const NUMBER: u8>;

impl<const FAMILY: u8, const NUMBER: u8> SlaveAlone<FAMILY, NUMBER> {
    /// The special devices of the port, alone: what is known of them is not read from memory.
    const WIRING: &'static PortWiring = &wired(FAMILY, NUMBER);
}

/// The special devices of a port, which is there, of the family with a number.
const fn wired(family: u8, number: u8) -> PortWiring {
    let mut families = Ports::families();
    while let [first, rest @ ..] = families {
        let mut ports = first.all();
        while let [port, others @ ..] = ports {
            if *first as u8 == family && port.number == number {
                return *port;
            }
            ports = others;
        }
        families = rest;
    }
    panic!("the family has no such port")
}

/// Brings the only port of a program to `now_us`, as [`super::advance`] does, if a slave by Modbus RTU is all that it
/// may be: port `NUMBER` of the family with the number `FAMILY`. Such a slave asks for neither RUN nor STOP.
pub fn advance_slave<const FAMILY: u8, const NUMBER: u8>(
    plc: &mut (impl Plc + Elements),
    hal: &mut (impl Hal + ?Sized),
    now_us: u32,
) {
    let Some(port) = plc.port(NUMBER) else {
        return;
    };
    let status = *port.status;
    let mut session = Session {
        plc,
        hal,
        status,
        own: SlaveAlone::<FAMILY, NUMBER>,
        now_us,
        request: None,
    };
    session.run();
    if let Some(port) = session.plc.port(NUMBER) {
        keep(port.status, &session.status);
    }
}

type Slave<'a, P, H, const FAMILY: u8, const NUMBER: u8> =
    Session<'a, P, H, SlaveAlone<FAMILY, NUMBER>>;

impl<'a, P: Plc + Elements, H: Hal + ?Sized, const FAMILY: u8, const NUMBER: u8> Spoken<'a, P, H>
    for SlaveAlone<FAMILY, NUMBER>
{
    fn wiring(_: &Slave<'a, P, H, FAMILY, NUMBER>) -> &'static PortWiring {
        Self::WIRING
    }

    fn protocol(session: &Slave<'a, P, H, FAMILY, NUMBER>) -> Protocol {
        match Self::WIRING.protocol_of(session.plc, session.status.uinit) {
            Protocol::ModbusRtu => Protocol::ModbusRtu,
            _ => Protocol::Off,
        }
    }

    fn forget(_: &mut Slave<'a, P, H, FAMILY, NUMBER>) {}

    fn find_codec(_: &mut Slave<'a, P, H, FAMILY, NUMBER>) {}

    fn is_spoken(session: &Slave<'a, P, H, FAMILY, NUMBER>) -> bool {
        session.status.protocol == Protocol::ModbusRtu
    }

    fn has_bus(_: &mut Slave<'a, P, H, FAMILY, NUMBER>) -> bool {
        false
    }

    fn line(session: &Slave<'a, P, H, FAMILY, NUMBER>) -> LineFormat {
        let format = Self::WIRING.line_of(session.plc, session.status.uinit);
        match Self::is_spoken(session) {
            true => format.eight_bits(),
            false => format,
        }
    }

    fn asked_rate(_: &Slave<'a, P, H, FAMILY, NUMBER>) -> u16 {
        0
    }

    fn ends_by_silence(_: &Slave<'a, P, H, FAMILY, NUMBER>) -> bool {
        true
    }

    fn silence_us(session: &Slave<'a, P, H, FAMILY, NUMBER>) -> u32 {
        end_of_frame_us(session.status.format, 0)
    }

    fn has_frames(_: &Slave<'a, P, H, FAMILY, NUMBER>) -> bool {
        true
    }

    fn character(_: &mut Slave<'a, P, H, FAMILY, NUMBER>, _: Received) -> bool {
        false
    }

    fn cut(_: &mut Slave<'a, P, H, FAMILY, NUMBER>, _: usize) -> Cut {
        Cut::Drop
    }

    fn take(session: &mut Slave<'a, P, H, FAMILY, NUMBER>, received: usize) {
        let settings = Settings {
            framing: Framing::Rtu,
            station: session.station(),
            profile: session.plc.modbus(),
        };
        session.reply::<LONGEST_RTU>(received, |plc, request, reply| {
            answer_rtu(&settings, request, &mut ByElement(plc), reply)
        });
    }

    fn advance(_: &mut Slave<'a, P, H, FAMILY, NUMBER>) {}

    fn sent(_: &mut Slave<'a, P, H, FAMILY, NUMBER>) {}

    fn note(session: &mut Slave<'a, P, H, FAMILY, NUMBER>, fault: LineFault) {
        match Self::is_spoken(session) {
            true => Self::WIRING.note_usual(session.plc, fault),
            false => Self::WIRING.note_general(session.plc, fault),
        }
    }
}
