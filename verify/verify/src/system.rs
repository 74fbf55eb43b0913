//! Transition systems: what a scan makes of the state before it and of its inputs, bit by bit.

use crate::aig::{Aig, Lit, Node};
use crate::lag::Lag;
use crate::model::{Input, Key};
use rustc_hash::{FxHashMap, FxHashSet};

/// A bit that lasts from scan to scan.
#[derive(Clone, Debug)]
pub struct Latch {
    /// The bit before the scan, an input of the graph.
    pub now: Lit,
    /// The bit after it.
    pub next: Lit,
    /// Initial value; `None`: any value.
    pub init: Option<bool>,
    /// The bit of the memory that it is.
    pub key: Key,
    /// Number of the bit.
    pub bit: usize,
}

/// A system with one question: whether `bad` can be on after a scan.
#[derive(Clone, Debug)]
pub struct System {
    /// The logic.
    pub aig: Aig,
    /// The state.
    pub latches: Vec<Latch>,
    /// The inputs of each scan, with what they are.
    pub inputs: Vec<(Lit, Input)>,
    /// Conditions that hold in every scan.
    pub constraints: Vec<Lit>,
    /// Additional assumptions for a counterexample, so that it can be replayed.
    pub replay_assumptions: Vec<Lit>,
    /// The same, of the first scan.
    pub first_replay_assumptions: Vec<Lit>,
    /// Relations between clocks and timers that may hold in all runs.
    pub lags: Vec<Lag>,
    /// Event that must not happen.
    pub bad: Lit,
}

impl System {
    /// The part that the answer depends on: the cone of influence of `bad`. A constraint or a wish stays if it meets
    /// the cone, and what it depends on belongs to the cone then.
    pub fn sliced(&self) -> System {
        self.about(self.bad)
    }

    /// The same with another question.
    pub fn about(&self, bad: Lit) -> System {
        self.keep(&self.cone(bad), bad)
    }

    /// The same with memory that may change between two scans.
    pub(crate) fn releasing(&self, released: impl Fn(Key) -> bool) -> System {
        let mut system = self.clone();
        system.latches.retain(|latch| !released(latch.key));
        let free = self.latches.iter().filter(|latch| released(latch.key));
        let free = free.map(|latch| (latch.now, Input::Device(latch.key, latch.bit)));
        system.inputs.extend(free);
        system.sliced()
    }

    /// Nodes that the answer to a question depends on.
    pub(crate) fn cone(&self, bad: Lit) -> Vec<bool> {
        let number_of = self.latch_numbers();
        let mut wanted = vec![false; self.aig.nodes().len()];
        let conditions: Vec<Lit> = self.conditions().collect();
        let mut kept = vec![false; conditions.len()];
        let mut open = vec![bad.node()];
        let supports: Vec<Vec<usize>> = conditions.iter().map(|&c| self.support(c)).collect();
        loop {
            while let Some(node) = open.pop() {
                if std::mem::replace(&mut wanted[node], true) {
                    continue;
                }
                if let Node::And(a, b) = self.aig.nodes()[node] {
                    open.extend([a.node(), b.node()]);
                }
                if let Some(&latch) = number_of.get(&node) {
                    open.push(self.latches[latch].next.node());
                }
            }
            for (i, support) in supports.iter().enumerate() {
                let meets = support.iter().any(|&node| wanted[node]);
                if !kept[i] && (meets || support.is_empty()) {
                    kept[i] = true;
                    open.push(conditions[i].node());
                }
            }
            if open.is_empty() {
                return wanted;
            }
        }
    }

    /// The constraints and the wishes.
    fn conditions(&self) -> impl Iterator<Item = Lit> {
        let replay_assumptions = self
            .replay_assumptions
            .iter()
            .chain(&self.first_replay_assumptions);
        self.constraints.iter().chain(replay_assumptions).copied()
    }

    /// The latches by their nodes.
    pub(crate) fn latch_numbers(&self) -> FxHashMap<usize, usize> {
        let latches = self.latches.iter().enumerate();
        latches.map(|(i, latch)| (latch.now.node(), i)).collect()
    }

    /// The inputs and latches on which a literal depends within a scan.
    fn support(&self, lit: Lit) -> Vec<usize> {
        let mut seen = FxHashSet::default();
        let mut open = vec![lit.node()];
        let mut found = Vec::new();
        while let Some(node) = open.pop() {
            if !seen.insert(node) {
                continue;
            }
            match self.aig.nodes()[node] {
                Node::And(a, b) => open.extend([a.node(), b.node()]),
                Node::Input(_) => found.push(node),
                Node::False => {}
            }
        }
        found
    }

    /// The wanted nodes, in a new graph.
    pub(crate) fn keep(&self, wanted: &[bool], bad: Lit) -> System {
        let mut aig = Aig::default();
        let mut map = vec![None; wanted.len()];
        map[0] = Some(Lit::FALSE);
        let new = |map: &[Option<Lit>], lit: Lit| -> Option<Lit> {
            map[lit.node()].map(|node: Lit| node.invert_if(lit.is_inverted()))
        };
        for (node, what) in self.aig.nodes().iter().enumerate() {
            if !wanted[node] {
                continue;
            }
            map[node] = match *what {
                Node::False => Some(Lit::FALSE),
                Node::Input(_) => Some(aig.input()),
                Node::And(a, b) => match (new(&map, a), new(&map, b)) {
                    (Some(a), Some(b)) => Some(aig.and(a, b)),
                    _ => None,
                },
            };
        }
        let lits = |lits: &[Lit]| lits.iter().filter_map(|&lit| new(&map, lit)).collect();
        let latch = |latch: &Latch| {
            let (now, next) = (new(&map, latch.now)?, new(&map, latch.next)?);
            Some(Latch {
                now,
                next,
                ..latch.clone()
            })
        };
        System {
            latches: self.latches.iter().filter_map(latch).collect(),
            inputs: self
                .inputs
                .iter()
                .filter_map(|&(lit, input)| Some((new(&map, lit)?, input)))
                .collect(),
            constraints: lits(&self.constraints),
            replay_assumptions: lits(&self.replay_assumptions),
            first_replay_assumptions: lits(&self.first_replay_assumptions),
            lags: self.lags.clone(),
            bad: new(&map, bad).unwrap_or(Lit::FALSE),
            aig,
        }
    }
}
