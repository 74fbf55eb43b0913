//! Blocks of devices that are copied or filled, as Rust.

use crate::expr::literal32;
use crate::generate::Generator;
use crate::storage::PrintField;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::storage::Field;
use rungc_ir::node::{Block, Expr, Place};
use rungc_ir::reach::Footprint;
use rungc_syntax::DeviceClass;

/// Location of a block in an array.
struct Span {
    /// The array.
    field: Ident,
    /// Position of its first device in it.
    first: TokenStream,
}

impl Generator<'_> {
    /// A run of devices is copied or filled; nothing is written of one that is not stored.
    pub(crate) fn block(&mut self, block: &Block) -> TokenStream {
        let (to, count) = block.written();
        let places = [Some(to), block.source()];
        let indexed = places.iter().flatten().any(|place| place.index.is_some());
        if indexed || block.length().is_some() {
            return self.indexed_block(block);
        }
        let Some((field, range)) = self.run(to, count) else {
            return TokenStream::new();
        };
        match *block {
            Block::Copy { from, .. } => match self.run(from, count) {
                Some((source, from)) if source == field => {
                    let first = Literal::u32_unsuffixed(to.number - self.first_of(to));
                    quote!(plc.#field.copy_within(#from, #first);)
                }
                Some((source, from)) => {
                    quote!(plc.#field[#range].copy_from_slice(&plc.#source[#from]);)
                }
                None => TokenStream::new(),
            },
            Block::Fill { value, .. } => {
                let reads = !matches!(self.module.expr(value), Expr::Bit(_) | Expr::I16(_));
                let value = self.typed(value);
                match reads {
                    // It is read before the field is borrowed.
                    true => quote!({ let value = #value; plc.#field[#range].fill(value); }),
                    false => quote!(plc.#field[#range].fill(#value);),
                }
            }
        }
    }

    /// The number at which the field of a device begins.
    fn first_of(&self, place: Place) -> u32 {
        let field = self.storage.find(place.class, place.number);
        field.map_or(place.number, |field| field.first)
    }

    /// A block whose place or length is only known at run time: in one array, or device by device.
    fn indexed_block(&mut self, block: &Block) -> TokenStream {
        let (to, count) = block.written();
        let target = self.span(to, count);
        let source = block.source().map(|from| self.span(from, count));
        let length = match block.length() {
            None => literal32(count as i32, false).tokens,
            Some(length) => self.expr(length).tokens,
        };
        let value = match *block {
            Block::Fill { value, .. } => Some(self.typed(value).tokens),
            Block::Copy { .. } => None,
        };
        let (names, values, call) = match (target, source, value) {
            (Some(to), Some(Some(from)), _) => {
                let (blocks, source, target) = (self.rt("blocks"), from.field, to.field);
                let call = match source == target {
                    true => quote!(#blocks::copy_within(&mut plc.#target, from, to, count);),
                    false => {
                        quote!(#blocks::copy(&plc.#source, from, &mut plc.#target, to, count);)
                    }
                };
                (
                    quote!(from, to, count),
                    [from.first, to.first, length],
                    call,
                )
            }
            (Some(to), None, Some(value)) => {
                let (blocks, field) = (self.rt("blocks"), to.field);
                let call = quote!(#blocks::fill(&mut plc.#field, to, count, value););
                (quote!(to, count, value), [to.first, length, value], call)
            }
            (_, _, value) => return self.block_by_number(block, &length, value),
        };
        // Places, length and value are read before the arrays are borrowed.
        quote!({ let (#names) = (#(#values),*); #call })
    }

    /// A block that no single array holds.
    fn block_by_number(
        &mut self,
        block: &Block,
        length: &TokenStream,
        value: Option<TokenStream>,
    ) -> TokenStream {
        let (to, _) = block.written();
        let (class, number) = self.indexed(to);
        let words = matches!(to.class, DeviceClass::D | DeviceClass::R);
        let what = if words { "words" } else { "bits" };
        match (block.source(), value) {
            (Some(from), _) => {
                let (from_class, from) = self.indexed(from);
                let method = format_ident!("copy_{what}_at");
                quote!(plc.#method((#from_class, #from), (#class, #number), #length);)
            }
            (None, value) => {
                let method = format_ident!("fill_{what}_at");
                quote!(plc.#method(#class, #number, #length, #value);)
            }
        }
    }

    /// The array that holds all blocks which begin at a place, and where this one begins.
    fn span(&mut self, place: Place, count: u32) -> Option<Span> {
        let used = Footprint {
            place,
            count: Some(count),
            in_array: true,
            writes: false,
        };
        let runs = used.reach(self.module.model, &self.module.exprs);
        let &[(first, last)] = runs.as_slice() else {
            return None;
        };
        let mut arrays = self.storage.of_class(place.class).iter();
        let holds = |field: &&Field| {
            let whole = field.first <= first && last < field.end();
            field.array && field.grid.is_none() && whole
        };
        let field = *arrays.find(holds)?;
        let base = place.number as i32 - field.first as i32;
        let first = match place.index {
            None => literal32(base, false).tokens,
            Some(index) => self.offset(base, index),
        };
        Some(Span {
            field: field.name(),
            first,
        })
    }
}
