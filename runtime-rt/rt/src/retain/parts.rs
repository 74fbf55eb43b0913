//! RAM that keeps its contents, and flash of STM32F1 and STM32F4 parts (ST PM0075 and RM0090, "Embedded Flash memory
//! interface").

use super::slots::{Flash, FlashFailed};
use core::ops::Range;

/// Access to the addresses of a microcontroller.
pub trait Registers {
    /// Reads a word; `address` is a multiple of 4.
    fn read(&mut self, address: u32) -> u32;
    /// Writes a word.
    fn write(&mut self, address: u32, value: u32);
    /// Writes half a word; `address` is a multiple of 2.
    fn write_half(&mut self, address: u32, value: u16);
}

/// Keys that unlock the control register, one after the other.
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

/// Polls of the busy bit before an operation counts as failed: far longer than the slowest erasure.
const PATIENCE: u32 = 1 << 28;

/// The flash controller of a family: addresses and bits.
struct Controller {
    keys: u32,
    status: u32,
    control: u32,
    busy: u32,
    /// Bits of the status that say that something failed; writing 1 clears them.
    errors: u32,
    lock: u32,
}

impl Controller {
    fn wait<R: Registers>(&self, registers: &mut R) -> Result<(), FlashFailed> {
        for _ in 0..PATIENCE {
            let status = registers.read(self.status);
            if status & self.busy == 0 {
                return match status & self.errors {
                    0 => Ok(()),
                    _ => Err(FlashFailed),
                };
            }
        }
        Err(FlashFailed)
    }

    /// Does `work` with the control register unlocked, and locks it again.
    fn unlocked<R: Registers>(
        &self,
        registers: &mut R,
        work: impl FnOnce(&mut R) -> Result<(), FlashFailed>,
    ) -> Result<(), FlashFailed> {
        registers.write(self.status, self.errors);
        if registers.read(self.control) & self.lock != 0 {
            for key in KEYS {
                registers.write(self.keys, key);
            }
        }
        let done = self.wait(registers).and_then(|()| work(registers));
        registers.write(self.control, self.lock);
        done
    }
}

/// Memory at addresses of a microcontroller. All kinds are read alike; erasing and writing is each one's own.
trait Mapped {
    type Bus: Registers;
    fn registers(&mut self) -> &mut Self::Bus;
    fn slots(&self) -> &[Range<u32>; 2];
    /// Makes all bytes of a slot 0xFF.
    fn erase_range(&mut self, slot: Range<u32>) -> Result<(), FlashFailed>;
    /// Writes erased bytes from an address on.
    fn program_at(&mut self, from: u32, bytes: &[u8]) -> Result<(), FlashFailed>;

    /// The addresses of a slot.
    fn slot(&self, slot: usize) -> Result<Range<u32>, FlashFailed> {
        self.slots().get(slot).cloned().ok_or(FlashFailed)
    }
}

impl<M: Mapped> Flash for M {
    /// Bytes of the shorter slot.
    fn slot_len(&self) -> u32 {
        let [a, b] = self.slots();
        (a.end - a.start).min(b.end - b.start)
    }

    fn read(&mut self, slot: usize, offset: u32, bytes: &mut [u8]) -> Result<(), FlashFailed> {
        let from = self.slot(slot)?.start + offset;
        for (at, byte) in (from..).zip(bytes) {
            let word = self.registers().read(at & !3).to_le_bytes();
            *byte = word.get(at as usize & 3).copied().unwrap_or_default();
        }
        Ok(())
    }

    fn erase(&mut self, slot: usize) -> Result<(), FlashFailed> {
        let range = self.slot(slot)?;
        self.erase_range(range)
    }

    fn program(&mut self, slot: usize, offset: u32, bytes: &[u8]) -> Result<(), FlashFailed> {
        let from = self.slot(slot)?.start + offset;
        self.program_at(from, bytes)
    }
}

/// Two slots in memory that is written like RAM and keeps its contents: with a battery, or FRAM.
#[derive(Clone, Debug)]
pub struct Ram<R> {
    /// Access to memory.
    pub registers: R,
    /// Addresses of the slots, multiples of 4.
    pub slots: [Range<u32>; 2],
}

impl<R: Registers> Mapped for Ram<R> {
    type Bus = R;

    fn registers(&mut self) -> &mut R {
        &mut self.registers
    }

    fn slots(&self) -> &[Range<u32>; 2] {
        &self.slots
    }

    fn erase_range(&mut self, slot: Range<u32>) -> Result<(), FlashFailed> {
        for at in slot.step_by(4) {
            self.registers.write(at, u32::MAX);
        }
        Ok(())
    }

    fn program_at(&mut self, from: u32, bytes: &[u8]) -> Result<(), FlashFailed> {
        for (at, word) in (from..).step_by(4).zip(bytes.as_chunks().0) {
            self.registers.write(at, u32::from_le_bytes(*word));
        }
        Ok(())
    }
}

/// Two slots in the flash of an STM32F4, each of one or more whole sectors. The code that runs meanwhile stands still
/// if it is in the same bank: some 16 µs for each word, and for the erasure of a sector of 16 KB a quarter of a second,
/// of 128 KB one to two seconds.
#[derive(Clone, Debug)]
pub struct Stm32f4<R> {
    /// Access to registers.
    pub registers: R,
    /// Addresses of the slots.
    pub slots: [Range<u32>; 2],
}

const F4: Controller = Controller {
    keys: 0x4002_3C04,
    status: 0x4002_3C0C,
    control: 0x4002_3C10,
    busy: 1 << 16,
    errors: 0xF2, // PGSERR, PGPERR, PGAERR, WRPERR, OPERR
    lock: 1 << 31,
};

/// Access control: what keeps erased data in a cache.
const F4_ACCESS: u32 = 0x4002_3C00;
const F4_DATA_CACHE: u32 = 1 << 10;
const F4_RESET_CACHE: u32 = 1 << 12;

/// Words are written as a whole (a supply of 2.7 V or more).
const F4_BY_WORDS: u32 = 2 << 8;

/// First address of a bank's sectors, and of the one after the last: four of 16 KB, one of 64 KB, seven of 128 KB.
const F4_SECTORS: [u32; 13] = [
    0, 0x4000, 0x8000, 0xC000, 0x1_0000, 0x2_0000, 0x4_0000, 0x6_0000, 0x8_0000, 0xA_0000,
    0xC_0000, 0xE_0000, 0x10_0000,
];

/// The sectors of an address range of an STM32F4, as its control register numbers them; `None` if the range does not
/// consist of whole sectors of one bank.
pub fn f4_sectors(range: &Range<u32>) -> Option<Range<u32>> {
    let bank = range.start.checked_sub(0x0800_0000)? / 0x10_0000;
    let origin = 0x0800_0000 + bank * 0x10_0000;
    let border = |address: u32| {
        let offset = address.checked_sub(origin)?;
        let border = F4_SECTORS.iter().position(|&border| border == offset)?;
        Some(border as u32 + 16 * bank)
    };
    let sectors = border(range.start)?..border(range.end)?;
    (bank < 2 && !sectors.is_empty()).then_some(sectors)
}

impl<R: Registers> Mapped for Stm32f4<R> {
    type Bus = R;

    fn registers(&mut self) -> &mut R {
        &mut self.registers
    }

    fn slots(&self) -> &[Range<u32>; 2] {
        &self.slots
    }

    fn erase_range(&mut self, slot: Range<u32>) -> Result<(), FlashFailed> {
        let sectors = f4_sectors(&slot).ok_or(FlashFailed)?;
        F4.unlocked(&mut self.registers, |registers| {
            for sector in sectors {
                let erase = F4_BY_WORDS | 1 << 1 | sector << 3; // SER, SNB
                registers.write(F4.control, erase);
                registers.write(F4.control, erase | 1 << 16); // STRT
                F4.wait(registers)?;
            }
            Ok(())
        })?;
        let access = self.registers.read(F4_ACCESS);
        if access & F4_DATA_CACHE != 0 {
            let off = access & !F4_DATA_CACHE;
            for value in [off, off | F4_RESET_CACHE, off, access] {
                self.registers.write(F4_ACCESS, value);
            }
        }
        Ok(())
    }

    fn program_at(&mut self, from: u32, bytes: &[u8]) -> Result<(), FlashFailed> {
        F4.unlocked(&mut self.registers, |registers| {
            registers.write(F4.control, F4_BY_WORDS | 1); // PG
            for (at, word) in (from..).step_by(4).zip(bytes.as_chunks().0) {
                registers.write(at, u32::from_le_bytes(*word));
                F4.wait(registers)?;
            }
            Ok(())
        })
    }
}

/// Two slots in the flash of an STM32F1, each of one or more whole pages. The code that runs meanwhile stands still:
/// some 50 µs for each half word, and 20 to 40 ms for the erasure of a page.
#[derive(Clone, Debug)]
pub struct Stm32f1<R> {
    /// Access to registers.
    pub registers: R,
    /// Addresses of the slots.
    pub slots: [Range<u32>; 2],
    /// Bytes of a page: 1024, or 2048 on parts with 256 KB of flash and more.
    pub page: u32,
}

const F1: Controller = Controller {
    keys: 0x4002_2004,
    status: 0x4002_200C,
    control: 0x4002_2010,
    busy: 1,
    errors: 0x14, // PGERR, WRPRTERR
    lock: 1 << 7,
};

/// The address of the page to erase.
const F1_ADDRESS: u32 = 0x4002_2014;

impl<R: Registers> Mapped for Stm32f1<R> {
    type Bus = R;

    fn registers(&mut self) -> &mut R {
        &mut self.registers
    }

    fn slots(&self) -> &[Range<u32>; 2] {
        &self.slots
    }

    fn erase_range(&mut self, slot: Range<u32>) -> Result<(), FlashFailed> {
        let step = self.page.max(1) as usize;
        F1.unlocked(&mut self.registers, |registers| {
            for page in slot.step_by(step) {
                registers.write(F1.control, 1 << 1); // PER
                registers.write(F1_ADDRESS, page);
                registers.write(F1.control, 1 << 1 | 1 << 6); // STRT
                F1.wait(registers)?;
            }
            Ok(())
        })
    }

    fn program_at(&mut self, from: u32, bytes: &[u8]) -> Result<(), FlashFailed> {
        F1.unlocked(&mut self.registers, |registers| {
            registers.write(F1.control, 1); // PG
            for (at, half) in (from..).step_by(2).zip(bytes.as_chunks().0) {
                registers.write_half(at, u16::from_le_bytes(*half));
                F1.wait(registers)?;
            }
            Ok(())
        })
    }
}
