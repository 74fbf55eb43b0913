//! Blocks of a step ladder that a scan leaves out while their states are off.

use crate::format::{Arm, Body};
use crate::generate::Generator;
use crate::storage::{PrintField, PrintStorage};
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use rungc_emit::comments;
use rungc_emit::plan::Node;
use rungc_emit::steps::{self, Case, Ladder, Move};
use rungc_emit::temps::ON;
use rungc_ir::node::{EdgeId, Steps};
use rungc_syntax::DeviceClass::S;
use std::rc::Rc;

impl Generator<'_> {
    /// Blocks: as cases, or with their test.
    pub(crate) fn steps(&mut self, body: &mut Body, of: &Steps, inner: &[Node]) {
        let plan = Rc::clone(&self.plan);
        let ladder = plan.ladders.find(of);
        let cases = ladder.and_then(|_| steps::cases(self.module, &plan, of, inner));
        match ladder.zip(cases) {
            Some(((number, ladder), cases)) => self.cases(body, number, ladder, &cases),
            None if steps::are_tested_within(of) => body.append(self.nodes(inner)),
            None => self.tested(body, of, inner),
        }
    }

    /// Blocks as the cases of a choice, in a loop over those that run.
    fn cases(&mut self, body: &mut Body, number: usize, ladder: &Ladder, cases: &[Case]) {
        let steps = steps_field(number);
        let states = self.neighbours(ladder.first, ladder.states);
        let mut arms = Vec::new();
        for case in cases {
            let mut arm = Body::default();
            self.block = Some((number, case.state));
            if let Some(network) = case.network {
                self.heading(&mut arm, network);
            }
            arm.append(self.nodes(case.rest));
            arms.push(Arm {
                number: Literal::u32_unsuffixed(case.state - ladder.first),
                beside: comments::device(&self.storage, S, case.state),
                body: arm,
            });
        }
        self.block = None;
        let on = match cases.iter().any(|case| case.on.is_some()) {
            true => format_ident!("{ON}").into_token_stream(),
            false => quote!(_),
        };
        let mut inner = Body::default();
        inner.arms(quote!(match step), arms);
        let (begin, next) = match ladder.in_turn {
            true => (
                quote!(#steps.begin_in_turn(&#states)),
                quote!(#steps.next_in_turn(&mut run, &mut #states)),
            ),
            false => (
                quote!(#steps.begin(&mut #states)),
                quote!(run.next(&#states)),
            ),
        };
        body.code(quote!(let mut run = #begin;));
        body.block(quote!(while let Some((step, #on)) = #next), inner);
    }

    /// A change of the bits of a ladder.
    pub(crate) fn step_move(&mut self, body: &mut Body, change: Move) {
        let plan = Rc::clone(&self.plan);
        let later = change.is_later(self.block);
        let (method, number, state) = match change {
            Move::Enter(number, state) if later => ("enter_later", number, state),
            Move::Enter(number, state) => ("enter", number, state),
            Move::Transfer(number, state) if later => ("transfer_later", number, state),
            Move::Transfer(number, state) => ("transfer", number, state),
            Move::Leave(number) => {
                let steps = steps_field(number);
                return body.code(quote!(#steps.leave(run);));
            }
        };
        let Some(ladder) = plan.ladders.get(number) else {
            return;
        };
        let (steps, method) = (steps_field(number), format_ident!("{method}"));
        let states = self.neighbours(ladder.first, ladder.states);
        let at = Literal::u32_unsuffixed(state - ladder.first);
        body.code(match change {
            Move::Enter(..) if !later => quote!(#steps.#method(&mut #states, #at);),
            _ if later => quote!(run = #steps.#method(&mut #states, run, #at);),
            Move::Enter(..) | Move::Transfer(..) | Move::Leave(_) => {
                quote!(#steps.#method(&mut #states, run, #at);)
            }
        });
        body.trailing_comment(&comments::device(&self.storage, S, state));
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
            let memory = Literal::u32_unsuffixed(self.plan.ladders.edge(EdgeId(memory)));
            quote!(| plc.edges[#memory].0)
        });
        quote!(#state #(#memories)*)
    }

    fn test_of_many(&mut self, of: &Steps) -> TokenStream {
        let any = self.rt("any_active");
        let states = self.neighbours(of.first, of.states);
        let first = self.plan.ladders.edge(of.memory);
        let [first, last] = [first, first + of.memories].map(Literal::u32_unsuffixed);
        quote!(#any(&#states, &plc.edges[#first..#last]))
    }

    /// Neighbouring states, as a part of an array.
    fn neighbours(&self, first: u32, count: u32) -> TokenStream {
        let Some(field) = self.storage.find(S, first) else {
            return quote!([]);
        };
        let begin = first - field.first;
        let [begin, end] = [begin, begin + count].map(Literal::u32_unsuffixed);
        let name = field.name();
        quote!(plc.#name[#begin..#end])
    }
}

/// The bits of a ladder.
fn steps_field(number: usize) -> TokenStream {
    let number = Literal::usize_unsuffixed(number);
    quote!(plc.steps[#number])
}
