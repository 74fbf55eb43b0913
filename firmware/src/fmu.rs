//! A program as a functional mock-up unit (FMU) for co-simulation by FMI 3.0: an archive with the description of its
//! variables, its sources, and a shared library of them.
//!
//! [`Fmu::new`] emits the sources and describes them; [`Fmu::archive`] packs them, with the library that
//! [`Tools::c_shared`](crate::build::Tools::c_shared) builds of [`Fmu::sources`]. The functions of FMI are in
//! `templates/fmu`, the same for all programs; `fmu_program.h` and the table of variables are made here.

mod archive;
mod description;
mod page;
mod program;
mod variable;

pub use archive::ArchiveError;
pub use variable::{Causality, SCAN_NAME, TIME_NAME, Value, Variable};

use crate::target::{System, Target};
use crate::template;
use rungc_codegen_c::Options;
use rungc_emit::OutFile;
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::statements;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::env::consts::{ARCH, OS};

/// Milliseconds that a scan takes unless the importer says otherwise.
pub const SCAN_MS: u32 = 10;

/// The functions of FMI, which all units share.
const FUNCTIONS: [(&str, &str); 6] = [
    ("fmi3Functions.c", template!("fmu/fmi3Functions.c")),
    ("fmi3Functions.h", template!("fmu/fmi3Functions.h")),
    ("fmi3States.c", template!("fmu/fmi3States.c")),
    ("fmi3Unsupported.c", template!("fmu/fmi3Unsupported.c")),
    ("fmi3Variables.c", template!("fmu/fmi3Variables.c")),
    ("fmu_instance.h", template!("fmu/fmu_instance.h")),
];

/// A program as a functional mock-up unit.
#[derive(Clone, Debug)]
pub struct Fmu<'m> {
    module: &'m Module,
    /// By their value references.
    variables: Vec<Variable>,
    token: String,
    /// C of the program and of the functions of FMI, and the runtime's sources if the program links its library.
    sources: Vec<OutFile>,
}

/// A shared library for one kind of machine.
#[derive(Clone, Debug)]
pub struct Binary {
    /// Path in the archive.
    pub path: String,
    /// Contents of the file.
    pub contents: Vec<u8>,
}

impl<'m> Fmu<'m> {
    /// Emits a program whose devices are these variables; one that the program does not store is left out. The same
    /// arguments give the same bytes.
    pub fn new(module: &'m Module, variables: Vec<Variable>) -> Self {
        let mut variables = variable::stored(module, variables);
        variables.sort_by_key(Variable::reference);
        let options = Options {
            access: true,
            ..Options::default()
        };
        let emitted = rungc_codegen_c::emit(module, &options).into_iter();
        let emitted = emitted.filter(|f| !["Makefile", "CMakeLists.txt"].contains(&&*f.path));
        let mut sources: Vec<OutFile> = emitted.collect();
        let functions = FUNCTIONS.iter();
        sources.extend(functions.map(|(path, text)| OutFile::new(*path, *text)));
        sources.push(program::table(module, &variables));
        let token = token(&sources);
        sources.push(program::header(module, &token));
        sources.sort_by(|a, b| a.path.cmp(&b.path));
        Fmu {
            module,
            variables,
            token,
            sources,
        }
    }

    /// The variables, by their value references.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// All sources, with those of the runtime library if the program links it.
    pub fn sources(&self) -> &[OutFile] {
        &self.sources
    }

    /// Returns true if the program links the runtime library, which an importer cannot build: its sources are Rust.
    pub fn needs_library(&self) -> bool {
        self.sources
            .iter()
            .any(|file| file.path.starts_with("rungc-rt/"))
    }

    /// The archive, with a shared library if there is one.
    ///
    /// # Errors
    /// It cannot be packed: it is too large.
    pub fn archive(&self, binary: Option<Binary>) -> Result<Vec<u8>, ArchiveError> {
        let own = [
            // First, and not compressed: it shows what the file is.
            OutFile::new("modelDescription.xml", description::model(self)?),
            OutFile::new("documentation/index.html", page::page(self)),
        ];
        let mut files: Vec<OutFile<Vec<u8>>> = own.into_iter().map(OutFile::from).collect();
        files.extend(binary.map(|Binary { path, contents }| OutFile { path, contents }));
        if !self.needs_library() {
            let build = OutFile::new("buildDescription.xml", description::build(self)?);
            let sources = self.sources.iter().cloned().chain([build]);
            files.extend(sources.map(|file| OutFile::from(file.inside("sources"))));
        }
        archive::pack(&files)
    }

    /// The name of its shared library and of its functions.
    fn identifier(&self) -> &str {
        &self.module.name
    }
}

/// Place of a program's shared library in the archive, by the names that FMI has for systems; `None` if FMI has no name
/// for the target, or none of its programs loads shared libraries.
pub fn binary_path(target: &Target, name: &str) -> Option<String> {
    let (architecture, system) = match target.rustc_name() {
        None => (ARCH, OS),
        Some(_) if target.system == System::Bare || target.flags.contains("-static") => {
            return None;
        }
        Some(triple) => (triple.split('-').next().unwrap_or_default(), "linux"),
    };
    let architecture = match architecture {
        "x86_64" => "x86_64",
        "x86" | "i686" => "x86",
        "aarch64" => "aarch64",
        "arm" | "armv7" => "aarch32",
        _ => return None,
    };
    let (system, ending) = match system {
        "linux" => ("linux", "so"),
        "macos" => ("darwin", "dylib"),
        "windows" => ("windows", "dll"),
        _ => return None,
    };
    Some(format!("binaries/{architecture}-{system}/{name}.{ending}"))
}

/// Hash of the sources, in the form of a GUID.
fn token(sources: &[OutFile]) -> String {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    for file in sources {
        for part in [&file.path, &file.contents] {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
    }
    let digest = hash.finalize();
    let digits: String = digest[..16]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    let parts = [0..8, 8..12, 12..16, 16..20, 20..32].map(|range| &digits[range]);
    format!("{{{}}}", parts.join("-"))
}

/// Number of instructions that a message names.
const NAMED: usize = 3;

/// Hardware that a program needs and an FMU does not have, as the end of "the program …"; `None` if there is none.
pub fn refusal(module: &Module) -> Option<String> {
    let reasons = [
        (module.has_ports(), "uses serial ports"),
        (module.sends_pulses(), "sends pulses"),
    ];
    if let Some((_, reason)) = reasons.into_iter().find(|(there, _)| *there) {
        return Some(reason.to_string());
    }
    let (mut asks, mut steps) = (false, BTreeSet::new());
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            let step = match stmt {
                Stmt::Do(Action::Call(call)) if call.function.needs().hal => call.step,
                Stmt::Do(Action::Fetch(fetch)) => fetch.step,
                Stmt::Do(Action::Send(send)) => send.step,
                _ => return,
            };
            asks = true;
            // An instruction that is driven is not the first; calls of the PLC itself have this step.
            if step > 0 {
                steps.insert(step);
            }
        });
    }
    let named = steps.iter().filter_map(|step| {
        let text = &module.origin(*step)?.text;
        Some(format!("{text} (step {step})"))
    });
    let named: Vec<String> = named.collect();
    let more = named.len().saturating_sub(NAMED);
    let first = named
        .iter()
        .take(NAMED)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    match (asks, named.is_empty(), more) {
        (false, ..) => None,
        (true, true, _) => Some("uses special devices of the clock or of modules".to_string()),
        (true, false, 0) => Some(format!("asks hardware: {first}")),
        (true, false, more) => Some(format!("asks hardware: {first}, {more} more")),
    }
}
