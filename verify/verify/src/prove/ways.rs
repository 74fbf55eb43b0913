//! Ways to answer a question that needs many scans, in rounds.

use super::scans::Hunt;
use super::{Answer, FOREVER_MS, INDUCTION, PLAIN, Question, SIMPLIFIED, Verdict, shown};
use crate::effort::Limit;
use crate::model::World;
use crate::pdr;
use crate::proof::{Method, Posed, Proof};
use crate::random::LongRuns;
use crate::replay;
use crate::search::Trace;
use crate::steered::{Plant, Steered};
use std::cell::LazyCell;

/// Effort for runs by chance in a round, as a multiple of that for another way.
const BY_CHANCE: u64 = 2;

/// Effort for an invariant without the times of timers, in halves of that for another way: the smallest system shows
/// most.
const ABSTRACTED: u64 = 3;

/// Part of the effort for runs by chance that those on the interpreter take where the logic leaves something open: a
/// half. It comes off the runs of the logic, so that proofs have what they had.
const ON_INTERPRETER: u64 = 2;

/// Percentage of a way's effort for runs on the interpreter where nothing is open, from the second round on. They come
/// first and on top: of two searches by chance, one finds soon what the other hardly ever does.
const BESIDE: u64 = 75;

/// A system in which an invariant is searched. It is made when it is first needed: most questions are answered before.
pub(super) struct Attempt<'a> {
    posed: LazyCell<Posed, Box<dyn FnOnce() -> Posed + 'a>>,
    /// True if an invariant may exist.
    may_hold: bool,
}

impl<'a> Attempt<'a> {
    pub fn new(pose: impl FnOnce() -> Posed + 'a) -> Self {
        Attempt {
            posed: LazyCell::new(Box::new(pose)),
            may_hold: true,
        }
    }

    /// The system, and the limit of a search in it with this effort. Making the system takes nothing of that.
    fn begin(&self, effort: u64, limit: &Limit) -> (&Posed, Limit) {
        let posed = LazyCell::force(&self.posed);
        (posed, limit.part(effort))
    }

    /// A proof by an invariant, which another solver confirms.
    pub fn invariant(&mut self, effort: u64, limit: &Limit) -> Option<Proof> {
        if !self.may_hold {
            return None;
        }
        let (posed, part) = self.begin(effort, limit);
        match pdr::search(&posed.system, &part) {
            pdr::Found::Invariant(cubes) => pdr::check(&posed.system, &cubes, limit)
                .then(|| posed.proof(Method::Invariant(cubes))),
            pdr::Found::Violated => {
                self.may_hold = false;
                None
            }
            pdr::Found::TimeUp => None,
        }
    }
}

/// Ways to answer a question that needs many scans.
pub(super) struct Ways<'a> {
    question: &'a dyn Question,
    world: &'a World,
    /// The question as it is, simplified.
    pub as_it_is: Attempt<'a>,
    /// The same with timers that may expire at any time, if that may be asked.
    pub timers_abstracted: Option<Attempt<'a>>,
    /// The same where a scan may come any time after the one before, so that a few scans show what takes many. What is
    /// proved for any time between scans holds for shorter times, too.
    pub free_scan_times: Attempt<'a>,
    /// True if more effort shows no run there.
    free_runs_are_over: bool,
    /// Runs that are longer than a search scan by scan can reach.
    long_runs: LongRuns<'a>,
    /// Runs on the interpreter, where nothing is left open.
    steered: Option<Steered<Plant<'a>>>,
    /// True if the logic shows a run that the interpreter does not confirm, or leaves something open.
    is_open: bool,
    /// Number of rounds so far.
    rounds: u32,
    limit: &'a Limit,
}

impl<'a> Ways<'a> {
    pub fn new(
        question: &'a dyn Question,
        world: &'a World,
        (posed, as_it_is): (&'a Posed, Attempt<'a>),
        limit: &'a Limit,
    ) -> Self {
        let abstracted = || {
            let posed = question.posed(&World {
                any_preset: true,
                ..world.clone()
            });
            posed.simplified(&limit.part(SIMPLIFIED))
        };
        let free_scan_times = || {
            question.posed(&World {
                scan_ms: FOREVER_MS,
                ..world.clone()
            })
        };
        let abstracts = question.abstracts_timers();
        Ways {
            question,
            world,
            as_it_is,
            timers_abstracted: abstracts.then(|| Attempt::new(abstracted)),
            free_scan_times: Attempt::new(free_scan_times),
            free_runs_are_over: false,
            long_runs: LongRuns::new(&posed.system, world.scan_ms),
            steered: question.steered(limit),
            is_open: question.leaves_open(),
            rounds: 0,
            limit,
        }
    }

    /// Returns true if no proof can be found any more, nor a run that the interpreter confirms, other than by a search
    /// scan by scan: rounds with more effort would do the same again and spend nothing.
    pub fn are_exhausted(&self, hunt: &Hunt) -> bool {
        let mut attempts = [&self.free_scan_times, &self.as_it_is]
            .into_iter()
            .chain(&self.timers_abstracted);
        let has_runs = !self.free_runs_are_over || !self.long_runs.are_over();
        attempts.all(|attempt| !attempt.may_hold) && (hunt.spurious.is_some() || !has_runs)
    }

    /// Tries each with this effort.
    pub fn round(&mut self, effort: u64, hunt: &Hunt) -> Option<Answer> {
        let limit = self.limit;
        self.rounds += 1;
        self.is_open |= hunt.spurious.is_some();
        if !self.is_open
            && self.rounds > 1
            && let Some(found) = self.runs_on_interpreter(&limit.part(effort / 100 * BESIDE))
        {
            return Some(found.into());
        }
        let abstracted = self.timers_abstracted.as_mut();
        let more = effort.saturating_mul(ABSTRACTED) / 2;
        if let Some(proof) = abstracted.and_then(|attempt| attempt.invariant(more, limit)) {
            return Some(proof.into());
        }
        if let Some(found) = self.with_free_scan_times(effort) {
            return Some(found.into());
        }
        if let Some(proof) = self.free_scan_times.invariant(effort, limit) {
            return Some(proof.into());
        }
        if let Some(found) = self.runs_by_chance(effort.saturating_mul(BY_CHANCE)) {
            return Some(found.into());
        }
        self.as_it_is.invariant(effort, limit).map(Answer::from)
    }

    /// Continues runs by chance where they were: on the interpreter where the logic leaves something open, and over the
    /// logic.
    fn runs_by_chance(&mut self, effort: u64) -> Option<Verdict> {
        let all = self.limit.part(effort);
        if self.is_open {
            let found = self.runs_on_interpreter(&all.share(ON_INTERPRETER));
            if found.is_some() {
                return found;
            }
        }
        let happens = |trace: &Trace| shown(self.question, self.limit, trace);
        let happened = &mut |trace: &Trace| happens(trace).is_some();
        let found = self.long_runs.search(&all, happened)?;
        Some(self.found(found))
    }

    /// Continues runs by chance on the interpreter, if the question has them.
    pub fn runs_on_interpreter(&mut self, part: &Limit) -> Option<Verdict> {
        let run = self.steered.as_mut()?.search(&|_| part.is_over())?;
        let trace = run.trace();
        let happens = shown(self.question, self.limit, &trace).is_some();
        happens.then(|| self.found(trace))
    }

    /// Verdict of a run, which is simplified first.
    fn found(&self, found: Trace) -> Verdict {
        let happens = |trace: &Trace| shown(self.question, self.limit, trace);
        let short = replay::shortened(&happens, found, &self.limit.share(4).part(PLAIN));
        Verdict::Found(replay::plain(
            &happens,
            self.world.scan_ms,
            short,
            &self.limit.part(PLAIN),
        ))
    }

    /// Searches a run where a scan may come any time after the one before: it is replayed with scans in between.
    fn with_free_scan_times(&mut self, effort: u64) -> Option<Verdict> {
        if self.free_runs_are_over {
            return None;
        }
        let (posed, part) = self.free_scan_times.begin(effort, self.limit);
        let mut hunt = Hunt::new(self.question, self.world, &posed.system, &part);
        for _ in 0..2 * INDUCTION {
            if hunt.has_ended() || part.is_over() {
                break;
            }
            let found = hunt.step();
            if found.is_some() {
                return found;
            }
        }
        // More effort affords longer runs, up to all that there is.
        let may_afford = hunt.is_too_long && effort < self.limit.effort();
        self.free_runs_are_over = !part.is_over() && !may_afford;
        self.is_open |= hunt.spurious.is_some();
        None
    }
}
