//! Random programs, with random inputs, must do the same on all engines, optimised and not: every device is compared
//! after each scan.
//!
//! The environment variables `RUNGC_RANDOM_PROGRAMS`, `RUNGC_RANDOM_SCANS` and `RUNGC_RANDOM_SEED` make it longer, or
//! another one; `RUNGC_RANDOM_WAY` names one way to run the programs instead of the three engines: `rust`, `interp`, a
//! C compiler with its flags (`clang -O3`), or a simulated microcontroller with the language (`cortex-m4 c`).

use rungc_catalogue::Lower;
use rungc_golden::operands::{BUFFER_WORDS, candidates};
use rungc_golden::random::{self, program};
use rungc_golden::rng::Rng;
use rungc_golden::rows::{self, Occurring};
use rungc_golden::shapes::Shapes;
use rungc_golden::stations;
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Repeat, Stmt};
use rungc_ir::walk::statements;
use rungc_lower::compile::{Bound, CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::Class;
use rungc_sim::engines::cortex_m::{CORTEX_M3, CORTEX_M4, build_for};
use rungc_sim::engines::{BuildError, Engine, EngineKind, Interpreter, build, build_c_with};
use rungc_sim::protocol::{Answer, Request};
use rungc_syntax::{Classes, Device, DeviceClass, Index};
use std::path::Path;

/// Forms that take so few devices on their model, whose terminals are few, that random operands hardly ever fit; the
/// same form of other models is in programs.
const SELDOM: [&str; 2] = ["Fx1s REFP", "Fx3s MTR"];

/// Devices of a long array that are compared after each scan; the others are compared after the last.
const HEAD: u32 = 200;

fn setting(name: &str, default: u64) -> u64 {
    let text = std::env::var(format!("RUNGC_RANDOM_{name}"));
    text.ok().and_then(|t| t.parse().ok()).unwrap_or(default)
}

/// What devices hold after scans.
type Trace = Vec<(u64, Vec<Answer>)>;

/// A random program and what became of it.
struct Sample {
    seed: u64,
    text: String,
    optimised: Module,
    plain: Module,
}

/// What indexed operands can reach in some of the programs.
fn bounds(seed: u64) -> Vec<Bound> {
    let registers = if seed.is_multiple_of(5) { 0..60 } else { 0..0 };
    let bound = |number: u32| Bound {
        device: Device {
            class: DeviceClass::D,
            number,
        },
        index: Index {
            class: DeviceClass::Z,
            number: number % 2,
        },
        first: number.saturating_sub(3),
        last: number + 5,
    };
    registers.map(bound).collect()
}

fn compiled(text: &str, seed: u64, model: ModelId, optimise: bool) -> Result<Module, String> {
    let read = rungc_frontend::read_text(&format!("random{seed}.il"), text);
    let options = CompileOptions {
        model: Some(model),
        name: Some(format!("random{seed}")),
        bounds: bounds(seed),
        optimise,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let messages = || {
        let found = read.diagnostics.iter().chain(compiled.diagnostics.iter());
        found.map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    match compiled.module {
        Some(module) if !read.diagnostics.has_errors() => Ok(module),
        _ => Err(format!("{:?}\n{text}", messages())),
    }
}

/// Both modules of a program.
fn sample(text: String, seed: u64, model: ModelId) -> Result<Sample, String> {
    Ok(Sample {
        seed,
        optimised: compiled(&text, seed, model, true)?,
        plain: compiled(&text, seed, model, false)?,
        text,
    })
}

fn samples(seed: u64, count: u64) -> Vec<Sample> {
    let pools: Vec<_> = ModelId::ALL.map(|model| (model, candidates(model))).into();
    let mut rejected = Vec::new();
    let mut samples = Vec::new();
    for i in 0..count {
        // All of a program follows from its seed, so that one program can be run again alone.
        let seed = seed.wrapping_add(i);
        let (model, pool) = &pools[(seed % pools.len() as u64) as usize];
        let text = match seed % 9 {
            0 => stations::program(seed),
            _ => program(seed, *model, pool, 8 + (seed % 20) as u32),
        };
        match sample(text, seed, *model) {
            Ok(sample) => samples.push(sample),
            Err(why) => rejected.push(why),
        }
    }
    assert!(
        rejected.len() as u64 * 10 <= count + 10,
        "{} of {count} random programs do not compile, e.g. {}",
        rejected.len(),
        rejected[0]
    );
    samples
}

/// How many rungs stand in a program that shows rows of the catalogue.
const RUNGS: usize = 24;

/// Adds programs of these rungs; those that cannot stand in one program stand in several.
fn assemble(rungs: &[String], seed: u64, model: ModelId, samples: &mut Vec<Sample>) {
    let text = format!("{}\nEND\n", rungs.join("\n"));
    match sample(text, seed, model) {
        Ok(sample) => samples.push(sample),
        Err(why) if rungs.len() == 1 => panic!("{why}"),
        Err(_) => {
            let (some, others) = rungs.split_at(rungs.len() / 2);
            assemble(some, seed, model, samples);
            assemble(others, seed ^ 1 << 40, model, samples);
        }
    }
}

/// What became of hostile operands.
#[derive(Default)]
struct Hostile {
    rejected: u32,
    run: u32,
}

/// Programs in which each instruction of a model occurs in each form, with legal operands and with hostile ones.
fn row_samples(model: ModelId, seed: u64, samples: &mut Vec<Sample>) -> Hostile {
    let mut hostile = Hostile::default();
    let mut rungs = Vec::new();
    for rung in rows::rungs(model, seed, setting("HOSTILE", 1)) {
        rungs.push(rung.text);
        for text in rung.hostile {
            match compiled(&format!("{text}\nEND\n"), seed, model, false) {
                Ok(_) => {
                    hostile.run += 1;
                    rungs.push(text);
                }
                Err(_) => hostile.rejected += 1,
            }
        }
    }
    let pool = candidates(model);
    let structures = (seed..seed + 50).find_map(|seed| {
        let text = random::with_all_structures(seed, model, &pool);
        sample(text, seed, model).ok()
    });
    samples.extend(structures);
    for (part, rungs) in rungs.chunks(RUNGS).enumerate() {
        assemble(rungs, seed + part as u64, model, samples);
    }
    hostile
}

/// A device's value or values as requests.
fn requests(class: DeviceClass, number: u32) -> Vec<Request> {
    match class {
        DeviceClass::X => vec![Request::Bit(Class::X, number)],
        DeviceClass::Y => vec![Request::Bit(Class::Y, number), Request::Output(number)],
        DeviceClass::M => vec![Request::Bit(Class::M, number)],
        DeviceClass::S => vec![Request::Bit(Class::S, number)],
        DeviceClass::T => vec![
            Request::Bit(Class::T, number),
            Request::Word(Class::T, number),
        ],
        DeviceClass::C if number >= 200 => {
            vec![
                Request::Bit(Class::C, number),
                Request::Double(Class::C, number),
            ]
        }
        DeviceClass::C => vec![
            Request::Bit(Class::C, number),
            Request::Word(Class::C, number),
        ],
        DeviceClass::D => vec![Request::Word(Class::D, number)],
        DeviceClass::R => vec![Request::Word(Class::R, number)],
        DeviceClass::ER => vec![Request::Word(Class::ER, number)],
        DeviceClass::V => vec![Request::Word(Class::V, number)],
        DeviceClass::Z => vec![Request::Word(Class::Z, number)],
        DeviceClass::P | DeviceClass::I | DeviceClass::N => vec![],
    }
}

/// All stored devices, of each area at most this many, and what pulse outputs send.
fn stored(module: &Module, most: u32) -> Vec<Request> {
    let areas = module.layout.areas.iter();
    let devices = areas.flat_map(|area| {
        let numbers = area.first..area.first + area.count.min(most);
        numbers.flat_map(|number| requests(area.class, number))
    });
    let outputs = module.pulse_outputs.iter();
    let pulses = outputs.flat_map(|&n| [Request::Pulses(n), Request::Frequency(n)]);
    let buffer = buffer_words(module).map(|address| Request::Bfm(0, address));
    devices.chain(pulses).chain(buffer).collect()
}

/// The words of the buffer memory of module 0 that a program may name.
fn buffer_words(module: &Module) -> std::ops::Range<u16> {
    let has = module.model.notations.meets(Classes::BUFFER);
    0..if has { BUFFER_WORDS as u16 + 4 } else { 0 }
}

/// What happens to a program before a scan.
fn events(rng: &mut Rng, module: &Module, first: bool) -> Vec<Request> {
    let mut events = Vec::new();
    if first {
        let words = buffer_words(module);
        events.extend(words.map(|n| Request::SetBfm(0, n, rng.value(16) as i16)));
    }
    for area in &module.layout.areas {
        for number in area.first..area.first + area.count.min(64) {
            let special = number >= 8000;
            match area.class {
                DeviceClass::X if rng.percent(25) => {
                    events.push(Request::SetBit(Class::X, number, rng.percent(50)));
                }
                DeviceClass::D if !special && rng.percent(if first { 60 } else { 2 }) => {
                    events.push(Request::SetWord(Class::D, number, rng.value(16) as i16));
                }
                DeviceClass::M if !special && rng.percent(1) => {
                    events.push(Request::SetBit(Class::M, number, rng.percent(50)));
                }
                _ => {}
            }
        }
    }
    match rng.below(200) {
        0 => events.push(Request::Run(false)),
        1..=6 => events.push(Request::Run(true)),
        7 => events.push(Request::Power),
        _ => {}
    }
    events
}

/// How long programs run.
#[derive(Clone, Copy)]
struct Length {
    /// Scans after each of which all is compared.
    scans: u64,
    /// Scans that follow, whose results are compared now and then.
    more: u64,
}

/// Every tenth of the scans that follow something happens to a program, and every hundredth is compared.
const EVENTS: u64 = 10;
const COMPARED: u64 = 100;

/// Runs one program on an engine; the values of its devices, and after which scan they were these.
fn trace(
    engine: &mut dyn Engine,
    case: usize,
    sample: &Sample,
    length: Length,
) -> Result<Trace, String> {
    let module = &sample.optimised;
    let mut rng = Rng::new(sample.seed ^ 0x5CA9);
    let head = stored(module, HEAD);
    let all = stored(module, u32::MAX);
    let mut ask = |requests: &[Request]| engine.ask_all(requests).map_err(|e| e.to_string());
    ask(&[Request::Case(case)])?;
    let mut now_ms = 0;
    let mut values = Vec::new();
    let scans = length.scans + length.more;
    for scan in 0..scans {
        let is_looked_at = scan < length.scans;
        let scan_ms = 1 + rng.below(if is_looked_at { 40 } else { 10 });
        let mut requests = match is_looked_at || scan % EVENTS == 0 {
            true => events(&mut rng, module, scan == 0),
            false => Vec::new(),
        };
        if requests.contains(&Request::Power) {
            now_ms = 0;
        }
        requests.push(Request::Scan {
            now_ms,
            scan_us: scan_ms * 1000,
        });
        if module.takes_events() {
            for ms in 1..=scan_ms {
                requests.push(Request::Tick(now_ms + ms));
                if rng.percent(10) {
                    requests.push(Request::Edge(rng.below(8), rng.percent(50)));
                }
                if rng.percent(80) {
                    requests.push(Request::Interrupts);
                }
            }
        }
        now_ms += scan_ms;
        ask(&requests)?;
        if scan + 1 == scans {
            values.push((scan, ask(&all)?));
        } else if is_looked_at || scan % COMPARED == 0 {
            values.push((scan, ask(&head)?));
        }
    }
    Ok(values)
}

/// Where two runs differ first.
fn difference(
    sample: &Sample,
    (name, a): (&str, &Result<Trace, String>),
    (other, b): (&str, &Result<Trace, String>),
) -> Option<String> {
    let (a, b) = match (a, b) {
        (Ok(a), Ok(b)) => (a, b),
        (Err(error), _) => return Some(format!("{name}: {error}")),
        (_, Err(error)) => return Some(format!("{other}: {error}")),
    };
    let at = a.iter().zip(b).position(|(a, b)| a != b)?;
    let most = if at + 1 == a.len() { u32::MAX } else { HEAD };
    let asked = stored(&sample.optimised, most);
    let (scan, values) = &a[at];
    let values = values.iter().zip(&b[at].1).zip(&asked);
    let differing: Vec<_> = values
        .filter(|((a, b), _)| a != b)
        .take(6)
        .map(|((a, b), request)| format!("`{request}`: {a:?} in {name}, {b:?} in {other}"))
        .collect();
    Some(format!("scan {}: {}", scan + 1, differing.join("; ")))
}

#[test]
fn random_stations_become_loops_with_all_that_loops_may_have() {
    let (mut timers, mut counters, mut registers, mut edges) = (0, 0, 0, 0);
    for seed in 0..60 {
        let module = compiled(&stations::program(seed), seed, ModelId::Fx3u, true);
        let module = module.unwrap_or_else(|e| panic!("{e}"));
        statements(&module.functions[1].body, &mut |stmt| {
            let Stmt::Repeat(Repeat { body, .. }) = stmt else {
                return;
            };
            statements(body, &mut |stmt| match stmt {
                Stmt::TimerAt(_) => timers += 1,
                Stmt::Counter16At(_) => counters += 1,
                Stmt::Write(access, _) if access.kind == AccessKind::Word => registers += 1,
                Stmt::Edge(_) => edges += 1,
                _ => {}
            });
        });
    }
    assert!(
        timers.min(counters).min(registers).min(edges) > 5,
        "{timers} timers, {counters} counters, {registers} registers, {edges} edges"
    );
}

/// The engines, or the way that the environment names.
fn engines<'m>(
    modules: &'m [Module],
    target: &Path,
) -> Result<Vec<Box<dyn Engine + 'm>>, BuildError> {
    let Ok(way) = std::env::var("RUNGC_RANDOM_WAY") else {
        let all = EngineKind::ALL.into_iter();
        return all.map(|kind| build(kind, modules, target)).collect();
    };
    let target = target.join(way.replace(|c: char| !c.is_ascii_alphanumeric(), "-"));
    let (first, rest) = way.split_once(' ').unwrap_or((&way, ""));
    let kind = |name| EngineKind::from_name(name).unwrap_or_else(|| panic!("no engine {name}"));
    let engine = match first {
        "interp" | "rust" => build(kind(first), modules, &target),
        "cortex-m3" => build_for(&CORTEX_M3, kind(rest), modules, &target),
        "cortex-m4" => build_for(&CORTEX_M4, kind(rest), modules, &target),
        compiler => build_c_with(compiler, rest, modules, &target),
    };
    Ok(vec![engine?])
}

/// Programs for a run of the tests: random ones, and those that show the rows of all models, or of one model in turn if
/// the environment names a way, which is one batch of many.
fn programs() -> Vec<Sample> {
    let (seed, count) = (setting("SEED", 1), setting("PROGRAMS", 90));
    let mut samples = samples(seed, count);
    let batch = seed / count.max(1);
    let models = match std::env::var("RUNGC_RANDOM_WAY") {
        Ok(_) => vec![ModelId::ALL[batch as usize % ModelId::ALL.len()]],
        Err(_) => ModelId::ALL.to_vec(),
    };
    let mut hostile = Hostile::default();
    for model in models {
        let of_model = row_samples(model, seed, &mut samples);
        hostile.run += of_model.run;
        hostile.rejected += of_model.rejected;
    }
    let Hostile { run, rejected } = hostile;
    println!("hostile operands: {run} instructions compile, {rejected} do not");
    assert!(run.min(rejected) > 20, "{run} compile, {rejected} do not");
    samples
}

/// The instructions of a program that a scan comes to, but for those that it jumps over and with those in loops once.
fn scanned(text: &str) -> u64 {
    text.lines().take_while(|line| *line != "FEND").count() as u64
}

/// What the tests of a run are to have compared, unless the environment asks for something else.
fn check_extent(samples: &[Sample], executed: u64) {
    let (mut occurring, mut shapes) = (Occurring::default(), Shapes::default());
    for sample in samples {
        occurring.add(sample.optimised.model.id, &sample.text);
        shapes.add(&sample.text);
    }
    let (rows, operands) = occurring.counts();
    println!("{rows} forms of instructions of models, {operands} classes of operands");
    println!("{shapes}");
    if std::env::vars().any(|(name, _)| name.starts_with("RUNGC_RANDOM_")) {
        return;
    }
    let mut missing = Vec::new();
    for model in ModelId::ALL {
        for (spelling, lower) in occurring.missing(model) {
            let row = format!("{model:?} {spelling}");
            // What the compiler rejects cannot be compared.
            if !matches!(lower, Lower::Todo(_)) && !SELDOM.contains(&row.as_str()) {
                missing.push(row);
            }
        }
    }
    assert!(missing.is_empty(), "no program has {missing:?}");
    assert!(operands >= 3_800, "only {operands} classes of operands");
    assert!(shapes.least() > 0, "{shapes}");
    assert!(executed >= 10_000_000, "only {executed} executions");
}

#[test]
fn all_engines_agree_on_random_programs() {
    let length = Length {
        scans: setting("SCANS", 60),
        more: setting("MORE", 300),
    };
    let samples = programs();
    let optimised: Vec<Module> = samples.iter().map(|s| s.optimised.clone()).collect();
    let plain: Vec<Module> = samples.iter().map(|s| s.plain.clone()).collect();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("differential");
    let mut reference = Interpreter::new(&plain);
    let mut engines = engines(&optimised, &target).unwrap_or_else(|e| panic!("{e}"));
    let mut differences = Vec::new();
    for (case, sample) in samples.iter().enumerate() {
        let expected = trace(&mut reference, case, sample, length);
        for engine in &mut engines {
            let actual = trace(&mut **engine, case, sample, length);
            let found = difference(
                sample,
                ("the unoptimised interpreter", &expected),
                (engine.name(), &actual),
            );
            if let Some(found) = found {
                let model = sample.optimised.model.name;
                differences.push(format!("seed {} ({model}): {found}", sample.seed));
                differences.push(sample.text.clone());
                break;
            }
        }
    }
    let lines: u64 = samples.iter().map(|s| scanned(&s.text)).sum();
    let scans = length.scans + length.more;
    println!(
        "{} programs, of {lines} instructions in scans, ran {scans} scans on each of {} engines: {} instructions each",
        samples.len(),
        engines.len() + 1,
        lines * scans
    );
    assert!(
        differences.is_empty(),
        "{} programs differ:\n{}",
        differences.len() / 2,
        differences.join("\n")
    );
    check_extent(&samples, lines * scans);
}
