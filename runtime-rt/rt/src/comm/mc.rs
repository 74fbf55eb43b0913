//! MC protocol in binary, as a server: frames 1E (which FX3 understands) and 3E (which Q, L and FX5 do). This is what
//! SCADA packages, Node-RED and libraries speak over TCP; none of our manuals has it. It follows the public
//! descriptions of both frames, and after what the libraries pymcprotocol and mcprotocol send.
//!
//! X and Y are numbered by terminals: 8 is X010. Words of bit devices hold 16 of them, the lowest in bit 0. The
//! protocol has no authentication.

mod device;
mod frame_1e;
mod frame_3e;
#[cfg(test)]
mod tests;

use super::{Cut, Frame, LineFault, Map};

/// Maximum number of bytes of a request: 7168 bits or 960 words, with their frame.
pub const LONGEST: usize = 21 + 7168 / 2;

/// First byte of a request in frame 3E; the second one is 0.
const REQUEST_3E: u8 = 0x50;

/// Decides whether the bytes received so far form a request of either frame.
pub fn cut(received: &[u8]) -> Cut {
    let whole = match received {
        [REQUEST_3E] => return Cut::More,
        [REQUEST_3E, 0, ..] => frame_3e::length(received),
        [command, ..] if frame_1e::is_command(*command) => frame_1e::length(received),
        _ => return Cut::Drop,
    };
    match whole {
        Some(length) if length > LONGEST => Cut::Drop,
        Some(length) if length <= received.len() => Cut::Whole,
        _ => Cut::More,
    }
}

/// Answers a request of either frame; silence if it is neither.
///
/// # Errors
/// What is wrong with the request. The answer says so as well.
pub fn answer(request: &[u8], map: &mut dyn Map, reply: &mut Frame) -> Result<(), LineFault> {
    match request {
        [REQUEST_3E, 0, ..] => frame_3e::answer(request, map, reply),
        [command, ..] if frame_1e::is_command(*command) => frame_1e::answer(request, map, reply),
        _ => Err(LineFault::Form),
    }
}

/// Reason to reject a request; each frame has its own codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    /// A command that is not served.
    Command,
    /// Too few or too many points.
    Points,
    /// A device that the PLC does not have, or that the command does not take.
    Device,
    /// The data has not the length that the command says.
    Length,
    /// A value that is not allowed.
    Data,
}

impl Refusal {
    fn fault(self) -> LineFault {
        match self {
            Refusal::Command => LineFault::Command,
            Refusal::Points | Refusal::Data => LineFault::Data,
            Refusal::Device => LineFault::Address,
            Refusal::Length => LineFault::Length,
        }
    }
}

/// The bytes of a request that have not been read yet; numbers come with their low byte first.
#[derive(Clone, Copy, Debug)]
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Refusal> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(Refusal::Length)?;
        self.0 = rest;
        Ok(taken)
    }

    /// A number of up to four bytes.
    fn number(&mut self, bytes: usize) -> Result<u32, Refusal> {
        let taken = self.take(bytes)?;
        Ok(taken
            .iter()
            .rev()
            .fold(0, |number, &byte| number << 8 | u32::from(byte)))
    }

    fn end(self) -> Result<(), Refusal> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(Refusal::Length)
        }
    }
}

/// Checks a number of points.
fn points(count: u32, most: u32) -> Result<u32, Refusal> {
    if (1..=most).contains(&count) {
        Ok(count)
    } else {
        Err(Refusal::Points)
    }
}
