//! The struct that holds the devices, and what it implements: access by number, and the scan.

use crate::events::{Hidden, hal_parameter};
use crate::expr::literal32;
use crate::format;
use crate::format::documented;
use crate::generate::{Generator, Item};
use crate::storage;
use crate::storage::{PrintField, PrintStorage, type_name};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::storage::{Field, Keep, Kind, Member, Run, Section};
use rungc_ir::node::{FunctionKind, Stmt};
use rungc_rt::special::{M_KEEP_IN_STOP, M_OPERATION_ERROR, M_OUTPUTS_OFF, Relay};
use rungc_syntax::DeviceClass;

/// One way of access by number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Access {
    Bit,
    Word,
    Counter32,
}

impl Generator<'_> {
    /// The struct.
    pub fn machine_struct(&mut self) -> Item {
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
        let hidden = self.hidden_fields();
        let hidden_types: Vec<TokenStream> = hidden.iter().map(|f| f.1.clone()).collect();
        let hidden_names: Vec<Ident> = hidden.iter().map(|f| f.0.clone()).collect();
        let hidden_docs: Vec<TokenStream> = hidden.iter().map(|f| self.doc(f.3)).collect();
        self.item_of(quote! {
            #doc
            #[derive(Clone, Debug)]
            pub struct #name {
                #(#fields,)*
                #(#hidden_docs pub(crate) #hidden_names: #hidden_types,)*
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
                let (columns, kept) = (grid.columns, grid.stored_columns);
                text.push_str(&match kept {
                    1 => format!(", {columns} apart"),
                    _ if kept < columns => {
                        format!(" in {columns} columns, {kept} stored, [1][0] is {second}")
                    }
                    _ => format!(" in {columns} columns, [1][0] is {second}"),
                });
            }
            if field.kind == Kind::Level {
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

    /// Which of a field's devices are kept over power-off, for its documentation.
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
            Kind::Level | Kind::Word => quote!(0),
            Kind::Timer | Kind::Counter16 | Kind::Counter32 => {
                let ty = self.rt(type_name(field.kind));
                quote!(#ty::new())
            }
        }
    }

    /// What is no device: name, type, value at power-on, meaning.
    fn hidden_fields(&mut self) -> Vec<Hidden> {
        let (edge, state, sys) = (self.rt("Edge"), self.rt("State"), self.rt("Sys"));
        let mut fields = Vec::new();
        if self.module.edges > 0 {
            let count = Literal::u32_unsuffixed(self.module.edges);
            fields.push((
                format_ident!("edges"),
                quote!([#edge; #count]),
                quote!([#edge(false); #count]),
                "What edge contacts and pulse instructions saw last.",
            ));
        } else {
            self.uses.imports.remove("Edge");
        }
        // Slot 0 stands for instructions without memory.
        let count = Literal::u32_unsuffixed(u32::from(self.module.states) + 1);
        fields.push((
            format_ident!("states"),
            quote!([#state; #count]),
            quote!([#state::new(); #count]),
            "Private memories of instructions.",
        ));
        fields.extend(self.flag_fields());
        fields.extend(self.cell_fields());
        fields.extend(self.axis_fields());
        fields.extend(self.temp_fields());
        fields.extend(self.port_fields());
        if self.module.may_fail() {
            let error = self.rt("LastError");
            fields.push((
                format_ident!("error"),
                quote!(#error),
                quote!(#error::NONE),
                "What has gone wrong.",
            ));
        }
        if self.module.has_watchdog() {
            let steps = self.initial_steps();
            fields.push((
                format_ident!("steps_left"),
                quote!(u32),
                quote!(#steps),
                "Steps that this scan may still repeat.",
            ));
        }
        fields.push((
            format_ident!("sys"),
            quote!(#sys),
            quote!(#sys::power_on()),
            "Time and mode.",
        ));
        fields
    }

    /// Power-on, and clearing.
    pub fn machine_impl(&mut self) -> Item {
        self.uses = Default::default();
        let name = self.type_name.clone();
        let fields = self.storage.fields().to_vec();
        let names: Vec<Ident> = fields.iter().map(PrintField::name).collect();
        let zeros: Vec<TokenStream> = fields.iter().map(|f| self.zero(f)).collect();
        let hidden = self.hidden_fields();
        let hidden_names: Vec<&Ident> = hidden.iter().map(|f| &f.0).collect();
        let hidden_zeros: Vec<&TokenStream> = hidden.iter().map(|f| &f.2).collect();
        let preset = self.preset();
        let doc = self.doc("The PLC as it leaves the factory, switched to RUN.");
        let value = quote! {
            Self { #(#names: #zeros,)* #(#hidden_names: #hidden_zeros,)* }
        };
        let new = if preset.is_empty() {
            quote!(#doc pub const fn new() -> Self { #value })
        } else {
            quote!(#doc pub const fn new() -> Self { let mut plc = #value; plc.preset(); plc })
        };
        let preset = (!preset.is_empty()).then(|| {
            let doc = self.doc("Gives special devices the values that they have at power-on.");
            quote!(#doc const fn preset(&mut self) { #preset })
        });
        let clear_general = self.clear(false);
        let clear_latched = (self.clears_latched() || self.module.model.latch_key.is_some())
            .then(|| self.clear(true));
        let forget = self.forget();
        let watchdog = self.module.has_watchdog().then(|| self.watchdog());
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
            }
            impl Default for #name {
                fn default() -> Self { Self::new() }
            }
        })
    }

    /// The statements that give special registers their values.
    fn preset(&mut self) -> TokenStream {
        let plc = quote!(self);
        let words = self.module.initial_words.iter();
        let bits = self.module.initial_bits.iter().filter_map(|&number| {
            let cell = self.storage.bit(&plc, DeviceClass::M, number)?;
            Some(quote!(#cell = true;))
        });
        words
            .filter_map(|&(number, value)| {
                let cell = self.storage.word(&plc, DeviceClass::D, number)?;
                let value = literal32(i32::from(value), false);
                Some(quote!(#cell = #value;))
            })
            .chain(bits)
            .collect()
    }

    fn clears_latched(&self) -> bool {
        let mut found = false;
        for function in &self.module.functions {
            rungc_ir::walk::statements(&function.body, &mut |stmt| {
                found |= matches!(stmt, Stmt::Clear { latched: true });
            });
        }
        found
    }

    /// The statements that set fields to 0.
    fn zeroing(&mut self, keeps: &[Keep]) -> TokenStream {
        let fields = self.storage.fields().to_vec();
        let mut out = TokenStream::new();
        for field in &fields {
            let (name, zero) = (field.name(), self.zero(field));
            let runs: Vec<Run> = self.storage.runs(field).collect();
            if runs.iter().all(|run| keeps.contains(&run.keep)) {
                out.extend(quote!(self.#name = #zero;));
                continue;
            }
            for run in runs.iter().filter(|run| keeps.contains(&run.keep)) {
                let zero = self.zero_element(field);
                let numbers = [run.first, run.first + run.count];
                if field.columns().is_none() {
                    let [first, end] = numbers.map(|n| Literal::u32_unsuffixed(n - field.first));
                    out.extend(quote!(self.#name[#first..#end].fill(#zero);));
                    continue;
                }
                let [first, end] = numbers.map(|number| number_literal(field.class, number));
                let cell = Self::matched(field);
                let clear = quote!(#cell = #zero;);
                let clear = match Self::column_is_kept(field) {
                    Some(is_kept) => quote!(if #is_kept { #clear }),
                    None => clear,
                };
                out.extend(quote!(for number in #first..#end { #clear }));
            }
        }
        out
    }

    fn clear(&mut self, latched: bool) -> TokenStream {
        let statements = self.zeroing(&[if latched {
            Keep::Latched
        } else {
            Keep::General
        }]);
        let (name, doc) = if latched {
            (
                format_ident!("clear_latched"),
                self.doc("Clears the latched devices, as M8032 does."),
            )
        } else {
            (
                format_ident!("clear_general"),
                self.doc("Clears what is neither latched nor special nor an input, as M8031 and STOP do."),
            )
        };
        quote!(#doc fn #name(&mut self) { #statements })
    }

    /// Forgets edges and coils, before the first scan in RUN.
    fn forget(&mut self) -> TokenStream {
        let mut out = TokenStream::new();
        if self.module.edges > 0 {
            let edge = self.rt("Edge");
            let count = Literal::u32_unsuffixed(self.module.edges);
            out.extend(quote!(self.edges = [#edge(false); #count];));
        }
        out.extend(self.forget_flags());
        if self.module.run_states > 0 {
            let state = self.rt("State");
            let last = Literal::usize_unsuffixed(self.module.run_states.into());
            out.extend(quote!(self.states[1..=#last].fill(#state::new());));
        }
        if self.module.may_fail() {
            let error = self.rt("LastError");
            out.extend(quote!(self.error = #error::NONE;));
        }
        out.extend(self.each_timer_and_counter(&quote!(coil = 0), &quote!(coil = false)));
        let doc = self.doc("Forgets that edges and the coils of timers and counters were on, and what instructions remember.");
        quote!(#doc fn forget(&mut self) { #out })
    }

    /// Does the first thing with a member of each timer, the second with one of each counter.
    fn each_timer_and_counter(&self, timer: &TokenStream, counter: &TokenStream) -> TokenStream {
        let fields = self.storage.fields().iter();
        fields
            .filter(|field| field.kind.has_members())
            .map(|field| {
                let name = field.name();
                let what = if field.kind == Kind::Timer {
                    timer
                } else {
                    counter
                };
                if field.columns().is_some() {
                    quote!(for device in self.#name.iter_mut().flatten() { device.#what; })
                } else if field.array {
                    quote!(for device in &mut self.#name { device.#what; })
                } else {
                    quote!(self.#name.#what;)
                }
            })
            .collect()
    }

    /// The scan.
    pub fn program_impl(&mut self) -> Item {
        self.uses = Default::default();
        let name = self.type_name.clone();
        let (program, hal) = (self.rt("Program"), self.rt("Hal"));
        let call = |this: &Self, kind: FunctionKind| {
            let mut functions = this.module.functions.iter();
            let function = this.plan.whole(functions.position(|f| f.kind == kind)?)?;
            let name = this.planned_name(function);
            let hal = function.needs_hardware.then(|| quote!(, hal));
            Some(quote!(program::#name(self #hal);))
        };
        let begin = call(self, FunctionKind::Begin);
        let main = call(self, FunctionKind::Main);
        let end = call(self, FunctionKind::End);
        let asks = |root: usize| self.plan.whole(root).is_some_and(|f| f.needs_hardware);
        let hal_name = hal_parameter(self.module.has_ports() || (0..3).any(asks));
        let in_run =
            (main.is_some() || end.is_some()).then(|| quote!(if self.sys.running { #main #end }));
        let plc = quote!(self);
        let special = |relay: Relay| {
            let works = self.module.model.scan_keeps(relay);
            self.storage
                .bit(&plc, DeviceClass::M, relay.number())
                .filter(|_| works)
        };
        let keep = special(M_KEEP_IN_STOP);
        let off = special(M_OUTPUTS_OFF);
        let stop = match &keep {
            Some(keep) => quote!({ if !#keep { self.clear_general(); } }),
            None => quote!({
                self.clear_general();
            }),
        };
        let class = self.class(DeviceClass::Y);
        let plc_trait = self.rt("Plc");
        // The watchdog switches off what STOP would keep.
        let keep = keep.map(|keep| match self.module.has_watchdog() {
            true => {
                let stop = self.rt("Stop");
                quote!((#keep & (self.error.stop != #stop::Watchdog)))
            }
            false => keep,
        });
        let keep = keep.map_or_else(
            || quote!(self.sys.running),
            |keep| quote!((self.sys.running | #keep)),
        );
        let off = off.map(|off| quote!(& !#off));
        let power_cycle = self.power_cycle();
        let events = self.event_methods();
        let count_pulses = self
            .module
            .sends_pulses()
            .then(|| quote!(self.count_pulses(hal, now_ms.wrapping_mul(1000));));
        let ports = self.ports_advance();
        let watchdog = self.module.has_watchdog().then(|| self.watchdog_begins());
        let last_error = self.last_error();
        let pulse_timer = self.pulse_timer();
        let pins = self.pins();
        let image = quote!(#plc_trait::bit(self, #class, number).unwrap_or(false));
        let level = match pins {
            Some(_) => quote!((pulse | #image)),
            None => image,
        };
        self.uses.plc = false;
        self.item_of(quote! {
            impl #program for #name {
                fn scan(&mut self, #hal_name: &mut dyn #hal, now_ms: u32, scan_us: u32) {
                    self.sys.begin_scan(now_ms, scan_us);
                    #count_pulses
                    #ports
                    #watchdog
                    #begin
                    #in_run
                    self.sys.end_scan();
                    #ports
                }
                #events
                fn set_running(&mut self, running: bool) {
                    if !self.sys.set_running(running) { return; }
                    if running { self.forget(); } else #stop
                }
                #power_cycle
                #pulse_timer
                #last_error
                fn output(&self, number: u32) -> bool {
                    #pins
                    #keep #off & #level
                }
            }
        })
    }

    fn power_cycle(&mut self) -> TokenStream {
        let plc = quote!(self);
        let latched = self.module.model.latch_key.map(|(register, key)| {
            let register = register.number();
            let literal = literal32(i32::from(key), false);
            match self.storage.word(&plc, DeviceClass::D, register) {
                Some(cell) => quote!(if #cell != #literal { self.clear_latched(); }),
                None => {
                    let mut words = self.module.model.special_words();
                    let initial = words.find(|w| w.0 == register).map_or(0, |w| w.1);
                    if initial == key {
                        TokenStream::new()
                    } else {
                        quote!(self.clear_latched();)
                    }
                }
            }
        });
        let others = self.zeroing(&[Keep::Input, Keep::Special]);
        let preset = (!self.preset().is_empty()).then(|| quote!(self.preset();));
        let contacts = (!self.module.model.keeps_contacts)
            .then(|| self.each_timer_and_counter(&quote!(done = false), &quote!(done = false)));
        let hidden = self.hidden_fields();
        let forgotten: Vec<Ident> = self.flag_fields().into_iter().map(|f| f.0).collect();
        let hidden = hidden
            .iter()
            .filter(|f| f.0 != "edges" && !forgotten.contains(&f.0))
            .map(|(name, _, value, _)| quote!(self.#name = #value;));
        let hidden: TokenStream = hidden.collect();
        quote! {
            fn power_cycle(&mut self) {
                #latched
                self.clear_general();
                #others
                #preset
                #contacts
                #hidden
                self.forget();
            }
        }
    }

    /// Access by number.
    pub fn plc_impl(&mut self) -> Item {
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
        let noted = self.note_error();
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
                #noted
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
            let guard = Self::column_is_kept(field).map(|is_kept| quote!(if #is_kept));
            quote!((#class, #numbers) #guard)
        } else {
            numbers
        }
    }

    /// A field's device behind `self` where a pattern has matched its number.
    fn matched(field: &Field) -> TokenStream {
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

    /// How far a number is behind a field's first.
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
    fn column_is_kept(field: &Field) -> Option<TokenStream> {
        let grid = field.trimmed()?;
        let n = Self::distance(field);
        let [columns, kept] = [grid.columns, grid.stored_columns].map(Literal::u32_unsuffixed);
        Some(quote!(#n % #columns < #kept))
    }

    fn arms(&mut self, access: Access, set: bool) -> TokenStream {
        let fields = self.storage.fields().to_vec();
        let mut out = TokenStream::new();
        for field in &fields {
            let pattern = self.pattern(field, access != Access::Counter32);
            let cell = Self::matched(field);
            if (access, field.kind) == (Access::Bit, Kind::Level) {
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
        for &(number, class, index) in self.module.model.index_aliases {
            let Some(cell) = self.storage.word(&quote!(self), class, index) else {
                continue;
            };
            let d = self.class(DeviceClass::D);
            let number = Literal::u32_unsuffixed(number);
            out.extend(if set {
                quote!((#d, #number) => #cell = value,)
            } else {
                quote!((#d, #number) => #cell,)
            });
        }
        out
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
    pub fn devices_table(&mut self) -> Item {
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

    /// The text of some items, and what they use.
    pub fn item_of(&mut self, tokens: TokenStream) -> Item {
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

/// What an array has of each element: of a type the array's type, of a value its value.
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

/// A device number as its class writes it.
fn number_literal(class: DeviceClass, number: u32) -> Literal {
    if class.is_octal()
        && number > 7
        && let Ok(literal) = format!("0o{number:o}").parse()
    {
        return literal;
    }
    Literal::u32_unsuffixed(number)
}
