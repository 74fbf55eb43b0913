//! Planted faults: a search of a few scans finds nearly all of them, and none in the repaired programs.

mod faults;

use rungc_explore::run::replay;
use rungc_explore::{Limits, Report, Task, What, search, shrink};
use rungc_ir::Module;
use rungc_rt::VirtualHal;
use rungc_verify::property::{Condition, Property};

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
