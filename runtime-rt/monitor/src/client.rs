//! The asking end of the programming port's protocol, for what only reads.

use crate::{Error, Line};
use rungc_rt::comm::fx_port;
use std::time::{Duration, Instant};

const STX: u8 = 0x02;
const ETX: u8 = 0x03;
const ENQ: u8 = 0x05;
const ACK: u8 = 0x06;
const NAK: u8 = 0x15;

/// More characters than an answer has.
const LONGEST: usize = 1024;

/// How long a PLC may take to answer, and how often it is asked.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Patience {
    /// Time to wait for an answer.
    pub timeout: Duration,
    /// Number of further requests if an answer is missing or damaged.
    pub retries: u32,
}

/// Asking end of a line.
pub struct Client<L> {
    line: L,
    patience: Patience,
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

impl<L: Line> Client<L> {
    /// A client on an open line, which has 7 data bits, even parity and 1 stop bit.
    pub fn new(line: L, patience: Patience) -> Self {
        Client { line, patience }
    }

    /// Failure to read the PLC.
    pub fn failure(&self, why: &str) -> Error {
        Error {
            line: self.line.name(),
            why: why.to_string(),
        }
    }

    /// Asks whether a PLC is there.
    ///
    /// # Errors
    /// No answer, or one that no PLC gives.
    pub fn greet(&mut self) -> Result<(), Error> {
        match self.exchange(&[ENQ])? {
            Reply::Ack => Ok(()),
            _ => Err(self.failure("what answers is not the programming port of a PLC")),
        }
    }

    /// Sends a command.
    ///
    /// # Errors
    /// No answer, or none that is whole.
    pub fn request(&mut self, text: &[u8]) -> Result<Reply, Error> {
        let sum = text.iter().fold(ETX, |sum, &c| sum.wrapping_add(c));
        let mut frame = vec![STX];
        frame.extend(text);
        frame.push(ETX);
        frame.extend(format!("{sum:02X}").bytes());
        self.exchange(&frame)
    }

    /// The bytes that a command reads; nothing if the PLC rejects it.
    ///
    /// # Errors
    /// No answer, or one of another length.
    pub fn data(&mut self, text: &[u8], count: usize) -> Result<Option<Vec<u8>>, Error> {
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
    fn exchange(&mut self, request: &[u8]) -> Result<Reply, Error> {
        let mut why = "";
        for attempt in 0..=self.patience.retries {
            if attempt > 0 {
                self.read_away()?;
            }
            self.send(request)?;
            match self.receive()? {
                Ok(reply) => return Ok(reply),
                Err(fault) => why = fault,
            }
        }
        let attempts = self.patience.retries + 1;
        Err(self.failure(&format!("{why} (asked {attempts} times)")))
    }

    fn send(&mut self, request: &[u8]) -> Result<(), Error> {
        let sent = self.line.send(request, self.patience.timeout);
        sent.map_err(|error| self.failure(&error.to_string()))
    }

    /// The answer, or what is wrong with it.
    fn receive(&mut self) -> Result<Result<Reply, &'static str>, Error> {
        let deadline = Instant::now() + self.patience.timeout;
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
    fn read_away(&mut self) -> Result<(), Error> {
        let deadline = Instant::now() + self.patience.timeout;
        while Instant::now() < deadline {
            self.read()?;
        }
        Ok(())
    }

    /// Received characters; empty if the line was silent.
    fn read(&mut self) -> Result<Vec<u8>, Error> {
        let mut buffer = [0; LONGEST];
        match self.line.receive(&mut buffer) {
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
