//! Reads of devices, as C.

use crate::expr::Around;
use crate::fields::PrintStorage;
use crate::writer::Writer;
use rungc_ir::node::{Expr, Place};
use rungc_models::runs::is_counter32;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

impl Writer<'_, '_> {
    pub(crate) fn bit_of_word(&mut self, out: &mut String, place: &Place, bit: u8) {
        self.call_in(out).push_str("plc_bit(");
        self.word(out, place, 0);
        let _ = write!(out, ", {bit}u)");
    }

    pub(crate) fn float_pair(&mut self, out: &mut String, place: &Place) {
        self.call_in(out).push_str("plc_float(");
        self.pair(out, place);
        out.push(')');
    }

    /// A group of bits as a number: its number of digits, and whether it has 32 bits in any case.
    pub(crate) fn group(
        &mut self,
        out: &mut String,
        place: &Place,
        (digits, wide): (u8, bool),
        around: Around,
    ) {
        let narrow = !wide && digits <= 4;
        if narrow && (digits == 4 || around == Around::Exact) {
            self.call_in(out).push_str("plc_low(");
            self.nibbles(out, place, digits);
            out.push(')');
        } else {
            self.nibbles(out, place, digits);
        }
    }

    pub(crate) fn read_bit(&mut self, out: &mut String, place: &Place) {
        if self.loop_invariant(out, place) {
            return;
        }
        let of_iteration = self.access_iteration(out, place);
        if place.index.is_some() && !of_iteration {
            return self.indexed_call(out, "bit", place, 0);
        }
        if !of_iteration && !self.fields.access(out, place.class, place.number) {
            out.push_str("false");
        } else if matches!(place.class, DeviceClass::T | DeviceClass::C) {
            out.push_str(".done");
        }
    }

    /// Writes the expression of a device of the current iteration of a loop; false for any other.
    pub fn access_iteration(&self, out: &mut String, place: &Place) -> bool {
        match place.index.map(|index| self.module.expr(index)) {
            Some(&Expr::Stride(_, by)) => {
                self.fields
                    .access_iteration(out, (place.class, place.number), by, &self.iteration)
            }
            _ => false,
        }
    }

    /// Reads the word `plus` places after `place`.
    pub fn word(&mut self, out: &mut String, place: &Place, plus: i32) {
        let of_iteration = plus == 0 && self.access_iteration(out, place);
        if place.index.is_some() && !of_iteration {
            return self.indexed_call(out, "word", place, plus);
        }
        let number = place.number.saturating_add_signed(plus);
        if !of_iteration && !self.fields.access(out, place.class, number) {
            out.push('0');
        } else if matches!(place.class, DeviceClass::T | DeviceClass::C) {
            out.push_str(".value");
        }
    }

    /// Where the high word of a pair is.
    pub fn high_word(&self, place: &Place) -> (Place, i32) {
        if place.class == DeviceClass::Z && self.module.model.z_pairs_with_v {
            (
                Place {
                    class: DeviceClass::V,
                    ..*place
                },
                0,
            )
        } else {
            (*place, 1)
        }
    }

    pub(crate) fn pair(&mut self, out: &mut String, place: &Place) {
        if place.index.is_some() && place.class == DeviceClass::C {
            return self.indexed_call(out, "long", place, 0);
        }
        if is_counter32(place.class, place.number) {
            return self.word(out, place, 0);
        }
        let (high, plus) = self.high_word(place);
        self.call_in(out).push_str("plc_join(");
        self.word(out, &high, plus);
        out.push_str(", ");
        self.word(out, place, 0);
        out.push(')');
    }

    fn nibbles(&mut self, out: &mut String, place: &Place, digits: u8) {
        let count = 4 * u32::from(digits);
        if place.index.is_some() {
            self.helpers.bits(place.class);
            let _ = write!(
                self.call_in(out),
                "{}_bits_{}(plc, ",
                self.module.name,
                place.class.prefix()
            );
            self.number(out, place, 0);
            let _ = write!(out, ", {count}u)");
        } else if self
            .fields
            .array(place.class, place.number, count)
            .is_some()
        {
            self.call_in(out).push_str("plc_bits(&");
            self.fields.access(out, place.class, place.number);
            let _ = write!(out, ", {count}u)");
        } else {
            // Relays that are not an array: their states side by side.
            self.call_in(out).push_str("plc_bits((const bool[]){");
            for bit in 0..count {
                out.push_str(if bit > 0 { ", " } else { "" });
                self.read_bit(
                    out,
                    &Place {
                        number: place.number + bit,
                        ..*place
                    },
                );
            }
            let _ = write!(out, "}}, {count}u)");
        }
    }

    /// A read through the program's function for indexed access.
    fn indexed_call(&mut self, out: &mut String, what: &'static str, place: &Place, plus: i32) {
        self.helpers.get(what, place.class);
        let _ = write!(
            self.call_in(out),
            "{}_{what}_{}(plc, ",
            self.module.name,
            place.class.prefix()
        );
        self.number(out, place, plus);
        out.push(')');
    }
}
