//! The registers and coils of a slave by Modbus: places, wherever devices are stored.

use super::Map;
use super::modbus::Place;
use crate::plc::Class;
use crate::timing::{Counter16, Counter32, Timer};
use crate::word::{pair, words};

/// The places of a slave by Modbus.
pub trait Places {
    /// Reads the register or the coil at a place, after it has written `new` there, if that is given; `None` if there
    /// is none.
    fn exchange(&mut self, place: Place, new: Option<u16>) -> Option<u16>;
}

impl<M: Map + ?Sized> Places for M {
    fn exchange(&mut self, place: Place, new: Option<u16>) -> Option<u16> {
        match place {
            Place::Bits(class, first, count) => {
                let mut all = 0..count;
                if let Some(new) = new {
                    all.try_for_each(|bit| self.set_bit(class, first + bit, is_on(new, bit)))?;
                    return Some(new);
                }
                all.try_fold(0, |word, bit| {
                    Some(word | u16::from(self.bit(class, first + bit)?) << bit)
                })
            }
            Place::Coil(class, number) => {
                let coil = self.coil(class, number).filter(|_| new.is_none())?;
                Some(coil.into())
            }
            Place::Word(class, n) => match new {
                Some(new) => self.set_word(class, n, new as i16).map(|()| new),
                None => self.word(class, n).map(|word| word as u16),
            },
            Place::Half { counter, high } => {
                let value = self.counter32(counter)?;
                let (value, half) = half_of(value, high, new);
                if new.is_some() {
                    self.set_counter32(counter, value)?;
                }
                Some(half)
            }
        }
    }
}

/// Returns true if a bit of a word is on.
fn is_on(word: u16, bit: u32) -> bool {
    word >> bit & 1 == 1
}

/// The value of a counter with a new half, if there is one, and that half.
fn half_of(value: i32, high: bool, new: Option<u16>) -> (i32, u16) {
    let mut halves = words(value);
    let half = &mut halves[usize::from(high)];
    if let Some(new) = new {
        *half = new as i16;
    }
    let half = *half as u16;
    (pair(halves[0], halves[1]), half)
}

/// A device where it is stored.
#[derive(Debug)]
pub enum Element<'a> {
    /// A relay.
    Bit(&'a mut bool),
    /// A relay that is stored as the number 0 or 1.
    Number(&'a mut u8),
    /// A register.
    Word(&'a mut i16),
    /// A timer.
    Timer(&'a mut Timer),
    /// A counter of 16 bits.
    Counter16(&'a mut Counter16),
    /// A counter of 32 bits.
    Counter32(&'a mut Counter32),
}

impl Element<'_> {
    /// Reads its state, for T and C the contact, after it has switched to `new`, if that is given; `None` if it has
    /// none.
    fn exchange_bit(self, new: Option<bool>) -> Option<bool> {
        let place = match self {
            Element::Bit(bit) => bit,
            Element::Timer(timer) => &mut timer.done,
            Element::Counter16(counter) => &mut counter.done,
            Element::Counter32(counter) => &mut counter.done,
            Element::Number(number) => {
                *number = new.map_or(*number, u8::from);
                return Some(*number != 0);
            }
            Element::Word(_) => return None,
        };
        *place = new.unwrap_or(*place);
        Some(*place)
    }

    /// State of the coil of a timer or counter.
    fn coil(self) -> Option<bool> {
        match self {
            Element::Timer(timer) => Some(timer.coil != 0),
            Element::Counter16(counter) => Some(counter.coil),
            Element::Counter32(counter) => Some(counter.coil),
            Element::Bit(_) | Element::Number(_) | Element::Word(_) => None,
        }
    }

    /// As [`Element::exchange_bit`], of its 16-bit value.
    fn exchange_word(self, new: Option<u16>) -> Option<u16> {
        let place = match self {
            Element::Word(word) => word,
            Element::Timer(timer) => &mut timer.value,
            Element::Counter16(counter) => &mut counter.value,
            Element::Bit(_) | Element::Number(_) | Element::Counter32(_) => return None,
        };
        *place = new.map_or(*place, |new| new as i16);
        Some(*place as u16)
    }
}

/// The devices that a program stores, for what asks for no others.
pub trait Elements {
    /// A device where it is stored; `None` if it is not.
    fn element(&mut self, class: Class, number: u32) -> Option<Element<'_>>;
}

/// The places of a slave that serves what a program stores: less code than devices of all kinds need that a [`Map`]
/// knows.
pub(super) struct ByElement<'a, E>(pub(super) &'a mut E);

impl<E: Elements> Places for ByElement<'_, E> {
    fn exchange(&mut self, place: Place, new: Option<u16>) -> Option<u16> {
        let (class, first, count) = match place {
            Place::Bits(class, first, count) => (class, first, count),
            Place::Word(class, number) | Place::Coil(class, number) => (class, number, 1),
            Place::Half { counter, .. } => (Class::C, counter, 1),
        };
        let mut word = 0;
        for bit in 0..count {
            let element = self.0.element(class, first + bit)?;
            word |= match (place, element) {
                (Place::Bits(..), element) => {
                    let on = element.exchange_bit(new.map(|new| is_on(new, bit)))?;
                    u16::from(on) << bit
                }
                (Place::Word(..), element) => element.exchange_word(new)?,
                (Place::Coil(..), element) => element.coil().filter(|_| new.is_none())?.into(),
                (Place::Half { high, .. }, Element::Counter32(counter)) => {
                    let (value, half) = half_of(counter.value, high, new);
                    counter.value = value;
                    half
                }
                (Place::Half { .. }, _) => return None,
            };
        }
        Some(word)
    }
}
