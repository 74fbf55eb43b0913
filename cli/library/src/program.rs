//! A compiled program.

use crate::why::Source;
use crate::{Error, Names, Plc, Project};
use rungc_emit::OutFile;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, Compiled as Result, compile};
use rungc_lower::marks::Marks;
use rungc_sim::property::Condition;
use rungc_verify::request::Reader;
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
    /// For runs: with all devices of the model, and the sources of its parts. It is made when it is first needed.
    observed: OnceLock<(Module, Marks)>,
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
            module: compiled(project, false).module?,
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
        let Compiled { project, id, .. } = &*self.0;
        let parameters = project.source().parameters.as_ref();
        let modules = parameters.map_or(&[][..], |parameters| &parameters.modules);
        Plc::new(self.source(), *id, modules)
    }

    /// Sources of the parts that [`start`](Self::start) executes, for the crates below this one.
    pub fn marks(&self) -> &Marks {
        self.source().marks
    }

    /// Reads a condition over devices, named as in properties: `Y000 & D0 > 100`.
    ///
    /// # Errors
    /// A mistake in it.
    pub fn condition(&self, text: &str) -> std::result::Result<Condition, Error> {
        let options = self.0.project.options();
        let reader = Reader {
            program: self.0.project.source(),
            options: &options,
        };
        let condition = reader.condition(text);
        condition.map_err(|error| Error::Question(error.why))
    }

    /// The project that it was compiled from.
    pub fn project(&self) -> &Project {
        &self.0.project
    }

    /// The program as it was read, and as it runs.
    pub(crate) fn source(&self) -> Source<'_> {
        let Compiled {
            project,
            module: usual,
            observed,
            names,
            ..
        } = &*self.0;
        let made = || {
            let Result { module, marks, .. } = compiled(project, true);
            module
                .zip(marks)
                .unwrap_or_else(|| (usual.clone(), Marks::default()))
        };
        let (module, marks) = observed.get_or_init(made);
        Source {
            program: project.source(),
            module,
            marks,
            names,
            settings: project.settings(),
        }
    }
}

/// Compiles a program: for output, or for runs.
fn compiled(project: &Project, for_runs: bool) -> Result {
    let options = CompileOptions {
        optimise: !for_runs,
        observe_all: for_runs,
        marks: for_runs,
        ..project.options()
    };
    compile(project.source(), &options)
}
