//! The devices that a program stores, for what asks for no others: less code than all devices of its model need.

use super::Map;
use super::map::{bit_of, counter_of, read, word_of, write};
use crate::comm::PortMut;
use crate::comm::modbus::Profile;
use crate::plc::{Class, Plc, State, Sys};

/// The devices that a program stores. Others do not exist.
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
        self.0.modbus()
    }

    fn type_code(&self) -> u16 {
        self.0.type_code()
    }
}
