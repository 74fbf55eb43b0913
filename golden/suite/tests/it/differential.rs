//! Random programs, with random inputs, must do the same on all engines, optimised and not: every device is compared
//! after each scan.
//!
//! The environment variables `RUNGC_RANDOM_PROGRAMS`, `RUNGC_RANDOM_SCANS` and `RUNGC_RANDOM_SEED` change their extent;
//! `RUNGC_RANDOM_WAY` names one way to run them instead of the three engines: `rust`, `interp`, `parts` (C with the
//! runtime in C), a C compiler with its flags (`clang -O3`), or a simulated chip with the language (`cortex-m4 c`).
//!
//! Where the environment names the run ([`rungc_golden::part`]), there are fewer programs: a third of the random ones,
//! from a seed that follows from the name, and the rows of one model.

use rungc_catalogue::Lower;
use rungc_golden::operands::{BUFFER_WORDS, candidates};
use rungc_golden::part::Part;
use rungc_golden::random;
use rungc_golden::rng::Rng;
use rungc_golden::rows::{self, Occurring};
use rungc_golden::sequences;
use rungc_golden::shapes::Shapes;
use rungc_golden::stations;
use rungc_interp::{Machine, Observer};
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Action, Repeat, Stmt};
use rungc_ir::walk::statements;
use rungc_lower::compile::{Bound, CompileOptions, compile};
use rungc_models::ModelId;
use rungc_models::runs::rt_class;
use rungc_rt::Class;
use rungc_sim::engines::cortex_m::{CORTEX_M3, CORTEX_M4, build_for};
use rungc_sim::engines::{
    BuildError, Engine, EngineError, EngineKind, Interpreter, build, build_c_with,
    build_c_with_parts,
};
use rungc_sim::protocol::{Answer, Request};
use rungc_syntax::{Classes, Device, DeviceClass, Index};
use std::fmt;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Devices of a long array that are compared after each scan; the others are compared after the last.
const HEAD: u32 = 200;

fn setting(name: &str, default: u64) -> u64 {
    let text = std::env::var(format!("RUNGC_RANDOM_{name}"));
    text.ok().and_then(|t| t.parse().ok()).unwrap_or(default)
}

/// After which scans devices held what, as digests.
type Trace = Vec<(u64, Vec<Answer>)>;

/// A random program and what became of it.
struct Sample {
    seed: u64,
    text: String,
    optimised: Module,
    plain: Module,
}

/// Ranges of indexed operands in some of the programs.
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
    // What blocks of a step ladder do while they are off is compared with leaving them out.
    let mut plain = compiled(&text, seed, model, false)?;
    sequences::execute_all_blocks(&mut plain);
    Ok(Sample {
        seed,
        optimised: compiled(&text, seed, model, true)?,
        plain,
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
        match sample(random::any(seed, *model, pool), seed, *model) {
            Ok(sample) => samples.push(sample),
            Err(why) => rejected.push(why),
        }
    }
    // Of few programs more may be unlucky.
    assert!(
        rejected.len() as u64 * 10 <= count + 50,
        "{} of {count} random programs do not compile, e.g. {}",
        rejected.len(),
        rejected[0]
    );
    samples
}

/// Number of rungs in a program that shows rows of the catalogue.
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

/// Results for hostile operands.
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
    devices.chain(others(module)).collect()
}

/// The same with one number for all that the devices of an area hold.
fn digests(module: &Module, most: u32) -> Vec<Request> {
    let areas = module.layout.areas.iter();
    let devices = areas.filter_map(|area| {
        let class = rt_class(area.class)?;
        Some(Request::Digest(class, area.first, area.count.min(most)))
    });
    devices.chain(others(module)).collect()
}

/// Other compared values than devices.
fn others(module: &Module) -> impl Iterator<Item = Request> + '_ {
    let outputs = module.pulse_outputs.iter();
    let pulses = outputs.flat_map(|&n| [Request::Pulses(n), Request::Frequency(n)]);
    let buffer = buffer_words(module).map(|address| Request::Bfm(0, address));
    pulses.chain(buffer)
}

/// The words of the buffer memory of module 0 that a program may name.
fn buffer_words(module: &Module) -> std::ops::Range<u16> {
    let has = module.model.notations.meets(Classes::BUFFER);
    0..if has { BUFFER_WORDS as u16 + 4 } else { 0 }
}

/// Inputs to a program before a scan.
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
                DeviceClass::S if rng.percent(1) => {
                    events.push(Request::SetBit(Class::S, number, rng.percent(50)));
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
        1..=20 => events.push(Request::Run(true)),
        21 => events.push(Request::Power),
        _ => {}
    }
    events
}

/// Length of programs' runs.
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

impl Length {
    fn total(self) -> u64 {
        self.scans + self.more
    }

    fn is_compared(self, scan: u64) -> bool {
        scan < self.scans || scan.is_multiple_of(COMPARED) || scan + 1 == self.total()
    }

    /// Number of devices in an area that are compared after a scan.
    fn most(self, scan: u64) -> u32 {
        match scan + 1 == self.total() {
            true => u32::MAX,
            false => HEAD,
        }
    }
}

/// A program of a batch, and how long it runs.
#[derive(Clone, Copy)]
struct Case<'s> {
    number: usize,
    sample: &'s Sample,
    length: Length,
}

impl Case<'_> {
    /// Requests to an engine for a scan, with the events before and after it.
    fn scan(self, rng: &mut Rng, scan: u64, now_ms: &mut u32) -> Vec<Request> {
        let module = &self.sample.optimised;
        let is_looked_at = scan < self.length.scans;
        let scan_ms = 1 + rng.below(if is_looked_at { 40 } else { 10 });
        let mut requests = match is_looked_at || scan.is_multiple_of(EVENTS) {
            true => events(rng, module, scan == 0),
            false => Vec::new(),
        };
        if requests.contains(&Request::Power) {
            *now_ms = 0;
        }
        requests.push(Request::Scan {
            now_ms: *now_ms,
            scan_us: scan_ms * 1000,
        });
        if module.takes_events() {
            for ms in 1..=scan_ms {
                requests.push(Request::Tick(*now_ms + ms));
                if rng.percent(10) {
                    requests.push(Request::Edge(rng.below(8), rng.percent(50)));
                }
                if rng.percent(80) {
                    requests.push(Request::Interrupts);
                }
            }
        }
        *now_ms += scan_ms;
        requests
    }

    /// Runs the program on an engine up to and with this scan; `compare` is called after each that is compared.
    fn run<E: Engine + ?Sized>(
        self,
        engine: &mut E,
        last: u64,
        compare: &mut dyn FnMut(&mut E, u64) -> Result<(), EngineError>,
    ) -> Result<(), EngineError> {
        let mut rng = Rng::new(self.sample.seed ^ 0x5CA9);
        engine.execute(Request::Case(self.number))?;
        let mut now_ms = 0;
        for scan in 0..=last {
            engine.execute_all(&self.scan(&mut rng, scan, &mut now_ms))?;
            if self.length.is_compared(scan) {
                compare(engine, scan)?;
            }
        }
        Ok(())
    }

    /// Runs the program on an engine: digests of what its devices hold, and after which scan that was.
    fn trace<E: Engine + ?Sized>(self, engine: &mut E) -> Result<Trace, EngineError> {
        let module = &self.sample.optimised;
        let [head, all] = [HEAD, u32::MAX].map(|most| digests(module, most));
        let mut trace = Vec::new();
        self.run(engine, self.length.total() - 1, &mut |engine, scan| {
            let requested = if self.length.most(scan) == HEAD {
                &head
            } else {
                &all
            };
            trace.push((scan, engine.execute_all(requested)?));
            Ok(())
        })?;
        Ok(trace)
    }

    /// Runs the program once more, up to this scan, and asks for each device.
    fn devices<E: Engine + ?Sized>(
        self,
        engine: &mut E,
        scan: u64,
    ) -> Result<Vec<Answer>, EngineError> {
        self.run(engine, scan, &mut |_, _| Ok(()))?;
        engine.execute_all(&stored(&self.sample.optimised, self.length.most(scan)))
    }

    /// First difference between the runs of the reference and an engine: the scan and the devices.
    fn difference(
        self,
        (reference, expected): (&mut Interpreter, &Result<Trace, EngineError>),
        engine: &mut dyn Engine,
    ) -> Option<String> {
        let name = engine.name().to_string();
        let actual = self.trace(engine);
        let (expected, actual) = match (expected, &actual) {
            (Ok(expected), Ok(actual)) => (expected, actual),
            (Err(error), _) => return Some(format!("the unoptimised interpreter: {error}")),
            (_, Err(error)) => return Some(format!("{name}: {error}")),
        };
        let at = expected.iter().zip(actual).position(|(a, b)| a != b)?;
        let scan = expected[at].0;
        let values = self
            .devices(reference, scan)
            .and_then(|expected| Ok((expected, self.devices(engine, scan)?)));
        let differing: Vec<String> = match values {
            Err(error) => vec![error.to_string()],
            Ok((expected, actual)) => stored(&self.sample.optimised, self.length.most(scan))
                .iter()
                .zip(expected.iter().zip(&actual))
                .filter(|(_, (a, b))| a != b)
                .take(6)
                .map(|(request, (a, b))| {
                    format!("`{request}`: {a:?} in the unoptimised interpreter, {b:?} in {name}")
                })
                .collect(),
        };
        Some(match differing.is_empty() {
            true => format!(
                "scan {}: digests of devices that a second run does not show",
                scan + 1
            ),
            false => format!("scan {}: {}", scan + 1, differing.join("; ")),
        })
    }
}

/// Counts the instructions that the interpreter executes: those of each network that a scan or an interrupt comes to,
/// whether they are driven or not.
struct Meter {
    /// Number of instructions in each network.
    lengths: Vec<u64>,
    executed: Arc<AtomicU64>,
}

impl Meter {
    fn new(sample: &Sample, executed: &Arc<AtomicU64>) -> Self {
        let networks = sample.plain.networks.iter();
        let starts: Vec<usize> = networks
            .map(|network| network.span.start as usize)
            .collect();
        let length = |&start: &usize| {
            let next = starts.iter().copied().filter(|&next| next > start).min();
            let lines = sample.text[start..next.unwrap_or(sample.text.len())].lines();
            lines.filter(|line| !line.is_empty()).count() as u64
        };
        Meter {
            lengths: starts.iter().map(length).collect(),
            executed: Arc::clone(executed),
        }
    }
}

impl Observer for Meter {
    fn before(&mut self, _: &Machine, stmt: &Stmt) {
        if let Stmt::Network(number) = stmt {
            let length = self.lengths.get(*number as usize);
            self.executed
                .fetch_add(length.copied().unwrap_or(0), Ordering::Relaxed);
        }
    }
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
                Stmt::Do(Action::TimerAt(_)) => timers += 1,
                Stmt::Do(Action::Counter16At(_)) => counters += 1,
                Stmt::Do(Action::Write(access, _)) if access.kind == AccessKind::Word => {
                    registers += 1
                }
                Stmt::Do(Action::Edge(_)) => edges += 1,
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
        // Emitted C calls the runtime in C as far as it is there: the conformance cases know the library.
        let build = |kind| match kind {
            EngineKind::C => build_c_with_parts(modules, target),
            EngineKind::Interp | EngineKind::Rust => build(kind, modules, target),
        };
        return all.map(build).collect();
    };
    let target = target.join(way.replace(|c: char| !c.is_ascii_alphanumeric(), "-"));
    let (first, rest) = way.split_once(' ').unwrap_or((&way, ""));
    let kind = |name| EngineKind::from_name(name).unwrap_or_else(|| panic!("no engine {name}"));
    let engine = match first {
        "interp" | "rust" => build(kind(first), modules, &target),
        "parts" => build_c_with_parts(modules, &target),
        "cortex-m3" => build_for(&CORTEX_M3, kind(rest), modules, &target),
        "cortex-m4" => build_for(&CORTEX_M4, kind(rest), modules, &target),
        compiler => build_c_with(compiler, rest, modules, &target),
    };
    Ok(vec![engine?])
}

/// Divisor of the number of random programs, for a run that takes a part.
const SHARE: u64 = 3;

/// Programs for a run of the tests: random ones, and those that show the rows of all models, or of one model in turn if
/// the environment names a way, which is one batch of many, or the run.
fn programs() -> Vec<Sample> {
    let part = Part::one_in(SHARE);
    let count = if part.is_all() { 90 } else { 90 / SHARE };
    let (seed, count) = (setting("SEED", part.seed()), setting("PROGRAMS", count));
    println!("{count} random programs from seed {seed}: {part}");
    let mut samples = samples(seed, count);
    let batch = seed / count.max(1);
    let is_one_model = std::env::var("RUNGC_RANDOM_WAY").is_ok() || !part.is_all();
    let models = match is_one_model {
        true => vec![ModelId::ALL[batch as usize % ModelId::ALL.len()]],
        false => ModelId::ALL.to_vec(),
    };
    let mut hostile = Hostile::default();
    for model in models {
        let of_model = row_samples(model, seed, &mut samples);
        hostile.run += of_model.run;
        hostile.rejected += of_model.rejected;
    }
    let Hostile { run, rejected } = hostile;
    println!("hostile operands: {run} instructions compile, {rejected} do not");
    assert!(
        is_one_model || run.min(rejected) > 20,
        "{run} compile, {rejected} do not"
    );
    samples
}

/// Checks the extent of a run's comparisons, unless the environment asks for something else.
fn check_extent(samples: &[Sample], extent: &Extent) {
    let (mut occurring, mut shapes) = (Occurring::default(), Shapes::default());
    for sample in samples {
        occurring.add(sample.optimised.model.id, &sample.text);
        shapes.add(&sample.text);
    }
    let (rows, operands) = occurring.counts();
    println!("{rows} forms of instructions of models, {operands} classes of operands");
    println!("{shapes}");
    let is_set = std::env::vars().any(|(name, _)| name.starts_with("RUNGC_RANDOM_"));
    if is_set || !Part::one_in(SHARE).is_all() {
        return;
    }
    let mut missing = Vec::new();
    for model in ModelId::ALL {
        for (spelling, lower) in occurring.missing(model) {
            // Rejected programs cannot be compared.
            if !matches!(lower, Lower::Todo(_)) {
                missing.push(format!("{model:?} {spelling}"));
            }
        }
    }
    missing.extend(occurring.missing_operands());
    assert!(missing.is_empty(), "no program has {missing:?}");
    assert!(shapes.least() > 0, "{shapes}");
    assert!(extent.instructions >= 10_000_000, "only {extent}");
}

/// A digest says what differs in any device, and says the same on all engines that need no long build.
#[test]
fn digests_show_every_device() {
    let text = "LD X000\nOUT T0 K5\nOUT C0 K5\nOUT C200 K5\nOUT Y001\nSET S3\nMOV D7 R9\nOUT M8\nMOV V0 Z1\nEND\n";
    let module = [compiled(text, 0, ModelId::Fx3u, false).unwrap()];
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("digests");
    let mut engines = [EngineKind::Interp, EngineKind::C]
        .map(|kind| build(kind, &module, &target).unwrap_or_else(|e| panic!("{e}")));
    let requested = digests(&module[0], u32::MAX);
    let mut before = Vec::new();
    let changes = [
        Request::Case(0),
        Request::SetBit(Class::X, 0, true),
        Request::SetBit(Class::Y, 1, true),
        Request::SetBit(Class::M, 8, true),
        Request::SetBit(Class::S, 3, true),
        Request::SetWord(Class::T, 0, 4),
        Request::SetBit(Class::T, 0, true),
        Request::SetWord(Class::C, 0, -4),
        Request::SetDouble(Class::C, 200, 1 << 20),
        Request::SetWord(Class::D, 7, -1),
        Request::SetWord(Class::R, 9, 1),
        Request::SetWord(Class::V, 0, 1),
        Request::SetWord(Class::Z, 1, 1),
    ];
    for change in changes {
        let [first, second] = engines.each_mut().map(|engine| {
            engine.execute(change).unwrap();
            engine.execute_all(&requested).unwrap()
        });
        assert_eq!(first, second, "{change}");
        assert_ne!(first, before, "{change}");
        before = first;
    }
}

/// Extent of comparisons.
#[derive(Default)]
struct Extent {
    programs: usize,
    scans: u64,
    instructions: u64,
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Extent {
            programs,
            scans,
            instructions,
        } = self;
        write!(
            f,
            "{programs} programs, {scans} scans, {instructions} instructions"
        )
    }
}

#[test]
fn all_engines_agree_on_random_programs() {
    let length = Length {
        scans: setting("SCANS", 60).max(1),
        more: setting("MORE", 300),
    };
    let samples = programs();
    let optimised: Vec<Module> = samples.iter().map(|s| s.optimised.clone()).collect();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("differential");
    let executed = Arc::new(AtomicU64::new(0));
    let meters = |case: usize| Box::new(Meter::new(&samples[case], &executed)) as Box<dyn Observer>;
    let plain = samples.iter().map(|sample| &sample.plain);
    let mut reference = Interpreter::observed(plain, Box::new(meters));
    let mut engines = engines(&optimised, &target).unwrap_or_else(|e| panic!("{e}"));
    let mut differences = Vec::new();
    let mut extent = Extent::default();
    for (number, sample) in samples.iter().enumerate() {
        let case = Case {
            number,
            sample,
            length,
        };
        executed.store(0, Ordering::Relaxed);
        let expected = case.trace(&mut reference);
        extent.programs += 1;
        extent.scans += length.total();
        extent.instructions += executed.load(Ordering::Relaxed);
        for engine in &mut engines {
            if let Some(found) = case.difference((&mut reference, &expected), &mut **engine) {
                let model = sample.optimised.model.name;
                differences.push(format!("seed {} ({model}): {found}", sample.seed));
                differences.push(sample.text.clone());
                break;
            }
        }
    }
    println!("compared with {} engines: {extent}", engines.len());
    assert!(
        differences.is_empty(),
        "{} programs differ:\n{}",
        differences.len() / 2,
        differences.join("\n")
    );
    check_extent(&samples, &extent);
}
