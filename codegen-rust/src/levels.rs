//! Bits in arrays of columns are numbers, 0 or 1: with `bool` compilers make slower loops of them.

use crate::analysis::{self, Declared};
use crate::expr::Code;
use crate::generate::Generator;
use crate::storage::PrintStorage;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use rungc_emit::storage::Kind;
use rungc_ir::node::{Expr, ExprId, Place, Stmt, TempId};
use rungc_syntax::DeviceClass;
use std::collections::HashSet;

impl Generator<'_> {
    /// Whether a `Bit` is written as a number: one from an array of columns, or made of such.
    pub fn is_level(&self, id: ExprId) -> bool {
        if self.module.layout.grids.is_empty() || self.hoisted(id).is_some() {
            return false;
        }
        match *self.module.expr(id) {
            Expr::ReadBit(place) => {
                self.storage.is_level(place.class, place.number) || self.is_constant(place)
            }
            Expr::Temp(temp) => self.levels.contains(&temp),
            Expr::Not(a) => self.is_level(a),
            Expr::And(a, b) | Expr::Or(a, b) => self.is_level(a) || self.is_level(b),
            _ => false,
        }
    }

    /// A `Bit` as a number.
    pub fn level(&mut self, id: ExprId) -> Code {
        match *self.module.expr(id) {
            Expr::Bit(value) => literal(value),
            Expr::And(a, b) if self.is_level(id) => Code::binary("&", self.level(a), self.level(b)),
            Expr::Or(a, b) if self.is_level(id) => Code::binary("|", self.level(a), self.level(b)),
            Expr::Not(a) if self.is_level(id) => Code::binary("^", self.level(a), literal(true)),
            Expr::Temp(temp) if self.is_level(id) => {
                Code::atom(self.temp_name(temp).into_token_stream())
            }
            Expr::ReadBit(place) if self.is_level(id) => {
                Code::atom(self.level_cell(place).unwrap_or_default())
            }
            _ => {
                let bit = self.expr(id);
                Code::atom(quote!(u8::from(#bit)))
            }
        }
    }

    /// Numbers for the bits that a loop over rungs only reads, and that are the same in all of its rounds. They are read before it:
    /// compilers would do so in each round if these bits stand behind an array in memory.
    pub fn constants(&mut self, body: &[Stmt]) -> TokenStream {
        let mut written = HashSet::new();
        let mut roots = Vec::new();
        rungc_ir::walk::statements(body, &mut |stmt| {
            if let Stmt::WriteBit(place, _) = stmt {
                written.insert((place.class, place.number));
            }
            roots.extend(analysis::expressions(stmt));
        });
        let mut devices: Vec<_> = analysis::reachable(self.module, &roots)
            .into_iter()
            .filter_map(|id| match *self.module.expr(id) {
                Expr::ReadBit(place) if place.index.is_none() => Some((place.class, place.number)),
                _ => None,
            })
            .filter(|device| !written.contains(device))
            .filter(|&(class, number)| {
                let field = self.storage.find(class, number);
                field.is_some_and(|field| field.kind == Kind::Bit)
            })
            .collect();
        devices.sort_unstable();
        devices.dedup();
        let lets = devices.iter().filter_map(|&(class, number)| {
            let cell = self.storage.bit(&quote!(plc), class, number)?;
            let name = constant_name(class, number);
            Some(quote!(let #name = u8::from(#cell);))
        });
        let lets = lets.collect();
        self.constants.extend(devices);
        lets
    }

    fn is_constant(&self, place: Place) -> bool {
        place.index.is_none() && self.constants.contains(&(place.class, place.number))
    }

    /// Where a bit is that is stored as a number.
    pub fn level_cell(&self, place: Place) -> Option<TokenStream> {
        if self.is_constant(place) {
            return Some(constant_name(place.class, place.number).into_token_stream());
        }
        let cell = self.bit_cell(place)?;
        self.storage
            .is_level(place.class, place.number)
            .then_some(cell)
    }

    /// A number as a `Bit`: whether it is on.
    pub fn is_on(level: TokenStream) -> Code {
        Code::binary("!=", Code::atom(level), literal(false))
    }

    /// Gives a temporary of a loop over rungs a number, if its value is one; false if not.
    pub fn assigns_level(&mut self, temp: TempId, value: ExprId) -> bool {
        let once = Some(Declared::There { again: false });
        let is = self.in_rounds && self.temps.declared(temp) == once && self.is_level(value);
        if is {
            self.levels.insert(temp);
        }
        is
    }
}

fn constant_name(class: DeviceClass, number: u32) -> Ident {
    format_ident!("{}", class.number(number).to_string().to_lowercase())
}

fn literal(on: bool) -> Code {
    Code::atom(Literal::u8_unsuffixed(on.into()).into_token_stream())
}
