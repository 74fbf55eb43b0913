//! Statements of the IR as statements of Rust.

use crate::analysis::{self, Declared};
use crate::coils::{OUT_COUNTER, OUT_TIMER};
use crate::expr::{Code, Shape, literal32};
use crate::generate::{Generator, function_name};
use crate::storage::PrintStorage;
use proc_macro2::{Delimiter, Literal, Punct, Spacing, TokenStream, TokenTree};
use quote::{format_ident, quote};
use rungc_ir::node::{Arg, CellId, Expr, ExprId, LabelId, Part, Place, Stmt, TempId, Ty};
use rungc_rt::EdgeKind;
use rungc_syntax::DeviceClass;

impl Generator<'_> {
    /// A run of statements of one body.
    pub fn statements(&mut self, body: &[Stmt], range: std::ops::Range<usize>) -> TokenStream {
        let mut out = TokenStream::new();
        let mut i = range.start;
        while let Some(stmt) = body.get(..range.end).and_then(|body| body.get(i)) {
            self.declarations(body, i, &mut out);
            let next = body.get(..range.end).and_then(|body| body.get(i + 1));
            let lets = self.hoist(&analysis::expressions(stmt));
            out.extend(lets);
            if self.is_asked_once(stmt, next) {
                self.inlined = rungc_ir::walk::assigned(stmt).zip(self.edge(stmt));
            } else {
                let tokens = self.statement(stmt);
                out.extend(tokens);
            }
            i += 1;
        }
        out
    }

    /// Whether only the next statement asks for an edge, and once: then the edge stands in it, `if plc.edges[0].rising(plc.x2) { … }`.
    fn is_asked_once(&self, stmt: &Stmt, next: Option<&Stmt>) -> bool {
        let (Stmt::Edge { out, .. }, Some(next)) = (stmt, next) else {
            return false;
        };
        let count = self.temps.count(*out);
        if (count.assigned, count.read) != (1, 1) {
            return false;
        }
        let is_written = match next {
            Stmt::If { .. } => true,
            Stmt::WriteBit(place, _) => {
                let plc = quote!(plc);
                place.index.is_none() && self.storage.bit(&plc, place.class, place.number).is_some()
            }
            _ => false,
        };
        is_written && analysis::reads_once(self.module, &analysis::expressions(next), *out)
    }

    /// The declarations in front of a statement.
    fn declarations(&mut self, body: &[Stmt], i: usize, out: &mut TokenStream) {
        for temp in self
            .declare
            .remove(&(analysis::key(body), i))
            .unwrap_or_default()
        {
            let name = self.temp_name(temp);
            let zero = match self.module.temps.get(temp.0 as usize) {
                Some(Ty::I16) => quote!(0i16),
                Some(Ty::I32) => quote!(0i32),
                Some(Ty::F32) => quote!(0f32),
                Some(Ty::Bit) | None => quote!(false),
            };
            out.extend(quote!(let mut #name = #zero;));
            self.assigned.insert(temp);
        }
    }

    /// `plc.edges[0].rising(plc.x2)`.
    fn edge(&mut self, stmt: &Stmt) -> Option<TokenStream> {
        let Stmt::Edge {
            edge,
            index,
            kind,
            input,
            ..
        } = stmt
        else {
            return None;
        };
        let first = Literal::u32_unsuffixed(edge.0);
        let further = match index.map(|index| self.module.expr(index)) {
            Some(&Expr::Stride(_, 1)) => Some(quote!(i)),
            Some(&Expr::Stride(_, by)) => {
                let by = Literal::u32_unsuffixed(by);
                Some(quote!(#by * i))
            }
            _ => None,
        };
        let i = match further {
            Some(further) if edge.0 == 0 => further,
            Some(further) => quote!(#first + #further),
            None => quote!(#first),
        };
        let method = match kind {
            EdgeKind::Rising => format_ident!("rising"),
            EdgeKind::Falling => format_ident!("falling"),
        };
        let input = self.expr(*input);
        Some(quote!(plc.edges[#i].#method(#input)))
    }

    fn statement(&mut self, stmt: &Stmt) -> TokenStream {
        match stmt {
            Stmt::Network(n) => self.network(*n),
            Stmt::Let(temp, value) => self.assign_temp(*temp, *value),
            Stmt::Edge { out, .. } => {
                let Some(edge) = self.edge(stmt) else {
                    return TokenStream::new();
                };
                self.bind(*out, edge)
            }
            Stmt::WriteBit(place, value) => self.write_bit(*place, *value),
            Stmt::WriteWordBit(place, bit, value) => self.write_word_bit(*place, *bit, *value),
            Stmt::WriteWord(place, value) => self.write_word(*place, *value),
            Stmt::WritePair(place, value) => self.write_pair(*place, *value, "words"),
            Stmt::WriteFloat(place, value) => self.write_pair(*place, *value, "float_words"),
            Stmt::WriteNibbles {
                place,
                digits,
                value,
            } => self.write_nibbles(*place, *digits, *value),
            Stmt::TimerGoesOn { number, kind } => {
                let kind = self.timer_kind(*kind);
                match self.storage.cell(&quote!(plc), DeviceClass::T, *number) {
                    Some(cell) => quote!(#cell.go_on(#kind, &plc.sys);),
                    None => TokenStream::new(),
                }
            }
            Stmt::SetCell(cell, value) => {
                let (cell, value) = (self.cell(*cell), self.expr(*value));
                quote!(plc.#cell = #value;)
            }
            Stmt::SetEntry(table, index, value) => {
                let (table, index) = (self.table(*table), self.expr(*index));
                let value = self.expr(*value);
                quote!(plc.#table[#index as usize] = #value;)
            }
            Stmt::Timer { .. }
            | Stmt::Counter16 { .. }
            | Stmt::Counter32 { .. }
            | Stmt::Count { .. } => self.coil(stmt),
            Stmt::TimerAt {
                place,
                drive,
                preset,
            } => self.indexed_coil(OUT_TIMER, *place, *drive, *preset),
            Stmt::Counter16At {
                place,
                drive,
                preset,
            } => self.indexed_coil(OUT_COUNTER, *place, *drive, *preset),
            Stmt::SetFlag(flag, value) => {
                let (flag, value) = (self.flag(*flag), self.expr(*value));
                quote!(plc.#flag = #value;)
            }
            Stmt::Reset(place) => self.reset(*place),
            Stmt::If {
                cond,
                then,
                otherwise,
            } => self.branches(*cond, then, otherwise),
            Stmt::For { count, body } => {
                let count = match *self.module.expr(*count) {
                    Expr::I16(n) => literal32(i32::from(n.max(1)), false).tokens,
                    _ => {
                        let count = self.typed(*count).receiver();
                        quote!(#count.max(1))
                    }
                };
                let body = self.body(body);
                quote!(for _ in 0..#count { #body })
            }
            Stmt::Repeat {
                count, body, steps, ..
            } => self.rounds(*count, body, *steps),
            Stmt::CallSub(n) => self.call_sub(*n),
            Stmt::Return => quote!(return;),
            Stmt::Parts(parts) => self.parts(parts),
            Stmt::Goto(label) => self.goto(*label),
            Stmt::Call { .. } => self.call(stmt),
            Stmt::Fetch {
                from,
                wide,
                value,
                there,
                step,
            } => self.fetch(from, (*wide, *step), *value, *there),
            Stmt::Send {
                to,
                wide,
                value,
                step,
            } => {
                let (send, site) = (self.rt("send"), self.site(*step, *wide));
                let (to, is_narrow) = (self.argument(to), !wide);
                let value = self.typed(*value);
                let value = if is_narrow {
                    quote!(i32::from(#value))
                } else {
                    value.tokens
                };
                quote!(#send(#site, #to, #value, plc, hal);)
            }
            Stmt::Fault { code, step } => {
                let (report, fault) = (self.rt("report"), self.rt("Fault"));
                let (code, step) = (
                    Literal::u16_unsuffixed(*code),
                    Literal::u32_unsuffixed(*step),
                );
                quote!(#report(plc, #fault(#code), #step);)
            }
            Stmt::Watch { steps, at } => {
                let steps = Literal::u32_unsuffixed(*steps);
                let at = Literal::u16_unsuffixed(*at as u16);
                quote!(if plc.out_of_time(#steps, #at) { return; })
            }
            Stmt::Stop => {
                let (program, stop) = (self.rt("Program"), self.rt("Stop"));
                quote!(plc.error.stop = #stop::Program; #program::set_running(plc, false);)
            }
            Stmt::Clear { latched: false } => quote!(plc.clear_general();),
            Stmt::Clear { latched: true } => quote!(plc.clear_latched();),
        }
    }

    /// A loop over rungs that the program repeats.
    fn rounds(&mut self, count: u32, body: &[Stmt], (first, last): (u32, u32)) -> TokenStream {
        let text = format!(
            "steps {first} to {last}: {count} times the same rungs, each time with the next devices"
        );
        let comment = match self.with_comments {
            true => self.comments.line(&text),
            false => TokenStream::new(),
        };
        let rounds = Literal::u32_unsuffixed(count);
        let constants = self.constants(body);
        self.in_rounds = true;
        let body = self.statements(body, 0..body.len());
        self.in_rounds = false;
        self.constants.clear();
        quote!(#comment #constants for i in 0..#rounds { #body })
    }

    fn network(&mut self, n: u32) -> TokenStream {
        let Some(network) = self.module.networks.get(n as usize) else {
            return TokenStream::new();
        };
        self.step = network.step;
        if !self.with_comments {
            return TokenStream::new();
        }
        let mut text = format!("step {}", network.step);
        let words = [&network.statement, &network.note];
        for (i, words) in words.into_iter().flatten().enumerate() {
            text.push_str(if i == 0 { ": " } else { "; " });
            text.push_str(words);
        }
        self.comments.line(&text)
    }

    /// The comment of a device, behind the statement that writes it.
    pub fn end_comment(&mut self, class: DeviceClass, number: u32) -> TokenStream {
        match self.device_comment(class, number) {
            Some(text) if self.with_comments => self.comments.end(text),
            _ => TokenStream::new(),
        }
    }

    fn assign_temp(&mut self, temp: TempId, value: ExprId) -> TokenStream {
        if self.temps.count(temp).read == 0 {
            return TokenStream::new();
        }
        let value = match self.assigns_level(temp, value) {
            true => self.level(value),
            false => self.typed(value),
        };
        self.bind(temp, value.tokens)
    }

    /// Gives a temporary its value, and declares it where this is its first.
    fn bind(&mut self, temp: TempId, value: TokenStream) -> TokenStream {
        if self.temps.count(temp).read == 0 {
            return quote!(#value;);
        }
        let name = self.temp_name(temp);
        if !self.assigned.insert(temp) {
            return quote!(#name = #value;);
        }
        match self.temps.declared(temp) {
            Some(Declared::There { again: true }) => quote!(let mut #name = #value;),
            _ => quote!(let #name = #value;),
        }
    }

    /// `target = value;`, or `target |= …;`.
    fn assign(&mut self, target: TokenStream, value: Code, place: Place) -> TokenStream {
        let written = target.to_string();
        let comment = self.end_comment(place.class, place.number);
        if let (Shape::Binary(op), Some((a, b))) = (value.shape, &value.operands) {
            let commutes = matches!(op, "&" | "|" | "^");
            let rest = if a.to_string() == written {
                Some(b)
            } else if commutes && b.to_string() == written {
                Some(a)
            } else {
                None
            };
            let joined = match (op, rest.map(without_parentheses)) {
                ("&", Some(rest)) => Some(quote!(#target &= #rest;)),
                ("|", Some(rest)) => Some(quote!(#target |= #rest;)),
                ("^", Some(rest)) => Some(quote!(#target ^= #rest;)),
                ("/", Some(rest)) => Some(quote!(#target /= #rest;)),
                ("%", Some(rest)) => Some(quote!(#target %= #rest;)),
                _ => None,
            };
            if let Some(joined) = joined {
                return quote!(#joined #comment);
            }
        }
        quote!(#target = #value; #comment)
    }

    fn write_bit(&mut self, place: Place, value: ExprId) -> TokenStream {
        let cell = self.bit_cell(place);
        let value = match self.storage.is_level(place.class, place.number) {
            true if cell.is_some() => self.level(value),
            _ => self.expr(value),
        };
        match cell {
            Some(cell) => self.assign(cell, value, place),
            None if place.index.is_some() => {
                let (class, number) = self.indexed(place);
                quote!(plc.set_bit_at(#class, #number, #value);)
            }
            // A special device that nobody looks at.
            None => quote!(let _ = #value;),
        }
    }

    fn write_word(&mut self, place: Place, value: ExprId) -> TokenStream {
        let plc = quote!(plc);
        if place.index.is_some() {
            let value = self.expr(value);
            if let Some(cell) = self.word_cell(place) {
                return self.assign(cell, value, place);
            }
            let (class, number) = self.indexed(place);
            return quote!(plc.set_word_at(#class, #number, #value););
        }
        if let Some(counter) = self.storage.counter32(&plc, place.class, place.number) {
            let value = self.typed(value);
            return self.assign(counter, Code::atom(quote!(i32::from(#value))), place);
        }
        let value = self.expr(value);
        match self.storage.word(&plc, place.class, place.number) {
            Some(cell) => self.assign(cell, value, place),
            None => quote!(let _ = #value;),
        }
    }

    fn write_word_bit(&mut self, place: Place, bit: u8, value: ExprId) -> TokenStream {
        let value = self.expr(value);
        let word = self.read_word(place);
        let with_bit = self.word_function("with_bit");
        let bit = Literal::u8_unsuffixed(bit);
        let value = Code::atom(quote!(#with_bit(#word, #bit, #value)));
        if place.index.is_some() {
            let (class, number) = self.indexed(place);
            return quote!(plc.set_word_at(#class, #number, #value););
        }
        match self.storage.word(&quote!(plc), place.class, place.number) {
            Some(cell) => self.assign(cell, value, place),
            None => quote!(let _ = #value;),
        }
    }

    /// Writes a pair with the function of `rungc_rt::word` that makes words of the value.
    fn write_pair(&mut self, place: Place, value: ExprId, function: &'static str) -> TokenStream {
        let value = self.expr(value);
        if place.index.is_some() {
            let (class, number) = self.indexed(place);
            let method = if function == "words" {
                format_ident!("set_pair_at")
            } else {
                format_ident!("set_float_at")
            };
            return quote!(plc.#method(#class, #number, #value););
        }
        let plc = quote!(plc);
        if let Some(counter) = self.storage.counter32(&plc, place.class, place.number) {
            return self.assign(counter, value, place);
        }
        let (high_class, high) = self.high_word(place);
        let low = self.storage.word(&plc, place.class, place.number);
        let high = self.storage.word(&plc, high_class, high);
        if low.is_none() && high.is_none() {
            return quote!(let _ = #value;);
        }
        let [low, high] = [low, high].map(|cell| cell.unwrap_or_else(|| quote!(_)));
        let function = self.word_function(function);
        let comment = self.end_comment(place.class, place.number);
        quote!([#low, #high] = #function(#value); #comment)
    }

    fn write_nibbles(&mut self, place: Place, digits: u8, value: ExprId) -> TokenStream {
        let is_narrow = self.module.ty(value) == Ty::I16;
        let value = self.typed(value);
        let value = if is_narrow {
            quote!(i32::from(#value))
        } else {
            value.tokens
        };
        if place.index.is_some() {
            let (class, number) = self.indexed(place);
            let digits = Literal::u8_unsuffixed(digits);
            return quote!(plc.set_nibbles_at(#digits, #class, #number, #value););
        }
        let count = 4 * u32::from(digits);
        if let Some(slice) = self.array_slice(place, count) {
            let unpack_to = self.word_function("unpack_to");
            return quote!(#unpack_to(#value, &mut #slice););
        }
        let unpack = self.word_function("unpack");
        let cells = (0..count).map(|i| {
            self.storage
                .bit(&quote!(plc), place.class, place.number + i)
                .unwrap_or_else(|| quote!(_))
        });
        quote!([#(#cells),*] = #unpack(#value);)
    }

    fn branches(&mut self, cond: ExprId, then: &[Stmt], otherwise: &[Stmt]) -> TokenStream {
        let has_effect = self.inlined.is_some();
        // `if a {} else { b }` is `if !a { b }`.
        let (code, first, second) = if then.is_empty() {
            let code = match *self.module.expr(cond) {
                Expr::Not(a) => self.expr(a),
                _ => self.not(cond),
            };
            (code, otherwise, then)
        } else {
            (self.expr(cond), then, otherwise)
        };
        let first = self.body(first);
        let second = self.body(second);
        if !second.is_empty() {
            quote!(if #code { #first } else { #second })
        } else if !first.is_empty() {
            quote!(if #code { #first })
        } else if has_effect {
            quote!(let _ = #code;)
        } else {
            TokenStream::new()
        }
    }

    fn call_sub(&mut self, n: u32) -> TokenStream {
        let Some(function) = self.module.functions.get(n as usize) else {
            return TokenStream::new();
        };
        if function.body.is_empty() {
            return TokenStream::new();
        }
        let name = format_ident!("{}", function_name(function));
        let needs_hal = self.calls.needs_hal.get(n as usize).copied();
        if needs_hal.unwrap_or(false) {
            quote!(#name(plc, hal);)
        } else {
            quote!(#name(plc);)
        }
    }

    /// Parts between which jumps go to and fro: a loop over the number of the part to run next.
    fn parts(&mut self, parts: &[Part]) -> TokenStream {
        let is_jumped_to = parts.iter().any(|part| jumps_to(&part.body, parts));
        if !is_jumped_to {
            return parts.iter().map(|part| self.body(&part.body)).collect();
        }
        let depth = self.jumps.len();
        let labels = parts.iter().map(|part| part.label).collect();
        self.jumps.push(labels);
        let label = jump_label(depth);
        let part_variable = part_variable(depth);
        let mut arms = TokenStream::new();
        for (i, part) in parts.iter().enumerate() {
            let is_last = i + 1 == parts.len();
            let pattern = if is_last {
                quote!(_)
            } else {
                let i = Literal::usize_unsuffixed(i);
                quote!(#i)
            };
            let name = match &part.name {
                Some(name) if self.with_comments => self.comments.line(name),
                _ => TokenStream::new(),
            };
            let body = self.body(&part.body);
            let ends = matches!(part.body.last(), Some(Stmt::Goto(_) | Stmt::Return));
            let tail = if ends {
                TokenStream::new()
            } else if is_last {
                quote!(break;)
            } else {
                let next = Literal::usize_unsuffixed(i + 1);
                quote!(#part_variable = #next;)
            };
            arms.extend(quote!(#pattern => { #name #body #tail }));
        }
        self.jumps.pop();
        let comment = if self.with_comments {
            self.comments
                .line("These jumps do not nest: the parts between their labels are run by number.")
        } else {
            TokenStream::new()
        };
        quote! {
            #comment
            let mut #part_variable = 0;
            #label: loop {
                match #part_variable { #arms }
            }
        }
    }

    fn goto(&mut self, label: LabelId) -> TokenStream {
        for (depth, labels) in self.jumps.iter().enumerate().rev() {
            if let Some(part) = labels.iter().position(|l| *l == Some(label)) {
                let name = jump_label(depth);
                let variable = part_variable(depth);
                let part = Literal::usize_unsuffixed(part);
                return quote!(#variable = #part; continue #name;);
            }
        }
        TokenStream::new()
    }

    fn call(&mut self, stmt: &Stmt) -> TokenStream {
        let Stmt::Call {
            function,
            wide,
            ref args,
            drive,
            signal,
            slot,
            step,
        } = *stmt
        else {
            return TokenStream::new();
        };
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
        let args: Vec<TokenStream> = args.iter().map(|arg| self.argument(arg)).collect();
        quote!(#call(#module::#name, #site, &[#(#args),*], plc, hal);)
    }

    /// Where an instruction stands, and its form.
    fn site(&mut self, step: u32, wide: bool) -> TokenStream {
        let site = self.rt("Site");
        let step = Literal::u32_unsuffixed(step);
        let wide = wide.then(|| quote!(.wide()));
        quote!(#site::at(#step)#wide)
    }

    fn fetch(
        &mut self,
        from: &Arg,
        (wide, step): (bool, u32),
        value: CellId,
        there: TempId,
    ) -> TokenStream {
        let (fetch, site) = (self.rt("fetch"), self.site(step, wide));
        let (from, cell) = (self.argument(from), self.cell(value));
        let fetched = quote! {
            #fetch(#site, #from, plc, hal).map(|value| plc.#cell = value).is_some()
        };
        self.bind(there, fetched)
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
    pub fn operand_place(&mut self, place: Place) -> (TokenStream, TokenStream) {
        let class = self.class(place.class);
        let number = match place.index {
            None => literal32(place.number as i32, false).tokens,
            Some(index) => self.offset(place.number as i32, index),
        };
        (class, number)
    }
}

/// An operand as it stands alone.
fn without_parentheses(operand: &TokenStream) -> TokenStream {
    let mut tokens = operand.clone().into_iter();
    match (tokens.next(), tokens.next()) {
        (Some(TokenTree::Group(group)), None) if group.delimiter() == Delimiter::Parenthesis => {
            group.stream()
        }
        _ => operand.clone(),
    }
}

/// Whether the statements jump to one of the parts.
fn jumps_to(stmts: &[Stmt], parts: &[Part]) -> bool {
    let mut found = false;
    rungc_ir::walk::statements(stmts, &mut |stmt| {
        if let Stmt::Goto(label) = stmt {
            found |= parts.iter().any(|part| part.label == Some(*label));
        }
    });
    found
}

fn jump_label(depth: usize) -> TokenStream {
    let tick = Punct::new('\'', Spacing::Joint);
    let name = match depth {
        0 => format_ident!("parts"),
        _ => format_ident!("parts{depth}"),
    };
    quote!(#tick #name)
}

fn part_variable(depth: usize) -> proc_macro2::Ident {
    if depth == 0 {
        format_ident!("part")
    } else {
        format_ident!("part{}", depth)
    }
}
