//! The programs of many test files, compiled.

use super::{Case, CaseProgram, Check, OtherPlc, TestFile};
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, Compiled, compile};
use rungc_models::ModelId;
use rungc_syntax::order;
use rungc_syntax::{DeviceClass, Diagnostic, Program, Severity, Source, codes};

/// Which case of which file.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub struct Id {
    /// Position of the file in the suite.
    pub file: usize,
    /// Position of the case in the file.
    pub case: usize,
}

/// What became of a case's program.
#[derive(Debug)]
pub(super) enum Built {
    /// They are these modules: the program of the case, and those of the other PLCs in their order.
    Modules(Vec<usize>),
    /// One of them raised errors.
    Refused(Errors),
}

/// The PLC's code, the line in the program, and the message of each error.
type Errors = Vec<(Option<u16>, u32, String)>;

/// Test files and their compiled programs.
#[derive(Debug)]
pub struct Suite {
    files: Vec<TestFile>,
    modules: Vec<Module>,
    built: Vec<Vec<Built>>,
}

impl Suite {
    /// Compiles the programs of all cases; those that do not compile are a matter of their cases. Errors with the codes
    /// `warn` that can be eased are none.
    pub fn compile(files: Vec<TestFile>, warn: &[&'static str]) -> Self {
        let mut modules = Vec::new();
        let mut build = |case: &Case| {
            let others = (1..).zip(&case.others);
            let others = others.map(|(plc, other)| compile_other(case, plc, other, warn));
            let compiled = std::iter::once(compile_case(case, warn)).chain(others);
            match compiled.collect::<Result<Vec<Module>, Errors>>() {
                Ok(compiled) => {
                    let first = modules.len();
                    modules.extend(compiled);
                    Built::Modules((first..modules.len()).collect())
                }
                Err(errors) => Built::Refused(errors),
            }
        };
        let built = files
            .iter()
            .map(|file| file.cases.iter().map(&mut build).collect())
            .collect();
        Suite {
            files,
            modules,
            built,
        }
    }

    /// The compiled programs, in the order in which engines number them.
    pub fn modules(&self) -> &[Module] {
        &self.modules
    }

    /// The files.
    pub fn files(&self) -> &[TestFile] {
        &self.files
    }

    /// All cases in order.
    pub fn cases(&self) -> impl Iterator<Item = (Id, &Case)> {
        self.files.iter().enumerate().flat_map(|(file, test)| {
            let id = move |case| Id { file, case };
            test.cases.iter().enumerate().map(move |(i, c)| (id(i), c))
        })
    }

    /// How many cases there are.
    pub fn len(&self) -> usize {
        self.files.iter().map(|f| f.cases.len()).sum()
    }

    /// Whether there is no case at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn built(&self, id: Id) -> &Built {
        &self.built[id.file][id.case]
    }
}

/// Devices of a PLC that a case looks at and its program may not use.
fn observed(case: &Case, plc: usize) -> Vec<(DeviceClass, u32)> {
    let Check::Steps { init, steps } = &case.check else {
        return Vec::new();
    };
    let of_steps = steps.iter().flat_map(|s| s.set.iter().chain(&s.expect));
    let of_machine = case.machine.iter().filter(|_| plc == 0);
    let of_machine = of_machine.flat_map(|machine| machine.terminals());
    let of_others = case.others.iter().flat_map(|other| &other.init);
    let settings = init.iter().chain(of_others).chain(of_steps);
    let devices = settings
        .filter(|setting| setting.plc == plc)
        .flat_map(|setting| {
            let text_len = match &setting.value {
                super::Value::Text(text) => text.len(),
                _ => 0,
            };
            let (class, first, count) = setting.target.devices(text_len);
            (first..first.saturating_add(count)).map(move |n| (class, n))
        });
    order::set(devices.chain(of_machine)).into_iter().collect()
}

/// The serial ports of a PLC that a case uses.
fn opened(case: &Case, plc: usize) -> Vec<u8> {
    let Check::Steps { steps, .. } = &case.check else {
        return Vec::new();
    };
    let rx = steps.iter().flat_map(|step| &step.rx).map(|(port, _)| port);
    let tx = steps.iter().flat_map(|step| &step.expect_tx);
    let ports = rx.chain(tx.map(|(port, _)| port));
    let ports = ports.chain(case.wires.iter().flatten());
    let ports = ports.filter(|port| port.plc == plc);
    let ports = order::set(ports.filter_map(|port| port.id.number()));
    ports.into_iter().collect()
}

fn compile_case(case: &Case, warn: &[&'static str]) -> Result<Module, Errors> {
    let of_list;
    let read = match &case.program {
        CaseProgram::List(list) => {
            of_list = rungc_frontend::read_text(&format!("{}.il", case.name), list);
            &of_list
        }
        CaseProgram::File(file) => &file.read,
    };
    let program = &case.with_modules(&read.program);
    let compiled = compile_on(case.model, case, program, warn);
    let compiled = for_boards(case, program, &compiled, warn).unwrap_or(compiled);
    finish(read, compiled)
}

/// The program of another PLC.
fn compile_other(
    case: &Case,
    plc: usize,
    other: &OtherPlc,
    warn: &[&'static str],
) -> Result<Module, Errors> {
    let name = format!("{}_{}", case.name, other.name);
    let read = rungc_frontend::read_text(&format!("{name}.il"), &other.program);
    let options = CompileOptions {
        model: Some(other.model),
        name: Some(name),
        warn: warn.to_vec(),
        ..options(case, plc)
    };
    let compiled = compile(&read.program, &options);
    finish(&read, compiled)
}

/// The module, or all errors.
fn finish(read: &Read, compiled: Compiled) -> Result<Module, Errors> {
    let source = &read.program.source;
    let mut found = read.diagnostics.clone();
    found.refine(&compiled.diagnostics);
    let errors: Vec<_> = found
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .map(|d| (d.plc_error, line_of(source, d), d.message.clone()))
        .collect();
    match compiled.module {
        Some(module) if errors.is_empty() => Ok(module),
        _ => Err(errors),
    }
}

fn compile_on(model: ModelId, case: &Case, program: &Program, warn: &[&'static str]) -> Compiled {
    let (bounds, eased) = match &case.program {
        CaseProgram::List(_) => (Vec::new(), &[][..]),
        CaseProgram::File(file) => (file.bounds.clone(), &file.warn[..]),
    };
    let options = CompileOptions {
        model: Some(model),
        name: Some(case.name.clone()),
        bounds,
        warn: warn.iter().chain(eased).copied().collect(),
        ..options(case, 0)
    };
    compile(program, &options)
}

/// What a case asks of the program of a PLC. Partners on a line may ask for any device.
fn options(case: &Case, plc: usize) -> CompileOptions {
    let ports = opened(case, plc);
    let other = plc.checked_sub(1).and_then(|i| case.others.get(i));
    CompileOptions {
        variant: other.map_or(case.variant, |other| other.variant),
        observe: observed(case, plc),
        observe_all: !ports.is_empty() || !case.serve.is_empty(),
        ports,
        optimise: true,
        ..CompileOptions::default()
    }
}

/// A model stands for compatible boards too: a program that only they take, compiled for them.
fn for_boards(
    case: &Case,
    program: &Program,
    compiled: &Compiled,
    warn: &[&'static str],
) -> Option<Compiled> {
    let refused = |compiled: &Compiled| {
        let mut errors = compiled.diagnostics.iter();
        errors.any(|d| d.severity == Severity::Error && d.code != codes::NOT_IMPLEMENTED.id)
    };
    let runs = matches!(case.check, Check::Steps { .. });
    let boards = compiled
        .model
        .boards
        .filter(|_| runs && compiled.module.is_none())?;
    let compiled = compile_on(boards, case, program, warn);
    (!refused(&compiled)).then_some(compiled)
}

fn line_of(source: &Source, diagnostic: &Diagnostic) -> u32 {
    source.line_col(diagnostic.span.start).0
}
