//! Implementations of a program, each in a form that can be measured: the program's own files, and an adaptor
//! (`templates/subject.h`).

use crate::ladder::{Device, FLAGS, Ladder, TERMINALS, hand};
use crate::problem::{Problem, Result};
use crate::tools;
use rungc_codegen_c::lanes::{self, LANES};
use rungc_ir::{Module, walk};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_runtime_sources::cache::{self, Slot};
use rungc_syntax::DeviceClass;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Common parts of all adaptors.
const SUBJECT_H: &str = include_str!("../templates/subject.h");

/// The adaptor of emitted C that runs many instances.
const LANES_ADAPTOR: &str = include_str!("../templates/lanes.c");

/// The adaptor of emitted Rust.
const RUST_ADAPTOR: &str = include_str!("../templates/adaptor.rs");

/// Number of inputs, of which one changes before each scan (`templates/subject.h`).
pub const INPUTS: usize = (TERMINALS + FLAGS) as usize;

/// Distance between the inputs that change before successive scans: all of them have their turn
/// (`templates/subject.h`).
pub const INPUT_STRIDE: usize = 37;

/// Output folder of Rust builds: beside the workspace's own output, so that shared parts are built once.
const RUST_OUTPUT: &str = concat!(env!("RUNGC_ROOT"), "/target/benches");

/// The runtime that emitted Rust depends on.
const RUNTIME: &str = concat!(env!("RUNGC_ROOT"), "/runtime-rt/rt");

/// Implementation to measure.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Code {
    /// C as an engineer writes it.
    Hand,
    /// Emitted C.
    C,
    /// Emitted C for many instances at once.
    Lanes,
    /// Emitted Rust.
    Rust,
}

impl Code {
    /// Number of instances executed by one scan.
    pub fn instances(self) -> u32 {
        if self == Code::Lanes { LANES } else { 1 }
    }

    /// For tables.
    pub fn title(self) -> &'static str {
        match self {
            Code::Hand => "hand-written C",
            Code::C => "emitted C",
            Code::Lanes => "emitted C, 64 instances",
            Code::Rust => "emitted Rust",
        }
    }
}

/// An implementation of a program in C.
#[derive(Clone, Debug)]
pub struct CSubject {
    /// Prefix of its names: `PREFIX_scan`, `PREFIX_one_scan` of the adaptor.
    pub prefix: String,
    folder: PathBuf,
    program: Vec<String>,
}

/// An implementation of a program in Rust.
#[derive(Clone, Debug)]
pub struct RustSubject {
    folder: PathBuf,
    /// Of the crate.
    name: String,
}

/// Object files.
#[derive(Clone, Debug)]
pub struct Objects {
    /// The program.
    pub program: Vec<PathBuf>,
    /// Its adaptor.
    pub adaptor: PathBuf,
}

/// A program that can be emitted and observed.
pub trait Source {
    /// The program as the compiler's IR, with names that begin with `name`.
    ///
    /// # Errors
    /// It does not compile.
    fn module(&self, name: &str) -> Result<Module>;

    /// Its name among others, as part of a crate's.
    fn label(&self) -> String;

    /// The devices that change from scan to scan, [`INPUTS`] of them.
    fn inputs(&self) -> Vec<Device>;

    /// The devices that are compared.
    fn devices(&self) -> Vec<Device>;
}

impl Source for Ladder {
    fn module(&self, name: &str) -> Result<Module> {
        module(self, name)
    }

    fn label(&self) -> String {
        format!("{}_{}", self.kind.name(), self.steps)
    }

    fn inputs(&self) -> Vec<Device> {
        inputs().collect()
    }

    fn devices(&self) -> Vec<Device> {
        Ladder::devices(self)
    }
}

/// The program as the compiler's IR, with names that begin with `name`.
pub fn module(ladder: &Ladder, name: &str) -> Result<Module> {
    module_of(&ladder.list(), name)
}

/// Returns true if emitted C of a program calls the runtime.
pub fn calls_runtime(program: &dyn Source) -> Result<bool> {
    let mut calls = false;
    for function in &program.module("program")?.functions {
        walk::statements(&function.body, &mut |stmt| {
            calls |= walk::calls_runtime(stmt)
        });
    }
    Ok(calls)
}

/// Returns true if emitted C can run many instances of a program at once.
pub fn runs_in_lanes(ladder: &Ladder) -> Result<bool> {
    Ok(lanes::refusal(&module(ladder, "program")?).is_none())
}

/// A list as the compiler's IR.
pub fn module_of(list: &str, name: &str) -> Result<Module> {
    let read = rungc_frontend::read_text("ladder.il", list);
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        name: Some(name.to_string()),
        optimise: true,
        ..CompileOptions::default()
    };
    let module = compile(&read.program, &options).module;
    module.ok_or_else(|| Problem::Wrong(format!("{name} does not compile")))
}

/// The devices that change from scan to scan: all inputs and the mode flags.
pub fn inputs() -> impl Iterator<Item = Device> {
    let inputs = (0..TERMINALS).map(|n| (DeviceClass::X, n));
    inputs.chain((0..FLAGS).map(|n| (DeviceClass::M, n)))
}

/// The parts of a device that are compared, as members of what stores it, and how many bytes they have.
fn parts(class: DeviceClass) -> &'static [(&'static str, u32)] {
    match class {
        DeviceClass::T => &[(".done", 1)],
        DeviceClass::C => &[(".done", 1), (".value", 2)],
        DeviceClass::D | DeviceClass::R => &[("", 2)],
        _ => &[("", 1)],
    }
}

/// Every part that is compared: where it is, by where its device is, and its bytes.
fn compared(
    program: &dyn Source,
    place: impl Fn(Device) -> Option<String>,
) -> Result<Vec<(String, u32)>> {
    let mut all = Vec::new();
    for device in program.devices() {
        let Some(place) = place(device) else {
            return Err(Problem::Wrong(format!("{device:?} is not stored")));
        };
        let parts = parts(device.0).iter();
        all.extend(parts.map(|(member, bytes)| (format!("{place}{member}"), *bytes)));
    }
    Ok(all)
}

/// The adaptor of a C program.
struct CAdaptor<'a> {
    prefix: &'a str,
    header: String,
    plc_type: String,
    /// State of the adaptor itself.
    memory: &'static str,
    reset: String,
    scan: String,
}

impl CAdaptor<'_> {
    fn text(
        &self,
        program: &dyn Source,
        place: impl Fn(Device) -> Option<String>,
    ) -> Result<String> {
        let (prefix, plc_type) = (self.prefix, &self.plc_type);
        let mut out = format!(
            "#include \"{}\"\n#include \"subject.h\"\n\nstatic {plc_type} plc;\n",
            self.header
        );
        // Writing to a String does not fail.
        let _ = writeln!(out, "{}static unsigned char nowhere;", self.memory);
        out.push_str("static unsigned char *const inputs[INPUTS] = {\n");
        for device in program.inputs() {
            // Writing to a String does not fail.
            let _ = match place(device) {
                Some(place) => writeln!(out, "    (unsigned char *)&plc.{place},"),
                None => writeln!(out, "    &nowhere,"),
            };
        }
        out.push_str("};\nstatic const struct device devices[] = {\n");
        let devices = compared(program, place)?;
        for (place, bytes) in &devices {
            let _ = writeln!(out, "    {{&plc.{place}, {bytes}}},");
        }
        let _ = write!(
            out,
            "}};\n\nstatic void reset(void)\n{{\n    {}\n}}\n\n\
             void {prefix}_one_scan(uint32_t now_ms);\nvoid {prefix}_one_scan(uint32_t now_ms)\n{{\n    {}\n}}\n\n\
             const struct subject {prefix}_subject = {{reset, {prefix}_one_scan, inputs, devices, {}, \"{prefix}\"}};\n",
            self.reset,
            self.scan,
            devices.len()
        );
        Ok(out)
    }
}

/// C written by hand.
fn hand(ladder: &Ladder, prefix: &str, folder: &Path) -> Result<CSubject> {
    let folder = folder.join(prefix);
    let header = format!("{prefix}.h");
    tools::write(&folder.join(&header), &hand::header(ladder, prefix))?;
    let source = format!("#include \"{header}\"\n{}", hand::source(ladder, prefix));
    tools::write(&folder.join("program.c"), &source)?;
    let scan = match hand::takes_time(ladder) {
        false => format!("(void)now_ms;\n    {prefix}_scan(&plc);"),
        true => format!("{prefix}_scan(&plc, now_ms - last_ms);\n    last_ms = now_ms;"),
    };
    let reset = match hand::has_init(ladder) {
        true => format!("{prefix}_init(&plc);"),
        false => "memset(&plc, 0, sizeof plc);".to_string(),
    };
    let adaptor = CAdaptor {
        prefix,
        header,
        plc_type: "struct plc".to_string(),
        memory: "static uint32_t last_ms;\n",
        reset: format!("{reset}\n    last_ms = 0;"),
        scan,
    };
    let text = adaptor.text(ladder, |device| Some(hand::place(device)))?;
    tools::write(&folder.join("adaptor.c"), &text)?;
    Ok(CSubject {
        prefix: prefix.to_string(),
        folder,
        program: vec!["program.c".to_string()],
    })
}

/// C that rungc emits.
fn emitted_c(program: &dyn Source, prefix: &str, folder: &Path) -> Result<CSubject> {
    let folder = folder.join(prefix);
    let module = program.module(prefix)?;
    let mut sources = Vec::new();
    for file in rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default()) {
        tools::write(&folder.join(&file.path), &file.contents)?;
        if file.path.ends_with(".c") {
            sources.push(file.path);
        }
    }
    let members = rungc_codegen_c::Members::new(&module);
    let adaptor = CAdaptor {
        prefix,
        header: format!("{prefix}.h"),
        plc_type: format!("{prefix}_plc"),
        memory: "",
        reset: format!("{prefix}_init(&plc);"),
        scan: format!("{prefix}_scan(&plc, now_ms, 0);"),
    };
    let text = adaptor.text(program, |(class, number)| members.of(class, number))?;
    tools::write(&folder.join("adaptor.c"), &text)?;
    Ok(CSubject {
        prefix: prefix.to_string(),
        folder,
        program: sources,
    })
}

/// C that rungc emits for many instances. An input changes in half of them at random, and always in the first,
/// which is what is compared.
fn emitted_lanes(ladder: &Ladder, prefix: &str, folder: &Path) -> Result<CSubject> {
    let folder = folder.join(prefix);
    let module = module(ladder, prefix)?;
    let options = rungc_codegen_c::Options {
        lanes: true,
        ..rungc_codegen_c::Options::default()
    };
    let mut program = Vec::new();
    for file in rungc_codegen_c::emit(&module, &options) {
        tools::write(&folder.join(&file.path), &file.contents)?;
        if file.path.ends_with(".c") {
            program.push(file.path);
        }
    }
    let members = rungc_codegen_c::Members::new(&module);
    let (mut input_list, mut device_list) = (String::new(), String::new());
    for (class, number) in inputs() {
        // Writing to a String does not fail, here and below.
        let _ = match members.of(class, number) {
            Some(place) => writeln!(input_list, "    &all.{place},"),
            None => writeln!(input_list, "    &nowhere,"),
        };
    }
    let place = |(class, number): Device| members.of(class, number);
    let devices = compared(ladder, place)?;
    for (place, bytes) in &devices {
        let _ = match (bytes, place.strip_suffix(".done")) {
            (1, Some(contact)) => writeln!(device_list, "    {{&all.{contact}, 1}},"),
            (1, None) => writeln!(device_list, "    {{&all.{place}, 1}},"),
            _ => writeln!(device_list, "    {{&all.lane[0].{place}, {bytes}}},"),
        };
    }
    let adaptor = LANES_ADAPTOR
        .replace("@PREFIX@", prefix)
        .replace("@UNUSED@\n", &"    &unused,\n".repeat(inputs().count()))
        .replace("@INPUTS@\n", &input_list)
        .replace("@DEVICES@\n", &device_list)
        .replace("@COUNT@", &devices.len().to_string());
    tools::write(&folder.join("adaptor.c"), &adaptor)?;
    Ok(CSubject {
        prefix: prefix.to_string(),
        folder,
        program,
    })
}

fn rust_adaptor(program: &dyn Source, module: &Module, prefix: &str) -> Result<String> {
    let members = rungc_codegen_rust::Members::new(module);
    let place = |(class, number): Device| members.of(class, number);
    let mut input_list = String::new();
    for device in program.inputs() {
        // Writing to a String does not fail.
        let _ = match place(device) {
            Some(place) => writeln!(input_list, "    &raw mut (*PLC).{place} as *mut u8,"),
            None => writeln!(input_list, "    &raw mut NOWHERE,"),
        };
    }
    let devices = compared(program, place)?;
    let mut device_list = String::new();
    for (place, bytes) in &devices {
        let _ = writeln!(
            device_list,
            "    Device {{ at: &raw const (*PLC).{place} as *const u8, bytes: {bytes} }},"
        );
    }
    Ok(RUST_ADAPTOR
        .replace("@PROGRAM@", &format!("{prefix}::{}", members.type_name()))
        .replace("@PREFIX@", prefix)
        .replace("@INPUTS@", &INPUTS.to_string())
        .replace("@INPUT_LIST@", &input_list)
        .replace("@DEVICES@", &devices.len().to_string())
        .replace("@DEVICE_LIST@", &device_list))
}

impl CSubject {
    /// Writes the files of a program by hand or of one that rungc emits.
    pub fn new(code: Code, ladder: &Ladder, prefix: &str, folder: &Path) -> Result<Self> {
        match code {
            Code::Hand => hand(ladder, prefix, folder),
            Code::C => emitted_c(ladder, prefix, folder),
            Code::Lanes => emitted_lanes(ladder, prefix, folder),
            Code::Rust => Err(Problem::Wrong("Rust is not C".to_string())),
        }
    }

    /// Writes the files of a program that rungc emits.
    pub fn emitted(program: &dyn Source, prefix: &str, folder: &Path) -> Result<Self> {
        emitted_c(program, prefix, folder)
    }

    /// Compiles the program with these options, the adaptor likewise.
    pub fn compile(&self, compiler: &str, options: &[&str]) -> Result<Objects> {
        tools::write(&self.folder.join("subject.h"), SUBJECT_H)?;
        let object = |source: &str| -> Result<PathBuf> {
            let path = self.folder.join(source).with_extension("o");
            let mut command = Command::new(compiler);
            command
                .args(["-std=c99", "-ffunction-sections", "-fdata-sections"])
                .args(options)
                .arg("-c")
                .arg(self.folder.join(source))
                .arg("-o")
                .arg(&path);
            tools::run(&mut command)?;
            Ok(path)
        };
        let program = self.program.iter().map(|source| object(source));
        Ok(Objects {
            program: program.collect::<Result<_>>()?,
            adaptor: object("adaptor.c")?,
        })
    }
}

impl RustSubject {
    /// Rust that rungc emits, as a static library's crate.
    pub fn new(program: &dyn Source, prefix: &str, folder: &Path) -> Result<Self> {
        let folder = folder.join(prefix);
        let module = program.module(prefix)?;
        let options = rungc_codegen_rust::Options {
            main: false,
            servers: false,
            io: false,
            unsaved: None,
            defmt: false,
            runtime: rungc_codegen_rust::Runtime::At(RUNTIME.to_string()),
        };
        for file in rungc_codegen_rust::emit(&module, &options) {
            let text = match file.path.as_str() {
                "Cargo.toml" => file.contents.replace("[workspace]\n", ""),
                _ => file.contents,
            };
            tools::write(&folder.join("program").join(&file.path), &text)?;
        }
        let name = format!("{prefix}_{}", program.label());
        let manifest = format!(
            "[package]\nname = {name:?}\nedition = \"2024\"\n\n[lib]\npath = \"lib.rs\"\ncrate-type = [\"staticlib\"]\n\n\
             [dependencies]\n{prefix} = {{ path = \"program\" }}\nrungc-rt = {{ path = {RUNTIME:?} }}\n\n\
             [profile.release]\npanic = \"abort\"\n\n[workspace]\nmembers = [\"program\"]\n"
        );
        tools::write(&folder.join("Cargo.toml"), &manifest)?;
        let adaptor = rust_adaptor(program, &module, prefix)?;
        tools::write(&folder.join("lib.rs"), &adaptor)?;
        Ok(RustSubject { folder, name })
    }

    /// Builds it as a static library, in a folder that other subjects wait for. With a target, what is needed to build
    /// for that is in `cargo`.
    pub fn build(&self, mut cargo: Command, target: Option<&str>, level: &str) -> Result<PathBuf> {
        let output = Path::new(RUST_OUTPUT).join(level);
        let _slot = Slot::wait(output.clone()).map_err(at(&output))?;
        // Cargo takes crates with the same name for one, and compiles those again that are newer.
        for root in ["lib.rs", "program/src/lib.rs"] {
            let root = self.folder.join(root);
            cache::touch(&root).map_err(at(&root))?;
        }
        cargo
            .args(["build", "--release", "--quiet"])
            .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", level)
            .env("CARGO_TARGET_DIR", &output)
            .current_dir(&self.folder);
        let mut library = output;
        if let Some(target) = target {
            cargo.args(["--target", target]);
            library.push(target);
        }
        tools::run(&mut cargo)?;
        let name = format!("lib{}.a", self.name);
        let own = self.folder.join(&name);
        std::fs::copy(library.join("release").join(name), &own).map_err(at(&own))?;
        Ok(own)
    }
}

fn at(path: &Path) -> impl FnOnce(std::io::Error) -> Problem + '_ {
    |error| Problem::File {
        path: path.to_path_buf(),
        error,
    }
}

/// The header that lists all subjects of an executable.
pub fn list_of(prefixes: &[&str]) -> String {
    let names: Vec<String> = prefixes.iter().map(|p| format!("{p}_subject")).collect();
    format!(
        "#include \"subject.h\"\nextern const struct subject {};\nstatic const struct subject *const subjects[] = {{&{}}};\n",
        names.join(", "),
        names.join(", &")
    )
}

/// Writes the header that lists all subjects, beside `subject.h`.
pub fn write_list(folder: &Path, prefixes: &[&str]) -> Result<()> {
    tools::write(&folder.join("subject.h"), SUBJECT_H)?;
    tools::write(&folder.join("subjects.h"), &list_of(prefixes))
}
