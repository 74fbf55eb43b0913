//! A compiled program.

use crate::{Names, Plc, Project};
use rungc_emit::OutFile;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// A program that has been compiled. A clone is the same program.
#[derive(Clone, Debug)]
pub struct Program(Arc<Compiled>);

#[derive(Debug)]
struct Compiled {
    project: Project,
    /// For output: without devices that the program does not use.
    module: Module,
    /// For runs: with all devices of the model. It is made when it is first needed.
    observed: OnceLock<Module>,
    names: Names,
    /// Distinguishes the program from others of this process.
    id: u64,
}

impl Program {
    /// Compiles a program; `None` if it has errors.
    pub(crate) fn new(project: &Project) -> Option<Self> {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Some(Program(Arc::new(Compiled {
            project: project.clone(),
            module: module(project, false)?,
            observed: OnceLock::new(),
            names: project.names(),
            id: NEXT.fetch_add(1, Ordering::Relaxed),
        })))
    }

    /// Name of the program in emitted code.
    pub fn name(&self) -> &str {
        &self.0.module.name
    }

    /// Its intermediate representation, for the crates below this one.
    pub fn module(&self) -> &Module {
        &self.0.module
    }

    /// The program as a folder of C99 with a Makefile, for this machine. The same program gives the same bytes.
    pub fn emit_c(&self) -> Vec<OutFile> {
        rungc_codegen_c::emit(&self.0.module, &rungc_codegen_c::Options::default())
    }

    /// The program as a crate in `no_std` Rust. The same program gives the same bytes.
    pub fn emit_rust(&self) -> Vec<OutFile> {
        rungc_codegen_rust::emit(&self.0.module, &rungc_codegen_rust::Options::default())
    }

    /// Powers a PLC with this program on, at virtual time 0, with the special modules of the project. Its switch is at
    /// RUN; the first scan comes with [`Plc::scan`] or [`Plc::run_for`].
    pub fn start(&self) -> Plc<'_> {
        let Compiled {
            project,
            module: usual,
            observed,
            names,
            id,
        } = &*self.0;
        let made = || module(project, true).unwrap_or_else(|| usual.clone());
        let parameters = project.source().parameters.as_ref();
        let modules = parameters.map_or(&[][..], |parameters| &parameters.modules);
        Plc::new((observed.get_or_init(made), *id), modules, names)
    }
}

/// Compiles a program.
fn module(project: &Project, observe_all: bool) -> Option<Module> {
    let options = CompileOptions {
        optimise: true,
        observe_all,
        ..project.options()
    };
    compile(project.source(), &options).module
}
