//! Access to a device by a number that is only known at run time.

use crate::plc::{Class, Plc};
use crate::runs::FIRST_COUNTER32;
use crate::word;

fn is_counter32(class: Class, number: i32) -> bool {
    class == Class::C && number >= FIRST_COUNTER32 as i32
}

/// Copies devices number 0 to `count` of a block, from the last on if the others come after those that are read.
fn in_order(from: (Class, i32), to: (Class, i32), count: i32, mut copy: impl FnMut(i32)) {
    if from.0 == to.0 && to.1 > from.1 {
        (0..count).rev().for_each(copy);
    } else {
        (0..count).for_each(&mut copy);
    }
}

/// Access to indexed devices in emitted Rust. It asks whether they exist before; where one does not, a read gives 0 and
/// a write is lost.
pub trait Access: Plc {
    /// State of a bit device.
    fn bit_at(&self, class: Class, number: i32) -> bool {
        self.bit(class, number as u32).unwrap_or(false)
    }

    /// Sets a bit device.
    fn set_bit_at(&mut self, class: Class, number: i32, value: bool) {
        let _ = self.set_bit(class, number as u32, value);
    }

    /// Value of a word device; of a 32-bit counter the low word.
    fn word_at(&self, class: Class, number: i32) -> i16 {
        if is_counter32(class, number) {
            return self.counter32(number as u32).unwrap_or(0) as i16;
        }
        self.word(class, number as u32).unwrap_or(0)
    }

    /// Sets a word device; a 32-bit counter takes the sign-extended word.
    fn set_word_at(&mut self, class: Class, number: i32, value: i16) {
        if is_counter32(class, number) {
            let _ = self.set_counter32(number as u32, value.into());
            return;
        }
        let _ = self.set_word(class, number as u32, value);
    }

    /// Copies `count` words to others, as if all were read before one is written; each is named by its class and its
    /// number.
    fn copy_words_at(&mut self, from: (Class, i32), to: (Class, i32), count: i32) {
        in_order(from, to, count, |k| {
            let value = self.word_at(from.0, from.1.wrapping_add(k));
            self.set_word_at(to.0, to.1.wrapping_add(k), value);
        });
    }

    /// Copies bits likewise.
    fn copy_bits_at(&mut self, from: (Class, i32), to: (Class, i32), count: i32) {
        in_order(from, to, count, |k| {
            let value = self.bit_at(from.0, from.1.wrapping_add(k));
            self.set_bit_at(to.0, to.1.wrapping_add(k), value);
        });
    }

    /// Sets `count` words.
    fn fill_words_at(&mut self, class: Class, number: i32, count: i32, value: i16) {
        (0..count).for_each(|k| self.set_word_at(class, number.wrapping_add(k), value));
    }

    /// Sets `count` bits.
    fn fill_bits_at(&mut self, class: Class, number: i32, count: i32, value: bool) {
        (0..count).for_each(|k| self.set_bit_at(class, number.wrapping_add(k), value));
    }

    /// Resets a timer or counter.
    fn reset_at(&mut self, class: Class, number: i32) {
        let _ = self.reset(class, number as u32);
    }

    /// Value of a pair or a 32-bit counter.
    fn pair_at(&self, class: Class, number: i32) -> i32 {
        if is_counter32(class, number) {
            return self.counter32(number as u32).unwrap_or(0);
        }
        let (high_class, high) = self.high_word(class, number);
        word::pair(self.word_at(class, number), self.word_at(high_class, high))
    }

    /// Sets a pair or a 32-bit counter.
    fn set_pair_at(&mut self, class: Class, number: i32, value: i32) {
        if is_counter32(class, number) {
            let _ = self.set_counter32(number as u32, value);
            return;
        }
        let (high_class, high) = self.high_word(class, number);
        let words = word::words(value);
        self.set_word_at(class, number, words[0]);
        self.set_word_at(high_class, high, words[1]);
    }

    /// The float in a pair.
    fn float_at(&self, class: Class, number: i32) -> f32 {
        f32::from_bits(self.pair_at(class, number) as u32)
    }

    /// Sets a float.
    fn set_float_at(&mut self, class: Class, number: i32, value: f32) {
        self.set_pair_at(class, number, value.to_bits() as i32);
    }

    /// `4 * digits` bits from a bit device on.
    fn nibbles_at(&self, digits: u8, class: Class, number: i32) -> i32 {
        let bits = 0..4 * i32::from(digits.min(8));
        bits.rev().fold(0, |value, bit| {
            value << 1 | i32::from(self.bit_at(class, number.wrapping_add(bit)))
        })
    }

    /// Sets `4 * digits` bits from a bit device on.
    fn set_nibbles_at(&mut self, digits: u8, class: Class, number: i32, value: i32) {
        for bit in 0..4 * i32::from(digits.min(8)) {
            self.set_bit_at(class, number.wrapping_add(bit), value >> bit & 1 == 1);
        }
    }

    /// The device that holds the high word of a pair.
    fn high_word(&self, class: Class, number: i32) -> (Class, i32) {
        if class == Class::Z && self.z_pairs_with_v() {
            (Class::V, number)
        } else {
            (class, number.wrapping_add(1))
        }
    }
}

impl<P: Plc + ?Sized> Access for P {}
