//! What a port may speak, as far as that is known when a program is built.

use super::codec::Codec;
use super::line::{LineFormat, Received};
use super::parts::{PortMut, Progress};
use super::port::Session;
use super::protocols::Protocols;
use super::wiring::{PortWiring, Protocol};
use super::{Cut, LineFault};
use crate::hal::Hal;
use crate::plc::Plc;

/// After this much silence, a frame that has a length or an end is given up, in microseconds (Modbus over serial line
/// §2.5.2.1).
const GIVEN_UP_US: u32 = 1_000_000;

/// The same on links that PLCs keep up by themselves, whose partners send frames without gaps: a frame that was cut off
/// must not hold up the others.
const LINK_GIVEN_UP_US: u32 = 50_000;

/// What a session asks about what its port may speak: the part that differs between [`Whole`] and [`SlaveAlone`].
pub(super) trait Spoken<'a, P: Plc + ?Sized, H: Hal + ?Sized>: Sized {
    /// The special devices of the port.
    fn wiring(session: &Session<'a, P, H, Self>) -> &'static PortWiring;
    /// What the registers choose now.
    fn protocol(session: &Session<'a, P, H, Self>) -> Protocol;
    /// The protocol has changed: forgets how far the last one was.
    fn forget(session: &mut Session<'a, P, H, Self>);
    /// Takes notice of the protocol of this call.
    fn find_codec(session: &mut Session<'a, P, H, Self>);
    /// Whether the port does anything under its protocol.
    fn is_spoken(session: &Session<'a, P, H, Self>) -> bool;
    /// Serves a bus that may be there instead of a serial port; whether it is.
    fn has_bus(session: &mut Session<'a, P, H, Self>) -> bool;
    /// The format of characters on the line.
    fn line(session: &Session<'a, P, H, Self>) -> LineFormat;
    /// The bit rate that a partner has asked for, in hundreds of bits per second; 0: none has.
    fn asked_rate(session: &Session<'a, P, H, Self>) -> u16;
    /// Whether silence ends frames; those of others have an end.
    fn ends_by_silence(session: &Session<'a, P, H, Self>) -> bool;
    /// After how much silence a frame ends or is given up.
    fn silence_us(session: &Session<'a, P, H, Self>) -> u32;
    /// Whether it sends and receives frames.
    fn has_frames(session: &Session<'a, P, H, Self>) -> bool;
    /// Takes a character; false if it belongs to a frame.
    fn character(session: &mut Session<'a, P, H, Self>, character: Received) -> bool;
    /// Whether the characters so far are a frame.
    fn cut(session: &mut Session<'a, P, H, Self>, received: usize) -> Cut;
    /// Takes a frame of this many characters.
    fn take(session: &mut Session<'a, P, H, Self>, received: usize);
    /// Does what is to be done by now: at the end of each call.
    fn advance(session: &mut Session<'a, P, H, Self>);
    /// A frame has been sent.
    fn sent(session: &mut Session<'a, P, H, Self>);
    /// Shows an error.
    fn note(session: &mut Session<'a, P, H, Self>, fault: LineFault);
}

/// The silence that ends a frame, in microseconds; `asked_us`, if the program asks for more. Characters come with times
/// in whole microseconds.
pub(super) fn end_of_frame_us(format: LineFormat, asked_us: u32) -> u32 {
    format.silence_us().max(asked_us) - 2
}

/// All that the program's codecs speak.
pub(super) struct Whole {
    /// The special devices of the port.
    pub(super) wiring: &'static PortWiring,
    /// As it begins, where the port has no memory for it.
    pub(super) progress: Progress,
    /// What the port does under its protocol, if the program has that.
    codec: Option<&'static Codec>,
}

impl Whole {
    /// That of a port.
    pub(super) fn of(wiring: &'static PortWiring, port: &PortMut) -> Self {
        Whole {
            wiring,
            progress: port.progress.as_deref().copied().unwrap_or_default(),
            codec: None,
        }
    }
}

impl Session<'_> {
    /// What a port does under one of these protocols, if the program has that.
    pub(super) fn codec_of(&self, protocols: Protocols) -> Option<&'static Codec> {
        let mut codecs = self.plc.codecs().iter();
        codecs
            .find(|codec| codec.protocols().meets(protocols))
            .copied()
    }
}

impl<'a> Spoken<'a, dyn Plc + 'a, dyn Hal + 'a> for Whole {
    fn wiring(session: &Session<'a>) -> &'static PortWiring {
        session.own.wiring
    }

    fn protocol(session: &Session<'a>) -> Protocol {
        session
            .own
            .wiring
            .protocol(session.plc, session.status.uinit)
    }

    fn forget(session: &mut Session<'a>) {
        session.own.progress = Progress::new();
        session.forget();
    }

    fn find_codec(session: &mut Session<'a>) {
        session.own.codec = session.codec_of(Protocols::of(&[session.status.protocol]));
    }

    fn is_spoken(session: &Session<'a>) -> bool {
        session.own.codec.is_some()
    }

    fn has_bus(session: &mut Session<'a>) -> bool {
        session.own.wiring.rules.bus(session)
    }

    fn line(session: &Session<'a>) -> LineFormat {
        let (wiring, status) = (session.own.wiring, &session.status);
        match session.own.codec {
            Some(codec) => codec.line(wiring, session.plc, status.protocol, status.uinit),
            None => wiring.own_line(session.plc, status.uinit, false),
        }
    }

    fn asked_rate(session: &Session<'a>) -> u16 {
        session.status.rate
    }

    fn ends_by_silence(session: &Session<'a>) -> bool {
        session.status.protocol.ends_by_silence()
    }

    fn silence_us(session: &Session<'a>) -> u32 {
        if session.status.protocol.ends_by_silence() {
            let modbus = session.own.wiring.modbus;
            let asked_us = modbus.map_or(0, |modbus| modbus.silence_us(session.plc));
            end_of_frame_us(session.status.format, asked_us)
        } else if Protocols::LINKS.contains(session.status.protocol) {
            LINK_GIVEN_UP_US
        } else {
            GIVEN_UP_US
        }
    }

    fn has_frames(session: &Session<'a>) -> bool {
        !session.own.codec.is_some_and(Codec::has_no_frames)
    }

    fn character(session: &mut Session<'a>, character: Received) -> bool {
        let codec = session.own.codec;
        codec.is_some_and(|codec| codec.character(session, character))
    }

    fn cut(session: &mut Session<'a>, received: usize) -> Cut {
        match session.own.codec {
            Some(codec) => session.cut_by(codec, received),
            None => Cut::Drop,
        }
    }

    fn take(session: &mut Session<'a>, received: usize) {
        if let Some(codec) = session.own.codec {
            codec.take(session, received);
        }
    }

    fn advance(session: &mut Session<'a>) {
        if let Some(codec) = session.own.codec {
            codec.advance(session);
        }
    }

    fn sent(session: &mut Session<'a>) {
        if let Some(codec) = session.own.codec {
            codec.sent(session);
        }
    }

    fn note(session: &mut Session<'a>, fault: LineFault) {
        let (wiring, protocol) = (session.own.wiring, session.status.protocol);
        match session.own.codec {
            Some(codec) => codec.note(wiring, session.plc, protocol, fault),
            None => wiring.note_general(session.plc, fault),
        }
    }
}
