//! Requests of a master beyond reading and writing devices: the functions 07, 08, 0B, 0C, 11 and 16 of FX3's ADPRW
//! (FX3U MODBUS manual JY997D26201 §7.9 to §7.17, §8.3).
//!
//! A job's address is the sub-function of 08; its count is the data of 08 and the AND mask of 16. The manual puts two
//! bytes of a log (0C) and of a slave's identification (11) into a word without saying which comes first: here the low
//! half takes the first one, as in the 16-bit mode of RS.

use super::adu::Body;
use super::master::{Job, Layout};
use crate::comm::{Frame, LineFault, Map};

/// The status of the slave, in one byte.
const READ_STATUS: u8 = 0x07;
/// A diagnosis, by its sub-function.
const DIAGNOSE: u8 = 0x08;
/// The counter of events.
const READ_EVENT_COUNT: u8 = 0x0b;
/// The log of events.
const READ_EVENT_LOG: u8 = 0x0c;
/// Reads the identity of the slave.
const READ_IDENTITY: u8 = 0x11;
/// Changes bits of a register.
const MASK_REGISTER: u8 = 0x16;

/// The sub-function of 08 after which a slave only listens; it is not answered.
const LISTEN_ONLY: u16 = 4;
/// Maximum number of bytes of a log of events.
const LONGEST_LOG: usize = 64;
/// Maximum number of bytes that follow the state of a slave.
const LONGEST_IDENTITY: usize = 249;

/// Offset of the data of an answer, after station and function.
const DATA: usize = 2;

/// Returns true if a function is one of these.
pub(super) const fn is_known(function: u8) -> bool {
    matches!(
        function,
        READ_STATUS | DIAGNOSE | READ_EVENT_COUNT | READ_EVENT_LOG | READ_IDENTITY | MASK_REGISTER
    )
}

/// Returns true if a slave does not answer a job.
pub(super) fn is_silent(job: &Job) -> bool {
    (job.function, job.address) == (DIAGNOSE, LISTEN_ONLY)
}

/// Appends what follows the function.
pub(super) fn request(job: &Job, map: &dyn Map, frame: &mut Frame) -> Result<(), LineFault> {
    let goes_to_words = job.buffer.layout == Layout::Words;
    match job.function {
        DIAGNOSE => {
            if !matches!(job.address, 0..=LISTEN_ONLY | 0x0a..=0x12) {
                return Err(LineFault::Data);
            }
            frame.push_be16(job.address);
            frame.push_be16(job.count);
        }
        MASK_REGISTER => {
            let or_mask = job.buffer.word(0, map).ok_or(LineFault::Address)?;
            frame.push_be16(job.address);
            frame.push_be16(job.count);
            frame.push_be16(or_mask);
            return Ok(());
        }
        _ => {}
    }
    match goes_to_words || is_silent(job) {
        true => Ok(()),
        false => Err(LineFault::Address),
    }
}

/// Takes the answer; nothing is written unless all of it fits.
pub(super) fn accept(job: &Job, body: Body, map: &mut dyn Map) -> Result<(), LineFault> {
    let word = |at: usize| body.word(DATA + 2 * at);
    let has = |bytes: usize| match body.len() == DATA + bytes {
        true => Ok(()),
        false => Err(LineFault::Length),
    };
    // The bytes that an answer says it has.
    let counted = |most: usize| {
        let count = usize::from(body.byte(DATA).unwrap_or(0));
        has(1 + count)?;
        match count <= most {
            true => Ok(count),
            false => Err(LineFault::Data),
        }
    };
    match job.function {
        READ_STATUS => {
            has(1)?;
            store(job, map, 1, |_| body.byte(DATA).map(u16::from))
        }
        DIAGNOSE => {
            has(4)?;
            match word(0) == Some(job.address) {
                true => store(job, map, 1, |_| word(1)),
                false => Err(LineFault::Data),
            }
        }
        READ_EVENT_COUNT => {
            has(4)?;
            store(job, map, 2, word)
        }
        READ_EVENT_LOG => {
            const HEAD: usize = 6;
            let log = counted(HEAD + LONGEST_LOG)?;
            let log = log.checked_sub(HEAD).ok_or(LineFault::Length)?;
            let first = DATA + 1 + HEAD;
            store(job, map, 4 + log.div_ceil(2), |n| match n {
                0..=2 => body.word(DATA + 1 + 2 * n),
                3 => Some(log as u16),
                _ => packed(body, first, log, n - 4),
            })
        }
        READ_IDENTITY => {
            const HEAD: usize = 2;
            let more = counted(HEAD + LONGEST_IDENTITY)?;
            let more = more.checked_sub(HEAD).ok_or(LineFault::Length)?;
            let first = DATA + 1 + HEAD;
            store(job, map, 3 + more.div_ceil(2), |n| match n {
                0 | 1 => body.byte(DATA + 1 + n).map(u16::from),
                2 => Some(more as u16),
                _ => packed(body, first, more, n - 3),
            })
        }
        _ => {
            has(6)?;
            match (word(0), word(1)) {
                (Some(address), _) if address != job.address => Err(LineFault::Address),
                (_, Some(and_mask)) if and_mask != job.count => Err(LineFault::Data),
                _ => Ok(()),
            }
        }
    }
}

/// Two bytes of `count` from `first` on, as word `n`.
fn packed(body: Body, first: usize, count: usize, n: usize) -> Option<u16> {
    let byte = |at: usize| match at < count {
        true => body.byte(first + at),
        false => Some(0),
    };
    Some(u16::from_le_bytes([byte(2 * n)?, byte(2 * n + 1)?]))
}

/// Writes words to the job's devices, if they are all there.
fn store(
    job: &Job,
    map: &mut dyn Map,
    count: usize,
    word: impl Fn(usize) -> Option<u16>,
) -> Result<(), LineFault> {
    let there = map.has_words(job.buffer.class, job.buffer.first, count as u32);
    let stored =
        there.then(|| (0..count).try_for_each(|n| job.buffer.set_word(n as u32, word(n)?, map)));
    stored.flatten().ok_or(LineFault::Address)
}
