//! Random simulation, 64 runs at once: an event in one of them needs no proof that it never happens.

mod long;
mod rarity;

pub(crate) use long::LongRuns;

use crate::aig::{Lit, Node};
use crate::model::{Digit, Input, Key, TimerPart};
use crate::search::{Scan, Trace, with_sign};
use crate::system::System;
use rustc_hash::FxHashMap;

/// Nodes of logic that are evaluated, 64 runs at once, in a step of a search.
pub(crate) const EVALUATED: usize = 4;

/// Random numbers, the same in every run of the program.
pub(crate) struct Random(u64);

impl Random {
    pub fn new() -> Self {
        Random(0x9E37_79B9_7F4A_7C15)
    }

    /// A separate sequence for each seed.
    pub fn seeded(seed: u64) -> Self {
        // The state must not be 0.
        let state = seed.wrapping_mul(0xBF58_476D_1CE4_E5B9) ^ Self::new().0;
        let mut random = Random(state.max(1));
        for _ in 0..4 {
            random.bits();
        }
        random
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

    /// True this many times in a hundred.
    pub fn percent(&mut self, percent: u64) -> bool {
        self.below(100) < percent
    }

    /// One of these; `None` if there is none.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> Option<T> {
        let number = self.bits().checked_rem(from.len() as u64)?;
        from.get(number as usize).copied()
    }

    /// From 0 to less than 1.
    pub fn fraction(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A signed value of this many bits: small, at a border, or any.
    pub fn value(&mut self, bits: u32) -> i64 {
        let max = (1i64 << (bits - 1)) - 1;
        match self.below(8) {
            0..4 => self.below(20) as i64 - 4,
            4 => max - self.below(3) as i64,
            5 => self.below(3) as i64 - max - 1,
            _ => (self.bits() as i64) >> (64 - bits),
        }
    }
}

/// Runs of a system, a bit of each in one word.
pub(crate) struct Lanes<'s> {
    system: &'s System,
    /// The value of each node in the scan.
    values: Vec<u64>,
    /// Value of each latch.
    latches: Vec<u64>,
    /// Value of each input.
    inputs: Vec<u64>,
    /// Runs that have kept all constraints.
    pub alive: u64,
    start: Vec<u64>,
    /// Inputs and milliseconds of each scan so far.
    scans: Vec<(u32, Vec<u64>)>,
    /// Before which scan lanes continued from where others had come to, and from which.
    moves: Vec<(usize, [u8; 64])>,
}

impl<'s> Lanes<'s> {
    /// Runs that begin, with what may be anything by chance in half of them.
    pub fn new(system: &'s System, random: &mut Random) -> Self {
        let half = 0xFFFF_FFFF;
        let begin = |latch: &crate::system::Latch, random: &mut Random| {
            let Some(on) = latch.init else {
                let any = random.bits() & random.bits() & half;
                // A replay begins at 0, too.
                let from_0 = matches!(
                    latch.key,
                    Key::Now | Key::Minute | Key::Timer(_, TimerPart::Part)
                );
                return if from_0 { 0 } else { any };
            };
            u64::from(on).wrapping_neg()
        };
        let latches: Vec<u64> = system
            .latches
            .iter()
            .map(|latch| begin(latch, random))
            .collect();
        Lanes {
            system,
            values: vec![0; system.aig.nodes().len()],
            start: latches.clone(),
            latches,
            inputs: vec![0; system.inputs.len()],
            alive: u64::MAX,
            scans: Vec::new(),
            moves: Vec::new(),
        }
    }

    /// Executes a scan this long after the one before; devices that are inputs change by chance if `change`.
    pub fn scan(&mut self, ms: u32, change: bool, random: &mut Random) {
        let wide = random.below(4) == 0;
        for ((_, input), held) in self.system.inputs.iter().zip(&mut self.inputs) {
            match *input {
                Input::Device(_, bit) if change => {
                    let few = random.bits() & random.bits();
                    // Numbers are small mostly.
                    *held = if bit < 4 || wide { *held ^ few } else { 0 };
                }
                Input::Device(..) => {}
                Input::Time(digit, bit) => *held = part_of(ms, digit, bit),
                Input::ScanTime(_) | Input::Restart => *held = 0,
                Input::Shown(..) | Input::Gap(_) => *held = random.bits(),
            }
        }
        self.evaluate();
        self.end(ms);
    }

    /// Executes a scan this long after the one before; devices change as they are used to. Lanes in which that would
    /// break a constraint keep what they had.
    fn scan_by(&mut self, ms: u32, habits: &Habits, random: &mut Random) {
        let before = self.inputs.clone();
        let inputs = self.system.inputs.iter().zip(&mut self.inputs);
        for (((_, input), held), seldom) in inputs.zip(&habits.seldom) {
            match *input {
                Input::Device(..) => *held ^= seldom.changes(random),
                Input::Time(digit, bit) => *held = part_of(ms, digit, bit),
                Input::ScanTime(_) | Input::Restart => *held = 0,
                Input::Shown(..) | Input::Gap(_) => *held = random.bits() & habits.gaps,
            }
        }
        self.evaluate();
        let broken = !self.valid() & self.alive;
        if broken != 0 {
            let inputs = self.system.inputs.iter().zip(&mut self.inputs);
            for (((_, input), held), before) in inputs.zip(before) {
                if let Input::Device(..) = input {
                    *held = *held & !broken | before & broken;
                }
            }
            self.evaluate();
        }
        self.end(ms);
    }

    /// Finds out the value of each node.
    fn evaluate(&mut self) {
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
    }

    /// The lanes in which all constraints hold in the scan.
    fn valid(&self) -> u64 {
        let constraints = self.system.constraints.iter();
        constraints.fold(u64::MAX, |valid, &holds| valid & self.of(holds))
    }

    /// Ends the scan.
    fn end(&mut self, ms: u32) {
        self.scans.push((ms, self.inputs.clone()));
        self.alive &= self.valid();
        self.latches = self
            .system
            .latches
            .iter()
            .map(|latch| self.of(latch.next))
            .collect();
    }

    /// Value of each latch after the last scan, in each run.
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

    /// Lets each lane continue from where another one has come to.
    fn follow(&mut self, from: [u8; 64]) {
        let moved = |bits: &u64| {
            let lanes = from.iter().enumerate();
            lanes.fold(0, |all, (lane, &from)| all | (bits >> from & 1) << lane)
        };
        self.latches = self.latches.iter().map(moved).collect();
        self.inputs = self.inputs.iter().map(moved).collect();
        self.alive = moved(&self.alive);
        self.moves.push((self.scans.len(), from));
    }

    /// Lane that a lane was in each scan, and its initial lane.
    fn history(&self, mut lane: u32) -> (Vec<u32>, u32) {
        let mut lanes = vec![lane; self.scans.len()];
        let mut end = self.scans.len();
        for &(scan, ref from) in self.moves.iter().rev() {
            lanes[scan..end].fill(lane);
            end = scan;
            lane = from[lane as usize].into();
        }
        lanes[..end].fill(lane);
        (lanes, lane)
    }

    /// One of the runs.
    pub fn trace(&self, lane: u32) -> Trace {
        let on = |bits: u64, lane: u32| i64::from(bits >> lane & 1 == 1);
        let (lanes, first) = self.history(lane);
        let mut trace = Trace::default();
        for (latch, &bits) in self.system.latches.iter().zip(&self.start) {
            if latch.init.is_none() {
                *trace.start.entry(latch.key).or_default() |= on(bits, first) << latch.bit;
            }
        }
        for ((ms, inputs), lane) in self.scans.iter().zip(lanes) {
            let mut set: FxHashMap<_, i64> = FxHashMap::default();
            for ((_, input), &bits) in self.system.inputs.iter().zip(inputs) {
                if let Input::Device(key, bit) = *input {
                    *set.entry(key).or_default() |= on(bits, lane) << bit;
                }
            }
            let mut scan = Scan {
                ms: *ms,
                scan_time: 0,
                restart: false,
                set: set.into_iter().collect(),
            };
            scan.set.iter_mut().for_each(with_sign);
            trace.scans.push(scan);
        }
        trace.start.iter_mut().for_each(with_sign);
        trace
    }
}

/// A bit of a part of a time, in all lanes.
pub(crate) fn part_of(ms: u32, digit: Digit, bit: usize) -> u64 {
    let value = match digit {
        Digit::Hundreds => ms / 100,
        Digit::Tens => ms / 10 % 10,
        Digit::Ones => ms % 10,
    };
    u64::from(value >> bit & 1).wrapping_neg()
}

/// Frequencies at which an input changes: lanes by the power of two that is the number of scans from one change to the
/// next.
struct Seldom([u64; 5]);

impl Seldom {
    /// Powers of two: from a change in every scan to hardly one; lanes beyond the last keep what they have.
    const POWERS: [u32; 5] = [0, 1, 3, 6, 10];

    /// Each lane has one of the powers, or none.
    fn new(random: &mut Random) -> Self {
        let (mut left, mut lanes) = (u64::MAX, [0; 5]);
        for part in &mut lanes {
            *part = left & (random.bits() | random.bits() & random.bits());
            left &= !*part;
        }
        // The most frequent change differs from input to input.
        lanes.rotate_left(random.below(5) as usize);
        Seldom(lanes)
    }

    /// The lanes in which it changes now.
    fn changes(&self, random: &mut Random) -> u64 {
        let mut changes = 0;
        let (mut bits, mut power) = (u64::MAX, 0);
        for (lanes, wanted) in self.0.iter().zip(Self::POWERS) {
            while power < wanted && bits != 0 {
                bits &= random.bits();
                power += 1;
            }
            changes |= lanes & bits;
        }
        changes
    }
}

/// Behaviour of inputs for some time.
struct Habits {
    /// Of each input.
    seldom: Vec<Seldom>,
    /// The lanes in which what is not modelled is not 0.
    gaps: u64,
}

impl Habits {
    fn new(system: &System, random: &mut Random) -> Self {
        // Numbers are small mostly.
        let (small, wide) = (random.bits() & random.bits(), random.bits() & random.bits());
        let inputs = system.inputs.iter().map(|(_, input)| {
            let mut seldom = Seldom::new(random);
            let lanes = match input {
                Input::Device(_, 0) => u64::MAX,
                Input::Device(_, 1..4) => small | wide,
                _ => small & wide,
            };
            seldom.0.iter_mut().for_each(|part| *part &= lanes);
            seldom
        });
        Habits {
            seldom: inputs.collect(),
            gaps: random.bits() & random.bits(),
        }
    }
}
