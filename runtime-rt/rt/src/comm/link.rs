//! Links that PLCs keep up by themselves: parallel link, N:N link and enhanced N:N link, and the polling of a computer
//! link's master.
//!
//! The manuals print no frame of the links between PLCs (h1u-h2u-programming §5.3 to §5.5); those here are our own, so
//! PLCs understand each other that run programs of rungc. What programs see (areas, registers, relays, times) is as the
//! manuals say.
//!
//! A frame is `STX text ETX sum`, in characters of seven bits: the text starts with a letter that gives its kind,
//! numbers are hexadecimal digits of upper case, a word has four, and the sum is the low byte of all characters after
//! STX up to and with ETX, in two digits.
//!
//! | text | sent by | meaning |
//! |---|---|---|
//! | `A` mode words | master of a parallel link | its area: in mode 0 seven words of bits (M800 to M899) and ten of D, in mode 1 two of D |
//! | `B` mode words | slave of a parallel link, as the answer | its area, alike |
//! | `D` station slaves mode words | each station of an N:N link | its block: words of bits, then words of D |
//! | `P` station slaves mode faults | master of an N:N link | asks this station for its block; four digits of faults say which stations are missing, station 0 in bit 0 |
//!
//! Station and slaves have one digit each; the mode of an N:N link is `0`, `1` or `2`, that of an enhanced one `E`. The
//! master of an N:N link begins each round with its own block, then asks one slave after the other. Every station takes
//! the blocks of all others. In STOP a PLC neither asks nor answers.

pub(super) mod nn;
pub(super) mod parallel;
mod text;

use super::computer_link::master::{self, Job, Schedule};
use super::{Cut, Frame, LineFault, Map};
use crate::plc::Class;

/// Role of a PLC on a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Master of a parallel link.
    ParallelMaster,
    /// Slave of a parallel link.
    ParallelSlave,
    /// Master of an N:N link.
    NnMaster {
        /// With 16 stations and fixed areas.
        enhanced: bool,
    },
    /// Slave of an N:N link.
    NnSlave {
        /// With 16 stations and fixed areas.
        enhanced: bool,
    },
    /// Master of HM's computer link.
    ComputerLinkMaster {
        /// Number of the first register of its work area.
        area: u16,
    },
}

/// State of a link. All zero is one that begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Link {
    /// Something has been sent or received.
    begun: bool,
    /// An answer is waited for.
    waiting: bool,
    /// The request has left the port, and its time-out runs.
    sent: bool,
    /// This station has been polled.
    polled: bool,
    /// The station whose turn it is.
    station: u8,
    /// Number of repeated requests.
    tries: u8,
    /// Number of slaves according to the master.
    slaves: u8,
    /// Mode according to the master.
    mode: u8,
    /// Missing stations, one bit each.
    missing: u16,
    /// Start of the time-out.
    since_us: u32,
    /// Time of the last frame from the partner.
    last_frame_us: u32,
    /// Start of the round.
    round_us: u32,
    /// The master's turns.
    schedule: Schedule,
    /// The master's job.
    job: Job,
}

impl Link {
    /// A link that begins.
    pub const fn new() -> Self {
        Link {
            begun: false,
            waiting: false,
            sent: false,
            polled: false,
            station: 0,
            tries: 0,
            slaves: 0,
            mode: 0,
            missing: 0,
            since_us: 0,
            last_frame_us: 0,
            round_us: 0,
            schedule: Schedule::new(),
            job: Job::new(),
        }
    }

    /// Decides whether the characters received so far form a frame.
    pub fn cut(&self, role: Role, received: &[u8]) -> Cut {
        match role {
            Role::ComputerLinkMaster { .. } if !self.waiting => Cut::Drop,
            Role::ComputerLinkMaster { .. } => master::cut(self.job, received),
            _ => text::cut(received),
        }
    }

    /// Takes a frame. What is to be sent then, [`Link::poll`] says.
    ///
    /// # Errors
    /// What is wrong with the frame.
    pub fn receive(
        &mut self,
        role: Role,
        frame: &[u8],
        now_us: u32,
        map: &mut dyn Map,
    ) -> Result<(), LineFault> {
        if !map.running() {
            return Ok(());
        }
        match role {
            Role::ParallelMaster => parallel::receive(self, true, frame, now_us, map),
            Role::ParallelSlave => parallel::receive(self, false, frame, now_us, map),
            Role::NnMaster { enhanced } => nn::receive(self, true, enhanced, frame, now_us, map),
            Role::NnSlave { enhanced } => nn::receive(self, false, enhanced, frame, now_us, map),
            Role::ComputerLinkMaster { area } => {
                self.waiting = false;
                let outcome = master::accept(self.job, frame, map);
                master::note(area.into(), self.job, outcome.is_ok(), map);
                Ok(())
            }
        }
    }

    /// Called while nothing is being sent or received, as often as the port is looked after: makes the frame that is to
    /// be sent now, if one is.
    ///
    /// # Errors
    /// The partner has not sent a frame in time.
    pub fn poll(
        &mut self,
        role: Role,
        now_us: u32,
        map: &mut dyn Map,
        frame: &mut Frame,
    ) -> Result<(), LineFault> {
        if !map.running() {
            *self = Link {
                schedule: self.schedule,
                ..Link::new()
            };
            return Ok(());
        }
        if !self.begun {
            self.begun = true;
            self.last_frame_us = now_us;
            self.round_us = now_us;
        }
        match role {
            Role::ParallelMaster => parallel::poll_master(self, now_us, map, frame),
            Role::ParallelSlave => parallel::poll_slave(self, now_us, map, frame),
            Role::NnMaster { enhanced } => {
                nn::poll_master(self, enhanced, now_us, map, frame);
                Ok(())
            }
            Role::NnSlave { enhanced } => {
                nn::poll_slave(self, enhanced, now_us, map, frame);
                Ok(())
            }
            Role::ComputerLinkMaster { area } => {
                self.poll_computers(area.into(), now_us, map, frame);
                Ok(())
            }
        }
    }

    /// A request has been made, whose answer is waited for.
    fn wait(&mut self) {
        self.waiting = true;
        self.sent = false;
    }

    /// Returns true if the answer is overdue.
    fn is_overdue(&mut self, now_us: u32, time_out_us: u32) -> bool {
        if !self.sent {
            self.sent = true;
            self.since_us = now_us;
        }
        now_us.wrapping_sub(self.since_us) >= time_out_us
    }

    fn poll_computers(&mut self, area: u32, now_us: u32, map: &mut dyn Map, frame: &mut Frame) {
        if self.waiting {
            if !self.is_overdue(now_us, master::TIME_OUT_US) {
                return;
            }
            self.waiting = false;
            master::note(area, self.job, false, map);
        }
        if let Some(job) = self.schedule.next(area, map) {
            self.job = job;
            master::request(job, map, frame);
            self.wait();
        }
    }
}

/// A register's value; 0 if there is none.
fn value(number: u32, map: &dyn Map) -> u16 {
    map.word(Class::D, number).unwrap_or(0) as u16
}

/// Sets a register, if there is one.
fn set_value(number: u32, value: u16, map: &mut dyn Map) {
    let _ = map.set_word(Class::D, number, value as i16);
}

/// Sets a relay, if there is one.
fn set_relay(number: u32, on: bool, map: &mut dyn Map) {
    let _ = map.set_bit(Class::M, number, on);
}

/// Data sent by one station: bits of M and words of D.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Block {
    /// First relay, and how many.
    bits: (u32, u32),
    /// First register, and how many.
    words: (u32, u32),
}

impl Block {
    /// Number of digits in a frame.
    fn digits(self) -> usize {
        4 * (self.bits.1.div_ceil(16) + self.words.1) as usize
    }

    /// Appends the values of its devices.
    fn write(self, map: &dyn Map, frame: &mut Frame) {
        let (first, count) = self.bits;
        for start in (0..count).step_by(16) {
            let word = (start..count.min(start + 16)).fold(0, |word, index| {
                let on = map.bit(Class::M, first + index) == Some(true);
                word | u32::from(on) << (index - start)
            });
            frame.push_hex(word, 4);
        }
        for number in self.words.0..self.words.0 + self.words.1 {
            frame.push_hex(value(number, map).into(), 4);
        }
    }

    /// Sets its devices to what a frame says.
    fn read(self, digits: &[u8], map: &mut dyn Map) -> Result<(), LineFault> {
        if digits.len() != self.digits() {
            return Err(LineFault::Length);
        }
        let word_of = |digits| super::hex_digits(digits);
        if digits.chunks(4).any(|word| word_of(word).is_none()) {
            return Err(LineFault::Unknown);
        }
        let mut words = digits.chunks(4).filter_map(word_of);
        let (first, count) = self.bits;
        for start in (0..count).step_by(16) {
            let word = words.next().unwrap_or(0);
            for index in start..count.min(start + 16) {
                set_relay(first + index, word >> (index - start) & 1 != 0, map);
            }
        }
        for (number, word) in (self.words.0..self.words.0 + self.words.1).zip(words) {
            set_value(number, word as u16, map);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
