//! Calls of the runtime.

use crate::expr::literal32;
use crate::generate::Generator;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_ir::node::{Arg, Call, Fetch, Place, Send};

impl Generator<'_> {
    /// A call of an instruction's function.
    pub fn call(&mut self, call: &Call) -> TokenStream {
        let Call {
            function,
            wide,
            ref args,
            drive,
            signal,
            period_ms,
            slot,
            step,
        } = *call;
        let call = self.rt("call");
        self.uses.fnc_imports.insert(function.module());
        let module = format_ident!("{}", function.module());
        let name = format_ident!("{}", function.name());
        let mut site = self.site(step, wide);
        if slot != 0 {
            let slot = Literal::u16_unsuffixed(slot);
            site.extend(quote!(.slot(#slot)));
        }
        if let Some(drive) = drive {
            let drive = self.expr(drive);
            site.extend(quote!(.driven(#drive)));
        }
        if signal {
            site.extend(quote!(.signal()));
        }
        if period_ms != 0 {
            let period_ms = Literal::u16_unsuffixed(period_ms);
            site.extend(quote!(.each_ms(#period_ms)));
        }
        let args: Vec<TokenStream> = args.iter().map(|arg| self.argument(arg)).collect();
        quote!(#call(#module::#name, #site, &[#(#args),*], plc, hal);)
    }

    /// Location of an instruction, and its form.
    fn site(&mut self, step: u32, wide: bool) -> TokenStream {
        let site = self.rt("Site");
        let step = Literal::u32_unsuffixed(step);
        let wide = wide.then(|| quote!(.wide()));
        quote!(#site::at(#step)#wide)
    }

    /// Reads an operand that only the runtime can read.
    pub fn fetch(&mut self, fetch: &Fetch) -> TokenStream {
        let (function, site) = (self.rt("fetch"), self.site(fetch.step, fetch.wide));
        let (from, cell) = (self.argument(&fetch.from), self.cell(fetch.value));
        let fetched = quote! {
            #function(#site, #from, plc, hal).map(|value| plc.#cell = value).is_some()
        };
        self.bind(fetch.there, fetched)
    }

    /// Writes such an operand.
    pub fn send(&mut self, send: &Send) -> TokenStream {
        let (function, site) = (self.rt("send"), self.site(send.step, send.wide));
        let (to, value) = (self.argument(&send.to), self.typed(send.value));
        let value = match send.wide {
            true => value.tokens,
            false => quote!(i32::from(#value)),
        };
        quote!(#function(#site, #to, #value, plc, hal);)
    }

    fn argument(&mut self, arg: &Arg) -> TokenStream {
        match *arg {
            Arg::Const { value, index, wide } => {
                let k = self.rt("k");
                let value = match index {
                    None => literal32(value, false).tokens,
                    Some(index) if wide => {
                        let index = self.typed(index).receiver();
                        let value = literal32(value, false);
                        quote!(#index.wrapping_add(#value))
                    }
                    Some(index) => {
                        let index = self.typed(index).receiver();
                        let value = literal32(value, false);
                        quote!(i32::from(#index.wrapping_add(#value) as i16))
                    }
                };
                quote!(#k(#value))
            }
            Arg::Float(value) => {
                let operand = self.rt("Operand");
                let bits = Literal::u32_unsuffixed(value.to_bits());
                let float = if value.is_finite() {
                    let literal = Literal::f32_unsuffixed(value.abs());
                    if value.is_sign_negative() {
                        quote!(-#literal)
                    } else {
                        quote!(#literal)
                    }
                } else {
                    quote!(f32::from_bits(#bits))
                };
                quote!(#operand::float(#float))
            }
            Arg::Device { place, .. } => {
                let d = self.rt("d");
                let (class, number) = self.operand_place(place);
                quote!(#d(#class, #number))
            }
            Arg::Nibbles { place, digits, .. } => {
                let kn = self.rt("kn");
                let digits = Literal::u8_unsuffixed(digits);
                let (class, number) = self.operand_place(place);
                quote!(#kn(#digits, #class, #number))
            }
            Arg::WordBit { place, bit, .. } => {
                let operand = self.rt("Operand");
                let bit = Literal::u8_unsuffixed(bit);
                let (class, number) = self.operand_place(place);
                quote!(#operand::word_bit(#class, #number, #bit))
            }
            Arg::Buffer {
                module,
                address,
                index,
            } => {
                let operand = self.rt("Operand");
                let module = Literal::u8_unsuffixed(module);
                let address = match index {
                    None => literal32(address as i32, false).tokens,
                    Some(index) => self.offset(address as i32, index),
                };
                quote!(#operand::buffer(#module, #address))
            }
            Arg::Text(n) => {
                let operand = self.rt("Operand");
                let n = Literal::u32_unsuffixed(n);
                quote!(#operand::text(#n))
            }
        }
    }

    /// Class and number of a device that the runtime is handed.
    pub(crate) fn operand_place(&mut self, place: Place) -> (TokenStream, TokenStream) {
        let class = self.class(place.class);
        let number = match place.index {
            None => literal32(place.number as i32, false).tokens,
            Some(index) => self.offset(place.number as i32, index),
        };
        (class, number)
    }
}
