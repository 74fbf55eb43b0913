//! A program whose only port is nothing but a slave by Modbus RTU: all that this does not need is left out when it is
//! built, for microcontrollers.

use super::LineFault;
use super::elements::{ByElement, Elements};
use super::line::LineFormat;
use super::modbus::{Framing, LONGEST_RTU, Settings, answer_rtu};
use super::port::{Session, keep};
use super::port_protocol::{PortProtocol, end_of_frame_us};
use super::wiring::{PortWiring, Ports, Protocol};
use crate::hal::Hal;
use crate::plc::Plc;

/// A slave by Modbus RTU on a port of a family of models, both by their numbers.
pub(super) struct SlaveAlone<const FAMILY: u8, const NUMBER: u8>;

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

impl<P, H, const FAMILY: u8, const NUMBER: u8> PortProtocol
    for Session<'_, P, H, SlaveAlone<FAMILY, NUMBER>>
where
    P: Plc + Elements,
    H: Hal + ?Sized,
{
    fn wiring(&self) -> &'static PortWiring {
        SlaveAlone::<FAMILY, NUMBER>::WIRING
    }

    fn chosen_protocol(&self) -> Protocol {
        match self.wiring().protocol_of(self.plc, self.status.uinit) {
            Protocol::ModbusRtu => Protocol::ModbusRtu,
            _ => Protocol::Off,
        }
    }

    fn has_protocol(&self) -> bool {
        self.status.protocol == Protocol::ModbusRtu
    }

    fn line(&self) -> LineFormat {
        let format = self.wiring().line_of(self.plc, self.status.uinit);
        match self.has_protocol() {
            true => format.eight_bits(),
            false => format,
        }
    }

    fn silence_us(&self) -> u32 {
        end_of_frame_us(self.status.format, 0)
    }

    fn receive_frame(&mut self, length: usize) {
        let settings = Settings {
            framing: Framing::Rtu,
            station: self.station(),
            profile: self.plc.modbus(),
        };
        self.reply::<LONGEST_RTU>(length, |plc, request, reply| {
            answer_rtu(&settings, request, &mut ByElement(plc), reply)
        });
    }

    fn show_error(&mut self, fault: LineFault) {
        match self.has_protocol() {
            true => self.wiring().note_usual(self.plc, fault),
            false => self.wiring().note_general(self.plc, fault),
        }
    }
}
