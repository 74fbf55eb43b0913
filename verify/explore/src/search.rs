//! The search: moments of runs, from which others are reached.
//!
//! A round continues from several moments at once, each with its own random numbers, in as many threads as there are
//! processors. What the parts of a round have found is put together in their order, so that a search with the same seed
//! finds the same, however many processors there are.

use crate::cover::{Feature, Last, Seen, View};
use crate::lanes::Lanes;
use crate::run::{Moment, RESTLESS, Runner, Scanned};
use crate::task::{Found, Kind, Step, Task, What};
use crate::trains::cost;
use crate::vary::Choices;
use crate::wide::{Event, Items, LANES, Sweep, refusal};
use fastrand::Rng;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use web_time::Instant;

/// Number of parts of a round.
const PARTS: usize = 8;
/// Approximate number of scans in each part.
const PART_SCANS: u32 = 256;
/// Number of moments stored.
const KEPT: usize = 400;
/// Maximum number of new moments of a part of a round.
const BROUGHT: usize = 24;
/// As many scans does one count as that does not end: it repeats millions of steps.
const ENDLESS: u64 = 2_000;
/// Longer runs are not continued.
const LONGEST: usize = 3_000;
/// After this many scans there are sweeps, if the program permits them: what is near has been found then.
const NEAR: u64 = 32_000;
/// Approximate number of scans in each lane for a part of a round with sweeps.
const SWEEP_SCANS: u32 = 64;
/// One round in this many has no sweeps.
const TURNS: u64 = 4;

/// Limits of a search.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Approximate number of scans: a search ends with the round in which it passes this.
    pub scans: u64,
    /// Time limit.
    pub time: Option<Duration>,
    /// Random seed.
    pub seed: u64,
    /// In how many threads, at least 1.
    pub threads: usize,
    /// Executable built by [`crate::lanes::build`] that executes sweeps; `None`: the interpreter does.
    pub lanes: Option<PathBuf>,
}

/// Result of a search.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Report {
    /// Everything that was found, in the order in which it was, once each.
    pub found: Vec<Found>,
    /// Number of scans executed.
    pub scans: u64,
    /// Number of moments reached that show something new.
    pub moments: usize,
    /// Numbers of branches taken, and of all branches of the program.
    pub branches: (usize, usize),
}

/// A moment that the search continues from.
struct Checkpoint<'t> {
    moment: Moment<'t>,
    run: Vec<Step>,
    chosen: u32,
}

/// Result of a part of a round.
#[derive(Default)]
struct PartResult<'t> {
    found: Vec<Found>,
    moments: Vec<(Vec<Feature>, Checkpoint<'t>)>,
    scans: u64,
    /// Scans, those that do not end as many.
    spent: u64,
    /// Reason why the search cannot continue.
    failed: Option<String>,
}

/// Executor of a part of a round.
struct Worker<'t> {
    runner: Runner<'t>,
    lanes: Option<Lanes>,
}

/// Searches until the limits; stops earlier once all properties are decided and nothing else is searched for, or when
/// `is_over` says so after a round. Fails if the machine does not fit the PLC, or with lanes if their process ends or
/// does otherwise than the interpreter.
pub fn search(
    task: &Task,
    limits: &Limits,
    is_over: &mut dyn FnMut(&Report) -> bool,
) -> Result<Report, String> {
    let begin = Instant::now();
    let (view, choices) = (View::new(task), Choices::new(task));
    let mut seen = Seen::default();
    let mut kept = vec![Checkpoint {
        moment: Runner::new(task)?.save(),
        run: Vec::new(),
        chosen: 0,
    }];
    let mut report = Report::default();
    let mut spent = 0;
    let mut known: BTreeSet<What> = BTreeSet::new();
    let mut rng = Rng::with_seed(limits.seed);
    let items = Items::new(task, &view);
    let may_sweep = refusal(task).is_none();
    let threads = limits.threads.clamp(1, PARTS);
    let workers = (0..threads).map(|_| Worker::new(task, &items, limits));
    let mut workers: Vec<Worker> = workers.collect::<Result<_, _>>()?;
    let mut rounds = 0;
    loop {
        let parts: Vec<(u64, usize)> = (0..PARTS)
            .map(|_| (rng.u64(..), choose(&mut kept, &mut rng)))
            .collect();
        let left = limits.scans.saturating_sub(spent);
        let scans = u32::try_from(left).map_or(PART_SCANS, |left| {
            PART_SCANS.min(left.div_ceil(PARTS as u32))
        });
        rounds += 1;
        let all = PARTS as u64 * LANES as u64 * u64::from(SWEEP_SCANS);
        let sweeps = may_sweep && spent >= NEAR && left >= all && rounds % TURNS != 0;
        let round = Round {
            task,
            items: sweeps.then_some(&items),
            view: &view,
            choices: &choices,
            seen: &seen,
            known: &known,
            kept: &kept,
            scans,
        };
        let brought = round.all(&parts, &mut workers)?;
        for part in brought {
            part.failed.map_or(Ok(()), Err)?;
            report.scans += part.scans;
            spent += part.spent;
            for found in part.found {
                if known.insert(found.what.clone()) {
                    report.found.push(found);
                }
            }
            for (features, moment) in part.moments {
                let new = features.into_iter().filter(|&f| seen.add(f)).count();
                if new > 0 {
                    report.moments += 1;
                    keep(&mut kept, moment, &mut rng);
                }
            }
        }
        let branches = &task.notes.branches;
        report.branches = (view.taken(&seen), branches.len());
        let late = limits.time.is_some_and(|time| begin.elapsed() >= time);
        if late || spent >= limits.scans || is_over(&report) {
            return Ok(report);
        }
    }
}

/// A moment to continue from: of some, the one that was chosen least.
fn choose(kept: &mut [Checkpoint], rng: &mut Rng) -> usize {
    const TRIED: usize = 3;
    let tried = (0..TRIED).map(|_| rng.usize(..kept.len()));
    let best = tried.min_by_key(|&i| (kept[i].chosen, kept[i].run.len()));
    let best = best.unwrap_or(0);
    kept[best].chosen += 1;
    best
}

/// Keeps a moment; if there are too many, in place of one that was chosen often. The first, power-on, stays.
fn keep<'t>(kept: &mut Vec<Checkpoint<'t>>, moment: Checkpoint<'t>, rng: &mut Rng) {
    if kept.len() < KEPT {
        kept.push(moment);
        return;
    }
    const TRIED: usize = 6;
    let tried = (0..TRIED).map(|_| rng.usize(1..kept.len()));
    if let Some(worst) = tried.max_by_key(|&i| kept[i].chosen) {
        kept[worst] = moment;
    }
}

/// Data shared by the parts of a round.
struct Round<'r, 't> {
    task: &'t Task<'t>,
    view: &'r View<'t>,
    choices: &'r Choices<'t>,
    seen: &'r Seen,
    known: &'r BTreeSet<What>,
    kept: &'r [Checkpoint<'t>],
    /// Of each part.
    scans: u32,
    /// Of a round with sweeps: what they look at.
    items: Option<&'r Items>,
}

impl<'t> Worker<'t> {
    fn new(task: &'t Task<'t>, items: &Items, limits: &Limits) -> Result<Self, String> {
        let start =
            |path: &PathBuf| Lanes::start(path, task, items).map_err(|error| error.to_string());
        Ok(Worker {
            runner: Runner::new(task)?,
            lanes: limits.lanes.as_ref().map(start).transpose()?,
        })
    }
}

impl<'t> Round<'_, 't> {
    /// All parts, each with the seed of its random numbers and the moment that it continues from, in their order, a
    /// thread for each runner.
    fn all(
        &self,
        parts: &[(u64, usize)],
        workers: &mut [Worker<'t>],
    ) -> Result<Vec<PartResult<'t>>, String> {
        // Parts differ in length, so each thread takes the next one when it has finished the last.
        let next = AtomicUsize::new(0);
        let of_thread = |worker: &mut Worker<'t>| {
            let numbers = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)));
            let own = numbers.map_while(|i| Some((i, *parts.get(i)?)));
            let brought = own.map(|(i, part)| match self.items {
                Some(items) => (i, self.sweeps(worker, items, part)),
                None => (i, self.part(&mut worker.runner, part)),
            });
            brought.collect::<Vec<_>>()
        };
        let mut all: Vec<(usize, PartResult)> = Vec::new();
        if let [only] = workers {
            all = of_thread(only);
        } else {
            let of_thread = &of_thread;
            std::thread::scope(|scope| {
                let workers = workers.iter_mut();
                let running = workers.map(|worker| scope.spawn(move || of_thread(worker)));
                for thread in running.collect::<Vec<_>>() {
                    let brought = thread.join();
                    all.extend(brought.map_err(|_| "a thread of the search has failed")?);
                }
                Ok::<(), String>(())
            })?;
        }
        all.sort_by_key(|(i, _)| *i);
        Ok(all.into_iter().map(|(_, brought)| brought).collect())
    }

    /// Continues from a moment, and from it again when the run has become long or has ended.
    fn part(&self, runner: &mut Runner<'t>, (seed, start): (u64, usize)) -> PartResult<'t> {
        let mut rng = Rng::with_seed(seed);
        let mut brought = PartResult::default();
        let mut own = Seen::default();
        while brought.spent < u64::from(self.scans) {
            let start = &self.kept[start];
            runner.restore(&start.moment);
            let mut way = Way {
                run: start.run.clone(),
                last: self.view.nothing(),
            };
            // The moment itself shows nothing new.
            self.view.look(runner, &mut way.last, &mut |_| {});
            let steps = 1 + rng.u32(..8) + rng.u32(..8);
            for _ in 0..steps {
                let left = u64::from(self.scans).saturating_sub(brought.spent);
                if left == 0 || way.run.len() >= LONGEST {
                    break;
                }
                let goes_on = self.step(runner, &mut way, &mut rng, (&mut brought, &mut own));
                if !goes_on {
                    break;
                }
            }
        }
        brought
    }

    /// Sweeps that continue from a moment.
    fn sweeps(
        &self,
        worker: &mut Worker<'t>,
        items: &Items,
        (seed, start): (u64, usize),
    ) -> PartResult<'t> {
        let mut rng = Rng::with_seed(seed);
        let mut brought = PartResult::default();
        let mut own = Seen::default();
        let start = &self.kept[start];
        let mut scans = 0;
        while scans < SWEEP_SCANS && brought.failed.is_none() {
            worker.runner.restore(&start.moment);
            let strides = self.choices.sweep(&worker.runner, &mut rng, SWEEP_SCANS);
            scans += strides.iter().map(|stride| stride.time.0).sum::<u32>();
            if start.run.len() + strides.len() > LONGEST {
                continue;
            }
            let sweep = Sweep {
                task: self.task,
                view: self.view,
                items,
                start: &start.moment,
                run: &start.run,
                strides,
            };
            let done = self.sweep(&sweep, worker, (&mut brought, &mut own));
            brought.failed = done.err();
        }
        brought.scans = u64::from(scans) * LANES as u64;
        brought.spent = brought.scans;
        brought
    }

    fn sweep(
        &self,
        sweep: &Sweep<'_, 't>,
        worker: &mut Worker<'t>,
        (brought, own): (&mut PartResult<'t>, &mut Seen),
    ) -> Result<(), String> {
        let mut judge = sweep.judge(&mut worker.runner);
        let mut is_new = |feature| self.seen.lacks(feature) && own.add(feature);
        let mut met = BTreeSet::new();
        let mut is_searched = |what: &What| !self.known.contains(what) && met.insert(what.clone());
        let mut row = |changes: &[_]| judge.scan(changes, &mut is_new, &mut is_searched);
        match &mut worker.lanes {
            Some(lanes) => lanes.sweep(sweep.run, &sweep.strides, &mut row)?,
            None => sweep.interpret(&mut worker.runner, &mut row),
        }
        for shown in judge.shown {
            let is_moment = matches!(shown.event, Event::Moment(_));
            if is_moment && brought.moments.len() >= BROUGHT {
                continue;
            }
            let run = sweep.confirm(&mut worker.runner, &shown)?;
            match shown.event {
                Event::Happened(what) if self.is_new(brought, &what) => {
                    brought.found.push(Found { what, run });
                }
                Event::Happened(_) => {}
                Event::Moment(features) => {
                    let moment = worker.runner.save();
                    let kept = Checkpoint {
                        moment,
                        run,
                        chosen: 0,
                    };
                    brought.moments.push((features, kept));
                }
            }
        }
        Ok(())
    }

    /// A step; whether the run can continue.
    fn step(
        &self,
        runner: &mut Runner<'t>,
        way: &mut Way,
        rng: &mut Rng,
        (brought, own): (&mut PartResult<'t>, &mut Seen),
    ) -> bool {
        let step = self.choices.step(runner, rng, 4 * self.scans.max(64));
        runner.begin(&step);
        let cost = cost(&step.pulses);
        brought.spent += cost;
        let mut done = Step { scans: 0, ..step };
        let mut new = Vec::new();
        let mut scanned = Scanned::Next;
        for _ in 0..step.scans {
            scanned = runner.scan(done.scan_ms);
            brought.scans += 1;
            brought.spent += 1;
            done.scans += 1;
            if scanned == Scanned::Excluded {
                break;
            }
            let happened = std::mem::take(&mut runner.happened);
            for what in happened {
                if matches!(what, What::Watchdog { .. }) {
                    brought.spent += ENDLESS;
                }
                self.note(brought, way, &done, what);
            }
            self.view.look(runner, &mut way.last, &mut |feature| {
                if self.seen.lacks(feature) && own.add(feature) {
                    new.push(feature);
                }
            });
            if scanned == Scanned::End {
                break;
            }
        }
        if scanned == Scanned::Next && self.task.wants(Kind::Oscillation) {
            self.find_restless(runner, way, &done, brought);
        }
        way.run.push(done);
        if scanned == Scanned::Next && !new.is_empty() && brought.moments.len() < BROUGHT {
            let moment = Checkpoint {
                moment: runner.save(),
                run: way.run.clone(),
                chosen: 0,
            };
            brought.moments.push((new, moment));
        }
        scanned == Scanned::Next
    }

    fn find_restless(
        &self,
        runner: &mut Runner<'t>,
        way: &Way,
        done: &Step,
        brought: &mut PartResult<'t>,
    ) {
        /// After this many scans it is worth a closer look.
        const SUSPECT: u32 = 4;
        let suspects: Vec<u32> = runner.restless(SUSPECT).collect();
        for output in suspects {
            let what = What::Oscillation(output);
            if self.is_new(brought, &what) {
                brought.scans += u64::from(2 * RESTLESS);
                brought.spent += u64::from(2 * RESTLESS);
                if runner.never_rests(output) {
                    self.note(brought, way, done, what);
                }
            }
        }
    }

    fn is_new(&self, brought: &PartResult, what: &What) -> bool {
        !self.known.contains(what) && brought.found.iter().all(|found| found.what != *what)
    }

    /// Notes what has happened in the scan that has just ended.
    fn note(&self, brought: &mut PartResult<'t>, way: &Way, done: &Step, what: What) {
        if self.is_new(brought, &what) {
            let mut run = way.run.clone();
            run.push(done.clone());
            brought.found.push(Found { what, run });
        }
    }
}

/// A run that is on its way.
struct Way {
    run: Vec<Step>,
    last: Last,
}
