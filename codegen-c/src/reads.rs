//! Reads of devices, as C.

use crate::expr::Around;
use crate::fields::PrintStorage;
use crate::writer::Writer;
use rungc_ir::node::{Access, AccessKind, Expr, Place};
use rungc_models::runs::is_counter32;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

impl Writer<'_, '_> {
    /// Writes the value that an access reads.
    pub(crate) fn read(&mut self, out: &mut String, access: &Access, around: Around) {
        let place = &access.place;
        match access.kind {
            AccessKind::Bit => self.bit(out, place),
            AccessKind::WordBit(bit) => {
                self.call_in(out).push_str("plc_bit(");
                self.word(out, place);
                let _ = write!(out, ", {bit}u)");
            }
            AccessKind::Word => self.word(out, place),
            AccessKind::Pair => self.pair(out, place),
            AccessKind::Float => {
                self.call_in(out).push_str("plc_float(");
                self.pair(out, place);
                out.push(')');
            }
            // A group of less than 16 bits is what it is as an `int`, too.
            AccessKind::Nibbles { digits, wide }
                if !wide && (digits == 4 || around == Around::Exact) =>
            {
                self.call_in(out).push_str("plc_low(");
                self.nibbles(out, place, access.extent());
                out.push(')');
            }
            AccessKind::Nibbles { .. } => self.nibbles(out, place, access.extent()),
        }
    }

    fn bit(&mut self, out: &mut String, place: &Place) {
        if self.loop_invariant(out, place) {
            return;
        }
        let of_iteration = self.access_iteration(out, place);
        if place.index.is_some() && !of_iteration {
            return self.indexed_call(out, "bit", place);
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

    fn word(&mut self, out: &mut String, place: &Place) {
        let of_iteration = self.access_iteration(out, place);
        if place.index.is_some() && !of_iteration {
            return self.indexed_call(out, "word", place);
        }
        if !of_iteration && !self.fields.access(out, place.class, place.number) {
            out.push('0');
        } else if matches!(place.class, DeviceClass::T | DeviceClass::C) {
            out.push_str(".value");
        }
    }

    fn pair(&mut self, out: &mut String, place: &Place) {
        if place.index.is_some() && place.class == DeviceClass::C {
            return self.indexed_call(out, "long", place);
        }
        if is_counter32(place.class, place.number) {
            return self.word(out, place);
        }
        self.call_in(out).push_str("plc_join(");
        self.word(out, &place.high_word(self.module.model));
        out.push_str(", ");
        self.word(out, place);
        out.push(')');
    }

    fn nibbles(&mut self, out: &mut String, place: &Place, count: u32) {
        if place.index.is_some() {
            self.helpers.bits(place.class);
            let _ = write!(
                self.call_in(out),
                "{}_bits_{}(plc, ",
                self.module.name,
                place.class.prefix()
            );
            self.number(out, place);
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
                self.bit(
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
    fn indexed_call(&mut self, out: &mut String, what: &'static str, place: &Place) {
        self.helpers.get(what, place.class);
        let _ = write!(
            self.call_in(out),
            "{}_{what}_{}(plc, ",
            self.module.name,
            place.class.prefix()
        );
        self.number(out, place);
        out.push(')');
    }
}
