//! The PLC's devices as codecs see them.

use crate::fault::show_error;
use crate::plc::{Class, Plc, StoredRun};
use crate::special::M_PORT_ERROR;
use core::cell::Cell;

/// The devices of a PLC as its partners on a line see them.
///
/// Numbers are device numbers: X010 is 8. `None` stands for a device that the model does not have or that this PLC does
/// not serve; the codec rejects the frame as its protocol says. A class that has no state (D) or no 16-bit value (M,
/// C200 and up) gives `None` as well.
pub trait Map {
    /// State of a bit device; for T and C the contact.
    fn bit(&self, class: Class, number: u32) -> Option<bool>;
    /// Sets a bit device. An input keeps the value until its terminal is read again.
    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()>;
    /// State of the coil of a timer or counter; a map that knows no coils gives the contact.
    fn coil(&self, class: Class, number: u32) -> Option<bool> {
        self.bit(class, number)
    }
    /// Value of a 16-bit word device; for T and C0–C199 the current value.
    fn word(&self, class: Class, number: u32) -> Option<i16>;
    /// Sets a word device.
    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()>;
    /// Current value of a 32-bit counter (C200 and up).
    fn counter32(&self, number: u32) -> Option<i32>;
    /// Sets the current value of a 32-bit counter.
    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()>;
    /// Resets a timer or counter: value 0, contact off.
    fn reset(&mut self, class: Class, number: u32) -> Option<()>;
    /// Returns true if the PLC is in RUN.
    fn running(&self) -> bool;
    /// Shows an error of a port.
    fn show_port_error(&mut self, code: u16) {
        let number = M_PORT_ERROR.number();
        let _ = self.set_bit(Class::M, number, true);
        let _ = self.set_word(Class::D, number, code as i16);
    }
    /// Asks for RUN or STOP; the PLC changes over before its next scan.
    fn request_running(&mut self, running: bool);
    /// The latest request for RUN or STOP that has not been carried out yet.
    fn requested_running(&self) -> Option<bool> {
        None
    }
    /// Code of model and version, which D8001 shows.
    fn type_code(&self) -> u16;
    /// A byte of the program memory by its offset from 8000h, if the program can be read.
    fn program_byte(&self, offset: u32) -> Option<u8> {
        let _ = offset;
        None
    }

    /// Selects the unit of a request over Modbus TCP; returns false if it is not for these devices. Units 0, 1 and 255
    /// mean the PLC itself rather than a device connected to it. A map of several PLCs is that of this unit from then
    /// on.
    fn takes_unit(&mut self, unit: u8) -> bool {
        matches!(unit, 0 | 1 | 255)
    }

    /// Returns true if `count` bit devices from `first` on all exist.
    fn has_bits(&self, class: Class, first: u32, count: u32) -> bool {
        let end = first.checked_add(count);
        end.is_some_and(|end| (first..end).all(|n| self.bit(class, n).is_some()))
    }

    /// Returns true if `count` 16-bit word devices from `first` on all exist.
    fn has_words(&self, class: Class, first: u32, count: u32) -> bool {
        let end = first.checked_add(count);
        end.is_some_and(|end| (first..end).all(|n| self.word(class, n).is_some()))
    }
}

/// A running program as its ports serve it: all devices that it stores. An emitted program stores those that it names;
/// the interpreter, and programs compiled with `observe_all`, store all.
pub struct Served<'a, P: ?Sized = dyn Plc + 'a> {
    plc: &'a mut P,
    type_code: u16,
    request: Option<bool>,
    /// Class, first device and place of the devices that were requested last: most frames are about a run of them.
    last: Cell<(Class, u32, StoredRun)>,
}

impl<'a, P: Plc + ?Sized> Served<'a, P> {
    /// Serves the devices of `plc`, a model whose D8001 shows `type_code`.
    pub fn new(plc: &'a mut P, type_code: u16) -> Self {
        Served {
            plc,
            type_code,
            request: None,
            last: Cell::new((Class::X, 0, StoredRun { count: 0, area: 0 })),
        }
    }

    /// RUN or STOP, if a frame has requested it.
    pub fn take_request(&mut self) -> Option<bool> {
        self.request.take()
    }
}

impl<P: Plc + ?Sized> Served<'_, P> {
    /// Area that stores a device; rejects a device that is not stored.
    fn stored(&self, class: Class, number: u32) -> Option<u8> {
        let (last_class, first, run) = self.last.get();
        if last_class == class && number.wrapping_sub(first) < run.count {
            return Some(run.area);
        }
        let run = self.plc.stored_run(class, number)?;
        self.last.set((class, number, run));
        Some(run.area)
    }
}

impl<P: Plc + ?Sized> Map for Served<'_, P> {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        let area = self.stored(class, number)?;
        self.plc.bit_in(area, class, number)
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        let area = self.stored(class, number)?;
        self.plc.set_bit_in(area, class, number, value)
    }

    fn coil(&self, class: Class, number: u32) -> Option<bool> {
        self.stored(class, number)?;
        self.plc.coil(class, number)
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        let area = self.stored(class, number)?;
        self.plc.word_in(area, class, number)
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        let area = self.stored(class, number)?;
        self.plc.set_word_in(area, class, number, value)
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.stored(Class::C, number)?;
        self.plc.counter32(number)
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        self.stored(Class::C, number)?;
        self.plc.set_counter32(number, value)
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        self.stored(class, number)?;
        self.plc.reset(class, number)
    }

    fn show_port_error(&mut self, code: u16) {
        show_error(self.plc, M_PORT_ERROR, code);
    }

    fn running(&self) -> bool {
        self.plc.sys().running
    }

    fn requested_running(&self) -> Option<bool> {
        self.request
    }

    fn request_running(&mut self, running: bool) {
        self.request = Some(running);
    }

    fn type_code(&self) -> u16 {
        self.type_code
    }

    fn program_byte(&self, offset: u32) -> Option<u8> {
        self.plc.program_byte(offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::double::Double;

    #[test]
    fn frames_reach_devices_and_the_switch() {
        let mut plc = Double::new().with_d(5, &[7]);
        let mut map = Served::new(&mut plc, 24120);
        assert_eq!(map.word(Class::D, 5), Some(7));
        assert_eq!(map.set_bit(Class::Y, 8, true), Some(()));
        assert!(map.has_words(Class::D, 0, 10) && !map.has_words(Class::D, 8500, 100));
        assert!(map.has_bits(Class::X, 0, 256) && !map.has_bits(Class::X, u32::MAX, 2));
        assert!(map.running());
        map.request_running(false);
        assert_eq!(map.take_request(), Some(false));
        assert_eq!(map.take_request(), None);
        assert_eq!(map.type_code(), 24120);
        assert_eq!(plc.bit(Class::Y, 8), Some(true));
    }
}
