/// Memory that holds latched devices: flash of an RP2040. Functions of its boot ROM erase and write it, and it cannot
/// be read meanwhile. So what runs then is in RAM, and no interrupt comes.
struct Rp2040 {
    slots: [Range<u32>; 2],
}

/// Address at which flash is read.
const FLASH_BASE: u32 = 0x1000_0000;

/// Bytes that are erased at once.
const SECTOR: usize = 4096;

/// Bytes that are written at once.
const PAGE: usize = 256;

/// Functions of the boot ROM.
struct Rom {
    connect: extern "C" fn(),
    leave: extern "C" fn(),
    erase: extern "C" fn(u32, usize, u32, u8),
    write: extern "C" fn(u32, *const u8, usize),
    flush: extern "C" fn(),
    /// The second stage of the boot ROM, in RAM: it lets flash be read again.
    enter: extern "C" fn(),
}

/// A half word of the boot ROM.
fn rom_half(address: usize) -> usize {
    (read(address & !3) >> (8 * (address & 2)) & 0xFFFF) as usize
}

/// A function of the boot ROM, by its two letters.
fn rom_function(name: &[u8; 2]) -> usize {
    // SAFETY: the boot ROM has at 18h the address of the function that looks in the table at 14h (RP2040 data sheet
    // §2.8.3).
    let find: extern "C" fn(usize, u32) -> usize = unsafe { core::mem::transmute(rom_half(0x18)) };
    find(rom_half(0x14), u16::from_le_bytes(*name).into())
}

/// Erases a sector, or writes a page.
#[inline(never)]
#[unsafe(link_section = ".ram_text")]
fn change_flash(rom: &Rom, offset: u32, page: Option<&[u8; PAGE]>) {
    (rom.connect)();
    (rom.leave)();
    match page {
        None => (rom.erase)(offset, SECTOR, 1 << 16, 0xD8),
        Some(page) => (rom.write)(offset, page.as_ptr(), PAGE),
    }
    (rom.flush)();
    (rom.enter)();
}

fn rom_changes(address: u32, page: Option<&[u8; PAGE]>) {
    let mut second_stage = [0u32; 64];
    for (at, word) in (FLASH_BASE as usize..).step_by(4).zip(&mut second_stage) {
        *word = read(at);
    }
    let entry = &raw const second_stage as usize | 1;
    // SAFETY: these are functions of the boot ROM (RP2040 data sheet §2.8.3.1.3), and a copy of what it has started
    // itself.
    let rom = unsafe {
        Rom {
            connect: core::mem::transmute(rom_function(b"IF")),
            leave: core::mem::transmute(rom_function(b"EX")),
            erase: core::mem::transmute(rom_function(b"RE")),
            write: core::mem::transmute(rom_function(b"RP")),
            flush: core::mem::transmute(rom_function(b"FC")),
            enter: core::mem::transmute(entry),
        }
    };
    let masked: u32;
    // SAFETY: the mask is as it was before when the work is done.
    unsafe { asm!("mrs {}, primask", "cpsid i", out(reg) masked) };
    change_flash(&rom, address - FLASH_BASE, page);
    // SAFETY: the same.
    unsafe { asm!("msr primask, {}", in(reg) masked) };
}

impl Rp2040 {
    fn slot(&self, slot: usize) -> Result<Range<u32>, FlashFailed> {
        self.slots.get(slot).cloned().ok_or(FlashFailed)
    }
}

impl Flash for Rp2040 {
    fn slot_len(&self) -> u32 {
        let [slot, _] = &self.slots;
        slot.end - slot.start
    }

    fn read(&mut self, slot: usize, offset: u32, bytes: &mut [u8]) -> Result<(), FlashFailed> {
        let from = self.slot(slot)?.start + offset;
        for (at, byte) in (from..).zip(bytes) {
            *byte = (read(at as usize & !3) >> (8 * (at & 3))) as u8;
        }
        Ok(())
    }

    fn erase(&mut self, slot: usize) -> Result<(), FlashFailed> {
        let slot = self.slot(slot)?;
        slot.clone().step_by(SECTOR).for_each(|at| rom_changes(at, None));
        match slot.step_by(4).all(|at| read(at as usize) == u32::MAX) {
            true => Ok(()),
            false => Err(FlashFailed),
        }
    }

    /// Writes bytes; the rest of a page is written as erased, which leaves its contents unchanged.
    fn program(&mut self, slot: usize, offset: u32, mut bytes: &[u8]) -> Result<(), FlashFailed> {
        let mut at = self.slot(slot)?.start + offset;
        while !bytes.is_empty() {
            let begin = at as usize % PAGE;
            let (now, rest) = bytes.split_at(bytes.len().min(PAGE - begin));
            let mut page = [0xFF; PAGE];
            for (to, from) in page.iter_mut().skip(begin).zip(now) {
                *to = *from;
            }
            rom_changes(at - begin as u32, Some(&page));
            for (at, byte) in (at..).zip(now) {
                if (read(at as usize & !3) >> (8 * (at & 3))) as u8 != *byte {
                    return Err(FlashFailed);
                }
            }
            at += now.len() as u32;
            bytes = rest;
        }
        Ok(())
    }
}

