//! 64 runs at once with inputs by chance: what happens in one of them needs no proof that it never does.

use crate::aig::{Lit, Node};
use crate::model::{Digit, Input};
use crate::search::{Scan, Trace, with_sign};
use crate::system::System;
use rustc_hash::FxHashMap;

/// Random numbers, the same in every run of the program.
pub(crate) struct Chance(u64);

impl Chance {
    pub fn new() -> Self {
        Chance(0x9E37_79B9_7F4A_7C15)
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// One of the numbers below this.
    pub fn below(&mut self, end: u64) -> u64 {
        self.bits() % end
    }
}

/// Runs of a system, a bit of each in one word.
pub(crate) struct Lanes<'s> {
    system: &'s System,
    /// The value of each node in the scan.
    values: Vec<u64>,
    /// What each latch holds.
    latches: Vec<u64>,
    /// What each input holds.
    inputs: Vec<u64>,
    /// Runs that have kept all constraints.
    pub alive: u64,
    start: Vec<u64>,
    /// Inputs and milliseconds of each scan so far.
    scans: Vec<(u32, Vec<u64>)>,
}

impl<'s> Lanes<'s> {
    /// Runs that begin, with what may be anything by chance in half of them.
    pub fn new(system: &'s System, chance: &mut Chance) -> Self {
        let half = 0xFFFF_FFFF;
        let begin = |latch: &crate::system::Latch, chance: &mut Chance| match latch.init {
            Some(on) => u64::from(on).wrapping_neg(),
            None => chance.bits() & chance.bits() & half,
        };
        let latches: Vec<u64> = system
            .latches
            .iter()
            .map(|latch| begin(latch, chance))
            .collect();
        Lanes {
            system,
            values: vec![0; system.aig.nodes().len()],
            start: latches.clone(),
            latches,
            inputs: vec![0; system.inputs.len()],
            alive: u64::MAX,
            scans: Vec::new(),
        }
    }

    /// Executes a scan this long after the one before; devices that are inputs change by chance if `change`.
    pub fn scan(&mut self, ms: u32, change: bool, chance: &mut Chance) {
        let wide = chance.below(4) == 0;
        for ((_, input), held) in self.system.inputs.iter().zip(&mut self.inputs) {
            match *input {
                Input::Device(_, bit) if change => {
                    let few = chance.bits() & chance.bits();
                    // Numbers are small mostly.
                    *held = if bit < 4 || wide { *held ^ few } else { 0 };
                }
                Input::Device(..) => {}
                Input::Time(digit, bit) => {
                    let value = match digit {
                        Digit::Hundreds => ms / 100,
                        Digit::Tens => ms / 10 % 10,
                        Digit::Ones => ms % 10,
                    };
                    *held = u64::from(value >> bit & 1).wrapping_neg();
                }
                Input::ScanTime(_) => *held = 0,
                Input::Gap(_) => *held = chance.bits(),
            }
        }
        self.scans.push((ms, self.inputs.clone()));
        let inputs = self.system.inputs.iter().zip(&self.inputs);
        for ((lit, _), &held) in inputs {
            self.values[lit.node()] = held;
        }
        for (latch, &held) in self.system.latches.iter().zip(&self.latches) {
            self.values[latch.now.node()] = held;
        }
        for (node, what) in self.system.aig.nodes().iter().enumerate() {
            if let Node::And(a, b) = *what {
                self.values[node] = self.of(a) & self.of(b);
            }
        }
        for &holds in &self.system.constraints {
            self.alive &= self.of(holds);
        }
        self.latches = self
            .system
            .latches
            .iter()
            .map(|latch| self.of(latch.next))
            .collect();
    }

    /// What each latch holds after the last scan, in each run.
    pub fn latches(&self) -> &[u64] {
        &self.latches
    }

    fn of(&self, lit: Lit) -> u64 {
        self.values[lit.node()] ^ u64::from(lit.is_inverted()).wrapping_neg()
    }

    /// The runs in which a literal is on in the scan.
    pub fn value(&self, lit: Lit) -> u64 {
        self.of(lit) & self.alive
    }

    /// One of the runs.
    pub fn trace(&self, lane: u32) -> Trace {
        let on = |bits: u64| i64::from(bits >> lane & 1 == 1);
        let mut trace = Trace::default();
        for (latch, &bits) in self.system.latches.iter().zip(&self.start) {
            if latch.init.is_none() {
                *trace.start.entry(latch.key).or_default() |= on(bits) << latch.bit;
            }
        }
        for (ms, inputs) in &self.scans {
            let mut set: FxHashMap<_, i64> = FxHashMap::default();
            for ((_, input), &bits) in self.system.inputs.iter().zip(inputs) {
                if let Input::Device(key, bit) = *input {
                    *set.entry(key).or_default() |= on(bits) << bit;
                }
            }
            let mut scan = Scan {
                ms: *ms,
                scan_time: 0,
                set: set.into_iter().collect(),
            };
            scan.set.iter_mut().for_each(with_sign);
            trace.scans.push(scan);
        }
        trace.start.iter_mut().for_each(with_sign);
        trace
    }
}
