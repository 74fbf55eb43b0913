//! `rungc run --serial COM1=/dev/ttyUSB0`: serial ports of this machine as those of the PLC, in real time.
//!
//! A thread for each port notes when characters come in. The run is late by at most one scan, so that they reach the
//! program's ports at their own times, and the end of a frame is where the line was silent.

#[cfg(target_os = "linux")]
mod can;
mod frames;
pub mod wire;

use super::watch::{Watch, Way};
use crate::args::ServeArgs;
use crate::commands::{Failure, eprint_line};
use frames::{Frames, Whole};
use rungc_host::servers::switched_by_line;
use rungc_interp::Machine;
use rungc_models::Model;
use rungc_project::serve;
use rungc_rt::comm::{LineFormat, Protocol, Received, Served};
use rungc_rt::{Plc, VirtualHal};
use rungc_sim::serve::{Direction, LinkProtocol, Place, Seen};
use std::io::ErrorKind;
use std::sync::mpsc::Receiver;
use std::time::Instant;
use wire::{Chunk, Event, Wire};

/// Characters that wait for a line that does not take them; more are lost, as on an open wire.
const UNSENT: usize = 4096;

/// Time by which characters are sent ahead: a frame is sent as a whole, because pauses between its parts would break
/// it. The other end sends them one after the other.
const AHEAD_US: u32 = 1 << 30;

/// The serial lines of a run.
#[derive(Default)]
pub struct Lines(Vec<Line>);

/// A port of the PLC, and the port of this machine that it is.
struct Line {
    number: u8,
    /// Names of the port and of the other end.
    port: String,
    name: String,
    /// Data sent to the other end when it is open.
    opening: String,
    events: Receiver<Event>,
    /// The other end, while it is open.
    wire: Option<Wire>,
    /// It has vanished, which was reported.
    lost: bool,
    /// Characters that the other end has not taken.
    unsent: Vec<u8>,
    format: LineFormat,
    /// Protocol of the port.
    protocol: Protocol,
    /// Times of the last received character, and of the end of the last one sent, in microseconds since the run began.
    last_us: u64,
    sent_us: u64,
    /// Frames on the wire.
    frames: Frames,
    place: Place,
}

impl Lines {
    /// Opens all ports, and reports them.
    ///
    /// # Errors
    /// A port that the model does not have, and one that cannot be opened.
    pub fn open(serve: &ServeArgs, model: &Model, watch: &mut Watch) -> Result<Self, Failure> {
        let lines = serve.lines(model);
        for (i, line) in lines.iter().enumerate() {
            if lines[..i].iter().any(|other| other.port == line.port) {
                let why = format!("{} is connected to two lines", line.name());
                return Err(Failure::Because(why));
            }
        }
        let lines = lines.iter().map(|line| {
            let place = match serve.named_lines().any(|named| named == line) {
                true => serve.settings.place_of_line(line),
                false => serve.settings.place("--fx"),
            };
            let line = Line::open(line, &place, model)?;
            watch.open(&line.place, LinkProtocol::Serial(line.protocol));
            Ok(line)
        });
        lines.collect::<Result<_, _>>().map(Lines)
    }

    /// Passes characters received since the last call to the ports, at their times but not before `from_ms`; the run
    /// began at `begin`.
    pub fn receive(
        &mut self,
        hal: &mut VirtualHal,
        begin: Instant,
        from_ms: u64,
        watch: &mut Watch,
    ) {
        for line in &mut self.0 {
            while let Ok(event) = line.events.try_recv() {
                for whole in line.notice(event, hal, begin, from_ms) {
                    line.seen(whole, from_ms, watch);
                }
            }
            line.follow_format(hal);
        }
    }

    /// Sends the output of the ports.
    pub fn send(
        &mut self,
        hal: &mut VirtualHal,
        machine: &mut Machine,
        now_ms: u64,
        watch: &mut Watch,
    ) {
        for line in &mut self.0 {
            line.follow_protocol(machine, now_ms, watch);
            for whole in line.send(hal, now_ms) {
                line.seen(whole, now_ms, watch);
            }
        }
    }

    /// Mode of the machine as partners on lines set it ([`rungc_rt::Ports::will_run`]); `None` without lines.
    pub fn mode(&self, machine: &mut Machine) -> Option<bool> {
        let ports = machine.module().model.ports;
        let has_any = !self.0.is_empty();
        has_any.then(|| ports.will_run(&Served::<Machine>::new(machine, 0)))
    }

    /// Reports a partner that has switched the PLC to RUN or STOP: its mode was `before`.
    pub fn report_switch(&self, before: Option<bool>, machine: &mut Machine) {
        let Some(running) = self.mode(machine).filter(|&now| before != Some(now)) else {
            return;
        };
        let ports: Vec<_> = self.0.iter().map(|line| line.number).collect();
        let message = switched_by_line(running, machine, &ports);
        eprint_line(&format!("rungc: {message}"));
    }

    /// The run is over: what is still on the wires counts as well.
    pub fn end(&mut self, now_ms: u64, watch: &mut Watch) {
        for line in &mut self.0 {
            if let Some(whole) = line.frames.take() {
                line.seen(whole, now_ms, watch);
            }
        }
    }
}

impl Line {
    /// Opens a line, which `place` names in messages.
    fn open(line: &serve::Line, place: &str, model: &Model) -> Result<Line, Failure> {
        let port = line.name();
        if let Some((message, help)) = line.missing(model) {
            return Err(Failure::Because(format!("{place}: {message}; {help}")));
        }
        let (name, events) = wire::keep(&line.end).map_err(|error| {
            let why = wire::cannot_open(&line.end, &error);
            Failure::Because(format!("{place}: {why}"))
        })?;
        eprint_line(&format!("rungc: {port} at {name}"));
        let place = Place {
            port: port.clone(),
            peer: name.clone(),
        };
        Ok(Line {
            number: line.port,
            port,
            name,
            opening: line.end.opening(),
            events,
            wire: None,
            lost: false,
            unsent: Vec::new(),
            format: LineFormat::new(),
            protocol: Protocol::Off,
            last_us: 0,
            sent_us: 0,
            frames: Frames::default(),
            place,
        })
    }

    /// Takes notice of what has happened to the other end.
    fn notice(
        &mut self,
        event: Event,
        hal: &mut VirtualHal,
        begin: Instant,
        from_ms: u64,
    ) -> Vec<Whole> {
        let Line { port, name, .. } = self;
        match event {
            Event::Up(wire) => {
                if std::mem::take(&mut self.lost) {
                    eprint_line(&format!("rungc: {port}: {name} is back"));
                }
                self.wire = Some(wire);
                self.unsent = self.opening.clone().into_bytes();
                self.format = LineFormat::new();
            }
            Event::Down(error) => {
                let why = match error.kind() {
                    ErrorKind::UnexpectedEof => "it was closed".to_string(),
                    _ => error.to_string(),
                };
                let what = match self.wire {
                    Some(_) => "is gone",
                    None => "is not there",
                };
                eprint_line(&format!(
                    "rungc: {port}: {name} {what} ({why}); waiting for it"
                ));
                self.wire = None;
                self.lost = true;
            }
            Event::Rejected(client) => eprint_line(&format!(
                "rungc: {port}: {name} rejects {}: another client is connected",
                client.ip()
            )),
            Event::Chunk(chunk) => return self.receive(&chunk, hal, begin, from_ms),
        }
        Vec::new()
    }

    /// A frame was on the wire.
    fn seen(&self, whole: Whole, now_ms: u64, watch: &mut Watch) {
        let seen = Seen {
            place: &self.place,
            link: LinkProtocol::Serial(self.protocol),
            direction: whole.direction,
            bytes: &whole.bytes,
        };
        watch.frame(since_begin(whole.at_us, now_ms), Way::Serial, seen);
    }

    /// Frames are those of the protocol that the port speaks.
    fn follow_protocol(&mut self, machine: &mut Machine, now_ms: u64, watch: &mut Watch) {
        let Some(protocol) = machine.port(self.number).map(|port| port.status.protocol) else {
            return;
        };
        if protocol != self.protocol {
            if let Some(whole) = self.frames.take() {
                self.seen(whole, now_ms, watch);
            }
            self.protocol = protocol;
            watch.open(&self.place, LinkProtocol::Serial(protocol));
        }
    }

    /// The line has the format that the program has set up.
    fn follow_format(&mut self, hal: &mut VirtualHal) {
        let (Some(line), Some(wire)) = (hal.line(self.number), &mut self.wire) else {
            return;
        };
        let format = line.format();
        if format == self.format || format.bits_per_second == 0 {
            return;
        }
        self.format = format;
        if let Err(error) = wire.set_format(format) {
            eprint_line(&format!(
                "rungc: {}: the line cannot be set to {} bit/s, {} data bits: {error}",
                self.port, format.bits_per_second, format.data_bits
            ));
        }
    }

    /// Characters come to the port one after the other; the system shows when the last of them was in.
    fn receive(
        &mut self,
        chunk: &Chunk,
        hal: &mut VirtualHal,
        begin: Instant,
        from_ms: u64,
    ) -> Vec<Whole> {
        let mut frames = Vec::new();
        let character_us = u64::from(self.format.character_us());
        let came_us = chunk.at.saturating_duration_since(begin).as_micros() as u64;
        let before = chunk.bytes.len().saturating_sub(1) as u64;
        let mut at_us = came_us.saturating_sub(character_us * before);
        for &byte in &chunk.bytes {
            // Characters from before the end of the port's output answer data that a faster line has shown already.
            let earliest = [
                1000 * from_ms,
                self.last_us.max(self.sent_us) + character_us,
            ];
            at_us = earliest.into_iter().fold(at_us, u64::max);
            let character = Received {
                at_us: at_us as u32,
                byte,
                ..Received::new()
            };
            if let Some(line) = hal.line(self.number) {
                // Excess characters are lost, as in the receiver of a PLC that is not polled in time.
                let _ = line.feed(character);
            }
            let line = (self.protocol, self.format);
            let ended = self.frames.push(Direction::In, at_us as u32, byte, line);
            frames.extend(ended.into_iter().flatten());
            self.last_us = at_us;
            at_us += character_us;
        }
        frames
    }

    fn send(&mut self, hal: &mut VirtualHal, now_ms: u64) -> Vec<Whole> {
        let now_us = (now_ms * 1000) as u32;
        let format = (self.protocol, self.format);
        let mut frames = Vec::new();
        if let Some(line) = hal.line(self.number) {
            while let Some(sent) = line.take(now_us.wrapping_add(AHEAD_US)) {
                let ended = self
                    .frames
                    .push(Direction::Out, sent.at_us, sent.byte, format);
                frames.extend(ended.into_iter().flatten());
                self.unsent.push(sent.byte);
                self.sent_us = since_begin(sent.at_us, now_ms);
            }
        }
        frames.extend(self.frames.end(now_us, format));
        self.write();
        frames
    }

    /// Hands over what the other end takes.
    fn write(&mut self) {
        let Some(wire) = &mut self.wire else {
            return self.unsent.clear();
        };
        if self.unsent.is_empty() {
            return;
        }
        // A failure is one of reading, too, which the thread reports.
        let written = wire.write(&self.unsent).unwrap_or(0);
        self.unsent.drain(..written);
        if self.unsent.len() > UNSENT {
            self.unsent.clear();
        }
    }
}

/// A wrapping time near `now_ms` in microseconds since the run began.
fn since_begin(at_us: u32, now_ms: u64) -> u64 {
    let now_us = 1000 * now_ms;
    let later_us = at_us.wrapping_sub(now_us as u32) as i32;
    now_us.saturating_add_signed(later_us.into())
}
