//! Blocks of a step ladder that a scan leaves out while their states are off.

use crate::format::{Arm, Body};
use crate::generate::Generator;
use crate::storage::{PrintField, PrintStorage};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use rungc_emit::comments;
use rungc_emit::plan::Node;
use rungc_emit::steps::{self, Case};
use rungc_emit::storage::At;
use rungc_ir::node::Steps;
use rungc_syntax::DeviceClass::S;
use std::rc::Rc;

impl Generator<'_> {
    /// Blocks: as cases, or with their test.
    pub(crate) fn steps(&mut self, body: &mut Body, of: &Steps, inner: &[Node]) {
        let plan = Rc::clone(&self.plan);
        let cases = steps::cases(self.module, &plan, of, inner);
        match cases.zip(self.ranges(of)) {
            Some((cases, ranges)) => self.cases(body, of, &cases, ranges),
            None => self.tested(body, of, inner),
        }
    }

    /// Blocks as the cases of a choice, in a loop over those that run.
    fn cases(&mut self, body: &mut Body, of: &Steps, cases: &[Case], ranges: [TokenStream; 2]) {
        let next = self.rt("next_step");
        let [states, memories] = ranges;
        let mut arms = Vec::new();
        for ((n, case), state) in (0_usize..).zip(cases).zip(of.first..) {
            let mut arm = Body::default();
            if let Some(network) = case.network {
                self.heading(&mut arm, network);
            }
            if let Some(on) = case.on {
                arm.code(self.statement(on));
            }
            arm.append(self.nodes(case.rest));
            arms.push(Arm {
                number: Literal::usize_unsuffixed(n),
                beside: comments::device(&self.storage, S, state),
                body: arm,
            });
        }
        let mut inner = Body::default();
        inner.arms(quote!(match at), arms);
        inner.code(quote!(at += 1;));
        body.code(quote!(let mut at = 0;));
        body.block(
            quote!(while #next(&mut at, &mut #states, &mut #memories)),
            inner,
        );
    }

    /// Blocks and their test.
    fn tested(&mut self, body: &mut Body, of: &Steps, inner: &[Node]) {
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
        let Some([states, memories]) = self.ranges(of) else {
            return quote!(true);
        };
        let any = self.rt("any_active");
        quote!(#any(&#states, &#memories))
    }

    /// The states and the memories of some blocks, as parts of arrays.
    fn ranges(&self, of: &Steps) -> Option<[TokenStream; 2]> {
        let field = self.storage.find(S, of.first)?;
        let name = field.name();
        let At::Element(begin) = field.at(of.first) else {
            return None;
        };
        let [begin, end, first, last] = [
            begin,
            begin + of.states,
            of.memory.0,
            of.memory.0 + of.memories,
        ]
        .map(Literal::u32_unsuffixed);
        Some([
            quote!(plc.#name[#begin..#end]),
            quote!(plc.edges[#first..#last]),
        ])
    }
}
