//! Soundness of `rungc verify`: its model must allow whatever the interpreter does. Random programs run scan by scan,
//! and each transition is looked for in the logic that the proofs are about. Examples of decided properties follow.
//!
//! The environment variables `RUNGC_RANDOM_PROGRAMS`, `RUNGC_RANDOM_SCANS` and `RUNGC_RANDOM_SEED` make it longer, or
//! another one.

use rungc_catalogue::Lower;
use rungc_golden::operands::{accepted, candidates};
use rungc_golden::random::program;
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_models::runs::{is_special, rt_class};
use rungc_rt::{Class, Plc, Program, RtFn, Stop, VirtualHal};
use rungc_sim::property::{Property, parse};
use rungc_syntax::DeviceClass;
use rungc_verify::aig::Lit;
use rungc_verify::effort::Limit;
use rungc_verify::model::{CounterPart, Digit, Encoder, Input, Key, TimerPart, World};
use rungc_verify::prove::{Options, Verdict, decide};
use rungc_verify::sat::{Answer, Solver};
use rungc_verify::system::System;
use rungc_verify::unroll::Unroller;
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

fn setting(name: &str, default: u64) -> u64 {
    let text = std::env::var(format!("RUNGC_RANDOM_{name}"));
    text.ok().and_then(|t| t.parse().ok()).unwrap_or(default)
}

fn compiled(text: &str, model: ModelId, optimise: bool) -> Option<Module> {
    let read = rungc_frontend::read_text("random.il", text);
    let options = CompileOptions {
        model: Some(model),
        optimise,
        ..CompileOptions::default()
    };
    let mut module = compile(&read.program, &options).module?;
    if !optimise {
        simplify(&mut module);
    }
    Some(module)
}

/// Value of a piece of memory in the interpreter, if it can be read.
fn seen(machine: &Machine, key: Key) -> Option<i64> {
    let class = |class: DeviceClass| rt_class(class);
    match key {
        Key::Bit(of, number) => machine.bit(class(of)?, number).map(i64::from),
        Key::Word(of, number) => machine.word(class(of)?, number).map(i64::from),
        Key::Timer(number, TimerPart::Value) => machine.word(Class::T, number).map(i64::from),
        Key::Timer(number, TimerPart::Done) => machine.bit(Class::T, number).map(i64::from),
        Key::Counter(number, CounterPart::Value) if number >= 200 => {
            machine.counter32(number).map(i64::from)
        }
        Key::Counter(number, CounterPart::Value) => machine.word(Class::C, number).map(i64::from),
        Key::Counter(number, CounterPart::Done) => machine.bit(Class::C, number).map(i64::from),
        _ => None,
    }
}

/// Sets inputs, and registers that keep their values, as a host might.
fn disturb(machine: &mut Machine, module: &Module, rng: &mut Rng, first: bool) {
    for area in &module.layout.areas {
        for number in area.first..area.first + area.count.min(64) {
            match area.class {
                DeviceClass::X if rng.percent(25) => {
                    let _ = machine.set_bit(Class::X, number, rng.percent(50));
                }
                DeviceClass::D
                    if first
                        && area.latched
                        && !is_special(DeviceClass::D, number)
                        && rng.percent(60) =>
                {
                    let _ = machine.set_word(Class::D, number, rng.value(16) as i16);
                }
                _ => {}
            }
        }
    }
}

/// Exactness with which a run was followed: the numbers of bits of memory that were computed, and that were free.
#[derive(Default)]
struct Exactness {
    computed: u64,
    free: u64,
    /// Programs whose logic has more than [`LARGEST`] nodes, which the solver would take minutes for.
    too_large: u64,
}

/// A run of the interpreter that the logic follows.
struct Run<'m> {
    module: &'m Module,
    system: &'m System,
    machine: Machine<'m>,
    unroller: Unroller<'m>,
    solver: Solver,
}

impl Run<'_> {
    /// STOP for two scans, and RUN.
    fn stop_and_run(&mut self, now_ms: u32) {
        self.machine.set_running(false);
        for _ in 0..2 {
            self.machine.scan(&mut VirtualHal::new(), now_ms, 0);
        }
        self.machine.set_running(true);
    }

    /// One scan on both; what the logic says cannot be.
    fn scan(
        &mut self,
        (now_ms, elapsed, scan_ms): (u32, u32, u32),
        restart: bool,
        exact: &mut Exactness,
    ) -> Result<bool, String> {
        let machine = &mut self.machine;
        let bit_of = |value: i64, bit: usize| value >> bit & 1 == 1;
        let before = |input: Input| match input {
            Input::Device(key, bit) | Input::Shown(_, key, bit) => {
                seen(machine, key).map(|value| bit_of(value, bit))
            }
            Input::Time(digit, bit) => Some(bit_of(
                i64::from(match digit {
                    Digit::Hundreds => elapsed / 100,
                    Digit::Tens => elapsed / 10 % 10,
                    Digit::Ones => elapsed % 10,
                }),
                bit,
            )),
            Input::ScanTime(bit) => Some(bit_of(i64::from(scan_ms) * 10, bit)),
            Input::Restart => Some(restart),
            Input::Gap(_) => None,
        };
        let start = |latch: &rungc_verify::system::Latch| {
            Some(bit_of(seen(machine, latch.key).unwrap_or(0), latch.bit))
        };
        self.unroller.extend_with(start, before);
        machine.scan(&mut VirtualHal::new(), now_ms, scan_ms * 1000);
        if machine.last_error().stop != Stop::No {
            return Ok(false);
        }
        let scan = self.unroller.len() - 1;
        let mut wrong = Vec::new();
        for &holds in &self.system.constraints {
            let holds = self.unroller.at(scan, holds);
            if holds == Lit::FALSE {
                wrong.push("a constraint does not hold".to_string());
            }
            let holds = self.solver.lit(&self.unroller.aig, holds);
            self.solver.clause(&[holds]);
        }
        for latch in &self.system.latches {
            let Some(value) = seen(&self.machine, latch.key) else {
                continue;
            };
            let is = self.unroller.at(scan, latch.next);
            let is = is.invert_if(!bit_of(value, latch.bit));
            match is.constant() {
                Some(true) => exact.computed += 1,
                Some(false) => wrong.push(format!(
                    "bit {} of {:?} is not as in {value}",
                    latch.bit, latch.key
                )),
                None => {
                    exact.free += 1;
                    let is = self.solver.lit(&self.unroller.aig, is);
                    self.solver.clause(&[is]);
                }
            }
        }
        if wrong.is_empty() && self.solver.solve(&[]) != Answer::Sat {
            wrong.push("no values of what is free lead to what the interpreter has".to_string());
        }
        match wrong.is_empty() {
            true => Ok(true),
            false => Err(format!("scan {}: {}", scan + 1, wrong.join("; "))),
        }
    }
}

/// The largest logic that is followed, in nodes.
const LARGEST: usize = 120_000;

fn follow(module: &Module, seed: u64, scans: u64, exact: &mut Exactness) -> Result<(), String> {
    let encoder = Encoder::scan(module, World::default());
    let system = encoder.system(Lit::FALSE);
    if system.aig.nodes().len() > LARGEST {
        exact.too_large += 1;
        return Ok(());
    }
    let mut run = Run {
        module,
        system: &system,
        machine: Machine::new(module),
        unroller: Unroller::new(&system, true),
        solver: Solver::new(&Limit::none()),
    };
    let mut rng = Rng::new(seed ^ 0x7E57);
    let (mut now_ms, mut elapsed) = (0, 0);
    let mut inputs = system.inputs.iter();
    let restarts = inputs.any(|(_, input)| *input == Input::Restart);
    for scan in 0..scans {
        // Programs that cannot tell RUN after STOP from power-on have a run for each.
        let restart = scan > 0 && restarts && rng.percent(15);
        if restart {
            run.stop_and_run(now_ms);
        }
        disturb(&mut run.machine, run.module, &mut rng, scan == 0);
        let scan_ms = 1 + rng.below(40);
        if !run.scan((now_ms, elapsed, scan_ms), restart, exact)? {
            break;
        }
        if module.takes_events() {
            let hal = &mut VirtualHal::new();
            for ms in 1..=scan_ms {
                run.machine.tick(hal, now_ms + ms);
                if rng.percent(10) {
                    run.machine.input_edge(hal, rng.below(8), rng.percent(50));
                }
                if rng.percent(80) {
                    run.machine.take_interrupts(hal);
                }
            }
        }
        elapsed = scan_ms;
        now_ms += elapsed;
    }
    Ok(())
}

#[test]
fn the_logic_allows_what_the_interpreter_does() {
    let (first, count) = (setting("SEED", 1), setting("PROGRAMS", 60));
    let scans = setting("SCANS", 8);
    let pools: Vec<_> = ModelId::ALL.map(|model| (model, candidates(model))).into();
    let mut exact = Exactness::default();
    let (mut followed, mut wrong) = (0, Vec::new());
    let drawn = (first..).map(|seed| {
        let (model, pool) = &pools[(seed % pools.len() as u64) as usize];
        let text = program(seed, *model, pool, 3 + (seed % 8) as u32);
        (seed, model, text)
    });
    // A routine is part of the logic wherever it is called, so calls in routines multiply it.
    let small = drawn.filter(|(_, _, text)| text.matches("CALL").count() <= 1);
    for (seed, model, text) in small.take(count as usize) {
        let Some(module) = compiled(&text, *model, seed % 2 == 0) else {
            continue;
        };
        followed += 1;
        if let Err(why) = follow(&module, seed, scans, &mut exact) {
            wrong.push(format!("seed {seed} ({model:?}): {why}\n{text}"));
        }
    }
    let Exactness {
        computed,
        free,
        too_large,
    } = exact;
    println!(
        "{followed} programs compiled, {too_large} too large, {computed} bits computed, {free} free"
    );
    assert!(
        wrong.is_empty(),
        "{} wrong:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
    assert!(
        followed * 10 >= count * 8,
        "only {followed} of {count} programs compile"
    );
    assert!(
        too_large * 5 <= count,
        "{too_large} of {count} programs are too large"
    );
    assert!(computed > free, "{computed} bits computed, {free} free");
}

/// Devices that an instruction may write though no operand names them: outputs, first states and those of a sequence,
/// annunciators.
const BESIDE: [&str; 16] = [
    "Y000", "Y001", "Y002", "Y005", "M8033", "M8140", "M0", "M1", "S0", "S1", "S2", "S5", "S21",
    "S22", "S900", "S901",
];

#[test]
fn an_instruction_writes_what_the_logic_says() {
    let mut rng = Rng::new(setting("SEED", 1));
    let mut exact = Exactness::default();
    let (mut followed, mut wrong) = (BTreeSet::new(), Vec::new());
    for model in ModelId::ALL {
        let has = |device: &&str| accepted(&format!("SET {device}"), model);
        let beside: Vec<_> = BESIDE.iter().copied().filter(has).collect();
        let set: String = beside
            .iter()
            .map(|device| format!("SET {device}\n"))
            .collect();
        let read: String = beside
            .iter()
            .map(|device| format!("LD {device}\nOUT M50\n"))
            .collect();
        for candidate in candidates(model) {
            let Lower::Call(function) = candidate.inst().lower_on_model(model) else {
                continue;
            };
            if followed.contains(&function) {
                continue;
            }
            let drawn = (0..8).find_map(|_| {
                let text = candidate.draw(&mut rng, model)?;
                let text = format!("LD M8002\n{set}LD M8000\n{text}\n{read}END\n");
                Some((compiled(&text, model, false)?, text))
            });
            let Some((module, text)) = drawn else {
                continue;
            };
            followed.insert(function);
            if let Err(why) = follow(&module, followed.len() as u64, 12, &mut exact) {
                wrong.push(format!("{model:?}: {why}\n{text}"));
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{} wrong:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
    for function in [RtFn::Ist, RtFn::Anr, RtFn::Zpop, RtFn::Plsy] {
        assert!(followed.contains(&function), "{function:?} is not followed");
    }
    println!(
        "{} instructions followed, {} too large",
        followed.len(),
        exact.too_large
    );
}

#[test]
fn each_two_outputs_of_the_examples_exclude_each_other_or_do_not() {
    let folder = concat!(env!("RUNGC_ROOT"), "/examples/programs");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "il"))
        .collect();
    files.sort();
    let (mut proved, mut violated, mut open) = (0, 0, Vec::new());
    for path in files {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let program = rungc_frontend::read(&path).unwrap().program;
        let options = CompileOptions {
            optimise: false,
            ..CompileOptions::default()
        };
        // Some are written for projects that choose a model.
        let Some(mut module) = compile(&program, &options).module else {
            continue;
        };
        simplify(&mut module);
        let encoder = Encoder::scan(&module, World::default());
        let outputs = encoder.memory().filter_map(|(key, ..)| match key {
            Key::Bit(DeviceClass::Y, number) => Some(number),
            _ => None,
        });
        let mut outputs: Vec<u32> = outputs.collect();
        // Of many equal stations, some stand for all.
        if outputs.len() > 6 {
            outputs = [outputs[0], outputs[1], outputs[outputs.len() - 1]].into();
        }
        for (i, &first) in outputs.iter().enumerate() {
            for &second in &outputs[i + 1..] {
                let [a, b] = [first, second].map(|number| DeviceClass::Y.number(number));
                let requested = format!("{a} & {b}");
                let property = Property::Never(parse(&requested, &|_| Vec::new()).unwrap());
                let options = Options {
                    effort: 300_000,
                    ..Options::default()
                };
                let begin = Instant::now();
                match decide(&module, &property, &options).verdict {
                    Verdict::Proved => proved += 1,
                    Verdict::Found(_) => violated += 1,
                    Verdict::Undecided(_) => open.push(format!("{name}: {requested}")),
                }
                let took = begin.elapsed();
                if took > Duration::from_secs(5) {
                    println!("{name}: {requested} took {took:.1?}");
                }
            }
        }
    }
    println!("{proved} proved, {violated} violated");
    assert_eq!(open, [""; 0]);
    assert!(
        proved + violated > 20,
        "{proved} proved, {violated} violated"
    );
}
