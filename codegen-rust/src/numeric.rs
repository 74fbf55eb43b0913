//! Bits in arrays of columns are numbers, 0 or 1: with `bool` compilers make slower loops of them.

use crate::expr::Code;
use crate::generate::Generator;
use crate::storage::PrintStorage;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use rungc_emit::logic;
use rungc_emit::temps::Home;
use rungc_ir::node::{Expr, ExprId, Place, TempId};
use rungc_syntax::DeviceClass;

impl Generator<'_> {
    /// Returns true if a `Bit` is written as a number: one from an array of columns, or made of such.
    pub(crate) fn is_numeric(&self, id: ExprId) -> bool {
        let known = |e: ExprId| {
            let is_named = self.named.contains_key(&e);
            if let Expr::Temp(temp) = *self.module.expr(e) {
                return Some(!is_named && self.numeric_temps.contains(&temp));
            }
            let Some(place) = self.module.expr(e).as_bit() else {
                return is_named.then_some(false);
            };
            let is_numeric = self.storage.is_numeric_bit(place.class, place.number);
            Some(!is_named && (is_numeric || self.is_invariant(place)))
        };
        !self.module.layout.grids.is_empty() && logic::is_number(self.module, id, &known)
    }

    /// A `Bit` as a number.
    pub(crate) fn numeric(&mut self, id: ExprId) -> Code {
        let is_numeric = self.is_numeric(id);
        match (*self.module.expr(id), is_numeric) {
            (Expr::Bit(value), _) => literal(value),
            (Expr::And(a, b), true) => Code::binary("&", self.numeric(a), self.numeric(b)),
            (Expr::Or(a, b), true) => Code::binary("|", self.numeric(a), self.numeric(b)),
            (Expr::Not(a), true) => Code::binary("^", self.numeric(a), literal(true)),
            (Expr::Temp(temp), true) => Code::atom(self.temp_place(temp)),
            (expr, _) => match expr.as_bit().filter(|_| is_numeric) {
                Some(place) => Code::atom(self.numeric_cell(place).unwrap_or_default()),
                None => {
                    let bit = self.expr(id);
                    Code::atom(quote!(u8::from(#bit)))
                }
            },
        }
    }

    /// Numbers for the bits that a loop over stations reads before its first iteration.
    pub(crate) fn invariant_lets(&self) -> TokenStream {
        let lets = self.invariants.iter().filter_map(|&(class, number)| {
            let cell = self.storage.bit(&quote!(plc), class, number)?;
            let name = invariant_name(class, number);
            Some(quote!(let #name = u8::from(#cell);))
        });
        lets.collect()
    }

    fn is_invariant(&self, place: Place) -> bool {
        place.index.is_none() && self.invariants.contains(&(place.class, place.number))
    }

    /// Location of a bit that is stored as a number.
    pub(crate) fn numeric_cell(&mut self, place: Place) -> Option<TokenStream> {
        if self.is_invariant(place) {
            return Some(invariant_name(place.class, place.number).into_token_stream());
        }
        let is_number = self.storage.is_numeric_bit(place.class, place.number);
        self.bit_cell(place).filter(|_| is_number)
    }

    /// A number as a `Bit`: whether it is on.
    pub fn is_on(number: TokenStream) -> Code {
        Code::binary("!=", Code::atom(number), literal(false))
    }

    /// Gives a temporary of a loop over rungs a number, if its value is one; false if not.
    pub(crate) fn assigns_level(&mut self, temp: TempId, value: ExprId) -> bool {
        let is_constant = self.plan.temp(temp).home() == Home::Constant;
        let is = self.in_station_loop && is_constant && self.is_numeric(value);
        if is {
            self.numeric_temps.insert(temp);
        }
        is
    }
}

fn invariant_name(class: DeviceClass, number: u32) -> Ident {
    format_ident!("{}", class.number(number).to_string().to_lowercase())
}

fn literal(on: bool) -> Code {
    Code::atom(Literal::u8_unsuffixed(on.into()).into_token_stream())
}
