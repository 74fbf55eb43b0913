//! The programs of a text in the order in which they run, and names that are declared twice.

use crate::ast::{Configuration, Expr, ExprKind, Name, Runs, Task, Text, UnitKind};
use crate::emit::Compiler;
use crate::fold;
use crate::labels::Labels;
use crate::literal::Const;
use crate::types::Ty;
use rungc_syntax::{Device, Diagnostic, Operand, OperandKind, Span, codes, phrase};
use std::collections::BTreeMap;

/// Priority of a task that states none: the lowest.
const LOWEST: i64 = 31;

/// Unit of the timers of tasks, in milliseconds.
const TICK: i64 = 10;

/// Longest interval, in milliseconds.
const LONGEST: i64 = 32_767 * TICK;

/// A program that runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// Its position among the units.
    pub unit: usize,
    /// Time between its runs, with its place; `None` for each scan.
    pub every: Option<(i64, Span)>,
}

/// The programs in the order in which they run: that of their tasks, else that of the text.
pub(crate) fn of(tree: &Text, found: &mut Vec<Diagnostic>) -> Vec<Run> {
    let programs = tree.units.iter().enumerate();
    let programs: Vec<_> = programs
        .filter(|(_, unit)| unit.kind == UnitKind::Program)
        .map(|(unit, _)| Run { unit, every: None })
        .collect();
    if programs.is_empty() {
        if !crate::has_errors(found) {
            let error = codes::ST_SYNTAX.at(Span::default(), "this text holds no PROGRAM");
            found.push(error.help("write `PROGRAM Main`, the statements, and `END_PROGRAM`"));
        }
        return Vec::new();
    }
    let Some((first, others)) = tree.configurations.split_first() else {
        return programs;
    };
    for other in others {
        let error = codes::ST_DECLARED_TWICE.at(other.head, "this is the second CONFIGURATION");
        found.push(error.other(first.head, "the first one"));
    }
    let runs = configured(tree, first, found);
    // A line with a mistake may have been meant for one of them.
    let programs = programs.into_iter().filter(|_| !crate::has_errors(found));
    for program in programs.collect::<Vec<_>>() {
        if !runs.iter().any(|run| run.unit == program.unit) {
            let name = &tree.units[program.unit].name;
            let what = phrase!("no task runs `{name}`", name = name.text);
            let warning = codes::ST_UNUSED.at(name.span, what);
            found.push(warning.other(first.head, "the programs that run"));
        }
    }
    if runs.is_empty() && !crate::has_errors(found) {
        let what = phrase!("no task runs a program");
        found.push(codes::ST_SYNTAX.at(first.head, what));
    }
    runs
}

/// Tasks by their priorities, tasks of one priority by their names; at last the programs without a task.
fn configured(tree: &Text, all: &Configuration, found: &mut Vec<Diagnostic>) -> Vec<Run> {
    let mut tasks: BTreeMap<(i64, String), (&Task, Vec<Run>)> = BTreeMap::new();
    let mut keys: BTreeMap<String, (i64, Span)> = BTreeMap::new();
    let mut every = BTreeMap::new();
    for task in &all.tasks {
        let name = task.name.text.to_uppercase();
        let (priority, interval) = settings(task, found);
        if let Some((_, before)) = keys.insert(name.clone(), (priority, task.name.span)) {
            found.push(twice(&task.name, before));
        }
        every.insert(name.clone(), interval);
        tasks.insert((priority, name), (task, Vec::new()));
    }
    let mut last = Vec::new();
    let mut listed: BTreeMap<usize, Span> = BTreeMap::new();
    for Runs { program, task } in &all.programs {
        let is_this = |name: &Name| name.text.eq_ignore_ascii_case(&program.text);
        let mut units = tree.units.iter();
        let unit = units.position(|one| one.kind == UnitKind::Program && is_this(&one.name));
        let Some(unit) = unit else {
            let what = phrase!(
                "there is no program `{program}` in structured text",
                program = program.text
            );
            let error = codes::ST_UNKNOWN_NAME.at(program.span, what);
            found.push(error.help("add its file, or leave out the line"));
            continue;
        };
        if let Some(before) = listed.insert(unit, program.span) {
            found.push(twice(program, before));
            continue;
        }
        let Some(task) = task else {
            last.push(Run { unit, every: None });
            continue;
        };
        let name = task.text.to_uppercase();
        let key = keys
            .get(&name)
            .map(|(priority, _)| (*priority, name.clone()));
        match key.and_then(|key| tasks.get_mut(&key)) {
            Some((_, runs)) => runs.push(Run {
                unit,
                every: every.get(&name).copied().flatten(),
            }),
            None => {
                let what = phrase!("there is no task `{task}`", task = task.text);
                found.push(codes::ST_UNKNOWN_NAME.at(task.span, what));
            }
        }
    }
    let runs = tasks.into_values().flat_map(|(_, runs)| runs);
    runs.chain(last).collect()
}

/// Priority and interval of a task.
fn settings(task: &Task, found: &mut Vec<Diagnostic>) -> (i64, Option<(i64, Span)>) {
    let none = Labels::default();
    let number = |value: &Expr| match fold::constant(&none, value) {
        Some((Const::Int(number), _)) => Some(number),
        _ => None,
    };
    let (mut priority, mut every) = (LOWEST, None);
    for (key, value) in &task.settings {
        let name = key.text.to_uppercase();
        match (name.as_str(), number(value)) {
            ("PRIORITY", Some(number)) => priority = number,
            ("INTERVAL", Some(0)) => {}
            ("INTERVAL", Some(number))
                if number % TICK == 0 && (TICK..=LONGEST).contains(&number) =>
            {
                every = Some((number, value.span));
            }
            ("INTERVAL", Some(_)) => {
                let what = phrase!("an interval is a multiple of 10 ms, up to 327.67 s");
                found.push(codes::ST_LITERAL.at(value.span, what));
            }
            ("PRIORITY" | "INTERVAL", None) => {
                found.push(codes::ST_LITERAL.at(value.span, "this is not a constant"));
            }
            ("SINGLE", _) if is_always(value) => {}
            ("SINGLE", _) => {
                let what = phrase!("tasks that a bit or an interrupt starts are not compiled yet");
                let error = codes::ST_UNSUPPORTED.at(value.span, what);
                found.push(
                    error.help("run the program in each scan, with `IF` around its statements"),
                );
            }
            _ => {
                let what = phrase!("a task has no setting `{key}`", key = key.text);
                let error = codes::ST_ARGUMENTS.at(key.span, what);
                found.push(error.help("it has INTERVAL, PRIORITY and SINGLE"));
            }
        }
    }
    (priority, every)
}

fn is_always(value: &Expr) -> bool {
    matches!(&value.kind, ExprKind::Name(name) if name.eq_ignore_ascii_case("TRUE"))
}

/// Reports names that several units or structures have, and global labels with the name of a function. Labels are
/// compared with each other where they are declared; as in GX Works2, an instance may have the name of its block.
pub(crate) fn declared_twice(tree: &Text, found: &mut Vec<Diagnostic>) {
    let mut names: BTreeMap<String, (Span, bool)> = BTreeMap::new();
    let units = tree.units.iter().filter(|unit| !unit.is_library);
    let units = units.map(|unit| (&unit.name, unit.kind == UnitKind::Function));
    let structures = tree.structures.iter().map(|one| (&one.name, false));
    for (name, is_function) in units.chain(structures) {
        let key = name.text.to_uppercase();
        match names.get(&key) {
            Some((before, _)) => found.push(twice(name, *before)),
            None => {
                names.insert(key, (name.span, is_function));
            }
        }
    }
    let structures = tree.structures.iter().map(|one| &one.name);
    for name in structures.filter(|name| Ty::is_name(&name.text)) {
        let what = phrase!("`{name}` is the name of a type", name = name.text);
        let error = codes::ST_DECLARED_TWICE.at(name.span, what);
        found.push(error.help("choose another name"));
    }
    let variables = tree.globals.iter().flat_map(|section| &section.variables);
    for name in variables.flat_map(|variable| &variable.names) {
        if let Some((before, true)) = names.get(&name.text.to_uppercase()) {
            found.push(twice(name, *before));
        }
    }
}

/// That a name is declared again.
fn twice(name: &Name, before: Span) -> Diagnostic {
    let what = phrase!("`{name}` is declared twice", name = name.text);
    let error = codes::ST_DECLARED_TWICE.at(name.span, what);
    error.label("again here").other(before, "first here")
}

impl Compiler<'_> {
    /// Compiles the statements of a program. One that runs by time waits for its timer, as in GX Works2.
    pub(crate) fn program(&mut self, run: &Run) {
        let unit = &self.units[run.unit];
        self.span = unit.name.span;
        let waits = run.every.and_then(|every| self.wait(every));
        self.end = None;
        self.body(&unit.body);
        self.span = unit.name.span;
        if let Some(end) = self.end.take() {
            self.label(end);
        }
        if let Some((timer, pointer, ticks)) = waits {
            self.label(pointer);
            self.push("LDI", [timer.clone()]);
            let ticks = self.here(OperandKind::Decimal(ticks, None));
            self.push("OUT", [timer, ticks]);
        }
    }

    /// Jumps over a program while its timer runs; gives the timer, the target of the jump and the number of ticks.
    fn wait(&mut self, (every, span): (i64, Span)) -> Option<(Operand, Device, i64)> {
        let (Some(timer), Some(pointer)) = (self.supply.tick(), self.supply.pointer()) else {
            let what = phrase!("no timer of 10 ms is left for this task");
            let error = codes::ST_NO_DEVICE.at(span, what);
            self.found
                .push(error.help("leave out INTERVAL, and use TON in the program"));
            return None;
        };
        let timer = self.here(OperandKind::Device(timer, None));
        self.push("LDI", [timer.clone()]);
        let target = self.here(OperandKind::Device(pointer, None));
        self.push("CJ", [target]);
        self.is_powered = false;
        Some((timer, pointer, every / TICK))
    }
}
