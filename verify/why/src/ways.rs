//! Search for what a person can do so that a device changes.
//!
//! From the moment on, inputs and other [levers](crate::levers) are changed one after another, with as much time
//! between as things take to happen. Short courses that come [close](crate::needs) are continued first. What is found
//! has happened in the interpreter, and no action of it can be left out.

use crate::answer::{Action, How};
use crate::causes::whole;
use crate::explain::{Explainer, is_bit, state};
use crate::levers::{Cone, Lever, target};
use crate::needs::Needs;
use crate::words::on_off;
use rungc_interp::Machine;
use rungc_models::runs::is_special;
use rungc_rt::Plc as _;
use rungc_sim::record::hertz;
use rungc_sim::session::Moment;
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, DeviceClass, Phrase, phrase};
use rustc_hash::FxHashSet;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Usual effort of a search, in expressions of scans: some seconds at most.
const EFFORT: usize = 200_000_000;

/// Expressions that a scan costs beside its own.
const SCAN: usize = 100;

/// Number of moments that are kept.
const MOST_MOMENTS: usize = 4000;

/// Number of scans after a change until things settle, at most.
const SETTLED: u32 = 12;

/// Costs of waits of at most this many milliseconds: long ones are tried where short ones and other actions lead to
/// nothing.
const WAITS: [(u32, u64); 3] = [(3, 5_000), (12, 60_000), (25, 600_000)];

/// Milliseconds in which nothing changes, after which a wait leads to nothing: no timer has a longer unit.
const IDLE_MS: u64 = 1200;

/// Number of times that an input is switched on and off in one action.
const MOST_PULSES: u32 = 100;

/// Devices that change with an action, of which an answer names this many.
const MOST_CHANGES: usize = 3;

/// Cost of a change, and of a series of pulses. Levers cost more, the farther away they are.
const COSTS: (u32, u32) = (4, 9);

/// Cost of what a place lacks, in the units of an estimate.
const WEIGHT: u32 = 5;

/// Levers that are farther away than this cost no more.
const FARTHEST: u32 = 6;

/// What a search for what a person can do starts from.
pub struct HowOptions<'a> {
    /// Duration of a scan, in milliseconds; `None`: that which the program asks for, or 10.
    pub scan_ms: Option<u64>,
    /// Returns true for a device that something outside writes although the program does, too, such as a button of a
    /// panel.
    pub is_outside: &'a dyn Fn(Device) -> bool,
    /// Effort after which the search ends, in expressions that are executed: an ordinary computer does some tens of
    /// millions in a second.
    pub effort: usize,
}

impl Default for HowOptions<'_> {
    fn default() -> Self {
        HowOptions {
            scan_ms: None,
            is_outside: &|_| false,
            effort: EFFORT,
        }
    }
}

/// Something to try.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Attempt {
    /// A lever takes a value.
    Change(usize, i64),
    /// A lever is switched on and off until something other than numbers changes.
    Pulses(usize),
    /// Time passes until something is as it was not before, at most this many milliseconds.
    Wait(u64),
}

/// Something that was done.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Act {
    /// A lever took a value.
    Change(usize, i64),
    /// A lever was switched on and off this many times.
    Pulses(usize, u32),
    /// This many scans passed.
    Wait(u32),
}

/// Course of an action.
struct Course {
    /// The action, with what it was found to take.
    act: Act,
    /// The device has changed.
    reached: bool,
}

/// A moment that a course of actions leads to.
struct Place {
    moment: Moment,
    cost: u32,
    /// What it lacks, in the measure of costs.
    far: u32,
    from: Option<(usize, Act)>,
    reached: bool,
}

/// What is seen of a moment. Two with the same lead to the same.
#[derive(Clone, PartialEq, Eq, Hash)]
struct View {
    bits: Vec<bool>,
    words: Vec<i64>,
}

struct Search<'s, 'm> {
    session: &'s mut Session<'m>,
    scan_ms: Option<u64>,
    device: Device,
    wanted: bool,
    cone: Cone,
    /// Bits of the cone.
    bits: Vec<Device>,
    /// Registers of the cone, and values of counters.
    words: Vec<Target>,
    timers: Vec<Target>,
    /// True if something happens that devices do not show.
    is_busy: bool,
    needs: Needs,
    price: usize,
    spent: usize,
    effort: usize,
    seen: FxHashSet<View>,
}

impl Explainer<'_> {
    /// Searches for what a person can do from this moment on so that a bit device changes. Afterwards the session is as
    /// before.
    pub fn how(&self, session: &mut Session<'_>, device: Device, options: &HowOptions) -> How {
        let now = session.save();
        let blamed = self.roots(session, options.scan_ms, device).sets.concat();
        let cone = self.cone(session, (device, &blamed), options.is_outside);
        let wanted = !is_active(session.machine(), device);
        let mut how = How {
            on: wanted,
            pulses: self.sends_pulses(device),
            found: false,
            not_searched: match () {
                () if !is_bit(device) => Some(phrase!("a way is searched for bits alone")),
                () if !session.machine().sys().running => Some(phrase!("the PLC is in STOP")),
                () => None,
            },
            longest_wait_ms: WAITS.map(|(_, ms)| ms).into_iter().max().unwrap_or(0),
            actions: Vec::new(),
            levers: cone
                .levers
                .iter()
                .map(|lever| self.words.named(lever.device))
                .collect(),
            left_out: cone.left_out,
            moments: 0,
            is_whole: false,
        };
        if how.not_searched.is_some() {
            return how;
        }
        let levers = cone.levers.iter().map(|lever| lever.device);
        let needs = Needs::new(self, (device, wanted), levers);
        let mut search = Search::new(session, options, (device, wanted), (cone, needs));
        let found = search.course();
        how.moments = search.seen.len();
        how.is_whole = matches!(found, Ok(None)) && how.left_out == 0;
        if let Ok(Some(acts)) = found {
            let acts = search.without_needless(&now, acts);
            how.found = true;
            how.actions = search.described(&now, &acts, self);
        }
        search.session.restore(&now);
        how
    }
}

/// Effort or memory for a search is used up.
struct Limited;

impl<'s, 'm> Search<'s, 'm> {
    fn new(
        session: &'s mut Session<'m>,
        options: &HowOptions,
        (device, wanted): (Device, bool),
        (cone, needs): (Cone, Needs),
    ) -> Self {
        let ours = |device: &&Device| !is_special(device.class, device.number);
        let devices = || cone.levels.keys().filter(ours).copied();
        let of = |class: DeviceClass| devices().filter(move |device| device.class == class);
        let current = |device: Device| Target::Current(device.class, device.number);
        let words = devices().filter(|&device| !is_bit(device)).map(target);
        let words = words.chain(of(DeviceClass::C).map(current));
        let module = session.machine().module();
        let has_clocks = module.flags.iter().any(|flag| flag.period_ms.is_some());
        let is_busy = has_clocks || module.takes_time() || session.plant().is_some();
        Search {
            scan_ms: options.scan_ms,
            device,
            wanted,
            bits: devices().filter(|&device| is_bit(device)).collect(),
            words: words.collect(),
            timers: of(DeviceClass::T).map(current).collect(),
            is_busy,
            price: module.exprs.len() + SCAN,
            spent: 0,
            effort: options.effort,
            seen: FxHashSet::default(),
            session,
            cone,
            needs,
        }
    }

    /// A course of actions after which the device has changed; `None` if none of all has changed it.
    fn course(&mut self) -> Result<Option<Vec<Act>>, Limited> {
        let view = self.view();
        self.seen.insert(view);
        let mut places = vec![self.place(0, None, false)];
        // Each with its cost and what it lacks: a place, or something that is to be done there.
        let mut open = BinaryHeap::from([Reverse((0u32, 0usize, None))]);
        while let Some(Reverse((_, at, attempt))) = open.pop() {
            let place = &places[at];
            let Some((price, attempt)) = attempt else {
                if place.reached {
                    return Ok(Some(acts_to(&places, at)));
                }
                self.session.restore(&place.moment);
                for attempt in self.attempts() {
                    let cost = place.cost + attempt.0 + place.far;
                    open.push(Reverse((cost, at, Some(attempt))));
                }
                continue;
            };
            let cost = place.cost + price;
            self.session.restore(&place.moment);
            let course = self.attempt(attempt);
            if self.spent >= self.effort || places.len() >= MOST_MOMENTS {
                return Err(Limited);
            }
            let Some(course) = course else {
                continue;
            };
            let view = self.view();
            if self.seen.insert(view) || course.reached {
                let place = self.place(cost, Some((at, course.act)), course.reached);
                open.push(Reverse((cost + place.far, places.len(), None)));
                places.push(place);
            }
        }
        Ok(None)
    }

    /// The present moment as a place.
    fn place(&mut self, cost: u32, from: Option<(usize, Act)>, reached: bool) -> Place {
        let far = match reached {
            true => 0,
            false => {
                self.spent += self.needs.price();
                WEIGHT * self.needs.estimate(self.session.machine())
            }
        };
        Place {
            moment: self.session.save(),
            from,
            reached,
            cost,
            far,
        }
    }

    /// Actions that are tried now, with their prices.
    fn attempts(&self) -> Vec<(u32, Attempt)> {
        let (change, pulses) = COSTS;
        let waits = WAITS.iter().map(|&(cost, ms)| (cost, Attempt::Wait(ms)));
        let mut attempts: Vec<(u32, Attempt)> = waits.collect();
        for (n, lever) in self.cone.levers.iter().enumerate() {
            let far = lever.level.min(FARTHEST);
            let now = self.value(lever);
            let others = lever.values.iter().filter(|&&value| value != now);
            attempts.extend(others.map(|&value| (change + far, Attempt::Change(n, value))));
            if is_bit(lever.device) && now == 0 {
                attempts.push((pulses + far, Attempt::Pulses(n)));
            }
        }
        attempts
    }

    fn value(&self, lever: &Lever) -> i64 {
        match is_bit(lever.device) {
            true => state(self.session.machine(), lever.device).into(),
            false => whole(self.session, lever.target()).unwrap_or(0),
        }
    }

    /// Does something, until it comes to something; `None` if it does not.
    fn attempt(&mut self, attempt: Attempt) -> Option<Course> {
        let course = |act, reached| Some(Course { act, reached });
        match attempt {
            Attempt::Change(lever, value) => {
                self.set(lever, value)?;
                course(Act::Change(lever, value), self.settle())
            }
            Attempt::Wait(most_ms) => {
                let mut before = (self.view(), self.times());
                let began = self.session.now_ms();
                let mut changed = began;
                for scan in 1.. {
                    if self.scan() {
                        return course(Act::Wait(scan), true);
                    }
                    let now = (self.view(), self.times());
                    if !self.seen.contains(&now.0) {
                        return course(Act::Wait(scan), self.settle());
                    }
                    if now != before {
                        (before, changed) = (now, self.session.now_ms());
                    }
                    let is_idle = self.session.now_ms() - changed > IDLE_MS && !self.is_busy;
                    let is_late = self.session.now_ms() - began > most_ms;
                    if is_idle || is_late || self.spent >= self.effort {
                        return None;
                    }
                }
                None
            }
            Attempt::Pulses(lever) => {
                let begin = self.view();
                let mut first = None;
                for count in 1..=MOST_PULSES {
                    for value in [1, 0] {
                        self.set(lever, value)?;
                        if self.settle() {
                            return course(Act::Pulses(lever, count), true);
                        }
                    }
                    let now = self.view();
                    match &first {
                        // Something must count.
                        None if now.words == begin.words => return None,
                        None => first = Some(now),
                        Some(first) if first.bits != now.bits => {
                            return course(Act::Pulses(lever, count), false);
                        }
                        Some(_) if self.spent >= self.effort => return None,
                        Some(_) => {}
                    }
                }
                None
            }
        }
    }

    /// Repeats what was found. Returns true if the device changes in it.
    fn repeat(&mut self, act: Act) -> bool {
        match act {
            Act::Change(lever, value) => self.set(lever, value).is_some() && self.settle(),
            Act::Wait(scans) => (0..scans).any(|_| self.scan()) || self.settle(),
            Act::Pulses(lever, count) => (0..count).any(|_| {
                [1, 0]
                    .into_iter()
                    .any(|value| self.set(lever, value).is_some() && self.settle())
            }),
        }
    }

    fn set(&mut self, lever: usize, value: i64) -> Option<()> {
        self.session
            .set(self.cone.levers[lever].target(), value as f64)?;
        self.session.take_interrupts();
        Some(())
    }

    /// A scan, and the time until the next one. Returns true if the device has changed.
    fn scan(&mut self) -> bool {
        self.spent += self.price;
        let ms = self.session.scan_ms(self.scan_ms);
        self.session.scan(ms);
        let reached = self.is_reached();
        let ms = self.session.scan_ms(self.scan_ms);
        self.session.pass(ms);
        reached || self.is_reached()
    }

    fn is_reached(&self) -> bool {
        is_active(self.session.machine(), self.device) == self.wanted
    }

    /// Scans until nothing changes but times. Returns true if the device has changed.
    fn settle(&mut self) -> bool {
        let mut before = self.view();
        for _ in 0..SETTLED {
            if self.scan() {
                return true;
            }
            let now = self.view();
            if now == before {
                break;
            }
            before = now;
        }
        false
    }

    fn view(&self) -> View {
        let machine = self.session.machine();
        View {
            bits: self
                .bits
                .iter()
                .map(|&device| state(machine, device))
                .collect(),
            words: self.values(&self.words),
        }
    }

    fn times(&self) -> Vec<i64> {
        self.values(&self.timers)
    }

    fn values(&self, targets: &[Target]) -> Vec<i64> {
        targets
            .iter()
            .map(|&target| whole(self.session, target).unwrap_or(0))
            .collect()
    }

    /// The same course without actions that it does not need.
    fn without_needless(&mut self, now: &Moment, mut acts: Vec<Act>) -> Vec<Act> {
        let mut at = 0;
        while at < acts.len() {
            let mut fewer = acts.clone();
            fewer.remove(at);
            self.session.restore(now);
            match fewer.iter().position(|&act| self.repeat(act)) {
                Some(end) => {
                    fewer.truncate(end + 1);
                    (acts, at) = (fewer, 0);
                }
                None => at += 1,
            }
        }
        self.without_pulses(now, acts)
    }

    /// The same course with an input switched off where switching it on before adds nothing.
    fn without_pulses(&mut self, now: &Moment, mut acts: Vec<Act>) -> Vec<Act> {
        for at in 0..acts.len() {
            if let Act::Pulses(lever, 1) = acts[at] {
                let mut fewer = acts.clone();
                fewer[at] = Act::Change(lever, 0);
                self.session.restore(now);
                let end = fewer.iter().position(|&act| self.repeat(act));
                if end == Some(acts.len() - 1) {
                    acts = fewer;
                }
            }
        }
        acts
    }

    /// The course in words.
    fn described(&mut self, now: &Moment, acts: &[Act], explainer: &Explainer) -> Vec<Action> {
        self.session.restore(now);
        let mut actions: Vec<Action> = Vec::new();
        for &act in acts {
            let before = self.view();
            let began = self.session.now_ms();
            self.repeat(act);
            let lever = match act {
                Act::Change(lever, _) | Act::Pulses(lever, _) => {
                    Some(self.cone.levers[lever].device)
                }
                Act::Wait(_) => None,
            };
            let named = |device: Device, value: i64| match is_bit(device) {
                true => on_off(value != 0),
                false => value.to_string().into(),
            };
            let (value, times) = match act {
                Act::Change(_, value) => (lever.map(|lever| named(lever, value)), None),
                Act::Pulses(_, times) => (None, Some(times)),
                Act::Wait(_) => (None, None),
            };
            let takes_ms = self.session.now_ms() - began;
            let then = self.changes(&before, lever, explainer);
            if let (None, Some(last)) = (lever, actions.last_mut())
                && last.device.is_none()
            {
                last.takes_ms += takes_ms;
                last.then = then;
                continue;
            }
            actions.push(Action {
                device: lever.map(|device| device.to_string()),
                comment: lever.and_then(|device| explainer.words.comment(device)),
                value,
                times,
                takes_ms,
                then,
            });
        }
        actions
    }

    /// Devices that have changed, the nearest to the device first.
    fn changes(&self, before: &View, lever: Option<Device>, explainer: &Explainer) -> Vec<Phrase> {
        let after = self.view();
        let bits = self.bits.iter().zip(before.bits.iter().zip(&after.bits));
        let changed = bits.filter(|(_, (before, after))| before != after);
        let mut changed: Vec<(u32, Device, bool)> = changed
            .filter(|(device, _)| Some(**device) != lever && **device != self.device)
            .map(|(&device, (_, &on))| (self.cone.levels[&device], device, on))
            .collect();
        changed.sort();
        let sentence = |(_, device, on)| {
            let name = explainer.words.named(device);
            match on {
                true => phrase!("{name} comes on", name),
                false => phrase!("{name} goes off", name),
            }
        };
        changed
            .into_iter()
            .take(MOST_CHANGES)
            .map(sentence)
            .collect()
    }
}

/// Returns true if a device is on, or an output sends pulses.
fn is_active(machine: &Machine, device: Device) -> bool {
    let sends = device.class == DeviceClass::Y && hertz(machine, device.number) != 0.0;
    sends || state(machine, device)
}

/// The actions that lead to a place.
fn acts_to(places: &[Place], at: usize) -> Vec<Act> {
    let mut acts = Vec::new();
    let mut at = at;
    while let Some((before, act)) = places[at].from {
        acts.push(act);
        at = before;
    }
    acts.reverse();
    acts
}
