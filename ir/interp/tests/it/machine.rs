//! The interpreter's scan cycle: what is not in any single statement.

use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program};

fn module(text: &str) -> Module {
    let read = rungc_frontend::read_text("test.il", text);
    let options = CompileOptions {
        model: Some(ModelId::H2u),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    compiled
        .module
        .unwrap_or_else(|| panic!("{:?}", compiled.diagnostics))
}

fn scan(machine: &mut Machine, now_ms: u32) {
    machine.scan(&mut NoHal, now_ms, 10_000);
}

#[test]
fn a_scan_that_does_not_end_is_stopped_by_the_watchdog() {
    let module = module("LD M8000\nSET Y000\nP0\nLD M8000\nINC D0\nCJ P0\nEND\n");
    let mut machine = Machine::new(&module);
    scan(&mut machine, 0);
    assert!(machine.watchdog_tripped());
    assert_eq!(machine.bit(Class::M, 8061), Some(true));
    assert_eq!(machine.word(Class::D, 8061), Some(6105));
    assert!(!machine.output(0), "outputs are off");
    assert!(machine.word(Class::D, 0) != Some(0));
    // In STOP nothing runs.
    let count = machine.word(Class::D, 0);
    scan(&mut machine, 10);
    assert_eq!(machine.word(Class::D, 0), count);
}

#[test]
fn a_long_scan_that_ends_is_no_endless_one() {
    let module = module("FOR K100\nFOR K100\nLD M8000\nINC D0\nNEXT\nNEXT\nEND\n");
    let mut machine = Machine::new(&module);
    scan(&mut machine, 0);
    assert!(!machine.watchdog_tripped());
    assert_eq!(machine.word(Class::D, 0), Some(10_000));
}

#[test]
fn stop_clears_general_devices_and_run_begins_anew() {
    let module =
        module("LD M8002\nINC D200\nLDP X000\nINC D0\nLD X000\nOUT Y000\nOUT C0 K9\nEND\n");
    let mut machine = Machine::new(&module);
    machine.set_bit(Class::X, 0, true);
    scan(&mut machine, 0);
    scan(&mut machine, 10);
    assert_eq!(machine.word(Class::D, 0), Some(1));
    assert_eq!(machine.word(Class::C, 0), Some(1));
    assert!(machine.output(0));
    machine.set_running(false);
    scan(&mut machine, 20);
    assert!(!machine.output(0));
    assert_eq!(machine.word(Class::D, 0), Some(0));
    assert_eq!(machine.bit(Class::X, 0), Some(true), "an input stays");
    machine.set_running(true);
    scan(&mut machine, 30);
    assert_eq!(machine.word(Class::D, 200), Some(2), "a latched register");
    assert_eq!(machine.word(Class::D, 0), Some(1), "the edge is seen again");
    assert_eq!(machine.word(Class::C, 0), Some(1));
}

#[test]
fn only_latched_devices_survive_a_power_cycle() {
    let module = module("LD X000\nOUT M0\nEND\n");
    let mut machine = Machine::new(&module);
    for (class, number) in [(Class::D, 0), (Class::D, 200), (Class::D, 8000)] {
        machine.set_word(class, number, 77).unwrap();
    }
    machine.power_cycle();
    assert_eq!(machine.word(Class::D, 0), Some(0));
    assert_eq!(machine.word(Class::D, 200), Some(77));
    assert_eq!(machine.word(Class::D, 8000), Some(200), "its default");
}

#[test]
fn index_registers_have_two_names() {
    let module = module("LD X000\nOUT M0\nEND\n");
    let mut machine = Machine::new(&module);
    machine.set_word(Class::D, 8028, 5).unwrap();
    assert_eq!(machine.word(Class::Z, 0), Some(5));
    machine.set_word(Class::V, 7, -1).unwrap();
    assert_eq!(machine.word(Class::D, 8195), Some(-1));
}

#[test]
fn devices_that_the_model_lacks_are_none() {
    let module = module("LD X000\nOUT M0\nEND\n");
    let mut machine = Machine::new(&module);
    assert_eq!(machine.word(Class::D, 9_000), None);
    assert_eq!(machine.set_bit(Class::S, 5_000, true), None);
    assert_eq!(machine.word(Class::C, 200), None, "a 32-bit counter");
    assert_eq!(machine.counter32(200), Some(0));
    assert_eq!(machine.counter32(199), None);
}
