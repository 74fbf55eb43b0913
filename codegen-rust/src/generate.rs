//! The generator of one module: what it knows, and what it has written so far.

use crate::analysis::{self, Calls, Position, Temps};
use crate::format::Comments;
use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::storage::Storage;
use rungc_ir::Module;
use rungc_ir::node::{ExprId, Function, FunctionKind, LabelId, TempId, Ty};
use rungc_ir::walk::operands;
use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Expressions deeper than this are cut by a `let`: nobody reads them otherwise, and compilers recurse over them.
const MAX_DEPTH: u32 = 24;

/// An expression used this often in one statement and larger than this gets a `let`.
const MAX_COPIES_SIZE: u32 = 6;

/// A function of the emitted program.
#[derive(Default)]
pub struct Item {
    /// Its text.
    pub text: String,
    /// What it uses.
    pub uses: Uses,
}

/// What an item needs around it.
#[derive(Default)]
pub struct Uses {
    /// Names used from `rungc_rt`.
    pub imports: BTreeSet<&'static str>,
    /// Names used from `rungc_rt::word`.
    pub word_imports: BTreeSet<&'static str>,
    /// Modules used from `rungc_rt::fnc`.
    pub fnc_imports: BTreeSet<&'static str>,
    /// Whether `DEVICES` is used.
    pub devices: bool,
    /// Kinds of timers used, by their constants' names.
    pub timers: BTreeMap<String, TimerKind>,
    /// Whether the struct is named.
    pub plc: bool,
}

impl Uses {
    /// Takes over what another item needs.
    pub fn join(&mut self, other: &Uses) {
        self.imports.extend(&other.imports);
        self.word_imports.extend(&other.word_imports);
        self.fnc_imports.extend(&other.fnc_imports);
        self.timers.extend(
            other
                .timers
                .iter()
                .map(|(name, kind)| (name.clone(), *kind)),
        );
        self.devices |= other.devices;
        self.plc |= other.plc;
    }
}

/// What the constant that holds a kind of timer is called.
pub fn kind_name(kind: TimerKind) -> String {
    let mut name = format!("TIMER_{}MS", kind.unit_ms);
    let traits = [
        (kind.accumulating, "_ACCUMULATING"),
        (kind.free_running, "_FREE_RUNNING"),
        (kind.latches_preset, "_PRESET_AT_START"),
        (kind.overruns, "_OVERRUNNING"),
        (kind.stepwise, "_STEPWISE"),
        (kind.shared, "_SHARED"),
    ];
    for (is, suffix) in traits {
        if is {
            name.push_str(suffix);
        }
    }
    name
}

/// Generates one module.
pub struct Generator<'m> {
    /// The module.
    pub module: &'m Module,
    /// Its fields.
    pub storage: Storage<'m>,
    /// Name of the struct.
    pub type_name: Ident,
    /// Which functions call what.
    pub calls: Calls,
    /// Whether to write comments.
    pub with_comments: bool,
    /// What the item being written needs.
    pub uses: Uses,
    /// Texts of its comments.
    pub comments: Comments,
    /// Functions written.
    pub items: Vec<Item>,
    /// Temporaries of the function being written.
    pub temps: Temps,
    /// Temporaries to declare in front of statements.
    pub declare: HashMap<Position, Vec<TempId>>,
    /// Step of the network being written.
    pub step: u32,
    /// Loops over parts around the statement being written: the labels of the parts.
    pub jumps: Vec<Vec<Option<LabelId>>>,
    /// Temporaries assigned so far in the function being written.
    pub assigned: HashSet<TempId>,
    /// An edge that stands for its temporary in the next statement.
    pub inlined: Option<(TempId, TokenStream)>,
    /// Temporaries that are numbers, 0 or 1, since they are made of bits that are.
    pub levels: HashSet<TempId>,
    /// Devices of which the loop over rungs around the statement being written has a number of its own.
    pub constants: HashSet<(DeviceClass, u32)>,
    /// Whether the statement being written is in a loop over rungs.
    pub in_rounds: bool,
    /// Kinds of timers that coils run, by the functions for them.
    pub timer_coils: BTreeMap<String, TimerKind>,
    /// Names of functions already given.
    names: HashSet<String>,
    /// Expressions that have a `let` in the statement being written.
    hoisted: HashMap<ExprId, Ident>,
}

impl<'m> Generator<'m> {
    /// A generator that has written nothing yet.
    pub fn new(module: &'m Module, with_comments: bool) -> Self {
        Generator {
            module,
            storage: Storage::new(module),
            type_name: type_name(&module.name),
            calls: Calls::of(module),
            with_comments,
            uses: Uses::default(),
            comments: Comments::default(),
            items: Vec::new(),
            temps: Temps::default(),
            declare: HashMap::new(),
            step: 0,
            jumps: Vec::new(),
            assigned: HashSet::new(),
            inlined: None,
            levels: HashSet::new(),
            constants: HashSet::new(),
            in_rounds: false,
            timer_coils: BTreeMap::new(),
            names: HashSet::new(),
            hoisted: HashMap::new(),
        }
    }

    /// The comment on a device.
    pub fn device_comment(&self, class: DeviceClass, number: u32) -> Option<&'m str> {
        self.storage.comment(class, number)
    }

    /// A name from `rungc_rt`, imported.
    pub fn rt(&mut self, name: &'static str) -> Ident {
        self.uses.imports.insert(name);
        Ident::new(name, Span::call_site())
    }

    /// A function from `rungc_rt::word`, imported.
    pub fn word_function(&mut self, name: &'static str) -> Ident {
        self.uses.word_imports.insert(name);
        Ident::new(name, Span::call_site())
    }

    /// Brings the methods of access by number into scope.
    pub fn import_access(&mut self) {
        self.uses.imports.insert("Access");
    }

    /// A device class as the runtime names it.
    pub fn class(&mut self, class: DeviceClass) -> TokenStream {
        let class_type = self.rt("Class");
        let name = Ident::new(class.prefix(), Span::call_site());
        quote!(#class_type::#name)
    }

    /// The table of the model's devices.
    pub fn devices_const(&mut self) -> Ident {
        self.uses.devices = true;
        format_ident!("DEVICES")
    }

    /// The constant that holds a kind of timer.
    pub fn timer_kind(&mut self, kind: TimerKind) -> Ident {
        let name = kind_name(kind);
        self.rt("TimerKind");
        let ident = Ident::new(&name, Span::call_site());
        self.uses.timers.insert(name, kind);
        ident
    }

    /// Name of a temporary.
    pub fn temp_name(&self, temp: TempId) -> Ident {
        format_ident!("t{}", temp.0)
    }

    /// Type of a temporary.
    pub fn temp_type(&self, temp: TempId) -> TokenStream {
        match self.module.temps.get(temp.0 as usize) {
            Some(Ty::I16) => quote!(i16),
            Some(Ty::I32) => quote!(i32),
            Some(Ty::F32) => quote!(f32),
            Some(Ty::Bit) | None => quote!(bool),
        }
    }

    /// A name for a function that no other has.
    pub fn unique_name(&mut self, wanted: String) -> Ident {
        let mut name = wanted.clone();
        let mut n = 2;
        while !self.names.insert(name.clone()) {
            name = format!("{wanted}_{n}");
            n += 1;
        }
        Ident::new(&name, Span::call_site())
    }

    /// The variable that holds an expression in this statement, if it has one.
    pub fn hoisted(&self, id: ExprId) -> Option<Ident> {
        self.hoisted.get(&id).cloned()
    }

    /// The `let`s to put in front of a statement that evaluates `roots`: for what is too deep to be read, and for what would be
    /// written out several times.
    pub fn hoist(&mut self, roots: &[ExprId]) -> Vec<TokenStream> {
        self.hoisted.clear();
        let ids = analysis::reachable(self.module, roots);
        if ids.len() <= MAX_COPIES_SIZE as usize {
            return Vec::new();
        }
        let mut uses: HashMap<ExprId, u32> = HashMap::new();
        for id in &ids {
            for operand in operands(self.module.expr(*id)) {
                *uses.entry(operand).or_default() += 1;
            }
        }
        // Depth and size of what is written where the expression stands; a hoisted one counts as a name.
        let mut shape: HashMap<ExprId, (u32, u32)> = HashMap::new();
        let mut lets = Vec::new();
        for id in ids {
            let mut depth = 0;
            let mut size = 1;
            for operand in operands(self.module.expr(id)) {
                let (d, s) = shape.get(&operand).copied().unwrap_or_default();
                depth = depth.max(d + 1);
                size += s;
            }
            let copied = size > MAX_COPIES_SIZE && uses.get(&id).is_some_and(|&n| n > 1);
            if (copied || depth >= MAX_DEPTH) && !roots.contains(&id) {
                let name = format_ident!("e{}", id.0);
                let value = self.typed(id);
                lets.push(quote!(let #name = #value;));
                self.hoisted.insert(id, name);
                (depth, size) = (0, 1);
            }
            shape.insert(id, (depth, size));
        }
        lets
    }
}

/// Name of a function of the module.
pub fn function_name(function: &Function) -> String {
    match function.kind {
        FunctionKind::Begin => "begin_scan".to_string(),
        FunctionKind::Main => "program".to_string(),
        FunctionKind::End => "end_scan".to_string(),
        FunctionKind::Subroutine(n) => format!("subroutine_p{n}"),
        FunctionKind::InputEdge { input, kind } => {
            format!("x{input:03o}_{}", kind.verb())
        }
        FunctionKind::TakeInterrupts => "interrupts".to_string(),
        FunctionKind::Signals => "signals".to_string(),
        FunctionKind::Interrupt(n) => format!("interrupt_i{n:03}"),
    }
}

/// Name of the struct: `box_filler` is `BoxFiller`.
pub(crate) fn type_name(module: &str) -> Ident {
    /// What the emitted files import.
    const TAKEN: [&str; 23] = [
        "Access",
        "Axis",
        "Class",
        "Counter16",
        "Counter32",
        "Edge",
        "Fault",
        "Hal",
        "LastError",
        "NoHal",
        "Operand",
        "Option",
        "Plc",
        "Program",
        "Pulses",
        "Runs",
        "Site",
        "Some",
        "State",
        "Stop",
        "Sys",
        "Timer",
        "TimerKind",
    ];
    let mut name: String = module
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(|word| {
            let (first, rest) = word.split_at(1);
            format!("{}{rest}", first.to_ascii_uppercase())
        })
        .collect();
    if !name.starts_with(|c: char| c.is_ascii_uppercase()) {
        name.insert_str(0, "Plc");
    }
    if TAKEN.contains(&name.as_str()) || name == "Self" || name == "None" {
        name.push_str("Plc");
    }
    Ident::new(&name, Span::call_site())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn type_names_are_identifiers_of_their_own() {
        let names = [
            "motor",
            "box_filler",
            "4you",
            "timer",
            "self",
            "",
            "plc",
            "axis",
        ];
        let names = names.map(|name| type_name(name).to_string());
        assert_eq!(
            names,
            [
                "Motor",
                "BoxFiller",
                "Plc4you",
                "TimerPlc",
                "SelfPlc",
                "PlcPlc",
                "PlcPlc",
                "AxisPlc"
            ]
        );
    }
}
