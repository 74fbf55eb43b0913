//! Search for a run in which something happens, by chance and on the interpreter alone.
//!
//! Runs continue from where others have come to: where a device had a value for the first time, which is the rarer the
//! fewer runs get there, and where what is searched for was closest.

use super::near::Levels;
use super::run::{Between, Goal, Moment, Rig, Run, State, Step};
use rungc_golden::operands::BUFFER_WORDS;
use rungc_golden::rng::Rng;
use rungc_ir::Module;
use rungc_models::runs::rt_class;
use rungc_rt::{Class, CmpOp, Plc};
use rungc_sim::property::{Condition, Devices, Number, Property, read};
use rungc_syntax::DeviceClass;
use rungc_verify::model::{CounterPart, Key, TimerPart, device_of};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

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
    /// True if the programs read the buffer memory of module 0.
    pub buffer: bool,
    /// True if input edges, time and interrupts matter between two scans.
    pub events: bool,
    /// Register with the length of a scan, if something else writes it.
    pub scan_register: Option<Key>,
}

impl Outside {
    /// Weight of a piece of memory: the larger, the fewer rungs lead from it to what is searched for.
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

/// Result of a search.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The run, if there is one.
    pub run: Option<Run>,
    /// Number of scans executed.
    pub scans: u64,
}

/// Searches a run of these programs in which it happens, over this many scans.
pub fn search(
    modules: &[&Module],
    goal: Goal,
    assumed: &[Condition],
    outside: &Outside,
    (seed, scans): (u64, u64),
) -> Found {
    let watched = watched(modules);
    let weights = watched.iter().map(|key| outside.weight(*key)).collect();
    let mut attack = Attack {
        rig: Rig::new(modules, goal, assumed),
        watched,
        weights,
        goal,
        outside,
        rng: Rng::new(seed),
        stretches: Vec::new(),
        places: Vec::new(),
        features: BTreeMap::new(),
        variety: Vec::new(),
        far: None,
        last: Vec::new(),
        closest: Vec::new(),
    };
    let mut found = Found::default();
    let end = Instant::now() + LIMIT;
    while found.scans < scans && found.run.is_none() && Instant::now() < end {
        (found.run, found.scans) = attack.stretch(found.scans);
    }
    found
}

/// Time limit of a search, for programs whose scans repeat very many instructions.
const LIMIT: Duration = Duration::from_secs(4);

/// Scans in a row with the same habits.
struct Stretch {
    /// Stretch that it continues, and after how many of its scans.
    from: Option<(usize, usize)>,
    start: Vec<(Key, i64)>,
    steps: Vec<Step>,
}

/// State from which runs continue.
struct Place<'c> {
    moment: Moment<'c>,
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

struct Attack<'m, 'c> {
    goal: Goal<'c>,
    outside: &'c Outside,
    rig: Rig<'m, 'c>,
    watched: Vec<Key>,
    /// Weight of each of the watched devices.
    weights: Vec<f64>,
    rng: Rng,
    stretches: Vec<Stretch>,
    places: Vec<Place<'c>>,
    features: BTreeMap<(usize, i64), Feature>,
    /// Number of features of each of the watched devices of each program.
    variety: Vec<u32>,
    /// Distance at power-on.
    far: Option<f64>,
    /// Last value of each of the watched devices of each program: what stays as it was adds nothing.
    last: Vec<i64>,
    /// The closest places with their distances, the closest first.
    closest: Vec<(f64, usize)>,
}

/// Number of places that are kept.
const PLACES: usize = 240;

/// Number of the closest places that are kept.
const CLOSEST: usize = 6;

/// Devices of each area that features look at.
const WATCHED: u32 = 48;

/// Scans between two changes of something outside, as powers of two.
const HABITS: [u32; 6] = [0, 1, 2, 3, 6, STAYS];

/// Habit of what does not change.
const STAYS: u32 = 20;

impl Attack<'_, '_> {
    /// Executes some scans; the run if it happens in one of them, and the scans so far.
    fn stretch(&mut self, before: u64) -> (Option<Run>, u64) {
        let mut levels = self.begin();
        let this = self.stretches.len() - 1;
        // Often little changes, so that times pass and sequences stay in order.
        let quiet = self.rng.pick(&[0, 50, 90]).unwrap_or(0);
        let mut habit = |key: &Key| {
            let quiet = match self.outside.weight(*key) > FAR {
                true => quiet,
                false => 90,
            };
            match self.rng.percent(quiet) {
                true => STAYS,
                false => self.rng.pick(&HABITS).unwrap_or(STAYS),
            }
        };
        let habits: Vec<u32> = self.outside.written.iter().map(&mut habit).collect();
        let most = self.outside.scan_ms;
        let times = [1, 10, 10, 100, most, most, 0];
        let time = self.rng.pick(&times).unwrap_or(10);
        let is_first = self.stretches[this].from.is_none();
        let length = 1u64 << (1 + self.rng.below(7));
        for n in 0..length {
            let Some(step) = self.step(&mut levels, &habits, time, is_first && n == 0) else {
                return (None, before + n + 1);
            };
            let state = self.rig.step(&step);
            self.stretches[this].steps.push(step);
            match state {
                State::Happened => return (Some(self.run(this)), before + n + 1),
                State::Over => return (None, before + n + 1),
                State::Lives => self.note(this, &levels),
            }
        }
        (None, before + length)
    }

    /// Begins a stretch, at power-on or where another one has come to; the values outside.
    fn begin(&mut self) -> Vec<i64> {
        let from = match self.rng.below(100) {
            0..15 => None,
            15..45 if !self.closest.is_empty() => {
                let near = self.rng.below(self.closest.len() as u32) as usize;
                self.closest.get(near).map(|(_, place)| *place)
            }
            _ => self.rare(),
        };
        let Some(place) = from else {
            let start = self.start();
            self.rig.begin(&start);
            self.stretches.push(Stretch {
                from: None,
                start,
                steps: Vec::new(),
            });
            return vec![0; self.outside.written.len()];
        };
        let place = &mut self.places[place];
        place.taken += 1;
        self.rig.restore(&place.moment);
        self.stretches.push(Stretch {
            from: Some(place.at),
            start: Vec::new(),
            steps: Vec::new(),
        });
        place.levels.clone()
    }

    /// Values of latched memory at power-on: none in half of the runs.
    fn start(&mut self) -> Vec<(Key, i64)> {
        if self.rng.percent(50) {
            return Vec::new();
        }
        let percent = self.rng.pick(&[10, 50, 90]).unwrap_or(50);
        let latched = self.outside.latched.iter();
        let chosen: Vec<Key> = latched
            .copied()
            .filter(|_| self.rng.percent(percent))
            .collect();
        chosen
            .into_iter()
            .map(|key| (key, self.value(key)))
            .collect()
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
        let device = draw(&mut self.rng, weighted)?;
        let of_device = (device, i64::MIN)..=(device, i64::MAX);
        let features = self.features.range(of_device).filter_map(|(_, feature)| {
            let place = feature.place?;
            let taken = self.places[place].taken;
            Some((
                place,
                1.0 / (f64::from(1 + taken) * f64::from(feature.seen)),
            ))
        });
        draw(&mut self.rng, features)
    }

    /// A value for a piece of memory.
    fn value(&mut self, key: Key) -> i64 {
        match bits(key) {
            1 => self.rng.below(2).into(),
            width => match self.rng.below(4) {
                0 => self.rng.value(width),
                _ => {
                    let near = i64::from(self.rng.below(3)) - 1;
                    let value = self.rng.pick(&self.outside.values).unwrap_or(0);
                    (value + near) << (64 - width) >> (64 - width)
                }
            },
        }
    }

    /// The next scan; `None` if the program asks for a longer time than there is.
    fn step(&mut self, levels: &mut [i64], habits: &[u32], time: u32, first: bool) -> Option<Step> {
        let power = self.outside.power && !first && self.rng.below(400) == 0;
        let stop = self.outside.stop && !first && !power && self.rng.below(100) == 0;
        let mut set = Vec::new();
        let mut edges = Vec::new();
        for (n, &key) in self.outside.written.iter().enumerate() {
            let seldom = 1 << habits[n];
            if first || habits[n] < STAYS && self.rng.below(seldom) == 0 {
                let value = match (key, first) {
                    (Key::Bit(..), false) => 1 - levels[n],
                    _ => self.value(key),
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
        if self.outside.buffer && self.rng.percent(30) {
            let address = self.rng.below(BUFFER_WORDS);
            set.push((Key::Buffer(0, address), self.rng.value(16)));
        }
        let most = self.outside.scan_ms;
        let set_length = set
            .iter()
            .find(|(key, _)| Some(*key) == self.outside.scan_register);
        let set_length = set_length.map_or(0, |(_, ms)| u32::try_from(*ms).unwrap_or(0));
        let least = self.rig.constant_scan_ms().max(set_length).max(1);
        if least > most && !first && !power && !stop {
            return None;
        }
        let ms = match (time, first || power) {
            (_, true) => 0,
            (0, _) => 1 + self.rng.below(most),
            (time, _) => time,
        };
        let ms = if first || power {
            0
        } else {
            ms.clamp(least, most)
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
            scan_us: self.rng.below(ms.min(40) + 1) * 1000,
        })
    }

    /// Events between two scans: edges of the inputs that change, some others, time, interrupts.
    fn events(&mut self, ms: u32, mut edges: Vec<Between>) -> Vec<Between> {
        let mut events = Vec::new();
        for _ in 0..self.rng.below(4) {
            events.push(Between::Edge(self.rng.below(8), self.rng.percent(50)));
        }
        events.append(&mut edges);
        let ticks = self.rng.below(ms.min(6) + 1);
        let mut times: Vec<u32> = (0..ticks).map(|_| self.rng.below(ms + 1)).collect();
        times.sort_unstable();
        for ms in times {
            let at = self.rng.below(events.len() as u32 + 1) as usize;
            let later = events.iter().rposition(|e| matches!(e, Between::Tick(_)));
            events.insert(at.max(later.map_or(0, |n| n + 1)), Between::Tick(ms));
            if self.rng.percent(70) {
                events.push(Between::Interrupts);
            }
        }
        events
    }

    /// Keeps the state as a place if it is a new one, or close to what is searched for.
    fn note(&mut self, stretch: usize, levels: &[i64]) {
        let mut is_new = false;
        let next = self.places.len();
        let count = self.watched.len();
        self.last.resize(count * self.rig.plants.len(), i64::MIN);
        self.variety.resize(self.last.len(), 0);
        for n in 0..count * self.rig.plants.len() {
            let plant = &self.rig.plants[n / count];
            let value = value_of(&plant.machine, self.watched[n % count]);
            let is_news = std::mem::replace(&mut self.last[n], value) != value;
            if !is_news {
                continue;
            }
            let value = alike(value);
            let feature = self.features.entry((n, value));
            let feature = feature.or_insert_with(|| {
                let limit = match self.weights[n % count] > FAR {
                    true => PLACES,
                    false => PLACES / 6,
                };
                is_new |= next < limit;
                self.variety[n] += 1;
                let place = (next < limit).then_some(next);
                Feature { seen: 0, place }
            });
            feature.seen = feature.seen.saturating_add(1);
        }
        let distance = distance(self.goal, &self.rig);
        let is_full = self.closest.len() == CLOSEST;
        let farthest = self.closest.last().filter(|_| is_full);
        let farthest = farthest.map_or(f64::MAX, |(far, _)| *far);
        let is_close = distance < farthest && distance < *self.far.get_or_insert(distance);
        if !is_new && !is_close || next >= PLACES {
            return;
        }
        self.places.push(Place {
            moment: self.rig.save(),
            at: (stretch, self.stretches[stretch].steps.len()),
            levels: levels.to_vec(),
            taken: 0,
        });
        if is_close {
            self.closest.push((distance, next));
            self.closest.sort_by(|a, b| a.0.total_cmp(&b.0));
            self.closest.truncate(CLOSEST);
        }
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
fn draw(rng: &mut Rng, weighted: impl Iterator<Item = (usize, f64)> + Clone) -> Option<usize> {
    let all: f64 = weighted.clone().map(|(_, weight)| weight).sum();
    let mut left = f64::from(rng.below(1 << 30)) / f64::from(1 << 30) * all;
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

/// The memory that features look at: some of each area that programs store.
fn watched(modules: &[&Module]) -> Vec<Key> {
    let mut keys = Vec::new();
    for area in modules.iter().flat_map(|module| &module.layout.areas) {
        for number in area.first..area.first + area.count.min(WATCHED) {
            use DeviceClass::{C, M, S, T, X, Y};
            match area.class {
                X => {}
                Y | M | S => keys.push(Key::Bit(area.class, number)),
                T => {
                    keys.extend([TimerPart::Done, TimerPart::Value].map(|p| Key::Timer(number, p)))
                }
                C => keys.extend(
                    [CounterPart::Done, CounterPart::Value].map(|p| Key::Counter(number, p)),
                ),
                _ => keys.push(Key::Word(area.class, number)),
            }
        }
    }
    keys.sort();
    keys.dedup();
    keys
}

/// Value of a piece of memory; 0 if the program does not store it.
pub fn value_of(machine: &impl Plc, key: Key) -> i64 {
    let found = match key {
        Key::Bit(class, number) => rt_class(class)
            .and_then(|class| machine.bit(class, number))
            .map(i64::from),
        Key::Word(class, number) => rt_class(class)
            .and_then(|class| machine.word(class, number))
            .map(i64::from),
        Key::Timer(number, TimerPart::Done) => machine.bit(Class::T, number).map(i64::from),
        Key::Timer(number, _) => machine.word(Class::T, number).map(i64::from),
        Key::Counter(number, CounterPart::Done) => machine.bit(Class::C, number).map(i64::from),
        Key::Counter(number, _) => {
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

/// Distance of a state from what is searched for: 0 is there, larger is farther.
fn distance(goal: Goal, rig: &Rig) -> f64 {
    let Some(plant) = rig.plants.first() else {
        return 0.0;
    };
    let of = |condition: &Condition, wanted: bool| far(condition, &plant.machine, wanted);
    match goal {
        Goal::Event(property) => match property {
            Property::Never(a) | Property::Reachable(a) => of(a, true),
            Property::Always(a) => of(a, false),
            Property::Whenever { when, then, .. } => of(when, true) + of(then, false),
            Property::Stays {
                after,
                holds,
                until,
            } => {
                let began = match after {
                    Some(after) => of(after, true) + of(holds, false),
                    None => of(holds, true).min(of(holds, false) + 0.5),
                };
                began + of(until, false)
            }
        },
        Goal::Differs(_) | Goal::Lives(_) => 0.0,
    }
}

/// Distance from a state in which a condition has a value: 1 for each bit, at most 1 for a comparison.
fn far(condition: &Condition, devices: &impl Devices, wanted: bool) -> f64 {
    match condition {
        Condition::Not(a) => far(a, devices, !wanted),
        Condition::And(a, b) | Condition::Or(a, b) => {
            let (a, b) = (far(a, devices, wanted), far(b, devices, wanted));
            match matches!(condition, Condition::And(..)) == wanted {
                true => a + b,
                false => a.min(b),
            }
        }
        Condition::Compare(op, a, b) if condition.holds(devices) != wanted => {
            let [Some(a), Some(b)] = [a, b].map(|number| match *number {
                Number::Constant(value) => Some(value),
                Number::Of(target) => Some(read(devices, target)),
                Number::Float(_) | Number::Was(_) | Number::Calc(_) => None,
            }) else {
                return 1.0;
            };
            let apart = f64::from(a.abs_diff(b));
            let apart = match op {
                CmpOp::Ne if wanted => 1.0,
                _ => apart + 1.0,
            };
            (apart.ln_1p() / 24.0).min(1.0)
        }
        _ => match condition.holds(devices) == wanted {
            true => 0.0,
            false => 1.0,
        },
    }
}
