//! Results of saves interrupted by a power failure at any byte, and the flash controllers of parts as models of their
//! registers.

use super::*;
use crate::double::Double;
use crate::{Hal, Plc, Program};
use std::ops::Range;
use std::vec;
use std::vec::Vec;

const RUNS: [RetainedRun; 5] = [
    RetainedRun::new(Class::M, 500, 21),
    RetainedRun::new(Class::T, 250, 2),
    RetainedRun::new(Class::C, 100, 1),
    RetainedRun::new(Class::C, 220, 1),
    RetainedRun::new(Class::D, 200, 3),
];

/// A program that keeps some devices.
struct Retaining {
    plc: Double,
    retained: Retained<'static>,
    /// Reset states of C100 and C220.
    resets: [bool; 2],
}

impl Retaining {
    fn new() -> Self {
        let retained = Retained {
            program: "motor (h2u)",
            runs: &RUNS,
            ..Retained::NOTHING
        };
        Retaining {
            plc: Double::new(),
            retained,
            resets: [false; 2],
        }
    }

    /// All latched devices differ from one state to the next.
    fn with_state(state: i16) -> Self {
        let mut kept = Retaining::new();
        for n in 0..21 {
            let on = (i32::from(state) + n) % 2 == 1;
            kept.set_bit(Class::M, 500 + n as u32, on).unwrap();
        }
        for (class, first, count) in [(Class::T, 250, 2), (Class::C, 100, 1), (Class::D, 200, 3)] {
            for number in first..first + count {
                kept.set_word(class, number, state).unwrap();
            }
        }
        kept.set_bit(Class::T, 251, state % 2 == 0).unwrap();
        kept.set_counter32(220, i32::from(state) * 100_000).unwrap();
        kept.resets = [state % 2 == 0, state % 2 != 0];
        kept
    }

    fn state(&self) -> u32 {
        record::state(self)
    }

    fn reset_of(&self, class: Class, number: u32) -> Option<usize> {
        let counters = [(Class::C, 100), (Class::C, 220)];
        counters.iter().position(|&it| it == (class, number))
    }
}

impl Plc for Retaining {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        self.plc.bit(class, number)
    }
    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        self.plc.set_bit(class, number, value)
    }
    fn word(&self, class: Class, number: u32) -> Option<i16> {
        self.plc.word(class, number)
    }
    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        self.plc.set_word(class, number, value)
    }
    fn counter32(&self, number: u32) -> Option<i32> {
        self.plc.counter32(number)
    }
    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        self.plc.set_counter32(number, value)
    }
    fn state(&mut self, slot: u16) -> &mut crate::State {
        self.plc.state(slot)
    }
    fn sys(&self) -> &crate::Sys {
        &self.plc.sys
    }
    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        self.plc.reset(class, number)
    }
}

impl Program for Retaining {
    fn scan(&mut self, _: &mut dyn Hal, _: u32, _: u32) {}
    fn set_running(&mut self, _: bool) {}
    fn power_cycle(&mut self) {}
    fn output(&self, _: u32) -> bool {
        false
    }
    fn retained(&self) -> Retained<'_> {
        self.retained
    }
    fn is_reset(&self, class: Class, number: u32) -> bool {
        self.reset_of(class, number).is_some_and(|i| self.resets[i])
    }
    fn set_reset(&mut self, class: Class, number: u32, reset: bool) {
        if let Some(i) = self.reset_of(class, number) {
            self.resets[i] = reset;
        }
    }
}

/// Flash that loses its supply after some bytes. The byte in work then keeps some of its bits.
#[derive(Clone)]
struct Cells {
    slots: [Vec<u8>; 2],
    left: usize,
    torn: u8,
    erasures: u32,
    word: u32,
}

impl Cells {
    fn new(length: usize) -> Self {
        Cells {
            slots: [vec![0xA5; length], vec![0x00; length]],
            left: usize::MAX,
            torn: 0,
            erasures: 0,
            word: 8,
        }
    }

    /// Changes a byte to `value`; if power fails, bits of `torn` stay as they are.
    fn change(&mut self, slot: usize, at: usize, value: u8) -> Result<(), FlashFailed> {
        let cell = &mut self.slots[slot][at];
        if self.left == 0 {
            *cell = *cell & self.torn | value & !self.torn;
            self.torn = 0xFF;
            return Err(FlashFailed);
        }
        *cell = value;
        self.left -= 1;
        Ok(())
    }
}

impl Flash for Cells {
    fn slot_len(&self) -> u32 {
        self.slots[0].len() as u32
    }
    fn word_len(&self) -> u32 {
        self.word
    }
    fn read(&mut self, slot: usize, offset: u32, bytes: &mut [u8]) -> Result<(), FlashFailed> {
        let from = offset as usize;
        bytes.copy_from_slice(&self.slots[slot][from..from + bytes.len()]);
        Ok(())
    }
    fn erase(&mut self, slot: usize) -> Result<(), FlashFailed> {
        self.erasures += 1;
        (0..self.slots[slot].len()).try_for_each(|at| self.change(slot, at, 0xFF))
    }
    fn program(&mut self, slot: usize, offset: u32, bytes: &[u8]) -> Result<(), FlashFailed> {
        for unit in [8, self.word] {
            assert!(offset.is_multiple_of(unit) && (bytes.len() as u32).is_multiple_of(unit));
        }
        for (at, &byte) in (offset as usize..).zip(bytes) {
            assert_eq!(self.slots[slot][at], 0xFF, "only erased bytes are written");
            self.change(slot, at, byte)?;
        }
        Ok(())
    }
}

/// Result of loading after power-on from a store.
fn loaded(flash: Cells) -> (Loaded, Retaining) {
    let mut kept = Retaining::new();
    let loaded = Slots::open(flash).unwrap().load(&mut kept).unwrap();
    (loaded, kept)
}

#[test]
fn a_save_that_is_cut_short_leaves_the_old_values_or_the_new_ones() {
    let mut store = Slots::open(Cells::new(256)).unwrap();
    assert_eq!(store.load(&mut Retaining::new()), Ok(Loaded::Nothing));
    let mut old = None;
    let mut cuts = 0;
    for number in 1..=12 {
        let new = Retaining::with_state(number);
        for left in 0.. {
            let mut finished = false;
            for torn in [0x00, 0x0F, 0x55, 0xFF] {
                let mut flash = store.flash.clone();
                flash.left = left;
                flash.torn = torn;
                let mut failing = store.clone();
                failing.flash = flash;
                let saved = failing.save(&new);
                finished = saved.is_ok();
                cuts += u32::from(!finished);
                let mut flash = failing.flash;
                flash.left = usize::MAX;
                let (what, found) = loaded(flash.clone());
                match (what, old) {
                    (Loaded::Nothing, None) => assert!(saved.is_err()),
                    (Loaded::Restored { dropped: 0 }, _) => {
                        let state = found.state();
                        assert!(state == new.state() || saved.is_err() && Some(state) == old);
                    }
                    other => panic!("{other:?} at byte {left} of save {number}"),
                }
                // The next save finds room after what is left.
                let mut next = Slots::open(flash).unwrap();
                next.save(&Retaining::with_state(77)).unwrap();
                let found = loaded(next.flash).1;
                assert_eq!(found.state(), Retaining::with_state(77).state());
            }
            if finished {
                break;
            }
        }
        store.save(&new).unwrap();
        old = Some(new.state());
    }
    assert!(cuts > 12 * 64 * 4, "{cuts} cuts were tried");
}

#[test]
fn flash_is_written_in_whole_words() {
    for word in [2, 4, 8, 16, 32] {
        let mut flash = Cells::new(256);
        flash.word = word;
        let mut store = Slots::open(flash).unwrap();
        for state in 1..=9 {
            let new = Retaining::with_state(state);
            store.save(&new).unwrap();
            let (what, found) = loaded(store.flash.clone());
            assert_eq!(
                what,
                Loaded::Restored { dropped: 0 },
                "words of {word} bytes"
            );
            assert_eq!(found.state(), new.state());
            store = Slots::open(store.flash).unwrap();
        }
        let fits = store.saves_per_erasure(&Retaining::new().retained);
        assert!(store.flash.erasures >= 9 / fits, "{fits} records in a slot");
    }
    let mut flash = Cells::new(256);
    flash.word = 64;
    let saved = Slots::open(flash).and_then(|mut store| store.save(&Retaining::new()));
    assert_eq!(saved, Err(FlashFailed));
}

#[test]
fn every_latched_device_comes_back() {
    let mut store = Slots::open(Cells::new(256)).unwrap();
    store.save(&Retaining::with_state(-3)).unwrap();
    let (what, found) = loaded(store.flash);
    assert_eq!(what, Loaded::Restored { dropped: 0 });
    assert_eq!(found.word(Class::D, 202), Some(-3));
    assert_eq!(found.word(Class::T, 250), Some(-3));
    assert_eq!(found.counter32(220), Some(-300_000));
    assert_eq!(found.bit(Class::M, 520), Some(true));
    assert_eq!(found.bit(Class::M, 519), Some(false));
    assert_eq!(found.bit(Class::T, 251), Some(false));
    assert_eq!(found.resets, [false, true]);
}

#[test]
fn a_slot_takes_records_until_it_is_full() {
    let mut store = Slots::open(Cells::new(256)).unwrap();
    let retained = Retaining::new().retained;
    assert_eq!(
        retained.record_len(),
        15 + 11 + 5 * 5 + 3 + 6 + 3 + 5 + 6 + 4
    );
    assert_eq!(store.saves_per_erasure(&retained), 3);
    for number in 0..30 {
        store.save(&Retaining::with_state(number)).unwrap();
    }
    assert_eq!(store.flash.erasures, 10);
    let none = Slots::open(Cells::new(64)).unwrap().save(&Retaining::new());
    assert_eq!(none, Err(FlashFailed), "the slot is shorter than a record");
}

#[test]
fn a_prepared_save_does_not_erase() {
    let mut store = Slots::open(Cells::new(256)).unwrap();
    let mut at_ms = 0;
    for number in 0..30 {
        at_ms += 1000;
        let kept = Retaining::with_state(number);
        assert_eq!(store.poll(&kept, at_ms - 1, 1000), Ok(false), "too early");
        assert_eq!(store.poll(&kept, at_ms, 1000), Ok(true));
        let erasures = store.flash.erasures;
        let mut failing = store.clone();
        failing.save(&Retaining::with_state(99)).unwrap();
        assert_eq!(failing.flash.erasures, erasures);
    }
    let same = Retaining::with_state(29);
    assert_eq!(
        store.poll(&same, at_ms + 1000, 1000),
        Ok(false),
        "unchanged"
    );
}

#[test]
fn records_of_another_program_are_not_loaded() {
    let mut store = Slots::open(Cells::new(256)).unwrap();
    let mut other = Retaining::with_state(5);
    other.retained.program = "pump (h2u)";
    store.save(&other).unwrap();
    let (what, found) = loaded(store.flash);
    let Loaded::Foreign(owner) = what else {
        panic!("{what:?}");
    };
    assert_eq!(owner.as_str(), "pump (h2u)");
    assert_eq!(found.state(), Retaining::new().state());
}

#[test]
fn a_changed_program_keeps_the_devices_that_both_have() {
    let mut store = Slots::open(Cells::new(256)).unwrap();
    store.save(&Retaining::with_state(5)).unwrap();
    let mut kept = Retaining::new();
    kept.retained.runs = const {
        &[
            RetainedRun::new(Class::D, 201, 9),
            RetainedRun::new(Class::M, 504, 4),
        ]
    };
    let what = store.load(&mut kept).unwrap();
    assert_eq!(
        what,
        Loaded::Restored {
            dropped: 17 + 2 + 1 + 1 + 1
        }
    );
    assert_eq!(kept.plc.d(200, 4), [0, 5, 5, 0]);
    assert_eq!(kept.plc.m(503, 6), "010100");
}

#[test]
fn without_its_key_a_model_keeps_nothing() {
    let mut store = Slots::open(Cells::new(256)).unwrap();
    for (held, value) in [(2222, 5), (0, 0)] {
        let mut kept = Retaining::with_state(5);
        kept.retained.key = Some((8020, 2222));
        kept.set_word(Class::D, 8020, held).unwrap();
        store.save(&kept).unwrap();
        let found = loaded(store.flash.clone()).1;
        assert_eq!(found.word(Class::D, 200), Some(value));
    }
}

#[test]
fn contacts_open_where_the_model_opens_them() {
    let mut store = Slots::open(Cells::new(256)).unwrap();
    let mut kept = Retaining::with_state(4);
    kept.retained.contacts = false;
    assert_eq!(kept.bit(Class::T, 251), Some(true));
    store.save(&kept).unwrap();
    assert_eq!(loaded(store.flash).1.bit(Class::T, 251), Some(false));
}

/// The flash controller of a part, as its reference manual describes it.
struct Part {
    is_f4: bool,
    memory: Vec<u8>,
    control: u32,
    status: u32,
    unlocking: u32,
    page: u32,
    erased: Vec<u32>,
    /// Remaining reads of the busy bit as set.
    busy: u32,
}

const BASE: u32 = 0x0800_0000;

impl Part {
    fn new(is_f4: bool) -> Self {
        Part {
            is_f4,
            memory: vec![0; 0x2_0000],
            control: 1 << if is_f4 { 31 } else { 7 },
            status: 0,
            unlocking: 0,
            page: 0,
            erased: Vec::new(),
            busy: 0,
        }
    }

    fn is_locked(&self) -> bool {
        self.control & (1 << if self.is_f4 { 31 } else { 7 }) != 0
    }

    /// The controller's register at an address, counted from the family's first.
    fn register(&self, address: u32) -> u32 {
        address - if self.is_f4 { 0x4002_3C00 } else { 0x4002_2000 }
    }

    fn set_control(&mut self, value: u32) {
        if self.is_locked() {
            return;
        }
        let start = 1 << if self.is_f4 { 16 } else { 6 };
        self.control = value & !start;
        if value & start != 0 && value & 2 != 0 {
            self.erase(value >> 3 & 31);
        }
    }

    fn erase(&mut self, sector: u32) {
        let (first, length) = match self.is_f4 {
            true => (sector * 0x4000, 0x4000),
            false => (self.page - BASE, 1024),
        };
        self.memory[first as usize..(first + length) as usize].fill(0xFF);
        self.erased.push(first);
        self.busy = 3;
    }

    fn store(&mut self, address: u32, bytes: &[u8]) {
        let first = (address - BASE) as usize;
        let cells = &mut self.memory[first..first + bytes.len()];
        let by_words = !self.is_f4 || self.control >> 8 & 3 == 2;
        if self.control & 1 == 0 || !by_words || self.busy > 0 || cells.iter().any(|&c| c != 0xFF) {
            self.status |= if self.is_f4 { 1 << 7 } else { 1 << 2 };
            return;
        }
        cells.copy_from_slice(bytes);
        self.busy = 2;
    }
}

impl Registers for &mut Part {
    fn read(&mut self, address: u32) -> u32 {
        if let Some(at) = address.checked_sub(BASE).filter(|&at| at < 0x2_0000) {
            let word: [u8; 4] = self.memory[at as usize..][..4].try_into().unwrap();
            return u32::from_le_bytes(word);
        }
        match self.register(address) {
            0x0C => {
                let is_busy = self.busy > 0;
                self.busy = self.busy.saturating_sub(1);
                self.status | u32::from(is_busy) << if self.is_f4 { 16 } else { 0 }
            }
            0x10 => self.control,
            _ => 0,
        }
    }

    fn write(&mut self, address: u32, value: u32) {
        if address < 0x4000_0000 {
            assert!(self.is_f4, "STM32F1 takes half words");
            return self.store(address, &value.to_le_bytes());
        }
        match self.register(address) {
            0x04 => {
                let key = [0x4567_0123, 0xCDEF_89AB][self.unlocking as usize];
                assert_eq!(value, key, "a wrong key locks the controller until a reset");
                self.unlocking = (self.unlocking + 1) % 2;
                if self.unlocking == 0 {
                    self.control &= !(1 << if self.is_f4 { 31 } else { 7 });
                }
            }
            0x0C => self.status &= !value,
            0x10 => self.set_control(value),
            0x14 => self.page = value,
            other => panic!("register {other:#x} is written"),
        }
    }

    fn write_half(&mut self, address: u32, value: u16) {
        assert!(!self.is_f4, "words are written as a whole");
        self.store(address, &value.to_le_bytes());
    }
}

/// Saves more often than a slot has room, each time as after a reset, and loads.
fn saves_on<F: Flash>(flash: impl Fn() -> F) {
    for number in 1..200 {
        let mut store = Slots::open(flash()).unwrap();
        let mut kept = Retaining::new();
        store.load(&mut kept).unwrap();
        let before = if number > 1 { number - 1 } else { 0 };
        let expected = if before == 0 {
            Retaining::new()
        } else {
            Retaining::with_state(before)
        };
        assert_eq!(kept.state(), expected.state());
        store.save(&Retaining::with_state(number)).unwrap();
    }
}

#[test]
fn an_stm32f1_erases_pages_and_takes_half_words() {
    let mut part = Part::new(false);
    let slots = [
        BASE + 0x1_F000..BASE + 0x1_F800,
        BASE + 0x1_F800..BASE + 0x2_0000,
    ];
    let part_cell = core::cell::RefCell::new(&mut part);
    saves_on(|| Shared {
        part: &part_cell,
        slots: slots.clone(),
    });
    assert!(part.is_locked());
    assert_eq!(part.erased[..4], [0x1_F000, 0x1_F400, 0x1_F800, 0x1_FC00]);
    assert_eq!(part.erased.len(), 2 * 199usize.div_ceil(25));
}

#[test]
fn an_stm32f4_erases_sectors_and_takes_words() {
    let mut part = Part::new(true);
    let slots = [BASE + 0x8000..BASE + 0xC000, BASE + 0xC000..BASE + 0x1_0000];
    let part_cell = core::cell::RefCell::new(&mut part);
    saves_on(|| Shared {
        part: &part_cell,
        slots: slots.clone(),
    });
    assert!(part.is_locked());
    assert_eq!(part.erased, [0x8000]);
}

/// The driver of a part that outlives it.
struct Shared<'p> {
    part: &'p core::cell::RefCell<&'p mut Part>,
    slots: [Range<u32>; 2],
}

impl Shared<'_> {
    fn with<T>(&self, work: impl FnOnce(&mut dyn Flash) -> T) -> T {
        let mut part = self.part.borrow_mut();
        let slots = self.slots.clone();
        match part.is_f4 {
            true => work(&mut Stm32f4 {
                registers: &mut **part,
                slots,
            }),
            false => work(&mut Stm32f1 {
                registers: &mut **part,
                slots,
                page: 1024,
            }),
        }
    }
}

impl Flash for Shared<'_> {
    fn slot_len(&self) -> u32 {
        self.slots[0].end - self.slots[0].start
    }
    fn read(&mut self, slot: usize, offset: u32, bytes: &mut [u8]) -> Result<(), FlashFailed> {
        self.with(|flash| flash.read(slot, offset, bytes))
    }
    fn erase(&mut self, slot: usize) -> Result<(), FlashFailed> {
        self.with(|flash| flash.erase(slot))
    }
    fn program(&mut self, slot: usize, offset: u32, bytes: &[u8]) -> Result<(), FlashFailed> {
        self.with(|flash| flash.program(slot, offset, bytes))
    }
}

#[test]
fn sectors_of_an_stm32f4_follow_from_addresses() {
    let sectors = f4_sectors;
    assert_eq!(sectors(&(0x0800_8000..0x0800_C000)), Some(2..3));
    assert_eq!(sectors(&(0x0801_0000..0x0804_0000)), Some(4..6));
    assert_eq!(sectors(&(0x0810_0000..0x0810_4000)), Some(16..17));
    assert_eq!(sectors(&(0x0800_8000..0x0800_9000)), None);
    assert_eq!(sectors(&(0x2000_0000..0x2000_4000)), None);
}
