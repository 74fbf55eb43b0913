//! A microcontroller in its boot loader, as AN3155 describes it, at the other end of a line.
#![allow(dead_code, reason = "not every test needs all of it")]

use std::sync::{Arc, Mutex, MutexGuard};

const ACK: u8 = 0x79;
const NACK: u8 = 0x1F;
const FLASH: usize = 0x0800_0000;

/// Disturbance of the line or the part.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fault {
    /// The write of this number, from 0 on, is rejected.
    RejectWrite(usize),
    /// A byte of the data of this write is lost.
    LoseByte(usize),
    /// A byte of this write, and of every later one, is lost.
    LoseBytes(usize),
    /// The write is done, but its answer is lost.
    LoseAnswer(usize),
    /// The write, and every later one, is rejected.
    RejectWrites(usize),
    /// A bit of what this write leaves in flash is wrong.
    BadBit(usize),
    /// The erasing of this number is rejected.
    RejectErase(usize),
    /// The line is cut at this write.
    Cut(usize),
    /// There is no boot loader.
    Silent,
}

/// The part.
#[derive(Clone, Debug)]
pub struct Part {
    pub id: u16,
    pub page: usize,
    pub flash: Vec<u8>,
    /// It knows Extended Erase instead of Erase.
    pub is_extended: bool,
    pub is_read_protected: bool,
    pub is_write_protected: bool,
    /// Address of its flash size register.
    pub size_at: usize,
    pub faults: Vec<Fault>,
    /// Addresses of pages that were erased and of blocks that were written, in order.
    pub log: Vec<(&'static str, usize)>,
    pub is_synchronised: bool,
    pub writes: usize,
    pub erasures: usize,
}

impl Part {
    /// An STM32F103VC with the firmware of a vendor.
    pub fn f103vc() -> Self {
        Part {
            id: 0x414,
            page: 2048,
            flash: (0..256 * 1024).map(|at| (at % 251) as u8).collect(),
            is_extended: false,
            is_read_protected: false,
            is_write_protected: false,
            size_at: 0x1FFF_F7E0,
            faults: Vec::new(),
            log: Vec::new(),
            is_synchronised: false,
            writes: 0,
            erasures: 0,
        }
    }

    /// An STM32F030C8.
    pub fn f030c8() -> Self {
        let mut part = Part::f103vc();
        part.flash.truncate(64 * 1024);
        Part {
            id: 0x440,
            page: 1024,
            is_extended: true,
            size_at: 0x1FFF_F7CC,
            ..part
        }
    }

    /// Contents at an address, if there are any.
    fn memory(&self, at: usize, count: usize) -> Option<Vec<u8>> {
        let kib = (self.flash.len() / 1024) as u16;
        if at == self.size_at {
            let mut bytes = kib.to_le_bytes().to_vec();
            bytes.resize(count, 0xFF);
            return Some(bytes);
        }
        let offset = at.checked_sub(FLASH)?;
        self.flash.get(offset..offset + count).map(<[u8]>::to_vec)
    }

    fn erase(&mut self, page: usize) -> bool {
        let number = self.erasures;
        self.erasures += 1;
        let rejected = self.faults.contains(&Fault::RejectErase(number));
        let range = page * self.page..(page + 1) * self.page;
        if rejected || self.is_write_protected || range.end > self.flash.len() {
            return false;
        }
        self.log.push(("erase", FLASH + range.start));
        self.flash[range].fill(0xFF);
        true
    }

    /// Flash takes what is programmed only where it is erased.
    fn program(&mut self, at: usize, bytes: &[u8]) -> bool {
        let Some(offset) = at.checked_sub(FLASH) else {
            return false;
        };
        let Some(place) = self.flash.get_mut(offset..offset + bytes.len()) else {
            return false;
        };
        if self.is_write_protected || place.iter().any(|byte| *byte != 0xFF) {
            return false;
        }
        place.copy_from_slice(bytes);
        self.log.push(("write", at));
        true
    }
}

/// The line is cut, or the test is over.
pub struct Over;

/// The part's end of a line.
pub trait Wire {
    /// The next byte, once it is there.
    fn byte(&mut self) -> Result<u8, Over>;

    /// Sends bytes.
    fn answer(&mut self, bytes: &[u8]) -> Result<(), Over>;
}

/// The boot loader of a part.
pub struct BootLoader<W> {
    pub wire: W,
    pub part: Arc<Mutex<Part>>,
}

impl<W: Wire> BootLoader<W> {
    /// Answers commands until the line is cut or the test is over.
    pub fn run(mut self) {
        while self.command().is_ok() {}
    }

    fn part(&self) -> MutexGuard<'_, Part> {
        self.part.lock().unwrap()
    }

    fn byte(&mut self) -> Result<u8, Over> {
        self.wire.byte()
    }

    fn bytes(&mut self, count: usize) -> Result<Vec<u8>, Over> {
        (0..count).map(|_| self.byte()).collect()
    }

    fn answer(&mut self, bytes: &[u8]) -> Result<(), Over> {
        self.wire.answer(bytes)
    }

    fn acknowledge(&mut self, is_good: bool) -> Result<bool, Over> {
        self.answer(&[if is_good { ACK } else { NACK }])?;
        Ok(is_good)
    }

    /// Takes a command: its code and the complement.
    fn command(&mut self) -> Result<(), Over> {
        let code = self.byte()?;
        if self.part().faults.contains(&Fault::Silent) {
            return Ok(());
        }
        if !self.part().is_synchronised {
            self.part().is_synchronised = code == 0x7F;
            return match code {
                0x7F => self.answer(&[ACK]),
                _ => Ok(()),
            };
        }
        if self.byte()? != !code {
            return self.answer(&[NACK]);
        }
        let erase = if self.part().is_extended { 0x44 } else { 0x43 };
        let commands = [
            0x00, 0x01, 0x02, 0x11, 0x21, 0x31, erase, 0x63, 0x73, 0x82, 0x92,
        ];
        let always = [0x00, 0x01, 0x02, 0x92];
        let is_protected = self.part().is_read_protected;
        let is_known = commands.contains(&code) && (always.contains(&code) || !is_protected);
        if !self.acknowledge(is_known)? {
            return Ok(());
        }
        match code {
            0x00 => {
                self.answer(&[commands.len() as u8, 0x22])?;
                self.answer(&commands)?;
                self.answer(&[ACK])
            }
            0x01 => self.answer(&[0x22, 0, 0, ACK]),
            0x02 => {
                let [high, low] = self.part().id.to_be_bytes();
                self.answer(&[1, high, low, ACK])
            }
            0x11 => self.read(),
            0x21 => self.go(),
            0x31 => self.write(),
            0x43 => self.erase(),
            0x44 => self.erase_extended(),
            0x73 => {
                self.part().is_write_protected = false;
                self.reset()
            }
            0x92 => {
                let mut part = self.part();
                part.flash.fill(0xFF);
                part.is_read_protected = false;
                part.log.push(("erase all", FLASH));
                drop(part);
                self.reset()
            }
            _ => Ok(()),
        }
    }

    fn reset(&mut self) -> Result<(), Over> {
        self.answer(&[ACK])?;
        self.part().is_synchronised = false;
        Ok(())
    }

    fn address(&mut self) -> Result<Option<usize>, Over> {
        let bytes = self.bytes(5)?;
        let is_good = bytes.iter().fold(0, |sum, byte| sum ^ byte) == 0;
        let at = u32::from_be_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        Ok(self.acknowledge(is_good)?.then_some(at as usize))
    }

    fn read(&mut self) -> Result<(), Over> {
        let Some(at) = self.address()? else {
            return Ok(());
        };
        let count = self.bytes(2)?;
        let found = self.part().memory(at, usize::from(count[0]) + 1);
        let is_good = count[0] == !count[1] && found.is_some();
        match (self.acknowledge(is_good)?, found) {
            (true, Some(bytes)) => self.answer(&bytes),
            _ => Ok(()),
        }
    }

    fn go(&mut self) -> Result<(), Over> {
        if let Some(at) = self.address()? {
            self.part().log.push(("start", at));
        }
        Ok(())
    }

    fn write(&mut self) -> Result<(), Over> {
        let Some(at) = self.address()? else {
            return Ok(());
        };
        let number = self.part().writes;
        self.part().writes += 1;
        let faults = self.part().faults.clone();
        let has = |fault: Fault| faults.contains(&fault);
        if has(Fault::Cut(number)) {
            return Err(Over);
        }
        let last = self.byte()?;
        let count = usize::from(last) + 1;
        let loses = |fault: &Fault| matches!(*fault, Fault::LoseBytes(n) if n <= number);
        if has(Fault::LoseByte(number)) || faults.iter().any(loses) {
            self.byte()?;
        }
        let mut bytes = self.bytes(count)?;
        let sum = self.byte()?;
        let is_whole = bytes.iter().fold(last, |sum, byte| sum ^ byte) == sum;
        let rejected = faults.iter().any(|fault| match *fault {
            Fault::RejectWrite(n) => n == number,
            Fault::RejectWrites(n) => n <= number,
            _ => false,
        });
        if has(Fault::BadBit(number)) {
            bytes[7] ^= 0x10;
        }
        let is_done = is_whole && !rejected && self.part().program(at, &bytes);
        if has(Fault::LoseAnswer(number)) {
            return Ok(());
        }
        self.acknowledge(is_done).map(|_| ())
    }

    fn erase(&mut self) -> Result<(), Over> {
        let last = self.byte()?;
        if last == 0xFF {
            let is_all = self.byte()? == 0;
            return self.erase_all(is_all);
        }
        let pages = self.bytes(usize::from(last) + 1)?;
        let sum = self.byte()?;
        let is_whole = pages.iter().fold(last, |sum, byte| sum ^ byte) == sum;
        self.erase_pages(is_whole.then(|| pages.into_iter().map(usize::from).collect()))
    }

    fn erase_extended(&mut self) -> Result<(), Over> {
        let count = self.bytes(2)?;
        let last = usize::from(u16::from_be_bytes([count[0], count[1]]));
        if last == 0xFFFF {
            let is_all = self.byte()? == 0;
            return self.erase_all(is_all);
        }
        let list = self.bytes(2 * (last + 1))?;
        let sum = self.byte()?;
        let all = count.iter().chain(&list);
        let is_whole = all.fold(0, |sum, byte| sum ^ byte) == sum;
        let pages = list
            .chunks(2)
            .map(|pair| usize::from(u16::from_be_bytes([pair[0], pair[1]])));
        self.erase_pages(is_whole.then(|| pages.collect()))
    }

    fn erase_all(&mut self, is_whole: bool) -> Result<(), Over> {
        let pages = self.part().flash.len() / self.part().page;
        self.erase_pages(is_whole.then(|| (0..pages).collect()))
    }

    /// Erases pages; without any, the list was damaged.
    fn erase_pages(&mut self, pages: Option<Vec<usize>>) -> Result<(), Over> {
        let is_done = match pages {
            Some(pages) => {
                let mut part = self.part();
                pages.into_iter().all(|page| part.erase(page))
            }
            None => false,
        };
        self.acknowledge(is_done).map(|_| ())
    }
}
