//! The whole way from a program to its module.

use crate::check;
use crate::lower::{LowerOptions, lower};
use crate::model::{Model, ModelId};
use crate::node::Module;
use crate::passes::optimise;
use crate::resolve::resolve;
use rungc_syntax::{DeviceClass, Diagnostics, Program};

/// How to compile.
#[derive(Clone, Debug, Default)]
pub struct CompileOptions {
    /// The model; else the one that the program's source names, else FX3U.
    pub model: Option<ModelId>,
    /// Name of the module; else it is made from the name of the source.
    pub name: Option<String>,
    /// Devices that tests or a monitor look at, to be stored besides those that the program uses.
    pub observe: Vec<(DeviceClass, u32)>,
    /// Store every device of the model.
    pub observe_all: bool,
    /// Simplify the module.
    pub optimise: bool,
}

/// What came of it.
#[derive(Debug)]
pub struct Compiled {
    /// The module; `None` if there were errors.
    pub module: Option<Module>,
    /// All findings.
    pub diagnostics: Diagnostics,
    /// The model it was compiled for.
    pub model: &'static Model,
    /// Length of the program in steps.
    pub steps: u32,
}

/// Finds out all that keeps a program from being compiled, and what else is wrong with it: `module` is always `None`.
pub fn check(program: &Program, options: &CompileOptions) -> Compiled {
    Compiled {
        module: None,
        ..lowered(program, options)
    }
}

/// Compiles a program.
pub fn compile(program: &Program, options: &CompileOptions) -> Compiled {
    let mut compiled = lowered(program, options);
    if let Some(module) = compiled.module.as_mut().filter(|_| options.optimise) {
        optimise(module);
    }
    compiled
}

fn model_of(program: &Program, options: &CompileOptions) -> &'static Model {
    let named = || program.cpu.as_deref().and_then(ModelId::from_cpu);
    Model::get(options.model.or_else(named).unwrap_or(ModelId::Fx3u))
}

/// A program as lowering makes it. Lowering has the last word on what can be compiled, so checking ends with it too.
fn lowered(program: &Program, options: &CompileOptions) -> Compiled {
    let model = model_of(program, options);
    let (resolved, mut diagnostics) = resolve(program, model);
    diagnostics.extend(check::check(&resolved).sorted());
    let module = if diagnostics.has_errors() {
        None
    } else {
        let options = LowerOptions {
            name: options.name.clone(),
            observe: options.observe.clone(),
            observe_all: options.observe_all,
        };
        lower(&resolved, &options)
            .map_err(|errors| diagnostics.extend(errors.sorted()))
            .ok()
    };
    Compiled {
        module,
        diagnostics,
        model,
        steps: resolved.steps,
    }
}
