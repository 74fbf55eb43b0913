//! The devices that a program stores, for what asks for no others: less code than all devices of its model need.

use super::map::{bit_of, counter_of, read, word_of, write};
use super::{Kind, Map};
use crate::comm::modbus::Profile;
use crate::comm::{Element, Elements, PortMut};
use crate::plc::{Class, Plc, State, Sys};

/// The devices that a program stores. Others do not exist.
/// Its layout names what it serves by Modbus.
pub(super) struct Stored<'a>(pub(super) &'a mut Map);

impl Plc for Stored<'_> {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        let (kind, at) = self.0.stored(class, number)?;
        bit_of(kind, at).map(read)
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        let (kind, at) = self.0.stored(class, number)?;
        bit_of(kind, at).map(|at| write(at, value))
    }

    #[inline(never)]
    fn word(&self, class: Class, number: u32) -> Option<i16> {
        let (kind, at) = self.0.stored(class, number)?;
        word_of(kind, at).map(read)
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        let (kind, at) = self.0.stored(class, number)?;
        word_of(kind, at).map(|at| write(at, value))
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        let (kind, at) = self.0.stored(Class::C, number)?;
        counter_of(kind, at).map(read)
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        let (kind, at) = self.0.stored(Class::C, number)?;
        counter_of(kind, at).map(|at| write(at, value))
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        self.0.reset(class, number)
    }

    fn state(&mut self, slot: u16) -> &mut State {
        self.0.state(slot)
    }

    fn sys(&self) -> &Sys {
        self.0.sys()
    }

    fn port(&mut self, number: u8) -> Option<PortMut<'_>> {
        self.0.port(number)
    }

    fn modbus(&self) -> &'static Profile {
        // SAFETY: one of the library's, which the layout of a program with a slave names.
        unsafe { &*self.0.layout().modbus }
    }

    fn type_code(&self) -> u16 {
        self.0.type_code()
    }
}

impl Elements for Stored<'_> {
    fn element(&mut self, class: Class, number: u32) -> Option<Element<'_>> {
        let (kind, at) = self.0.stored(class, number)?;
        // SAFETY: the program's struct holds an element of this kind there, and nothing else uses it during a call.
        Some(unsafe {
            match kind {
                Kind::Bits => Element::Bit(&mut *at.cast()),
                Kind::Words => Element::Word(&mut *at.cast()),
                Kind::Timers => Element::Timer(&mut *at.cast()),
                Kind::Counters16 => Element::Counter16(&mut *at.cast()),
                Kind::Counters32 => Element::Counter32(&mut *at.cast()),
            }
        })
    }
}
