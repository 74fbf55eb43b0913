//! Storage of devices in the interpreter: every device of the model, whether the program uses it or not.

use rungc_ir::Module;
use rungc_models::Range;
use rungc_models::runs::{IndexAlias, is_special, rt_class};
use rungc_rt::{Class, Counter16, Counter32, FIRST_COUNTER32, FIRST_SPECIAL, Timer};
use rungc_syntax::DeviceClass;

/// Properties of one number of a class, according to the model.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
struct Presence {
    exists: bool,
    latched: bool,
    /// An input or a special device, which neither M8031 nor M8032 clears.
    spared: bool,
}

/// Range of a class's devices in their bank: number 0 at `start`.
#[derive(Clone, Copy, Default)]
struct Row {
    start: u32,
    length: u32,
}

/// A bit device in the bank of all bits, which every device of the model is in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct BitSlot(u32);

impl BitSlot {
    /// The slot `numbers` further on in the same class.
    pub(crate) fn plus(self, numbers: u32) -> Self {
        BitSlot(self.0.wrapping_add(numbers))
    }
}

/// The devices of some classes, one class after the other.
struct Bank<T> {
    cells: Vec<T>,
    presence: Vec<Presence>,
    /// By class.
    rows: [Row; CLASSES],
}

/// Number of classes that are storage.
const CLASSES: usize = Class::ER as usize + 1;

impl<T: Clone + Default> Bank<T> {
    /// The devices of `classes` whose numbers `wanted` accepts.
    fn new(ranges: &[Range], classes: &[DeviceClass], wanted: impl Fn(u32) -> bool) -> Self {
        let mut presence = Vec::new();
        let mut rows = [Row::default(); CLASSES];
        for &name in classes {
            let Some(class) = rt_class(name) else {
                continue;
            };
            let start = presence.len();
            for range in ranges.iter().filter(|range| range.class == name) {
                let spared = class == Class::X || is_special(name, range.first);
                for number in (range.first..=range.last).filter(|&n| wanted(n)) {
                    let i = start + number as usize;
                    if presence.len() <= i {
                        presence.resize(i + 1, Presence::default());
                    }
                    presence[i] = Presence {
                        exists: true,
                        latched: range.latched,
                        spared,
                    };
                }
            }
            rows[class as usize] = Row {
                start: start as u32,
                length: (presence.len() - start) as u32,
            };
        }
        Bank {
            cells: vec![T::default(); presence.len()],
            presence,
            rows,
        }
    }

    /// Index of a device, if the model has it.
    fn slot(&self, class: Class, number: u32) -> Option<usize> {
        let row = self.rows[class as usize];
        if number >= row.length {
            return None;
        }
        let i = (row.start + number) as usize;
        self.presence[i].exists.then_some(i)
    }

    fn get(&self, class: Class, number: u32) -> Option<&T> {
        let i = self.slot(class, number)?;
        self.cells.get(i)
    }

    fn get_mut(&mut self, class: Class, number: u32) -> Option<&mut T> {
        let i = self.slot(class, number)?;
        self.cells.get_mut(i)
    }

    /// Gives the devices that `pick` chooses their power-on value 0.
    fn clear(&mut self, pick: impl Fn(Presence) -> bool) {
        for (cell, presence) in self.cells.iter_mut().zip(&self.presence) {
            if pick(*presence) {
                *cell = T::default();
            }
        }
    }
}

/// All devices of a model.
pub(crate) struct Devices {
    bits: Bank<bool>,
    words: Bank<i16>,
    timers: Bank<Timer>,
    counters16: Bank<Counter16>,
    counters32: Bank<Counter32>,
    /// Other names of index registers among the special registers.
    aliases: &'static [IndexAlias],
}

/// Values of all devices of a model.
#[derive(Clone)]
pub(crate) struct Cells {
    bits: Vec<bool>,
    words: Vec<i16>,
    timers: Vec<Timer>,
    counters16: Vec<Counter16>,
    counters32: Vec<Counter32>,
}

impl Devices {
    /// Current values.
    pub(crate) fn cells(&self) -> Cells {
        Cells {
            bits: self.bits.cells.clone(),
            words: self.words.cells.clone(),
            timers: self.timers.cells.clone(),
            counters16: self.counters16.cells.clone(),
            counters32: self.counters32.cells.clone(),
        }
    }

    /// Gives them what devices of the same model have held.
    pub(crate) fn set_cells(&mut self, cells: &Cells) {
        self.bits.cells.clone_from(&cells.bits);
        self.words.cells.clone_from(&cells.words);
        self.timers.cells.clone_from(&cells.timers);
        self.counters16.cells.clone_from(&cells.counters16);
        self.counters32.cells.clone_from(&cells.counters32);
    }

    /// The devices of a program's model, all 0.
    pub(crate) fn new(module: &Module) -> Self {
        use DeviceClass::{C, D, ER, M, R, S, T, V, X, Y, Z};
        let any = |_: u32| true;
        let ranges = &module.ranges;
        Devices {
            bits: Bank::new(ranges, &[X, Y, M, S], any),
            words: Bank::new(ranges, &[D, R, V, Z, ER], any),
            timers: Bank::new(ranges, &[T], any),
            counters16: Bank::new(ranges, &[C], |n| n < FIRST_COUNTER32),
            counters32: Bank::new(ranges, &[C], |n| n >= FIRST_COUNTER32),
            aliases: module.model.index_aliases,
        }
    }

    /// The device that a word device's name stands for.
    fn canonical(&self, class: Class, number: u32) -> (Class, u32) {
        if class == Class::D && number >= FIRST_SPECIAL {
            let mut aliases = self.aliases.iter();
            if let Some(alias) = aliases.find(|alias| alias.register.number() == number)
                && let Some(class) = rt_class(alias.class)
            {
                return (class, alias.index);
            }
        }
        (class, number)
    }

    /// Index of a bit device; `None` for contacts of timers and counters, which are in their own memory.
    pub(crate) fn bit_slot(&self, class: Class, number: u32) -> Option<BitSlot> {
        let i = self.bits.slot(class, number)?;
        u32::try_from(i).ok().map(BitSlot)
    }

    /// Returns true if any of `count` states S from `first` on, which follow each other, is on.
    pub(crate) fn any_state(&self, first: u32, count: u32) -> bool {
        let begin = self.bits.slot(Class::S, first);
        let states = begin.and_then(|i| self.bits.cells.get(i..i + count as usize));
        states.is_some_and(|states| states.contains(&true))
    }

    /// The bit in a slot.
    pub(crate) fn bit_at(&self, slot: BitSlot) -> bool {
        self.bits.cells.get(slot.0 as usize) == Some(&true)
    }

    pub(crate) fn bit(&self, class: Class, number: u32) -> Option<bool> {
        match class {
            Class::T => self.timers.get(class, number).map(|t| t.done),
            Class::C if number < FIRST_COUNTER32 => {
                self.counters16.get(class, number).map(|c| c.done)
            }
            Class::C => self.counters32.get(class, number).map(|c| c.done),
            Class::X
            | Class::Y
            | Class::M
            | Class::S
            | Class::D
            | Class::R
            | Class::V
            | Class::Z
            | Class::ER => self.bits.get(class, number).copied(),
        }
    }

    pub(crate) fn bit_mut(&mut self, class: Class, number: u32) -> Option<&mut bool> {
        match class {
            Class::T => self.timers.get_mut(class, number).map(|t| &mut t.done),
            Class::C if number < FIRST_COUNTER32 => {
                let counter = self.counters16.get_mut(class, number);
                counter.map(|c| &mut c.done)
            }
            Class::C => {
                let counter = self.counters32.get_mut(class, number);
                counter.map(|c| &mut c.done)
            }
            Class::X
            | Class::Y
            | Class::M
            | Class::S
            | Class::D
            | Class::R
            | Class::V
            | Class::Z
            | Class::ER => self.bits.get_mut(class, number),
        }
    }

    pub(crate) fn word(&self, class: Class, number: u32) -> Option<i16> {
        let (class, number) = self.canonical(class, number);
        match class {
            Class::T => self.timers.get(class, number).map(|t| t.value),
            Class::C => self.counters16.get(class, number).map(|c| c.value),
            Class::X
            | Class::Y
            | Class::M
            | Class::S
            | Class::D
            | Class::R
            | Class::V
            | Class::Z
            | Class::ER => self.words.get(class, number).copied(),
        }
    }

    pub(crate) fn word_mut(&mut self, class: Class, number: u32) -> Option<&mut i16> {
        let (class, number) = self.canonical(class, number);
        match class {
            Class::T => self.timers.get_mut(class, number).map(|t| &mut t.value),
            Class::C => {
                let counter = self.counters16.get_mut(class, number);
                counter.map(|c| &mut c.value)
            }
            Class::X
            | Class::Y
            | Class::M
            | Class::S
            | Class::D
            | Class::R
            | Class::V
            | Class::Z
            | Class::ER => self.words.get_mut(class, number),
        }
    }

    /// State of the coil of a timer or counter.
    pub(crate) fn coil(&self, class: Class, number: u32) -> Option<bool> {
        let timer = self.timers.get(class, number).map(|t| t.coil != 0);
        let narrow = || self.counters16.get(class, number).map(|c| c.coil);
        let wide = || self.counters32.get(class, number).map(|c| c.coil);
        timer.or_else(narrow).or_else(wide)
    }

    pub(crate) fn timer(&mut self, number: u32) -> Option<&mut Timer> {
        self.timers.get_mut(Class::T, number)
    }

    pub(crate) fn counter16(&mut self, number: u32) -> Option<&mut Counter16> {
        self.counters16.get_mut(Class::C, number)
    }

    pub(crate) fn counter32(&self, number: u32) -> Option<&Counter32> {
        self.counters32.get(Class::C, number)
    }

    pub(crate) fn counter32_mut(&mut self, number: u32) -> Option<&mut Counter32> {
        self.counters32.get_mut(Class::C, number)
    }

    /// The coil of a counter counts as on, so its next execution does not count.
    pub(crate) fn hold_counter(&mut self, number: u32) {
        if let Some(counter) = self.counter16(number) {
            counter.coil = true;
        } else if let Some(counter) = self.counter32_mut(number) {
            counter.coil = true;
        }
    }

    /// M8031, M8032 and going to STOP: clears the general or the latched devices. Inputs and special devices stay.
    pub(crate) fn clear(&mut self, latched: bool) {
        let pick = |p: Presence| p.latched == latched && !p.spared;
        self.each_clear(pick);
    }

    /// Power off and on: only latched devices keep their value, if any do, and no coil remembers that it was on.
    pub(crate) fn power_off(&mut self, keeps_latched: bool) {
        let pick = |p: Presence| !(p.latched && keeps_latched);
        self.each_clear(pick);
        self.forget_coils();
    }

    /// Opens the contacts of timers and counters.
    pub(crate) fn open_contacts(&mut self) {
        self.timers.cells.iter_mut().for_each(|t| t.done = false);
        self.counters16
            .cells
            .iter_mut()
            .for_each(|c| c.done = false);
        self.counters32
            .cells
            .iter_mut()
            .for_each(|c| c.done = false);
    }

    fn each_clear(&mut self, pick: impl Fn(Presence) -> bool + Copy) {
        self.bits.clear(pick);
        self.words.clear(pick);
        self.timers.clear(pick);
        self.counters16.clear(pick);
        self.counters32.clear(pick);
    }

    /// Timers' and counters' coils count as off before the first scan in RUN, like every edge memory.
    pub(crate) fn forget_coils(&mut self) {
        self.timers.cells.iter_mut().for_each(|t| t.coil = 0);
        self.counters16
            .cells
            .iter_mut()
            .for_each(|c| c.coil = false);
        self.counters32
            .cells
            .iter_mut()
            .for_each(|c| c.coil = false);
    }
}
