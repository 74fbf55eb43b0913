//! Writes of devices.

use crate::expr::{Code, Shape};
use crate::generate::Generator;
use crate::storage::PrintStorage;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_ir::node::{Access, AccessKind, Expr, ExprId, Place, Ty};

impl Generator<'_> {
    /// `target = value;`, or `target |= …;` where the value is made of what the place holds.
    fn assign(
        &mut self,
        target: TokenStream,
        value: Code,
        place: Place,
        of: ExprId,
    ) -> TokenStream {
        let (Shape::Binary(op), Some(operands)) = (value.shape, &value.operands) else {
            return quote!(#target = #value;);
        };
        let holds = |e: ExprId| self.is_value_of(e, place);
        let commutes = matches!(op, "&" | "|" | "^");
        let (Expr::And(a, b) | Expr::Or(a, b) | Expr::Bin(_, a, b)) = *self.module.expr(of) else {
            return quote!(#target = #value;);
        };
        let rest = if holds(a) {
            Some(&operands.1)
        } else if commutes && holds(b) {
            Some(&operands.0)
        } else {
            None
        };
        let rest = rest.map(|rest| &rest.tokens);
        match (op, rest) {
            ("&", Some(rest)) => quote!(#target &= #rest;),
            ("|", Some(rest)) => quote!(#target |= #rest;),
            ("^", Some(rest)) => quote!(#target ^= #rest;),
            ("/", Some(rest)) => quote!(#target /= #rest;),
            ("%", Some(rest)) => quote!(#target %= #rest;),
            _ => quote!(#target = #value;),
        }
    }

    /// Returns true if an expression reads this place, and is written as such.
    fn is_value_of(&self, e: ExprId, place: Place) -> bool {
        let Expr::Read(Access {
            place: read,
            kind: AccessKind::Bit | AccessKind::Word | AccessKind::Pair,
        }) = *self.module.expr(e)
        else {
            return false;
        };
        let index = |place: Place| place.index.map(|index| self.module.expr(index));
        let device = |place: Place| (place.class, place.number);
        !self.named.contains_key(&e) && device(read) == device(place) && index(read) == index(place)
    }

    /// Writes a value; nothing where no device is stored.
    pub fn write(&mut self, Access { place, kind }: Access, value: ExprId) -> TokenStream {
        match kind {
            AccessKind::Bit => self.write_bit(place, value),
            AccessKind::WordBit(bit) => self.write_word_bit(place, bit, value),
            AccessKind::Word => self.write_word(place, value),
            AccessKind::Pair => self.write_pair(place, value),
            AccessKind::Float => self.write_words(place, value, ("float_words", "set_float_at")),
            AccessKind::Nibbles { digits, .. } => self.write_nibbles(place, digits, value),
        }
    }

    /// Writes a bit; nothing for a special device that nothing reads, which is not stored.
    fn write_bit(&mut self, place: Place, value: ExprId) -> TokenStream {
        match self.bit_cell(place) {
            Some(cell) => {
                let code = match self.storage.is_numeric_bit(place.class, place.number) {
                    true => self.numeric(value),
                    false => self.expr(value),
                };
                self.assign(cell, code, place, value)
            }
            None if place.index.is_some() => {
                let value = self.expr(value);
                self.set_indexed("set_bit_at", place, quote!(#value))
            }
            None => TokenStream::new(),
        }
    }

    /// Writes a word likewise.
    fn write_word(&mut self, place: Place, value: ExprId) -> TokenStream {
        let plc = quote!(plc);
        if let Some(cell) = self.word_cell(place) {
            let code = self.expr(value);
            return self.assign(cell, code, place, value);
        }
        if place.index.is_some() {
            let value = self.expr(value);
            return self.set_indexed("set_word_at", place, quote!(#value));
        }
        match self.storage.counter32(&plc, place.class, place.number) {
            Some(counter) => {
                let value = self.typed(value);
                quote!(#counter = i32::from(#value);)
            }
            None => TokenStream::new(),
        }
    }

    /// Writes a bit of a word.
    fn write_word_bit(&mut self, place: Place, bit: u8, value: ExprId) -> TokenStream {
        let cell = self.storage.word(&quote!(plc), place.class, place.number);
        let cell = cell.filter(|_| place.index.is_none());
        if cell.is_none() && place.index.is_none() {
            return TokenStream::new();
        }
        let value = self.expr(value);
        let word = self.read_word(place);
        let with_bit = self.word_function("with_bit");
        let bit = Literal::u8_unsuffixed(bit);
        let value = quote!(#with_bit(#word, #bit, #value));
        match cell {
            Some(cell) => quote!(#cell = #value;),
            None => self.set_indexed("set_word_at", place, value),
        }
    }

    /// Writes a pair of words, or a 32-bit counter.
    fn write_pair(&mut self, place: Place, value: ExprId) -> TokenStream {
        let counter = self
            .storage
            .counter32(&quote!(plc), place.class, place.number);
        match counter.filter(|_| place.index.is_none()) {
            Some(counter) => {
                let code = self.expr(value);
                self.assign(counter, code, place, value)
            }
            None => self.write_words(place, value, ("words", "set_pair_at")),
        }
    }

    /// Writes a pair with the function of `rungc_rt::word` that makes words of the value, or with the method for
    /// indexed ones.
    fn write_words(
        &mut self,
        place: Place,
        value: ExprId,
        (function, method): (&'static str, &str),
    ) -> TokenStream {
        if place.index.is_some() {
            let value = self.expr(value);
            return self.set_indexed(method, place, quote!(#value));
        }
        let plc = quote!(plc);
        let high = place.high_word(self.module.model);
        let low = self.storage.word(&plc, place.class, place.number);
        let high = self.storage.word(&plc, high.class, high.number);
        if low.is_none() && high.is_none() {
            return TokenStream::new();
        }
        let [low, high] = [low, high].map(|cell| cell.unwrap_or_else(|| quote!(_)));
        let (value, function) = (self.expr(value), self.word_function(function));
        quote!([#low, #high] = #function(#value);)
    }

    /// Writes the low bits of a number to relays.
    fn write_nibbles(&mut self, place: Place, digits: u8, value: ExprId) -> TokenStream {
        let is_narrow = self.module.ty(value) == Ty::I16;
        let value = self.typed(value);
        let value = match is_narrow {
            true => quote!(i32::from(#value)),
            false => value.tokens,
        };
        if place.index.is_some() {
            let (class, number) = self.indexed(place);
            let digits = Literal::u8_unsuffixed(digits);
            return quote!(plc.set_nibbles_at(#digits, #class, #number, #value););
        }
        let count = 4 * u32::from(digits);
        if let Some(slice) = self.array_slice(place, count) {
            let unpack_to = self.word_function("unpack_to");
            return quote!(#unpack_to(#value, &mut #slice););
        }
        let unpack = self.word_function("unpack");
        let cells = (0..count).map(|i| {
            let cell = self
                .storage
                .bit(&quote!(plc), place.class, place.number + i);
            cell.unwrap_or_else(|| quote!(_))
        });
        quote!([#(#cells),*] = #unpack(#value);)
    }

    /// A write of a device that an index leads to.
    fn set_indexed(&mut self, method: &str, place: Place, value: TokenStream) -> TokenStream {
        let method = format_ident!("{method}");
        let (class, number) = self.indexed(place);
        quote!(plc.#method(#class, #number, #value);)
    }
}
