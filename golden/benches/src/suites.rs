//! Time of test suites: many cases of a program, and the mutants of programs that cases judge.

use crate::clock::Clock;
use crate::ladder::{Kind, Ladder};
use crate::problem::{Problem, Result};
use crate::random::Random;
use crate::subject;
use crate::table::{Cell, Table};
use rungc_coverage::{cover, mutants};
use rungc_interp::{Machine, rt_class};
use rungc_ir::Module;
use rungc_rt::{NoHal, Plc, Program};
use rungc_sim::engines::Interpreter;
use rungc_sim::plctest::{self, Suite};
use rungc_syntax::{Device, DeviceClass};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

/// Steps of a case, and scans of each.
const STEPS: u32 = 3;
const SCANS: u32 = 5;
/// Numbers of settings and expectations in a step.
const SETS: u32 = 10;
const EXPECTS: u32 = 9;
/// Scan time, as in test files that do not specify it.
const SCAN_MS: u32 = 10;

/// A test file of cases whose inputs are random, and which expect what the interpreter does.
fn file(module: &Module, program: &str, cases: u32) -> String {
    let mut text = format!("model = \"fx3u\"\ntopic = \"mixed\"\nprogram = {program:?}\n");
    let inputs: Vec<_> = subject::inputs().collect();
    let areas = module.layout.areas.iter();
    let kept = areas.filter(|area| matches!(area.class, DeviceClass::M | DeviceClass::D));
    let numbers = kept.flat_map(|area| {
        let numbers = area.first..area.first + area.count;
        numbers.map(|number| (area.class, number))
    });
    let looked_at: Vec<_> = numbers.filter(|(_, number)| *number < 8000).collect();
    let mut random = Random::new(cases);
    for case in 0..cases {
        // Writing to a String does not fail.
        let _ = write!(text, "\n[[case]]\nname = \"case {case}\"\n");
        let (mut machine, mut now_ms) = (Machine::new(module), 0);
        for _ in 0..STEPS {
            text.push_str("[[case.step]]\nset = { ");
            settings(
                &mut text,
                &mut random,
                &inputs,
                SETS,
                |(class, number), on| {
                    let class = rt_class(class)?;
                    machine.set_bit(class, number, on)?;
                    Some(on.into())
                },
            );
            for _ in 0..SCANS {
                machine.scan(&mut NoHal, now_ms, SCAN_MS * 1000);
                now_ms += SCAN_MS;
            }
            let _ = write!(text, " }}\nscans = {SCANS}\nexpect = {{ ");
            settings(
                &mut text,
                &mut random,
                &looked_at,
                EXPECTS,
                |(class, number), _| {
                    let at = rt_class(class)?;
                    match class {
                        DeviceClass::D => machine.word(at, number),
                        _ => machine.bit(at, number).map(i16::from),
                    }
                },
            );
            text.push_str(" }\n");
        }
    }
    text
}

/// Some of the devices, each once, with the values that `value` gives them; it receives a random bit.
fn settings(
    text: &mut String,
    random: &mut Random,
    devices: &[(DeviceClass, u32)],
    count: u32,
    mut value: impl FnMut((DeviceClass, u32), bool) -> Option<i16>,
) {
    let mut named = Vec::new();
    for _ in 0..count {
        let (class, number) = random.choice(devices);
        let on = random.chance(0.5);
        if named.contains(&(class, number)) {
            continue;
        }
        if let Some(value) = value((class, number), on) {
            let comma = if named.is_empty() { "" } else { ", " };
            let _ = write!(text, "{comma}{} = {value}", Device { class, number });
            named.push((class, number));
        }
    }
}

/// A program and its test file, in a folder.
fn written(folder: &Path, ladder: &Ladder, cases: u32) -> Result<std::path::PathBuf> {
    let list = ladder.list();
    let module = subject::module_of(&list, "tested")?;
    let at = folder.join("mixed.plctest.toml");
    let files = [
        (folder.join("mixed.il"), list),
        (at.clone(), file(&module, "mixed.il", cases)),
    ];
    for (path, text) in files {
        std::fs::write(&path, text).map_err(|error| Problem::File { path, error })?;
    }
    Ok(at)
}

fn load(path: &Path) -> Result<Vec<plctest::TestFile>> {
    let file = plctest::load(path).map_err(|error| Problem::Wrong(error.to_string()))?;
    Ok(vec![file])
}

/// Reads, compiles and runs a suite; the number of scans.
fn run_suite(path: &Path) -> Result<u64> {
    let suite = Suite::compile(load(path)?, &[]);
    let mut engine = Interpreter::new(suite.modules());
    let report = plctest::run(&suite, &mut engine, &mut |_| ControlFlow::Continue(()));
    if let Some(failed) = report.failures().next() {
        return Err(Problem::Wrong(format!("a case fails: {failed:?}")));
    }
    Ok(suite.len() as u64 * u64::from(STEPS * SCANS))
}

/// Judges at most `most` mutants of a program; how many there were, and how many were noticed.
fn run_mutants(path: &Path, most: usize) -> Result<(usize, usize)> {
    let suite = Suite::compile_marked(load(path)?, &[]);
    let (programs, report) = cover(&suite, &mut |_| ControlFlow::Continue(()));
    let [program] = &programs[..] else {
        return Err(Problem::Wrong("there is no single program".to_string()));
    };
    if !report.is_success() {
        return Err(Problem::Wrong(
            "a case fails while it is observed".to_string(),
        ));
    }
    let mut all = mutants::mutants(program);
    all.truncate(most);
    let fates = mutants::run(&suite, program, &all, &|| true);
    let noticed = fates.iter().filter(|fate| **fate == mutants::Fate::Noticed);
    Ok((fates.len(), noticed.count()))
}

/// The table: a suite of `cases` cases, and `count` mutants of programs of that length, judged by a tenth of the cases
/// and by as many.
pub fn table(steps: u32, cases: u32, count: usize) -> Result<Table> {
    let mut table = Table::new(
        "Test suites of `mixed`",
        &[
            "work",
            "steps",
            "cases",
            "mutants",
            "noticed",
            "scans",
            "processor, s",
            "clock, s",
        ],
    );
    let folder = tempfile::tempdir().map_err(|error| Problem::File {
        path: std::env::temp_dir(),
        error,
    })?;
    let ladder = Ladder::new(Kind::Mixed, steps);
    let path = written(folder.path(), &ladder, cases)?;
    let (clock, start) = (Clock::start(), Instant::now());
    let scans = run_suite(&path)?;
    let none = || Cell::from("");
    table.row([
        "a suite".into(),
        Cell::count(ladder.steps.into()),
        Cell::count(cases.into()),
        none(),
        none(),
        Cell::count(scans),
        Cell::number(clock.taken().as_secs_f64(), 2),
        Cell::number(start.elapsed().as_secs_f64(), 2),
    ]);
    for judges in [cases / 10, cases] {
        let (mut judged, mut noticed) = (0, 0);
        let (mut processor, mut elapsed) = (0.0, 0.0);
        // One program has fewer mutants.
        for seed in 1.. {
            if judged >= count {
                break;
            }
            let ladder = Ladder::with_seed(Kind::Mixed, steps, seed);
            let path = written(folder.path(), &ladder, judges)?;
            let (clock, start) = (Clock::start(), Instant::now());
            let (all, seen) = run_mutants(&path, count - judged)?;
            processor += clock.taken().as_secs_f64();
            elapsed += start.elapsed().as_secs_f64();
            judged += all;
            noticed += seen;
        }
        table.row([
            "mutants".into(),
            Cell::count(ladder.steps.into()),
            Cell::count(judges.into()),
            Cell::count(judged as u64),
            Cell::count(noticed as u64),
            none(),
            Cell::number(processor, 1),
            Cell::number(elapsed, 1),
        ]);
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn suites_pass_and_judge_mutants() {
        let table = table(200, 20, 30).unwrap().to_string();
        assert_eq!(table.matches("mutants ").count(), 3, "{table}");
    }
}
