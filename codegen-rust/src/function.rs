//! The functions of the plan as Rust.

use crate::format::{self, Body};
use crate::generate::{Generator, Item, function_name};
use crate::temps::type_of;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::plan::{Flow, Function, Node};
use rungc_emit::temps::Home;
use rungc_ir::node::{FunctionKind, Stmt};
use rungc_rt::EdgeKind;
use rungc_syntax::DeviceClass;
use std::rc::Rc;

/// The constant that says that a function is to be left; the states of parts count from 1.
const LEAVE: &str = "LEAVE";

impl Generator<'_> {
    /// Writes all functions of the plan, and those that they also call.
    pub fn functions(&mut self) {
        for index in 0..self.plan.functions.len() {
            let item = self.function(index);
            self.items.push(item);
        }
        self.states();
        self.indexed_coils();
        self.coils_of_kinds();
    }

    fn function(&mut self, index: usize) -> Item {
        let plan = Rc::clone(&self.plan);
        let function = &plan.functions[index];
        self.function = index;
        self.names = 0;
        self.numeric_temps.clear();
        self.uses.plc = true;
        let variables = self.variables(index);
        let (body, tail) = match function.body.split_last() {
            Some((last, body)) if function.ends_by_jump() => (body, self.last_jump(function, last)),
            _ => (function.body.as_slice(), self.end(function)),
        };
        let inner = self.nodes(body);
        let mut body = Body::default();
        body.code(variables);
        body.append(inner);
        body.code(tail);
        let plc_type = self.type_name.clone();
        let plc = match function.is_idle() {
            true => quote!(_: &mut #plc_type),
            false => quote!(plc: &mut #plc_type),
        };
        let hal = function.needs_hardware.then(|| {
            let hal = self.rt("Hal");
            quote!(, hal: &mut dyn #hal)
        });
        let returns = (function.flow != Flow::Void).then(|| quote!(-> Option<u32>));
        let doc = self.function_doc(function);
        let (doc, name) = (self.doc(&doc), self.planned_name(function));
        let head = quote!(#doc fn #name(#plc #hal) #returns);
        Item {
            text: match self.with_comments {
                true => format::function(&head, &body),
                false => {
                    let body = body.tokens();
                    quote!(#head { #body }).to_string()
                }
            },
            uses: std::mem::take(&mut self.uses),
        }
    }

    /// The name of a function of the plan.
    pub(crate) fn planned_name(&self, function: &Function) -> Ident {
        let root = function_name(&self.module.functions[function.root]);
        format_ident!("{root}{}", function.suffix.to_lowercase())
    }

    /// A call of a function of the plan.
    pub fn planned_call(&self, function: &Function) -> TokenStream {
        let name = self.planned_name(function);
        match function.needs_hardware {
            true => quote!(#name(plc, hal)),
            false => quote!(#name(plc)),
        }
    }

    /// The variables that are at the top of a function.
    fn variables(&self, index: usize) -> TokenStream {
        let temps = self.plan.temps.iter().zip(&self.module.temps);
        let here = temps.filter(|(temp, _)| temp.home() == Home::Variable(index) && temp.used > 0);
        here.map(|(temp, &ty)| {
            let name = format_ident!("{}", temp.to_string());
            let (_, zero) = type_of(ty);
            quote!(let mut #name = #zero;)
        })
        .collect()
    }

    /// Return value at the end of a function.
    fn end(&self, function: &Function) -> TokenStream {
        match function.flow {
            Flow::Void => TokenStream::new(),
            Flow::Part { next: Some(next) } => {
                let state = self.state_name(function.root, next);
                quote!(Some(#state))
            }
            Flow::Outlined | Flow::Part { next: None } => quote!(None),
        }
    }

    /// Return value of a function that ends by a jump or a return.
    fn last_jump(&mut self, function: &Function, last: &Node) -> TokenStream {
        if let Node::Stmt(Stmt::Goto(label)) = last {
            let state = self.label_state(*label);
            return quote!(Some(#state));
        }
        if function.flow == Flow::Void {
            return TokenStream::new();
        }
        let leave = self.leave();
        quote!(Some(#leave))
    }

    /// Return statement that leaves the function of the module.
    pub(crate) fn return_statement(&mut self) -> TokenStream {
        if self.is_void() {
            return quote!(return;);
        }
        let leave = self.leave();
        quote!(return Some(#leave);)
    }

    fn leave(&mut self) -> Ident {
        self.leaves = true;
        format_ident!("{LEAVE}")
    }

    /// Returns true if the function being written has no result.
    pub fn is_void(&self) -> bool {
        self.plan.functions[self.function].flow == Flow::Void
    }

    /// The constant that stands for a part: `PROGRAM_P12`.
    pub fn state_name(&self, root: usize, state: u32) -> Ident {
        let function = function_name(&self.module.functions[root]);
        let name = &self.plan.state_names(root)[state as usize - 1];
        format_ident!("{}", format!("{function}_{name}").to_uppercase())
    }

    /// Writes the constants that stand for parts, if there are any.
    fn states(&mut self) {
        let mut constants = TokenStream::new();
        if std::mem::take(&mut self.leaves) {
            let leave = format_ident!("{LEAVE}");
            let doc = self.doc("The function is left.");
            constants.extend(quote!(#doc pub(crate) const #leave: u32 = 0;));
        }
        for root in 0..self.module.functions.len() {
            for state in (1..).take(self.plan.state_names(root).len()) {
                let (name, value) = (self.state_name(root, state), Literal::u32_unsuffixed(state));
                let doc = self.doc("Part at which the program continues after a jump.");
                constants.extend(quote!(#doc pub(crate) const #name: u32 = #value;));
            }
        }
        if !constants.is_empty() {
            let item = self.item_of(constants);
            self.items.insert(0, item);
        }
    }

    fn function_doc(&self, function: &Function) -> String {
        if !function.is_whole() {
            return match function.steps(self.module) {
                Some((first, last)) if first < last => {
                    format!("From step {first} to the network at step {last}.")
                }
                Some((first, _)) => format!("At step {first}."),
                None => "A part of a network.".to_string(),
            };
        }
        match self.module.functions[function.root].kind {
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
        }
    }

    fn pointer_doc(&self, what: &str, class: DeviceClass, number: u32) -> String {
        let pointer = class.number(number);
        match self.device_comment(class, number) {
            Some(comment) => format!("{what} {pointer}: {comment}."),
            None => format!("{what} {pointer}."),
        }
    }
}
