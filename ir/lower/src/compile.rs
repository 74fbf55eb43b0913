//! The whole way from a program to its module.

use crate::marks::Marks;
use crate::{LowerOptions, lower, lower_marked};
use rungc_analysis::check::ports::{Setup, setups};
use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::{CrossReference, Use, UseKind};
use rungc_analysis::{check, latches};
use rungc_ir::layout::Wanted;
use rungc_ir::node::Module;
use rungc_ir::passes::optimise;
pub use rungc_ir::ranges::Bound;
use rungc_models::{Fit, Model, ModelId, Plc, Variant};
use rungc_syntax::{DeviceClass, Diagnostic, Diagnostics, Program, codes, phrase};
use std::collections::BTreeSet;

/// Options of a compilation.
#[derive(Clone, Debug, Default)]
pub struct CompileOptions {
    /// The model; else the one that the program's source names, else FX3U.
    pub model: Option<ModelId>,
    /// The PLC of the model's family that the program is held to.
    pub variant: Option<&'static Variant>,
    /// Name of the module; else it is made from the name of the source.
    pub name: Option<String>,
    /// Devices that tests or a monitor read, stored in addition to those that the program uses.
    pub observe: Vec<(DeviceClass, u32)>,
    /// Store every device of the model.
    pub observe_all: bool,
    /// Serial ports that the host opens, in addition to those that the program uses; numbers that the model does not
    /// have mean nothing.
    pub ports: Vec<u8>,
    /// The host opens the model's port for programmers and HMIs.
    pub programmer: bool,
    /// Slaves by Modbus RTU do not answer QLink, which takes memory.
    pub without_qlink: bool,
    /// Ranges of operands with an index.
    pub bounds: Vec<Bound>,
    /// Simplify the module.
    pub optimise: bool,
    /// Mark the module, which then is not simplified.
    pub marks: bool,
    /// Codes of errors that are warnings here: limits of the PLC which can be eased ([`codes::Code::can_be_eased`]);
    /// others stay errors.
    pub warn: Vec<&'static str>,
}

/// Result of a compilation.
#[derive(Debug)]
pub struct Compiled {
    /// The module; `None` if there were errors, or if the program's reader could not read all of it.
    pub module: Option<Module>,
    /// Sources of its parts, if requested.
    pub marks: Option<Marks>,
    /// All findings.
    pub diagnostics: Diagnostics,
    /// The model it was compiled for.
    pub model: &'static Model,
    /// Length of the program in steps.
    pub steps: u32,
    /// The serial ports that the program uses or sets up.
    pub ports: Vec<Setup>,
    /// The step number of each instruction: as the source counts where it does, else as the model does.
    pub step_numbers: Vec<u32>,
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
    if let Some(module) = compiled
        .module
        .as_mut()
        .filter(|_| options.optimise && !options.marks)
    {
        optimise(module);
    }
    compiled
}

/// The model that a program is compiled for.
pub fn model(program: &Program, options: &CompileOptions) -> &'static Model {
    model_of(program, options).0
}

/// Index registers that may have any value when a scan begins, to be observed: the compiler is not to conclude where an
/// index leads. Those that something else writes, and those that the program does not write.
pub fn open_indexes(
    program: &Program,
    options: &CompileOptions,
    is_written_externally: impl Fn((DeviceClass, u32)) -> bool,
) -> Vec<(DeviceClass, u32)> {
    let model = model(program, options);
    let (resolved, _) = resolve(program, model);
    let uses = CrossReference::new(&resolved).uses;
    let is_write = |used: &&Use| matches!(used.kind, UseKind::Write | UseKind::Change);
    let written: BTreeSet<_> = uses
        .iter()
        .filter(is_write)
        .flat_map(|used| (used.first.number..used.end()).map(|number| (used.first.class, number)))
        .collect();
    let indexes = [DeviceClass::V, DeviceClass::Z]
        .into_iter()
        .flat_map(|class| {
            let runs = model.runs(class).into_iter();
            runs.flat_map(move |(first, last)| (first..=last).map(move |number| (class, number)))
        });
    indexes
        .filter(|device| is_written_externally(*device) || !written.contains(device))
        .collect()
}

/// The model that a program is for, and the diagnostics of its choice.
fn model_of(program: &Program, options: &CompileOptions) -> (&'static Model, Diagnostics) {
    let mut out = Diagnostics::new();
    let (id, cpu) = match (options.model, program.cpu.as_deref()) {
        (Some(id), _) => return (Model::get(id), out),
        (None, None) => return (Model::get(ModelId::Fx3u), out),
        (None, Some(cpu)) => (Plc::for_cpu(cpu), cpu),
    };
    let taken = |id| phrase!("it is compiled as {id}", id = Model::get(id).name);
    let model = match id {
        Some((plc, Fit::Same)) => plc.model,
        Some((Plc { model: id, .. }, Fit::Nearest(different))) => {
            let message = phrase!(
                "CPU type {cpu} is not among the models; {id}",
                cpu,
                id = taken(id)
            );
            let note = codes::NEAREST_MODEL.at(program.cpu_span, message);
            out.push(note.help(different));
            id
        }
        // Of a project that was rejected nothing is compiled.
        None if program.instrs.is_empty() => ModelId::Fx3u,
        None => {
            let id = ModelId::Fx3u;
            let message = phrase!("CPU type {cpu} is not known; {id}", cpu, id = taken(id));
            let warning = codes::UNKNOWN_CPU.at(program.cpu_span, message);
            out.push(warning.help(phrase!("`--model` takes {names}", names = ModelId::names())));
            id
        }
    };
    (Model::get(model), out)
}

/// The variant that a program is compiled for: the chosen one, or the one that the program names.
fn variant_of(program: &Program, options: &CompileOptions) -> Option<&'static Variant> {
    let cpu = program.cpu.as_deref().filter(|_| options.model.is_none());
    let named = cpu.and_then(Plc::for_cpu);
    let named = named.and_then(|(plc, _)| plc.variant);
    options.variant.or(named)
}

/// A note that another model was chosen than the program names.
fn other_cpu(program: &Program, options: &CompileOptions) -> Option<Diagnostic> {
    let (chosen, cpu) = (options.model?, program.cpu.as_deref()?);
    let (plc, _) = Plc::for_cpu(cpu)?;
    let named = Some(plc.model).filter(|id| *id != chosen)?;
    let (chosen, named) = (Model::get(chosen), Model::get(named));
    let message = phrase!(
        "`--model` or rungc.toml says {chosen}, but the program names CPU type {cpu}",
        chosen = chosen.name,
        cpu
    );
    let note = codes::OTHER_CPU.at(program.cpu_span, message);
    Some(note.help(phrase!(
        "without the setting it is compiled as {named}",
        named = named.name
    )))
}

/// A program as lowering makes it. Lowering has the last word on what can be compiled, so checking ends with it too.
fn lowered(program: &Program, options: &CompileOptions) -> Compiled {
    let (model, mut diagnostics) = model_of(program, options);
    diagnostics.extend(latches::check(program, model).sorted());
    let (resolved, found) = resolve(program, model);
    diagnostics.extend(found.sorted());
    diagnostics.extend(check::check(&resolved).sorted());
    let variant = variant_of(program, options).filter(|variant| variant.model == model.id);
    if let Some(variant) = variant {
        diagnostics.extend(check::variants::check(&resolved, variant).sorted());
    }
    let eased = codes::eased().map(|code| code.id);
    let eased: Vec<_> = eased.filter(|id| options.warn.contains(id)).collect();
    diagnostics.ease(&eased);
    let wants_marks = options.marks;
    let lowered = if diagnostics.has_errors() || !program.is_complete() {
        None
    } else {
        let mut ports = options.ports.clone();
        ports.extend(model.ports.of_programmer().filter(|_| options.programmer));
        let options = LowerOptions {
            name: options.name.clone(),
            variant,
            wanted: Wanted {
                observe: options.observe.clone(),
                observe_all: options.observe_all,
                ports,
                without_qlink: options.without_qlink,
            },
            bounds: options.bounds.clone(),
        };
        let (lowered, findings) = match wants_marks {
            true => {
                let (lowered, findings) = lower_marked(&resolved, &options);
                (
                    lowered.map(|(module, marks)| (module, Some(marks))),
                    findings,
                )
            }
            false => {
                let (module, findings) = lower(&resolved, &options);
                (module.map(|module| (module, None)), findings)
            }
        };
        diagnostics.extend(findings.sorted());
        lowered
    };
    if diagnostics.has_errors() {
        diagnostics.extend(other_cpu(program, options));
    }
    let (module, marks) = lowered.unzip();
    Compiled {
        module,
        marks: marks.flatten(),
        diagnostics,
        model,
        steps: resolved.steps,
        ports: setups(&resolved),
        step_numbers: resolved.instrs.iter().map(|instr| instr.step).collect(),
    }
}
