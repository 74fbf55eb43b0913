//! Where the interpreter keeps devices: every device of the model, whether the program uses it or not.

use rungc_ir::Model;
use rungc_ir::runs::is_special;
use rungc_rt::{Class, Counter16, Counter32, FIRST_COUNTER32, FIRST_SPECIAL, Timer};
use rungc_syntax::DeviceClass;

/// The class as the runtime numbers it; `None` for pointers and nesting levels, which are no storage.
pub fn rt_class(class: DeviceClass) -> Option<Class> {
    Some(match class {
        DeviceClass::X => Class::X,
        DeviceClass::Y => Class::Y,
        DeviceClass::M => Class::M,
        DeviceClass::S => Class::S,
        DeviceClass::T => Class::T,
        DeviceClass::C => Class::C,
        DeviceClass::D => Class::D,
        DeviceClass::R => Class::R,
        DeviceClass::ER => Class::ER,
        DeviceClass::V => Class::V,
        DeviceClass::Z => Class::Z,
        DeviceClass::P | DeviceClass::I | DeviceClass::N => return None,
    })
}

/// What the model says about one number of a class.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
struct Presence {
    exists: bool,
    latched: bool,
    special: bool,
}

/// The devices of one class, by number.
struct Bank<T> {
    cells: Vec<T>,
    presence: Vec<Presence>,
}

impl<T: Clone + Default> Bank<T> {
    /// The devices of `class` whose numbers `wanted` accepts.
    fn new(model: &'static Model, class: DeviceClass, wanted: impl Fn(u32) -> bool) -> Self {
        let mut presence = Vec::new();
        for range in model.ranges_of(class) {
            let special = is_special(class, range.first);
            for number in (range.first..=range.last).filter(|&n| wanted(n)) {
                let i = number as usize;
                if presence.len() <= i {
                    presence.resize(i + 1, Presence::default());
                }
                presence[i] = Presence {
                    exists: true,
                    latched: range.latched,
                    special,
                };
            }
        }
        Bank {
            cells: vec![T::default(); presence.len()],
            presence,
        }
    }

    fn get(&self, number: u32) -> Option<&T> {
        let i = number as usize;
        self.presence.get(i).filter(|p| p.exists)?;
        self.cells.get(i)
    }

    fn get_mut(&mut self, number: u32) -> Option<&mut T> {
        let i = number as usize;
        self.presence.get(i).filter(|p| p.exists)?;
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
    x: Bank<bool>,
    y: Bank<bool>,
    m: Bank<bool>,
    s: Bank<bool>,
    timers: Bank<Timer>,
    counters16: Bank<Counter16>,
    counters32: Bank<Counter32>,
    d: Bank<i16>,
    r: Bank<i16>,
    v: Bank<i16>,
    z: Bank<i16>,
    er: Bank<i16>,
    /// Other names of index registers among the special registers: (D number, class, number).
    aliases: &'static [(u32, DeviceClass, u32)],
}

impl Devices {
    /// The devices of `model`, all 0.
    pub(crate) fn new(model: &'static Model) -> Self {
        let any = |_: u32| true;
        Devices {
            x: Bank::new(model, DeviceClass::X, any),
            y: Bank::new(model, DeviceClass::Y, any),
            m: Bank::new(model, DeviceClass::M, any),
            s: Bank::new(model, DeviceClass::S, any),
            timers: Bank::new(model, DeviceClass::T, any),
            counters16: Bank::new(model, DeviceClass::C, |n| n < FIRST_COUNTER32),
            counters32: Bank::new(model, DeviceClass::C, |n| n >= FIRST_COUNTER32),
            d: Bank::new(model, DeviceClass::D, any),
            r: Bank::new(model, DeviceClass::R, any),
            v: Bank::new(model, DeviceClass::V, any),
            z: Bank::new(model, DeviceClass::Z, any),
            er: Bank::new(model, DeviceClass::ER, any),
            aliases: model.index_aliases,
        }
    }

    /// The storage behind a word device's name.
    fn canonical(&self, class: Class, number: u32) -> (Class, u32) {
        if class == Class::D && number >= FIRST_SPECIAL {
            let alias = self.aliases.iter().find(|(d, ..)| *d == number);
            if let Some(&(_, class, number)) = alias
                && let Some(class) = rt_class(class)
            {
                return (class, number);
            }
        }
        (class, number)
    }

    fn words(&self, class: Class) -> Option<&Bank<i16>> {
        match class {
            Class::D => Some(&self.d),
            Class::R => Some(&self.r),
            Class::V => Some(&self.v),
            Class::Z => Some(&self.z),
            Class::ER => Some(&self.er),
            _ => None,
        }
    }

    pub(crate) fn bit(&self, class: Class, number: u32) -> Option<bool> {
        match class {
            Class::X => self.x.get(number).copied(),
            Class::Y => self.y.get(number).copied(),
            Class::M => self.m.get(number).copied(),
            Class::S => self.s.get(number).copied(),
            Class::T => self.timers.get(number).map(|t| t.done),
            Class::C if number < FIRST_COUNTER32 => self.counters16.get(number).map(|c| c.done),
            Class::C => self.counters32.get(number).map(|c| c.done),
            _ => None,
        }
    }

    pub(crate) fn bit_mut(&mut self, class: Class, number: u32) -> Option<&mut bool> {
        match class {
            Class::X => self.x.get_mut(number),
            Class::Y => self.y.get_mut(number),
            Class::M => self.m.get_mut(number),
            Class::S => self.s.get_mut(number),
            Class::T => self.timers.get_mut(number).map(|t| &mut t.done),
            Class::C if number < FIRST_COUNTER32 => {
                self.counters16.get_mut(number).map(|c| &mut c.done)
            }
            Class::C => self.counters32.get_mut(number).map(|c| &mut c.done),
            _ => None,
        }
    }

    pub(crate) fn word(&self, class: Class, number: u32) -> Option<i16> {
        let (class, number) = self.canonical(class, number);
        match class {
            Class::T => self.timers.get(number).map(|t| t.value),
            Class::C => self.counters16.get(number).map(|c| c.value),
            _ => self.words(class)?.get(number).copied(),
        }
    }

    pub(crate) fn word_mut(&mut self, class: Class, number: u32) -> Option<&mut i16> {
        let (class, number) = self.canonical(class, number);
        match class {
            Class::T => self.timers.get_mut(number).map(|t| &mut t.value),
            Class::C => self.counters16.get_mut(number).map(|c| &mut c.value),
            Class::D => self.d.get_mut(number),
            Class::R => self.r.get_mut(number),
            Class::V => self.v.get_mut(number),
            Class::Z => self.z.get_mut(number),
            Class::ER => self.er.get_mut(number),
            Class::X | Class::Y | Class::M | Class::S => None,
        }
    }

    pub(crate) fn timer(&mut self, number: u32) -> Option<&mut Timer> {
        self.timers.get_mut(number)
    }

    pub(crate) fn counter16(&mut self, number: u32) -> Option<&mut Counter16> {
        self.counters16.get_mut(number)
    }

    pub(crate) fn counter32(&self, number: u32) -> Option<&Counter32> {
        self.counters32.get(number)
    }

    pub(crate) fn counter32_mut(&mut self, number: u32) -> Option<&mut Counter32> {
        self.counters32.get_mut(number)
    }

    /// M8031, M8032 and going to STOP: clears the general or the latched devices. Inputs and special devices stay.
    pub(crate) fn clear(&mut self, latched: bool) {
        let pick = |p: Presence| p.latched == latched && !p.special;
        self.each_clear(pick);
    }

    /// Power off and on: only latched devices keep their value, if any do, and no coil remembers that it was on.
    pub(crate) fn power_off(&mut self, keeps_latched: bool) {
        let pick = |p: Presence| !(p.latched && keeps_latched);
        self.x.clear(pick);
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
        for bits in [&mut self.y, &mut self.m, &mut self.s] {
            bits.clear(pick);
        }
        for words in [
            &mut self.d,
            &mut self.r,
            &mut self.v,
            &mut self.z,
            &mut self.er,
        ] {
            words.clear(pick);
        }
        self.timers.clear(pick);
        self.counters16.clear(pick);
        self.counters32.clear(pick);
    }

    /// Timers' and counters' coils count as off before the first scan in RUN, like every edge memory.
    pub(crate) fn forget_coils(&mut self) {
        self.timers.cells.iter_mut().for_each(|t| t.coil = false);
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
