//! Assumptions that a program contradicts: runs that keep all of them until no further scan can. A proof says nothing
//! of what comes after.

use crate::aig::{Lit, Node};
use crate::effort::Limit;
use crate::model::{AFTER_STOP, Encoder, Input};
use crate::property::condition;
use crate::prove::Options;
use crate::random::{EVALUATED, Random, part_of};
use crate::sat::{Answer, SatLit, Solver};
use crate::system::System;
use rungc_ir::Module;
use rungc_sim::property::Condition;

/// End of a run: whatever the outside does, the next scan breaks an assumption.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct DeadEnd {
    /// Number of scans of the run.
    pub scans: usize,
    /// Its duration in milliseconds.
    pub ms: u64,
    /// Assumption that cannot be kept.
    pub broken: Broken,
}

/// An assumption that a program contradicts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Broken {
    /// A condition, by its number in [`Options::assumed`].
    Condition(usize),
    /// The longest time from one scan to the next: the program asks for longer scans (M8039).
    ScanTime,
    /// Several together.
    Together,
}

/// Limit of the effort for the search.
const LIMIT: u64 = 3000;

/// Runs that are followed, each for a number of scans.
const RUNS: (u64, usize) = (6, 400);

/// Searches a run that keeps the assumptions and that no scan can continue.
pub fn dead_end(module: &Module, options: &Options) -> Option<DeadEnd> {
    let mut world = options.world.clone();
    let devices = options.assumed.iter().flat_map(Condition::devices);
    world.observed.extend(devices);
    let mut encoder = Encoder::scan(module, world);
    let conditions = options.assumed.iter();
    let mut assumed: Vec<(Broken, Lit)> = conditions
        .enumerate()
        .map(|(n, of)| (Broken::Condition(n), condition(of, &mut encoder)))
        .collect();
    assumed.extend(encoder.constant_scan.map(|lit| (Broken::ScanTime, lit)));
    if assumed.is_empty() {
        return None;
    }
    let lits: Vec<Lit> = assumed.iter().map(|(_, lit)| *lit).collect();
    let kept = encoder.aig.all(lits);
    // What is not modelled could lead anywhere, also where no real run does.
    let is_gap = |(_, input): &(Lit, Input)| match input {
        Input::Gap(number) => encoder.gaps[*number].what != AFTER_STOP,
        _ => false,
    };
    if encoder.system(!kept).sliced().inputs.iter().any(is_gap) {
        return None;
    }
    let system = encoder.system(Lit::FALSE);
    let scan_ms = options.world.scan_ms;
    let mut search = Search::new(&system, &assumed, scan_ms);
    (0..RUNS.0).find_map(|run| search.follow(run))
}

/// A state, and what continues a run from it.
struct Search<'s> {
    system: &'s System,
    scan_ms: u32,
    /// Assumptions, with their literals and the solver's.
    assumed: Vec<(Broken, Lit, SatLit)>,
    /// What holds in every scan of the model.
    always: Vec<(Lit, SatLit)>,
    solver: Solver,
    /// The solver's literal of each latch before the scan.
    latches: Vec<SatLit>,
    random: Random,
    limit: Limit,
    /// The value of each node in the scan.
    values: Vec<bool>,
}

impl<'s> Search<'s> {
    fn new(system: &'s System, assumed: &[(Broken, Lit)], scan_ms: u32) -> Self {
        let limit = Limit::new(LIMIT, None);
        let mut solver = Solver::new(&limit);
        let of = |lit: Lit, solver: &mut Solver| solver.lit(&system.aig, lit);
        // STOP would put an end to any run.
        let restarts = system.inputs.iter();
        let restarts = restarts.filter(|(_, input)| *input == Input::Restart);
        let running: Vec<Lit> = restarts.map(|(restart, _)| !*restart).collect();
        let always = system.constraints.iter().chain(&system.replay_assumptions);
        let always = always.chain(&running);
        Search {
            scan_ms,
            assumed: assumed
                .iter()
                .map(|&(what, lit)| (what, lit, of(lit, &mut solver)))
                .collect(),
            always: always.map(|&lit| (lit, of(lit, &mut solver))).collect(),
            latches: system
                .latches
                .iter()
                .map(|latch| of(latch.now, &mut solver))
                .collect(),
            solver,
            random: Random::new(),
            limit,
            values: vec![false; system.aig.nodes().len()],
            system,
        }
    }

    /// Follows a run: by chance, as far as that keeps the assumptions, else with the inputs that keep them.
    fn follow(&mut self, run: u64) -> Option<DeadEnd> {
        let any = |random: &mut Random| run > 1 && random.below(4) == 0;
        let mut latches: Vec<bool> = Vec::new();
        for latch in &self.system.latches {
            latches.push(match latch.init {
                Some(on) => on,
                None => any(&mut self.random),
            });
        }
        let mut inputs = vec![false; self.system.inputs.len()];
        let mut ms = 0;
        for scans in 0..RUNS.1 {
            if self.limit.is_over() {
                return None;
            }
            self.vary(run, scans == 0, &mut inputs);
            self.evaluate(&latches, &inputs);
            let lits = self.always.iter().map(|(lit, _)| *lit);
            let mut lits = lits.chain(self.assumed.iter().map(|(_, lit, _)| *lit));
            if !lits.all(|lit| self.is_on(lit)) {
                match self.continued(&latches) {
                    Ok(found) => inputs = found,
                    Err(Some(broken)) => return Some(DeadEnd { scans, ms, broken }),
                    Err(None) => return None,
                }
                self.evaluate(&latches, &inputs);
            }
            ms += self.elapsed(&inputs);
            let next = self
                .system
                .latches
                .iter()
                .map(|latch| self.is_on(latch.next));
            latches = next.collect();
        }
        None
    }

    /// Changes some inputs. Runs of even number have the longest scans, so that times pass.
    fn vary(&mut self, run: u64, first: bool, inputs: &mut [bool]) {
        let ms = match (first, run % 2) {
            (true, _) => 0,
            (false, 0) => self.scan_ms,
            _ => 1 + self.random.below(self.scan_ms.into()) as u32,
        };
        for ((_, input), on) in self.system.inputs.iter().zip(inputs) {
            match *input {
                Input::Device(..) => *on ^= self.random.below(8) == 0,
                Input::Time(digit, bit) => *on = part_of(ms, digit, bit) != 0,
                Input::ScanTime(_) | Input::Restart => *on = false,
                Input::Shown(..) | Input::Gap(_) => *on = self.random.below(2) == 0,
            }
        }
    }

    fn evaluate(&mut self, latches: &[bool], inputs: &[bool]) {
        self.limit.charge(self.system.aig.nodes().len() / EVALUATED);
        for (latch, &on) in self.system.latches.iter().zip(latches) {
            self.values[latch.now.node()] = on;
        }
        for ((lit, _), &on) in self.system.inputs.iter().zip(inputs) {
            self.values[lit.node()] = on;
        }
        for (node, what) in self.system.aig.nodes().iter().enumerate() {
            if let Node::And(a, b) = *what {
                self.values[node] = self.is_on(a) && self.is_on(b);
            }
        }
    }

    fn is_on(&self, lit: Lit) -> bool {
        self.values[lit.node()] != lit.is_inverted()
    }

    /// Inputs with which a scan from this state keeps all assumptions; else the assumption that none keeps, if the
    /// solver knows.
    fn continued(&mut self, latches: &[bool]) -> Result<Vec<bool>, Option<Broken>> {
        let state = self.latches.iter().zip(latches);
        let mut known: Vec<SatLit> = state
            .map(|(&lit, &on)| if on { lit } else { !lit })
            .collect();
        known.extend(self.always.iter().map(|(_, lit)| *lit));
        let all = self.assumed.iter().map(|(.., lit)| *lit);
        let all: Vec<SatLit> = known.iter().copied().chain(all).collect();
        match self.solver.solve(&all) {
            Answer::Sat => {
                let inputs = self.system.inputs.iter();
                Ok(inputs.map(|(lit, _)| self.solver.value(*lit)).collect())
            }
            Answer::Unknown => Err(None),
            Answer::Unsat => {
                for at in 0..self.assumed.len() {
                    let (what, _, lit) = self.assumed[at];
                    let one: Vec<SatLit> = known.iter().copied().chain([lit]).collect();
                    if self.solver.solve(&one) == Answer::Unsat {
                        return Err(Some(what));
                    }
                }
                Err(Some(Broken::Together))
            }
        }
    }

    fn elapsed(&self, inputs: &[bool]) -> u64 {
        let inputs = self.system.inputs.iter().zip(inputs);
        let parts = inputs.map(|((_, input), &on)| match *input {
            Input::Time(digit, bit) if on => u64::from(digit.milliseconds()) << bit,
            _ => 0,
        });
        parts.sum()
    }
}
