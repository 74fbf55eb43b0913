//! From a program and a property to a verdict.

use crate::chance::long_runs;
use crate::model::{Encoder, Gap, Input, Key, World};
use crate::pdr;
use crate::property::{Condition, Property};
use crate::replay;
use crate::search::{Bounded, Induction, Step, Trace};
use crate::system::System;
use rungc_ir::Module;
use rungc_syntax::order;
use std::time::{Duration, Instant};

/// How to decide.
#[derive(Clone, Debug)]
pub struct Options {
    /// What is supposed of the world around the program.
    pub world: World,
    /// What holds after every scan.
    pub assumed: Vec<Condition>,
    /// How long to try, for each property.
    pub time: Duration,
}

/// What was found of a property.
#[derive(Clone, PartialEq, Debug)]
pub enum Verdict {
    /// No run of the model does what must not happen.
    Proved,
    /// This run does it, on the interpreter too.
    Found(Trace),
    /// Neither is known.
    Undecided(Why),
}

/// Why a property is not decided.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Why {
    /// The time was up after this many scans without what is searched for.
    Time {
        /// How many.
        scans: usize,
    },
    /// The model allows a run of this many scans, but the program does otherwise: something in it is not modelled.
    Spurious {
        /// How many.
        scans: usize,
    },
    /// No run of this many scans keeps the assumptions.
    Contradiction {
        /// How many.
        scans: usize,
    },
    /// A run happens on the interpreter, but not on another engine.
    Engines {
        /// Which engine, and how it differs.
        difference: String,
    },
}

/// A verdict, and what it is about.
#[derive(Clone, PartialEq, Debug)]
pub struct Decision {
    /// What was found.
    pub verdict: Verdict,
    /// What the model leaves open, of what the property depends on.
    pub gaps: Vec<Gap>,
    /// Devices that the property depends on, that the program reads and never writes: they count as inputs.
    pub unwritten: Vec<Key>,
    /// Devices of [`World::free`] that the property depends on.
    pub free: Vec<Key>,
    /// How many bits of memory the property depends on.
    pub latches: usize,
}

/// How many scans induction supposes at most.
pub(crate) const INDUCTION: usize = 12;

/// What a property asks, as a system of what it depends on, and the program's logic that it was cut out of.
pub fn system<'m>(
    module: &'m Module,
    property: &Property,
    options: &Options,
) -> (Encoder<'m>, System) {
    let mut world = options.world.clone();
    let conditions = property.conditions().into_iter().chain(&options.assumed);
    world
        .observed
        .extend(conditions.flat_map(Condition::devices));
    let mut encoder = Encoder::scan(module, world);
    for assumed in &options.assumed {
        let holds = assumed.encode(&mut encoder);
        encoder.suppose(holds);
    }
    let bad = property.encode(&mut encoder);
    let system = encoder.system(bad).sliced();
    (encoder, system)
}

/// A question about runs: whether one can do something.
pub trait Question {
    /// What the answer depends on.
    fn system(&self, world: &World) -> System;

    /// Runs a trace on the interpreter; after how many of its scans what is searched for has happened.
    fn happens(&self, trace: &Trace) -> Option<usize>;

    /// Whether timers may be taken to expire at any time.
    fn may_be_vague(&self) -> bool {
        true
    }
}

/// Whether a program has a property.
struct OfProperty<'a> {
    module: &'a Module,
    property: &'a Property,
    options: &'a Options,
}

impl Question for OfProperty<'_> {
    fn system(&self, world: &World) -> System {
        let options = Options {
            world: world.clone(),
            ..self.options.clone()
        };
        self::system(self.module, self.property, &options).1
    }

    fn happens(&self, trace: &Trace) -> Option<usize> {
        replay::replay(self.module, self.property, &self.options.assumed, trace)
    }
}

/// Decides whether a program has a property.
pub fn decide(module: &Module, property: &Property, options: &Options) -> Decision {
    let deadline = Instant::now() + options.time;
    let (encoder, system) = system(module, property, options);
    let of_cone = |wanted: &dyn Fn(&Input) -> bool| system.inputs.iter().any(|(_, i)| wanted(i));
    let gaps = encoder
        .gaps
        .iter()
        .enumerate()
        .filter(|(n, _)| of_cone(&|input| *input == Input::Gap(*n)))
        .map(|(_, gap)| gap.clone());
    let in_cone = |key: &Key| of_cone(&|input| matches!(input, Input::Device(of, _) if of == key));
    let (free, unwritten): (Vec<Key>, Vec<Key>) = encoder
        .opened()
        .filter(in_cone)
        .partition(|key| encoder.is_named_free(*key));
    let question = OfProperty {
        module,
        property,
        options,
    };
    Decision {
        gaps: order::set(gaps).into_iter().collect(),
        unwritten,
        free,
        latches: system.latches.len(),
        verdict: search(&question, &options.world, &system, deadline),
    }
}

/// A time, in milliseconds, in which every timer expires.
pub(crate) const FOREVER_MS: u32 = 4_000_000;

/// Bounded search and induction side by side. Then, each for a short time: a search for an invariant where timers may
/// expire at any time; a search for a run, and one for an invariant, where a scan may come any time after the one
/// before, so that a few scans show what takes many; and long runs by chance. Then the searches for invariants for
/// longer, and bounded search alone. What is proved for any time between scans holds for shorter times, too. `system`
/// is that of the question in this world.
pub fn search(
    question: &dyn Question,
    world: &World,
    system: &System,
    deadline: Instant,
) -> Verdict {
    let mut hunt = Hunt::new(question, world, system, deadline);
    // A proof must hold for what a replay cannot show, too.
    let mut complete = Bounded::new(system, false, deadline);
    let mut induction = Induction::new(system, deadline);
    for _ in 0..INDUCTION {
        if let Some(verdict) = hunt.step() {
            return verdict;
        }
        match complete.step() {
            Step::Holds if induction.step() => return Verdict::Proved,
            Step::Holds => {}
            Step::Impossible => {
                let scans = complete.scans();
                return Verdict::Undecided(Why::Contradiction { scans });
            }
            Step::Violated(_) | Step::TimeUp => break,
        }
    }
    // Most proofs are found at once.
    const AT_ONCE: u32 = 16;
    if question.may_be_vague() && proved_vaguely(question, world, deadline, AT_ONCE) {
        return Verdict::Proved;
    }
    let patient = question.system(&World {
        scan_ms: FOREVER_MS,
        ..world.clone()
    });
    if let Some(found) = patiently(question, world, &patient, deadline) {
        return found;
    }
    if invariant(&patient, share(deadline, AT_ONCE), deadline) {
        return Verdict::Proved;
    }
    if let Some(found) = hunt.by_chance(system, deadline) {
        return found;
    }
    if question.may_be_vague() && proved_vaguely(question, world, deadline, 4) {
        return Verdict::Proved;
    }
    if invariant(&patient, share(deadline, 2), deadline) {
        return Verdict::Proved;
    }
    while Instant::now() < deadline && hunt.spurious.is_none() {
        if let Some(verdict) = hunt.step() {
            return verdict;
        }
    }
    hunt.undecided()
}

/// When this part of the time that is left will be over: 4 is a quarter.
fn share(deadline: Instant, parts: u32) -> Instant {
    let now = Instant::now();
    now + deadline.saturating_duration_since(now) / parts
}

/// Whether a property is proved where timers may expire at any time, in this part of the time.
fn proved_vaguely(question: &dyn Question, world: &World, deadline: Instant, parts: u32) -> bool {
    let system = question.system(&World {
        any_preset: true,
        ..world.clone()
    });
    invariant(&system, share(deadline, parts), deadline)
}

/// Whether an invariant is found, and another solver confirms it.
fn invariant(system: &System, until: Instant, deadline: Instant) -> bool {
    match pdr::search(system, until) {
        pdr::Found::Invariant(cubes) => pdr::check(system, &cubes, deadline),
        pdr::Found::Violated | pdr::Found::TimeUp => false,
    }
}

/// Searches in `system`, where a scan may come any time after the one before: a run is replayed with scans in between.
fn patiently(
    question: &dyn Question,
    world: &World,
    system: &System,
    deadline: Instant,
) -> Option<Verdict> {
    let mut hunt = Hunt::new(question, world, system, share(deadline, 8));
    for _ in 0..2 * INDUCTION {
        if hunt.spurious.is_some() {
            break;
        }
        let found = hunt.step();
        if found.is_some() {
            return found;
        }
    }
    None
}

/// A search for a run that the interpreter confirms.
struct Hunt<'a> {
    question: &'a dyn Question,
    /// The most milliseconds from one scan of the program to the next.
    scan_ms: u32,
    bounded: Bounded<'a>,
    /// How long the first run was that the interpreter did not confirm.
    spurious: Option<usize>,
}

impl<'a> Hunt<'a> {
    fn new(
        question: &'a dyn Question,
        world: &World,
        system: &'a System,
        deadline: Instant,
    ) -> Self {
        Hunt {
            question,
            scan_ms: world.scan_ms,
            bounded: Bounded::new(system, true, deadline),
            spurious: None,
        }
    }

    /// Searches one scan further, unless nothing can be confirmed any more.
    fn step(&mut self) -> Option<Verdict> {
        if self.spurious.is_some() {
            return None;
        }
        let Step::Violated(trace) = self.bounded.step() else {
            return None;
        };
        let happens = |trace: &Trace| self.question.happens(trace);
        let trace = replay::stretched(&trace, self.scan_ms);
        if happens(&trace).is_none() {
            self.spurious = Some(self.bounded.scans());
            return None;
        }
        Some(Verdict::Found(replay::plain(&happens, trace)))
    }

    /// Searches runs that are longer than a search scan by scan can reach.
    fn by_chance(&self, system: &System, deadline: Instant) -> Option<Verdict> {
        /// Long enough for runs that can be found so at all, and for what shortens one.
        const MOST: Duration = Duration::from_secs(3);
        let soon = || share(deadline, 4).min(Instant::now() + MOST);
        let happens = |trace: &Trace| self.question.happens(trace);
        let found = long_runs(system, self.scan_ms, soon(), &mut |trace| {
            happens(trace).is_some()
        })?;
        let short = replay::shortened(&happens, found, soon());
        Some(Verdict::Found(replay::plain(&happens, short)))
    }

    fn undecided(&self) -> Verdict {
        Verdict::Undecided(match self.spurious {
            Some(scans) => Why::Spurious { scans },
            None => Why::Time {
                scans: self.bounded.scans().saturating_sub(1),
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Options, Verdict, decide};
    use crate::model::World;
    use crate::property::{Property, parse};
    use rungc_ir::passes::simplify;
    use rungc_lower::compile::{CompileOptions, compile};
    use std::time::Duration;

    #[test]
    fn runs_of_many_scans_are_found() {
        // Forty parts, then one of twenty marks: no search scan by scan gets there.
        let list = "LD X000\nAND X001\nOUT C0 K1000\nLDF X000\nMOV C0 D10\nINC D20\nRST C0\nLD> D10 K20\nOUT Y001\n\
                    LD= D20 K40\nSET M20\nLD X002\nRST M20\nMOV K0 D20\nLD M20\nOUT Y002\nEND\n";
        let program = rungc_frontend::read_text("parts.il", list).program;
        let options = CompileOptions {
            optimise: false,
            ..CompileOptions::default()
        };
        let mut module = compile(&program, &options).module.unwrap();
        simplify(&mut module);
        let options = Options {
            world: World::default(),
            // What breaks an assumption does not end a run.
            assumed: vec![parse("!(X001 & X002)", &|_| Vec::new()).unwrap()],
            time: Duration::from_secs(120),
        };
        let both = parse("Y001 & Y002", &|_| Vec::new()).unwrap();
        let decision = decide(&module, &Property::Never(both), &options);
        let Verdict::Found(trace) = decision.verdict else {
            panic!("{decision:?}");
        };
        assert!(trace.scans.len() > 80, "{} scans", trace.scans.len());
    }
}
