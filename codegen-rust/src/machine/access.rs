//! Access to devices by number.

use crate::generate::{Generator, Item};
use crate::storage::{self, PrintField, PrintStorage};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::storage::{Field, Kind, Member};
use rungc_rt::special::M_OPERATION_ERROR;
use rungc_syntax::DeviceClass;

/// One way of access by number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Access {
    Bit,
    Word,
    Counter32,
}

impl Generator<'_> {
    /// Access by number.
    pub(crate) fn plc_impl(&mut self) -> Item {
        self.uses = Default::default();
        let name = self.type_name.clone();
        let (plc, state, sys) = (self.rt("Plc"), self.rt("State"), self.rt("Sys"));
        let methods = self.access_methods();
        let axes = self.axis_methods();
        let ports = self.port_methods();
        let last = usize::from(self.module.states);
        let (slot, cell) = if last == 0 {
            (quote!(_slot), quote!(0))
        } else {
            let last = Literal::usize_unsuffixed(last);
            (quote!(slot), quote!(usize::from(slot).min(#last)))
        };
        let text = self.text();
        let pairs = (!self.module.model.z_pairs_with_v).then(|| {
            quote!(
                fn z_pairs_with_v(&self) -> bool {
                    false
                }
            )
        });
        let relay = self.module.model.error_relay;
        let errors = (relay != M_OPERATION_ERROR).then(|| {
            let relay = relay.number();
            quote!(
                fn error_relay(&self) -> u32 {
                    #relay
                }
            )
        });
        let value = self.module.model.value_error;
        let values = (value != 6706).then(|| {
            quote!(
                fn value_error(&self) -> u16 {
                    #value
                }
            )
        });
        let rules = self.error_rules();
        let noted = self.note_error();
        let elements = self.elements_impl();
        self.item_of(quote! {
            impl #plc for #name {
                #(#methods)*
                fn state(&mut self, #slot: u16) -> &mut #state { &mut self.states[#cell] }
                fn sys(&self) -> &#sys { &self.sys }
                #axes
                #ports
                #text
                #pairs
                #errors
                #values
                #rules
                #noted
            }
            #elements
        })
    }

    /// Lookup of devices by number, for a port that can only be a Modbus slave.
    fn elements_impl(&mut self) -> Option<TokenStream> {
        self.module.slave_alone?;
        let name = self.type_name.clone();
        let (comm, class) = (self.rt("comm"), self.rt("Class"));
        let fields = self.storage.fields().to_vec();
        let mut arms = TokenStream::new();
        for field in &fields {
            let pattern = self.pattern(field, true);
            let cell = Self::matched(field);
            let kind = match field.kind {
                Kind::Bit => quote!(Bit),
                Kind::NumericBit => quote!(Number),
                Kind::Word => quote!(Word),
                Kind::Timer => quote!(Timer),
                Kind::Counter16 => quote!(Counter16),
                Kind::Counter32 => quote!(Counter32),
            };
            arms.extend(quote!(#pattern => Element::#kind(&mut #cell),));
        }
        for alias in self.module.model.index_aliases {
            if let Some(cell) = self.storage.word(&quote!(self), alias.class, alias.index) {
                let d = self.class(DeviceClass::D);
                let number = Literal::u32_unsuffixed(alias.register.number());
                arms.extend(quote!((#d, #number) => Element::Word(&mut #cell),));
            }
        }
        Some(quote! {
            impl #comm::Elements for #name {
                fn element(&mut self, class: #class, number: u32) -> Option<#comm::Element<'_>> {
                    use #comm::Element;
                    Some(match (class, number) { #arms _ => return None })
                }
            }
        })
    }

    /// The methods that find a device by its number.
    fn access_methods(&mut self) -> Vec<TokenStream> {
        let class = self.rt("Class");
        let devices = self.devices_const();
        let key = quote!((class, number));
        let device = quote!(class: #class, number: u32);
        let ways = [
            (Access::Bit, "bit", quote!(bool), &device, &key),
            (Access::Word, "word", quote!(i16), &device, &key),
            (
                Access::Counter32,
                "counter32",
                quote!(i32),
                &quote!(number: u32),
                &quote!(number),
            ),
        ];
        let mut methods = Vec::new();
        for (access, name, ty, parameters, key) in ways {
            let (read, write) = (format_ident!("{name}"), format_ident!("set_{name}"));
            let arguments = if access == Access::Counter32 {
                quote!(number)
            } else {
                quote!(class, number)
            };
            let absent = quote!(#devices.#read(#arguments));
            let arms = self.arms(access, false);
            methods.push(if arms.is_empty() {
                quote!(fn #read(&self, #parameters) -> Option<#ty> { #absent })
            } else {
                quote!(fn #read(&self, #parameters) -> Option<#ty> {
                    let value = match #key { #arms _ => return #absent };
                    Some(value)
                })
            });
            let arms = self.arms(access, true);
            let absent = quote!(#absent.map(drop));
            methods.push(if arms.is_empty() {
                quote!(fn #write(&mut self, #parameters, _value: #ty) -> Option<()> { #absent })
            } else {
                writer(&write, quote!(#parameters, value: #ty), key, arms, absent)
            });
        }
        methods.extend(self.coil_method());
        let arms = self.reset_arms();
        let reset = format_ident!("reset");
        let absent = quote!(#devices.reset(class, number));
        methods.push(if arms.is_empty() {
            quote!(fn #reset(&mut self, #device) -> Option<()> { #absent })
        } else {
            writer(&reset, device, &key, arms, absent)
        });
        methods
    }

    /// The numbers of a field's devices as a pattern.
    fn pattern(&mut self, field: &Field, with_class: bool) -> TokenStream {
        let number = |n: u32| number_literal(field.class, n);
        let first = number(field.first);
        let numbers = if field.count > 1 {
            let last = number(field.last());
            quote!(#first..=#last)
        } else {
            quote!(#first)
        };
        if with_class {
            let class = self.class(field.class);
            let guard = Self::column_is_stored(field).map(|is_kept| quote!(if #is_kept));
            quote!((#class, #numbers) #guard)
        } else {
            numbers
        }
    }

    /// A field's device in `self` where a pattern has matched its number.
    pub(super) fn matched(field: &Field) -> TokenStream {
        let name = field.name();
        if !field.array {
            return quote!(self.#name);
        }
        if let Some(grid) = field.columns() {
            let columns = Literal::u32_unsuffixed(grid.columns);
            let n = Self::distance(field);
            return quote!(self.#name[(#n % #columns) as usize][(#n / #columns) as usize]);
        }
        match (field.first, field.count) {
            (_, 1) => quote!(self.#name[0]),
            (0, _) => quote!(self.#name[number as usize]),
            (first, _) => {
                let first = number_literal(field.class, first);
                quote!(self.#name[(number - #first) as usize])
            }
        }
    }

    /// The distance of a number from a field's first.
    fn distance(field: &Field) -> TokenStream {
        match field.first {
            0 => quote!(number),
            first => {
                let first = number_literal(field.class, first);
                quote!((number - #first))
            }
        }
    }

    /// That a field holds one of its numbers, if it does not hold all.
    pub(super) fn column_is_stored(field: &Field) -> Option<TokenStream> {
        let grid = field.trimmed()?;
        let n = Self::distance(field);
        let [columns, stored] = [grid.columns, grid.stored_columns].map(Literal::u32_unsuffixed);
        Some(quote!(#n % #columns < #stored))
    }

    fn arms(&mut self, access: Access, set: bool) -> TokenStream {
        let fields = self.storage.fields().to_vec();
        let mut out = TokenStream::new();
        for field in &fields {
            let pattern = self.pattern(field, access != Access::Counter32);
            let cell = Self::matched(field);
            if (access, field.kind) == (Access::Bit, Kind::NumericBit) {
                out.extend(match set {
                    true => quote!(#pattern => #cell = u8::from(value),),
                    false => quote!(#pattern => #cell != 0,),
                });
                continue;
            }
            let member = match access {
                Access::Bit => field.kind.bit(),
                Access::Word => field.kind.word(),
                Access::Counter32 => (field.kind == Kind::Counter32).then_some(Member::Value),
            };
            let Some(member) = member else { continue };
            let cell = storage::member(cell, member);
            out.extend(if set {
                quote!(#pattern => #cell = value,)
            } else {
                quote!(#pattern => #cell,)
            });
        }
        if access == Access::Word {
            out.extend(self.alias_arms(set));
        }
        out
    }

    /// Special registers that are other names of index registers.
    fn alias_arms(&mut self, set: bool) -> TokenStream {
        let mut out = TokenStream::new();
        for alias in self.module.model.index_aliases {
            let Some(cell) = self.storage.word(&quote!(self), alias.class, alias.index) else {
                continue;
            };
            let d = self.class(DeviceClass::D);
            let number = Literal::u32_unsuffixed(alias.register.number());
            out.extend(if set {
                quote!((#d, #number) => #cell = value,)
            } else {
                quote!((#d, #number) => #cell,)
            });
        }
        out
    }

    /// Coils of timers and counters, which partners on a line of some models read.
    fn coil_method(&mut self) -> Option<TokenStream> {
        let profile = self
            .module
            .model
            .ports
            .modbus(self.module.model.type_code());
        if !self.module.has_ports() || !profile.serves_coils() {
            return None;
        }
        let class = self.rt("Class");
        let fields = self.storage.fields().to_vec();
        let mut arms = TokenStream::new();
        for field in fields.iter().filter(|field| field.kind.has_members()) {
            let pattern = self.pattern(field, true);
            let cell = Self::matched(field);
            arms.extend(if field.kind == Kind::Timer {
                quote!(#pattern => #cell.coil != 0,)
            } else {
                quote!(#pattern => #cell.coil,)
            });
        }
        (!arms.is_empty()).then(|| {
            quote!(fn coil(&self, class: #class, number: u32) -> Option<bool> {
                let value = match (class, number) { #arms _ => return self.bit(class, number) };
                Some(value)
            })
        })
    }

    fn reset_arms(&mut self) -> TokenStream {
        let fields = self.storage.fields().to_vec();
        let mut out = TokenStream::new();
        for field in &fields {
            if field.kind.has_members() {
                let pattern = self.pattern(field, true);
                let cell = Self::matched(field);
                out.extend(quote!(#pattern => #cell.reset(),));
            }
        }
        out
    }

    fn text(&self) -> Option<TokenStream> {
        if self.module.texts.is_empty() {
            return None;
        }
        let arms = self.module.texts.iter().enumerate().map(|(n, text)| {
            let n = Literal::usize_unsuffixed(n);
            let bytes = Literal::byte_string(text.as_bytes());
            quote!(#n => #bytes,)
        });
        Some(quote! {
            fn text(&self, index: u32) -> &[u8] {
                match index { #(#arms)* _ => &[] }
            }
        })
    }

    /// The table of the model's devices.
    pub(crate) fn devices_table(&mut self) -> Item {
        self.uses = Default::default();
        let runs = self.rt("Runs");
        let mut rows = Vec::new();
        let stored = DeviceClass::ALL
            .into_iter()
            .filter(|class| !matches!(class, DeviceClass::P | DeviceClass::I | DeviceClass::N));
        for class in stored {
            for (first, last) in self.module.model.runs(class) {
                let [first, last] = [first, last].map(|n| number_literal(class, n));
                let class = self.class(class);
                rows.push(quote!((#class, #first, #last)));
            }
        }
        let doc = format!("The devices of the {}.", self.module.model.title);
        let doc = self.doc(&doc);
        self.item_of(quote!(#doc pub(crate) const DEVICES: #runs = #runs(&[#(#rows),*]);))
    }
}

/// A method that changes the device that one of the arms finds.
fn writer(
    name: &Ident,
    parameters: TokenStream,
    key: &TokenStream,
    arms: TokenStream,
    absent: TokenStream,
) -> TokenStream {
    quote!(fn #name(&mut self, #parameters) -> Option<()> {
        match #key { #arms _ => return #absent }
        Some(())
    })
}

/// A device number as its class writes it.
pub(super) fn number_literal(class: DeviceClass, number: u32) -> Literal {
    if class.is_octal()
        && number > 7
        && let Ok(literal) = format!("0o{number:o}").parse()
    {
        return literal;
    }
    Literal::u32_unsuffixed(number)
}
