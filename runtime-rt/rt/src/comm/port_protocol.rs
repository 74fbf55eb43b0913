//! Protocol side of a session: any protocol that the program's codecs speak.

use super::codec::{Codec, Handler};
use super::line::{LineFormat, Received};
use super::parts::{PortMut, Progress};
use super::port::Session;
use super::protocols::Protocols;
use super::wiring::{PortWiring, Protocol};
use super::{Cut, LineFault};

/// After this much silence, a frame that has a length or an end is given up, in microseconds (Modbus over serial line
/// §2.5.2.1).
pub(super) const GIVEN_UP_US: u32 = 1_000_000;

/// The same on links that PLCs keep up by themselves, whose partners send frames without gaps: a frame that was cut off
/// must not hold up the others.
const LINK_GIVEN_UP_US: u32 = 50_000;

/// Protocol side of a session, on which the state machine of a port builds. It is chosen when a program is built: a
/// session of [`AnyProtocol`] asks the handler of its protocol, one of
/// [`SlaveAlone`](super::slave_alone::SlaveAlone) links neither handlers nor what they need. The defaults are those of
/// a slave whose frames end by silence.
pub(super) trait PortProtocol {
    /// Special devices of the port.
    fn wiring(&self) -> &'static PortWiring;
    /// Protocol that the registers choose now.
    fn chosen_protocol(&self) -> Protocol;
    /// Returns true if the program has the protocol of the port.
    fn has_protocol(&self) -> bool;
    /// Format of characters on the line.
    fn line(&self) -> LineFormat;
    /// Silence after which a frame ends or is given up, in microseconds.
    fn silence_us(&self) -> u32;
    /// Handles a frame of `length` characters.
    fn receive_frame(&mut self, length: usize);
    /// Shows an error in the special devices of the port.
    fn show_error(&mut self, fault: LineFault);

    /// Returns to the beginning, after the protocol has changed.
    fn restart(&mut self) {}

    /// Looks up the handler of the port's protocol, for this call.
    fn find_handler(&mut self) {}

    /// Serves a bus in place of the serial port. Returns false if there is none.
    fn poll_bus(&mut self) -> bool {
        false
    }

    /// Bit rate that a partner has requested, in hundreds of bits per second; 0 if none has.
    fn requested_rate(&self) -> u16 {
        0
    }

    /// Returns true if silence ends frames; those of others have an end.
    fn ends_by_silence(&self) -> bool {
        true
    }

    /// Returns true if the port sends and receives frames, false if characters.
    fn has_frames(&self) -> bool {
        true
    }

    /// Handles a character, in protocols without frames.
    fn receive_character(&mut self, _character: Received) {}

    /// End of the frame that the characters received so far begin.
    fn cut(&mut self, _received: usize) -> Cut {
        Cut::Drop
    }

    /// Takes notice that the rest of a frame of `length` characters has not come.
    fn give_up(&mut self, _length: usize) {}

    /// Does what is due, at the end of each call.
    fn poll(&mut self) {}

    /// Takes notice that a frame has been sent.
    fn sent(&mut self) {}
}

/// The silence that ends a frame, in microseconds; `least_us`, if the program asks for more. Characters come with times
/// in whole microseconds.
pub(super) fn end_of_frame_us(format: LineFormat, least_us: u32) -> u32 {
    format.silence_us().max(least_us) - 2
}

/// Part of a session that may speak all protocols of the program's codecs.
pub(super) struct AnyProtocol {
    /// Special devices of the port.
    pub(super) wiring: &'static PortWiring,
    /// As it begins, where the port has no memory for it.
    pub(super) progress: Progress,
    /// Handler of the protocol, if the program has it.
    handler: Option<&'static dyn Handler>,
}

impl AnyProtocol {
    /// Part of a session of a port.
    pub(super) fn new(wiring: &'static PortWiring, port: &PortMut) -> Self {
        AnyProtocol {
            wiring,
            progress: port.progress.as_deref().copied().unwrap_or_default(),
            handler: None,
        }
    }
}

impl Session<'_> {
    /// Codec of one of these protocols, if the program has it.
    pub(super) fn codec_of(&self, protocols: Protocols) -> Option<&'static Codec> {
        let mut codecs = self.plc.codecs().iter();
        codecs
            .find(|codec| codec.protocols().meets(protocols))
            .copied()
    }
}

impl PortProtocol for Session<'_> {
    fn wiring(&self) -> &'static PortWiring {
        self.own.wiring
    }

    fn chosen_protocol(&self) -> Protocol {
        self.own.wiring.protocol(self.plc, self.status.uinit)
    }

    fn has_protocol(&self) -> bool {
        self.own.handler.is_some()
    }

    fn line(&self) -> LineFormat {
        let (wiring, status) = (self.own.wiring, &self.status);
        match self.own.handler {
            Some(handler) => handler.line(wiring, self.plc, status.protocol, status.uinit),
            None => wiring.own_line(self.plc, status.uinit, false),
        }
    }

    fn silence_us(&self) -> u32 {
        if self.ends_by_silence() {
            let modbus = self.own.wiring.modbus;
            let least_us = modbus.map_or(0, |modbus| modbus.silence_us(self.plc));
            end_of_frame_us(self.status.format, least_us)
        } else if Protocols::LINKS.contains(self.status.protocol) {
            LINK_GIVEN_UP_US
        } else {
            let handler = self.own.handler;
            let given_up_us = handler.map(|handler| handler.given_up_us(self.own.wiring, self.plc));
            given_up_us.unwrap_or(GIVEN_UP_US)
        }
    }

    fn give_up(&mut self, length: usize) {
        if let Some(handler) = self.own.handler {
            handler.give_up(self, length);
        }
    }

    fn receive_frame(&mut self, length: usize) {
        if let Some(handler) = self.own.handler {
            handler.receive(self, length);
        }
    }

    fn show_error(&mut self, fault: LineFault) {
        let (wiring, protocol) = (self.own.wiring, self.status.protocol);
        match self.own.handler {
            Some(handler) => handler.show_error(wiring, self.plc, protocol, fault),
            None => wiring.note_general(self.plc, fault),
        }
    }

    fn restart(&mut self) {
        self.own.progress = Progress::new();
        self.forget();
    }

    fn find_handler(&mut self) {
        let codec = self.codec_of(Protocols::of(&[self.status.protocol]));
        self.own.handler = codec.map(|codec| codec.handler);
    }

    fn poll_bus(&mut self) -> bool {
        self.own.wiring.rules.bus(self)
    }

    fn requested_rate(&self) -> u16 {
        self.status.rate
    }

    fn ends_by_silence(&self) -> bool {
        self.status.protocol.ends_by_silence()
    }

    fn has_frames(&self) -> bool {
        self.status.protocol.has_frames()
    }

    fn receive_character(&mut self, character: Received) {
        if let Some(handler) = self.own.handler {
            handler.receive_character(self, character);
        }
    }

    fn cut(&mut self, received: usize) -> Cut {
        match self.own.handler {
            Some(handler) => self.cut_by(handler, received),
            None => Cut::Drop,
        }
    }

    fn poll(&mut self) {
        if let Some(handler) = self.own.handler {
            handler.poll(self);
        }
    }

    fn sent(&mut self) {
        if let Some(handler) = self.own.handler {
            handler.sent(self);
        }
    }
}
