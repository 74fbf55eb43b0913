//! Functions: the module's own, and those that its long bodies are split into.

use crate::analysis::{self, Declared, Temps};
use crate::generate::{Generator, Item, function_name};
use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use rungc_ir::node::{Function, FunctionKind, Stmt, TempId};
use rungc_rt::EdgeKind;
use rungc_syntax::DeviceClass;

/// A body of more lines than this is split.
const MAX_LINES: usize = 60;

/// A piece ends at the first network after this many lines.
const PIECE_LINES: usize = 40;

/// More parameters than this make clippy speak up.
const MAX_PARAMETERS: usize = 7;

/// How a piece of a body is handed what it needs.
struct Interface {
    parameters: Vec<TempId>,
    results: Vec<TempId>,
}

impl Generator<'_> {
    /// Writes all functions that the scan reaches.
    pub fn functions(&mut self) {
        let module = self.module;
        for (n, function) in module.functions.iter().enumerate() {
            let is_reached = self.calls.reached.get(n).copied().unwrap_or(false);
            if is_reached && !function.body.is_empty() {
                self.function(n, function);
            }
        }
        self.indexed_coils();
        self.coils_of_kinds();
    }

    fn function(&mut self, n: usize, function: &Function) {
        self.temps = Temps::of(self.module, &function.body);
        self.declare = self.temps.before();
        self.assigned.clear();
        let at = self.items.len();
        self.items.push(Item::default());
        let body = self.body(&function.body);
        let needs_hal = self.calls.needs_hal.get(n).copied().unwrap_or(false);
        let doc = match function.kind {
            FunctionKind::Begin => "Special relays and registers, before the program.".to_string(),
            FunctionKind::Main => "The program.".to_string(),
            FunctionKind::End => "END processing.".to_string(),
            FunctionKind::Subroutine(p) => self.pointer_doc("Subroutine", DeviceClass::P, p),
            FunctionKind::InputEdge { input, kind } => {
                let what = match kind {
                    EdgeKind::Rising => "on",
                    EdgeKind::Falling => "off",
                };
                format!("Input terminal X{input:03o} goes {what}.")
            }
            FunctionKind::TakeInterrupts => {
                "Runs the interrupt routines that are requested.".to_string()
            }
            FunctionKind::Signals => {
                "An input has changed at which instructions look that send pulses.".to_string()
            }
            FunctionKind::Interrupt(i) => self.pointer_doc("Interrupt routine", DeviceClass::I, i),
        };
        let name = self.unique_name(function_name(function));
        let interface = Interface {
            parameters: Vec::new(),
            results: Vec::new(),
        };
        self.items[at] = self.item(&doc, &name.to_string(), needs_hal, &interface, body);
    }

    fn pointer_doc(&self, what: &str, class: DeviceClass, number: u32) -> String {
        let pointer = class.number(number);
        match self.device_comment(class, number) {
            Some(comment) => format!("{what} {pointer}: {comment}."),
            None => format!("{what} {pointer}."),
        }
    }

    /// A function's text.
    fn item(
        &mut self,
        doc: &str,
        name: &str,
        needs_hal: bool,
        interface: &Interface,
        mut body: TokenStream,
    ) -> Item {
        let name = quote::format_ident!("{}", name);
        self.uses.plc = true;
        let plc_type = &self.type_name.clone();
        let mut parameters = vec![if mentions(&body, "plc") {
            quote!(plc: &mut #plc_type)
        } else {
            quote!(_: &mut #plc_type)
        }];
        if needs_hal {
            let hal = self.rt("Hal");
            parameters.push(quote!(hal: &mut dyn #hal));
        }
        for &temp in &interface.parameters {
            let (name, ty) = (self.temp_name(temp), self.temp_type(temp));
            parameters.push(quote!(#name: #ty));
        }
        let types: Vec<_> = interface
            .results
            .iter()
            .map(|&temp| self.temp_type(temp))
            .collect();
        let names: Vec<_> = interface
            .results
            .iter()
            .map(|&temp| self.temp_name(temp))
            .collect();
        let returns = match types.as_slice() {
            [] => TokenStream::new(),
            [one] => quote!(-> #one),
            more => quote!(-> (#(#more),*)),
        };
        body.extend(match names.as_slice() {
            [] => TokenStream::new(),
            [one] => one.to_token_stream(),
            more => quote!((#(#more),*)),
        });
        let allow = (parameters.len() > MAX_PARAMETERS).then(|| {
            quote!(#[allow(clippy::too_many_arguments, reason = "a piece of a longer function")])
        });
        let doc = self.doc(doc);
        self.item_of(quote! {
            #doc
            #allow
            fn #name(#(#parameters),*) #returns { #body }
        })
    }

    /// The statements of a body; of a long one, calls of the functions that it is split into.
    pub fn body(&mut self, body: &[Stmt]) -> TokenStream {
        let weights: Vec<usize> = body
            .iter()
            .map(|stmt| analysis::weight(self.module, stmt))
            .collect();
        if weights.iter().sum::<usize>() <= MAX_LINES {
            return self.statements(body, 0..body.len());
        }
        let mut out = TokenStream::new();
        for range in pieces(body, &weights) {
            let tokens = match self.interface(body, &range) {
                Some(interface) if range.len() < body.len() => self.piece(body, range, interface),
                _ => self.statements(body, range),
            };
            out.extend(tokens);
        }
        out
    }

    /// What a piece takes and returns; `None` if it cannot be a function of its own.
    fn interface(&self, body: &[Stmt], range: &std::ops::Range<usize>) -> Option<Interface> {
        let stmts = body.get(range.clone())?;
        if analysis::escapes(stmts) {
            return None;
        }
        let mut interface = Interface {
            parameters: Vec::new(),
            results: Vec::new(),
        };
        for (temp, here) in analysis::count(self.module, stmts) {
            let all = self.temps.count(temp);
            if here == all {
                continue;
            }
            let is_simple = self.temps.declared(temp) == Some(Declared::There { again: false });
            match here.assigned {
                0 => interface.parameters.push(temp),
                1 if is_simple => interface.results.push(temp),
                _ => return None,
            }
        }
        Some(interface)
    }

    /// Makes a piece of a body a function, and calls it.
    fn piece(
        &mut self,
        body: &[Stmt],
        range: std::ops::Range<usize>,
        interface: Interface,
    ) -> TokenStream {
        let stmts = body.get(range.clone()).unwrap_or_default();
        let steps = || {
            stmts.iter().filter_map(|stmt| match stmt {
                Stmt::Network(n) => self.module.networks.get(*n as usize).map(|n| n.step),
                _ => None,
            })
        };
        let first = match stmts.first() {
            Some(Stmt::Network(_)) => steps().next(),
            _ => None,
        };
        let (first, last) = (first.unwrap_or(self.step), steps().next_back());
        let doc = match last.filter(|&last| last != first) {
            Some(last) => format!("From step {first} to the network at step {last}."),
            None => format!("At step {first}."),
        };
        let name = self.unique_name(format!("step_{first}"));
        let needs_hal = self.calls.stmts_need_hal(stmts);

        let uses = std::mem::take(&mut self.uses);
        let comments = std::mem::take(&mut self.comments);
        let jumps = std::mem::take(&mut self.jumps);
        let at = self.items.len();
        self.items.push(Item::default());
        let code = self.statements(body, range);
        self.items[at] = self.item(&doc, &name.to_string(), needs_hal, &interface, code);
        self.uses = uses;
        self.comments = comments;
        self.jumps = jumps;

        let hal = needs_hal.then(|| quote!(hal,));
        let arguments = interface.parameters.iter().map(|&t| self.temp_name(t));
        let call = quote!(#name(plc, #hal #(#arguments),*));
        let names: Vec<_> = interface
            .results
            .iter()
            .map(|&t| self.temp_name(t))
            .collect();
        match names.as_slice() {
            [] => quote!(#call;),
            [one] => quote!(let #one = #call;),
            more => quote!(let (#(#more),*) = #call;),
        }
    }
}

/// Where to cut a body: at networks if there are any in reach.
fn pieces(body: &[Stmt], weights: &[usize]) -> Vec<std::ops::Range<usize>> {
    let mut pieces = Vec::new();
    let (mut start, mut lines) = (0, 0);
    for (i, (stmt, weight)) in body.iter().zip(weights).enumerate() {
        let at_network = matches!(stmt, Stmt::Network(_));
        let is_full = lines >= PIECE_LINES && at_network;
        if i > start && (is_full || lines + weight > 2 * MAX_LINES) {
            pieces.push(start..i);
            (start, lines) = (i, 0);
        }
        lines += weight;
    }
    pieces.push(start..body.len());
    pieces
}

/// Whether the tokens have this identifier.
fn mentions(tokens: &TokenStream, name: &str) -> bool {
    tokens.clone().into_iter().any(|token| match token {
        proc_macro2::TokenTree::Ident(ident) => ident == name,
        proc_macro2::TokenTree::Group(group) => mentions(&group.stream(), name),
        _ => false,
    })
}
