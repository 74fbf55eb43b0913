//! From a program and a property to a verdict.

#[cfg(test)]
mod events;
mod scans;
mod ways;

use crate::effort::Limit;
use crate::model::{AFTER_STOP, Encoder, Gap, Input, Key, World, gaps_of};
use crate::proof::{Posed, Proof};
use crate::property::{condition, event};
use crate::replay;
use crate::search::Trace;
use crate::steered::{Plant, Steered, Surroundings};
use crate::system::System;
use rungc_ir::Module;
use rungc_sim::property::{Condition, Property};
use scans::ScanByScan;
use std::time::Duration;
use ways::{Attempt, Ways};

/// Options of a decision.
#[derive(Clone, Debug)]
pub struct Options {
    /// Assumptions about the environment of the program.
    pub world: World,
    /// Conditions that hold after every scan.
    pub assumed: Vec<Condition>,
    /// Limit of the effort for each property ([`crate::effort::STEPS`]): what is found within it is the same on every
    /// machine.
    pub effort: u64,
    /// Time limit for each property, if there is one.
    pub time: Option<Duration>,
}

/// Usual limit of the effort for a property: about ten seconds of an ordinary computer.
pub const EFFORT: u64 = 10_000;

impl Default for Options {
    fn default() -> Self {
        Options {
            world: World::default(),
            assumed: Vec::new(),
            effort: EFFORT,
            time: None,
        }
    }
}

impl Options {
    /// Limit of a search.
    pub(crate) fn limit(&self) -> Limit {
        Limit::new(self.effort, self.time)
    }
}

/// Verdict on a property.
#[derive(Clone, PartialEq, Debug)]
pub enum Verdict {
    /// No run of the model does what must not happen.
    Proved,
    /// This run does it, on the interpreter too.
    Found(Trace),
    /// Neither is known.
    Undecided(Why),
}

/// Reason why a property is not decided.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Why {
    /// The time was up after this many scans without what is searched for.
    Time {
        /// Number of scans.
        scans: usize,
    },
    /// The effort was spent after this many scans without what is searched for.
    Effort {
        /// Number of scans.
        scans: usize,
        /// The effort.
        effort: u64,
    },
    /// The model allows a run of this many scans, but the program does otherwise: something in it is not modelled.
    Spurious {
        /// Number of scans.
        scans: usize,
    },
    /// No run of this many scans keeps the assumptions.
    Contradiction {
        /// Number of scans.
        scans: usize,
    },
    /// The program contradicts an assumption: a run ends where no scan keeps it, so that a proof says too little.
    Vacuous {
        /// The assumption, and the run.
        contradiction: String,
    },
    /// A run happens on the interpreter, but not on another engine.
    Engines {
        /// The engine, and the difference.
        difference: String,
    },
}

/// A verdict, and how it is known.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The verdict.
    pub verdict: Verdict,
    /// The proof, of what is proved.
    pub proof: Option<Proof>,
}

impl From<Verdict> for Answer {
    fn from(verdict: Verdict) -> Self {
        Answer {
            verdict,
            proof: None,
        }
    }
}

impl From<Proof> for Answer {
    fn from(proof: Proof) -> Self {
        Answer {
            verdict: Verdict::Proved,
            proof: Some(proof),
        }
    }
}

/// A verdict, and what it is about.
#[derive(Clone, Debug)]
pub struct Decision {
    /// The verdict.
    pub verdict: Verdict,
    /// The proof, of what is proved.
    pub proof: Option<Proof>,
    /// Parts that the property depends on and the model leaves open.
    pub gaps: Vec<Gap>,
    /// Devices that the property depends on, that the program reads and never writes: they count as inputs.
    pub unwritten: Vec<Key>,
    /// Devices of [`World::free`] that the property depends on.
    pub free: Vec<Key>,
    /// Number of bits of memory that the property depends on.
    pub latches: usize,
}

/// Maximum number of scans that induction assumes.
pub(crate) const INDUCTION: usize = 12;

/// System of the parts that a property depends on, and the program's logic that it was cut out of.
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
        let holds = condition(assumed, &mut encoder);
        encoder.suppose(holds);
    }
    let bad = event(property, &mut encoder);
    let system = encoder.system(bad).sliced();
    (encoder, system)
}

/// A question about runs: whether one can do something.
pub(crate) trait Question {
    /// The question in this world.
    fn posed(&self, world: &World) -> Posed;

    /// Runs a trace on the interpreter; after how many of its scans what is searched for has happened.
    fn happens(&self, trace: &Trace) -> Option<usize>;

    /// Steps of such a run, for the limit of a search.
    fn steps(&self, trace: &Trace) -> usize;

    /// Returns true if the answer depends on something that the logic leaves open.
    fn leaves_open(&self) -> bool {
        false
    }

    /// A search for a run on the interpreter, with these steps of its limit, if the question has one.
    fn steered<'q>(&'q self, _limit: &Limit) -> Option<Steered<Plant<'q>>> {
        None
    }

    /// Returns true if the answer may abstract from the time at which timers expire.
    fn abstracts_timers(&self) -> bool {
        true
    }
}

/// Question whether a program has a property.
struct OfProperty<'a> {
    module: &'a Module,
    property: &'a Property,
    options: &'a Options,
    surroundings: Surroundings,
}

impl Question for OfProperty<'_> {
    fn posed(&self, world: &World) -> Posed {
        let options = Options {
            world: world.clone(),
            ..self.options.clone()
        };
        system(self.module, self.property, &options).1.into()
    }

    fn happens(&self, trace: &Trace) -> Option<usize> {
        replay::replay(self.module, self.property, &self.options.assumed, trace)
    }

    fn steps(&self, trace: &Trace) -> usize {
        replay::steps(self.module, trace)
    }

    fn leaves_open(&self) -> bool {
        self.surroundings.is_open
    }

    fn steered<'q>(&'q self, limit: &Limit) -> Option<Steered<Plant<'q>>> {
        let plant = Plant::new(self.module, self.property, &self.options.assumed, limit);
        let Surroundings {
            outside, watched, ..
        } = self.surroundings.clone();
        Some(Steered::new(plant, outside, watched, (SEED, LONGEST)))
    }
}

/// Decides whether a program has a property.
pub fn decide(module: &Module, property: &Property, options: &Options) -> Decision {
    let limit = options.limit();
    let (encoder, system) = system(module, property, options);
    let mut gaps = gaps_of(&system, &encoder);
    let in_cone = |key: &Key| {
        let mut inputs = system.inputs.iter();
        inputs.any(|(_, input)| matches!(input, Input::Device(of, _) if of == key))
    };
    let (free, unwritten): (Vec<Key>, Vec<Key>) = encoder
        .opened()
        .filter(in_cone)
        .partition(|key| encoder.is_named_free(*key));
    let question = OfProperty {
        module,
        property,
        options,
        surroundings: Surroundings::new(&encoder, &system, options.world.scan_ms),
    };
    let latches = system.latches.len();
    let answer = search(&question, &options.world, &system.into(), &limit);
    // A proof holds for whatever is there after STOP; it is named where it may be the reason that there is none.
    if !matches!(answer.verdict, Verdict::Undecided(_)) {
        gaps.retain(|gap| gap.what != AFTER_STOP);
    }
    Decision {
        gaps: gaps.into_iter().collect(),
        unwritten,
        free,
        latches,
        verdict: answer.verdict,
        proof: answer.proof,
    }
}

/// A time, in milliseconds, in which every timer expires.
pub const FOREVER_MS: u32 = 4_000_000;

/// Initial effort for each way, and its factor in the next round.
const ROUND: (u64, u64) = (500, 4);

/// The most effort for finding bits that never change or are always equal.
const SIMPLIFIED: u64 = 1000;

/// Part of what is left for runs on the interpreter where nothing else can decide: an eighth, since a run that is not
/// found soon is seldom found later.
const LAST: u64 = 8;

/// Part of the effort for a search scan by scan before other ways have their turn: a half, so that large logic leaves
/// them something.
const SCAN_BY_SCAN: u64 = 2;

/// Number of the sequence of runs by chance on the interpreter.
const SEED: u64 = 1;

/// The most scans of a stretch of one: more than counters of parts and timers of minutes take, and few beside all scans
/// of a turn.
const LONGEST: u64 = 4096;

/// Returns after how many scans of a trace what is searched for has happened, and counts its steps.
fn shown(question: &dyn Question, limit: &Limit, trace: &Trace) -> Option<usize> {
    limit.charge(question.steps(trace));
    question.happens(trace)
}

/// Number of scans after which an invariant is searched for the first time.
const EARLY: usize = 2;

/// Limit of the effort for leaving out of a run what does not matter.
const PLAIN: u64 = 2000;

/// Bounded search and induction side by side, and soon a first attempt at an invariant; then, in rounds that give each
/// of them more effort, these and the ways of [`Ways`]; then bounded search alone. `posed` is the question in this
/// world.
pub(crate) fn search(
    question: &dyn Question,
    world: &World,
    posed: &Posed,
    limit: &Limit,
) -> Answer {
    let mut scans = ScanByScan::new(question, world, posed, limit);
    let mut as_it_is = Attempt::new(|| posed.clone().simplified(&limit.part(SIMPLIFIED)));
    if let Some(answer) = scans.search(EARLY, limit) {
        return answer;
    }
    // Bits that are always equal make a proof short: where the clock of a duration equals a timer of the program, no
    // search scan by scan comes to an end.
    if !scans.ends
        && let Some(proof) = as_it_is.invariant(ROUND.0 / 2, limit)
    {
        return proof.into();
    }
    if let Some(answer) = scans.search(INDUCTION, &limit.share(SCAN_BY_SCAN)) {
        return answer;
    }
    let mut ways = Ways::new(question, world, (posed, as_it_is), limit);
    let (mut effort, factor) = ROUND;
    while !limit.is_over() && !ways.are_exhausted(&scans.hunt) {
        if let Some(answer) = ways.round(effort, &scans.hunt) {
            return answer;
        }
        if let Some(answer) = scans.search(INDUCTION, &limit.part(effort)) {
            return answer;
        }
        effort = effort.saturating_mul(factor);
    }
    if scans.hunt.spurious.is_some()
        && let Some(found) = ways.runs_on_interpreter(&limit.share(LAST))
    {
        return found.into();
    }
    while !limit.is_over() && !scans.hunt.has_ended() {
        if let Some(verdict) = scans.hunt.step() {
            return verdict.into();
        }
    }
    scans.hunt.undecided().into()
}

#[cfg(test)]
mod tests {
    use super::{
        Attempt, OfProperty, Options, Question, Surroundings, Verdict, Ways, Why, decide, search,
        system,
    };
    use crate::certificate::formulas;
    use crate::model::World;
    use crate::proof::{Fact, Posed, Proof};
    use crate::sat::{Answer, Solver};
    use crate::search::Trace;
    use crate::tests::module;
    use rungc_sim::property::{Property, parse};
    use std::time::{Duration, Instant};

    #[test]
    fn each_way_to_a_proof_leaves_what_others_can_check() {
        // M20, which Y000 needs and M1 excludes, is on if D0 is above 9; D0 begins again after 5.
        let module = module(
            "LD X000\nOUT T0 K3\nLD T0\nOUT M0\nLD M0\nANI M20\nOUT M1\nLDP X001\nADD D0 K1 D0\nLD> D0 K5\nMOV K0 D0\n\
             LD> D0 K9\nOUT M20\nLD M20\nOUT Y000\nLD M1\nOUT Y001\nEND\n",
        );
        let both = parse("Y000 & Y001", &|_| Vec::new()).unwrap();
        let options = Options {
            world: World {
                fresh: true,
                ..World::default()
            },
            assumed: Vec::new(),
            effort: 60_000,
            time: None,
        };
        let property = Property::Never(both);
        let (encoder, system) = system(&module, &property, &options);
        let question = OfProperty {
            module: &module,
            property: &property,
            options: &options,
            surroundings: Surroundings::new(&encoder, &system, options.world.scan_ms),
        };
        let limit = options.limit();
        let posed = question.posed(&options.world);
        let as_it_is = Attempt::new(|| posed.clone().simplified(&limit));
        let mut ways = Ways::new(&question, &options.world, (&posed, as_it_is), &limit);
        let abstracted = ways.timers_abstracted.as_mut().unwrap();
        let attempts = [abstracted, &mut ways.free_scan_times, &mut ways.as_it_is];
        let mut proofs: Vec<_> = attempts
            .map(|attempt| attempt.invariant(options.effort, &limit))
            .into();
        assert!(proofs.iter().all(Option::is_some));
        // Invariants of bits are part of the proof.
        assert!(
            proofs[2]
                .as_ref()
                .is_some_and(|proof| !proof.facts.is_empty())
        );
        proofs.push(decide(&module, question.property, &options).proof);
        let refuted = |proof: &Proof| {
            let formulas = formulas(proof).into_iter();
            let satisfied = formulas.filter(|(_, formula)| {
                let mut solver = Solver::new(&limit);
                let all = formula.all.iter();
                let all: Vec<_> = all.map(|&lit| solver.lit(&formula.aig, lit)).collect();
                solver.solve(&all) != Answer::Unsat
            });
            satisfied.map(|(name, _)| name).collect::<Vec<_>>()
        };
        for proof in proofs.iter().flatten() {
            assert_eq!(refuted(proof), Vec::<&str>::new());
        }
        // A proof that rests on what does not hold is not confirmed.
        let mut wrong = proofs[2].clone().unwrap();
        let facts = wrong.facts.clone();
        let is_about =
            |fact: &Fact, of: usize| matches!(fact, Fact::Bit { latch, .. } if *latch == of);
        let unknown = |latch: &usize| !facts.iter().any(|fact| is_about(fact, *latch));
        let known_at_first = |latch: &usize| posed.system.latches[*latch].init.is_some();
        let latches = (0..posed.system.latches.len()).filter(|n| unknown(n) && known_at_first(n));
        wrong
            .facts
            .extend(latches.map(|latch| Fact::Bit { latch, like: None }));
        assert!(refuted(&wrong).contains(&"bits-step"));
    }

    #[test]
    fn short_scans_do_not_make_an_answer_late() {
        // Without a longest scan, the timer expires at once; in scans of a millisecond that takes millions of them.
        let module = module("LD X000\nOUT T0 K30000\nLD T0\nOUT Y000\nEND\n");
        let never = parse("Y000", &|_| Vec::new()).unwrap();
        let options = Options {
            world: World {
                scan_ms: 1,
                ..World::default()
            },
            effort: 200,
            ..Options::default()
        };
        let begin = Instant::now();
        let decision = decide(&module, &Property::Never(never), &options);
        assert!(matches!(decision.verdict, Verdict::Undecided(_)));
        assert!(begin.elapsed() < Duration::from_secs(60));
    }

    #[test]
    fn runs_keep_the_times_of_scans() {
        let late = module("LD X000\nOUT M0\nLD M0\nOUT Y000\nEND\n");
        let constant =
            module("LD M8000\nOUT M8039\nLD M8002\nMOV K30 D8039\nLDP X000\nOUT Y000\nEND\n");
        let never = Property::Never(parse("Y000", &|_| Vec::new()).unwrap());
        for (module, scan_ms, least) in [(late, 1, 1), (constant, 200, 30)] {
            let options = Options {
                world: World {
                    scan_ms,
                    ..World::default()
                },
                assumed: vec![parse("!M8002 | !X000", &|_| Vec::new()).unwrap()],
                ..Options::default()
            };
            let decision = decide(&module, &never, &options);
            let Verdict::Found(trace) = decision.verdict else {
                panic!("{decision:?}");
            };
            let mut later = trace.scans.iter().skip(1);
            assert!(
                later.all(|scan| (least..=scan_ms).contains(&scan.ms)),
                "{trace:?}"
            );
        }
    }

    #[test]
    fn runs_of_many_scans_are_found() {
        // Forty parts, then one of twenty marks: no search scan by scan gets there.
        let list = "LD X000\nAND X001\nOUT C0 K1000\nLDF X000\nMOV C0 D10\nINC D20\nRST C0\nLD> D10 K20\nOUT Y001\n\
                    LD= D20 K40\nSET M20\nLD X002\nRST M20\nMOV K0 D20\nLD M20\nOUT Y002\nEND\n";
        let module = module(list);
        let options = Options {
            world: World::default(),
            // A violated assumption does not end a run.
            assumed: vec![parse("!(X001 & X002)", &|_| Vec::new()).unwrap()],
            effort: 120_000,
            time: None,
        };
        let both = parse("Y001 & Y002", &|_| Vec::new()).unwrap();
        let decision = decide(&module, &Property::Never(both), &options);
        let Verdict::Found(trace) = decision.verdict else {
            panic!("{decision:?}");
        };
        assert!(trace.scans.len() > 80, "{} scans", trace.scans.len());
    }

    /// A question whose runs happen in the model only.
    struct NeverHappens<'a>(OfProperty<'a>);

    impl Question for NeverHappens<'_> {
        fn posed(&self, world: &World) -> Posed {
            self.0.posed(world)
        }

        fn happens(&self, _trace: &Trace) -> Option<usize> {
            None
        }

        fn steps(&self, trace: &Trace) -> usize {
            trace.scans.len()
        }
    }

    #[test]
    fn rounds_end_where_more_effort_shows_nothing() {
        // Each round would show the same runs again and spend next to nothing.
        let module = module("LD X000\nOUT T0 K20\nEND\n");
        let property = Property::Never(parse("T0", &|_| Vec::new()).unwrap());
        let options = Options {
            world: World {
                scan_ms: 100,
                ..World::default()
            },
            ..Options::default()
        };
        let (encoder, system) = system(&module, &property, &options);
        let question = NeverHappens(OfProperty {
            module: &module,
            property: &property,
            options: &options,
            surroundings: Surroundings::new(&encoder, &system, options.world.scan_ms),
        });
        let posed = question.posed(&options.world);
        let answer = search(&question, &options.world, &posed, &options.limit());
        // Twenty scans later the timer expires, in the model.
        assert_eq!(
            answer.verdict,
            Verdict::Undecided(Why::Spurious { scans: 21 })
        );
    }
}
