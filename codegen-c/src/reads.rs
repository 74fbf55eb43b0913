//! Reads of devices, as C.

use crate::code::Code;
use crate::expr::Around;
use crate::fields::{PrintField, PrintStorage};
use crate::writer::Writer;
use rungc_emit::bounds;
use rungc_ir::node::{Access, AccessKind, Expr, Place};
use rungc_models::runs::is_counter32;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

impl Writer<'_, '_> {
    /// Writes the value that an access reads.
    pub fn read(&mut self, out: &mut Code, access: &Access, around: Around) {
        let place = &access.place;
        match access.kind {
            AccessKind::Bit => self.bit(out, place),
            AccessKind::WordBit(bit) => {
                self.call_in(out).open("plc_bit(");
                self.word(out, place);
                out.argument(format_args!("{bit}u"));
                out.close(")");
            }
            AccessKind::Word => self.word(out, place),
            AccessKind::Pair => self.pair(out, place),
            AccessKind::Float => {
                self.call_in(out).open("plc_float(");
                self.pair(out, place);
                out.close(")");
            }
            // A group of less than 16 bits is what it is as an `int`, too.
            AccessKind::Nibbles { digits, wide }
                if !wide && (digits == 4 || around == Around::Exact) =>
            {
                self.call_in(out).open("plc_low(");
                self.nibbles(out, place, access.extent());
                out.close(")");
            }
            AccessKind::Nibbles { .. } => self.nibbles(out, place, access.extent()),
        }
    }

    fn bit(&mut self, out: &mut Code, place: &Place) {
        if self.loop_invariant(out.text(), place) {
            return;
        }
        let is_found = self.access_by_index(out, place);
        if place.index.is_some() && !is_found {
            return self.indexed_call(out, "bit", place);
        }
        if !is_found && !self.fields.access(out.text(), place.class, place.number) {
            out.push_str("false");
        } else if matches!(place.class, DeviceClass::T | DeviceClass::C) {
            out.push_str(".done");
        }
    }

    /// Writes the expression of a device of the current iteration of a loop; false for any other.
    pub(crate) fn access_iteration(&self, out: &mut String, place: &Place) -> bool {
        match place.index.map(|index| self.module.expr(index)) {
            Some(&Expr::Stride(_, by)) => {
                self.fields
                    .access_iteration(out, (place.class, place.number), by, &self.iteration)
            }
            _ => false,
        }
    }

    /// Writes the expression of a device of the current iteration of a loop, or that an index leads to in an array
    /// known to hold it; false for any other.
    pub(crate) fn access_by_index(&mut self, out: &mut Code, place: &Place) -> bool {
        if self.access_iteration(out.text(), place) {
            return true;
        }
        let fields = self.fields;
        let (Some(index), Some((field, more))) =
            (place.index, bounds::array(self.module, fields, place))
        else {
            return false;
        };
        out.push_str("plc->");
        field.name(out.text());
        out.push_str("[");
        match more {
            0 => self.expr(out, index, Around::Exact),
            1.. => {
                let _ = write!(out.text(), "{more} + ");
                self.expr(out, index, Around::Operand("+"));
            }
            _ => {
                self.expr(out, index, Around::Operand("-"));
                let _ = write!(out.text(), " - {}", -more);
            }
        }
        out.push_str("]");
        true
    }

    fn word(&mut self, out: &mut Code, place: &Place) {
        let is_found = self.access_by_index(out, place);
        if place.index.is_some() && !is_found {
            return self.indexed_call(out, "word", place);
        }
        if !is_found && !self.fields.access(out.text(), place.class, place.number) {
            out.push_str("0");
        } else if matches!(place.class, DeviceClass::T | DeviceClass::C) {
            out.push_str(".value");
        }
    }

    fn pair(&mut self, out: &mut Code, place: &Place) {
        let of_iteration = self.access_iteration(&mut String::new(), place);
        if place.index.is_some() && !of_iteration {
            return self.indexed_call(out, "long", place);
        }
        if is_counter32(place.class, place.number) {
            return self.word(out, place);
        }
        self.call_in(out).open("plc_join(");
        self.word(out, &place.high_word(self.module.model));
        out.comma();
        self.word(out, place);
        out.close(")");
    }

    fn nibbles(&mut self, out: &mut Code, place: &Place, count: u32) {
        if place.index.is_some() {
            self.helpers.bits(place.class);
            let class = place.class.prefix();
            let _ = write!(
                self.call_in(out).text(),
                "{}_bits_{class}",
                self.module.name
            );
            out.open("(plc");
            out.comma();
            self.number(out, place);
            out.argument(format_args!("{count}u"));
            out.close(")");
        } else if self
            .fields
            .array(place.class, place.number, count)
            .is_some()
        {
            self.call_in(out).open("plc_bits(&");
            self.fields.access(out.text(), place.class, place.number);
            out.argument(format_args!("{count}u"));
            out.close(")");
        } else {
            // Relays that are not an array: their states side by side.
            self.call_in(out).open("plc_bits(");
            out.open("(const bool[]){");
            for bit in 0..count {
                if bit > 0 {
                    out.comma();
                }
                self.bit(
                    out,
                    &Place {
                        number: place.number + bit,
                        ..*place
                    },
                );
            }
            out.close("}");
            out.argument(format_args!("{count}u"));
            out.close(")");
        }
    }

    /// A read through the program's function for indexed access.
    fn indexed_call(&mut self, out: &mut Code, what: &'static str, place: &Place) {
        self.helpers.get(what, place.class);
        let class = place.class.prefix();
        let _ = write!(
            self.call_in(out).text(),
            "{}_{what}_{class}",
            self.module.name
        );
        out.open("(plc");
        out.comma();
        self.number(out, place);
        out.close(")");
    }
}
