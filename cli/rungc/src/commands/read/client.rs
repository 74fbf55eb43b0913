//! The asking end of the programming port's protocol, for what only reads.

use crate::args::ReadArgs;
use crate::commands::run::lines::wire::{self, Wire};
use crate::commands::{Failure, eprint_line, interruption};
use rungc_rt::comm::{LineFormat, Parity, fx_port};
use std::time::{Duration, Instant};

const STX: u8 = 0x02;
const ETX: u8 = 0x03;
const ENQ: u8 = 0x05;
const ACK: u8 = 0x06;
const NAK: u8 = 0x15;

/// More characters than an answer has.
const LONGEST: usize = 1024;

/// A line to a PLC.
pub struct Client {
    wire: Wire,
    name: String,
    timeout: Duration,
    retries: u32,
}

/// Reply of a PLC.
#[derive(Debug)]
pub enum Reply {
    /// Yes.
    Ack,
    /// No.
    Nak,
    /// The text of a frame.
    Data(Vec<u8>),
}

impl Client {
    /// Opens the line.
    pub fn open(args: &ReadArgs) -> Result<Self, Failure> {
        let name = args.port.to_string();
        let format = LineFormat {
            bits_per_second: args.baud,
            data_bits: 7,
            parity: Parity::Even,
            ..LineFormat::new()
        };
        let wire = wire::open(&args.port);
        let mut wire =
            wire.map_err(|error| Failure::Because(wire::cannot_open(&args.port, &error)))?;
        if let Err(error) = wire.set_format(format) {
            // A pseudo-terminal has no parity, and needs none.
            let rate = args.baud;
            eprint_line(&format!(
                "rungc: {name} cannot be set to {rate} bit/s, 7 data bits, even parity: {error}"
            ));
        }
        Ok(Client {
            wire,
            name,
            timeout: Duration::from_millis(args.timeout),
            retries: args.retries,
        })
    }

    /// Failure to read the PLC.
    pub fn failure(&self, why: &str) -> Failure {
        Failure::Because(format!("{}: {why}", self.name))
    }

    /// Asks whether a PLC is there.
    pub fn greet(&mut self) -> Result<(), Failure> {
        match self.exchange(&[ENQ])? {
            Reply::Ack => Ok(()),
            _ => Err(self.failure("what answers is not the programming port of a PLC")),
        }
    }

    /// Sends a command.
    pub fn request(&mut self, text: &[u8]) -> Result<Reply, Failure> {
        let sum = text.iter().fold(ETX, |sum, &c| sum.wrapping_add(c));
        let mut frame = vec![STX];
        frame.extend(text);
        frame.push(ETX);
        frame.extend(format!("{sum:02X}").bytes());
        self.exchange(&frame)
    }

    /// The bytes that a command reads; nothing if the PLC rejects it.
    pub fn data(&mut self, text: &[u8], count: usize) -> Result<Option<Vec<u8>>, Failure> {
        let Reply::Data(digits) = self.request(text)? else {
            return Ok(None);
        };
        let pairs = digits.chunks(2).map(|pair| number(pair).map(|n| n as u8));
        match pairs.collect::<Option<Vec<u8>>>() {
            Some(bytes) if bytes.len() == count && digits.len() == 2 * count => Ok(Some(bytes)),
            _ => Err(self.failure("the PLC's answer has another length than was asked for")),
        }
    }

    /// Sends a request until an answer comes.
    fn exchange(&mut self, request: &[u8]) -> Result<Reply, Failure> {
        let mut why = "";
        for attempt in 0..=self.retries {
            if attempt > 0 {
                self.read_away()?;
            }
            self.send(request)?;
            match self.receive()? {
                Ok(reply) => return Ok(reply),
                Err(fault) => why = fault,
            }
        }
        let attempts = self.retries + 1;
        Err(self.failure(&format!("{why} (asked {attempts} times)")))
    }

    fn send(&mut self, request: &[u8]) -> Result<(), Failure> {
        let sent = self.wire.send(request, self.timeout);
        sent.map_err(|error| self.failure(&error.to_string()))
    }

    /// The answer, or what is wrong with it.
    fn receive(&mut self) -> Result<Result<Reply, &'static str>, Failure> {
        let deadline = Instant::now() + self.timeout;
        let mut received = Vec::new();
        while Instant::now() < deadline {
            received.extend(self.read()?);
            // Characters before an answer are noise on the line.
            let begin = received.iter().position(|c| matches!(*c, STX | ACK | NAK));
            received.drain(..begin.unwrap_or(received.len()));
            match received.as_slice() {
                [ACK, ..] => return Ok(Ok(Reply::Ack)),
                [NAK, ..] => return Ok(Ok(Reply::Nak)),
                frame => {
                    let end = frame.iter().position(|c| *c == ETX).map(|etx| etx + 3);
                    if let Some(frame) = end.and_then(|end| frame.get(..end)) {
                        let text = fx_port::text_of(frame).map(<[u8]>::to_vec);
                        return Ok(text
                            .map(Reply::Data)
                            .map_err(|_| "the PLC's answer is damaged"));
                    }
                    if frame.len() > LONGEST {
                        return Ok(Err("the PLC's answer does not end"));
                    }
                }
            }
        }
        Ok(Err(match received.is_empty() {
            true => "no answer; check the cable, the port and --baud",
            false => "the PLC's answer is not complete",
        }))
    }

    /// Reads away what still comes, for as long as an answer may take: a late answer must not be mistaken for that to
    /// another request.
    fn read_away(&mut self) -> Result<(), Failure> {
        let deadline = Instant::now() + self.timeout;
        while Instant::now() < deadline {
            self.read()?;
        }
        Ok(())
    }

    /// Received characters; empty if the line was silent. An interruption ends the command here, however long an answer
    /// may take.
    fn read(&mut self) -> Result<Vec<u8>, Failure> {
        if interruption::is_requested() {
            return Err(self.failure("interrupted"));
        }
        let mut buffer = [0; LONGEST];
        match self.wire.receive(&mut buffer) {
            Ok(count) => Ok(buffer[..count].to_vec()),
            Err(error) => Err(self.failure(&error.to_string())),
        }
    }
}

/// The value of hexadecimal digits.
pub fn number(digits: &[u8]) -> Option<u32> {
    let text = std::str::from_utf8(digits).ok()?;
    u32::from_str_radix(text, 16).ok()
}
