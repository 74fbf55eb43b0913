//! Step ladders cost what is active: blocks whose states are off are left out, and leaving them out changes nothing.

use rungc_golden::rng::Rng;
use rungc_golden::{module, sequences};
use rungc_interp::{Machine, Observer};
use rungc_ir::Module;
use rungc_ir::node::{Steps, Stmt};
use rungc_ir::walk::statements;
use rungc_models::ModelId;
use rungc_models::runs::rt_class;
use rungc_rt::{Class, NoHal, Plc, Program};
use rungc_sim::engines::{Engine, EngineKind, build};
use rungc_sim::protocol::{Answer, Request};
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// States of the random programs, timers, relays and outputs that they name.
const COMPARED: [(Class, u32); 5] = [
    (Class::S, 110),
    (Class::T, 64),
    (Class::M, 40),
    (Class::Y, 8),
    (Class::C, 1),
];

fn devices(machine: &Machine) -> Vec<(Class, u32, Option<bool>, Option<i16>)> {
    let numbers = COMPARED.iter();
    let all = numbers.flat_map(|&(class, count)| (0..count).map(move |n| (class, n)));
    let registers = [0, 10, 11].map(|n| (Class::D, n));
    all.chain(registers)
        .map(|(class, n)| (class, n, machine.bit(class, n), machine.word(class, n)))
        .collect()
}

/// The tests of a module: number of states of each.
fn tests(module: &Module) -> Vec<u32> {
    let mut found = Vec::new();
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            if let Stmt::Steps(Steps { states, .. }) = stmt {
                found.push(*states);
            }
        });
    }
    found
}

#[test]
fn blocks_that_are_left_out_would_have_no_effect() {
    let (mut single, mut groups) = (0, 0);
    for seed in 0..40 {
        let text = sequences::program(seed);
        let guarded = module(&text, ModelId::Fx3u);
        single += tests(&guarded)
            .iter()
            .filter(|&&states| states == 1)
            .count();
        groups += tests(&guarded).iter().filter(|&&states| states > 1).count();
        let mut whole = guarded.clone();
        sequences::execute_all_blocks(&mut whole);
        assert!(tests(&whole).is_empty());
        let mut machines = [Machine::new(&guarded), Machine::new(&whole)];
        let mut rng = Rng::new(seed);
        for scan in 0..150 {
            let events = random_events(&mut rng);
            for machine in &mut machines {
                for &(class, number, on) in &events {
                    machine.set_bit(class, number, on);
                    if class == Class::X {
                        machine.input_edge(&mut NoHal, number, on);
                    }
                }
                match scan {
                    70 => machine.set_running(false),
                    73 => machine.set_running(true),
                    _ => {}
                }
                machine.scan(&mut NoHal, 40 * scan, 10_000);
            }
            let [guarded, whole] = &machines;
            assert_eq!(
                devices(guarded),
                devices(whole),
                "scan {scan}, seed {seed}:\n{text}"
            );
        }
    }
    assert!(
        single > 400 && groups > 25,
        "{single} blocks, {groups} groups"
    );
}

/// Inputs that change, and states that something outside writes.
fn random_events(rng: &mut Rng) -> Vec<(Class, u32, bool)> {
    let mut events = Vec::new();
    for input in 0..8 {
        if rng.percent(20) {
            events.push((Class::X, input, rng.percent(50)));
        }
    }
    if rng.percent(10) {
        events.push((Class::S, 20 + rng.below(80), rng.percent(60)));
    }
    events
}

/// Digests of all devices of a random program after each scan of a random run on an engine.
fn digests(engine: &mut dyn Engine, number: usize, module: &Module) -> Vec<Answer> {
    let areas = || {
        let areas = module.layout.areas.iter();
        areas.filter_map(|area| Some((rt_class(area.class)?, area.first, area.count)))
    };
    let stores = |class, number| {
        areas().any(|(of, first, count)| of == class && (first..first + count).contains(&number))
    };
    let requested: Vec<Request> = areas()
        .map(|(class, first, count)| Request::Digest(class, first, count))
        .collect();
    let mut rng = Rng::new(number as u64);
    let mut execute = |requests: &[Request]| {
        let answers = engine.execute_all(requests);
        answers.unwrap_or_else(|error| panic!("{error}"))
    };
    execute(&[Request::Case(number)]);
    let mut found = Vec::new();
    for scan in 0..200 {
        let mut requests = Vec::new();
        let mut events = random_events(&mut rng);
        events.retain(|&(class, number, _)| stores(class, number));
        for (class, number, on) in events {
            requests.push(Request::SetBit(class, number, on));
            if module.takes_events() {
                requests.extend([Request::Edge(number % 8, on), Request::Interrupts]);
            }
        }
        requests.extend(match scan {
            70 => Some(Request::Run(false)),
            73 => Some(Request::Run(true)),
            _ => None,
        });
        requests.push(Request::Scan {
            now_ms: 40 * scan,
            scan_us: 10_000,
        });
        execute(&requests);
        found.extend(execute(&requested));
    }
    found
}

#[test]
fn emitted_ladders_do_what_the_interpreter_does() {
    let modules: Vec<Module> = (0..16)
        .map(|seed| module(&sequences::program(seed), ModelId::Fx3u))
        .collect();
    let ladders = modules.iter().map(|module| {
        let c = rungc_codegen_c::emit(module, &rungc_codegen_c::Options::default());
        let c = c.iter().filter(|file| file.path.ends_with(".c"));
        c.map(|file| file.contents.matches("= plc_begin_").count())
            .sum::<usize>()
    });
    let ladders: usize = ladders.sum();
    assert!(ladders > 10, "{ladders} ladders");
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("step_ladders");
    let [mut interpreter, mut c, mut rust] = EngineKind::ALL.map(|kind| {
        let engine = build(kind, &modules, &target);
        engine.unwrap_or_else(|error| panic!("{error}"))
    });
    for (number, module) in modules.iter().enumerate() {
        let expected = digests(&mut *interpreter, number, module);
        for engine in [&mut c, &mut rust] {
            let found = digests(&mut **engine, number, module);
            let differs = expected.iter().zip(&found).position(|(a, b)| a != b);
            let text = sequences::program(number as u64);
            assert_eq!(differs, None, "{}, digest:\n{text}", engine.name());
        }
    }
}

/// Sequences of eleven states, which hand on by inputs.
fn sequences_of_eleven(count: u32) -> String {
    let mut text = String::from("LD M8002\n");
    for sequence in 0..count {
        let _ = writeln!(text, "SET S{}", 20 + 11 * sequence);
    }
    for state in 20..20 + 11 * count {
        let next = if (state - 20) % 11 == 10 {
            state - 10
        } else {
            state + 1
        };
        let relay = 1000 + state;
        let _ = write!(text, "STL S{state}\nOUT M{relay}\nLD X000\nSET S{next}\n");
    }
    text + "RET\nEND\n"
}

/// Counts statements that are executed.
struct Counter(Arc<AtomicU64>);

impl Observer for Counter {
    fn before(&mut self, _: &Machine, _: &Stmt) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

#[test]
fn a_scan_costs_what_is_active() {
    let module = module(&sequences_of_eleven(14), ModelId::Fx3u);
    let count = Arc::new(AtomicU64::new(0));
    let mut machine = Machine::new(&module);
    machine.scan(&mut NoHal, 0, 0);
    machine.observe(Box::new(Counter(Arc::clone(&count))));
    machine.scan(&mut NoHal, 10, 0);
    // 154 states in 20 groups, 14 of which have an active one: a test of each block of these, and what is active.
    let executed = count.load(Ordering::Relaxed);
    assert!((200..400).contains(&executed), "{executed} statements");
}

#[test]
fn neighbours_make_groups_of_about_the_same_size() {
    let of = |count| {
        let mut found = tests(&module(&sequences_of_eleven(count), ModelId::Fx3u));
        found.retain(|&states| states > 1);
        found
    };
    assert_eq!(of(1), [11, 6, 5]);
    assert_eq!(of(2), [22, 8, 7, 7]);
    assert_eq!(of(3), [17, 6, 6, 5, 16, 8, 8]);
}

/// The lines of an emitted file from the first of its networks on.
fn networks(files: impl Iterator<Item = (String, String)>, name: &str) -> String {
    let (_, text) = files.into_iter().find(|(path, _)| path == name).unwrap();
    let lines = text.lines().skip_while(|line| !line.contains("step 0"));
    lines.take(64).collect::<Vec<_>>().join("\n")
}

#[test]
fn emitted_blocks_are_cases() {
    let module = module(&sequences_of_eleven(1), ModelId::Fx3u);
    let c = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
    let c = c.into_iter().map(|f| (f.path, f.contents));
    insta::assert_snapshot!("groups_c", networks(c, "test.c"));
    let rust = rungc_codegen_rust::emit(&module, &rungc_codegen_rust::Options::default());
    let rust = rust.into_iter().map(|f| (f.path, f.contents));
    insta::assert_snapshot!("groups_rust", networks(rust, "src/program.rs"));
}

/// Blocks that begin alike are cases; one that does not, among its neighbours, is tested with them.
#[test]
fn blocks_of_states_in_a_row_are_cases() {
    let of = |text: &str| {
        let module = module(text, ModelId::Fx3u);
        let c = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
        let c: String = c.into_iter().map(|file| file.contents).collect();
        let lines = || c.lines().map(str::trim_start);
        let cases = lines().filter(|line| line.starts_with("case ")).count();
        let tests = lines()
            .filter(|line| line.starts_with("if (plc_active("))
            .count();
        (cases, tests)
    };
    let text = sequences_of_eleven(1);
    assert_eq!(of(&text), (11, 0));
    // A state that nothing leaves is like the others, a gap between the states is not.
    assert_eq!(of(&text.replace("SET S20\nRET", "SET M0\nRET")), (11, 0));
    assert_eq!(of(&text.replace("S23", "S33")), (5, 1));
    // Where the states rise, a gap is a bit without a case.
    assert_eq!(of(&text.replace("S30", "S40")), (11, 0));
    assert_eq!(of(&sequences_of_eleven(3)), (33, 0));
}

/// A state that was left goes off in front of the ladder, unless a block before its own reads it.
#[test]
fn states_that_are_read_go_off_in_turn() {
    let begins = |action: &str| {
        let text = sequences_of_eleven(1);
        let text = text.replace("OUT M1022\n", &format!("OUT M1022\n{action}\n"));
        let module = module(&text, ModelId::Fx3u);
        let c = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
        let c: String = c.into_iter().map(|file| file.contents).collect();
        let rust = rungc_codegen_rust::emit(&module, &rungc_codegen_rust::Options::default());
        let rust: String = rust.into_iter().map(|file| file.contents).collect();
        let in_turn = c.contains("= plc_begin_in_turn(&plc");
        assert_eq!(in_turn, rust.contains(".begin_in_turn(&plc"), "{action}");
        assert_eq!(in_turn, c.contains("plc_drop_step(&plc"), "{action}");
        in_turn
    };
    for action in ["LD S20\nOUT M0", "SET S27", "LD S31\nOUT M0", "RST S22"] {
        assert!(!begins(action), "{action}");
    }
    for action in ["LD S23\nOUT M0", "MOV K2S24 D0", "MOV D1 Z0\nMOV K1S0Z0 D0"] {
        assert!(begins(action), "{action}");
    }
}

/// Blocks that change later states in other ways than by a transition are tested, since their bits would be wrong.
#[test]
fn blocks_that_reset_later_states_are_tested() {
    let cases = |action: &str| {
        let text = sequences_of_eleven(1);
        let text = text.replace("OUT M1022\n", &format!("OUT M1022\n{action}\n"));
        let module = module(&text, ModelId::Fx3u);
        let c = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
        let c: String = c.into_iter().map(|file| file.contents).collect();
        let count = |text| c.matches(text).count();
        (count("\n        case "), count("= plc_begin_"))
    };
    for action in [
        "RST S22",
        "RST S20",
        "SET S27",
        "LD S27\nOUT M0",
        "PLS M0",
        "OUT S40",
    ] {
        assert_eq!(cases(action), (11, 1), "{action}");
    }
    for action in ["RST S23", "ZRST S20 S30", "MOV D1 Z0\nMOV D0 K1S0Z0"] {
        assert_eq!(cases(action), (5, 1), "{action}");
    }
    // The states are read again where the next group begins.
    assert_eq!(cases("MOV D0 K1S28"), (11, 2));
}
