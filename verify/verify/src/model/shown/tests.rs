//! Random runs on the interpreter: each special device that the runtime changes, the model lets change.

use crate::model::{Encoder, Key, World};
use crate::random::Random;
use crate::replay::{get, set};
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::comm::{CharFault, Received};
use rungc_rt::{Program, VirtualHal};
use rungc_syntax::DeviceClass::{self, D, M, X};
use std::collections::BTreeSet;

/// Instructions, each driven by X000 or one of the next inputs.
struct Case {
    model: &'static str,
    /// Lines that set up ports or outputs.
    set_up: &'static str,
    instructions: &'static [&'static str],
    /// Special devices that choose what happens: relays, and registers with small numbers.
    relays: &'static [u32],
    registers: &'static [u32],
}

const CASES: [Case; 9] = [
    Case {
        model: "fx3u",
        set_up: "",
        instructions: &[
            "DDRVA D0 D2 Y000 Y004",
            "DDVIT D4 D2 Y001 Y005",
            "DRVI D4 D2 Y000 Y004",
            "DSZR X005 X001 Y000 Y004",
            "PLSV D2 Y001 Y005",
            "ZRN D2 D3 X006 Y002",
            "PLSR D2 D4 D6 Y000",
        ],
        relays: &[8341, 8349, 8359, 8348, 8343, 8344, 8336, 8338, 8464],
        registers: &[8336, 8342, 8348],
    },
    Case {
        model: "fx3u",
        set_up: "",
        instructions: &[
            "PLSY D2 D4 Y000",
            "PWM D6 D7 Y001",
            "ABS X004 Y004 D10",
            "MTR X020 Y020 M0 K2",
            "HKY X020 Y010 D20 M40",
            "SEGL D20 Y030 K0",
            "PR D20 Y040",
            "INCD D30 C0 M60 K4",
            "RAMP D30 D31 D32 K4",
        ],
        relays: &[8349, 8145, 8146, 8026],
        registers: &[],
    },
    Case {
        model: "h2u",
        set_up: "",
        instructions: &[
            "DDRVA D0 D2 Y000 Y004",
            "PLSV D2 Y001 Y005",
            "ZRN D2 D3 X006 Y002",
            "DSZR X005 X001 Y001 Y006",
            "PLSR D2 D4 D6 Y000",
            "PLSY D2 D4 Y002",
        ],
        relays: &[8145, 8146, 8449, 8085, 8086, 8135, 8140, 8141],
        registers: &[8145, 8148, 8161],
    },
    Case {
        model: "l01s",
        set_up: "",
        instructions: &[
            "DDRVA D0 D2 Y000 Y004",
            "PLSV D2 Y001 Y005",
            "ZRN D2 D3 X006 Y002",
            "PLSY D2 D4 Y003",
        ],
        relays: &[8349, 8343, 8348],
        registers: &[],
    },
    Case {
        model: "fx1n",
        set_up: "",
        instructions: &["DRVI D4 D2 Y000 Y004", "PLSY D2 D4 Y001", "VRRD K0 D40"],
        relays: &[8145, 8140],
        registers: &[8145, 8148],
    },
    Case {
        model: "hm",
        set_up: "",
        instructions: &["DDRVI D4 D2 K1", "DPLSV D2 K2"],
        relays: &[],
        registers: &[],
    },
    Case {
        model: "fx3u",
        set_up: "LD M8002\nMOV H0C81 D8120\n",
        instructions: &["RS D100 D10 D120 D11", "RS2 D140 D10 D160 D11 K2"],
        relays: &[8122, 8123, 8402, 8422],
        registers: &[8120],
    },
    Case {
        model: "h2u",
        set_up: "LD M8002\nMOV H40 D8126\nMOV H81 D8120\n",
        instructions: &["RS D100 D10 D120 D11"],
        relays: &[8122, 8123, 8070, 8071],
        registers: &[8126, 8176, 8177],
    },
    Case {
        model: "fx2n",
        set_up: "LD M8002\nMOV H81 D8120\n",
        instructions: &["RS D100 D10 D120 D11"],
        relays: &[8122, 8123, 8070, 8071, 8128],
        registers: &[8120, 8128, 8176, 8177],
    },
];

/// Devices that are watched: the special ones, and on HM the registers of axes.
fn watched(case: &Case) -> Vec<(DeviceClass, u32)> {
    let special = (8000..8512).flat_map(|n| [(M, n), (D, n)]);
    let axes = if case.model == "hm" { 600 } else { 0 };
    special.chain((0..axes).map(|n| (D, n))).collect()
}

fn module(case: &Case) -> Module {
    let rungs = case.instructions.iter().enumerate();
    let rungs = rungs.map(|(n, instruction)| format!("LD X{n:03o}\n{instruction}\n"));
    let list = format!("{}{}END\n", case.set_up, rungs.collect::<String>());
    let id = ModelId::from_name(case.model).unwrap();
    let options = CompileOptions {
        model: Some(id),
        optimise: false,
        observe: watched(case),
        ..CompileOptions::default()
    };
    let program = rungc_frontend::read_text("program.il", &list).program;
    let compiled = compile(&program, &options);
    let mut module = compiled
        .module
        .unwrap_or_else(|| panic!("{}: {list}: {:?}", case.model, compiled.diagnostics));
    simplify(&mut module);
    module
}

/// The devices that the model lets change.
fn may_change(case: &Case, module: &Module) -> BTreeSet<Key> {
    let world = World {
        observed: BTreeSet::from_iter(watched(case)),
        ..World::default()
    };
    let encoder = Encoder::scan(module, world);
    let memory = encoder.memory();
    memory
        .filter(|(key, before, after)| before != after || encoder.external.contains(key))
        .map(|(key, ..)| key)
        .collect()
}

/// Changes inputs, operands and what chooses.
fn disturb(case: &Case, machine: &mut Machine, hal: &mut VirtualHal, random: &mut Random) {
    for _ in 0..random.below(4) {
        let input = random.below(10) as u32;
        let on = random.below(3) > 0;
        machine.input_edge(hal, input, on);
        set(machine, hal, Key::Bit(X, input), on.into());
    }
    if random.below(4) == 0 {
        let number = random.below(12) as u32;
        let value = [0, 1, 5, 40, 900, 5000][random.below(6) as usize];
        set(machine, hal, Key::Word(D, number), value);
    }
    for (class, numbers) in [(M, case.relays), (D, case.registers)] {
        if !numbers.is_empty() && random.below(6) == 0 {
            let number = numbers[random.below(numbers.len() as u64) as usize];
            let value = random.below(if class == M { 2 } else { 5 }) as i64;
            set(machine, hal, key(class, number), value);
        }
    }
    for port in 0..4 {
        if let Some(line) = hal.line(port).filter(|_| random.below(3) == 0) {
            let byte = [2, 3, 5, b'0', b'P', random.below(256) as u8][random.below(6) as usize];
            line.feed(Received {
                byte,
                at_us: 0,
                fault: match random.below(9) {
                    0 => CharFault::Parity,
                    _ => CharFault::None,
                },
            });
        }
    }
}

fn key(class: DeviceClass, number: u32) -> Key {
    match class {
        M => Key::Bit(class, number),
        _ => Key::Word(class, number),
    }
}

/// The devices that change in random runs though the model holds them.
fn missed(case: &Case) -> (BTreeSet<Key>, usize) {
    let module = module(case);
    let model_says = may_change(case, &module);
    let is_of_scan = |key: &Key| matches!(key, Key::Bit(M, 8000..=8003 | 8011..=8014));
    let watched = watched(case).into_iter();
    let watched = watched.map(|(class, number)| key(class, number));
    let watched: Vec<Key> = watched.filter(|key| !is_of_scan(key)).collect();
    let mut random = Random::new();
    let (mut missed, mut changed) = (BTreeSet::new(), BTreeSet::new());
    for _ in 0..5 {
        let (mut machine, mut hal) = (Machine::new(&module), VirtualHal::new());
        let mut now_ms = 0;
        for _ in 0..100 {
            disturb(case, &mut machine, &mut hal, &mut random);
            let before: Vec<_> = watched.iter().map(|&key| get(&machine, key)).collect();
            now_ms += 1 + random.below(20) as u32;
            machine.scan(&mut hal, now_ms, 1000);
            for (&key, before) in watched.iter().zip(before) {
                if get(&machine, key) != before {
                    changed.insert(key);
                    if !model_says.contains(&key) {
                        missed.insert(key);
                    }
                }
            }
        }
    }
    (missed, changed.len())
}

#[test]
fn the_model_lets_all_devices_change_that_the_runtime_writes() {
    for case in &CASES {
        let (missed, changed) = missed(case);
        let what = (case.model, case.instructions);
        assert_eq!(missed, BTreeSet::new(), "{what:?}");
        assert!(changed > 5, "{what:?}: {changed} devices change");
    }
}
