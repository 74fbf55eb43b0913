//! The private fields of the struct.

use crate::events::{axis_field, flag_field, port_field, since_field};
use crate::generate::Generator;
use crate::temps::type_of;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::private::{self, Private};
use rungc_rt::comm::Protocols;
use std::rc::Rc;

/// A private field.
pub(crate) struct PrivateField {
    /// Its name.
    pub name: Ident,
    /// Its type.
    pub ty: TokenStream,
    /// Its value at power-on.
    pub initial: TokenStream,
    /// Meaning, for its documentation.
    pub meaning: &'static str,
    /// True if RUN resets it to its power-on value.
    pub begins_with_run: bool,
}

impl Generator<'_> {
    /// The fields that are not devices.
    pub(crate) fn private_fields(&mut self) -> Vec<PrivateField> {
        let plan = Rc::clone(&self.plan);
        let mut fields = Vec::new();
        for private in private::fields(self.module, &plan) {
            let begins_with_run = private.begins_with_run();
            let named = self.named_private(private).into_iter();
            fields.extend(named.map(|(name, ty, initial, meaning)| PrivateField {
                name,
                ty,
                initial,
                meaning,
                begins_with_run,
            }));
        }
        fields
    }

    /// Names, types, values at power-on and meanings of what is one field, or of the fields of outputs or ports.
    fn named_private(
        &mut self,
        private: Private,
    ) -> Vec<(Ident, TokenStream, TokenStream, &'static str)> {
        let one = match private {
            Private::Sys => {
                let sys = self.rt("Sys");
                let (power_on, meaning) = (quote!(#sys::power_on()), "Time and mode.");
                (format_ident!("sys"), quote!(#sys), power_on, meaning)
            }
            Private::Edges(count) => {
                let (edge, count) = (self.rt("Edge"), Literal::u32_unsuffixed(count));
                let meaning = "Last inputs of edge contacts and pulse instructions.";
                let (ty, off) = (quote!([#edge; #count]), quote!([#edge(false); #count]));
                (format_ident!("edges"), ty, off, meaning)
            }
            Private::Steps(count) => {
                let (ty, new) = self.array("Steps", count);
                let meaning = "Which blocks of step ladders run.";
                (format_ident!("steps"), ty, new, meaning)
            }
            Private::Flag { flag, .. } => {
                (flag_field(flag), quote!(bool), quote!(false), flag.meaning)
            }
            Private::PeriodStart(flag) => {
                let watch = self.rt("Milliseconds");
                let (ty, new) = (quote!(#watch), quote!(#watch::at(0)));
                let meaning = "Time since this period began.";
                (since_field(flag), ty, new, meaning)
            }
            Private::Cell(cell) => {
                let name = format_ident!("{}", cell.name);
                (name, quote!(i32), quote!(0), cell.meaning)
            }
            Private::Table(table) => {
                let name = format_ident!("{}", table.name);
                let length = Literal::u32_unsuffixed(table.length);
                let (ty, zero) = (quote!([i32; #length]), quote!([0; #length]));
                (name, ty, zero, table.meaning)
            }
            Private::Error => {
                let error = self.rt("LastError");
                let (none, meaning) = (quote!(#error::NONE), "The last error.");
                (format_ident!("error"), quote!(#error), none, meaning)
            }
            Private::StepsLeft => {
                let (name, steps) = (format_ident!("steps_left"), self.initial_steps());
                let meaning = "Steps that this scan may still repeat.";
                (name, quote!(u32), quote!(#steps), meaning)
            }
            Private::Temp(temp, ty) => {
                let (ty, zero) = type_of(ty);
                let meaning = "found in one function, used in another";
                (format_ident!("{}", temp.to_string()), ty, zero, meaning)
            }
            Private::Axes(outputs) => {
                let axis = self.rt("Axis");
                let (ty, new) = (quote!(#axis), quote!(#axis::new()));
                let meaning = "State of this pulse output.";
                let outputs = outputs.iter();
                return outputs
                    .map(|&output| (axis_field(output), ty.clone(), new.clone(), meaning))
                    .collect();
            }
            Private::Port(number, protocols) => {
                let (ty, new) = self.port(protocols);
                let meaning = "State of this serial port.";
                (port_field(number), ty, new, meaning)
            }
            Private::States(count) => {
                // Slot 0 stands for instructions without memory.
                let (ty, new) = self.array("State", u32::from(count) + 1);
                let meaning = "Private memories of instructions.";
                (format_ident!("states"), ty, new, meaning)
            }
        };
        vec![one]
    }

    /// The type of an array of things of the runtime, and its first value.
    fn array(&mut self, of: &'static str, count: u32) -> (TokenStream, TokenStream) {
        let (of, count) = (self.rt(of), Literal::u32_unsuffixed(count));
        (quote!([#of; #count]), quote!([#of::new(); #count]))
    }

    /// The type of a serial port that may speak these protocols, and its first value.
    fn port(&mut self, protocols: Protocols) -> (TokenStream, TokenStream) {
        let (port, comm) = (self.rt("Port"), self.rt("comm"));
        let length = Literal::usize_unsuffixed(protocols.longest_frame());
        let progress = match protocols.has_progress() {
            true => quote!(#comm::Progress),
            false => quote!(#comm::Without),
        };
        let memory = match protocols.keeps_memory() {
            true => quote!(#comm::Memory),
            false => quote!(#comm::Without),
        };
        (
            quote!(#port<#length, #progress, #memory>),
            quote!(#port::new()),
        )
    }
}
