//! Statements of the plan as statements of Rust.

use crate::coils::{OUT_COUNTER, OUT_TIMER};
use crate::expr::literal32;
use crate::format::Body;
use crate::generate::Generator;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::comments;
use rungc_emit::edges::{Asker, user_of_edge};
use rungc_emit::plan::{Flow, Node, Plan, Stations};
use rungc_emit::stations;
use rungc_ir::node::{Action, Edge, Expr, ExprId, LabelId, SetEntry, Stmt};
use rungc_rt::EdgeKind;
use rungc_syntax::text::one_line;
use std::rc::Rc;

impl Generator<'_> {
    /// The nodes of a body.
    pub fn nodes(&mut self, nodes: &[Node]) -> Body {
        let plan = Rc::clone(&self.plan);
        let mut body = Body::default();
        let mut i = 0;
        while let Some(node) = nodes.get(i) {
            if let Some((change, count)) = plan.ladders.next_move(self.module, &nodes[i..]) {
                self.step_move(&mut body, change);
                i += count;
                continue;
            }
            i += 1;
            let next = nodes.get(i);
            if Plan::is_silent(self.module, node, next) {
                continue;
            }
            self.named.clear();
            body.code(self.name_parts(&node.roots()));
            if let (Node::Stmt(Stmt::Do(Action::Edge(edge))), Some(next)) = (node, next)
                && let Some(Asker::Whole(user_of_edge) | Asker::Operand(user_of_edge)) =
                    user_of_edge(self.module, &plan, &self.storage, edge, next)
            {
                // The edge stands in what asks for it: `if plc.edges[0].rising(plc.x2) { … }`.
                let edge = self.edge(edge);
                self.named.clear();
                self.named.insert(user_of_edge, edge);
                body.code(self.name_parts(&next.roots()));
                self.node(&mut body, next);
                i += 1;
                continue;
            }
            self.node(&mut body, node);
        }
        body
    }

    fn node(&mut self, body: &mut Body, node: &Node) {
        match node {
            Node::Stmt(Stmt::Network(n)) => self.heading(body, *n),
            Node::Stmt(stmt) => {
                let tokens = self.statement(stmt);
                let beside = comments::written(stmt).filter(|_| !tokens.is_empty());
                body.code(tokens);
                let beside = beside
                    .and_then(|(class, number)| comments::beside(&self.storage, class, number));
                if let Some(text) = beside {
                    body.trailing_comment(&text);
                }
            }
            Node::If {
                cond,
                then,
                otherwise,
            } => self.branches(body, *cond, then, otherwise),
            Node::For { count, body: inner } => {
                let count = if let Expr::I16(n) = *self.module.expr(*count) {
                    literal32(i32::from(n.max(1)), false).tokens
                } else {
                    let count = self.typed(*count).receiver();
                    quote!(#count.max(1))
                };
                let inner = self.nodes(inner);
                body.block(quote!(for _ in 0..#count), inner);
            }
            Node::Repeat(stations) => self.stations(body, stations),
            Node::Steps { of, body: inner } => self.steps(body, of, inner),
            Node::Parts { parts, leaves } => self.parts(body, parts, *leaves),
            Node::Outlined(function) => body.code(self.outline(*function)),
        }
    }

    /// The heading of a network.
    pub(crate) fn heading(&self, body: &mut Body, network: u32) {
        if let Some(network) = self.module.networks.get(network as usize) {
            let clean = |text: &str| one_line(text).trim().to_string();
            body.comment(&comments::heading(network, clean));
        }
    }

    pub(crate) fn statement(&mut self, stmt: &Stmt) -> TokenStream {
        match stmt {
            Stmt::Do(action) => self.action(action),
            Stmt::CallSub(root) => self.call_sub(*root as usize),
            Stmt::Return => self.return_statement(),
            Stmt::Goto(label) => {
                let state = self.label_state(*label);
                quote!(return Some(#state);)
            }
            Stmt::Watch { steps, at } => self.watch(*steps, *at),
            // Written as nodes.
            Stmt::Network(_)
            | Stmt::If(_)
            | Stmt::For { .. }
            | Stmt::Repeat(_)
            | Stmt::Steps(_)
            | Stmt::Parts(_) => TokenStream::new(),
        }
    }

    fn action(&mut self, action: &Action) -> TokenStream {
        match action {
            Action::Let(temp, value) => self.assign_temp(*temp, *value),
            Action::Edge(edge) if self.plan.temp(edge.out).used == 0 => {
                let (memory, input) = (self.edge_memory(edge), self.expr(edge.input));
                quote!(#memory.0 = #input;)
            }
            Action::Edge(edge) => {
                let changed = self.edge(edge);
                self.bind(edge.out, changed)
            }
            Action::SetFlag(flag, value) => {
                let (flag, value) = (self.flag(*flag), self.expr(*value));
                quote!(plc.#flag = #value;)
            }
            Action::SetCell(cell, value) => {
                let (cell, value) = (self.cell(*cell), self.expr(*value));
                quote!(plc.#cell = #value;)
            }
            Action::SetEntry(SetEntry {
                table,
                index,
                value,
            }) => {
                let (table, index) = (self.table(*table), self.expr(*index));
                let value = self.expr(*value);
                quote!(plc.#table[#index as usize] = #value;)
            }
            Action::Write(access, value) => self.write(*access, *value),
            Action::Timer(coil) => self.timer(coil),
            Action::TimerAt(coil) => self.indexed_coil(OUT_TIMER, coil),
            Action::TimerGoesOn { number, kind } => self.timer_goes_on(*number, *kind),
            Action::Counter16(coil) => self.counter16(coil),
            Action::Counter16At(coil) => self.indexed_coil(OUT_COUNTER, coil),
            Action::Counter32(coil) => self.counter32(coil),
            Action::Count(count) => self.count(count),
            Action::Reset { place, holds } => self.reset(*place, *holds),
            Action::Block(block) => self.block(block),
            Action::Call(call) => self.call(call),
            Action::Fetch(fetch) => self.fetch(fetch),
            Action::Send(send) => self.send(send),
            Action::Fault { code, step } => self.fault(*code, *step),
            Action::RestartWatchdog => self.watchdog_begins(&quote!(plc)).unwrap_or_default(),
            Action::Stop => {
                let (program, stop) = (self.rt("Program"), self.rt("Stop"));
                quote!(plc.error.stop = #stop::Program; #program::set_running(plc, false);)
            }
            Action::Clear { latched: false } => quote!(plc.clear_general();),
            Action::Clear { latched: true } => quote!(plc.clear_latched();),
        }
    }

    fn fault(&mut self, code: u16, step: u32) -> TokenStream {
        let (code, step) = (
            Literal::u16_unsuffixed(code),
            Literal::u16_unsuffixed(step as u16),
        );
        quote!(plc.fault(#code, #step);)
    }

    fn watch(&mut self, steps: u32, at: u32) -> TokenStream {
        let steps = Literal::u32_unsuffixed(steps);
        let at = Literal::u16_unsuffixed(at as u16);
        let leave = self.return_statement();
        quote!(if plc.out_of_time(#steps, #at) { #leave })
    }

    /// The constant that stands for the part with this label.
    pub(crate) fn label_state(&self, label: LabelId) -> Option<Ident> {
        let root = self.plan.functions[self.function].root;
        let state = self.plan.state(root, label)?;
        Some(self.state_name(root, state))
    }

    /// `plc.edges[0].rising(plc.x2)`.
    fn edge(&mut self, edge: &Edge) -> TokenStream {
        let method = match edge.kind {
            EdgeKind::Rising => format_ident!("rising"),
            EdgeKind::Falling => format_ident!("falling"),
        };
        let (memory, input) = (self.edge_memory(edge), self.expr(edge.input));
        quote!(#memory.#method(#input))
    }

    /// `plc.edges[0]`.
    fn edge_memory(&self, edge: &Edge) -> TokenStream {
        let memory = self.plan.ladders.edge(edge.memory);
        let first = Literal::u32_unsuffixed(memory);
        let further = match edge.index.map(|index| self.module.expr(index)) {
            Some(&Expr::Stride(_, 1)) => Some(quote!(i)),
            Some(&Expr::Stride(_, by)) => {
                let by = Literal::u32_unsuffixed(by);
                Some(quote!(#by * i))
            }
            _ => None,
        };
        let i = match further {
            Some(further) if memory == 0 => further,
            Some(further) => quote!(#first + #further),
            None => quote!(#first),
        };
        quote!(plc.edges[#i])
    }

    /// A loop over rungs that the program repeats.
    fn stations(&mut self, body: &mut Body, stations: &Stations) {
        body.comment(&stations::heading(stations));
        let iterations = Literal::u32_unsuffixed(stations.count);
        self.invariants = stations::invariants(self.module, &self.storage, stations);
        body.code(self.invariant_lets());
        (self.in_station_loop, self.iterations) = (true, stations.count);
        let inner = self.nodes(&stations.body);
        self.in_station_loop = false;
        self.invariants.clear();
        body.block(quote!(for i in 0..#iterations), inner);
    }

    fn branches(&mut self, body: &mut Body, cond: ExprId, then: &[Node], otherwise: &[Node]) {
        // `if a {} else { b }` is `if !a { b }`.
        let (code, first, second) = if then.is_empty() {
            let code = if let Expr::Not(a) = *self.module.expr(cond) {
                self.expr(a)
            } else {
                self.not(cond)
            };
            (code, otherwise, then)
        } else {
            (self.expr(cond), then, otherwise)
        };
        let first = self.nodes(first);
        let second = self.nodes(second);
        body.branches(code.tokens, first, second);
    }

    fn call_sub(&mut self, root: usize) -> TokenStream {
        let plan = Rc::clone(&self.plan);
        let call = plan.whole(root).map(|function| self.planned_call(function));
        call.map_or(TokenStream::new(), |call| quote!(#call;))
    }

    /// Parts between which jumps go back and forth: a loop over the part to run next.
    fn parts(&mut self, body: &mut Body, parts: &[(u32, usize)], leaves: bool) {
        let plan = Rc::clone(&self.plan);
        let root = plan.functions[self.function].root;
        let call = |this: &Self, function: usize| this.planned_call(&plan.functions[function]);
        if let (&[(state, function)], false) = (parts, leaves) {
            let (state, call) = (self.state_name(root, state), call(self, function));
            body.comment(comments::ONE_PART);
            body.code(quote!(while #call == Some(#state) {}));
            return;
        }
        let first = parts
            .first()
            .map(|&(state, _)| self.state_name(root, state));
        let arms = parts.iter().map(|&(state, function)| {
            let (state, call) = (self.state_name(root, state), call(self, function));
            quote!(#state => #call,)
        });
        let arms: TokenStream = arms.collect();
        let outside = match (leaves, self.is_void()) {
            (true, true) => quote!(return),
            (true, false) => quote!(return next),
            (false, _) => quote!(None),
        };
        body.comment(comments::PARTS);
        body.code(quote! {
            let mut next = Some(#first);
            while let Some(part) = next {
                next = match part { #arms _ => #outside };
            }
        });
    }

    /// A call of a block that is a separate function.
    fn outline(&mut self, function: usize) -> TokenStream {
        let plan = Rc::clone(&self.plan);
        let function = &plan.functions[function];
        let call = self.planned_call(function);
        match (function.flow == Flow::Void, self.is_void()) {
            (true, _) => quote!(#call;),
            (false, true) => quote!(if #call.is_some() { return; }),
            (false, false) => quote!(if let Some(next) = #call { return Some(next); }),
        }
    }
}
