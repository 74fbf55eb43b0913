//! The programs of many test files, compiled.

use super::{Case, CaseProgram, Check, OtherPlc, TestFile};
use crate::threads::Threads;
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, Compiled, compile};
use rungc_lower::marks::Marks;
use rungc_models::{Model, ModelId};
use rungc_syntax::{DeviceClass, Diagnostic, Program, Severity, Source, codes};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Identifier of a case in a file.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub struct Id {
    /// Position of the file in the suite.
    pub file: usize,
    /// Position of the case in the file.
    pub case: usize,
}

/// Result of building a case's program.
#[derive(Debug)]
pub(super) enum Built {
    /// They are these modules: the program of the case, and those of the other PLCs in their order.
    Modules(Vec<usize>),
    /// One of them raised errors: the program of the case (0), or that of another PLC.
    Refused(usize, Errors),
    /// The case is known to pass.
    Known,
}

/// The PLC's code, the line in the program, and the message of each error.
type Errors = Vec<(Option<u16>, u32, String)>;

/// Options for compiling programs.
#[derive(Clone, Copy)]
struct How<'a> {
    /// Codes of errors that are warnings.
    warn: &'a [&'static str],
    /// True if they are marked.
    marks: bool,
}

/// A program, and where its parts come from.
type Lowered = (Module, Marks);

/// Devices that a host looks at.
type Devices = Vec<(DeviceClass, u32)>;

/// Test files and their compiled programs.
#[derive(Debug)]
pub struct Suite {
    files: Vec<TestFile>,
    modules: Vec<Module>,
    marks: Vec<Marks>,
    built: Vec<Vec<Built>>,
}

impl Suite {
    /// Compiles the programs of all cases; those that do not compile are a matter of their cases. Errors with the codes
    /// `warn` that can be eased are none.
    pub fn compile(files: Vec<TestFile>, warn: &[&'static str]) -> Self {
        Suite::compile_but(files, warn, &BTreeSet::new())
    }

    /// As [`Suite::compile`], but for cases that are known to pass.
    pub fn compile_but(files: Vec<TestFile>, warn: &[&'static str], known: &BTreeSet<Id>) -> Self {
        let how = How { warn, marks: false };
        Suite::compile_as(files, how, known)
    }

    /// As [`Suite::compile`], with marks that say where the parts of each program come from.
    pub fn compile_marked(files: Vec<TestFile>, warn: &[&'static str]) -> Self {
        let how = How { warn, marks: true };
        Suite::compile_as(files, how, &BTreeSet::new())
    }

    fn compile_as(files: Vec<TestFile>, how: How, known: &BTreeSet<Id>) -> Self {
        let shared: Vec<Shared> = files.iter().map(Shared::of).collect();
        let jobs = jobs(&files, &shared, known);
        let compiled = Threads::usual().map(&jobs, |&(id, group)| {
            let file = &files[id.file];
            compile_all(&file.cases[id.case], how, || match group {
                Some(first) => shared[id.file].observed(file, first),
                None => observed(&file.cases[id.case], 0),
            })
        });
        let mut lowered: Vec<Lowered> = Vec::new();
        let mut done: BTreeMap<Id, Result<Vec<usize>, (usize, Errors)>> = BTreeMap::new();
        for ((id, group), compiled) in jobs.into_iter().zip(compiled) {
            let modules = compiled.map(|compiled| {
                let first = lowered.len();
                lowered.extend(compiled);
                (first..lowered.len()).collect()
            });
            let case = group.unwrap_or(id.case);
            done.insert(Id { case, ..id }, modules);
        }
        let of_case = |id: Id| {
            let case = shared[id.file].first(id.case).unwrap_or(id.case);
            let done = done.get(&Id { case, ..id });
            match done.filter(|_| !known.contains(&id)) {
                Some(Ok(modules)) => Built::Modules(modules.clone()),
                Some(Err((plc, errors))) => Built::Refused(*plc, errors.clone()),
                None => Built::Known,
            }
        };
        let of_file = |(file, test): (usize, &TestFile)| {
            let cases = 0..test.cases.len();
            cases.map(|case| of_case(Id { file, case })).collect()
        };
        let built = files.iter().enumerate().map(of_file).collect();
        let (modules, marks) = lowered.into_iter().unzip();
        Suite {
            files,
            modules,
            marks,
            built,
        }
    }

    /// Sources of the parts of a program, which has the number that engines give it. Only available after
    /// [`Suite::compile_marked`].
    pub fn marks(&self, module: usize) -> &Marks {
        &self.marks[module]
    }

    /// The number of a case's program, and those of the other PLCs in their order; none if one does not compile.
    pub fn modules_of(&self, id: Id) -> &[usize] {
        match self.built(id) {
            Built::Modules(modules) => modules,
            Built::Refused(..) | Built::Known => &[],
        }
    }

    /// The program of a case as it is compiled, and how.
    pub fn source(&self, id: Id) -> (Program, CompileOptions) {
        let file = &self.files[id.file];
        let case = &file.cases[id.case];
        let shared = Shared::of(file);
        let observe = match shared.first(id.case) {
            Some(first) => shared.observed(file, first),
            None => observed(case, 0),
        };
        let model = self
            .modules_of(id)
            .first()
            .map(|&module| self.modules[module].model.id);
        let read = read_case(case);
        let options = options(case, 0, observe);
        let how = How {
            warn: &[],
            marks: false,
        };
        let options = options_of(model.unwrap_or(case.model), case, (&options, how));
        (case.with_modules(&read.program).into_owned(), options)
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

    /// Number of cases.
    pub fn len(&self) -> usize {
        self.files.iter().map(|f| f.cases.len()).sum()
    }

    /// Returns true if there is no case at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn built(&self, id: Id) -> &Built {
        &self.built[id.file][id.case]
    }
}

/// The cases whose programs have to be compiled, in their order; of those that share a program the first one that is
/// not known, with the first of all of them.
fn jobs(files: &[TestFile], shared: &[Shared], known: &BTreeSet<Id>) -> Vec<(Id, Option<usize>)> {
    let mut jobs = Vec::new();
    for (file, (test, shared)) in files.iter().zip(shared).enumerate() {
        let mut seen = BTreeSet::new();
        for case in 0..test.cases.len() {
            let id = Id { file, case };
            let group = shared.first(case);
            if !known.contains(&id) && group.is_none_or(|first| seen.insert(first)) {
                jobs.push((id, group));
            }
        }
    }
    jobs
}

/// Compiles the program of a case, with the devices that are observed, and those of its other PLCs; or gives the number
/// of the first PLC whose program raises errors, with them.
fn compile_all(
    case: &Case,
    how: How,
    observed: impl FnOnce() -> Devices,
) -> Result<Vec<Lowered>, (usize, Errors)> {
    let others = (1..).zip(&case.others);
    let others = others.map(|(plc, other)| compile_other(case, plc, other, how));
    let own = compile_case(case, observed(), how);
    let compiled = std::iter::once(own).chain(others);
    let compiled = (0..).zip(compiled);
    let compiled = compiled.map(|(plc, result)| result.map_err(|errors| (plc, errors)));
    compiled.collect()
}

/// Cases of a file that run the same program on the same PLC, so that it is compiled once, with the devices that any of
/// them reads.
struct Shared {
    /// The first case with the same program, for each case that shares it.
    firsts: Vec<Option<usize>>,
}

impl Shared {
    fn of(file: &TestFile) -> Self {
        let mut known: BTreeMap<_, Vec<usize>> = BTreeMap::new();
        for (i, case) in file.cases.iter().enumerate() {
            let alone =
                !case.others.is_empty() || !case.serve.is_empty() || !opened(case, 0).is_empty();
            if alone || matches!(case.check, Check::Rejects(_)) {
                continue;
            }
            let program = match &case.program {
                CaseProgram::List(list) => (list.as_str(), 0),
                CaseProgram::File(file) => ("", Arc::as_ptr(file) as usize),
            };
            let modules: Vec<_> = case
                .modules
                .iter()
                .map(|(unit, kind)| (unit, kind.name))
                .collect();
            let variant = case.variant.map(|variant| variant.name);
            let key = (program, Model::get(case.model).name, variant, modules);
            known.entry(key).or_default().push(i);
        }
        let mut firsts = vec![None; file.cases.len()];
        for group in known.into_values().filter(|group| group.len() > 1) {
            for &i in &group {
                firsts[i] = Some(group[0]);
            }
        }
        Shared { firsts }
    }

    /// The first case that has the program of this one, if others have it.
    fn first(&self, case: usize) -> Option<usize> {
        self.firsts[case]
    }

    /// The devices that the cases look at that share the program of this one.
    fn observed(&self, file: &TestFile, first: usize) -> Devices {
        let cases = file.cases.iter().zip(&self.firsts);
        let cases = cases.filter(|(_, of)| **of == Some(first));
        BTreeSet::from_iter(cases.flat_map(|(case, _)| observed(case, 0)))
            .into_iter()
            .collect()
    }
}

/// Devices of a PLC that a case looks at and its program may not use.
fn observed(case: &Case, plc: usize) -> Devices {
    let Check::Steps { init, steps } = &case.check else {
        return Vec::new();
    };
    let of_steps = steps
        .iter()
        .flat_map(|s| s.set.iter().cloned().chain(s.compared()));
    let of_rules = case.rules.settings();
    let of_machine = case.machine.iter().filter(|_| plc == 0);
    let of_machine = of_machine.flat_map(|machine| machine.terminals());
    let of_others = case.others.iter().flat_map(|other| &other.init);
    let at_first = init.iter().chain(of_others).cloned();
    let settings = at_first.chain(of_steps).chain(of_rules);
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
    let traced = case.trace.iter().flat_map(|trace| &trace.devices);
    let traced = traced.filter(|(of, _)| *of == plc).flat_map(|(_, target)| {
        let (class, first, count) = target.devices(0);
        (first..first.saturating_add(count)).map(move |n| (class, n))
    });
    BTreeSet::from_iter(devices.chain(of_machine).chain(traced))
        .into_iter()
        .collect()
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
    let ports = BTreeSet::from_iter(ports.filter_map(|port| port.id.number()));
    ports.into_iter().collect()
}

/// The program of a case as it is read.
fn read_case(case: &Case) -> Cow<'_, Read> {
    match &case.program {
        CaseProgram::List(list) => Cow::Owned(rungc_frontend::read_text(
            &format!("{}.il", case.name),
            list,
        )),
        CaseProgram::File(file) => Cow::Borrowed(&file.read),
    }
}

fn compile_case(case: &Case, observe: Devices, how: How) -> Result<Lowered, Errors> {
    let read = read_case(case);
    let program = &case.with_modules(&read.program);
    let compiling = options(case, 0, observe);
    let compiled = compile_on(case.model, case, program, (&compiling, how));
    let compiled = for_boards(case, program, &compiled, (&compiling, how)).unwrap_or(compiled);
    finish(&read, compiled)
}

/// The program of another PLC.
fn compile_other(case: &Case, plc: usize, other: &OtherPlc, how: How) -> Result<Lowered, Errors> {
    let name = format!("{}_{}", case.name, other.name);
    let read = rungc_frontend::read_text(&format!("{name}.il"), &other.program);
    let options = CompileOptions {
        model: Some(other.model),
        name: Some(name),
        warn: how.warn.to_vec(),
        marks: how.marks,
        ..options(case, plc, observed(case, plc))
    };
    let compiled = compile(&read.program, &options);
    finish(&read, compiled)
}

/// The module, or all errors.
fn finish(read: &Read, compiled: Compiled) -> Result<Lowered, Errors> {
    let source = &read.program.source;
    let mut found = read.diagnostics.clone();
    found.refine(&compiled.diagnostics);
    let errors: Vec<_> = found
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .map(|d| (d.plc_error, line_of(source, d), d.message.to_string()))
        .collect();
    match compiled.module {
        Some(module) if errors.is_empty() => Ok((module, compiled.marks.unwrap_or_default())),
        _ => Err(errors),
    }
}

fn compile_on(
    model: ModelId,
    case: &Case,
    program: &Program,
    compiling: (&CompileOptions, How),
) -> Compiled {
    compile(program, &options_of(model, case, compiling))
}

fn options_of(
    model: ModelId,
    case: &Case,
    (compiling, how): (&CompileOptions, How),
) -> CompileOptions {
    let (bounds, eased) = match &case.program {
        CaseProgram::List(_) => (Vec::new(), &[][..]),
        CaseProgram::File(file) => (file.bounds.clone(), &file.warn[..]),
    };
    CompileOptions {
        model: Some(model),
        name: Some(case.name.clone()),
        bounds,
        warn: how.warn.iter().chain(eased).copied().collect(),
        marks: how.marks,
        ..compiling.clone()
    }
}

/// Options that a case requires for the program of a PLC. Partners on a line may ask for any device.
fn options(case: &Case, plc: usize, observe: Devices) -> CompileOptions {
    let ports = opened(case, plc);
    let other = plc.checked_sub(1).and_then(|i| case.others.get(i));
    CompileOptions {
        variant: other.map_or(case.variant, |other| other.variant),
        observe,
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
    compiling: (&CompileOptions, How),
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
    let compiled = compile_on(boards, case, program, compiling);
    (!refused(&compiled)).then_some(compiled)
}

fn line_of(source: &Source, diagnostic: &Diagnostic) -> u32 {
    source.line_col(diagnostic.span.start).0
}
