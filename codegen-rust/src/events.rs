//! What happens outside the scan: flags that a host's interrupts set, and the methods that it calls for that.

use crate::generate::{Generator, function_name};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_ir::node::{EdgeKind, Flag, FlagId, FunctionKind, Source};

/// A private field: name, type, value at power-on, meaning.
pub type Hidden = (Ident, TokenStream, TokenStream, &'static str);

/// The field of a flag.
pub fn flag_field(flag: &Flag) -> Ident {
    format_ident!("{}", flag.name)
}

/// The field that holds when a flag's period began.
fn since_field(flag: &Flag) -> Ident {
    format_ident!("{}_since", flag.name)
}

impl Generator<'_> {
    /// The field of a flag.
    pub fn flag(&self, flag: FlagId) -> Ident {
        flag_field(&self.module.flags[flag.0 as usize])
    }

    /// The flags with a period, and their periods in milliseconds.
    fn periods(&self) -> impl Iterator<Item = (&Flag, u32)> {
        self.module
            .flags
            .iter()
            .filter_map(|flag| match flag.source {
                Some(Source::Period { ms }) => Some((flag, ms)),
                _ => None,
            })
    }

    /// The fields that flags need.
    pub fn flag_fields(&self) -> Vec<Hidden> {
        let flags = self.module.flags.iter().map(|flag| {
            let meaning = match flag.source {
                Some(Source::Input { .. }) => "Set by `input_edge`.",
                Some(Source::Period { .. }) => "Set by `tick`.",
                None => "EI was executed.",
            };
            (flag_field(flag), quote!(bool), quote!(false), meaning)
        });
        let since = self.periods().map(|(flag, _)| {
            let meaning = "When this period began.";
            (since_field(flag), quote!(u32), quote!(0), meaning)
        });
        flags.chain(since).collect()
    }

    /// Forgets what happened, when RUN begins.
    pub fn forget_flags(&self) -> TokenStream {
        let flags = self.module.flags.iter().map(|flag| {
            let field = flag_field(flag);
            quote!(self.#field = false;)
        });
        let since = self.periods().map(|(flag, _)| {
            let field = since_field(flag);
            quote!(self.#field = self.sys.now_ms;)
        });
        flags.chain(since).collect()
    }

    /// The methods that a host calls; nothing if the program takes no notice of anything outside its scan.
    pub fn event_methods(&mut self) -> TokenStream {
        let module = self.module;
        let kinds = module.functions.iter().map(|f| &f.kind);
        let Some(at) = kinds
            .into_iter()
            .position(|kind| *kind == FunctionKind::TakeInterrupts)
        else {
            return TokenStream::new();
        };
        let edges: Vec<TokenStream> = module
            .flags
            .iter()
            .filter_map(|flag| match flag.source {
                Some(Source::Input { number, kind }) => {
                    let (field, number) = (flag_field(flag), Literal::u32_unsuffixed(number));
                    let level = match kind {
                        EdgeKind::Rising => quote!(level),
                        EdgeKind::Falling => quote!(!level),
                    };
                    Some(quote!(if number == #number && #level { self.#field = true; }))
                }
                _ => None,
            })
            .collect();
        let edge = (!edges.is_empty()).then(|| {
            quote! {
                fn input_edge(&mut self, number: u32, level: bool) { #(#edges)* }
            }
        });
        let periods: Vec<TokenStream> = self
            .periods()
            .map(|(flag, ms)| {
                let (field, since) = (flag_field(flag), since_field(flag));
                let ms = Literal::u32_unsuffixed(ms);
                quote! {
                    if now_ms.wrapping_sub(self.#since) >= #ms {
                        self.#since = self.#since.wrapping_add(#ms);
                        self.#field = true;
                    }
                }
            })
            .collect();
        let tick = (!periods.is_empty()).then(|| {
            quote! {
                fn tick(&mut self, now_ms: u32) { #(#periods)* }
            }
        });
        let function = format_ident!("{}", function_name(&module.functions[at]));
        let needs_hal = self.calls.needs_hal.get(at).copied().unwrap_or(false);
        let (parameter, argument) = if needs_hal {
            (format_ident!("hal"), Some(quote!(, hal)))
        } else {
            (format_ident!("_hal"), None)
        };
        let hal = self.rt("Hal");
        quote! {
            #edge
            #tick
            fn take_interrupts(&mut self, #parameter: &mut dyn #hal) {
                if self.sys.running { program::#function(self #argument); }
            }
        }
    }
}
