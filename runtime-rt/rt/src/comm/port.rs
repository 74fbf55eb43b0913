//! The state machine of one port, beside the scan.

use super::codec::{Codec, Handler};
use super::computer_link::Remote;
use super::line::{CharFault, Received};
use super::modbus::LONGEST_RTU;
use super::parts::Status;
use super::port_protocol::{AnyProtocol, PortProtocol};
use super::slaves::Slave;
use super::wiring::{M_PARALLEL_MASTER, M_PARALLEL_SLAVE, PortWiring, value};
use super::{Cut, Frame, LineFault, Memory, Served};
use crate::hal::{Hal, SerialPort};
use crate::plc::{Plc, Sys};
use crate::special::Relay;

/// Characters of the longest frame: Modbus ASCII has 513, computer link fewer.
pub const FRAME: usize = 528;

/// The parallel link is set up wrongly: M8070 and M8071 are both on.
pub(super) const M_SET_UP_WRONGLY: Relay = Relay(8073);

/// One port while it is advanced. `S` is its protocol side as far as that is known when a program is built: then the
/// devices and the hardware are known, too, and the rest of this is not linked.
pub(super) struct Session<'a, P: ?Sized = dyn Plc + 'a, H: ?Sized = dyn Hal + 'a, S = AnyProtocol> {
    pub(super) plc: &'a mut P,
    pub(super) hal: &'a mut H,
    pub(super) status: Status,
    /// Its protocol side.
    pub(super) own: S,
    pub(super) now_us: u32,
    /// RUN or STOP, if a frame has requested it.
    pub(super) request: Option<bool>,
}

/// Returns true if `at_us` has passed, both wrapping.
pub(super) fn has_come(now_us: u32, at_us: u32) -> bool {
    now_us.wrapping_sub(at_us) as i32 >= 0
}

/// Brings all ports to `now_us`, microseconds since power-on, wrapping: when a scan begins, when it ends, and at ticks.
/// Takes the characters that have come, answers, sends, and shows in special devices what has happened. Returns RUN or
/// STOP if a partner has requested it.
pub fn advance(plc: &mut dyn Plc, hal: &mut dyn Hal, now_us: u32) -> Option<bool> {
    let mut request = None;
    let mut index = 0;
    while let Some(wiring) = plc.port_wiring(index) {
        index += 1;
        let wiring = wiring.chosen(plc);
        request = request.or(advance_port(plc, hal, wiring, now_us));
    }
    request
}

/// Brings one of the ports to `now_us`, if the program has it.
fn advance_port<'a>(
    plc: &'a mut dyn Plc,
    hal: &'a mut dyn Hal,
    wiring: &'static PortWiring,
    now_us: u32,
) -> Option<bool> {
    let port = plc.port(wiring.number)?;
    let (status, own) = (*port.status, AnyProtocol::new(wiring, &port));
    let mut session: Session<'a> = Session {
        plc,
        hal,
        status,
        own,
        now_us,
        request: None,
    };
    session.run();
    if let Some(port) = session.plc.port(wiring.number) {
        keep(port.status, &session.status);
        if let Some(place) = port.progress {
            keep(place, &session.own.progress);
        }
    }
    session.request
}

/// A separate function says that the two do not overlap: else it is done by `memmove`, which is larger than all else
/// here.
#[inline(never)]
pub(super) fn keep<T: Copy>(place: &mut T, value: &T) {
    *place = *value;
}

impl<P, H, S> Session<'_, P, H, S>
where
    P: Plc + ?Sized,
    H: Hal + ?Sized,
    Self: PortProtocol,
{
    pub(super) fn run(&mut self) {
        self.choose();
        if self.poll_bus() || !self.set_up() {
            return;
        }
        self.send();
        while let Some(character) = self.oldest_character() {
            if self.has_protocol() {
                self.receive(character);
            }
        }
        self.pass_silence(self.now_us);
        self.poll();
        self.send();
    }

    /// The hardware of the port, and the time.
    pub(super) fn serial(&mut self) -> Option<(&mut dyn SerialPort, u32)> {
        let port = self.hal.serial_port(self.wiring().number)?;
        Some((port, self.now_us))
    }

    /// The oldest character that has come.
    fn oldest_character(&mut self) -> Option<Received> {
        self.serial()
            .and_then(|(port, now_us)| port.receive(now_us))
    }

    /// Selects the protocol.
    fn choose(&mut self) {
        let wiring = self.wiring();
        if wiring.has_parallel_link(self.plc) {
            let both = M_PARALLEL_MASTER.is_on(self.plc) && M_PARALLEL_SLAVE.is_on(self.plc);
            M_SET_UP_WRONGLY.set(self.plc, both);
        }
        let Sys {
            running,
            first_scan,
            ..
        } = *self.plc.sys();
        let settled = running && !first_scan;
        if !self.status.bound || !settled {
            let protocol = self.chosen_protocol();
            self.status.bound = settled && wiring.binds();
            if protocol != self.status.protocol {
                self.status.protocol = protocol;
                self.drop_frame();
                self.status.sending = false;
                self.status.rate = 0;
                self.restart();
            }
        }
        self.find_handler();
    }

    /// Sets the format of the line. Returns false if there is no hardware.
    fn set_up(&mut self) -> bool {
        let requested = self.requested_rate();
        let (sending, set_up) = (self.status.sending, self.status.format);
        let mut format = self.line();
        if requested != 0 {
            format.bits_per_second = u32::from(requested) * 100;
        }
        let Some((port, _)) = self.serial() else {
            return false;
        };
        // The answer to a request for another rate still has the old one.
        if sending && requested != 0 {
            return true;
        }
        if format != set_up {
            port.set_format(format);
            self.status.format = format;
        }
        true
    }

    /// Handles a character.
    fn receive(&mut self, character: Received) {
        if self.status.sending && self.status.format.half_duplex {
            return;
        }
        if !self.has_frames() {
            return self.receive_character(character);
        }
        let begin_us = character
            .at_us
            .wrapping_sub(self.status.format.character_us());
        self.pass_silence(begin_us);
        if self.status.sending {
            return;
        }
        if !self.store(character) {
            return;
        }
        if !self.ends_by_silence() {
            self.end_frame();
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
        if self.append(byte) {
            return true;
        }
        // No frame is as long. One that silence ends continues until then; else this character may begin another.
        if at > 0 && !self.ends_by_silence() {
            self.note(LineFault::Overflow);
            self.drop_frame();
            self.status.open = true;
            self.status.last_us = character.at_us;
            if self.append(byte) {
                return true;
            }
        } else if at > 0 && !self.status.spoiled {
            self.note(LineFault::Overflow);
        }
        self.status.spoiled = true;
        false
    }

    /// Appends a byte to the frame; false if there is no room.
    fn append(&mut self, byte: u8) -> bool {
        let at = usize::from(self.status.received);
        // A port of several protocols has room for more.
        let fits = !self.ends_by_silence() || at < LONGEST_RTU;
        let port = self.plc.port(self.number()).filter(|_| fits);
        let place = port.and_then(|port| port.buffer.get_mut(at));
        let has_room = place.is_some();
        if let Some(place) = place {
            *place = byte;
            self.status.received += 1;
        }
        has_room
    }

    /// Handles the frame if it is whole, in a protocol whose frames have an end.
    fn end_frame(&mut self) {
        let mut received = usize::from(self.status.received);
        let mut cut = self.cut(received);
        // The last character may be a whole frame.
        while let Cut::Restart = cut {
            let port = self.plc.port(self.number());
            let frame = port.and_then(|port| port.buffer.get_mut(..received));
            if let Some([first, .., last]) = frame {
                *first = *last;
            }
            self.status.received = 1;
            self.status.spoiled = false;
            if received <= 1 {
                return;
            }
            received = 1;
            cut = self.cut(received);
        }
        match cut {
            Cut::Whole if self.status.spoiled => self.drop_frame(),
            Cut::Whole => self.take_frame(),
            Cut::More | Cut::Restart => {}
            Cut::Drop => self.drop_frame(),
        }
    }

    /// Takes or gives up the frame, if the line has been silent until then for as long as ends one.
    #[inline(never)]
    fn pass_silence(&mut self, until_us: u32) {
        let quiet_us = until_us.wrapping_sub(self.status.last_us);
        if !self.status.open
            || !has_come(until_us, self.status.last_us)
            || quiet_us < self.silence_us()
        {
            return;
        }
        let whole = self.status.received > 0 && !self.status.spoiled;
        if self.ends_by_silence() && whole {
            self.take_frame();
        } else {
            let received = usize::from(self.status.received);
            self.drop_frame();
            if whole {
                self.give_up(received);
            }
        }
    }

    /// Forgets what has been received.
    pub(super) fn drop_frame(&mut self) {
        self.status.received = 0;
        self.status.open = false;
        self.status.spoiled = false;
    }

    /// Shows an error of the port.
    #[inline(never)]
    pub(super) fn note(&mut self, fault: LineFault) {
        self.show_error(fault);
    }

    /// Its number in the model's manual.
    fn number(&self) -> u8 {
        self.wiring().number
    }

    /// A frame is whole: answers it, or takes it for an answer.
    fn take_frame(&mut self) {
        let received = usize::from(self.status.received);
        self.drop_frame();
        self.receive_frame(received);
    }

    /// Copies the frame that has been received.
    pub(super) fn copy_frame<const LENGTH: usize>(&mut self) -> [u8; LENGTH] {
        let mut frame = [0; LENGTH];
        if let Some(port) = self.plc.port(self.number()) {
            for (place, byte) in frame.iter_mut().zip(port.buffer) {
                *place = *byte;
            }
        }
        frame
    }

    /// Answers a frame of this many characters; no answer has more than `LENGTH`.
    pub(super) fn reply<const LENGTH: usize>(
        &mut self,
        received: usize,
        answer: impl FnOnce(&mut P, &[u8], &mut Frame) -> Result<(), LineFault>,
    ) {
        let request = self.copy_frame::<LENGTH>();
        let mut bytes = [0; LENGTH];
        let mut reply = Frame::new(&mut bytes);
        let request = request.get(..received).unwrap_or_default();
        if let Err(fault) = answer(self.plc, request, &mut reply) {
            self.note(fault);
        }
        let wait_us = u32::from(reply.wait_ms()) * 1000;
        self.begin_sending(reply.as_slice(), wait_us);
    }

    /// Own station number, as the registers say now.
    pub(super) fn station(&self) -> u16 {
        let wiring = self.wiring();
        match wiring.station {
            None => self.status.uinit[0] & 0xff,
            Some(_) => value(self.plc, wiring.station_of(self.status.protocol)),
        }
    }

    /// Sends a frame, not before `wait_us` after the last character received.
    pub(super) fn begin_sending(&mut self, frame: &[u8], wait_us: u32) {
        let Some(port) = self.plc.port(self.number()) else {
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
        if !self.has_frames() || !self.status.sending || !has_come(self.now_us, self.status.due_us)
        {
            return;
        }
        let number = self.number();
        while self.status.taken < self.status.to_send {
            let at = usize::from(self.status.taken);
            let port = self.plc.port(number);
            let byte = port.and_then(|port| port.buffer.get(at).copied());
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
            self.sent();
        }
    }
}

/// The devices of a program that is not known when this is built.
type Devices<'a, 'b> = Served<'b, dyn Plc + 'a>;

impl<'a> Session<'a> {
    /// Settings of the answering protocols, as the registers are now.
    pub(super) fn slave(&self) -> Slave {
        let format = match self.own.wiring.station {
            None => self.status.uinit[1],
            Some(_) => value(self.plc, self.own.wiring.format),
        };
        Slave {
            family: self.plc.ports(),
            type_code: self.plc.type_code(),
            station: self.station(),
            format,
            profile: self.plc.modbus(),
        }
    }

    /// Returns true if the received characters are a frame of this codec.
    pub(super) fn is_whole(&mut self, codec: &Codec, received: usize) -> bool {
        self.cut_by(codec.handler, received) == Cut::Whole
    }

    /// Classification by this handler of the characters so far.
    pub(super) fn cut_by(&mut self, handler: &dyn Handler, received: usize) -> Cut {
        let slave = self.slave();
        let port = self.plc.port(self.own.wiring.number);
        let frame = port.as_ref().and_then(|port| port.buffer.get(..received));
        let frame = frame.unwrap_or_default();
        handler.cut(&self.status, &self.own.progress, slave, frame)
    }

    /// Answers a frame, none of which has more than `LENGTH` characters.
    pub(super) fn answer<const LENGTH: usize>(
        &mut self,
        received: usize,
        answer: impl FnOnce(
            Slave,
            &[u8],
            &mut Remote,
            &mut Devices<'a, '_>,
            &mut Frame,
        ) -> Result<(), LineFault>,
    ) {
        let slave = self.slave();
        let mut remote = self.status.remote;
        let mut mode = None;
        self.reply::<LENGTH>(received, |plc, request, reply| {
            let mut map = Served::new(plc, slave.type_code);
            let done = answer(slave, request, &mut remote, &mut map, reply);
            mode = map.take_request();
            done
        });
        self.request = mode.or(self.request);
        self.status.remote = remote;
    }

    /// The same with what the slave keeps.
    pub(super) fn answer_with_memory<const LENGTH: usize>(
        &mut self,
        received: usize,
        answer: impl FnOnce(
            Slave,
            &[u8],
            &mut Memory,
            &mut Devices<'a, '_>,
            &mut Frame,
        ) -> Result<(), LineFault>,
    ) {
        let number = self.own.wiring.number;
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
}
