//! `cargo xtask campaign --proofs`: random questions to the prover, and attacks on its answers.
//!
//! Whatever is proved is attacked on the interpreter, within what the verdict assumes; runs that violate a property are
//! replayed, also as tests; files for other model checkers are evaluated along runs. The same number of a program gives
//! the same programs, questions and attacks on every computer; only which questions are answered in time depends on it.

mod attack;
mod draw;
mod files;
mod minimise;
mod near;
mod planted;
mod run;
mod shown;
mod table;
#[cfg(test)]
mod tests;

use crate::{Problem, root};
use attack::search;
use draw::{Asked, FORMS, Pools, Question, question};
use minimise::Refutation;
use near::levels;
use run::{Goal, replay, run_of};
use rungc_golden::operands::BUFFER_WORDS;
use rungc_golden::rng::Rng;
use rungc_ir::Module;
use rungc_sim::property::{Condition, Property};
use rungc_syntax::DeviceClass::{D, X};
use rungc_verify::model::{Encoder, Key, TimerPart, device_of};
use rungc_verify::prove::{self, Options, Verdict, Why, decide};
use rungc_verify::same::compare;
use rungc_verify::search::Trace;
use rungc_verify::steered::{Levels, Outside, Run};
use rungc_verify::system::System;
use rungc_verify::vacuous::dead_end;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use table::{Counts, Results};

/// Extent of a campaign.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Number of the first program.
    pub seed: u64,
    /// Programs.
    pub programs: u64,
    /// Programs at a time.
    pub jobs: usize,
    /// No program is begun later than this.
    pub time: Option<Duration>,
    /// Ask another model checker where it is installed.
    pub others: bool,
}

/// Effort for a question.
const QUESTION: u64 = 800;

/// Of this many programs, one is compared with a program that was changed.
const COMPARED: u64 = 3;

/// Effort for each output that is compared.
const OUTPUT: u64 = 200;

/// Programs after which the time is shown.
const SHOWN: usize = 20;

/// Properties of a program.
const PROPERTIES: u32 = 3;

/// Scans of an attack on a proof.
const ATTACK: u64 = 2000;

/// Scans that sort out most properties that hold hardly ever.
const GLANCE: u64 = 120;

/// Largest logic of a question, in nodes.
const NODES: usize = 60_000;

/// Runs a campaign and prints its results.
///
/// # Errors
///
/// An answer is wrong, or fewer than 80 % of the planted violations were found.
pub fn run(extent: Extent) -> Result<(), Problem> {
    let folder = root().join("target/campaign");
    std::fs::create_dir_all(&folder)?;
    let results = all(extent);
    for (n, wrong) in results.wrong.iter().enumerate() {
        let path = folder.join(format!("proof-{}-{n}.txt", extent.seed));
        std::fs::write(&path, wrong)?;
        println!("wrong: {}", path.display());
    }
    println!("{}", results.text());
    judge(&results)
}

fn judge(results: &Results) -> Result<(), Problem> {
    let (planted, found) = results.calibration();
    match (results.wrong.len(), found * 10 >= planted * 8) {
        (0, true) => Ok(()),
        (0, false) => {
            Err(format!("only {found} of {planted} planted violations were found").into())
        }
        (wrong, _) => Err(format!("{wrong} answers are wrong").into()),
    }
}

/// Results for all programs, in their order.
fn all(extent: Extent) -> Results {
    let pools = Pools::new();
    let begin = Instant::now();
    let next = AtomicU64::new(0);
    let parts = Mutex::new(Vec::new());
    let work = || {
        loop {
            let n = next.fetch_add(1, Ordering::Relaxed);
            let is_late = extent.time.is_some_and(|time| begin.elapsed() >= time);
            if n >= extent.programs || is_late {
                return;
            }
            let seed = extent.seed + n;
            let results = catch_unwind(AssertUnwindSafe(|| examine(&pools, seed, extent)));
            let results = results.unwrap_or_else(|_| Results {
                wrong: vec![format!("program {seed}: the prover panicked")],
                ..Results::default()
            });
            let mut parts = parts.lock().unwrap_or_else(PoisonError::into_inner);
            parts.push((n, results));
            if parts.len().is_multiple_of(SHOWN) {
                eprintln!(
                    "{} programs in {} s",
                    parts.len(),
                    begin.elapsed().as_secs()
                );
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..extent.jobs.max(1) {
            scope.spawn(work);
        }
    });
    let mut parts = parts.into_inner().unwrap_or_else(PoisonError::into_inner);
    parts.sort_by_key(|(n, _)| *n);
    let mut all = Results::default();
    parts.iter().for_each(|(_, results)| all.add(results));
    all
}

/// Examines the program of a number.
fn examine(pools: &Pools, seed: u64, extent: Extent) -> Results {
    let mut results = Results::default();
    let Some(question) = question(pools, seed, QUESTION) else {
        results.rejected += 1;
        return results;
    };
    // Each question would make that logic again.
    if is_too_large(&question) {
        results.rejected += 1;
        return results;
    }
    results.programs += 1;
    let mut examination = Examination {
        question,
        seed,
        others: extent.others && seed.is_multiple_of(8) && files::has_abc(),
        results,
    };
    for _ in 0..PROPERTIES {
        examination.property();
    }
    if seed.is_multiple_of(COMPARED) {
        examination.same();
    }
    examination.planted();
    examination.results
}

/// Returns true if the logic of a program, without a property, is too large.
fn is_too_large(question: &Question) -> bool {
    let Some(module) = question.written.module(&question.options, &[]) else {
        return false;
    };
    let encoder = Encoder::scan(&module, question.options.world.clone());
    encoder.aig.nodes().len() > NODES
}

/// A program under examination.
struct Examination {
    question: Question,
    seed: u64,
    others: bool,
    results: Results,
}

/// A module with what may happen to it.
fn outside(
    modules: &[&Module],
    encoders: &[&Encoder],
    options: &Options,
    values: &[i64],
) -> Outside {
    let mut written = BTreeSet::new();
    let mut latched = BTreeSet::new();
    for (module, encoder) in modules.iter().zip(encoders) {
        let areas = module.layout.areas.iter().filter(|area| area.class == X);
        let inputs = areas.flat_map(|area| area.first..area.first + area.count.min(64));
        written.extend(inputs.map(|number| Key::Bit(X, number)));
        written.extend(encoder.opened());
        let keys = encoder.memory().map(|(key, ..)| key);
        // A replay cannot set parts of a timer's unit: they begin at 0.
        let is_part = |key: &Key| matches!(key, Key::Timer(_, TimerPart::Part));
        let any = |key: &Key| {
            device_of(*key).is_some() && encoder.initial(*key).is_none() && !is_part(key)
        };
        latched.extend(keys.filter(any));
    }
    let registers = modules
        .iter()
        .filter_map(|module| module.model.constant_scan());
    let mut registers = registers.map(|asks| Key::Word(D, asks.register.number()));
    Outside {
        scan_register: registers.find(|register| written.contains(register)),
        written: written.into_iter().collect(),
        latched: latched.into_iter().collect(),
        values: values.to_vec(),
        near: Levels::new(),
        scan_ms: options.world.scan_ms,
        power: !options.world.fresh,
        stop: true,
        buffer: 0,
        events: modules.iter().any(|module| module.takes_events()),
    }
}

impl Examination {
    fn seed_of(&mut self) -> u64 {
        self.question.rng.bits()
    }

    /// Draws a property that a glance does not refute, most often, and examines the answer to it.
    fn property(&mut self) {
        for attempt in 0..8 {
            let Some(asked) = self.question.property() else {
                continue;
            };
            let options = &self.question.options;
            let Some(module) = self.question.written.module(options, &[&asked.property]) else {
                continue;
            };
            let (encoder, system) = prove::system(&module, &asked.property, options);
            if system.aig.nodes().len() > NODES {
                self.results.counts[asked.form].large += 1;
                return;
            }
            let mut outside = outside(&[&module], &[&encoder], options, &self.question.values);
            outside.buffer = buffer_words(&self.question);
            let devices = asked
                .property
                .conditions()
                .into_iter()
                .flat_map(Condition::devices);
            outside.near = levels(&self.question.written.text, devices);
            drop(encoder);
            let seed = self.seed_of();
            let goal = Goal::Event(&asked.property);
            let assumed = &self.question.options.assumed;
            let glance = search(&[&module], goal, assumed, &outside, (seed, GLANCE));
            if glance.run.is_some() && attempt < 7 && self.question.rng.percent(85) {
                continue;
            }
            self.decided(&asked, &module, &system, &outside);
            return;
        }
    }

    /// Examines the answer to a question.
    fn decided(&mut self, asked: &Asked, module: &Module, system: &System, outside: &Outside) {
        let options = self.question.options.clone();
        let decision = decide(module, &asked.property, &options);
        let mut counts = Counts {
            asked: 1,
            ..Counts::default()
        };
        let goal = Goal::Event(&asked.property);
        let seed = self.seed_of();
        let attack =
            |goal, scans| search(&[module], goal, &options.assumed, outside, (seed, scans));
        match &decision.verdict {
            Verdict::Proved if dead_end(module, &options).is_some() => counts.vacuous += 1,
            Verdict::Proved => {
                counts.proved += 1;
                let found = attack(goal, ATTACK);
                counts.scans += found.scans;
                if let Some(run) = found.run {
                    counts.refuted += 1;
                    self.refuted(asked, run);
                }
            }
            Verdict::Found(trace) => {
                counts.violated += 1;
                let written = &self.question.written;
                let as_test = shown::contradiction(written, module, asked, trace);
                match confirmed(module, goal, &options, outside, trace)
                    .err()
                    .or(as_test)
                {
                    None => counts.replayed += 1,
                    Some(why) => self.wrong(&asked.text, &why),
                }
            }
            Verdict::Undecided(Why::Contradiction { scans }) => {
                counts.contradictory += 1;
                let found = attack(Goal::Lives(*scans), ATTACK);
                counts.scans += found.scans;
                if let Some(run) = found.run {
                    counts.refuted += 1;
                    let why =
                        format!("no run of {scans} scans keeps the assumptions; this does:\n{run}");
                    self.wrong(&asked.text, &why);
                }
            }
            Verdict::Undecided(Why::Effort { .. } | Why::Time { .. }) => counts.late += 1,
            Verdict::Undecided(Why::Vacuous { .. }) => counts.vacuous += 1,
            Verdict::Undecided(Why::Spurious { .. } | Why::Engines { .. }) => {
                counts.unmodelled += 1
            }
        }
        self.results.counts[asked.form].add(&counts);
        self.files(asked, module, (system, outside), &decision.verdict);
    }

    /// Evaluates the files of a question, and asks others.
    fn files(
        &mut self,
        asked: &Asked,
        module: &Module,
        (system, outside): (&System, &Outside),
        verdict: &Verdict,
    ) {
        let assumed = self.question.options.assumed.clone();
        if files::is_exact(system) && !outside.events {
            let calm = Outside {
                power: false,
                stop: false,
                ..outside.clone()
            };
            let seed = self.seed_of();
            let goal = Goal::Event(&asked.property);
            let lives = search(&[module], Goal::Lives(60), &assumed, &calm, (seed, 300));
            let mut runs: Vec<Run> = lives.run.into_iter().collect();
            if let Verdict::Found(trace) = verdict {
                runs.push(run_of(&[module], trace));
            }
            self.results.files.0 += 1;
            for run in runs {
                match files::evaluate(system, module, goal, &assumed, &run) {
                    Ok(scans) => self.results.files.1 += scans,
                    Err(why) => self.wrong(&asked.text, &format!("{why}\n{run}")),
                }
            }
        }
        let expected = match verdict {
            Verdict::Proved => false,
            Verdict::Found(_) => true,
            Verdict::Undecided(_) => return,
        };
        if self.others {
            match files::asked_abc(system, 4) {
                Some(answer) if answer == expected => self.results.others.0 += 1,
                // What is not modelled may have led others to a run that does not happen.
                Some(true) if !files::is_exact(system) => self.results.others.0 += 1,
                Some(answer) => {
                    let why = format!("another model checker says that it can happen: {answer}");
                    self.wrong(&asked.text, &why);
                }
                None => self.results.others.1 += 1,
            }
        }
    }

    /// Notes a refuted proof, as small as it becomes.
    fn refuted(&mut self, asked: &Asked, run: Run) {
        let refutation = Refutation {
            written: self.question.written.clone(),
            property: &asked.property,
            options: &self.question.options,
            run,
        };
        let Refutation { written, run, .. } = refutation.minimised();
        let text = format!("proved, but this run violates it:\n{run}");
        let whole = std::mem::replace(&mut self.question.written, written);
        self.wrong(&asked.text, &text);
        self.question.written = whole;
    }

    fn wrong(&mut self, asked: &str, why: &str) {
        let Question {
            written,
            options,
            assumed,
            ..
        } = &self.question;
        let free: Vec<String> = options
            .world
            .free
            .iter()
            .map(|(class, number)| class.number(*number).to_string())
            .collect();
        self.results.wrong.push(format!(
            "program {} for {:?}, latched {:?}, scans of at most {} ms, cleared: {}, free {free:?}, assumed {assumed:?}\n\
             {asked}\n{why}\n\n{}",
            self.seed, written.model, written.latched, options.world.scan_ms, options.world.fresh, written.text
        ));
    }

    /// Compares the program with one that was changed, and attacks what is the same.
    fn same(&mut self) {
        let old = self.question.written.clone();
        let Some(new) = (0..8).find_map(|_| minimise::changed(&old, &mut self.question.rng)) else {
            return;
        };
        let options = Options {
            effort: OUTPUT,
            ..self.question.options.clone()
        };
        let modules = [&old, &new].map(|written| written.module(&options, &[]));
        let [Some(old_module), Some(new_module)] = &modules else {
            return;
        };
        let encoders =
            [old_module, new_module].map(|module| Encoder::scan(module, options.world.clone()));
        let same = FORMS.len() - 1;
        let [of_old, of_new] = &encoders;
        if of_old.aig.nodes().len().max(of_new.aig.nodes().len()) > NODES / 2 {
            self.results.counts[same].large += 1;
            return;
        }
        let pair = [old_module, new_module];
        let outside = outside(&pair, &[of_old, of_new], &options, &self.question.values);
        let compared = compare(old_module, new_module, &options);
        let is_vacuous = pair
            .iter()
            .any(|module| dead_end(module, &options).is_some());
        let mut counts = Counts::default();
        let mut proved = Vec::new();
        for output in &compared.outputs {
            counts.asked += 1;
            match &output.verdict {
                Verdict::Proved if is_vacuous => counts.vacuous += 1,
                Verdict::Proved => proved.push(output.number),
                Verdict::Found(trace) => {
                    counts.violated += 1;
                    let numbers = [output.number];
                    let happens = replay(
                        &pair,
                        Goal::Differs(&numbers),
                        &options.assumed,
                        &run_of(&pair, trace),
                    );
                    match happens {
                        Some(_) => counts.replayed += 1,
                        None => {
                            let text = format!(
                                "the run does not happen, in the new program:\n{}",
                                new.text
                            );
                            self.wrong(&format!("same, Y number {}", output.number), &text);
                        }
                    }
                }
                Verdict::Undecided(Why::Effort { .. } | Why::Time { .. }) => counts.late += 1,
                Verdict::Undecided(Why::Contradiction { .. }) => counts.contradictory += 1,
                Verdict::Undecided(Why::Vacuous { .. }) => counts.vacuous += 1,
                Verdict::Undecided(Why::Spurious { .. } | Why::Engines { .. }) => {
                    counts.unmodelled += 1
                }
            }
        }
        counts.proved = proved.len() as u64;
        if !proved.is_empty() {
            let seed = self.seed_of();
            let goal = Goal::Differs(&proved);
            let found = search(&pair, goal, &options.assumed, &outside, (seed, ATTACK));
            counts.scans += found.scans;
            if let Some(run) = found.run {
                counts.refuted += 1;
                let run = minimise::shorter(&pair, goal, &options.assumed, run);
                let text = format!(
                    "the same {proved:?}, but this run shows a difference:\n{run}\nnew:\n{}",
                    new.text
                );
                self.wrong("same", &text);
            }
        }
        self.results.counts[same].add(&counts);
    }

    /// Plants a violation, and attacks it as if its absence were proved.
    fn planted(&mut self) {
        let mut rng = Rng::new(self.seed ^ 0x91A7);
        let Some(planted) = planted::plant(&self.question.written, &mut rng) else {
            return;
        };
        let options = Options {
            effort: QUESTION,
            ..Options::default()
        };
        let Some(module) = planted.written.module(&options, &[&planted.property]) else {
            return;
        };
        if !planted.is_reachable(&module) {
            return;
        }
        let encoder = Encoder::scan(&module, options.world.clone());
        let mut outside = outside(&[&module], &[&encoder], &options, &self.question.values);
        let devices = planted
            .property
            .conditions()
            .into_iter()
            .flat_map(Condition::devices);
        outside.near = levels(&planted.written.text, devices);
        let goal = Goal::Event(&planted.property);
        let found = search(&[&module], goal, &[], &outside, (rng.bits(), ATTACK));
        let counts = &mut self.results.planted[planted.kind];
        counts.0 += 1;
        counts.1 += u64::from(found.run.is_some());
    }
}

/// Number of words of the buffer memory of special modules that a program reads.
fn buffer_words(question: &Question) -> u32 {
    let mut words = question.written.text.split_whitespace();
    let is_read = words.any(|word| {
        word.contains("\\G") || matches!(word.trim_start_matches('D'), "FROM" | "FROMP")
    });
    if is_read { BUFFER_WORDS } else { 0 }
}

/// Confirms that a run is one that may happen, and that the event happens in its last scan.
fn confirmed(
    module: &Module,
    goal: Goal,
    options: &Options,
    outside: &Outside,
    trace: &Trace,
) -> Result<(), String> {
    let run = run_of(&[module], trace);
    let scans = run.steps.len();
    let strange = run.start.iter().find(|(key, value)| {
        *value != 0 && device_of(*key).is_some() && !outside.latched.contains(key)
    });
    if let Some((key, _)) = strange {
        return Err(format!("{key:?} has a value at power-on\n{run}"));
    }
    let mut set = trace.scans.iter().flat_map(|scan| &scan.set);
    // Partners at serial ports write, too.
    let is_outside = |key: &Key| {
        matches!(key, Key::Buffer(..) | Key::Bit(X, _))
            || outside.written.contains(key)
            || module.has_ports()
    };
    if let Some((key, _)) = set.find(|(key, _)| !is_outside(key)) {
        return Err(format!(
            "{key:?} is set, which only the program writes\n{run}"
        ));
    }
    let mut scans_after_first = trace.scans.iter().skip(1);
    let late = scans_after_first.find(|scan| scan.ms == 0 || scan.ms > options.world.scan_ms);
    if let Some(scan) = late {
        return Err(format!(
            "a scan begins {} ms after the one before\n{run}",
            scan.ms
        ));
    }
    match replay(&[module], goal, &options.assumed, &run) {
        Some(after) if after == scans => Ok(()),
        Some(after) => Err(format!("it happens after scan {after}\n{run}")),
        None => Err(format!("it does not happen\n{run}")),
    }
}

/// Returns true if an answer is still that a property is proved, with all that the command does.
fn is_proved(module: &Module, property: &Property, options: &Options) -> bool {
    let verdict = decide(module, property, options).verdict;
    verdict == Verdict::Proved && dead_end(module, options).is_none()
}

/// Returns true if a run is one that a verdict speaks of and shows the event.
fn violates(module: &Module, property: &Property, assumed: &[Condition], run: &Run) -> bool {
    replay(&[module], Goal::Event(property), assumed, run).is_some()
}
