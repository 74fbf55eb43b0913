//! Records in two slots of flash.

use super::record::{self, Record};
use super::{Loaded, Retained};
use crate::program::Program;

/// The longest word of flash, in bytes, as that of an STM32H7.
const MOST: usize = 32;

/// Records begin at multiples of this, in bytes, or of the flash's word if that is longer.
const LEAST: u32 = 8;

/// Flash did not do what it was asked: an operation failed, or what was written reads back as something else.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FlashFailed;

/// Two slots of flash, 0 and 1, each of which is erased as a whole: one or more of its pages or sectors. RAM that keeps
/// its contents (battery, FRAM) works likewise: it erases by writing 0xFF.
pub trait Flash {
    /// Bytes of each slot, a multiple of [`Flash::word_len`].
    fn slot_len(&self) -> u32;
    /// Bytes that flash writes at once, a power of 2 up to 32. By default, words of up to 8 bytes fit.
    fn word_len(&self) -> u32 {
        LEAST
    }
    /// Reads bytes of a slot.
    fn read(&mut self, slot: usize, offset: u32, bytes: &mut [u8]) -> Result<(), FlashFailed>;
    /// Makes all bytes of a slot 0xFF.
    fn erase(&mut self, slot: usize) -> Result<(), FlashFailed>;
    /// Writes bytes that are erased. `offset` is a multiple of 8 and of the word, and so is the number of bytes.
    fn program(&mut self, slot: usize, offset: u32, bytes: &[u8]) -> Result<(), FlashFailed>;
}

/// The newest record, and where it is.
type Newest = (usize, Record);

/// Saves a program's latched devices to two slots of flash, and loads them.
#[derive(Clone, Debug)]
pub struct Slots<F> {
    /// The flash.
    pub flash: F,
    newest: Option<Newest>,
    /// Slot and offset of the next record; the slot is erased from there on.
    next: Option<(usize, u32)>,
    /// Checksum of the values that were saved or loaded last.
    saved: Option<u32>,
    /// Time of the last check for changes by [`Slots::poll`].
    looked_ms: u32,
}

impl<F: Flash> Slots<F> {
    /// Looks for the newest record.
    ///
    /// # Errors
    /// Flash cannot be read.
    pub fn open(mut flash: F) -> Result<Self, FlashFailed> {
        let slots = [scan(&mut flash, 0)?, scan(&mut flash, 1)?];
        let records = slots
            .iter()
            .enumerate()
            .filter_map(|(slot, found)| Some((slot, found.newest?)));
        let newest = records.reduce(|a, b| {
            let later = b.1.sequence.wrapping_sub(a.1.sequence) as i32 > 0;
            if later { b } else { a }
        });
        let free = |(slot, _): Newest| Some((slot, slots.get(slot)?.end));
        Ok(Slots {
            flash,
            newest,
            next: newest.and_then(free),
            saved: None,
            looked_ms: 0,
        })
    }

    /// Gives a program that was just switched on the values of the newest record.
    ///
    /// # Errors
    /// Flash cannot be read.
    pub fn load<P: Program + ?Sized>(&mut self, program: &mut P) -> Result<Loaded, FlashFailed> {
        let Some((slot, record)) = self.newest else {
            return Ok(Loaded::Nothing);
        };
        let flash = &mut self.flash;
        let mut read = |offset, bytes: &mut [u8]| flash.read(slot, offset, bytes);
        let loaded = record::restore(&mut read, &record, program)?;
        if let Loaded::Restored { .. } = loaded {
            self.saved = Some(record::state(program));
        }
        Ok(loaded)
    }

    /// Saves a program's latched devices now, as when a supply says that power is about to fail. Unless
    /// [`Slots::prepare`] was called, or [`Slots::poll`], this may have to erase a slot first.
    ///
    /// # Errors
    /// Flash cannot be written, or a slot is shorter than a record.
    pub fn save<P: Program + ?Sized>(&mut self, program: &P) -> Result<(), FlashFailed> {
        let length = program.retained().record_len();
        let (slot, at) = self.room(length)?;
        let sequence = self
            .newest
            .map_or(0, |newest| newest.1.sequence.wrapping_add(1));
        // An error from here on leaves a part of a record.
        let align = align(&self.flash);
        self.next = Some((slot, at.saturating_add(length.next_multiple_of(align))));
        let mut writer = Writer {
            flash: &mut self.flash,
            slot,
            at,
            chunk: [0xFF; MOST],
            align,
            used: 0,
        };
        record::write(program, sequence, &mut |bytes| writer.put(bytes))?;
        writer.finish()?;
        let flash = &mut self.flash;
        let end = flash.slot_len();
        let mut read = |offset, bytes: &mut [u8]| flash.read(slot, offset, bytes);
        let written = record::find(&mut read, at, end)?;
        let record = written.filter(|record| record.sequence == sequence);
        self.newest = Some((slot, record.ok_or(FlashFailed)?));
        self.saved = Some(record::state(program));
        Ok(())
    }

    /// Makes room for the next record, so that [`Slots::save`] does not have to erase.
    ///
    /// # Errors
    /// Flash cannot be erased, or a slot is shorter than a record.
    pub fn prepare(&mut self, retained: &Retained) -> Result<(), FlashFailed> {
        self.room(retained.record_len()).map(drop)
    }

    /// To be called between scans, `now_ms` is the program's time: once in `every_ms` saves latched devices if one has
    /// changed. Returns whether they were saved.
    ///
    /// # Errors
    /// Flash cannot be written, or a slot is shorter than a record.
    pub fn poll<P: Program + ?Sized>(
        &mut self,
        program: &P,
        now_ms: u32,
        every_ms: u32,
    ) -> Result<bool, FlashFailed> {
        if now_ms.wrapping_sub(self.looked_ms) < every_ms {
            return Ok(false);
        }
        self.looked_ms = now_ms;
        let changed = self.saved != Some(record::state(program));
        if changed {
            self.save(program)?;
            self.prepare(&program.retained())?;
        }
        Ok(changed)
    }

    /// Number of records a slot takes between two erasures.
    pub fn saves_per_erasure(&self, retained: &Retained) -> u32 {
        let length = retained.record_len();
        self.flash.slot_len() / length.next_multiple_of(align(&self.flash))
    }

    /// Location of the next record: after the newest one, or in the other slot, which is then erased.
    fn room(&mut self, length: u32) -> Result<(usize, u32), FlashFailed> {
        let end = self.flash.slot_len();
        let align = align(&self.flash);
        let length = length.next_multiple_of(align);
        if length > end || align as usize > MOST {
            return Err(FlashFailed);
        }
        match self.next {
            Some((slot, at)) if end - at.min(end) >= length => Ok((slot, at)),
            _ => {
                let slot = self.newest.map_or(0, |newest| 1 - newest.0);
                self.next = None;
                self.flash.erase(slot)?;
                self.next = Some((slot, 0));
                Ok((slot, 0))
            }
        }
    }
}

/// Records begin at multiples of this.
fn align<F: Flash>(flash: &F) -> u32 {
    flash.word_len().max(LEAST)
}

/// Contents of a slot.
#[derive(Clone, Copy)]
struct Found {
    /// Its last complete record.
    newest: Option<Record>,
    /// Offset from which all bytes are erased.
    end: u32,
}

/// Looks through a slot. What is neither a record nor erased is left of one that was cut short.
fn scan<F: Flash>(flash: &mut F, slot: usize) -> Result<Found, FlashFailed> {
    let length = flash.slot_len();
    let align = align(flash);
    let mut found = Found {
        newest: None,
        end: 0,
    };
    let mut at = 0;
    while length - at >= align {
        let mut chunk = [0; MOST];
        let chunk = chunk.get_mut(..align as usize).ok_or(FlashFailed)?;
        flash.read(slot, at, chunk)?;
        let next = if chunk.iter().all(|&byte| byte == 0xFF) {
            at + align
        } else {
            let mut read = |offset, bytes: &mut [u8]| flash.read(slot, offset, bytes);
            let record = record::find(&mut read, at, length)?;
            let next = at + record.map_or(align, |record| record.length.next_multiple_of(align));
            found = Found {
                newest: record.or(found.newest),
                end: next,
            };
            next
        };
        at = next.min(length);
    }
    Ok(found)
}

/// Gathers bytes to pieces that flash takes.
struct Writer<'f, F> {
    flash: &'f mut F,
    slot: usize,
    at: u32,
    chunk: [u8; MOST],
    align: u32,
    used: usize,
}

impl<F: Flash> Writer<'_, F> {
    fn put(&mut self, bytes: &[u8]) -> Result<(), FlashFailed> {
        for &byte in bytes {
            if let Some(cell) = self.chunk.get_mut(self.used) {
                *cell = byte;
            }
            self.used += 1;
            if self.used == self.align as usize {
                self.flush()?;
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), FlashFailed> {
        let chunk = self.chunk.get(..self.align as usize).ok_or(FlashFailed)?;
        self.flash.program(self.slot, self.at, chunk)?;
        self.at += self.align;
        self.chunk.fill(0xFF);
        self.used = 0;
        Ok(())
    }

    fn finish(mut self) -> Result<(), FlashFailed> {
        if self.used > 0 {
            self.flush()?;
        }
        Ok(())
    }
}
