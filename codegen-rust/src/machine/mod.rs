//! The struct that holds the devices, and what it implements.

mod access;
mod clear;
mod private;
mod scan;

use crate::format;
use crate::format::documented;
use crate::generate::{Generator, Item};
use crate::storage::{PrintField, type_name};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::cycle::{self, Latches, Services};
use rungc_emit::storage::{Field, Keep, Kind, Section};

impl Generator<'_> {
    /// The struct.
    pub(crate) fn machine_struct(&mut self) -> Item {
        self.uses = Default::default();
        let name = self.type_name.clone();
        let fields: Vec<TokenStream> = self
            .storage
            .fields()
            .to_vec()
            .iter()
            .map(|field| self.field(field))
            .collect();
        let doc = format!(
            " The devices of the {} that the program uses, and what its scan remembers. All of them are plain fields: read and \
             write them between two scans.",
            self.module.model.title
        );
        let doc = self.with_comments.then(|| quote!(#[doc = #doc]));
        let private = self.private_fields();
        let private = private.iter().map(|field| {
            let (doc, name, ty) = (self.doc(field.meaning), &field.name, &field.ty);
            quote!(#doc pub(crate) #name: #ty)
        });
        let private: Vec<TokenStream> = private.collect();
        let on_error = self.module.may_fail().then(|| {
            let doc = self.doc("Callback of the host for operation errors, given the PLC's code and the step of the instruction.");
            quote!(#doc pub on_error: Option<fn(&Self, code: u16, step: u16)>,)
        });
        self.item_of(quote! {
            #doc
            #[derive(Clone, Debug)]
            pub struct #name {
                #(#fields,)*
                #(#private,)*
                #on_error
            }
        })
    }

    pub(crate) fn doc(&self, text: &str) -> TokenStream {
        if !self.with_comments {
            return TokenStream::new();
        }
        let text = format!(" {text}");
        quote!(#[doc = #text])
    }

    fn field(&mut self, field: &Field) -> TokenStream {
        let (class, first) = (field.class, field.first);
        let mut text = class.number(first).to_string();
        let latched = self.latched(field);
        if field.array {
            if field.count > 1 {
                text.push_str(&format!("–{}", class.number(field.last())));
            }
            if let Some(grid) = field.columns() {
                let second = class.number(first + 1);
                let (columns, stored) = (grid.columns, grid.stored_columns);
                text.push_str(&match stored {
                    1 => format!(", {columns} apart"),
                    _ if stored < columns => {
                        format!(" in {columns} columns, {stored} stored, [1][0] is {second}")
                    }
                    _ => format!(" in {columns} columns, [1][0] is {second}"),
                });
            }
            if field.kind == Kind::NumericBit {
                text.push_str(", 0 or 1");
            }
            text.push_str(&latched);
            let named = field
                .numbers()
                .filter_map(|n| Some((n, self.device_comment(class, n)?)))
                .map(|(n, comment)| format!("{} {}", class.number(n), documented(comment)));
            let named: Vec<String> = named.collect();
            if !named.is_empty() {
                text.push_str(": ");
                text.push_str(&named.join(", "));
            }
        } else {
            text.push_str(&latched);
            if let Some(comment) = self.device_comment(class, first) {
                text.push_str(&format!(": {}", documented(comment)));
            }
        }
        let doc = self.doc(&text);
        let (name, ty) = (field.name(), self.field_type(field));
        quote!(#doc pub #name: #ty)
    }

    /// Devices of a field that are retained over power-off, for its documentation.
    fn latched(&self, field: &Field) -> String {
        match field.section {
            Section::Latched | Section::Records => " (latched)".to_string(),
            Section::Inputs | Section::General | Section::Special => String::new(),
            Section::Mixed => {
                let runs = self.storage.runs(field);
                let latched = runs
                    .filter(|run| matches!(run.keep, Keep::Latched | Keep::Record))
                    .map(|run| {
                        let last = run.first + run.count - 1;
                        let [first, last] = [run.first, last].map(|n| field.class.number(n));
                        format!(", latched: {first}–{last}")
                    });
                latched.collect()
            }
        }
    }

    fn field_type(&mut self, field: &Field) -> TokenStream {
        let name = type_name(field.kind);
        let ty = match field.kind.has_members() {
            true => self.rt(name),
            false => format_ident!("{name}"),
        };
        dimensions(field, quote!(#ty))
    }

    /// A field's value at power-on, special registers' apart.
    fn zero(&mut self, field: &Field) -> TokenStream {
        let zero = self.zero_element(field);
        dimensions(field, zero)
    }

    /// The same of one of its devices.
    fn zero_element(&mut self, field: &Field) -> TokenStream {
        match field.kind {
            Kind::Bit => quote!(false),
            Kind::NumericBit | Kind::Word => quote!(0),
            Kind::Timer | Kind::Counter16 | Kind::Counter32 => {
                let ty = self.rt(type_name(field.kind));
                quote!(#ty::new())
            }
        }
    }

    /// Power-on, and clearing.
    pub(crate) fn machine_impl(&mut self) -> Item {
        self.uses = Default::default();
        let name = self.type_name.clone();
        let fields = self.storage.fields().to_vec();
        let names: Vec<Ident> = fields.iter().map(PrintField::name).collect();
        let zeros: Vec<TokenStream> = fields.iter().map(|f| self.zero(f)).collect();
        let private = self.private_fields();
        let private_names = private.iter().map(|field| &field.name);
        let private_values = private.iter().map(|field| &field.initial);
        let preset = self.preset(&quote!(self), false);
        let first = self.preset(&quote!(plc), true);
        let on_error = self.module.may_fail().then(|| quote!(on_error: None,));
        let doc = self.doc("The PLC as it leaves the factory, switched to RUN.");
        let value = quote! {
            Self { #(#names: #zeros,)* #(#private_names: #private_values,)* #on_error }
        };
        let new = if preset.is_empty() && first.is_empty() {
            quote!(#doc pub const fn new() -> Self { #value })
        } else {
            let preset = (!preset.is_empty()).then(|| quote!(plc.preset();));
            quote!(#doc pub const fn new() -> Self { let mut plc = #value; #first #preset plc })
        };
        let preset = (!preset.is_empty()).then(|| {
            let doc = self.doc("Gives special devices the values that they have at power-on.");
            quote!(#doc const fn preset(&mut self) { #preset })
        });
        let clear_general = self.clear(false);
        let lost = cycle::latches(self.module, &self.storage) != Latches::Retained;
        let asked = Services::of(&self.plan);
        let clear_latched = (asked.clears_latched || lost).then(|| self.clear(true));
        let forget = self.forget();
        let watchdog = self.module.has_watchdog().then(|| self.watchdog());
        let fault = asked.faults.then(|| self.fault_method());
        let count_pulses = self.count_pulses();
        let advance_ports = self.advance_ports();
        let pulse_outputs = self.pulse_outputs();
        self.item_of(quote! {
            impl #name {
                #pulse_outputs
                #new
                #preset
                #clear_general
                #clear_latched
                #forget
                #count_pulses
                #advance_ports
                #watchdog
                #fault
            }
            impl Default for #name {
                fn default() -> Self { Self::new() }
            }
        })
    }

    /// The text of some items, and what they use.
    pub(crate) fn item_of(&mut self, tokens: TokenStream) -> Item {
        Item {
            text: if self.with_comments {
                format::items(tokens)
            } else {
                tokens.to_string()
            },
            uses: std::mem::take(&mut self.uses),
        }
    }
}

/// Array of an element by the field's dimensions: of a type the array's type, of a value its value.
fn dimensions(field: &Field, element: TokenStream) -> TokenStream {
    if !field.array {
        return element;
    }
    let (columns, rows) = field.dimensions();
    let rows = Literal::u32_unsuffixed(rows);
    match columns.map(Literal::u32_unsuffixed) {
        Some(columns) => quote!([[#element; #rows]; #columns]),
        None => quote!([#element; #rows]),
    }
}
