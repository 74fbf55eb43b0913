//! Proofs by invariants that are found step by step: IC3, or property-directed reachability (Bradley 2011; Eén,
//! Mishchenko and Brayton 2011).
//!
//! Frame `i` is a superset of the states that `i` scans can reach, as a set of cubes that cannot be reached so soon. A
//! state that would violate the property is blocked by showing that nothing in the frame before leads to it; if
//! something does, that is blocked first. When all cubes of a frame hold in the next one, too, the frame is an
//! invariant.

use crate::aig::Lit;
use crate::effort::Limit;
use crate::sat::{Answer, SatLit, Solver};
use crate::system::System;
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// States: latches by number with their values, in order.
pub(crate) type Cube = Vec<(usize, bool)>;

/// Result of the search.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Found {
    /// No reachable state is in one of these cubes, which includes all that can violate the property.
    Invariant(Vec<Cube>),
    /// A run violates the property.
    Violated,
    /// The limit is reached.
    TimeUp,
}

/// A cube that must be blocked at a level; the earliest first, of these the smallest.
type Obligation = Reverse<(usize, usize, Cube)>;

/// The search.
struct Pdr<'s> {
    system: &'s System,
    limit: Limit,
    /// One scan, with the constraints.
    solver: Solver,
    /// One scan without them, to find out on what a step depends.
    lifter: Solver,
    now: Vec<SatLit>,
    next: Vec<SatLit>,
    /// Latches by the variable of their next value.
    by_next: FxHashMap<SatLit, Vec<usize>>,
    bad: SatLit,
    /// Assumed for the cubes of each level; the first also for the state at the beginning.
    levels: Vec<SatLit>,
    /// The cubes of which this level is the highest.
    cubes: Vec<Vec<Cube>>,
    timed_out: bool,
}

/// Searches for an invariant.
pub fn search(system: &System, limit: &Limit) -> Found {
    let mut pdr = Pdr::new(system, limit);
    loop {
        match pdr.bad_state() {
            Some(cube) => {
                let top = pdr.levels.len() - 1;
                if !pdr.block(cube, top) {
                    return pdr.give_up(Found::Violated);
                }
            }
            None if pdr.timed_out => return Found::TimeUp,
            None => {
                pdr.add_level();
                if let Some(invariant) = pdr.propagate() {
                    return Found::Invariant(invariant);
                }
            }
        }
        if pdr.timed_out {
            return Found::TimeUp;
        }
    }
}

impl<'s> Pdr<'s> {
    fn new(system: &'s System, limit: &Limit) -> Self {
        let (mut solver, mut lifter) = (Solver::new(limit), Solver::new(limit));
        let lits = |solver: &mut Solver, of: &dyn Fn(&crate::system::Latch) -> Lit| {
            let latches = system.latches.iter();
            latches
                .map(|latch| solver.lit(&system.aig, of(latch)))
                .collect::<Vec<_>>()
        };
        let now = lits(&mut solver, &|latch| latch.now);
        let next = lits(&mut solver, &|latch| latch.next);
        for &holds in &system.constraints {
            let holds = solver.lit(&system.aig, holds);
            solver.clause(&[holds]);
        }
        let bad = solver.lit(&system.aig, system.bad);
        let start = solver.variable();
        for (latch, &now) in system.latches.iter().zip(&now) {
            if let Some(init) = latch.init {
                solver.clause(&[!start, if init { now } else { !now }]);
            }
        }
        lits(&mut lifter, &|latch| latch.next);
        let mut by_next: FxHashMap<SatLit, Vec<usize>> = FxHashMap::default();
        for (latch, &next) in next.iter().enumerate() {
            by_next.entry(next).or_default().push(latch);
            by_next.entry(!next).or_default().push(latch);
        }
        Pdr {
            system,
            limit: limit.clone(),
            solver,
            lifter,
            now,
            next,
            by_next,
            bad,
            levels: vec![start],
            cubes: vec![Vec::new()],
            timed_out: false,
        }
    }

    fn give_up(&self, found: Found) -> Found {
        match self.timed_out {
            true => Found::TimeUp,
            false => found,
        }
    }

    fn add_level(&mut self) {
        let level = self.solver.variable();
        self.levels.push(level);
        self.cubes.push(Vec::new());
    }

    fn solve(&mut self, assumed: &[SatLit]) -> Answer {
        let answer = self.solver.solve(assumed);
        self.timed_out |= answer == Answer::Unknown;
        answer
    }

    /// Assumptions about a state of a level.
    fn at(&self, level: usize) -> Vec<SatLit> {
        self.levels[level..].to_vec()
    }

    fn lit(lits: &[SatLit], &(latch, on): &(usize, bool)) -> SatLit {
        if on { lits[latch] } else { !lits[latch] }
    }

    /// A state of the last level from which a scan violates the property.
    fn bad_state(&mut self) -> Option<Cube> {
        let mut assumed = self.at(self.levels.len() - 1);
        assumed.push(self.bad);
        match self.solve(&assumed) {
            Answer::Sat => Some(self.lifted(&[self.system.bad])),
            Answer::Unsat | Answer::Unknown => None,
        }
    }

    /// The part of the state just found that makes these hold, and the constraints, with the inputs just found.
    fn lifted(&mut self, wanted: &[Lit]) -> Cube {
        let system = self.system;
        let act = self.lifter.variable();
        let mut refuted = vec![!act];
        for &lit in wanted.iter().chain(&system.constraints) {
            refuted.push(!self.lifter.lit(&system.aig, lit));
        }
        self.lifter.clause(&refuted);
        let mut assumed = vec![act];
        for &(input, _) in &system.inputs {
            let lit = input.invert_if(!self.solver.value(input));
            assumed.push(self.lifter.lit(&system.aig, lit));
        }
        let mut latches = FxHashMap::default();
        for (i, latch) in system.latches.iter().enumerate() {
            let on = self.solver.value(latch.now);
            let lit = self.lifter.lit(&system.aig, latch.now.invert_if(!on));
            latches.insert(lit, (i, on));
            assumed.push(lit);
        }
        let answer = self.lifter.solve(&assumed);
        let mut cube: Cube = match answer {
            Answer::Unsat => {
                let core = self.lifter.core().into_iter();
                core.filter_map(|lit| latches.get(&lit).copied()).collect()
            }
            Answer::Sat | Answer::Unknown => latches.into_values().collect(),
        };
        self.timed_out |= answer == Answer::Unknown;
        self.lifter.clause(&[!act]);
        cube.sort_unstable();
        cube
    }

    /// Returns true if no state of a cube is an initial one.
    fn excludes_start(&self, cube: &[(usize, bool)]) -> bool {
        cube.iter()
            .any(|&(latch, on)| self.system.latches[latch].init == Some(!on))
    }

    /// Blocks a cube at a level, and all that leads to it; whether that is possible.
    fn block(&mut self, cube: Cube, level: usize) -> bool {
        let mut open: BinaryHeap<Obligation> = BinaryHeap::new();
        open.push(Reverse((level, cube.len(), cube)));
        while let Some(Reverse((level, size, cube))) = open.pop() {
            if self.timed_out || level == 0 || !self.excludes_start(&cube) {
                return false;
            }
            if self.is_blocked(&cube, level) {
                continue;
            }
            match self.step_to(&cube, level) {
                Err(before) => {
                    open.push(Reverse((level, size, cube)));
                    open.push(Reverse((level - 1, before.len(), before)));
                }
                Ok(core) => {
                    let (general, reached) = self.generalised(core, level);
                    self.add(general, reached);
                    if reached + 1 < self.levels.len() {
                        open.push(Reverse((reached + 1, size, cube)));
                    }
                }
            }
        }
        !self.timed_out
    }

    /// Returns true if a level already excludes a cube.
    fn is_blocked(&self, cube: &[(usize, bool)], level: usize) -> bool {
        let known = self.cubes[level..].iter();
        self.limit.charge(known.clone().map(Vec::len).sum());
        let mut known = known.flatten();
        known.any(|known| known.iter().all(|lit| cube.binary_search(lit).is_ok()))
    }

    /// Searches for a state of the level before, outside the cube, that leads into it: returns (a part of) it, else the
    /// part of the cube that nothing leads into.
    fn step_to(&mut self, cube: &[(usize, bool)], level: usize) -> Result<Cube, Cube> {
        let act = self.solver.variable();
        let mut outside = vec![!act];
        outside.extend(cube.iter().map(|lit| !Self::lit(&self.now, lit)));
        self.solver.clause(&outside);
        let mut assumed = self.at(level - 1);
        assumed.push(act);
        assumed.extend(cube.iter().map(|lit| Self::lit(&self.next, lit)));
        let found = match self.solve(&assumed) {
            Answer::Sat => {
                let wanted: Vec<Lit> = cube
                    .iter()
                    .map(|&(latch, on)| self.system.latches[latch].next.invert_if(!on))
                    .collect();
                Err(self.lifted(&wanted))
            }
            Answer::Unsat => Ok(self.core_of(cube)),
            Answer::Unknown => Ok(cube.to_vec()),
        };
        self.solver.clause(&[!act]);
        found
    }

    /// The part of a cube that the solver needed, and enough more that no state to begin with is in it.
    fn core_of(&mut self, cube: &[(usize, bool)]) -> Cube {
        let core = self.solver.core();
        let mut needed = vec![false; self.system.latches.len()];
        for lit in core {
            for &latch in self.by_next.get(&lit).into_iter().flatten() {
                needed[latch] = true;
            }
        }
        let mut part: Cube = cube
            .iter()
            .copied()
            .filter(|(latch, _)| needed[*latch])
            .collect();
        if !self.excludes_start(&part) {
            let more = cube
                .iter()
                .find(|&&(latch, on)| self.system.latches[latch].init == Some(!on));
            part.extend(more);
            part.sort_unstable();
        }
        part
    }

    /// A larger cube that nothing leads into either, and the highest level at which that holds.
    fn generalised(&mut self, mut cube: Cube, level: usize) -> (Cube, usize) {
        let mut at = 0;
        while at < cube.len() && cube.len() > 1 && !self.timed_out {
            let mut smaller = cube.clone();
            smaller.remove(at);
            if self.excludes_start(&smaller)
                && let Ok(core) = self.step_to(&smaller, level)
                && !self.timed_out
            {
                // Literals that were tried before and still occur are needed.
                at = core
                    .iter()
                    .position(|lit| !cube[..at].contains(lit))
                    .unwrap_or(core.len());
                cube = core;
            } else {
                at += 1;
            }
        }
        let mut reached = level;
        while reached + 1 < self.levels.len() && !self.timed_out {
            match self.step_to(&cube, reached + 1) {
                Ok(_) if !self.timed_out => reached += 1,
                _ => break,
            }
        }
        (cube, reached)
    }

    /// No state of a level, nor of one before, is in the cube.
    fn add(&mut self, cube: Cube, level: usize) {
        let mut clause = vec![!self.levels[level]];
        clause.extend(cube.iter().map(|lit| !Self::lit(&self.now, lit)));
        self.solver.clause(&clause);
        let covers = |known: &Cube| cube.iter().all(|lit| known.binary_search(lit).is_ok());
        for known in &mut self.cubes[..=level] {
            known.retain(|known| !covers(known));
        }
        self.cubes[level].push(cube);
    }

    /// Moves cubes to the next level where they hold there, too; the invariant, if all of a level do.
    fn propagate(&mut self) -> Option<Vec<Cube>> {
        for level in 1..self.levels.len() - 1 {
            for cube in self.cubes[level].clone() {
                if self.timed_out {
                    return None;
                }
                let mut assumed = self.at(level);
                assumed.extend(cube.iter().map(|lit| Self::lit(&self.next, lit)));
                if self.solve(&assumed) == Answer::Unsat {
                    self.add(cube, level + 1);
                }
            }
            if self.cubes[level].is_empty() {
                let above = self.cubes[level + 1..].iter().flatten();
                return Some(above.cloned().collect());
            }
        }
        None
    }
}

/// Checks with a new solver that cubes are an invariant that excludes a violation.
pub fn check(system: &System, cubes: &[Cube], limit: &Limit) -> bool {
    let mut solver = Solver::new(limit);
    let aig = &system.aig;
    for &holds in &system.constraints {
        let holds = solver.lit(aig, holds);
        solver.clause(&[holds]);
    }
    let excluded = |cube: &Cube| {
        let init = |&(latch, on): &(usize, bool)| system.latches[latch].init == Some(!on);
        cube.iter().any(init)
    };
    for cube in cubes {
        let clause: Vec<SatLit> = cube
            .iter()
            .map(|&(latch, on)| solver.lit(aig, system.latches[latch].now.invert_if(on)))
            .collect();
        solver.clause(&clause);
    }
    let unreachable = |solver: &mut Solver, lits: &[Lit]| {
        let assumed: Vec<SatLit> = lits.iter().map(|&lit| solver.lit(aig, lit)).collect();
        solver.solve(&assumed) == Answer::Unsat
    };
    let next = |&(latch, on): &(usize, bool)| system.latches[latch].next.invert_if(!on);
    cubes.iter().all(excluded)
        && unreachable(&mut solver, &[system.bad])
        && cubes.iter().all(|cube| {
            let next: Vec<Lit> = cube.iter().map(next).collect();
            unreachable(&mut solver, &next)
        })
}
