//! The record: latched devices as bytes, in little endian.
//!
//! | offset | bytes | what |
//! |---|---|---|
//! | 0 | 4 | `RGR1` |
//! | 4 | 4 | sequence number |
//! | 8 | 4 | length of the record, with its checksum |
//! | 12 | 2 | number of runs |
//! | 14 | 1 | length of the name |
//! | 15 | n | name of the program and its model |
//! | | 5 each | runs: class ([`Class`]), first number, count |
//! | | | values, run after run |
//! | | 4 | CRC-32 (as in zip files) of all before it |
//!
//! Relays take a bit each, from the lowest bit of a byte on; registers two bytes; timers and 16-bit counters the value
//! and a byte whose bit 0 is the contact and bit 1 the reset state; 32-bit counters the same with four bytes of value.

use super::{Loaded, OWNER_MAX, Owner, Retained, RetainedRun};
use crate::plc::Class;
use crate::program::Program;
use crate::runs::FIRST_COUNTER32;

/// The first bytes of a record.
pub const MAGIC: [u8; 4] = *b"RGR1";

/// Bytes before the name.
pub(super) const HEADER: u32 = 15;

/// Bytes of a run.
const RUN: u32 = 5;

/// Bits of a timer's or counter's states: its contact, and its reset state ([`Program::is_reset`]).
const CONTACT: u8 = 1;
const RESET: u8 = 2;

/// Bytes of the checksum.
const CHECKSUM: u32 = 4;

/// CRC-32 by half bytes.
#[derive(Clone, Copy)]
pub(super) struct Crc(u32);

impl Crc {
    pub(super) const fn new() -> Self {
        Crc(u32::MAX)
    }

    pub(super) fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 ^= u32::from(byte);
            for _ in 0..2 {
                self.0 = self.0 >> 4 ^ half(self.0 & 15);
            }
        }
    }

    pub(super) const fn value(self) -> u32 {
        !self.0
    }
}

/// Contribution of four bits to the checksum.
const fn half(bits: u32) -> u32 {
    let mut value = bits;
    let mut i = 0;
    while i < 4 {
        value = value >> 1 ^ if value & 1 == 1 { 0xEDB8_8320 } else { 0 };
        i += 1;
    }
    value
}

/// Form of a class's devices in a record.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Bit,
    Word,
    /// A value of two bytes, and a byte of states.
    Short,
    /// A value of four bytes, and a byte of states.
    Long,
}

impl Form {
    fn of(class: Class, number: u32) -> Form {
        match class {
            Class::X | Class::Y | Class::M | Class::S => Form::Bit,
            Class::T => Form::Short,
            Class::C if number >= FIRST_COUNTER32 => Form::Long,
            Class::C => Form::Short,
            Class::D | Class::R | Class::V | Class::Z | Class::ER => Form::Word,
        }
    }

    /// Bytes of `count` devices.
    fn bytes(self, count: u32) -> u32 {
        match self {
            Form::Bit => count.div_ceil(8),
            Form::Word => count * 2,
            Form::Short => count * 3,
            Form::Long => count * 5,
        }
    }
}

/// Length of a record.
pub(super) fn length(retained: &Retained) -> u32 {
    let values = retained.runs.iter().map(|run| {
        let form = Form::of(run.class, run.first.into());
        RUN + form.bytes(run.count.into())
    });
    HEADER + owner(retained).len() as u32 + values.sum::<u32>() + CHECKSUM
}

/// The name in a record.
fn owner<'a>(retained: &Retained<'a>) -> &'a [u8] {
    let bytes = retained.program.as_bytes();
    bytes.get(..OWNER_MAX).unwrap_or(bytes)
}

/// Takes the bytes of a record in turn.
pub type Sink<'s, E> = &'s mut dyn FnMut(&[u8]) -> Result<(), E>;

/// Writes a record.
///
/// # Errors
/// The first error of `sink`.
pub fn write<P: Program + ?Sized, E>(
    program: &P,
    sequence: u32,
    sink: Sink<'_, E>,
) -> Result<(), E> {
    let retained = program.retained();
    let mut crc = Crc::new();
    let mut put = |bytes: &[u8]| {
        crc.add(bytes);
        sink(bytes)
    };
    let name = owner(&retained);
    put(&MAGIC)?;
    put(&sequence.to_le_bytes())?;
    put(&length(&retained).to_le_bytes())?;
    put(&(retained.runs.len() as u16).to_le_bytes())?;
    put(&[name.len() as u8])?;
    put(name)?;
    for run in retained.runs {
        put(&[run.class as u8])?;
        put(&run.first.to_le_bytes())?;
        put(&run.count.to_le_bytes())?;
    }
    values(program, &mut put)?;
    sink(&crc.value().to_le_bytes())
}

/// Writes the values of a program's latched devices. On models with a latch key they are 0 without it.
fn values<P: Program + ?Sized, E>(program: &P, sink: Sink<'_, E>) -> Result<(), E> {
    let retained = program.retained();
    let held = |(register, key): (u32, i16)| program.word(Class::D, register) == Some(key);
    let kept = retained.key.is_none_or(held);
    for run in retained.runs {
        let class = run.class;
        let end = u32::from(run.first) + u32::from(run.count);
        let form = Form::of(class, run.first.into());
        let step = if form == Form::Bit { 8 } else { 1 };
        for number in (run.first.into()..end).step_by(step) {
            let bit = |number| kept && program.bit(class, number).unwrap_or(false);
            let word = match kept {
                true => program.word(class, number).unwrap_or(0),
                false => 0,
            };
            let contact = CONTACT * u8::from(retained.contacts && bit(number));
            let states = contact | (RESET * u8::from(kept && program.is_reset(class, number)));
            match form {
                Form::Bit => {
                    let bits = (number..end.min(number + 8)).rev();
                    sink(&[bits.fold(0, |byte, n| byte << 1 | u8::from(bit(n)))])?;
                }
                Form::Word => sink(&word.to_le_bytes())?,
                Form::Short => {
                    sink(&word.to_le_bytes())?;
                    sink(&[states])?;
                }
                Form::Long => {
                    let value = program.counter32(number).filter(|_| kept);
                    sink(&value.unwrap_or(0).to_le_bytes())?;
                    sink(&[states])?;
                }
            }
        }
    }
    Ok(())
}

/// A checksum of the values alone: whether something has changed.
pub fn state<P: Program + ?Sized>(program: &P) -> u32 {
    let mut crc = Crc::new();
    let add = |bytes: &[u8]| -> Result<(), core::convert::Infallible> {
        crc.add(bytes);
        Ok(())
    };
    let mut add = add;
    match values(program, &mut add) {
        Ok(()) => crc.value(),
        Err(never) => match never {},
    }
}

/// Reads bytes of a slot or a file from an offset on.
pub type Source<'s, E> = &'s mut dyn FnMut(u32, &mut [u8]) -> Result<(), E>;

/// A complete record.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Record {
    /// Its offset.
    pub(super) at: u32,
    /// Its length.
    pub(super) length: u32,
    /// Its sequence number.
    pub sequence: u32,
    runs: u16,
    owner: Owner,
}

/// The complete record that begins at an offset of something that is `end` bytes long; `None` if there is none.
///
/// # Errors
/// The first error of `source`.
pub fn find<E>(source: Source<'_, E>, at: u32, end: u32) -> Result<Option<Record>, E> {
    let mut header = [0; HEADER as usize];
    if end.saturating_sub(at) < HEADER + CHECKSUM {
        return Ok(None);
    }
    source(at, &mut header)?;
    let [m0, m1, m2, m3, s0, s1, s2, s3, l0, l1, l2, l3, r0, r1, name] = header;
    let length = u32::from_le_bytes([l0, l1, l2, l3]);
    let runs = u16::from_le_bytes([r0, r1]);
    let least = HEADER + u32::from(name) + RUN * u32::from(runs) + CHECKSUM;
    if [m0, m1, m2, m3] != MAGIC
        || usize::from(name) > OWNER_MAX
        || length < least
        || length > end - at
    {
        return Ok(None);
    }
    let mut owner = Owner {
        bytes: [0; OWNER_MAX],
        length: name,
    };
    if let Some(bytes) = owner.bytes.get_mut(..usize::from(name)) {
        source(at + HEADER, bytes)?;
    }
    let mut crc = Crc::new();
    let mut chunk = [0; 64];
    let checked = length - CHECKSUM;
    for from in (0..checked).step_by(chunk.len()) {
        let left = ((checked - from) as usize).min(chunk.len());
        if let Some(chunk) = chunk.get_mut(..left) {
            source(at + from, chunk)?;
            crc.add(chunk);
        }
    }
    let mut sum = [0; CHECKSUM as usize];
    source(at + checked, &mut sum)?;
    let sequence = u32::from_le_bytes([s0, s1, s2, s3]);
    Ok((u32::from_le_bytes(sum) == crc.value()).then_some(Record {
        at,
        length,
        sequence,
        runs,
        owner,
    }))
}

/// Gives a program the values of a record, if it is one of this program.
///
/// # Errors
/// The first error of `source`; some devices may have their values then.
pub fn restore<P: Program + ?Sized, E>(
    source: Source<'_, E>,
    record: &Record,
    program: &mut P,
) -> Result<Loaded, E> {
    if owner(&program.retained()) != record.owner.as_str().as_bytes() {
        return Ok(Loaded::Foreign(record.owner));
    }
    let table = record.at + HEADER + u32::from(record.owner.length);
    let mut values = table + RUN * u32::from(record.runs);
    let mut dropped = 0;
    for i in 0..record.runs {
        let mut bytes = [0; RUN as usize];
        source(table + RUN * u32::from(i), &mut bytes)?;
        let [class, f0, f1, c0, c1] = bytes;
        let Some(class) = CLASSES.into_iter().find(|&known| known as u8 == class) else {
            return Ok(Loaded::Restored { dropped });
        };
        let run = RetainedRun {
            class,
            first: u16::from_le_bytes([f0, f1]),
            count: u16::from_le_bytes([c0, c1]),
        };
        let form = Form::of(class, run.first.into());
        for n in 0..u32::from(run.count) {
            let number = u32::from(run.first) + n;
            if program.retained().contains(class, number) {
                restore_one(source, (form, values, n), program, (class, number))?;
            } else {
                dropped += 1;
            }
        }
        values += form.bytes(run.count.into());
    }
    Ok(Loaded::Restored { dropped })
}

/// The classes of devices that can be latched.
const CLASSES: [Class; 9] = {
    use Class::*;
    [Y, M, S, T, C, D, R, V, Z]
};

/// Gives a device its value: the one of the `n`-th device of a run whose values begin at an offset.
fn restore_one<P: Program + ?Sized, E>(
    source: Source<'_, E>,
    (form, values, n): (Form, u32, u32),
    program: &mut P,
    (class, number): (Class, u32),
) -> Result<(), E> {
    let mut bytes = [0; 5];
    let (at, length) = match form {
        Form::Bit => (n / 8, 1),
        Form::Word | Form::Short | Form::Long => (form.bytes(n), form.bytes(1) as usize),
    };
    if let Some(bytes) = bytes.get_mut(..length) {
        source(values + at, bytes)?;
    }
    let [b0, b1, b2, b3, b4] = bytes;
    let word = i16::from_le_bytes([b0, b1]);
    let contacts = program.retained().contacts;
    let set_states = |program: &mut P, states: u8| {
        program.set_reset(class, number, states & RESET != 0);
        program.set_bit(class, number, contacts && states & CONTACT != 0)
    };
    // A device that the model has and the program does not store takes no value.
    let _ = match form {
        Form::Bit => program.set_bit(class, number, b0 >> (n % 8) & 1 == 1),
        Form::Word => program.set_word(class, number, word),
        Form::Short => {
            let value = program.set_word(class, number, word);
            value.and(set_states(program, b2))
        }
        Form::Long => {
            let value = program.set_counter32(number, i32::from_le_bytes([b0, b1, b2, b3]));
            value.and(set_states(program, b4))
        }
    };
    Ok(())
}
