//! A machine that comes back to a state it was in does the same from there again: random programs on the interpreter.

use rungc_golden::operands::candidates;
use rungc_golden::random::program;
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Class, Plc, Program as _, VirtualHal};

const SCANS: u32 = 20;

/// All devices of a machine that programs work with.
fn devices(machine: &Machine) -> Vec<Option<i32>> {
    let bits = [Class::X, Class::Y, Class::M, Class::S, Class::T, Class::C];
    let words = [Class::D, Class::R, Class::T, Class::C, Class::V, Class::Z];
    let numbers = || (0..200).chain(8000..8200);
    let bits = bits
        .into_iter()
        .flat_map(|class| numbers().map(move |n| (class, n)));
    let bits = bits.map(|(class, n)| machine.bit(class, n).map(i32::from));
    let words = words
        .into_iter()
        .flat_map(|class| numbers().map(move |n| (class, n)));
    let words = words.map(|(class, n)| machine.word(class, n).map(i32::from));
    let long = (200..256).map(|n| machine.counter32(n));
    bits.chain(words).chain(long).collect()
}

/// A scan with inputs that look random, and what holds then.
fn scan(machine: &mut Machine, hal: &mut VirtualHal, n: u32) -> Vec<Option<i32>> {
    let mut rng = Rng::new(u64::from(n) + 1);
    for input in 0..16 {
        // Each model has these.
        machine.set_bit(Class::X, input, rng.percent(50)).unwrap();
    }
    hal.advance_to(10 * n);
    machine.scan(hal, 10 * n, 10_000);
    for ms in 10 * n..10 * n + 10 {
        machine.tick(hal, ms);
    }
    devices(machine)
}

#[test]
fn a_machine_repeats_what_it_has_done_from_a_saved_state() {
    let mut compared = 0;
    for model in [ModelId::Fx3u, ModelId::H2u, ModelId::Hm] {
        let candidates = candidates(model);
        for seed in 0..6 {
            let text = program(seed, model, &candidates, 40);
            let options = CompileOptions {
                model: Some(model),
                observe_all: true,
                ..CompileOptions::default()
            };
            let read = rungc_frontend::read_text("random.il", &text);
            let Some(module) = compile(&read.program, &options).module else {
                continue;
            };
            let mut machine = Machine::new(&module);
            let mut hal = VirtualHal::new();
            for n in 0..SCANS {
                scan(&mut machine, &mut hal, n);
            }
            let (saved, hardware) = (machine.save(), hal.clone());
            let run = |machine: &mut Machine, hal: &mut VirtualHal| -> Vec<_> {
                let scans = SCANS..2 * SCANS;
                scans.map(|n| scan(machine, hal, n)).collect()
            };
            let first = run(&mut machine, &mut hal);
            machine.restore(&saved);
            let second = run(&mut machine, &mut hardware.clone());
            assert!(first == second, "{model:?}, seed {seed}:\n{text}");
            compared += 1;
        }
    }
    assert!(compared > 12, "only {compared} programs compile");
}
