//! Writing an image into a microcontroller over the boot loader that its vendor put into ROM.
//!
//! [`chips`] lists the parts, [`loader`] speaks the protocol, [`Writer`] decides what is erased and written, in which
//! order, and verifies it.

pub mod chips;
pub mod loader;
pub mod uf2;

use chips::Chip;
use loader::{BLOCK, Line, Loader, LoaderError};
use object::read::elf::{ElfFile32, FileHeader, ProgramHeader};
use object::{Endianness, elf};
use std::ops::Range;

/// The byte of erased flash.
const ERASED: u8 = 0xFF;

/// The most flash that a part has; what extends further is not an image for one.
const LARGEST: u32 = 16 << 20;

/// An image: what flash holds from an address on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Payload {
    /// The address of the first byte.
    pub origin: u32,
    /// The bytes; gaps hold what erased flash holds.
    pub bytes: Vec<u8>,
    /// True if the file itself gives the addresses.
    pub is_elf: bool,
}

/// Reason why a file is not an image.
#[derive(Debug, thiserror::Error)]
pub enum PayloadError {
    /// It begins as an ELF file does, and is not one for a 32-bit machine.
    #[error("not an ELF file for a 32-bit microcontroller: {0}")]
    Elf(#[from] object::Error),
    /// Its machine is another.
    #[error("an ELF file for another machine than an Arm microcontroller")]
    Machine,
    /// It holds nothing for flash.
    #[error("the file holds nothing to be written")]
    Empty,
    /// Its parts are too far from each other to be in one flash memory.
    #[error("the image extends from 0x{:08X} to 0x{:X}, further than any flash", .0.start, .0.end)]
    Scattered(Range<u64>),
}

impl Payload {
    /// The parts of an ELF file that are loaded, at their load addresses; any other file is an image that begins at
    /// `origin`.
    ///
    /// # Errors
    /// An ELF file for another machine, or one whose parts are scattered; a file without contents.
    pub fn read(file: &[u8], origin: u32) -> Result<Payload, PayloadError> {
        let is_elf = file.starts_with(&elf::ELFMAG);
        let parts = match is_elf {
            true => loaded(file)?,
            false => vec![(origin, file)],
        };
        let ends = parts
            .iter()
            .map(|&(at, bytes)| u64::from(at) + bytes.len() as u64);
        let (Some(start), Some(end)) = (parts.iter().map(|part| part.0).min(), ends.max()) else {
            return Err(PayloadError::Empty);
        };
        if end == u64::from(start) {
            return Err(PayloadError::Empty);
        }
        if end - u64::from(start) > u64::from(LARGEST) || end > 1 << 32 {
            return Err(PayloadError::Scattered(u64::from(start)..end));
        }
        let mut bytes = vec![ERASED; (end - u64::from(start)) as usize];
        for (at, part) in parts {
            let offset = (at - start) as usize;
            bytes[offset..offset + part.len()].copy_from_slice(part);
        }
        Ok(Payload {
            origin: start,
            bytes,
            is_elf,
        })
    }

    /// The address after the last byte.
    pub fn end(&self) -> u64 {
        u64::from(self.origin) + self.bytes.len() as u64
    }

    /// Contents of flash at these addresses with the image; erased flash outside the image.
    fn at(&self, range: Range<u32>) -> Vec<u8> {
        let byte = |address: u32| {
            let offset = address
                .checked_sub(self.origin)
                .map(|offset| offset as usize);
            offset.and_then(|offset| self.bytes.get(offset)).copied()
        };
        range
            .map(|address| byte(address).unwrap_or(ERASED))
            .collect()
    }
}

/// The loaded parts of an ELF file.
fn loaded(file: &[u8]) -> Result<Vec<(u32, &[u8])>, PayloadError> {
    let elf = ElfFile32::<Endianness>::parse(file)?;
    let endian = elf.endian();
    if elf.elf_header().e_machine(endian) != elf::EM_ARM {
        return Err(PayloadError::Machine);
    }
    let mut parts = Vec::new();
    for header in elf.elf_program_headers() {
        if header.p_type(endian) != elf::PT_LOAD || header.p_filesz(endian) == 0 {
            continue;
        }
        let data = header.data(endian, file);
        let data = data.map_err(|()| PayloadError::Empty)?;
        parts.push((header.p_paddr(endian), data));
    }
    Ok(parts)
}

/// Error while an image is written.
#[derive(Debug, thiserror::Error)]
pub enum FlashError {
    /// The boot loader, or the line to it.
    #[error(transparent)]
    Loader(#[from] LoaderError),
    /// The image is not for this flash.
    #[error("the image takes 0x{:08X} to 0x{:08X}, the flash of {chip} is 0x{:08X} to 0x{:08X}", .image.start, .image.end - 1, .flash.start, .flash.end - 1)]
    Misfit {
        /// The addresses of the image.
        image: Range<u64>,
        /// The addresses of the flash.
        flash: Range<u64>,
        /// The part.
        chip: &'static str,
    },
    /// The data read back differ from the data written.
    #[error("flash at 0x{at:08X} holds 0x{found:02X} instead of 0x{wanted:02X} after writing")]
    Differs {
        /// The address.
        at: u32,
        /// Its contents.
        found: u8,
        /// Expected contents.
        wanted: u8,
    },
}

/// Step of a writer, in the order of execution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Reads flash to compare it.
    Compare,
    /// Erases pages.
    Erase,
    /// Writes the image.
    Write,
    /// Reads the image back.
    Verify,
}

/// The pages of a part that an image takes, and which of them have to change.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Numbers and addresses of the pages that the image takes.
    pub pages: Vec<(u32, Range<u32>)>,
    /// The pages that already hold what they should.
    pub unchanged: Vec<u32>,
}

impl Plan {
    /// The pages that are erased and written.
    pub fn changed(&self) -> impl Iterator<Item = &(u32, Range<u32>)> {
        self.pages
            .iter()
            .filter(|(page, _)| !self.unchanged.contains(page))
    }
}

/// Writes images.
pub struct Writer<'a, L: Line> {
    /// The boot loader.
    pub loader: &'a mut Loader<L>,
    /// The part.
    pub chip: &'static Chip,
    /// Size of its flash in bytes.
    pub flash: u32,
    /// Called with what is done and how much of it: bytes, or pages while erasing.
    pub progress: Box<dyn FnMut(Step, usize, usize) + 'a>,
}

impl<L: Line> Writer<'_, L> {
    /// The pages that an image takes.
    ///
    /// # Errors
    /// The image is not within flash.
    pub fn fit(chip: &'static Chip, flash: u32, payload: &Payload) -> Result<Plan, FlashError> {
        let whole = u64::from(chips::FLASH)..u64::from(chips::FLASH) + u64::from(flash);
        let image = u64::from(payload.origin)..payload.end();
        if image.start < whole.start || image.end > whole.end {
            return Err(FlashError::Misfit {
                image,
                flash: whole,
                chip: chip.name,
            });
        }
        let meets = |page: &Range<u32>| {
            u64::from(page.start) < image.end && image.start < u64::from(page.end)
        };
        let pages = (0..).zip(chip.pages(flash)).filter(|(_, page)| meets(page));
        Ok(Plan {
            pages: pages.collect(),
            unchanged: Vec::new(),
        })
    }

    /// Finds the pages that need no change. The first page, with the vectors, changes if any other does: until all the
    /// rest is written it is empty, so that a part whose programming was interrupted does not start.
    ///
    /// # Errors
    /// Those of the boot loader.
    pub fn compare(&mut self, plan: &mut Plan, payload: &Payload) -> Result<(), FlashError> {
        let total = plan.pages.iter().map(|(_, page)| page.len()).sum();
        let mut done = 0;
        for (number, page) in &plan.pages {
            let wanted = payload.at(page.clone());
            let mut equal = true;
            for (at, block) in blocks(page, &wanted) {
                if self.loader.read(at, block.len())? != block {
                    equal = false;
                    break;
                }
            }
            if equal {
                plan.unchanged.push(*number);
            }
            done += page.len();
            (self.progress)(Step::Compare, done, total);
        }
        if plan.unchanged.len() < plan.pages.len()
            && let Some((first, _)) = plan.pages.first()
        {
            plan.unchanged.retain(|page| page != first);
        }
        Ok(())
    }

    /// Erases the pages that change, writes them and reads all of the image back. The first block, with the vectors, is
    /// written when all the rest is there.
    ///
    /// # Errors
    /// Those of the boot loader, and flash that does not hold what was written.
    pub fn write(&mut self, plan: &Plan, payload: &Payload) -> Result<(), FlashError> {
        let changed: Vec<_> = plan.changed().cloned().collect();
        for (done, (number, _)) in changed.iter().enumerate() {
            self.loader.erase(*number)?;
            (self.progress)(Step::Erase, done + 1, changed.len());
        }
        let total = changed.iter().map(|(_, page)| page.len()).sum();
        let mut done = 0;
        let mut first = None;
        for (_, page) in &changed {
            let wanted = payload.at(page.clone());
            for (at, block) in blocks(page, &wanted) {
                if first.is_none() {
                    first = Some((at, block.to_vec()));
                } else if block.iter().any(|byte| *byte != ERASED) {
                    self.loader.write(at, block)?;
                }
                done += block.len();
                (self.progress)(Step::Write, done, total);
            }
        }
        let Some((at, block)) = first else {
            return Ok(());
        };
        let whole = payload.origin..payload.end() as u32;
        let rest = (at + BLOCK as u32).min(whole.end)..whole.end;
        self.verify(rest, payload)?;
        self.loader.write(at, &block)?;
        self.verify(whole.start..whole.end.min(at + BLOCK as u32), payload)
    }

    /// Compares flash at these addresses with the image.
    fn verify(&mut self, range: Range<u32>, payload: &Payload) -> Result<(), FlashError> {
        for (at, block) in blocks(&range, &payload.at(range.clone())) {
            let found = self.loader.read(at, block.len())?;
            let mut pairs = (at..).zip(found.iter().zip(block));
            if let Some((at, (found, wanted))) = pairs.find(|(_, (found, wanted))| found != wanted)
            {
                return Err(FlashError::Differs {
                    at,
                    found: *found,
                    wanted: *wanted,
                });
            }
            let done = (at - range.start) as usize + block.len();
            (self.progress)(Step::Verify, done, range.len());
        }
        Ok(())
    }
}

/// Bytes in blocks that a command takes, with their addresses.
fn blocks<'b>(range: &Range<u32>, bytes: &'b [u8]) -> impl Iterator<Item = (u32, &'b [u8])> {
    let addresses = range.clone().step_by(BLOCK);
    addresses.zip(bytes.chunks(BLOCK))
}
