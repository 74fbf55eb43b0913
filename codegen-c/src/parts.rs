//! The runtime in C: the files of `runtime/`, and those that a program needs.
//!
//! They have the C ABI of the runtime library, so that the same emitted code is linked with either. A header `X.h` is
//! implemented by `X.c`, and what a file needs are the headers that it includes: there is no other list. The tables of
//! special devices come from [`rungc_rt::Wiring`], for the models that are emitted.

use crate::OutFile;
use rungc_emit::cycle;
use rungc_emit::storage::Storage;
use rungc_ir::Module;
use rungc_ir::node::{Action, FunctionKind, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::{Clear, Home, Pulses, Ramps, Register, Relay, Wiring};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// A file of `runtime/`.
macro_rules! source {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/runtime/", $name)),
        )
    };
}

/// All of them.
const SOURCES: &[(&str, &str)] = &[
    source!("rungc_clock.c"),
    source!("rungc_data.c"),
    source!("rungc_devices.c"),
    source!("rungc_devices.h"),
    source!("rungc_generator.c"),
    source!("rungc_generator.h"),
    source!("rungc_modules.c"),
    source!("rungc_moves.c"),
    source!("rungc_operands.c"),
    source!("rungc_operands.h"),
    source!("rungc_outputs.c"),
    source!("rungc_outputs.h"),
    source!("rungc_position.c"),
    source!("rungc_pulses.c"),
    source!("rungc_ramps.c"),
    source!("rungc_ramps.h"),
    source!("rungc_return.c"),
    source!("rungc_shifts.c"),
    source!("rungc_system.c"),
    source!("rungc_trigonometry.c"),
    source!("rungc_wiring.h"),
];

/// The source that is made for the models of the programs: what `rungc_wiring.h` declares.
const WIRING: &str = "rungc_wiring.c";

/// Text of a file of `runtime/`; `None` if there is no such file.
fn text(name: &str) -> Option<&'static str> {
    let mut sources = SOURCES.iter();
    sources
        .find(|(path, _)| *path == name)
        .map(|(_, text)| *text)
}

/// The source that defines a function of the C ABI, by its name without `rungc_`.
fn source_of(function: &str) -> Option<&'static str> {
    let name = format!("rungc_{function}(");
    let defines = |line: &str| {
        let before = line.split_once(&name).map(|(before, _)| before);
        before.is_some_and(|before| {
            before.starts_with(char::is_alphabetic) && before.ends_with([' ', '*'])
        })
    };
    let sources = SOURCES.iter().filter(|(path, _)| path.ends_with(".c"));
    let mut sources = sources.filter(|(_, text)| text.lines().any(defines));
    sources.next().map(|(path, _)| *path)
}

/// What a program calls of the runtime: the names of the functions without `rungc_`, with the steps of the
/// instructions that call them.
fn calls(module: &Module) -> BTreeMap<&'static str, BTreeSet<u32>> {
    let mut calls: BTreeMap<&str, BTreeSet<u32>> = BTreeMap::new();
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            let call = if let Stmt::Do(Action::Call(call)) = stmt {
                Some((call.function.name(), call.step))
            } else if let Stmt::Do(Action::Fetch(fetch)) = stmt {
                Some(("fetch", fetch.step))
            } else if let Stmt::Do(Action::Send(send)) = stmt {
                Some(("send", send.step))
            } else {
                None
            };
            if let Some((name, step)) = call {
                let steps = calls.entry(name).or_default();
                steps.extend(is_of_program(&function.kind).then_some(step));
            }
        });
    }
    let others = [
        (module.sends_pulses(), "advance_pulses"),
        (module.sends_pulses(), "pulse_timer"),
        (module.has_ports(), "advance_ports"),
        (
            cycle::error_rules(module, &Storage::new(module)).logs,
            "log_error",
        ),
    ];
    for (_, name) in others.into_iter().filter(|(is_called, _)| *is_called) {
        calls.entry(name).or_default();
    }
    calls
}

/// Returns false for functions that keep special devices up to date, of which no instruction is the reason.
fn is_of_program(kind: &FunctionKind) -> bool {
    !matches!(kind, FunctionKind::Begin | FunctionKind::End)
}

/// A function of the runtime that a program calls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuntimeCall {
    /// Its name in the C ABI, without `rungc_`.
    pub name: &'static str,
    /// Steps of the instructions that call it; none if the scan itself does.
    pub steps: BTreeSet<u32>,
    /// True if it is there in C; otherwise in the runtime library alone, which is built of Rust.
    pub in_c: bool,
}

/// The functions of the runtime that a program calls, by their names.
pub fn runtime_calls(module: &Module) -> Vec<RuntimeCall> {
    let calls = calls(module).into_iter();
    let calls = calls.map(|(name, steps)| RuntimeCall {
        name,
        steps,
        in_c: source_of(name).is_some(),
    });
    calls.collect()
}

/// Parts of the runtime in C.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Parts {
    /// The files of `runtime/` that are needed, with [`WIRING`].
    files: BTreeSet<&'static str>,
    /// Families of pulse outputs in [`WIRING`].
    families: Vec<Pulses>,
}

impl Parts {
    /// What a program needs; `None` if some of that is not there in C.
    pub fn of(module: &Module) -> Option<Parts> {
        let mut parts = Parts::default();
        if module.sends_pulses() {
            parts.add_family(module.model.pulses);
        }
        for function in calls(module).keys() {
            parts.add(source_of(function)?);
        }
        Some(parts)
    }

    /// All files, for programs that also link the library.
    pub fn all(modules: &[Module]) -> Parts {
        let mut parts = Parts::default();
        for (path, _) in SOURCES {
            parts.add(path);
        }
        for module in modules.iter().filter(|module| module.sends_pulses()) {
            parts.add_family(module.model.pulses);
        }
        parts
    }

    fn add_family(&mut self, family: Pulses) {
        if !self.families.contains(&family) {
            self.families.push(family);
        }
    }

    /// Adds a file and what it includes.
    fn add(&mut self, name: &'static str) {
        let mut pending = vec![name];
        while let Some(name) = pending.pop() {
            if !self.files.insert(name) {
                continue;
            }
            let lines = text(name).unwrap_or_default().lines();
            let included =
                lines.filter_map(|line| line.strip_prefix("#include \"")?.strip_suffix("\""));
            for header in included {
                let source = header.replace(".h", ".c");
                let sources = SOURCES.iter().map(|(path, _)| *path).chain([WIRING]);
                pending.extend(sources.filter(|path| *path == header || *path == source));
            }
        }
    }

    /// Both.
    pub fn join(&mut self, other: &Parts) {
        self.files.extend(&other.files);
        for family in &other.families {
            self.add_family(*family);
        }
    }

    /// The paths of the sources or of the headers, by their ending.
    pub fn paths(&self, ending: &'static str) -> impl Iterator<Item = &'static str> {
        let paths = self.files.iter().copied();
        paths.filter(move |path| path.ends_with(ending))
    }

    /// The files.
    pub fn files(&self) -> Vec<OutFile> {
        let files = self.files.iter().map(|name| {
            let text = text(name).map_or_else(|| wiring(&self.families), String::from);
            OutFile::new(*name, text)
        });
        files.collect()
    }
}

/// Runtime that a program links.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) enum Runtime {
    /// It calls none.
    #[default]
    None,
    /// In C.
    C(Parts),
    /// The library, which is built of Rust.
    Library,
}

impl Runtime {
    /// What several programs of one firmware link: a function is there once.
    pub fn together<'a>(all: impl Iterator<Item = &'a Runtime>) -> Runtime {
        let mut joined = Runtime::None;
        for runtime in all {
            joined = match (joined, runtime) {
                (Runtime::Library, _) | (_, Runtime::Library) => Runtime::Library,
                (one, Runtime::None) => one,
                (Runtime::None, other) => other.clone(),
                (Runtime::C(mut one), Runtime::C(other)) => {
                    one.join(other);
                    Runtime::C(one)
                }
            };
        }
        joined
    }

    /// Returns true if the program links the library.
    pub fn is_library(&self) -> bool {
        *self == Runtime::Library
    }

    /// The parts in C.
    pub fn parts(&self) -> Option<&Parts> {
        match self {
            Runtime::C(parts) => Some(parts),
            Runtime::None | Runtime::Library => None,
        }
    }
}

/// The text of [`WIRING`].
fn wiring(families: &[Pulses]) -> String {
    let mut text = String::from(
        "/*\n * rungc_wiring.c: the special devices of pulse outputs of the models that the programs are for.\n */\n\
         #include \"rungc_wiring.h\"\n\n",
    );
    let mut cases = String::new();
    for family in families {
        let name = format!("{family:?}").to_ascii_lowercase();
        let outputs = family.outputs();
        if !outputs.is_empty() {
            let count = outputs.len();
            let _ = writeln!(
                text,
                "static const rungc_wiring {name}_outputs[{count}] = {{"
            );
            for (number, output) in outputs.iter().enumerate() {
                let _ = writeln!(text, "    [{number}] = {{{}}},", members(output).join(", "));
            }
            text.push_str("};\n\n");
        }
        let table = match outputs {
            [] => "NULL".to_string(),
            _ => format!("{name}_outputs"),
        };
        let _ = writeln!(
            text,
            "static const rungc_pulse_family {name} = {{{table}, {}, {}, {}, {}, {}, {}}};\n",
            outputs.len(),
            family.lowest_hz(),
            family.highest_hz(),
            family.fewest_with_ramps(),
            family.conflict(),
            family.raises_speeds()
        );
        let _ = writeln!(
            cases,
            "    case RUNGC_PULSES_{}:\n        return &{name};",
            name.to_ascii_uppercase()
        );
    }
    let _ = write!(
        text,
        "const rungc_pulse_family *rungc_pulse_family_of(rungc_pulses family)\n{{\n    \
         static const rungc_pulse_family none = {{NULL, 0, 1, 100000, 1, 6764, false}};\n\n    \
         switch (family) {{\n{cases}    default:\n        return &none;\n    }}\n}}\n"
    );
    text
}

/// The members of a wiring that are not 0, as a C initialiser.
fn members(wiring: &Wiring) -> Vec<String> {
    let relay = |relay: Option<Relay>| relay.map_or(0, |relay| relay.0);
    let register = |register: Option<Register>| register.map_or(0, |register| register.0);
    let pair = |relays: [Option<Relay>; 2]| {
        let [first, second] = relays.map(relay);
        ((first, second) != (0, 0)).then(|| format!("{{{first}, {second}}}"))
    };
    let number = |number: u16| (number != 0).then(|| number.to_string());
    let ramps = |ramps: Option<Ramps>| ramps.map(ramps_in_c);
    let interrupt = wiring.interrupt;
    let interrupt = [
        interrupt.input as u16,
        relay(interrupt.chooses),
        register(interrupt.register),
        relay(interrupt.relay),
        relay(interrupt.inverted),
    ];
    let members = [
        ("axis", number(register(wiring.axis))),
        ("position", number(register(wiring.position))),
        ("pulses", number(register(wiring.pulses))),
        ("sum", number(register(wiring.sum))),
        ("busy", pair(wiring.busy)),
        ("stop", pair(wiring.stop)),
        ("driven", number(relay(wiring.driven))),
        ("restart", number(relay(wiring.restart))),
        ("changes", number(relay(wiring.changes))),
        ("ramps", ramps(wiring.ramps)),
        ("own", ramps(wiring.own)),
        ("slides", number(relay(wiring.slides))),
        ("limits", pair(wiring.limits)),
        ("aborted", number(relay(wiring.aborted))),
        ("micro", number(relay(wiring.micro))),
        ("inverts", number(relay(wiring.inverts))),
        ("unit", number(register(wiring.unit))),
        ("zrn_clear", wiring.zrn_clear.map(clear_in_c)),
        ("home", wiring.home.map(home_in_c)),
        ("interrupt", (interrupt != [0; 5]).then(|| list(&interrupt))),
    ];
    let members = members.into_iter();
    let mut members: Vec<String> = members
        .filter_map(|(name, value)| Some(format!(".{name} = {}", value?)))
        .collect();
    if members.is_empty() {
        members.push("0".to_string());
    }
    members
}

/// Numbers as a C initialiser.
fn list(numbers: &[u16]) -> String {
    let numbers: Vec<String> = numbers.iter().map(u16::to_string).collect();
    format!("{{{}}}", numbers.join(", "))
}

fn ramps_in_c(ramps: Ramps) -> String {
    list(&[ramps.base.0, ramps.highest.0, ramps.up.0, ramps.down.0])
}

fn clear_in_c(clear: Clear) -> String {
    format!(
        "{{{}, {}, {}, {}, {}, {}}}",
        clear.enable.0,
        clear.output,
        clear.register.map_or(0, |register| register.0),
        clear.chooses.map_or(0, |relay| relay.0),
        clear.ms,
        clear.octal
    )
}

fn home_in_c(home: Home) -> String {
    let clear = match home.clear {
        Some(clear) => clear_in_c(clear),
        None => "{0, 0, 0, 0, 0, false}".to_string(),
    };
    format!(
        "{{{}, {}, {}, {}, {}, {}, {}, {clear}}}",
        home.forward.0,
        list(&home.limits.map(|relay| relay.0)),
        home.dog_inverted.map_or(0, |relay| relay.0),
        home.zero_inverted.0,
        ramps_in_c(home.ramps),
        home.creep.0,
        home.speed.0
    )
}
