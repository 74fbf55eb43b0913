//! The generator of one module: what it knows, and what it has written so far.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::plan::Plan;
use rungc_emit::stations::Device;
use rungc_emit::storage::Storage;
use rungc_emit::timers::Coils;
use rungc_ir::Module;
use rungc_ir::node::{ExprId, Function, FunctionKind, TempId};
use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::rc::Rc;

/// A function of the emitted program.
#[derive(Default)]
pub struct Item {
    /// Its text.
    pub text: String,
    /// Uses of the item.
    pub uses: Uses,
}

/// Dependencies of an item.
#[derive(Default)]
pub struct Uses {
    /// Names used from `rungc_rt`.
    pub imports: BTreeSet<&'static str>,
    /// Names used from `rungc_rt::word`.
    pub word_imports: BTreeSet<&'static str>,
    /// Modules used from `rungc_rt::fnc`.
    pub fnc_imports: BTreeSet<&'static str>,
    /// True if `DEVICES` is used.
    pub devices: bool,
    /// Kinds of timers used, by their constants' names.
    pub timers: BTreeMap<String, TimerKind>,
    /// True if the struct is named.
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

/// Name of the constant for a kind of timer.
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
    /// Its functions and temporaries.
    pub plan: Rc<Plan<'m>>,
    /// Memories of its timers.
    pub coils: Coils,
    /// True if comments are written.
    pub with_comments: bool,
    /// Uses of the item being written.
    pub uses: Uses,
    /// Functions written.
    pub items: Vec<Item>,
    /// Function of the plan that is being written.
    pub function: usize,
    /// Parts of expressions that have got a name in it.
    pub names: u32,
    /// Replacements of expressions in the statement being written: names, and edges.
    pub named: HashMap<ExprId, TokenStream>,
    /// True if a function's result may tell its caller to return.
    pub leaves: bool,
    /// Temporaries that are numbers, 0 or 1, since they are made of bits that are.
    pub numeric_temps: HashSet<TempId>,
    /// Bits that the loop over stations around the statement being written has read before its first iteration.
    pub invariants: BTreeSet<Device>,
    /// True if the statement being written is in a loop over rungs.
    pub in_station_loop: bool,
    /// Number of its iterations.
    pub iterations: u32,
    /// The ladder and the state of the block around the statement being written, where blocks are cases.
    pub block: Option<(usize, u32)>,
    /// Kinds of timers that coils run, by the functions for them.
    pub timer_coils: BTreeMap<String, TimerKind>,
}

impl<'m> Generator<'m> {
    /// A generator that has written nothing yet.
    pub fn new(module: &'m Module, with_comments: bool) -> Self {
        let (storage, plan) = (Storage::new(module), Plan::new(module));
        Generator {
            module,
            coils: Coils::of(module, &plan, &storage),
            storage,
            plan: Rc::new(plan),
            type_name: type_name(&module.name),
            with_comments,
            uses: Uses::default(),
            items: Vec::new(),
            function: 0,
            names: 0,
            named: HashMap::new(),
            leaves: false,
            numeric_temps: HashSet::new(),
            invariants: BTreeSet::new(),
            in_station_loop: false,
            iterations: 0,
            block: None,
            timer_coils: BTreeMap::new(),
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
    pub(crate) fn word_function(&mut self, name: &'static str) -> Ident {
        self.uses.word_imports.insert(name);
        Ident::new(name, Span::call_site())
    }

    /// Brings the methods of access by number into scope.
    pub(crate) fn import_access(&mut self) {
        self.uses.imports.insert("Access");
    }

    /// A device class as the runtime names it.
    pub fn class(&mut self, class: DeviceClass) -> TokenStream {
        let class_type = self.rt("Class");
        let name = Ident::new(class.prefix(), Span::call_site());
        quote!(#class_type::#name)
    }

    /// The table of the model's devices.
    pub(crate) fn devices_const(&mut self) -> Ident {
        self.uses.devices = true;
        format_ident!("DEVICES")
    }

    /// The constant that holds a kind of timer.
    pub(crate) fn timer_kind(&mut self, kind: TimerKind) -> Ident {
        let name = kind_name(kind);
        self.rt("TimerKind");
        let ident = Ident::new(&name, Span::call_site());
        self.uses.timers.insert(name, kind);
        ident
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
    /// Names that the emitted files import.
    const TAKEN: [&str; 25] = [
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
        "Port",
        "Ports",
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
