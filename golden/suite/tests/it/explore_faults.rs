//! Planted faults: a search of a few scans finds nearly all of them, and none in the repaired programs.

use crate::faults;
use rungc_explore::run::replay;
use rungc_explore::wide::refusal;
use rungc_explore::{Kind, Limits, Report, Task, What, lanes, search, shrink};
use rungc_ir::Module;
use rungc_rt::VirtualHal;
use rungc_sim::property::{Condition, Property, parse};
use std::path::Path;

fn task<'a>(module: &'a Module, property: &'a Property, assumed: &'a [Condition]) -> Task<'a> {
    let properties = std::slice::from_ref(property);
    let world = (None, Box::new(VirtualHal::new()));
    let mut task = Task::new(module, (properties, assumed), &[], 200, world);
    task.kinds.clear();
    task
}

fn searched(task: &Task, scans: u64) -> Report {
    let limits = Limits {
        scans,
        time: None,
        seed: 1,
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
        let report = searched(&faulty, 40_000);
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
        if let Some(found) = searched(&repaired, 40_000).found.first() {
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

/// A fault that only pulses show: its name, a property, the program with it and without.
const OF_PULSES: [(&str, &str, &str, &str); 6] = [
    (
        "a count far away",
        "Y000 & !X002",
        "LD X001\nOUT C235 K200000\nLD X001\nDHSCS K9000 C235 Y000\nLDI X001\nRST Y000\nEND\n",
        "LD X001\nOUT C235 K200000\nLD X001\nDHSCS K9000 C235 M0\nLD M0\nAND X002\nOUT Y000\nEND\n",
    ),
    (
        "a count in a register",
        "Y000",
        "LD M8002\nDMOV K7777 D10\nLD M8000\nOUT C235 K200000\nDHSCS D10 C235 Y000\nEND\n",
        "LD M8002\nDMOV K7777 D10\nLD M8000\nOUT C235 K200000\nDHSCS D10 C235 M0\nEND\n",
    ),
    (
        "a zone between two counts",
        "Y011 & X002",
        "LD M8000\nOUT C235 K200000\nDHSZ K1500 K1510 C235 Y010\nLDI X001\nRST C235\nEND\n",
        "LD M8000\nOUT C235 K200000\nDHSZ K1500 K1510 C235 M10\nLD M11\nANI X002\nOUT Y011\nEND\n",
    ),
    (
        "an encoder that turns back",
        "Y000",
        "LD M8000\nOUT C251 K1000\nLDD> C251 K400\nSET M0\nLDD< C251 K-300\nAND M0\nOUT Y000\nEND\n",
        "LD M8000\nOUT C251 K1000\nLDD> C251 K400\nSET M0\nLDD< C251 K-300\nANI M0\nAND M0\nOUT Y000\nEND\n",
    ),
    (
        "a fast input",
        "Y000",
        "LD M8000\nSPD X000 K100 D0\nLD> D0 K60\nAND X004\nOUT Y000\nEND\n",
        "LD M8000\nSPD X000 K100 D0\nLD> D0 K60\nANI M8000\nOUT Y000\nEND\n",
    ),
    (
        "an interrupt that comes often",
        "Y000",
        "EI\nLDP X003\nMOV K0 D0\nLD> D0 K20\nOUT Y000\nFEND\nI001\nLD M8000\nINC D0\nIRET\nEND\n",
        "EI\nLD M8000\nMOV K0 D0\nLD> D0 K20\nOUT Y000\nFEND\nI001\nLD M8000\nINC D0\nIRET\nEND\n",
    ),
];

#[test]
fn faults_that_pulses_show_are_found() {
    for (name, never, faulty, repaired) in OF_PULSES {
        let property = Property::Never(parse(never, &|_| Vec::new()).expect(never));
        let module = faults::module(faulty, &property);
        let of_faulty = task(&module, &property, &[]);
        let report = searched(&of_faulty, 40_000);
        let found = report.found.first();
        let found = found.unwrap_or_else(|| panic!("{name}: not found"));
        let short = shrink(&of_faulty, found.clone());
        println!("{name}: after {} scans, {:?}", report.scans, short.run);
        let shown = replay(&of_faulty, &short.what, &short.run);
        assert_eq!(shown.as_ref(), Some(&short.run), "{name}");
        assert!(short.run.len() <= 12, "{name}: {:?}", short.run);
        let module = faults::module(repaired, &property);
        let of_repaired = task(&module, &property, &[]);
        let found = searched(&of_repaired, 3_000).found;
        assert!(found.is_empty(), "{name}, repaired: {found:?}");
    }
}
