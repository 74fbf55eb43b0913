//! Coverage of programs by test cases, and the changes of a program that they detect.
//!
//! [`cover`] runs the cases of a suite on the interpreter while an observer looks on, and says of each [`Goal`] whether
//! a case reached it; [`text`], [`lcov`] and [`html`] show that. [`mutants`] changes a program a little, again and
//! again, and says which changes no case notices. Start reading at [`cover`].

mod goals;
pub mod html;
pub mod lcov;
pub mod mutants;
mod observe;
pub mod text;

pub use goals::{Goal, What};
use std::collections::BTreeMap;

use goals::goals;
use observe::{Seen, Watcher};
use rungc_analysis::resolve::resolve;
use rungc_interp::Observer;
use rungc_ladder::{Ladder, build};
use rungc_lower::marks::Marks;
use rungc_models::Model;
use rungc_sim::engines::Interpreter;
use rungc_sim::plctest::{self, CaseProgram, Id, Outcome, Report, Suite};
use rungc_syntax::Program;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// A program that cases test.
#[derive(Clone)]
pub struct Covered {
    /// Its name: that of its file, or of the test file that holds its list.
    pub name: String,
    /// Its file, if it has one.
    pub path: Option<PathBuf>,
    /// Its instructions.
    pub program: Program,
    /// The PLC.
    pub model: &'static Model,
    /// Goals in the order of the program.
    pub goals: Vec<Goal>,
    /// The cases that run it, each with what was seen of each instruction.
    cases: Vec<(Id, Vec<u8>)>,
    /// By instruction: what was seen of it in all of them.
    seen: Vec<u8>,
}

impl Covered {
    /// Number of goals reached.
    pub fn reached(&self) -> usize {
        self.goals
            .iter()
            .filter(|goal| self.is_reached(goal))
            .count()
    }

    /// The program as these cases alone test it.
    #[must_use]
    pub fn only(&self, is_one: &dyn Fn(Id) -> bool) -> Covered {
        let mut part = self.clone();
        part.cases.retain(|(id, _)| is_one(*id));
        part.seen.fill(0);
        for (_, seen) in &part.cases {
            for (all, now) in part.seen.iter_mut().zip(seen) {
                *all |= now;
            }
        }
        part
    }

    /// Returns true if a goal was reached.
    pub(crate) fn is_reached(&self, goal: &Goal) -> bool {
        goal.is_reached(&self.seen)
    }

    /// Goals of these instructions, a network, that were not reached: only that, if it was not executed.
    fn missed(&self, instrs: std::ops::Range<usize>) -> Vec<&Goal> {
        let goals = self.goals.iter();
        let missed = goals.filter(|goal| instrs.contains(&goal.instr) && !self.is_reached(goal));
        let missed: Vec<&Goal> = missed.collect();
        match missed.iter().position(|goal| goal.what == What::Executed) {
            Some(at) => vec![missed[at]],
            None => missed,
        }
    }

    /// The line of an instruction in the source of the program, from 1.
    pub fn line(&self, instr: usize) -> u32 {
        let start = self.program.instrs[instr].span.start;
        self.program.source.line_col(start).0
    }
}

/// Key that distinguishes programs: their file or list, and their PLC.
type Key = (Option<PathBuf>, String, &'static str);

/// Runs all cases of a suite that is compiled with marks. `progress` receives each result, and may cancel the run.
pub fn cover(
    suite: &Suite,
    progress: &mut dyn FnMut(&Outcome) -> ControlFlow<()>,
) -> (Vec<Covered>, Report) {
    let mut programs = Programs::default();
    let of_module = programs.find(suite);
    let watched = of_module.iter().enumerate().map(|(module, program)| {
        let seen = Arc::clone(&programs.seen[(*program)?]);
        Some((Arc::new(suite.marks(module).clone()), seen))
    });
    let watched: Vec<Option<(Arc<Marks>, Arc<Seen>)>> = watched.collect();
    let observers = |module: usize| -> Box<dyn Observer> {
        match &watched[module] {
            Some((marks, seen)) => Box::new(Watcher::new(Arc::clone(marks), Arc::clone(seen))),
            None => Box::new(observe::Nobody),
        }
    };
    let mut engine = Interpreter::observed(suite.modules(), Box::new(observers));
    let report = plctest::run(suite, &mut engine, &mut |outcome| {
        programs.end_case(suite, outcome.id, &of_module);
        progress(outcome)
    });
    drop(engine);
    (programs.found, report)
}

/// The programs of a suite.
#[derive(Default)]
struct Programs {
    found: Vec<Covered>,
    /// Observations of the running case, by program.
    seen: Vec<Arc<Seen>>,
}

impl Programs {
    /// Finds the programs of all cases; of each module, which of them it is. Programs of other PLCs are not looked at.
    fn find(&mut self, suite: &Suite) -> Vec<Option<usize>> {
        let mut known: BTreeMap<Key, usize> = BTreeMap::new();
        let mut of_module = vec![None; suite.modules().len()];
        for (id, case) in suite.cases() {
            let Some(&module) = suite.modules_of(id).first() else {
                continue;
            };
            if of_module[module].is_some() {
                continue;
            }
            let model = suite.modules()[module].model;
            let (path, list) = match &case.program {
                CaseProgram::List(list) => (None, list.clone()),
                CaseProgram::File(file) => (Some(file.path.clone()), String::new()),
            };
            let number = *known
                .entry((path.clone(), list, model.name))
                .or_insert_with(|| {
                    let name = match &path {
                        Some(path) => path.display().to_string(),
                        None => format!("{}: {}", suite.files()[id.file].name, case.name),
                    };
                    let (program, _) = suite.source(id);
                    let count = program.instrs.len();
                    self.found.push(Covered {
                        name,
                        path,
                        goals: goals(
                            &program,
                            model,
                            suite.marks(module),
                            &suite.modules()[module],
                        ),
                        program,
                        model,
                        cases: Vec::new(),
                        seen: vec![0; count],
                    });
                    self.seen.push(Arc::new(Seen::new(count)));
                    self.found.len() - 1
                });
            of_module[module] = Some(number);
        }
        of_module
    }

    /// A case is over.
    fn end_case(&mut self, suite: &Suite, id: Id, of_module: &[Option<usize>]) {
        let modules = suite.modules_of(id).iter();
        let programs = modules.filter_map(|&module| of_module[module]);
        for number in programs {
            let now = self.seen[number].take();
            let program = &mut self.found[number];
            for (all, now) in program.seen.iter_mut().zip(&now) {
                *all |= now;
            }
            program.cases.push((id, now));
        }
    }
}

impl Covered {
    /// Its ladder, whose networks have the numbers that people see.
    fn drawn<T>(&self, f: impl FnOnce(&rungc_analysis::resolve::Resolved, &Ladder) -> T) -> T {
        let (resolved, _) = resolve(&self.program, self.model);
        f(&resolved, &build::ladder(&resolved))
    }
}
