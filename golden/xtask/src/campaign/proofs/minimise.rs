//! Smaller programs and runs, and programs that are changed a little.

use super::draw::Written;
use super::run::{Goal, replay};
use super::{is_proved, violates};
use rungc_golden::rng::Rng;
use rungc_ir::Module;
use rungc_sim::property::{Condition, Property};
use rungc_verify::prove::Options;
use rungc_verify::steered::{Run, Step};
use std::time::{Duration, Instant};

/// A proof with a run against it.
pub struct Refutation<'a> {
    /// The program.
    pub written: Written,
    /// The property.
    pub property: &'a Property,
    /// The world.
    pub options: &'a Options,
    /// The run.
    pub run: Run,
}

/// Time for the minimisation of a program.
const TIME: Duration = Duration::from_secs(60);

impl Refutation<'_> {
    /// With fewer lines and a shorter run.
    pub fn minimised(mut self) -> Self {
        let end = Instant::now() + TIME;
        self.shorten();
        let mut lines: Vec<String> = self.written.text.lines().map(str::to_string).collect();
        let mut size = lines.len() / 2;
        while size > 0 {
            let mut at = 0;
            while at < lines.len() && Instant::now() < end {
                let mut fewer = lines.clone();
                fewer.drain(at..(at + size).min(lines.len()));
                let written = Written {
                    text: fewer.join("\n") + "\n",
                    ..self.written.clone()
                };
                match self.holds(&written) {
                    true => {
                        self.written = written;
                        lines = fewer;
                    }
                    false => at += size,
                }
            }
            size /= 2;
        }
        self.shorten();
        self
    }

    /// Returns true if the property of another program is proved, and the run violates it.
    fn holds(&self, written: &Written) -> bool {
        let module = written.module(self.options, &[self.property]);
        module.is_some_and(|module| {
            violates(&module, self.property, &self.options.assumed, &self.run)
                && is_proved(&module, self.property, self.options)
        })
    }

    fn shorten(&mut self) {
        let Some(module) = self.written.module(self.options, &[self.property]) else {
            return;
        };
        let run = std::mem::take(&mut self.run);
        let goal = Goal::Event(self.property);
        self.run = shorter(&[&module], goal, &self.options.assumed, run);
    }
}

/// A run with fewer scans and events in which it happens, too.
pub fn shorter(modules: &[&Module], goal: Goal, assumed: &[Condition], mut run: Run) -> Run {
    let happens = |run: &Run| replay(modules, goal, assumed, run);
    let end = Instant::now() + TIME / 6;
    if let Some(scans) = happens(&run) {
        run.steps.truncate(scans);
    }
    let attempt = |run: &mut Run, change: &dyn Fn(&mut Run)| {
        let mut other = run.clone();
        change(&mut other);
        let changed = other != *run && Instant::now() < end;
        if let Some(scans) = changed.then(|| happens(&other)).flatten() {
            other.steps.truncate(scans);
            *run = other;
            return true;
        }
        false
    };
    let mut size = run.steps.len() / 2;
    while size > 0 {
        let mut at = 1;
        while at < run.steps.len() {
            let last = |run: &Run| (at + size).min(run.steps.len());
            let is_shorter = attempt(&mut run, &|run| {
                let last = last(run);
                run.steps.drain(at..last);
            });
            at += if is_shorter { 0 } else { size };
        }
        size /= 2;
    }
    for n in (0..run.start.len()).rev() {
        attempt(&mut run, &|run| {
            run.start.remove(n);
        });
    }
    let keys: Vec<_> = run
        .steps
        .iter()
        .flat_map(|step| &step.set)
        .map(|(key, _)| *key)
        .collect();
    for key in std::collections::BTreeSet::from_iter(keys) {
        attempt(&mut run, &|run| {
            run.steps
                .iter_mut()
                .for_each(|step| step.set.retain(|(of, _)| *of != key));
        });
    }
    for n in 0..run.steps.len() {
        let step = |run: &mut Run, change: &dyn Fn(&mut Step)| {
            if let Some(step) = run.steps.get_mut(n) {
                change(step);
            }
        };
        attempt(&mut run, &|run| step(run, &|step| step.between.clear()));
        attempt(&mut run, &|run| step(run, &|step| step.scan_us = 0));
        attempt(&mut run, &|run| step(run, &|step| step.power = false));
        attempt(&mut run, &|run| step(run, &|step| step.stop = false));
    }
    run
}

/// A program with a change that a person might make; `None` if there is nothing to change.
pub fn changed(written: &Written, rng: &mut Rng) -> Option<Written> {
    let mut lines: Vec<String> = written.text.lines().map(str::to_string).collect();
    let at = rng.below(lines.len() as u32) as usize;
    let line = lines.get(at)?.clone();
    let (verb, operands) = line.split_once(' ').unwrap_or((&line, ""));
    match rng.below(6) {
        0 => {
            lines.remove(at);
        }
        1 if at + 1 < lines.len() => lines.swap(at, at + 1),
        2 => lines.insert(0, "LD X001\nOUT M49".to_string()),
        3 => {
            let input = rng.below(8);
            lines[at] = match verb {
                "LD" | "AND" | "OR" | "LDI" | "ANI" | "ORI" => format!("{verb} X{input:03o}"),
                _ => return None,
            };
        }
        4 => {
            // Two contacts in series, and in parallel, may change places.
            let next = lines.get(at + 1)?.clone();
            let (other, others) = next.split_once(' ')?;
            match (verb, other) {
                ("LD", "AND" | "OR") => {
                    lines[at] = format!("LD {others}");
                    lines[at + 1] = format!("{other} {operands}");
                }
                ("AND" | "ANI", "AND" | "ANI") | ("OR" | "ORI", "OR" | "ORI") => {
                    lines.swap(at, at + 1);
                }
                _ => return None,
            }
        }
        _ => {
            let other = match verb {
                "LD" => "LDI",
                "LDI" => "LD",
                "AND" => "ANI",
                "ANI" => "AND",
                "OR" => "ORI",
                "ORI" => "OR",
                "SET" => "RST",
                _ => return None,
            };
            lines[at] = format!("{other} {operands}");
        }
    }
    Some(Written {
        text: lines.join("\n") + "\n",
        ..written.clone()
    })
}
