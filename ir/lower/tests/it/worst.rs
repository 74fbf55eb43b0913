//! Upper bound of a scan.

use rungc_ir::worst::{Event, Worst, worst};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;

fn of(list: &str) -> Worst {
    let read = rungc_frontend::read_text("test.il", list);
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    worst(&compiled.module.expect("a program without errors"))
}

#[test]
fn straight_programs_count_all_their_steps() {
    let worst = of("LD X000\nOUT Y000\nLD X001\nMOV D0 D1\nEND\n");
    // 1 + 1, 1 + 5, 1.
    assert_eq!(worst.scan.steps, 9);
    assert!(worst.scan.operations > 0);
    assert!(worst.open_loops.is_empty() && worst.events.is_empty());
}

#[test]
fn loops_count_as_often_as_they_run() {
    let list = |count: &str| format!("FOR {count}\nLD X000\nADD D0 K1 D0\nNEXT\nEND\n");
    let once = of(&list("K1")).scan;
    let ten = of(&list("K10")).scan;
    assert!(ten.steps >= once.steps + 9 * 8, "{once:?} {ten:?}");
    let open = of(&list("D5"));
    assert_eq!(open.open_loops.len(), 1);
    let iteration = open.open_loops[0].iteration;
    assert_eq!(open.scan.steps + 9 * iteration.steps, ten.steps);
}

#[test]
fn calls_count_what_is_called() {
    let with = |calls: &str| {
        let called = "P0\nLD X002\nMOV D0 D1\nSRET\n";
        of(&format!("{calls}LD X001\nOUT Y000\nFEND\n{called}END\n")).scan
    };
    let none = of("LD X001\nOUT Y000\nFEND\nEND\n").scan;
    let one = with("LD X000\nCALL P0\n");
    let two = with("LD X000\nCALL P0\nCALL P0\n");
    assert!(one.operations > none.operations);
    // CALL, P0, LD, MOV, SRET; the first one follows LD X000.
    assert_eq!(two.steps - one.steps, 3 + 1 + 1 + 5 + 1);
    assert_eq!(one.steps - none.steps, 1 + 3 + 1 + 1 + 5 + 1);
}

#[test]
fn of_two_ways_the_longer_one_counts() {
    // The path that a jump skips is the longer one.
    let plain = of("LD X001\nMOV D0 D1\nLD X002\nOUT Y000\nEND\n").scan;
    let jump = of("LD X000\nCJ P0\nLD X001\nMOV D0 D1\nP0\nLD X002\nOUT Y000\nEND\n").scan;
    assert!(jump.steps >= plain.steps);
    assert!(jump.steps <= plain.steps + 1 + 3 + 1, "{plain:?} {jump:?}");
}

#[test]
fn jumps_back_are_named() {
    let worst = of("P0\nLD X001\nINC D0\nLD X000\nCJ P0\nEND\n");
    assert_eq!(worst.jumps_back.len(), 1, "{worst:?}");
}

#[test]
fn interrupts_come_on_top() {
    let list = "EI\nLD X010\nOUT Y000\nFEND\nI001\nLD M8000\nINC D0\nINC D1\nIRET\nEND\n";
    let worst = of(list);
    let cost = |event: Event| {
        worst
            .events
            .iter()
            .find(|(e, _)| *e == event)
            .map(|(_, cost)| *cost)
    };
    let routine = cost(Event::Interrupt(1)).expect("a routine");
    let all = cost(Event::Interrupts).expect("what takes them");
    assert!(
        all.operations > routine.operations && all.steps >= routine.steps,
        "{worst:?}"
    );
    assert!(cost(Event::Edge(0)).is_some());
    assert!(worst.scan.steps < 10, "{worst:?}");
}
