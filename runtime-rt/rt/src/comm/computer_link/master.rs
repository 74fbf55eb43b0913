//! HM as the master of a computer link: tasks in registers, worked off in turn (hm-motion-controller §6.3.2).
//!
//! A work area of 20 registers describes the tasks: kinds of tasks with the first register of their blocks, how many
//! blocks there are, and how many bytes of data each has. A block is a station number and the data; the slave's
//! register that is read or written has the number of the master's. Tasks of level 0 get two frames of three, those of
//! level 1 the third; within a level, reads come first.
//!
//! The manual does not say where the second block of a kind begins; it is assumed to follow the first: `1 + bytes / 2`
//! registers on.

use super::{ACK, Dialect, ENQ, ETX, NAK, STX, Settings, end, head};
use crate::comm::{Cut, Frame, LineFault, Map, hex_digits};
use crate::plc::Class;

/// Microseconds after which a slave that has not answered counts as off line. The manual states none.
pub const TIME_OUT_US: u32 = 300_000;

/// Longest answer: 64 registers.
pub const LONGEST: usize = 5 + 4 * MOST as usize + 3;

/// Maximum number of registers of a frame.
const MOST: u32 = 64;
/// Registers that computer link reaches.
const REGISTERS: u32 = 8000;
/// State bits of the stations, 16 to a register.
const STATES: u32 = 12;
/// Good answers.
const GOOD: u32 = 16;
/// Time-outs and bad answers.
const BAD: u32 = 17;
/// The kinds of tasks of each level: where their three registers are, and whether they write.
const KINDS: [[(u32, bool); 2]; 2] = [[(0, false), (3, true)], [(6, false), (9, true)]];
/// The level of each of three frames.
const TURNS: [usize; 3] = [0, 0, 1];

/// One frame's work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Job {
    /// The slave's station.
    pub station: u8,
    /// True if its registers are written.
    pub write: bool,
    /// First register, of master and slave.
    pub first: u16,
    /// Number of registers.
    pub count: u16,
}

impl Job {
    /// No job.
    pub const fn new() -> Self {
        Job {
            station: 0,
            write: false,
            first: 0,
            count: 0,
        }
    }

    /// Numbers of its registers.
    fn registers(self) -> core::ops::Range<u32> {
        let first = u32::from(self.first);
        first..first + u32::from(self.count)
    }

    /// Characters of the answer to a read.
    fn answer(self) -> usize {
        5 + 4 * usize::from(self.count) + 3
    }
}

/// Turns of the tasks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Schedule {
    turn: u8,
    next: [u16; 2],
}

impl Schedule {
    /// As after UINIT.
    pub const fn new() -> Self {
        Schedule {
            turn: 0,
            next: [0; 2],
        }
    }

    /// The next job of the work area that begins at D`area`; `None` if there is nothing to do.
    pub fn next(&mut self, area: u32, map: &dyn Map) -> Option<Job> {
        let turn = usize::from(self.turn) % TURNS.len();
        let level = TURNS[turn];
        self.turn = turn as u8 + 1;
        self.next_of(level, area, map)
            .or_else(|| self.next_of(1 - level, area, map))
    }

    fn next_of(&mut self, level: usize, area: u32, map: &dyn Map) -> Option<Job> {
        let kinds = KINDS.get(level)?;
        let place = self.next.get_mut(level)?;
        let total: u32 = kinds.iter().map(|kind| tasks(area + kind.0, map)).sum();
        if total == 0 {
            return None;
        }
        let mut index = u32::from(*place) % total;
        *place = ((index + 1) % total) as u16;
        for &(registers, write) in kinds {
            let count = tasks(area + registers, map);
            if index < count {
                return job(area + registers, index, write, map);
            }
            index -= count;
        }
        None
    }
}

/// A register's value.
fn register(number: u32, map: &dyn Map) -> u32 {
    map.word(Class::D, number)
        .map_or(0, |word| u32::from(word as u16))
}

/// Number of tasks of a kind; none without data.
fn tasks(kind: u32, map: &dyn Map) -> u32 {
    if register(kind + 2, map) < 2 {
        0
    } else {
        register(kind + 1, map)
    }
}

/// Task `index` of a kind, if its registers exist.
fn job(kind: u32, index: u32, write: bool, map: &dyn Map) -> Option<Job> {
    let words = (register(kind + 2, map) / 2).min(MOST);
    let block = register(kind, map) + index * (1 + words);
    let station = u8::try_from(register(block, map)).ok()?;
    (block + 1 + words <= REGISTERS).then_some(Job {
        station,
        write,
        first: (block + 1) as u16,
        count: words as u16,
    })
}

/// Settings of HM's frames: format 1 with sum.
fn settings(station: u8) -> Settings {
    Settings {
        station,
        sum: true,
        crlf: false,
        dialect: Dialect::Hm,
    }
}

/// Makes the request of a job.
pub fn request(job: Job, map: &dyn Map, frame: &mut Frame) {
    head(ENQ, job.station, b"FF", frame);
    frame.extend(if job.write { b"WW0D" } else { b"WR0D" });
    for place in [1000, 100, 10, 1] {
        frame.push(b'0' + (job.first / place % 10) as u8);
    }
    frame.push_hex(job.count.into(), 2);
    if job.write {
        for number in job.registers() {
            frame.push_hex(register(number, map), 4);
        }
    }
    end(settings(job.station), frame);
}

/// Decides whether the characters received so far form the answer to a job.
pub fn cut(job: Job, received: &[u8]) -> Cut {
    let length = match received.first() {
        Some(&STX) => job.answer(),
        Some(&ACK) => 5,
        Some(&NAK) => 7,
        _ => return Cut::Drop,
    };
    if received.len() < length {
        Cut::More
    } else {
        Cut::Whole
    }
}

/// Takes the answer to a job.
///
/// # Errors
/// It is a refusal, damaged, or not from this station.
pub fn accept(job: Job, reply: &[u8], map: &mut dyn Map) -> Result<(), LineFault> {
    let mut bytes = [0; LONGEST];
    let mut wanted = Frame::new(&mut bytes);
    head(
        if job.write { ACK } else { STX },
        job.station,
        b"FF",
        &mut wanted,
    );
    let Some((start, rest)) = reply.split_at_checked(wanted.len()) else {
        return Err(LineFault::Length);
    };
    if start != wanted.as_slice() {
        return Err(LineFault::Form);
    }
    if job.write {
        return Ok(());
    }
    let [digits @ .., ETX, high, low] = rest else {
        return Err(LineFault::Form);
    };
    let summed = reply.get(1..reply.len() - 2).unwrap_or(&[]);
    let sum = summed.iter().fold(0u8, |sum, &c| sum.wrapping_add(c));
    if hex_digits(&[*high, *low]) != Some(sum.into()) {
        return Err(LineFault::Sum);
    }
    if digits.len() != 4 * usize::from(job.count) {
        return Err(LineFault::Length);
    }
    if digits.chunks(4).any(|word| hex_digits(word).is_none()) {
        return Err(LineFault::Unknown);
    }
    for (number, word) in job.registers().zip(digits.chunks(4)) {
        let value = hex_digits(word).unwrap_or(0) as u16 as i16;
        let _ = map.set_word(Class::D, number, value);
    }
    Ok(())
}

/// Notes in the work area how a job went: the station's state and the counters.
pub fn note(area: u32, job: Job, done: bool, map: &mut dyn Map) {
    let states = area + STATES + u32::from(job.station) / 16;
    if job.station < 64 {
        let bit = 1 << (job.station % 16);
        let old = register(states, map);
        let new = if done { old & !bit } else { old | bit };
        let _ = map.set_word(Class::D, states, new as u16 as i16);
    }
    let counter = area + if done { GOOD } else { BAD };
    let count = register(counter, map).wrapping_add(1);
    let _ = map.set_word(Class::D, counter, count as u16 as i16);
}
