//! Counterexamples on the interpreter: no run is reported that has not happened there.

use crate::effort::Limit;
use crate::model::device_of;
use crate::model::{CounterPart, Key, TimerPart};
use crate::search::{Scan, Trace};
use rungc_interp::{Machine, rt_class};
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::{Class, Plc, Program, Stop, VirtualHal};
use rungc_sim::property::{Condition, Monitor, Property, Reading, Watcher};
use rungc_sim::record::Seen;
use rungc_sim::session::{self, Session};
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;

/// Gives a piece of memory its value; whether a host can.
pub(crate) fn set(machine: &mut Machine, hal: &mut VirtualHal, key: Key, value: i64) -> bool {
    let done = match key {
        Key::Buffer(module, address) => hal.set_bfm(module.into(), address as u16, value as i16),
        Key::Bit(class, number) => {
            rt_class(class).and_then(|class| machine.set_bit(class, number, value != 0))
        }
        Key::Word(class, number) => {
            rt_class(class).and_then(|class| machine.set_word(class, number, value as i16))
        }
        Key::Timer(number, TimerPart::Value) => machine.set_word(Class::T, number, value as i16),
        Key::Timer(number, TimerPart::Done) => machine.set_bit(Class::T, number, value != 0),
        Key::Counter(number, CounterPart::Value) if machine.counter32(number).is_some() => {
            machine.set_counter32(number, value as i32)
        }
        Key::Counter(number, CounterPart::Value) => {
            machine.set_word(Class::C, number, value as i16)
        }
        Key::Counter(number, CounterPart::Done) => machine.set_bit(Class::C, number, value != 0),
        _ => None,
    };
    done.is_some()
}

/// Present value of a piece of memory that a host can set, but for buffer memory.
pub(crate) fn get(machine: &Machine, key: Key) -> Option<i64> {
    let bit = |class, number| machine.bit(class, number).map(i64::from);
    let word = |class, number| machine.word(class, number).map(i64::from);
    match key {
        Key::Bit(class, number) => bit(rt_class(class)?, number),
        Key::Word(class, number) => word(rt_class(class)?, number),
        Key::Timer(number, TimerPart::Value) => word(Class::T, number),
        Key::Timer(number, TimerPart::Done) => bit(Class::T, number),
        Key::Counter(number, CounterPart::Value) => {
            let value = machine.counter32(number).map(i64::from);
            value.or_else(|| word(Class::C, number))
        }
        Key::Counter(number, CounterPart::Done) => bit(Class::C, number),
        _ => None,
    }
}

/// Values of latched memory with which a program begins a trace. Of two programs, each has its own latched devices.
pub(crate) fn start(module: &Module, trace: &Trace) -> impl Iterator<Item = (Key, i64)> {
    let start = trace.start.iter().map(|(&key, &value)| (key, value));
    start.filter(|(key, _)| {
        device_of(*key).is_none_or(|(class, number)| module.is_latched(class, number))
    })
}

/// A program that is given a trace. It runs as test files and [`Session`] run it: inputs that change between two scans
/// have edges, and where the program takes the time between scans, that passes in milliseconds, with interrupts.
pub struct Run<'m> {
    session: Session<'m>,
    has_hardware: bool,
    /// True if something happens between two scans.
    takes_events: bool,
    first: bool,
}

/// State of a [`Run`] between two scans.
pub(crate) struct Moment {
    session: session::Moment,
    first: bool,
}

/// Settings of the same time in the order of test files, by names: edges of inputs find those before them.
pub(crate) fn in_order(set: &BTreeMap<Key, i64>) -> impl Iterator<Item = (Key, i64)> {
    use DeviceClass::{X, Y, Z};
    let part = |key: Key| match key {
        Key::Bit(X, _) => 1,
        Key::Bit(Y, _) | Key::Word(Z, _) => 2,
        _ => 0,
    };
    let all = (0..3).flat_map(move |n| set.iter().filter(move |(key, _)| part(**key) == n));
    all.map(|(&key, &value)| (key, value))
}

/// Milliseconds of STOP before a scan after which RUN begins: the shortest step of a test.
pub(crate) const STOP_MS: u32 = 1;

/// Milliseconds from a scan to the STOP or the scan after it. STOP takes some of the time, and a scan before it, too.
pub(crate) fn until_next_ms(next: &Scan) -> u32 {
    match next.restart {
        true => next.ms.saturating_sub(STOP_MS).max(1),
        false => next.ms,
    }
}

/// Returns true if a program uses the buffer memory of modules, ports or pulses, so that what is around the PLC
/// remembers something.
pub fn has_hardware(module: &Module) -> bool {
    let mut uses_hal = module.has_ports() || module.sends_pulses() || module.takes_events();
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            uses_hal |= match stmt {
                Stmt::Do(Action::Call(call)) => call.function.needs().hal,
                Stmt::Do(action) => matches!(action, Action::Fetch(_) | Action::Send(_)),
                _ => false,
            };
        });
    }
    uses_hal
}

impl<'m> Run<'m> {
    /// Before the first scan of a trace.
    pub fn new(module: &'m Module, trace: &Trace) -> Self {
        let mut run = Run {
            session: Session::new(module, VirtualHal::new()),
            has_hardware: has_hardware(module),
            takes_events: module.takes_events() || module.takes_time(),
            first: true,
        };
        run.begin_with(start(module, trace));
        run
    }

    /// The program.
    pub fn machine(&self) -> &Machine<'m> {
        self.session.machine()
    }

    /// Gives latched memory its initial values.
    pub(crate) fn begin_with(&mut self, start: impl Iterator<Item = (Key, i64)>) {
        let (machine, hal) = self.session.parts();
        for (key, value) in start {
            set(machine, hal, key, value);
        }
    }

    /// State now, without what is around a program that uses none of it.
    pub(crate) fn save(&self) -> Moment {
        Moment {
            session: match self.has_hardware {
                true => self.session.save(),
                false => self.session.save_without_hardware(),
            },
            first: self.first,
        }
    }

    /// Comes back to a state.
    pub(crate) fn restore(&mut self, moment: &Moment) {
        self.session.restore(&moment.session);
        self.first = moment.first;
    }

    /// Returns true if a scan begins before the program lets it: it asks for scans of constant length (M8039).
    pub fn is_early(&self, scan: &Scan) -> bool {
        let least = self.machine().constant_scan_ms().unwrap_or(0);
        !self.first && !scan.restart && scan.ms < least.into()
    }

    /// Executes a scan; the milliseconds since the one before, unless the program stops.
    pub fn scan(&mut self, scan: &Scan) -> Option<u32> {
        self.begin(scan);
        self.execute(scan)
    }

    /// Lets the time before the scan pass, with STOP at its end and RUN, if the scan begins so.
    fn begin(&mut self, scan: &Scan) {
        self.pass(until_next_ms(scan));
        if scan.restart {
            self.session.set_running(false);
            self.session.scan(STOP_MS.into());
            self.pass(STOP_MS);
            self.session.set_running(true);
            self.first = true;
        }
    }

    /// Lets time pass.
    fn pass(&mut self, ms: u32) {
        match self.takes_events {
            true => self.session.pass(ms.into()),
            false => self.session.skip(ms.into()),
        }
    }

    fn execute(&mut self, scan: &Scan) -> Option<u32> {
        if self.takes_events {
            in_order(&scan.set).for_each(|(key, value)| self.set(key, value));
        } else {
            let (machine, hal) = self.session.parts();
            for (&key, &value) in &scan.set {
                set(machine, hal, key, value);
            }
        }
        self.session.scan_us(scan.scan_time * 100);
        let first = std::mem::take(&mut self.first);
        let stops = self.machine().last_error().stop != Stop::No;
        (!stops).then_some(if first { 0 } else { scan.ms })
    }

    /// Sets a piece of memory before a scan; an input has an edge.
    fn set(&mut self, key: Key, value: i64) {
        if let Key::Bit(DeviceClass::X, number) = key {
            // What the model does not have is not set.
            let _ = self.session.set_input(number, value != 0);
        } else {
            let (machine, hal) = self.session.parts();
            set(machine, hal, key, value);
        }
    }

    /// The program as it is after the last scan.
    pub fn seen(&self) -> Seen<'_> {
        self.session.seen()
    }
}

/// Steps of a millisecond between two scans that passes by itself.
pub(crate) const MILLISECOND: usize = 4;

/// Steps of a run, for the limit of a search.
pub(crate) fn steps(module: &Module, trace: &Trace) -> usize {
    let scans = trace.scans.len() * module.exprs.len();
    if !module.takes_time() {
        return scans;
    }
    let ms: u64 = trace.scans.iter().map(|scan| u64::from(scan.ms)).sum();
    scans
        + usize::try_from(ms)
            .unwrap_or(usize::MAX)
            .saturating_mul(MILLISECOND)
}

/// Runs a trace; after how many of its scans what is searched for has happened, with all assumptions kept until then.
pub fn replay(
    module: &Module,
    property: &Property,
    assumed: &[Condition],
    trace: &Trace,
) -> Option<usize> {
    let mut run = Run::new(module, trace);
    let (mut watcher, mut monitor) = (Watcher::new(property), Monitor::new(assumed));
    for (n, scan) in trace.scans.iter().enumerate() {
        if run.is_early(scan) {
            return None;
        }
        if scan.restart {
            (watcher, monitor) = (Watcher::new(property), Monitor::new(assumed));
        }
        let elapsed = run.scan(scan)?;
        if !monitor.all_hold(run.machine(), elapsed) {
            return None;
        }
        if watcher.happened(run.machine(), elapsed) {
            return Some(n + 1);
        }
    }
    None
}

/// The most scans of a run that is stretched.
const STRETCHED: u32 = 20_000;

/// The same run with more scans, none later than this after the one before: what is set stays as it is meanwhile.
/// `None` if that takes too many scans.
pub(crate) fn stretched(trace: &Trace, most_ms: u32) -> Option<Trace> {
    let most_ms = most_ms.max(1);
    let mut all = trace.scans.iter().map(|scan| scan.ms / most_ms);
    all.try_fold(0, |all: u32, scans| {
        all.checked_add(scans).filter(|all| *all <= STRETCHED)
    })?;
    let mut scans: Vec<Scan> = Vec::new();
    for scan in &trace.scans {
        let mut scan = scan.clone();
        while let Some(last) = scans.last()
            && scan.ms > most_ms
        {
            let meanwhile = Scan {
                ms: most_ms,
                restart: false,
                ..last.clone()
            };
            scan.ms -= most_ms;
            scans.push(meanwhile);
        }
        scans.push(scan);
    }
    Some(Trace {
        start: trace.start.clone(),
        scans,
    })
}

/// Values of a run that are copied in a step of effort.
const COPIED: usize = 4;

/// Runs of more scans than this are not simplified scan by scan.
const SIMPLIFIED: usize = 150;

/// The same run without scans that it does not need, the longer stretches first, as far as the limit goes.
pub fn shortened(
    happens: &dyn Fn(&Trace) -> Option<usize>,
    mut trace: Trace,
    limit: &Limit,
) -> Trace {
    if let Some(scans) = happens(&trace) {
        trace.scans.truncate(scans);
    }
    let mut length = trace.scans.len() / 2;
    while length > 0 {
        // The first scan stays the first.
        let mut at = 1;
        while at < trace.scans.len() {
            if limit.is_over() {
                return trace;
            }
            let mut other = trace.clone();
            other.scans.drain(at..(at + length).min(trace.scans.len()));
            match happens(&other) {
                Some(scans) => {
                    other.scans.truncate(scans);
                    trace = other;
                }
                None => at += length,
            }
        }
        length /= 2;
    }
    trace
}

/// The same run with what does not matter left out: inputs that stay off, changes that come later, times that are
/// ordinary, but not above `most_ms` from one scan to the next. `happens` runs one, and says after how many scans it
/// does what it is about. When the limit is reached, the rest stays.
pub fn plain(
    happens: &dyn Fn(&Trace) -> Option<usize>,
    most_ms: u32,
    mut trace: Trace,
    limit: &Limit,
) -> Trace {
    if let Some(scans) = happens(&trace) {
        trace.scans.truncate(scans);
    }
    let attempts = Attempts { happens, limit };
    /// A scan time that people expect.
    const USUAL_MS: u32 = 10;
    let usual_ms = USUAL_MS.min(most_ms);
    if trace.scans.iter().skip(1).any(|scan| scan.ms != usual_ms) {
        attempts.change(&mut trace, &|trace| {
            let later = trace.scans.iter_mut().skip(1);
            later.for_each(|scan| scan.ms = usual_ms);
        });
    }
    let on = trace.start.iter().filter(|(_, value)| **value != 0);
    for key in on.map(|(key, _)| *key).collect::<Vec<_>>() {
        attempts.change(&mut trace, &|trace| {
            trace.start.insert(key, 0);
        });
    }
    let steps = match trace.scans.len() {
        // Only what is the same in all of the run.
        more if more > SIMPLIFIED => 1,
        all => all,
    };
    for at in 0..steps {
        if trace.scans[at].scan_time != 0 {
            attempts.change(&mut trace, &|trace| trace.scans[at].scan_time = 0);
        }
        if trace.scans[at].restart {
            attempts.change(&mut trace, &|trace| trace.scans[at].restart = false);
        }
        if at > 0 && trace.scans[at].ms != usual_ms {
            attempts.change(&mut trace, &|trace| trace.scans[at].ms = usual_ms);
        }
        for key in trace.scans[at].set.keys().copied().collect::<Vec<_>>() {
            if limit.is_over() {
                return trace;
            }
            attempts.settle(&mut trace, at, key);
        }
    }
    trace
}

/// Changes of a run that are tried. A copy costs as much as it has values, which is much where a panel writes thousands
/// of registers: no change is tried that changes nothing, and the limit counts the others.
struct Attempts<'a> {
    happens: &'a dyn Fn(&Trace) -> Option<usize>,
    limit: &'a Limit,
}

impl Attempts<'_> {
    /// Changes a run, if it still does what it is about.
    fn change(&self, trace: &mut Trace, change: &dyn Fn(&mut Trace)) {
        let values: usize = trace.scans.iter().map(|scan| scan.set.len()).sum();
        self.limit.charge(values / COPIED);
        if self.limit.is_over() {
            return;
        }
        let mut other = trace.clone();
        change(&mut other);
        if (self.happens)(&other) == Some(other.scans.len()) {
            *trace = other;
        }
    }

    /// Leaves a device off from a scan on, or in this scan, or as it was in the scan before.
    fn settle(&self, trace: &mut Trace, at: usize, key: Key) {
        let is_off = |scan: &Scan| scan.set.get(&key) == Some(&0);
        if !trace.scans[at..].iter().all(is_off) {
            self.change(trace, &|trace| {
                trace.scans[at..].iter_mut().for_each(|scan| {
                    scan.set.insert(key, 0);
                });
            });
        }
        if !is_off(&trace.scans[at]) {
            self.change(trace, &|trace| {
                trace.scans[at].set.insert(key, 0);
            });
        }
        let before = at.checked_sub(1);
        let before = before.and_then(|before| trace.scans[before].set.get(&key));
        let before = before.copied().unwrap_or(0);
        if trace.scans[at].set.get(&key) != Some(&before) {
            self.change(trace, &|trace| {
                trace.scans[at].set.insert(key, before);
            });
        }
    }
}

/// A device with a name as test files have it, and its value.
pub type Setting = (String, (DeviceClass, u32), Reading);

/// Equal scans of a run.
#[derive(Clone, PartialEq, Debug)]
pub struct Change {
    /// Settings before the first scan of the run.
    pub start: Vec<Setting>,
    /// The first of the scans, from 0.
    pub first: usize,
    /// Number of scans.
    pub scans: usize,
    /// Start of the first, in milliseconds since power-on.
    pub at_ms: u64,
    /// The PLC was in STOP before the first.
    pub restart: bool,
    /// Milliseconds from each of them to the next scan.
    pub scan_ms: u32,
    /// Settings before the first of them.
    pub set: Vec<Setting>,
    /// Changes in the buffer memory of special modules: module, address, value.
    pub buffers: Vec<(u8, u32, i64)>,
    /// At the end of the run: what the property looks at.
    pub after: Vec<Setting>,
}

/// A run in words: equal scans together, with what the property looks at in the end.
pub fn story(module: &Module, property: &Property, trace: &Trace) -> Vec<Change> {
    let mut run = Run::new(module, trace);
    let named = |(&key, &value): (&Key, &i64)| Some((name(key)?, device_of(key)?, value.into()));
    let start = start(module, trace).filter(|(_, value)| *value != 0);
    let start: Vec<Setting> = start
        .filter_map(|(key, value)| named((&key, &value)))
        .collect();
    let mut changes: Vec<Change> = Vec::new();
    let mut known: BTreeMap<Key, i64> = BTreeMap::new();
    for (n, scan) in trace.scans.iter().enumerate() {
        let mut set_now = BTreeMap::new();
        run.begin(scan);
        for (&key, &value) in &scan.set {
            // What the program has overwritten is set again. A module is there as soon as its memory is set, if only
            // to 0.
            let before = get(run.machine(), key).or_else(|| known.get(&key).copied());
            known.insert(key, value);
            if before != Some(value) {
                set_now.insert(key, value);
            }
        }
        let at_ms = run.session.now_ms();
        run.execute(scan);
        const USUAL_MS: u32 = 10;
        let scan_ms = trace.scans.get(n + 1).map_or(USUAL_MS, until_next_ms);
        match changes.last_mut() {
            Some(last) if set_now.is_empty() && last.scan_ms == scan_ms && !scan.restart => {
                last.scans += 1;
            }
            _ => changes.push(Change {
                start: Vec::new(),
                first: n,
                scans: 1,
                at_ms,
                restart: scan.restart,
                scan_ms,
                set: set_now.iter().filter_map(named).collect(),
                buffers: set_now.iter().filter_map(in_buffer).collect(),
                after: Vec::new(),
            }),
        }
    }
    if let Some(first) = changes.first_mut() {
        first.start = start;
    }
    if let Some(last) = changes.last_mut() {
        last.after = property.values(run.machine());
    }
    changes
}

fn in_buffer((key, &value): (&Key, &i64)) -> Option<(u8, u32, i64)> {
    match *key {
        Key::Buffer(module, address) => Some((module, address, value)),
        _ => None,
    }
}

/// Name of a piece of memory in test files, if they can set it.
fn name(key: Key) -> Option<String> {
    let (class, number) = device_of(key)?;
    let device = class.number(number);
    Some(match key {
        Key::Timer(_, TimerPart::Value) | Key::Counter(_, CounterPart::Value) => {
            format!("{device}.value")
        }
        Key::Bit(..)
        | Key::Word(..)
        | Key::Timer(_, TimerPart::Done)
        | Key::Counter(_, CounterPart::Done) => device.to_string(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::plain;
    use crate::effort::{Limit, STEPS};
    use crate::model::Key;
    use crate::search::{Scan, Trace};
    use rungc_syntax::DeviceClass;
    use std::cell::Cell;
    use std::collections::BTreeMap;

    /// A run of 100 scans in which a panel writes as many registers, each in each scan.
    fn written(registers: u32) -> Trace {
        let key = |n| Key::Word(DeviceClass::D, n);
        let scan = |at: i64| Scan {
            ms: 10,
            set: (0..registers).map(|n| (key(n), at + 1)).collect(),
            ..Scan::default()
        };
        Trace {
            start: BTreeMap::new(),
            scans: (0..100).map(scan).collect(),
        }
    }

    #[test]
    fn runs_become_plain_within_the_limit() {
        let tried = Cell::new(0);
        let happens = |trace: &Trace| {
            tried.set(tried.get() + 1);
            Some(trace.scans.len())
        };
        let plain_of = |registers, limit| plain(&happens, 200, written(registers), &limit);
        let ms = |trace: &Trace| trace.scans.iter().all(|scan| scan.ms == 10);
        let few = plain_of(2, Limit::none());
        let values = few.scans.iter().flat_map(|scan| scan.set.values());
        assert!(values.copied().all(|value| value == 0) && ms(&few));
        // The first run, and a change of each register from the first scan on.
        assert_eq!(tried.replace(0), 3);
        // A copy of 500,000 values takes 125,000 steps, of which this limit has a few times as many.
        let limit = Limit::new(500_000 / STEPS, None);
        assert!(ms(&plain_of(5_000, limit)));
        assert!(tried.get() < 6, "{}", tried.get());
    }
}
