//! What happens outside the scan: flags that a host's interrupts set, and the methods that it calls for that.

use crate::generate::{Generator, function_name};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_ir::node::{CellId, EdgeKind, Flag, FlagId, FunctionKind, TableId};

/// A private field: name, type, value at power-on, meaning.
pub type Hidden = (Ident, TokenStream, TokenStream, &'static str);

fn flag_field(flag: &Flag) -> Ident {
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

    /// The field of a cell.
    pub fn cell(&self, cell: CellId) -> Ident {
        format_ident!("{}", self.module.cells[cell.0 as usize].name)
    }

    /// The field of a table.
    pub fn table(&self, table: TableId) -> Ident {
        format_ident!("{}", self.module.tables[table.0 as usize].name)
    }

    /// The flags with a period, and their periods in milliseconds.
    fn periods(&self) -> impl Iterator<Item = (&Flag, u32)> {
        let flags = self.module.flags.iter();
        flags.filter_map(|flag| flag.period_ms.map(|ms| (flag, ms)))
    }

    /// The fields that flags need; RUN begins with them as at power-on.
    pub fn flag_fields(&self) -> Vec<Hidden> {
        let flags = self.module.flags.iter();
        let flags = flags.map(|f| (flag_field(f), quote!(bool), quote!(false), f.meaning));
        let since = self.periods().map(|(flag, _)| {
            let meaning = "when this period began";
            (since_field(flag), quote!(u32), quote!(0), meaning)
        });
        flags.chain(since).collect()
    }

    /// The fields of cells and tables.
    pub fn cell_fields(&self) -> Vec<Hidden> {
        let cells = self.module.cells.iter().map(|cell| {
            let name = format_ident!("{}", cell.name);
            (name, quote!(i32), quote!(0), cell.meaning)
        });
        let tables = self.module.tables.iter().map(|table| {
            let name = format_ident!("{}", table.name);
            let length = Literal::u32_unsuffixed(table.length);
            let ty = quote!([i32; #length]);
            (name, ty, quote!([0; #length]), table.meaning)
        });
        cells.chain(tables).collect()
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
        let edge = self.input_edge();
        let tick = self.tick();
        let module = self.module;
        let mut functions = module.functions.iter();
        let Some(at) = functions.position(|f| f.kind == FunctionKind::TakeInterrupts) else {
            return quote!(#edge #tick);
        };
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

    /// Time goes on; `None` if that means nothing.
    fn tick(&self) -> Option<TokenStream> {
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
        let clocks: Vec<TokenStream> = (0..)
            .zip(&self.module.cells)
            .filter(|(_, cell)| cell.follows_time)
            .map(|(i, _)| {
                let field = self.cell(CellId(i));
                quote!(self.#field = now_ms as i32;)
            })
            .collect();
        (!periods.is_empty() || !clocks.is_empty()).then(|| {
            quote! {
                fn tick(&mut self, now_ms: u32) { #(#periods)* #(#clocks)* }
            }
        })
    }

    fn input_edge(&self) -> TokenStream {
        let edges: Vec<TokenStream> = self
            .module
            .functions
            .iter()
            .filter_map(|function| match function.kind {
                FunctionKind::InputEdge { input, kind } => {
                    let input = Literal::u32_unsuffixed(input);
                    let level = match kind {
                        EdgeKind::Rising => quote!(level),
                        EdgeKind::Falling => quote!(!level),
                    };
                    let name = format_ident!("{}", function_name(function));
                    Some(quote!(if number == #input && #level { program::#name(self); }))
                }
                _ => None,
            })
            .collect();
        if edges.is_empty() {
            return TokenStream::new();
        }
        quote! {
            fn input_edge(&mut self, number: u32, level: bool) { #(#edges)* }
        }
    }
}
