//! `rungc run --write-test`: a first test, written from what a run does.
//!
//! A step ends where outputs change: one step of scans in which they stay as they are, then one scan after which they
//! are as they are from then on. So the test fails if an output changes in an earlier or in a later scan.

use super::super::verify::test_file::relative;
use super::super::{Failure, parent_dir};
use crate::output::{make_folder, write_file};
use rungc_ir::Module;
use rungc_sim::Target;
use rungc_sim::engines::Interpreter;
use rungc_sim::plctest::{self, Suite};
use rungc_sim::record::{Reading, Seen};
use rungc_sim::session::USUAL_SCAN_MS;
use rungc_syntax::DeviceClass;
use rungc_verify::written::{quoted, table};
use std::fmt::Write;
use std::mem;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Maximum number of steps of a test that people read.
const MOST_STEPS: usize = 10_000;

/// A test that is being written.
pub struct Recorder {
    path: PathBuf,
    head: String,
    /// Targets to compare.
    targets: Vec<Target>,
    /// Their values after the last scan; empty before the first.
    last: Vec<Reading>,
    steps: Vec<Step>,
    /// Settings before the last scan.
    set: Vec<(String, f64)>,
    /// Settings since.
    next: Vec<(String, f64)>,
}

/// A step of the test.
#[derive(Default)]
struct Step {
    set: Vec<(String, f64)>,
    scans: u32,
    /// Targets compared after it, and their values.
    expect: Vec<(usize, Reading)>,
}

impl Recorder {
    /// Begins a test of a program: of the outputs that it uses, and of what is watched.
    pub fn begin(
        path: &Path,
        (program, machine): (&Path, Option<&Path>),
        (module, watched): (&Module, &[Target]),
    ) -> Recorder {
        let mut head = String::new();
        let _ = writeln!(head, "topic = \"a recorded run\"");
        let _ = writeln!(head, "model = {}", quoted(module.model.name));
        let _ = writeln!(
            head,
            "program = {{ file = {} }}",
            quoted(&relative(program, path))
        );
        if let Some(machine) = machine {
            let _ = writeln!(head, "machine = {}", quoted(&relative(machine, path)));
        }
        let _ = write!(head, "\n[[case]]\nname = \"recorded\"\n");
        let areas = module
            .layout
            .areas
            .iter()
            .filter(|area| area.class == DeviceClass::Y);
        let outputs = areas.flat_map(|area| area.first..area.first + area.count);
        let outputs = outputs.map(|number| Target::Bit(DeviceClass::Y, number));
        let mut targets: Vec<Target> = outputs.collect();
        for &target in watched {
            if !matches!(target, Target::Text(..)) && !targets.contains(&target) {
                targets.push(target);
            }
        }
        Recorder {
            path: path.to_path_buf(),
            head,
            targets,
            last: Vec::new(),
            steps: Vec::new(),
            set: Vec::new(),
            next: Vec::new(),
        }
    }

    /// A device is set before the next scan.
    pub fn set(&mut self, target: Target, value: f64) {
        let name = target.to_string();
        self.next.retain(|(other, _)| *other != name);
        self.next.push((name, value));
    }

    /// A scan begins.
    pub fn scan_begins(&mut self) {
        self.set = mem::take(&mut self.next);
    }

    /// A scan and the time until the next one are over: then a test file compares.
    pub fn scanned(&mut self, seen: Seen) {
        let mut changed = Vec::new();
        for (i, &target) in self.targets.iter().enumerate() {
            let Some(now) = Reading::of(seen, target) else {
                continue;
            };
            match self.last.get_mut(i) {
                Some(last) if *last == now => {}
                Some(last) => {
                    let before = mem::replace(last, now.clone());
                    changed.push((i, before, now));
                }
                None => self.last.push(now),
            }
        }
        let begins = self.steps.is_empty() || !self.set.is_empty();
        if !begins && changed.is_empty() {
            self.extend();
            return;
        }
        // Until now, what changes held what it held before.
        if let Some(step) = self.steps.last_mut() {
            for (i, before, _) in &changed {
                if !step.expect.iter().any(|(known, _)| known == i) {
                    step.expect.push((*i, before.clone()));
                }
            }
        }
        self.steps.push(Step {
            set: mem::take(&mut self.set),
            scans: 1,
            expect: changed.into_iter().map(|(i, _, now)| (i, now)).collect(),
        });
    }

    /// Another scan in which nothing changes: after one after which something is compared, it is a separate step.
    fn extend(&mut self) {
        match self.steps.last_mut() {
            Some(step) if step.expect.is_empty() => step.scans += 1,
            _ => self.steps.push(Step {
                scans: 1,
                ..Step::default()
            }),
        }
    }

    /// Writes the test, once it has run and passed.
    pub fn keep(mut self, scan_ms: u64, force: bool) -> Result<(), Failure> {
        if self.steps.len() > MOST_STEPS {
            let why = format!(
                "--write-test: the outputs and watched devices change {} times, which no one reads; watch fewer devices or run less long",
                self.steps.len()
            );
            return Err(Failure::Because(why));
        }
        if let Some(step) = self.steps.last_mut() {
            step.expect = self.last.iter().cloned().enumerate().collect();
        }
        let mut text = mem::take(&mut self.head);
        for step in &self.steps {
            self.write(&mut text, step, scan_ms);
        }
        // The test names its program from its own folder.
        make_folder(parent_dir(&self.path))?;
        self.try_out(&text)?;
        write_file(&self.path, text.as_bytes(), force)
    }

    fn write(&self, text: &mut String, step: &Step, scan_ms: u64) {
        let _ = writeln!(text, "\n[[case.step]]");
        if !step.set.is_empty() {
            let _ = writeln!(text, "set = {}", table(&step.set));
        }
        if step.scans != 1 {
            let _ = writeln!(text, "scans = {}", step.scans);
        }
        if scan_ms != USUAL_SCAN_MS {
            let _ = writeln!(text, "scan_ms = {scan_ms}");
        }
        if !step.expect.is_empty() {
            let expect = step.expect.iter();
            let expect: Vec<_> = expect
                .map(|(i, reading)| (self.targets[*i].to_string(), reading.to_string()))
                .collect();
            let _ = writeln!(text, "expect = {}", table(&expect));
        }
    }

    /// Runs the test at once: what cannot be repeated is not a test.
    fn try_out(&self, text: &str) -> Result<(), Failure> {
        let because = |why: String| {
            Failure::Because(format!(
                "--write-test: the run cannot be repeated as a test: {why}"
            ))
        };
        let file = plctest::parse(&self.path.display().to_string(), text);
        let suite = Suite::compile(vec![file.map_err(|error| because(error.to_string()))?], &[]);
        let mut engine = Interpreter::new(suite.modules());
        let report = plctest::run(&suite, &mut engine, &mut |_| ControlFlow::Continue(()));
        match report.failures().next() {
            Some(failure) => Err(because(failure.describe(&suite))),
            None => Ok(()),
        }
    }
}
