//! Soundness of a comparison of two programs: random programs, each with a random change, run side by side.

use rungc_golden::operands::candidates;
use rungc_golden::random::program;
use rungc_golden::rng::Rng;
use rungc_golden::stations;
use rungc_ir::Module;
use rungc_ir::compare::{Behaviour, behaviour};
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::Class;
use rungc_sim::engines::{Engine, Interpreter};
use rungc_sim::protocol::Request;
use rungc_syntax::{DeviceClass, DeviceRun};
use std::collections::BTreeSet;

const MODELS: [ModelId; 3] = [ModelId::Fx3u, ModelId::H2u, ModelId::Fx2n];

fn module(text: &str, model: ModelId) -> Option<Module> {
    let read = rungc_frontend::read_text("random.il", text);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let mut module = compile(&read.program, &options).module?;
    simplify(&mut module);
    Some(module)
}

/// Positions at which networks begin, and END: at an LD after an output.
fn networks(lines: &[String]) -> Vec<usize> {
    let logic = ["LD", "AN", "OR", "INV", "ME", "MPS", "MRD", "MPP"];
    let is_logic = |line: &str| {
        logic
            .iter()
            .any(|start| line.trim_start().starts_with(start))
    };
    let begins = |at: &usize| {
        let line = lines[*at].trim_start();
        *at == 0 || line == "END" || line.starts_with("LD") && !is_logic(&lines[at - 1])
    };
    (0..lines.len()).filter(begins).collect()
}

/// A program with two networks next to each other, or anywhere, exchanged.
fn exchanged(mut lines: Vec<String>, rng: &mut Rng) -> String {
    let starts = networks(&lines);
    if starts.len() > 3 {
        let last = starts.len() as u32 - 2;
        let first = rng.below(last) as usize;
        let second = match rng.percent(50) {
            true => first + 1,
            false => first + 1 + rng.below(last - first as u32) as usize,
        };
        let end = starts[second + 1];
        let (first, second) = (starts[first], starts[second]);
        let moved: Vec<String> = lines.drain(second..end).collect();
        lines.splice(first..first, moved);
    }
    lines.join("\n") + "\n"
}

/// A program with one line removed, repeated, exchanged with the next one, or with another number in it; or with a
/// network that moved.
fn changed(text: &str, rng: &mut Rng) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
    if rng.percent(40) {
        return exchanged(lines, rng);
    }
    let at = rng.below(lines.len() as u32 - 1) as usize;
    match rng.below(6) {
        0 => _ = lines.remove(at),
        1 => lines.insert(at, lines[at].clone()),
        2 => lines.swap(at, at + 1),
        3 => lines.insert(at, format!("LD X0\nOUT M{}", rng.below(60))),
        _ => {
            let line = lines[at].trim_end();
            let digits = line.trim_end_matches(|c: char| c.is_ascii_digit());
            let other = format!("{digits}{}", rng.below(8));
            lines[at] = other;
        }
    }
    lines.join("\n") + "\n"
}

fn requests((class, number): (DeviceClass, u32)) -> Vec<Request> {
    let bit = |class| vec![Request::Bit(class, number)];
    let word = |class| vec![Request::Word(class, number)];
    match class {
        DeviceClass::X => bit(Class::X),
        DeviceClass::Y => bit(Class::Y),
        DeviceClass::M => bit(Class::M),
        DeviceClass::S => bit(Class::S),
        DeviceClass::T => [bit(Class::T), word(Class::T)].concat(),
        DeviceClass::C if number >= 200 => {
            [bit(Class::C), vec![Request::Double(Class::C, number)]].concat()
        }
        DeviceClass::C => [bit(Class::C), word(Class::C)].concat(),
        DeviceClass::D => word(Class::D),
        DeviceClass::R => word(Class::R),
        DeviceClass::ER => word(Class::ER),
        DeviceClass::V => word(Class::V),
        DeviceClass::Z => word(Class::Z),
        DeviceClass::P | DeviceClass::I | DeviceClass::N => vec![],
    }
}

/// The devices that a module stores, of each area at most some.
fn stored(module: &Module) -> BTreeSet<(DeviceClass, u32)> {
    let areas = module.layout.areas.iter();
    areas
        .flat_map(|area| (area.first..area.first + area.count.min(100)).map(|n| (area.class, n)))
        .collect()
}

/// Inputs from a host and the machine before a scan, to devices that both programs store.
fn events(rng: &mut Rng, shared: &BTreeSet<(DeviceClass, u32)>) -> Vec<Request> {
    let mut events = Vec::new();
    for &(class, number) in shared {
        match class {
            DeviceClass::X if rng.percent(30) => {
                events.push(Request::SetBit(Class::X, number, rng.percent(50)));
            }
            DeviceClass::D if number < 8000 && rng.percent(3) => {
                events.push(Request::SetWord(Class::D, number, rng.value(16) as i16));
            }
            _ => {}
        }
    }
    events
}

/// Inputs that one of the programs does not look at.
fn of_one(module: &Module, rng: &mut Rng, shared: &BTreeSet<(DeviceClass, u32)>) -> Vec<Request> {
    let own = stored(module);
    let own = own
        .difference(shared)
        .filter(|device| device.0 == DeviceClass::X);
    own.map(|device| Request::SetBit(Class::X, device.1, rng.percent(50)))
        .collect()
}

#[test]
fn what_is_called_the_same_has_the_same_values() {
    let seeds: u64 = std::env::var("RUNGC_RANDOM_PROGRAMS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(60);
    let pools = MODELS.map(|model| (model, candidates(model)));
    let (mut same, mut partly, mut compared) = (0_u64, 0, 0_u64);
    for seed in 0..seeds {
        let (model, pool) = &pools[(seed % 3) as usize];
        let text = match seed % 5 {
            0 => stations::program(seed),
            _ => program(seed, *model, pool, 6 + (seed % 20) as u32),
        };
        let mut rng = Rng::new(seed ^ 0xD1FF);
        let other = changed(&text, &mut rng);
        let (Some(old), Some(new)) = (module(&text, *model), module(&other, *model)) else {
            continue;
        };
        let can_differ: Vec<DeviceRun> = match behaviour(&old, &new) {
            Behaviour::Same => {
                same += 1;
                Vec::new()
            }
            Behaviour::CanDiffer { devices, .. } => devices,
            Behaviour::Undecided(_) => continue,
        };
        let shared: BTreeSet<_> = stored(&old).intersection(&stored(&new)).copied().collect();
        let equal = shared.iter().filter(|(class, number)| {
            !can_differ.iter().any(|run| {
                run.class == *class && (run.first..run.first + run.count).contains(number)
            })
        });
        let requested: Vec<Request> = equal.copied().flat_map(requests).collect();
        partly += u64::from(!can_differ.is_empty() && !requested.is_empty());
        compared += requested.len() as u64;
        let modules = [old, new];
        let mut engines = modules
            .each_ref()
            .map(|module| Interpreter::new(std::slice::from_ref(module)));
        for engine in &mut engines {
            engine.execute_all(&[Request::Case(0)]).unwrap();
        }
        let mut now_ms = 0;
        for scan in 0..15 {
            let events = events(&mut rng, &shared);
            let timing = Request::Scan {
                now_ms,
                scan_us: 7000,
            };
            now_ms += 7;
            let mut answers = Vec::new();
            for (engine, module) in engines.iter_mut().zip(&modules) {
                let mut all = events.clone();
                all.extend(of_one(module, &mut rng.clone(), &shared));
                all.push(timing);
                all.extend(
                    [Request::Tick(now_ms), Request::Interrupts]
                        .into_iter()
                        .filter(|_| module.takes_events()),
                );
                engine.execute_all(&all).unwrap();
                answers.push(engine.execute_all(&requested).unwrap());
            }
            let differing = answers[0].iter().zip(&answers[1]).position(|(a, b)| a != b);
            if let Some(at) = differing {
                panic!(
                    "seed {seed}, scan {scan}: `{}` is {:?} and {:?}, but is called the same\n{text}\n--- changed\n{other}",
                    requested[at], answers[0][at], answers[1][at]
                );
            }
        }
    }
    println!(
        "{same} pairs behave the same, {partly} differ in part, {compared} devices were compared"
    );
    assert!(
        20 * same > seeds / 2 && 4 * partly > seeds,
        "{same} the same, {partly} in part"
    );
}
