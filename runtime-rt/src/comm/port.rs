//! The state machine of one port, beside the scan.

use super::can::{CanFrame, CanTurn};
use super::codec::Codec;
use super::computer_link::Remote;
use super::free::Free;
use super::line::{CharFault, LineFormat, Received};
use super::link::Link;
use super::modbus::Exchange;
use super::protocols::Protocols;
use super::slaves::Slave;
use super::wiring::{Choice, M_PARALLEL_MASTER, M_PARALLEL_SLAVE, PortWiring, Protocol, value};
use super::{Cut, Frame, LineFault, Memory, Served};
use crate::hal::{Hal, SerialPort};
use crate::plc::{Plc, Sys};
use crate::special::Relay;

/// Characters of the longest frame: Modbus ASCII has 513, computer link fewer.
pub const FRAME: usize = 528;

/// After this much silence, a frame that has a length or an end is given up, in microseconds (Modbus over serial line
/// §2.5.2.1).
const GIVEN_UP_US: u32 = 1_000_000;

/// The same on links that PLCs keep up by themselves, whose partners send frames without gaps: a frame that was cut off
/// must not hold up the others.
const LINK_GIVEN_UP_US: u32 = 50_000;

/// The parallel link is set up wrongly: M8070 and M8071 are both on.
const M_SET_UP_WRONGLY: Relay = Relay(8073);

/// What a port is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Status {
    /// What it speaks.
    pub protocol: Protocol,
    /// The first scan in RUN is over: what the port speaks stays until STOP.
    pub bound: bool,
    /// Characters of a frame have come, and the silence that ends it has not.
    pub open: bool,
    /// A character of the frame was wrong: it is not answered.
    pub spoiled: bool,
    /// A frame is being sent, or waits to be.
    pub sending: bool,
    /// The last settings of the hardware.
    pub format: LineFormat,
    /// What UINIT has set up: protocol and station, format, first register of the work area.
    pub uinit: [u16; 3],
    /// Characters received.
    pub received: u16,
    /// Characters to send.
    pub to_send: u16,
    /// Characters of them that the hardware has taken.
    pub taken: u16,
    /// When the last character was in.
    pub last_us: u32,
    /// When a frame begins to be sent.
    pub due_us: u32,
    /// RS, RS2, USEND, URCV.
    pub free: Free,
    /// Links between PLCs.
    pub link: Link,
    /// Which instruction waits for a frame on CAN.
    pub can: CanTurn,
    /// RUN and STOP by computer link.
    pub remote: Remote,
    /// Instructions of a Modbus master.
    pub exchange: Exchange,
}

impl Status {
    /// A port that has not been set up.
    pub const fn new() -> Self {
        Status {
            protocol: Protocol::Off,
            bound: false,
            open: false,
            spoiled: false,
            sending: false,
            format: LineFormat {
                data_bits: 0,
                stop_bits: 0,
                ..LineFormat::new()
            },
            uinit: [0; 3],
            received: 0,
            to_send: 0,
            taken: 0,
            last_us: 0,
            due_us: 0,
            free: Free::new(),
            link: Link::new(),
            can: CanTurn::new(),
            remote: Remote::new(),
            exchange: Exchange::new(),
        }
    }
}

/// A serial port in a program's memory, with room for a frame of `LENGTH` characters and for what its protocols keep:
/// [`Memory`] or [`NoMemory`]. All zero is one that has not been set up.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Port<const LENGTH: usize = FRAME, K = Memory> {
    /// What it is doing.
    pub status: Status,
    /// The frame that is received or sent.
    pub buffer: [u8; LENGTH],
    /// What a slave keeps.
    pub memory: K,
}

/// No protocol of the port keeps anything from one frame to the next.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NoMemory;

/// What a port has to keep something in from one frame to the next.
pub trait Keeps {
    /// Nothing is kept.
    const NOTHING: Self;

    /// The memory, if there is one.
    fn memory(&mut self) -> Option<&mut Memory>;
}

impl Keeps for Memory {
    const NOTHING: Self = Memory::new();

    fn memory(&mut self) -> Option<&mut Memory> {
        Some(self)
    }
}

impl Keeps for NoMemory {
    const NOTHING: Self = NoMemory;

    fn memory(&mut self) -> Option<&mut Memory> {
        None
    }
}

impl<const LENGTH: usize, K: Keeps> Default for Port<LENGTH, K> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const LENGTH: usize, K: Keeps> Port<LENGTH, K> {
    /// A port that has not been set up.
    pub const fn new() -> Self {
        Port {
            status: Status::new(),
            buffer: [0; LENGTH],
            memory: K::NOTHING,
        }
    }

    /// The port, whatever it has room for.
    pub fn parts(&mut self) -> PortMut<'_> {
        PortMut {
            status: &mut self.status,
            buffer: &mut self.buffer,
            memory: self.memory.memory(),
        }
    }
}

/// A serial port in a program's memory, whatever it has room for.
#[derive(Debug)]
pub struct PortMut<'a> {
    /// What it is doing.
    pub status: &'a mut Status,
    /// The frame that is received or sent.
    pub buffer: &'a mut [u8],
    /// What a slave keeps, if its protocols keep anything.
    pub memory: Option<&'a mut Memory>,
}

/// One port while it is advanced.
pub(super) struct Session<'a> {
    pub(super) plc: &'a mut dyn Plc,
    pub(super) hal: &'a mut dyn Hal,
    pub(super) wiring: &'static PortWiring,
    pub(super) status: Status,
    pub(super) now_us: u32,
    /// RUN or STOP, if a frame has asked for it.
    request: Option<bool>,
}

/// Whether `at_us` has come, both wrapping.
pub(super) fn has_come(now_us: u32, at_us: u32) -> bool {
    now_us.wrapping_sub(at_us) as i32 >= 0
}

/// Brings all ports to `now_us`, microseconds since power-on, wrapping: when a scan begins, when it ends, and at ticks.
/// Takes the characters that have come, answers, sends, and shows in special devices what has happened. Returns RUN or
/// STOP if a partner has asked for it.
pub fn advance(plc: &mut dyn Plc, hal: &mut dyn Hal, now_us: u32) -> Option<bool> {
    let mut request = None;
    let mut index = 0;
    while let Some(wiring) = plc.port_wiring(index) {
        index += 1;
        let Some(status) = plc.port(wiring.number).map(|port| *port.status) else {
            continue;
        };
        let wiring = wiring.chosen(plc);
        let mut session = Session {
            plc,
            hal,
            wiring,
            status,
            now_us,
            request: None,
        };
        session.run();
        request = request.or(session.request);
        if let Some(port) = session.plc.port(wiring.number) {
            keep(port.status, &session.status);
        }
    }
    request
}

/// A separate function says that the two do not overlap: else it is done by `memmove`, which is larger than all else
/// here.
#[inline(never)]
fn keep(place: &mut Status, status: &Status) {
    *place = *status;
}

impl Session<'_> {
    fn run(&mut self) {
        self.choose();
        if self.wiring.rules.bus(self) || !self.set_up() {
            return;
        }
        self.send();
        while let Some(character) = self.serial().and_then(|(port, now)| port.receive(now)) {
            self.take(character);
        }
        let quiet_us = self.now_us.wrapping_sub(self.status.last_us);
        if self.status.open && quiet_us >= self.silence_us() {
            self.silence();
        }
        if let Some(codec) = self.codec() {
            codec.advance(self);
        }
        self.send();
    }

    /// What the port does under its protocol, if the program has that.
    fn codec(&self) -> Option<&'static Codec> {
        self.codec_of(Protocols::of(&[self.status.protocol]))
    }

    /// What a port does under one of these protocols, if the program has that.
    pub(super) fn codec_of(&self, protocols: Protocols) -> Option<&'static Codec> {
        let mut codecs = self.plc.codecs().iter();
        codecs
            .find(|codec| codec.protocols().meets(protocols))
            .copied()
    }

    /// The hardware of the port, and the time.
    pub(super) fn serial(&mut self) -> Option<(&mut dyn SerialPort, u32)> {
        let port = self.hal.serial_port(self.wiring.number)?;
        Some((port, self.now_us))
    }

    /// What the port speaks from now on.
    fn choose(&mut self) {
        if self.wiring.choice == Choice::Com1 {
            let both = M_PARALLEL_MASTER.is_on(self.plc) && M_PARALLEL_SLAVE.is_on(self.plc);
            M_SET_UP_WRONGLY.set(self.plc, both);
        }
        let Sys {
            running,
            first_scan,
            ..
        } = *self.plc.sys();
        let settled = running && !first_scan;
        if self.status.bound && settled {
            return;
        }
        let protocol = self.wiring.protocol(self.plc, self.status.uinit);
        self.status.bound = settled && self.wiring.binds();
        if protocol != self.status.protocol {
            self.status.protocol = protocol;
            self.drop_frame();
            self.status.sending = false;
            self.status.free = Free::new();
            self.status.link = Link::new();
            self.status.can = CanTurn::new();
            self.forget();
            self.status.exchange = Exchange::new();
        }
    }

    /// Tells the hardware the format of the line; false if there is no hardware.
    fn set_up(&mut self) -> bool {
        let status = self.status;
        let format = match self.codec() {
            Some(codec) => codec.line(self.wiring, self.plc, status.protocol, status.uinit),
            None => self.wiring.own_line(self.plc, status.uinit, false),
        };
        let Some((port, _)) = self.serial() else {
            return false;
        };
        if format != status.format {
            port.set_format(format);
            self.status.format = format;
        }
        true
    }

    /// After how much silence a frame ends or is given up. Characters come with times in whole microseconds.
    fn silence_us(&self) -> u32 {
        if self.status.protocol.ends_by_silence() {
            let modbus = self.wiring.modbus;
            let asked_us = modbus.map_or(0, |modbus| modbus.silence_us(self.plc));
            self.status.format.silence_us().max(asked_us) - 2
        } else if Protocols::LINKS.contains(self.status.protocol) {
            LINK_GIVEN_UP_US
        } else {
            GIVEN_UP_US
        }
    }

    /// A character has come.
    fn take(&mut self, character: Received) {
        if self.status.sending && self.status.format.half_duplex {
            return;
        }
        let codec = self.codec();
        if codec.is_some_and(|codec| codec.character(self, character)) {
            return;
        }
        let begin_us = character
            .at_us
            .wrapping_sub(self.status.format.character_us());
        let quiet_us = begin_us.wrapping_sub(self.status.last_us);
        if self.status.open
            && has_come(begin_us, self.status.last_us)
            && quiet_us >= self.silence_us()
        {
            self.silence();
        }
        if self.status.sending {
            return;
        }
        if !self.store(character) {
            return;
        }
        if !self.status.protocol.ends_by_silence() {
            self.cut(codec);
        }
    }

    /// Appends a character to the frame; false if it was wrong.
    fn store(&mut self, character: Received) -> bool {
        self.status.open = true;
        self.status.last_us = character.at_us;
        if character.fault != CharFault::None {
            self.note(LineFault::Character);
            self.status.spoiled = true;
            return false;
        }
        let at = usize::from(self.status.received);
        let byte = character.byte & self.status.format.mask();
        let port = self.plc.port(self.wiring.number);
        match port.and_then(|port| port.buffer.get_mut(at)) {
            Some(place) => {
                *place = byte;
                self.status.received += 1;
                true
            }
            // No frame is as long. One that silence ends continues until then; else this character may begin another.
            None if at == 0 || self.status.protocol.ends_by_silence() => {
                self.status.spoiled = true;
                false
            }
            None => {
                self.drop_frame();
                self.store(character)
            }
        }
    }

    /// Looks whether the frame is whole, in a protocol whose frames have an end.
    fn cut(&mut self, codec: Option<&'static Codec>) {
        let received = usize::from(self.status.received);
        let slave = self.slave();
        let Some(port) = self.plc.port(self.wiring.number) else {
            return;
        };
        let frame = port.buffer.get(..received).unwrap_or_default();
        let cut = codec.map_or(Cut::Drop, |codec| codec.cut(&self.status, slave, frame));
        match cut {
            Cut::More => {}
            Cut::Whole if self.status.spoiled => self.drop_frame(),
            Cut::Whole => self.take_frame(),
            Cut::Restart => {
                let last = frame.last().copied();
                if let Some((first, last)) = port.buffer.first_mut().zip(last) {
                    *first = last;
                }
                self.status.received = 1;
                self.status.spoiled = false;
                // The character may be a whole frame.
                if received > 1 {
                    self.cut(codec);
                }
            }
            Cut::Drop => self.drop_frame(),
        }
    }

    /// The line has been silent for as long as ends a frame.
    fn silence(&mut self) {
        let whole = self.status.received > 0 && !self.status.spoiled;
        if self.status.protocol.ends_by_silence() && whole {
            self.take_frame();
        } else {
            self.drop_frame();
        }
    }

    /// Forgets what has been received.
    fn drop_frame(&mut self) {
        self.status.received = 0;
        self.status.open = false;
        self.status.spoiled = false;
    }

    /// Shows an error of the port.
    pub(super) fn note(&mut self, fault: LineFault) {
        match self.codec() {
            Some(codec) => codec.note(self.wiring, self.plc, self.status.protocol, fault),
            None => self.wiring.note_general(self.plc, fault),
        }
    }

    /// Who answers, as the registers say now.
    pub(super) fn slave(&self) -> Slave {
        let uinit = self.status.uinit;
        let (station, format) = match self.wiring.station {
            None => (uinit[0] & 0xff, uinit[1]),
            Some(_) => (
                value(self.plc, self.wiring.station_of(self.status.protocol)),
                value(self.plc, self.wiring.format),
            ),
        };
        Slave {
            family: self.plc.ports(),
            type_code: self.plc.type_code(),
            station,
            format,
            profile: self.plc.modbus(),
        }
    }

    /// A frame is whole: answers it, or takes it for an answer.
    fn take_frame(&mut self) {
        let received = usize::from(self.status.received);
        self.drop_frame();
        if let Some(codec) = self.codec() {
            codec.take(self, received);
        }
    }

    /// Copies the frame that has been received.
    pub(super) fn copy_frame<const LENGTH: usize>(&mut self, received: usize) -> [u8; LENGTH] {
        let mut frame = [0; LENGTH];
        let port = self.plc.port(self.wiring.number);
        let received = port.as_ref().and_then(|port| port.buffer.get(..received));
        if let Some((place, received)) =
            received.and_then(|r| frame.get_mut(..r.len()).zip(Some(r)))
        {
            place.copy_from_slice(received);
        }
        frame
    }

    /// Whether what has been received is a frame of this codec.
    pub(super) fn is_whole(&mut self, codec: &Codec, received: usize) -> bool {
        let slave = self.slave();
        let port = self.plc.port(self.wiring.number);
        let frame = port.as_ref().and_then(|port| port.buffer.get(..received));
        frame.is_some_and(|frame| codec.cut(&self.status, slave, frame) == Cut::Whole)
    }

    /// Answers a frame, none of which has more than `LENGTH` characters.
    pub(super) fn answer<const LENGTH: usize>(
        &mut self,
        received: usize,
        answer: impl FnOnce(Slave, &[u8], &mut Remote, &mut Served, &mut Frame) -> Result<(), LineFault>,
    ) {
        let slave = self.slave();
        let request = self.copy_frame::<LENGTH>(received);
        let mut remote = self.status.remote;
        let mut bytes = [0; LENGTH];
        let mut reply = Frame::new(&mut bytes);
        let mut map = Served::new(self.plc, slave.type_code);
        let request = request.get(..received).unwrap_or_default();
        let answered = answer(slave, request, &mut remote, &mut map, &mut reply);
        self.request = map.take_request().or(self.request);
        self.status.remote = remote;
        if let Err(fault) = answered {
            self.note(fault);
        }
        let wait_us = u32::from(reply.wait_ms()) * 1000;
        self.begin_sending(reply.as_slice(), wait_us);
    }

    /// The same with what the slave keeps.
    pub(super) fn answer_with_memory<const LENGTH: usize>(
        &mut self,
        received: usize,
        answer: impl FnOnce(Slave, &[u8], &mut Memory, &mut Served, &mut Frame) -> Result<(), LineFault>,
    ) {
        let number = self.wiring.number;
        let port = self.plc.port(number);
        let Some(mut memory) = port.and_then(|port| port.memory.map(core::mem::take)) else {
            return;
        };
        self.answer::<LENGTH>(received, |slave, request, _, map, reply| {
            answer(slave, request, &mut memory, map, reply)
        });
        if let Some(place) = self.plc.port(number).and_then(|port| port.memory) {
            *place = memory;
        }
    }

    /// A frame of CAN has come.
    pub(super) fn take_can(&mut self, received: usize) {
        let port = self.plc.port(self.wiring.number);
        let frame = port.as_ref().and_then(|port| port.buffer.get(..received));
        if let Some(frame) = frame.and_then(CanFrame::parse) {
            self.take_from_bus(frame);
        }
    }

    /// Sends a frame, not before `wait_us` after the last character received.
    pub(super) fn begin_sending(&mut self, frame: &[u8], wait_us: u32) {
        let Some(port) = self.plc.port(self.wiring.number) else {
            return;
        };
        if let Some(place) = port
            .buffer
            .get_mut(..frame.len())
            .filter(|_| !frame.is_empty())
        {
            place.copy_from_slice(frame);
            self.status.sending = true;
            self.status.to_send = frame.len() as u16;
            self.status.taken = 0;
            self.status.due_us = self.status.last_us.wrapping_add(wait_us);
        }
    }

    /// Hands the frame to the hardware, and takes notice of its end.
    fn send(&mut self) {
        let codec = self.codec();
        if codec.is_some_and(Codec::has_no_frames)
            || !self.status.sending
            || !has_come(self.now_us, self.status.due_us)
        {
            return;
        }
        let number = self.wiring.number;
        while self.status.taken < self.status.to_send {
            let at = usize::from(self.status.taken);
            let byte = self
                .plc
                .port(number)
                .and_then(|port| port.buffer.get(at).copied());
            let Some((byte, (port, now_us))) = byte.zip(self.serial()) else {
                break;
            };
            if !port.send(byte, now_us) {
                return;
            }
            self.status.taken += 1;
        }
        if self
            .serial()
            .is_none_or(|(port, now_us)| port.unsent(now_us) == 0)
        {
            self.status.sending = false;
            if let Some(codec) = codec {
                codec.sent(self);
            }
        }
    }
}
