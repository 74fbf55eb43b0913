//! Clearing, power-off and what RUN forgets.

use super::access::number_literal;
use crate::expr::literal32;
use crate::generate::Generator;
use crate::storage::{PrintField, PrintStorage};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::cycle::{self, Latches};
use rungc_emit::storage::{Keep, Kind, Run};
use rungc_syntax::DeviceClass;

impl Generator<'_> {
    /// The statements that give special devices of `plc` their defaults: latched ones, when the PLC is switched on for
    /// the first time, or all others.
    pub(super) fn preset(&mut self, plc: &TokenStream, latched: bool) -> TokenStream {
        let module = self.module;
        let bits = module.initial_bits.iter().map(|relay| relay.number());
        let bits = bits.filter(|&number| module.is_latched(DeviceClass::M, number) == latched);
        let bits = bits.filter_map(|number| {
            let cell = self.storage.bit(plc, DeviceClass::M, number)?;
            Some(quote!(#cell = true;))
        });
        let words = module.initial_words.iter();
        let words = words.map(|(register, value)| (register.number(), *value));
        let words = words.filter(|word| module.is_latched(DeviceClass::D, word.0) == latched);
        words
            .filter_map(|(number, value)| {
                let cell = self.storage.word(plc, DeviceClass::D, number)?;
                let value = literal32(i32::from(value), false);
                Some(quote!(#cell = #value;))
            })
            .chain(bits)
            .collect()
    }

    /// The statements that set fields to 0.
    fn zeroing(&mut self, keeps: &[Keep]) -> TokenStream {
        let fields = self.storage.fields().to_vec();
        let mut out = TokenStream::new();
        for field in &fields {
            let (name, zero) = (field.name(), self.zero(field));
            let runs: Vec<Run> = self.storage.runs(field).collect();
            if runs.iter().all(|run| keeps.contains(&run.keep)) {
                out.extend(quote!(self.#name = #zero;));
                continue;
            }
            for run in runs.iter().filter(|run| keeps.contains(&run.keep)) {
                let zero = self.zero_element(field);
                let numbers = [run.first, run.first + run.count];
                if field.columns().is_none() {
                    let [first, end] = numbers.map(|n| Literal::u32_unsuffixed(n - field.first));
                    out.extend(quote!(self.#name[#first..#end].fill(#zero);));
                    continue;
                }
                let [first, end] = numbers.map(|number| number_literal(field.class, number));
                let cell = Self::matched(field);
                let clear = quote!(#cell = #zero;);
                let clear = match Self::column_is_stored(field) {
                    Some(is_kept) => quote!(if #is_kept { #clear }),
                    None => clear,
                };
                out.extend(quote!(for number in #first..#end { #clear }));
            }
        }
        out
    }

    pub(super) fn clear(&mut self, latched: bool) -> TokenStream {
        let statements = self.zeroing(&[if latched {
            Keep::Latched
        } else {
            Keep::General
        }]);
        let (name, doc) = if latched {
            (
                format_ident!("clear_latched"),
                self.doc("Clears the latched devices, as M8032 does."),
            )
        } else {
            (
                format_ident!("clear_general"),
                self.doc("Clears what is neither latched nor special nor an input, as M8031 and STOP do."),
            )
        };
        quote!(#doc fn #name(&mut self) { #statements })
    }

    /// Forgets edges and coils, before the first scan in RUN.
    pub(super) fn forget(&mut self) -> TokenStream {
        let mut out = TokenStream::new();
        let (edges, ladders) = (
            self.plan.ladders.edges(self.module),
            self.plan.ladders.count(),
        );
        if edges > 0 {
            let (edge, count) = (self.rt("Edge"), Literal::u32_unsuffixed(edges));
            out.extend(quote!(self.edges = [#edge(false); #count];));
        }
        if ladders > 0 {
            let (steps, count) = (self.rt("Steps"), Literal::u32_unsuffixed(ladders));
            out.extend(quote!(self.steps = [#steps::new(); #count];));
        }
        out.extend(self.forget_flags());
        if self.module.run_states > 0 {
            let state = self.rt("State");
            let last = Literal::usize_unsuffixed(self.module.run_states.into());
            out.extend(quote!(self.states[1..=#last].fill(#state::new());));
        }
        if self.module.may_fail() {
            let error = self.rt("LastError");
            out.extend(quote!(self.error = #error::NONE;));
        }
        out.extend(self.each_timer_and_counter(&quote!(coil = 0), &quote!(coil = false)));
        let doc = self.doc("Forgets that edges and the coils of timers and counters were on, and what instructions remember.");
        quote!(#doc fn forget(&mut self) { #out })
    }

    /// Does the first thing with a member of each timer, the second with one of each counter.
    fn each_timer_and_counter(&self, timer: &TokenStream, counter: &TokenStream) -> TokenStream {
        let fields = self.storage.fields().iter();
        fields
            .filter(|field| field.kind.has_members())
            .map(|field| {
                let name = field.name();
                let what = if field.kind == Kind::Timer {
                    timer
                } else {
                    counter
                };
                if field.columns().is_some() {
                    quote!(for device in self.#name.iter_mut().flatten() { device.#what; })
                } else if field.array {
                    quote!(for device in &mut self.#name { device.#what; })
                } else {
                    quote!(self.#name.#what;)
                }
            })
            .collect()
    }

    /// Power off and on.
    pub(super) fn power_cycle(&mut self) -> TokenStream {
        let plc = quote!(self);
        let latched = match cycle::latches(self.module, &self.storage) {
            Latches::Retained => TokenStream::new(),
            Latches::RetainedIf(register, key) => {
                let cell = self.storage.word(&plc, DeviceClass::D, register);
                let key = literal32(i32::from(key), false);
                quote!(if #cell != #key { self.clear_latched(); })
            }
            Latches::Lost(..) => quote!(self.clear_latched();),
        };
        let others = self.zeroing(&[Keep::Input, Keep::Special]);
        let preset = self.preset(&plc, false);
        let preset = (!preset.is_empty()).then(|| quote!(self.preset();));
        let contacts = (!self.module.model.keeps_contacts)
            .then(|| self.each_timer_and_counter(&quote!(done = false), &quote!(done = false)));
        let private = self.private_fields();
        let private = private.iter().filter(|field| !field.begins_with_run);
        let private = private.map(|field| {
            let (name, value) = (&field.name, &field.initial);
            quote!(self.#name = #value;)
        });
        let private: TokenStream = private.collect();
        quote! {
            fn power_cycle(&mut self) {
                #latched
                self.clear_general();
                #others
                #preset
                #contacts
                #private
                self.forget();
            }
        }
    }
}
