//! MC protocol as a server: frames 1E (which FX3 understands) and 3E (which Q, L and FX5 do), in binary and in ASCII.
//! This is what SCADA packages, Node-RED and libraries speak over TCP; none of our manuals has it. It follows the
//! public descriptions of both frames (FX3U-ENET-ADP user's manual, chapter 7) and what the libraries pymcprotocol,
//! mcprotocol and fx3u-mcprotocol send. The first character of a request shows its frame and code.
//!
//! X and Y are numbered by terminals: 8 is X010. Words of bit devices hold 16 of them, the lowest in bit 0. The
//! protocol has no authentication.

mod device;
mod frame_1e;
mod frame_3e;
#[cfg(test)]
mod tests;

use super::{Cut, Frame, LineFault, Map};
pub use device::codes;

/// Maximum number of characters of a request: 960 words in ASCII, with their frame.
pub const LONGEST: usize = 42 + 4 * 960;

/// Code of a frame's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Code {
    /// Bytes, the low one first.
    Binary,
    /// Hexadecimal digits, the high one first.
    Ascii,
}

impl Code {
    /// Characters that a byte takes.
    const fn width(self) -> usize {
        match self {
            Code::Binary => 1,
            Code::Ascii => 2,
        }
    }
}

/// Frame of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Frame1e(Code),
    Frame3e(Code),
    /// A command of neither frame, which frame 1E rejects.
    Unknown(Code),
}

/// Set in the first byte of an answer.
const ANSWER: u32 = 0x80;

impl Form {
    /// Frame and code of a request.
    ///
    /// # Errors
    /// [`Refusal::Length`] if too few characters are there, [`Refusal::Digit`] and [`Refusal::Command`] if no request
    /// begins like this.
    fn of(received: &[u8]) -> Result<Form, Refusal> {
        const REQUEST_3E: &[u8] = &[0x50, 0];
        const REQUEST_3E_ASCII: &[u8] = b"5000";
        match received {
            [] => Err(Refusal::Length),
            [b'0' | b'1', ..] => {
                let command = Fields::new(received, Code::Ascii).number(1)?;
                Ok(Form::of_command(command, Code::Ascii))
            }
            [0x50 | b'5', ..] => {
                let (head, code) = if received.starts_with(b"5") {
                    (REQUEST_3E_ASCII, Code::Ascii)
                } else {
                    (REQUEST_3E, Code::Binary)
                };
                if received.starts_with(head) {
                    Ok(Form::Frame3e(code))
                } else if head.starts_with(received) {
                    Err(Refusal::Length)
                } else {
                    Err(Refusal::Command)
                }
            }
            // An answer.
            [0x80..=0xff, ..] => Err(Refusal::Command),
            [command, ..] => Ok(Form::of_command(u32::from(*command), Code::Binary)),
        }
    }

    /// Frame of a request that begins with a command.
    fn of_command(command: u32, code: Code) -> Form {
        if frame_1e::is_command(command) {
            Form::Frame1e(code)
        } else {
            Form::Unknown(code)
        }
    }
}

/// Decides whether the bytes received so far form a request of either frame.
pub fn cut(received: &[u8]) -> Cut {
    let length = Form::of(received).and_then(|form| match form {
        Form::Frame1e(code) => frame_1e::length(received, code),
        Form::Frame3e(code) => frame_3e::length(received, code),
        Form::Unknown(code) => Ok(code.width()),
    });
    match length {
        Ok(length) if length > LONGEST => Cut::Drop,
        Ok(length) if length <= received.len() => Cut::Whole,
        Ok(_) | Err(Refusal::Length) => Cut::More,
        Err(_) => Cut::Drop,
    }
}

/// Answers a request of either frame; silence if it is neither.
///
/// # Errors
/// What is wrong with the request. The answer says so as well. After [`LineFault::Length`] and [`LineFault::Form`] the
/// beginning of the next request is unknown.
pub fn answer(request: &[u8], map: &mut dyn Map, reply: &mut Frame) -> Result<(), LineFault> {
    match Form::of(request) {
        Ok(Form::Frame1e(code)) => frame_1e::answer(
            Fields::new(request, code),
            map,
            &mut Reply { frame: reply, code },
        ),
        Ok(Form::Frame3e(code)) => frame_3e::answer(
            Fields::new(request, code),
            map,
            &mut Reply { frame: reply, code },
        ),
        Ok(Form::Unknown(code)) => {
            let command = Fields::new(request, code).number(1);
            let mut reply = Reply { frame: reply, code };
            reply.number(command.map_err(Refusal::fault)? | ANSWER, 1);
            reply.number(frame_1e::UNKNOWN, 1);
            Err(LineFault::Form)
        }
        Err(_) => Err(LineFault::Form),
    }
}

/// Reason to reject a request; each frame has its own codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    /// A command that is not served.
    Command,
    /// Too few or too many points.
    Points,
    /// A code or a name of no device.
    Device,
    /// A first device that the PLC does not have.
    Head,
    /// A last device that the PLC does not have.
    End,
    /// A word device in a command of bits.
    Kind,
    /// Words of bit devices that do not begin at a multiple of 16.
    Group,
    /// A mode that is not supported.
    Mode,
    /// The data has not the length that the command says.
    Length,
    /// The state of a bit that is neither 0 nor 1.
    Bit,
    /// Another PLC, which cannot be reached through this one.
    Station,
    /// A character that is not a digit of a number in ASCII.
    Digit,
}

impl Refusal {
    fn fault(self) -> LineFault {
        match self {
            Refusal::Command => LineFault::Command,
            Refusal::Points | Refusal::Bit | Refusal::Mode => LineFault::Data,
            Refusal::Device | Refusal::Head | Refusal::End | Refusal::Kind | Refusal::Group => {
                LineFault::Address
            }
            Refusal::Length => LineFault::Length,
            Refusal::Station => LineFault::Station,
            Refusal::Digit => LineFault::Unknown,
        }
    }
}

/// The characters of a request that have not been read yet.
#[derive(Clone, Copy, Debug)]
struct Fields<'a> {
    left: &'a [u8],
    code: Code,
}

impl<'a> Fields<'a> {
    fn new(left: &'a [u8], code: Code) -> Self {
        Fields { left, code }
    }

    /// Characters as they are.
    fn characters(&mut self, count: usize) -> Result<&'a [u8], Refusal> {
        let (taken, rest) = self.left.split_at_checked(count).ok_or(Refusal::Length)?;
        self.left = rest;
        Ok(taken)
    }

    /// The characters of this many bytes.
    fn skip(&mut self, bytes: usize) -> Result<&'a [u8], Refusal> {
        self.characters(bytes * self.code.width())
    }

    /// A number of up to four bytes.
    fn number(&mut self, bytes: usize) -> Result<u32, Refusal> {
        let taken = self.skip(bytes)?;
        match self.code {
            Code::Binary => Ok(taken
                .iter()
                .rev()
                .fold(0, |number, &byte| number << 8 | u32::from(byte))),
            Code::Ascii => digits(taken, 16),
        }
    }

    /// Checks that this many numbers follow.
    fn check_numbers(mut self, count: u32, bytes: usize) -> Result<(), Refusal> {
        (0..count).try_for_each(|_| self.number(bytes).map(drop))
    }

    /// Checks that all that follows are bits of a batch: two to a byte, or a digit each.
    fn check_bits(self) -> Result<(), Refusal> {
        let are_bits = |&character: &u8| match self.code {
            Code::Binary => character & !0x11 == 0,
            Code::Ascii => matches!(character, b'0' | b'1'),
        };
        if self.left.iter().all(are_bits) {
            Ok(())
        } else {
            Err(Refusal::Bit)
        }
    }

    fn end(self) -> Result<(), Refusal> {
        if self.left.is_empty() {
            Ok(())
        } else {
            Err(Refusal::Length)
        }
    }
}

/// Value of at most eight digits.
fn digits(text: &[u8], base: u32) -> Result<u32, Refusal> {
    text.iter().try_fold(0, |number, &digit| {
        let digit = char::from(digit).to_digit(base).ok_or(Refusal::Digit)?;
        Ok(number * base + digit)
    })
}

/// An answer in the code of its request.
struct Reply<'a, 'b> {
    frame: &'a mut Frame<'b>,
    code: Code,
}

impl Reply<'_, '_> {
    /// Appends a number of up to four bytes.
    fn number(&mut self, value: u32, bytes: usize) {
        match self.code {
            Code::Binary => self
                .frame
                .extend(value.to_le_bytes().get(..bytes).unwrap_or_default()),
            Code::Ascii => self.frame.push_hex(value, 2 * bytes as u32),
        }
    }

    /// Replaces the number at a place.
    fn replace(&mut self, place: usize, value: u32, bytes: usize) {
        let end = self.frame.len();
        self.number(value, bytes);
        let width = bytes * self.code.width();
        for index in 0..width {
            let character = self.frame.as_slice().get(end + index).copied();
            self.frame.set(place + index, character.unwrap_or_default());
        }
        self.frame.truncate(end);
    }

    /// Appends bits: two to a byte, the first in the high half, or a digit for each.
    fn bits(&mut self, count: u32, on: impl Fn(u32) -> bool) {
        match self.code {
            Code::Binary => {
                let half = |index| u8::from(index < count && on(index));
                for index in (0..count).step_by(2) {
                    self.frame.push(half(index) << 4 | half(index + 1));
                }
            }
            Code::Ascii => {
                for index in 0..count {
                    self.frame.push(b'0' + u8::from(on(index)));
                }
            }
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
