//! The state machine of one port, beside the scan.

use super::can::CanFrame;
use super::codec::Codec;
use super::computer_link::Remote;
use super::line::{CharFault, Received};
use super::modbus::LONGEST_RTU;
use super::parts::{Progress, Status};
use super::protocols::Protocols;
use super::slaves::Slave;
use super::wiring::{Choice, M_PARALLEL_MASTER, M_PARALLEL_SLAVE, PortWiring, value};
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

/// One port while it is advanced.
pub(super) struct Session<'a> {
    pub(super) plc: &'a mut dyn Plc,
    pub(super) hal: &'a mut dyn Hal,
    pub(super) wiring: &'static PortWiring,
    pub(super) status: Status,
    /// As it begins, where the port has no memory for it.
    pub(super) progress: Progress,
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
            progress: Progress::new(),
            now_us,
            request: None,
        };
        let port = session.plc.port(wiring.number);
        if let Some(progress) = port.and_then(|port| port.progress) {
            keep(&mut session.progress, progress);
        }
        session.run();
        request = request.or(session.request);
        if let Some(port) = session.plc.port(wiring.number) {
            keep(port.status, &session.status);
            if let Some(place) = port.progress {
                keep(place, &session.progress);
            }
        }
    }
    request
}

/// A separate function says that the two do not overlap: else it is done by `memmove`, which is larger than all else
/// here.
#[inline(never)]
fn keep<T: Copy>(place: &mut T, value: &T) {
    *place = *value;
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
            self.status.rate = 0;
            self.progress = Progress::new();
            self.forget();
        }
    }

    /// Tells the hardware the format of the line; false if there is no hardware.
    fn set_up(&mut self) -> bool {
        let status = self.status;
        let mut format = match self.codec() {
            Some(codec) => codec.line(self.wiring, self.plc, status.protocol, status.uinit),
            None => self.wiring.own_line(self.plc, status.uinit, false),
        };
        if status.rate != 0 {
            format.bits_per_second = u32::from(status.rate) * 100;
        }
        let Some((port, _)) = self.serial() else {
            return false;
        };
        // The answer to a request for another rate still has the old one.
        if status.sending && status.rate != 0 {
            return true;
        }
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
            self.status.rate = 0;
            self.status.spoiled = true;
            return false;
        }
        let at = usize::from(self.status.received);
        let byte = character.byte & self.status.format.mask();
        let port = self.plc.port(self.wiring.number);
        // A port of several protocols has room for more.
        let fits = !self.status.protocol.ends_by_silence() || at < LONGEST_RTU;
        let place = port.filter(|_| fits);
        match place.and_then(|port| port.buffer.get_mut(at)) {
            Some(place) => {
                *place = byte;
                self.status.received += 1;
                true
            }
            None if at == 0 => {
                self.status.spoiled = true;
                false
            }
            // No frame is as long. One that silence ends continues until then; else this character may begin another.
            None if self.status.protocol.ends_by_silence() => {
                if !self.status.spoiled {
                    self.note(LineFault::Overflow);
                }
                self.status.spoiled = true;
                false
            }
            None => {
                self.note(LineFault::Overflow);
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
        let cut = codec.map_or(Cut::Drop, |codec| {
            codec.cut(&self.status, &self.progress, slave, frame)
        });
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
    pub(super) fn drop_frame(&mut self) {
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
        frame.is_some_and(|frame| {
            codec.cut(&self.status, &self.progress, slave, frame) == Cut::Whole
        })
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
