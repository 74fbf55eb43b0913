//! Planted faults: a search of a few scans finds nearly all of them, and none in the repaired programs.

mod faults;

use rungc_explore::run::replay;
use rungc_explore::wide::refusal;
use rungc_explore::{Kind, Limits, Report, Task, What, lanes, search, shrink};
use rungc_ir::Module;
use rungc_rt::VirtualHal;
use rungc_verify::property::{Condition, Property};
use std::path::Path;

fn task<'a>(module: &'a Module, property: &'a Property, assumed: &'a [Condition]) -> Task<'a> {
    let properties = std::slice::from_ref(property);
    let world = (None, Box::new(VirtualHal::new()));
    let mut task = Task::new(module, (properties, assumed), &[], 200, world);
    task.kinds.clear();
    task
}

fn searched(task: &Task, seed: u64) -> Report {
    let limits = Limits {
        scans: 40_000,
        time: None,
        seed,
        threads: 2,
        lanes: None,
    };
    let decided = |report: &Report| !report.found.is_empty();
    search(task, &limits, &mut { decided }).expect("a search")
}

#[test]
fn planted_faults_are_found_and_none_in_repaired_programs() {
    let (mut count, mut missed, mut wrong) = (0, Vec::new(), Vec::new());
    for fault in faults::all() {
        count += 1;
        let (property, assumed) = (fault.property(), fault.assumed());
        let faulty = faults::module(&fault.faulty, &property);
        let faulty = task(&faulty, &property, &assumed);
        let report = searched(&faulty, 1);
        match report.found.first() {
            Some(found) => {
                let scans = report.scans;
                let short = shrink(&faulty, found.clone());
                assert_eq!(short.what, What::Property(0));
                let shown = replay(&faulty, &short.what, &short.run);
                assert_eq!(shown.as_ref(), Some(&short.run), "{}", fault.name);
                let steps = short.run.len();
                println!("{}: after {scans} scans, {steps} steps", fault.name);
            }
            None => missed.push(fault.name.clone()),
        }
        let repaired = faults::module(&fault.repaired, &property);
        let repaired = task(&repaired, &property, &assumed);
        if let Some(found) = searched(&repaired, 1).found.first() {
            wrong.push(format!("{}: repaired, {found:?}", fault.name));
        }
    }
    println!("{count} faults; not found: {missed:?}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(missed.len() * 25 <= count, "{missed:?} of {count}");
}

/// Programs that run in lanes, and what they compute with: contacts, timers, registers, counters.
#[test]
fn lanes_find_what_the_interpreter_finds() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("explore");
    let (mut compared, mut swept) = (0, 0);
    let faults = faults::all();
    let mut lists: Vec<(&str, &str, Property, Vec<Condition>)> = Vec::new();
    for fault in faults.iter().step_by(13) {
        lists.push((
            &fault.name,
            &fault.repaired,
            fault.property(),
            fault.assumed(),
        ));
    }
    for (name, list, property, assumed) in lists {
        let module = faults::module(list, &property);
        let mut task = task(&module, &property, &assumed);
        task.kinds = Kind::ALL.into();
        if refusal(&task).is_some() {
            continue;
        }
        let mut limits = Limits {
            scans: 100_000,
            time: None,
            seed: 3,
            threads: 2,
            lanes: None,
        };
        let interpreted = search(&task, &limits, &mut |_| false).expect("a search");
        let built = lanes::build(&task, &folder.join(compared.to_string()));
        limits.lanes = Some(built.unwrap_or_else(|error| panic!("{name}: {error}")));
        limits.threads = 1;
        let in_lanes = search(&task, &limits, &mut |_| false).expect("a search in lanes");
        assert_eq!(interpreted, in_lanes, "{name}");
        compared += 1;
        swept += interpreted.scans;
    }
    println!("{compared} programs, {swept} scans");
    assert!(compared >= 3, "{compared} programs");
}
