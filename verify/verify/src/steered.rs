//! Search for a run in which something happens, by chance, on what executes programs: nothing has to be modelled.
//!
//! Runs continue from where others have come to: where a device had a value for the first time, which is the rarer the
//! fewer runs get there, and where what is searched for was closest. A stretch of a run lasts while it comes to
//! something new.

mod distance;
mod plant;

pub use distance::distance;
pub(crate) use plant::{Plant, Surroundings};

use crate::model::{CounterPart, Key, TimerPart, device_of};
use crate::random::Random;
use rungc_interp::rt_class;
use rungc_rt::{Class, Plc};
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;
use std::fmt;

/// Events of one scan.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Step {
    /// Power goes off and on first.
    pub power: bool,
    /// The PLC goes to STOP and back to RUN first.
    pub stop: bool,
    /// Events between the scan before and this one.
    pub between: Vec<Between>,
    /// Devices that something other than the program sets before the scan.
    pub set: Vec<(Key, i64)>,
    /// Milliseconds since the scan before.
    pub ms: u32,
    /// Duration of the scan before, in microseconds.
    pub scan_us: u32,
}

/// An event between two scans.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Between {
    /// Time advances to this many milliseconds after the scan before.
    Tick(u32),
    /// An input terminal turns on or off.
    Edge(u32, bool),
    /// Interrupt routines run.
    Interrupts,
    /// Something other than the program sets a device.
    Set(Key, i64),
    /// The PLC goes to STOP, in which it executes a scan of this many milliseconds.
    Stop(u32),
    /// It goes back to RUN.
    Run,
}

/// A run: what it begins with, and its scans.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Run {
    /// Latched memory with other values than at the first power-on.
    pub start: Vec<(Key, i64)>,
    /// The scans.
    pub steps: Vec<Step>,
}

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "begins with {:?}", self.start)?;
        let mut now = 0;
        let mut known = BTreeMap::new();
        for (n, step) in self.steps.iter().enumerate() {
            now = if step.power { 0 } else { now + step.ms };
            write!(f, "scan {} at {now} ms", n + 1)?;
            if step.power {
                write!(f, ", after power off and on")?;
            }
            if step.stop {
                write!(f, ", after STOP and RUN")?;
            }
            if !step.between.is_empty() {
                write!(f, ", after {:?}", step.between)?;
            }
            let mut set = step.set.clone();
            set.retain(|(key, value)| known.insert(*key, *value).unwrap_or(0) != *value);
            writeln!(f, ", scan time {} us: {set:?}", step.scan_us)?;
        }
        Ok(())
    }
}

/// State of a run after a scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum State {
    /// It continues.
    Lives,
    /// Nothing is claimed of what follows: an assumption is broken, or the PLC is not in RUN.
    Over,
    /// What is searched for has happened.
    Happened,
}

/// Programs that are executed side by side with the same events, and what is searched for.
pub trait Subject {
    /// State at one moment.
    type Moment;

    /// Goes to the first power-on, with these values in latched memory.
    fn begin(&mut self, start: &[(Key, i64)]);

    /// Executes a scan of each program.
    fn step(&mut self, step: &Step) -> State;

    /// State now.
    fn save(&self) -> Self::Moment;

    /// Comes back to a state.
    fn restore(&mut self, moment: &Self::Moment);

    /// The most milliseconds that a program asks for from this scan to the next.
    fn constant_scan_ms(&self) -> u32;

    /// Number of programs.
    fn programs(&self) -> usize;

    /// Value of a piece of memory of a program; 0 if the program does not store it.
    fn value(&self, program: usize, key: Key) -> i64;

    /// Distance from what is searched for: 0 is there, larger is farther.
    fn distance(&self) -> f64;
}

/// Distances of devices from what is searched for, in rungs or scans.
pub type Levels = BTreeMap<(DeviceClass, u32), u32>;

/// What may happen to programs, as far as a verdict is about it.
#[derive(Clone, Debug, Default)]
pub struct Outside {
    /// Memory that something other than the program writes.
    pub written: Vec<Key>,
    /// Memory with any value at power-on.
    pub latched: Vec<Key>,
    /// Values that numbers are likely to meet.
    pub values: Vec<i64>,
    /// Devices that lead to what is searched for; empty: all may.
    pub near: Levels,
    /// The most milliseconds from one scan to the next.
    pub scan_ms: u32,
    /// True if power may go off and on: latched memory begins with any value.
    pub power: bool,
    /// True if the PLC may go to STOP and back to RUN.
    pub stop: bool,
    /// Number of words of the buffer memory of module 0 that the programs read.
    pub buffer: u32,
    /// True if input edges, time and interrupts matter between two scans.
    pub events: bool,
    /// Register with the length of a scan, if something else writes it.
    pub scan_register: Option<Key>,
}

impl Outside {
    /// Weight of a piece of memory: the larger, the nearer it is to what is searched for.
    fn weight(&self, key: Key) -> f64 {
        if self.near.is_empty() {
            return 1.0;
        }
        let level = device_of(key).and_then(|device| self.near.get(&device));
        level.map_or(FAR, |level| 1.0 / f64::from(1 + level * level))
    }
}

/// Weight of memory from which nothing leads to what is searched for.
const FAR: f64 = 0.01;

/// Scans in a row with the same habits.
struct Stretch {
    /// Stretch that it continues, and after how many of its scans.
    from: Option<(usize, usize)>,
    start: Vec<(Key, i64)>,
    steps: Vec<Step>,
}

/// State from which runs continue.
struct Place<M> {
    moment: M,
    /// Stretch, and number of its scans.
    at: (usize, usize),
    /// Value of everything that is written from outside.
    levels: Vec<i64>,
    /// Number of times that a run has continued from here.
    taken: u32,
}

/// Feature of states: a device with a value, or with one of similar values.
struct Feature {
    seen: u32,
    /// The first place with it, if that is kept.
    place: Option<usize>,
}

/// A search. It continues where it was interrupted.
pub struct Steered<S: Subject> {
    subject: S,
    outside: Outside,
    watched: Vec<Key>,
    /// Weight of each of the watched devices.
    weights: Vec<f64>,
    random: Random,
    /// The most scans of a stretch.
    longest: u64,
    stretches: Vec<Stretch>,
    places: Vec<Place<S::Moment>>,
    features: BTreeMap<(usize, i64), Feature>,
    /// Number of features of each of the watched devices of each program.
    variety: Vec<u32>,
    /// Distance at power-on.
    far: Option<f64>,
    /// Last value of each of the watched devices of each program: what stays as it was adds nothing.
    last: Vec<i64>,
    /// The closest places with their distances, the closest first.
    closest: Vec<(f64, usize)>,
    /// Number of scans executed.
    scans: u64,
}

/// Number of places that are kept.
const PLACES: usize = 600;

/// Number of the closest places that are kept.
const CLOSEST: usize = 6;

/// Scans between two changes of something outside, as powers of two.
const HABITS: [u32; 6] = [0, 1, 2, 3, 6, STAYS];

/// Percentage of stretches in which power goes off or the PLC goes to STOP now and then. In the others, what is not
/// latched has time to come to something.
const INTERRUPTED: u64 = 25;

/// Habit of what does not change.
const STAYS: u32 = 20;

impl<S: Subject> Steered<S> {
    /// Before the first run. `watched` is the memory whose values say how far a run has come; a stretch has at most
    /// `longest` scans, a small part of those that the search is given.
    pub fn new(
        subject: S,
        outside: Outside,
        watched: Vec<Key>,
        (seed, longest): (u64, u64),
    ) -> Self {
        let count = watched.len() * subject.programs();
        Steered {
            weights: watched.iter().map(|key| outside.weight(*key)).collect(),
            subject,
            outside,
            watched,
            random: Random::seeded(seed),
            longest,
            stretches: Vec::new(),
            places: Vec::new(),
            features: BTreeMap::new(),
            variety: vec![0; count],
            far: None,
            last: vec![i64::MIN; count],
            closest: Vec::new(),
            scans: 0,
        }
    }

    /// Number of scans executed so far.
    pub fn scans(&self) -> u64 {
        self.scans
    }

    /// Continues until it happens, or `is_over` of the number of scans.
    pub fn search(&mut self, is_over: &dyn Fn(u64) -> bool) -> Option<Run> {
        while !is_over(self.scans) {
            let levels = self.begin();
            let found = self.stretch(levels, is_over);
            if found.is_some() {
                return found;
            }
            self.prune();
        }
        None
    }

    /// Drops the scans of the last stretch from which no run can continue.
    fn prune(&mut self) {
        let last = self.stretches.len() - 1;
        let place = self.places.last().filter(|place| place.at.0 == last);
        match place {
            Some(place) => self.stretches[last].steps.truncate(place.at.1),
            None => {
                self.stretches.pop();
            }
        }
    }

    /// Executes some scans; the run if it happens in one of them.
    fn stretch(&mut self, mut levels: Vec<i64>, is_over: &dyn Fn(u64) -> bool) -> Option<Run> {
        let this = self.stretches.len() - 1;
        let habits = self.habits();
        let most = self.outside.scan_ms;
        let times = [1, 10, 10, 100, most, most, 0];
        let time = self.random.pick(&times).unwrap_or(10);
        let interrupted = self.random.percent(INTERRUPTED);
        let is_first = self.stretches[this].from.is_none();
        let (mut n, mut end) = (0, 2u64 << self.random.below(7));
        while n < end && !is_over(self.scans) {
            let step = self.next(
                &mut levels,
                &habits,
                (time, interrupted),
                is_first && n == 0,
            )?;
            let state = self.subject.step(&step);
            self.scans += 1;
            self.stretches[this].steps.push(step);
            n += 1;
            match state {
                State::Happened => return Some(self.run(this)),
                State::Over => return None,
                State::Lives if self.note(this, &levels) => {
                    end = end.max(self.longest.min(2 * n));
                }
                State::Lives => {}
            }
        }
        None
    }

    /// Begins a stretch, at power-on or where another one has come to; the values outside.
    fn begin(&mut self) -> Vec<i64> {
        let from = match self.random.below(100) {
            0..15 => None,
            15..45 if !self.closest.is_empty() => {
                let near = self.random.below(self.closest.len() as u64) as usize;
                self.closest.get(near).map(|(_, place)| *place)
            }
            _ => self.rare(),
        };
        let Some(place) = from else {
            let start = self.start();
            self.subject.begin(&start);
            self.stretches.push(Stretch {
                from: None,
                start,
                steps: Vec::new(),
            });
            return vec![0; self.outside.written.len()];
        };
        let place = &mut self.places[place];
        place.taken += 1;
        self.subject.restore(&place.moment);
        self.stretches.push(Stretch {
            from: Some(place.at),
            start: Vec::new(),
            steps: Vec::new(),
        });
        place.levels.clone()
    }

    /// Frequencies at which each of the devices outside changes. Often little changes, so that times pass and sequences
    /// stay in order.
    fn habits(&mut self) -> Vec<u32> {
        let usual = self.random.pick(&[0, 50, 90]).unwrap_or(0);
        let (random, outside) = (&mut self.random, &self.outside);
        let habit = |key: &Key| {
            let quiet = match outside.weight(*key) > FAR {
                true => usual,
                false => 90,
            };
            match random.percent(quiet) {
                true => STAYS,
                false => random.pick(&HABITS).unwrap_or(STAYS),
            }
        };
        outside.written.iter().map(habit).collect()
    }

    /// Values of latched memory at power-on: none in half of the runs.
    fn start(&mut self) -> Vec<(Key, i64)> {
        if self.random.percent(50) {
            return Vec::new();
        }
        let percent = self.random.pick(&[10, 50, 90]).unwrap_or(50);
        let (random, latched) = (&mut self.random, self.outside.latched.iter());
        let mut chosen: Vec<Key> = latched.copied().collect();
        chosen.retain(|_| random.percent(percent));
        chosen.into_iter().map(|key| (key, self.any(key))).collect()
    }

    /// A place whose feature few scans have shown, and from which few runs have continued: first a device, then one of
    /// its features.
    fn rare(&mut self) -> Option<usize> {
        let count = self.weights.len().max(1);
        // What has never changed leads nowhere.
        let changed = self
            .variety
            .iter()
            .enumerate()
            .filter(|(_, variety)| **variety > 1);
        let weighted = changed.map(|(device, _)| (device, self.weights[device % count]));
        let device = draw(&mut self.random, weighted)?;
        let of_device = (device, i64::MIN)..=(device, i64::MAX);
        let features = self.features.range(of_device).filter_map(|(_, feature)| {
            let place = feature.place?;
            let taken = self.places[place].taken;
            Some((
                place,
                1.0 / (f64::from(1 + taken) * f64::from(feature.seen)),
            ))
        });
        draw(&mut self.random, features)
    }

    /// A value for a piece of memory.
    fn any(&mut self, key: Key) -> i64 {
        match bits(key) {
            1 => self.random.below(2) as i64,
            width => match self.random.below(4) {
                0 => self.random.value(width),
                _ => {
                    let near = self.random.below(3) as i64 - 1;
                    let value = self.random.pick(&self.outside.values).unwrap_or(0);
                    (value + near) << (64 - width) >> (64 - width)
                }
            },
        }
    }

    /// The next scan; `None` if the program asks for a longer time than there is.
    fn next(
        &mut self,
        levels: &mut [i64],
        habits: &[u32],
        (time, interrupted): (u32, bool),
        first: bool,
    ) -> Option<Step> {
        let interrupted = interrupted && !first;
        let power = self.outside.power && interrupted && self.random.below(100) == 0;
        let stop = self.outside.stop && interrupted && !power && self.random.below(25) == 0;
        let (set, edges) = self.changes(levels, habits, first);
        let most = self.outside.scan_ms;
        let set_length = set
            .iter()
            .find(|(key, _)| Some(*key) == self.outside.scan_register);
        let set_length = set_length.map_or(0, |(_, ms)| u32::try_from(*ms).unwrap_or(0));
        let least = self.subject.constant_scan_ms().max(set_length).max(1);
        if least > most && !first && !power && !stop {
            return None;
        }
        let ms = match (time, first || power) {
            (_, true) => 0,
            (0, _) => 1 + self.random.below(most.into()) as u32,
            (time, _) => time,
        };
        let ms = if first || power {
            0
        } else {
            ms.clamp(least.min(most), most)
        };
        let between = match self.outside.events && !first && !power {
            true => self.events(ms, edges),
            false => Vec::new(),
        };
        Some(Step {
            power,
            stop,
            between,
            set,
            ms,
            scan_us: self.random.below(u64::from(ms.min(40)) + 1) as u32 * 1000,
        })
    }

    /// Values of everything that is written from outside, and edges of terminals among the changes.
    fn changes(
        &mut self,
        levels: &mut [i64],
        habits: &[u32],
        first: bool,
    ) -> (Vec<(Key, i64)>, Vec<Between>) {
        let (mut set, mut edges) = (Vec::new(), Vec::new());
        for n in 0..self.outside.written.len() {
            let key = self.outside.written[n];
            if first || habits[n] < STAYS && self.random.below(1 << habits[n]) == 0 {
                let value = match (key, first) {
                    (Key::Bit(..), false) => 1 - levels[n],
                    _ => self.any(key),
                };
                if let Key::Bit(DeviceClass::X, number) = key
                    && value != levels[n]
                {
                    edges.push(Between::Edge(number, value != 0));
                }
                levels[n] = value;
            }
            set.push((key, levels[n]));
        }
        if self.outside.buffer > 0 && self.random.percent(30) {
            let address = self.random.below(self.outside.buffer.into()) as u32;
            set.push((Key::Buffer(0, address), self.random.value(16)));
        }
        (set, edges)
    }

    /// Events between two scans: edges of the inputs that change, some others, time, interrupts.
    fn events(&mut self, ms: u32, mut edges: Vec<Between>) -> Vec<Between> {
        let mut events = Vec::new();
        for _ in 0..self.random.below(4) {
            let input = self.random.below(8) as u32;
            events.push(Between::Edge(input, self.random.percent(50)));
        }
        events.append(&mut edges);
        let ticks = self.random.below(u64::from(ms.min(6)) + 1);
        let below = u64::from(ms) + 1;
        let mut times: Vec<u32> = (0..ticks)
            .map(|_| self.random.below(below) as u32)
            .collect();
        times.sort_unstable();
        for ms in times {
            let at = self.random.below(events.len() as u64 + 1) as usize;
            let later = events.iter().rposition(|e| matches!(e, Between::Tick(_)));
            events.insert(at.max(later.map_or(0, |n| n + 1)), Between::Tick(ms));
            if self.random.percent(70) {
                events.push(Between::Interrupts);
            }
        }
        events
    }

    /// Keeps the state as a place if it is a new one, or close to what is searched for. Returns true if what leads to
    /// that is new in it.
    fn note(&mut self, stretch: usize, levels: &[i64]) -> bool {
        let (mut is_new, mut is_progress) = (false, false);
        let next = self.places.len();
        let count = self.watched.len();
        for n in 0..self.last.len() {
            let value = self.subject.value(n / count, self.watched[n % count]);
            if std::mem::replace(&mut self.last[n], value) == value {
                continue;
            }
            let feature = self.features.entry((n, alike(value)));
            let feature = feature.or_insert_with(|| {
                let is_near = self.weights[n % count] > FAR;
                let limit = if is_near { PLACES } else { PLACES / 6 };
                is_new |= next < limit;
                is_progress |= is_near;
                self.variety[n] += 1;
                let place = (next < limit).then_some(next);
                Feature { seen: 0, place }
            });
            feature.seen = feature.seen.saturating_add(1);
        }
        let distance = self.subject.distance();
        let is_full = self.closest.len() == CLOSEST;
        let farthest = self.closest.last().filter(|_| is_full);
        let farthest = farthest.map_or(f64::MAX, |(far, _)| *far);
        let is_close = distance < farthest && distance < *self.far.get_or_insert(distance);
        if !is_new && !is_close || next >= PLACES {
            return is_progress;
        }
        self.places.push(Place {
            moment: self.subject.save(),
            at: (stretch, self.stretches[stretch].steps.len()),
            levels: levels.to_vec(),
            taken: 0,
        });
        if is_close {
            self.closest.push((distance, next));
            self.closest.sort_by(|a, b| a.0.total_cmp(&b.0));
            self.closest.truncate(CLOSEST);
        }
        is_progress
    }

    /// The run from power-on to the end of a stretch.
    fn run(&self, stretch: usize) -> Run {
        let mut parts = Vec::new();
        let mut at = (stretch, self.stretches[stretch].steps.len());
        loop {
            let part = &self.stretches[at.0];
            parts.push(&part.steps[..at.1]);
            match part.from {
                Some(from) => at = from,
                None => break,
            }
        }
        Run {
            start: self.stretches[at.0].start.clone(),
            steps: parts.into_iter().rev().flatten().cloned().collect(),
        }
    }
}

/// One of these, each as likely as its weight says.
fn draw(
    random: &mut Random,
    weighted: impl Iterator<Item = (usize, f64)> + Clone,
) -> Option<usize> {
    let all: f64 = weighted.clone().map(|(_, weight)| weight).sum();
    let mut left = random.fraction() * all;
    let mut last = None;
    for (one, weight) in weighted {
        last = Some(one);
        left -= weight;
        if left < 0.0 {
            break;
        }
    }
    last
}

/// Number of bits of memory that something else writes.
fn bits(key: Key) -> u32 {
    match key {
        Key::Bit(..) | Key::Timer(_, TimerPart::Done) | Key::Counter(_, CounterPart::Done) => 1,
        Key::Counter(200.., CounterPart::Value) => 32,
        _ => 16,
    }
}

/// Value of a piece of memory; 0 if the program does not store it, or if it is a part of a timer or counter that a PLC
/// does not show.
pub fn value_of(machine: &impl Plc, key: Key) -> i64 {
    let found = match key {
        Key::Bit(class, number) => rt_class(class)
            .and_then(|class| machine.bit(class, number))
            .map(i64::from),
        Key::Word(class, number) => rt_class(class)
            .and_then(|class| machine.word(class, number))
            .map(i64::from),
        Key::Timer(number, TimerPart::Done) => machine.bit(Class::T, number).map(i64::from),
        Key::Timer(number, TimerPart::Value) => machine.word(Class::T, number).map(i64::from),
        Key::Counter(number, CounterPart::Done) => machine.bit(Class::C, number).map(i64::from),
        Key::Counter(number, CounterPart::Value) => {
            let wide = machine.counter32(number).map(i64::from);
            wide.or_else(|| machine.word(Class::C, number).map(i64::from))
        }
        _ => None,
    };
    found.unwrap_or(0)
}

/// Values that count as one: small ones are exact, of others there are four from one power of two to the next.
fn alike(value: i64) -> i64 {
    match value.unsigned_abs() {
        0..16 => value,
        large => {
            let power = large.ilog2();
            let quarter = i64::try_from(large >> (power - 2)).unwrap_or(0) & 3;
            value.signum() * (i64::from(4 * power) + quarter)
        }
    }
}
