//! Blocks of a step ladder that a scan leaves out while their states are off.

use crate::format::Body;
use crate::generate::Generator;
use crate::storage::{PrintField, PrintStorage};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use rungc_emit::plan::Node;
use rungc_emit::storage::At;
use rungc_ir::node::Steps;
use rungc_syntax::DeviceClass::S;

impl Generator<'_> {
    /// Blocks and their test.
    pub(crate) fn steps(&mut self, body: &mut Body, of: &Steps, inner: &[Node]) {
        let test = match of.states {
            1 => self.test_of_one(of),
            _ => self.test_of_many(of),
        };
        let inner = self.nodes(inner);
        body.block(quote!(if #test), inner);
    }

    fn test_of_one(&self, of: &Steps) -> TokenStream {
        let plc = quote!(plc);
        let state = self.storage.bit(&plc, S, of.first).unwrap_or_default();
        let state = match self.storage.is_numeric_bit(S, of.first) {
            true => quote!((#state != 0)),
            false => state,
        };
        let memories = (of.memory.0..of.memory.0 + of.memories).map(|memory| {
            let memory = Literal::u32_unsuffixed(memory);
            quote!(| plc.edges[#memory].0)
        });
        quote!(#state #(#memories)*)
    }

    fn test_of_many(&mut self, of: &Steps) -> TokenStream {
        let Some(field) = self.storage.find(S, of.first) else {
            return quote!(true);
        };
        let name = field.name();
        let begin = match field.at(of.first) {
            At::Element(n) => n,
            At::Field | At::Column { .. } => return quote!(true),
        };
        let [begin, end, first, last] = [
            begin,
            begin + of.states,
            of.memory.0,
            of.memory.0 + of.memories,
        ]
        .map(Literal::u32_unsuffixed);
        let any = self.rt("any_active");
        quote!(#any(&plc.#name[#begin..#end], &plc.edges[#first..#last]))
    }
}
