//! Puts the items of a program together to files: a crate for one program, or one for many.

use crate::format::documented;
use crate::generate::{Generator, Item, Uses};
use crate::{Options, OutFile, Runtime, defmt, host, template};
use rungc_emit::cycle;
use rungc_ir::Module;
use rungc_rt::TimerKind;
use rungc_runtime_sources::{EMITTED_VERSION, HOST_FOLDER};
use rungc_syntax::text::one_line;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Lines of functions that one file holds.
const FILE_LINES: usize = 600;

/// Columns of a line.
const LINE: usize = 100;

/// Modules of a batch in one file.
const CASES_PER_FILE: usize = 25;

/// Folder of the runtime inside an emitted crate.
const RUNTIME_FOLDER: &str = "rungc-rt";

/// The runtime's sources, for a path dependency; with a host's services if there is a `host`.
fn runtime(host: bool) -> impl Iterator<Item = OutFile> {
    rungc_runtime_sources::files(host)
        .into_iter()
        .map(|(path, text)| OutFile::new(format!("{RUNTIME_FOLDER}/{path}"), text))
}

/// The lock file of a crate that depends on nothing but the runtime's sources.
fn lock_file(crate_name: &str, host: bool) -> OutFile {
    let needs: &[&str] = match host {
        true => &["rungc-host", "rungc-rt"],
        false => &["rungc-rt"],
    };
    let lock = rungc_runtime_sources::lock_file(host, &[(crate_name, needs)]);
    OutFile::new("Cargo.lock", lock)
}

/// A string of TOML, whose escapes are not those of Rust.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

impl Runtime {
    /// The line of a manifest that depends on it. The emitted crate, which may have its sources, is in `folder`: empty,
    /// or with a slash at its end.
    pub fn dependency(&self, folder: &str) -> String {
        format!("rungc-rt = {{ path = {} }}\n", quoted(&self.path(folder)))
    }

    /// The lines of a manifest that depend on it and on a host's services.
    fn host_dependencies(&self, folder: &str) -> String {
        let path = format!("{}/{HOST_FOLDER}", self.path(folder));
        let host = format!("rungc-host = {{ path = {} }}\n", quoted(&path));
        host + &self.dependency(folder)
    }

    /// Folder of the runtime, for an emitted crate in `folder`.
    fn path(&self, folder: &str) -> String {
        match self {
            Runtime::Included => format!("{folder}{RUNTIME_FOLDER}"),
            Runtime::At(path) => path.clone(),
        }
    }
}

fn manifest(name: &str, description: &str, dependencies: &str, profile: &str) -> String {
    let (name, description) = (quoted(name), quoted(&one_line(description)));
    format!(
        "[package]\nname = {name}\ndescription = {description}\nversion = \"{EMITTED_VERSION}\"\nedition = \"2024\"\npublish = false\n\n\
         [dependencies]\n{dependencies}\n\
         # A separate workspace. Delete this line to make the crate a member of yours.\n[workspace]\n{profile}"
    )
}

/// A crate for one program.
pub fn program(module: &Module, options: &Options) -> Vec<OutFile> {
    let mut generator = Generator::new(module, true);
    generator.functions();
    let functions = std::mem::take(&mut generator.items);
    let crate_name = crate_name(&module.name);
    let asks = cycle::keeps_any(module) || cycle::uses_clock(module);
    let ports = module.has_ports();
    let needs_host = options.main && (options.servers || options.io || asks || ports);
    let mut dependencies = match needs_host {
        true => options.runtime.host_dependencies(""),
        false => options.runtime.dependency(""),
    };
    let mut features = "";
    if options.defmt {
        dependencies.push_str(defmt::DEPENDENCY);
        features = defmt::FEATURE;
    }
    let description = format!("PLC program {}", module.source_name);
    let mut files = vec![
        OutFile::new(
            "Cargo.toml",
            manifest(&crate_name, &description, &dependencies, features),
        ),
        OutFile::new("src/lib.rs", library(&mut generator, &functions, options)),
        OutFile::new("src/devices.rs", devices(&mut generator)),
    ];
    files.extend(program_files(&generator, functions));
    if options.defmt {
        files.push(defmt::file(&generator.type_name, &crate_name));
    }
    if options.main {
        files.push(OutFile::new(
            "src/main.rs",
            host::main_file(&generator, &crate_name, options),
        ));
    }
    if options.runtime == Runtime::Included {
        files.extend(runtime(needs_host));
    }
    // The registry knows the other locked dependencies of defmt.
    if !options.defmt {
        files.push(lock_file(&crate_name, needs_host));
    }
    files
}

/// Names of a program's crate and type.
pub fn names(module: &Module) -> (String, String) {
    let generator = Generator::new(module, true);
    (crate_name(&module.name), generator.type_name.to_string())
}

/// A module's name in snake case, or one like it if cargo does not take that or a crate it needs has it.
fn crate_name(name: &str) -> String {
    // rustc warns of a crate whose name has two underscores in a row.
    let words: Vec<&str> = name.split('_').filter(|word| !word.is_empty()).collect();
    let name = words.join("_");
    let is_taken = matches!(
        name.as_str(),
        "" | "rungc_host"
            | "rungc_rt"
            | "libm"
            | "core"
            | "defmt"
            | "std"
            | "alloc"
            | "test"
            | "build"
            | "deps"
            | "examples"
            | "incremental"
            | "self"
            | "super"
            | "crate"
            | "_"
    );
    let is_keyword = syn::parse_str::<syn::Ident>(&name).is_err();
    if is_taken || is_keyword || name.starts_with(|c: char| c.is_ascii_digit()) {
        format!("plc_{name}")
    } else {
        name
    }
}

/// The lines that bring into scope what items use.
fn imports(uses: &Uses) -> String {
    let mut out = String::new();
    let mut names: Vec<&str> = uses.imports.iter().copied().collect();
    let word: Vec<&str> = uses.word_imports.iter().copied().collect();
    let word = match word.as_slice() {
        [] => None,
        [one] => Some(format!("word::{one}")),
        more => Some(format!("word::{{{}}}", more.join(", "))),
    };
    let modules: Vec<&str> = uses.fnc_imports.iter().copied().collect();
    let modules = match modules.as_slice() {
        [] => None,
        [one] => Some(format!("fnc::{one}")),
        more => Some(format!("fnc::{{{}}}", more.join(", "))),
    };
    names.extend(modules.as_deref());
    names.extend(word.as_deref());
    out.push_str(&import("rungc_rt", &names));
    out
}

/// The declaration that imports names of a module, laid out as rustfmt does; empty if there are none.
fn import(module: &str, names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => format!("use {module}::{one};\n"),
        more => {
            let list = format!("use {module}::{{{}}};\n", more.join(", "));
            if list.len() <= LINE {
                return list;
            }
            let mut out = format!("use {module}::{{\n");
            fill(&mut out, more);
            out.push_str("};\n");
            out
        }
    }
}

/// Names one after the other, as many on a line as fit, laid out as rustfmt does.
fn fill(out: &mut String, names: &[&str]) {
    let mut line = String::from("   ");
    for name in names {
        if line.len() + name.len() + 2 > LINE {
            out.push_str(&line);
            out.push('\n');
            line = String::from("   ");
        }
        line.push(' ');
        line.push_str(name);
        line.push(',');
    }
    out.push_str(&line);
    out.push('\n');
}

/// The constants of the kinds of timers that are used.
fn timer_constants(timers: &BTreeMap<String, TimerKind>, visibility: &str) -> String {
    let mut out = String::new();
    for (name, kind) in timers {
        let TimerKind {
            unit_ms,
            accumulating,
            free_running,
            latches_preset,
            overruns,
            stepwise,
            shared,
        } = kind;
        let _ = write!(
            out,
            "\n{visibility}const {name}: TimerKind = TimerKind {{\n    unit_ms: {unit_ms},\n    accumulating: {accumulating},\n    \
             free_running: {free_running},\n    latches_preset: {latches_preset},\n    overruns: {overruns},\n    stepwise: {stepwise},\n    shared: {shared},\n}};\n"
        );
    }
    out
}

fn joined<'a>(items: impl IntoIterator<Item = &'a Item>) -> Uses {
    let mut uses = Uses::default();
    for item in items {
        uses.join(&item.uses);
    }
    uses
}

/// An item's text with its function visible outside its file.
fn exported(text: &str, visibility: &str) -> String {
    let mut out = String::with_capacity(text.len() + visibility.len());
    for line in text.split_inclusive('\n') {
        if line.starts_with("fn ") {
            out.push_str(visibility);
        }
        out.push_str(line);
    }
    out
}

/// Notes for hosts of programs with interrupts.
const EVENTS_DOC: &str = "\
//!
//! Interrupts: tell the program of edges of input terminals ([`Program::input_edge`]) and, each millisecond, of time
//! ([`Program::tick`]); its routines run in the next scan in front of each network, or at once in [`Program::take_interrupts`].
";

fn library(generator: &mut Generator, functions: &[Item], options: &Options) -> String {
    let module = generator.module;
    let machine = generator.machine_struct();
    let implementation = generator.machine_impl();
    let program = generator.program_impl();
    let uses = joined([&machine, &implementation, &program]);
    let name = &generator.type_name;
    let crate_name = crate_name(&module.name);
    let mut out = format!(
        "//! {name}: generated by rungc {version} from {source} ({title}, {steps} steps). Do not edit: change the PLC program.\n\
         //!\n\
         //! ```no_run\n\
         //! use {crate_name}::{name};\n\
         //! use rungc_rt::{{Class, NoHal, Plc, Program}};\n\
         //!\n\
         //! let mut plc = {name}::new();\n\
         //! let (mut now_ms, mut scan_us) = (0, 0);\n\
         //! loop {{\n\
         //!     plc.set_bit(Class::X, 0, true); // every input terminal\n\
         //!     plc.scan(&mut NoHal, now_ms, scan_us);\n\
         //!     let on = plc.output(0); // every output terminal\n\
         //! # let _ = on;\n\
         //!     now_ms += 10; // milliseconds since power-on\n\
         //!     scan_us = 150; // how long the scan took, in microseconds\n\
         //! }}\n\
         //! ```\n\
         //!\n\
         //! Timers are as exact as scans are frequent: scan every 10 ms or faster. All memory is in [`{name}`]. Devices marked\n\
         //! \"latched\" keep their values over power-off on the PLC; a host that wants that stores these fields.\n\
         {events}#![no_std]\n#![forbid(unsafe_code)]\n",
        version = env!("CARGO_PKG_VERSION"),
        source = documented(&module.source_name),
        title = module.model.title,
        steps = module.steps,
        events = if !module.takes_events() {
            ""
        } else {
            EVENTS_DOC
        },
    );
    out.push_str("\nmod devices;\n");
    if options.defmt {
        out.push_str(defmt::MODULE);
    }
    if !functions.is_empty() {
        out.push_str("mod program;\n");
    }
    out.push('\n');
    out.push_str(&imports(&uses));
    for item in [&machine, &implementation, &program] {
        out.push('\n');
        out.push_str(&item.text);
    }
    out
}

fn devices(generator: &mut Generator) -> String {
    let table = generator.devices_table();
    let access = generator.plc_impl();
    let uses = joined([&table, &access]);
    format!(
        "//! Access to devices by number.\n\nuse crate::{};\n{}\n{}\n{}",
        generator.type_name,
        imports(&uses),
        table.text,
        access.text
    )
}

/// `src/program.rs`, or a folder of files if it would be long.
fn program_files(generator: &Generator, functions: Vec<Item>) -> Vec<OutFile> {
    if functions.is_empty() {
        return Vec::new();
    }
    let lines: usize = functions.iter().map(lines).sum();
    let type_name = &generator.type_name;
    let uses = joined(&functions);
    let from_crate = if uses.devices {
        format!("use crate::{{{type_name}, devices::DEVICES}};\n")
    } else {
        format!("use crate::{type_name};\n")
    };
    let clippy = format!(
        "#![allow(\n    {},\n    reason = \"as the PLC program has it\"\n)]\n",
        LINTS.join(",\n    ")
    );
    if lines <= FILE_LINES {
        let mut out = format!(
            "//! The program, step by step.\n{clippy}\n{from_crate}{}",
            imports(&uses)
        );
        out.push_str(&timer_constants(&uses.timers, ""));
        for item in &functions {
            out.push('\n');
            out.push_str(&exported(&item.text, "pub(crate) "));
        }
        return vec![OutFile::new("src/program.rs", out)];
    }
    let mut parts: Vec<Vec<Item>> = vec![Vec::new()];
    let mut filled = 0;
    for item in functions {
        let length = self::lines(&item);
        if filled > 0 && filled + length > FILE_LINES {
            parts.push(Vec::new());
            filled = 0;
        }
        filled += length;
        if let Some(part) = parts.last_mut() {
            part.push(item);
        }
    }
    let mut root = format!("//! The program, step by step.\n{clippy}\n");
    for i in 0..parts.len() {
        let _ = writeln!(root, "mod part{i};");
    }
    root.push('\n');
    for i in 0..parts.len() {
        let _ = writeln!(root, "pub(crate) use part{i}::*;");
    }
    if !uses.timers.is_empty() {
        root.push_str("use rungc_rt::TimerKind;\n");
    }
    root.push_str(&timer_constants(&uses.timers, ""));
    let mut files = vec![OutFile::new("src/program/mod.rs", root)];
    let defined: Vec<Vec<&str>> = parts.iter().map(|part| defined(part)).collect();
    for (i, part) in parts.iter().enumerate() {
        let mut uses = joined(part);
        uses.imports.remove("TimerKind");
        let from_crate = if uses.devices {
            format!("use crate::{{{type_name}, devices::DEVICES}};\n")
        } else {
            format!("use crate::{type_name};\n")
        };
        let mut out = format!(
            "{}{}{from_crate}{}",
            "//! A part of the program.\n\n",
            import("super", &shared(i, part, &defined, &uses)),
            imports(&uses)
        );
        for item in part {
            out.push('\n');
            out.push_str(&exported(&item.text, "pub(crate) "));
        }
        files.push(OutFile::new(format!("src/program/part{i}.rs"), out));
    }
    files
}

/// The names that a part uses of the files beside it: timers, and functions of other parts, of which `defined` has the
/// names.
fn shared<'a>(
    number: usize,
    part: &[Item],
    defined: &[Vec<&'a str>],
    uses: &'a Uses,
) -> Vec<&'a str> {
    let others = defined.iter().enumerate();
    let others = others.filter(|(other, _)| *other != number);
    let mut names: BTreeSet<&str> = others.flat_map(|(_, names)| names).copied().collect();
    names.extend(uses.timers.keys().map(String::as_str));
    let words = words(part);
    names.retain(|name| words.contains(name));
    names.into_iter().collect()
}

/// The names of the functions that items define.
fn defined(items: &[Item]) -> Vec<&str> {
    let lines = items.iter().flat_map(|item| item.text.lines());
    let functions = lines.filter_map(|line| line.strip_prefix("fn ")?.split(['(', '<']).next());
    functions.collect()
}

/// The words of items.
fn words(items: &[Item]) -> BTreeSet<&str> {
    let is_between = |c: char| !c.is_alphanumeric() && c != '_';
    let words = items.iter().flat_map(|item| item.text.split(is_between));
    words.collect()
}

/// Lints of clippy that verbose programs trigger.
const LINTS: [&str; 11] = [
    "clippy::approx_constant",
    "clippy::collapsible_else_if",
    "clippy::collapsible_if",
    "clippy::eq_op",
    "clippy::erasing_op",
    "clippy::identity_op",
    "clippy::modulo_one",
    "clippy::neg_cmp_op_on_partial_ord",
    "clippy::nonminimal_bool",
    "clippy::self_assignment",
    "unused_assignments",
];

fn lines(item: &Item) -> usize {
    item.text.lines().count()
}

/// A crate for many programs.
pub fn batch(modules: &[Module]) -> Vec<OutFile> {
    let profile = "\n[features]\n# For a machine without operating system: a static library with a `main`, and without the standard library.\nbare = []\n\n\
                   [profile.dev]\nopt-level = 0\ndebug = false\nincremental = false\ncodegen-units = 16\n\n\
                   # The runtime, and for a machine without operating system the standard library's parts.\n[profile.dev.package.\"*\"]\nopt-level = 2\n";
    let mut files = vec![
        OutFile::new(
            "Cargo.toml",
            manifest(
                "batch",
                "PLC programs for tests",
                &Runtime::Included.dependency(""),
                profile,
            ),
        ),
        OutFile::new("src/main.rs", template!("batch/main.rs")),
        OutFile::new("src/lib.rs", template!("batch/lib.rs")),
        OutFile::new("src/port.rs", template!("batch/port.rs")),
        OutFile::new("src/bare.rs", template!("batch/bare.rs")),
    ];
    let mut models: BTreeMap<&str, &Module> = BTreeMap::new();
    let mut cases = String::from(
        "//! The programs of the batch.\n#![allow(warnings, clippy::all, reason = \"not made to be read\")]\n\n",
    );
    let mut arms = String::new();
    for (n, chunk) in modules.chunks(CASES_PER_FILE).enumerate() {
        let mut out = String::new();
        for (i, module) in chunk.iter().enumerate() {
            let number = n * CASES_PER_FILE + i;
            models.entry(module.model.name).or_insert(module);
            let type_name = case(module, number, &mut out);
            let _ = writeln!(
                arms,
                "        {number} => power_on(cases{n}::case{number}::{type_name}::new, what),"
            );
        }
        let _ = writeln!(cases, "mod cases{n};");
        files.push(OutFile::new(format!("src/cases/cases{n}.rs"), out));
    }
    let _ = write!(
        cases,
        "\nuse rungc_rt::Program;\n\n\
         /// Does something with a program, freshly powered on; `None` if there is no such program.\n\
         pub fn run(number: usize, what: &mut dyn FnMut(&mut dyn Program)) -> Option<()> {{\n    \
         match number {{\n{arms}        _ => return None,\n    }}\n    Some(())\n}}\n\n\
         /// A separate function for each program: in one, the stack would hold all of them.\n\
         #[inline(never)]\n\
         fn power_on<T: Program>(new: fn() -> T, what: &mut dyn FnMut(&mut dyn Program)) {{\n    what(&mut new())\n}}\n"
    );
    files.push(OutFile::new("src/cases/mod.rs", cases));
    let mut tables = String::from(
        "//! The models' devices.\n#![allow(dead_code, reason = \"one for each model of the batch\")]\n\nuse rungc_rt::{Class, Runs};\n",
    );
    for (name, module) in models {
        let mut generator = Generator::new(module, true);
        let table = generator.devices_table().text;
        tables.push('\n');
        tables.push_str(&table.replace("const DEVICES", &format!("const {}", table_name(name))));
    }
    files.push(OutFile::new("src/models.rs", tables));
    files.extend(runtime(false));
    files.push(lock_file("batch", false));
    files
}

/// Name of the table of a model's devices: `FX3U_COMPATIBLE`.
fn table_name(model: &str) -> String {
    model.to_uppercase().replace('-', "_")
}

/// One program of a batch; returns the name of its struct.
fn case(module: &Module, number: usize, out: &mut String) -> String {
    let mut generator = Generator::new(module, false);
    generator.functions();
    let functions = std::mem::take(&mut generator.items);
    let machine = [
        generator.machine_struct(),
        generator.machine_impl(),
        generator.program_impl(),
        generator.plc_impl(),
    ];
    let model = table_name(module.model.name);
    let uses = joined(machine.iter().chain(&functions));
    let _ = writeln!(
        out,
        "pub mod case{number} {{\nuse crate::models::{model} as DEVICES;"
    );
    out.push_str(&imports(&uses));
    for item in &machine {
        out.push_str(&item.text);
        out.push('\n');
    }
    out.push_str("mod program {\nuse super::*;\n");
    out.push_str(&timer_constants(&uses.timers, ""));
    for item in &functions {
        out.push_str(&exported(&item.text, "pub(super) "));
        out.push('\n');
    }
    out.push_str("}\n}\n");
    generator.type_name.to_string()
}
