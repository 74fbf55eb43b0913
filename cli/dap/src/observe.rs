//! What stops a scan: breakpoints, which an observer of the interpreter checks before each place.

use crate::breakpoints::{DataPoint, Point};
use rungc_interp::{Machine, Observer, Saved};
use rungc_ir::node::Stmt;
use rungc_rt::{Plc, Program, Stop, VirtualHal};
use rungc_sim::record::{Reading, Seen};
use rungc_sim::{Target, set};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Object of a search in a scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Search {
    /// Nothing.
    Nothing,
    /// The place of this number.
    Place(u32),
    /// The last place.
    LastPlace,
    /// The first hit after a place; without one, the first of the scan.
    First(Option<u32>),
    /// The last hit before a place; without one, the last of the scan.
    Last(Option<u32>),
}

/// Reason for a stop.
#[derive(Clone, Debug)]
pub enum Why {
    /// The wanted place.
    Place,
    /// Breakpoints at an instruction, by their numbers.
    Points(Vec<i64>),
    /// Breakpoints on devices, and what has changed.
    Data(Vec<i64>, String),
    /// An error of the PLC: code, and step of the instruction.
    Error(u16, u32),
}

/// A stop.
#[derive(Clone)]
pub struct Hit {
    /// Number of the place in its scan; `None` after its end.
    pub place: Option<u32>,
    /// The instruction that is next.
    pub instr: usize,
    /// The reason.
    pub why: Why,
    /// The machine at the place.
    saved: Option<Saved>,
}

impl Hit {
    /// The machine at the place.
    pub fn take_saved(&mut self) -> Option<Saved> {
        self.saved.take()
    }
}

/// Breakpoints of a run.
#[derive(Default)]
pub struct Stops {
    /// At instructions.
    pub points: Vec<Point>,
    /// On devices.
    pub data: Vec<DataPoint>,
    /// Errors of the PLC.
    pub errors: bool,
}

impl Stops {
    /// Returns true if there is none.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() && self.data.is_empty() && !self.errors
    }
}

/// A scan that is observed.
struct Scan {
    /// Instructions by numbers of networks.
    marks: Arc<[usize]>,
    stops: Stops,
    search: Search,
    /// Devices that change at places of this scan.
    changes: Vec<(u32, Target, f64)>,
    /// Number of places so far.
    places: u32,
    /// Values of the devices with breakpoints at the last place.
    values: Vec<Option<Reading>>,
    /// Number of errors at the last place.
    errors: u64,
    /// Hardware for reading and setting devices that have none.
    hal: Box<VirtualHal>,
    hit: Option<Hit>,
    logged: Vec<String>,
}

/// Observes scans.
#[derive(Clone)]
pub struct Watch(Arc<Mutex<Scan>>);

/// Result of a search in a scan.
pub struct Scanned {
    /// The stop that was looked for.
    pub hit: Option<Hit>,
    /// Messages of breakpoints.
    pub logged: Vec<String>,
}

impl Watch {
    /// An observer of a program whose networks have these instructions.
    pub fn new(marks: &[usize]) -> Self {
        Watch(Arc::new(Mutex::new(Scan {
            marks: marks.into(),
            stops: Stops::default(),
            search: Search::Nothing,
            changes: Vec::new(),
            places: 0,
            values: Vec::new(),
            errors: 0,
            hal: Box::new(VirtualHal::new()),
            hit: None,
            logged: Vec::new(),
        })))
    }

    fn scan(&self) -> MutexGuard<'_, Scan> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes what stops a run.
    pub fn set(&self, change: impl FnOnce(&mut Stops)) {
        change(&mut self.scan().stops);
    }

    /// Returns true if something stops a run.
    pub fn has_stops(&self) -> bool {
        !self.scan().stops.is_empty()
    }

    /// Begins to observe a scan.
    pub fn begin(&self, machine: &Machine, search: Search, changes: Vec<(u32, Target, f64)>) {
        let mut scan = self.scan();
        scan.search = search;
        scan.changes = changes;
        scan.places = 0;
        scan.hit = None;
        scan.values = scan.look(machine);
        scan.errors = errors(machine);
    }

    /// Ends it; `was_running` says whether the PLC was in RUN before.
    pub fn end(&self, machine: &Machine, was_running: bool) -> Scanned {
        let mut scan = self.scan();
        scan.at_end(machine, was_running);
        Scanned {
            hit: scan.hit.take(),
            logged: std::mem::take(&mut scan.logged),
        }
    }
}

impl Observer for Watch {
    fn intervene(&mut self, machine: &mut Machine, stmt: &Stmt) {
        let mut scan = self.scan();
        if scan.changes.is_empty() || scan.instr(stmt).is_none() {
            return;
        }
        let Scan {
            changes,
            places,
            hal,
            values,
            stops,
            ..
        } = &mut *scan;
        let mut has_changed = false;
        for (_, target, value) in changes.iter().filter(|change| change.0 == *places) {
            // It exists: that was looked at when the change was recorded.
            let _ = set(machine, hal, *target, *value);
            has_changed = true;
        }
        if has_changed {
            // What the user changes does not stop the run.
            *values = look(&stops.data, machine, hal);
        }
    }

    fn before(&mut self, machine: &Machine, stmt: &Stmt) {
        let mut scan = self.scan();
        if let Some(instr) = scan.instr(stmt) {
            scan.at(machine, instr);
            scan.places += 1;
        }
    }
}

/// Values of devices with breakpoints.
fn look(data: &[DataPoint], machine: &Machine, hal: &VirtualHal) -> Vec<Option<Reading>> {
    let seen = Seen {
        machine,
        hal,
        plant: None,
    };
    data.iter()
        .map(|point| Reading::of(seen, point.target))
        .collect()
}

/// Number of operation errors since power-on.
fn errors(machine: &Machine) -> u64 {
    machine.errors().iter().map(|error| error.times).sum()
}

impl Scan {
    /// The instruction of a place.
    fn instr(&self, stmt: &Stmt) -> Option<usize> {
        match stmt {
            Stmt::Network(network) => self.marks.get(*network as usize).copied(),
            _ => None,
        }
    }

    fn look(&self, machine: &Machine) -> Vec<Option<Reading>> {
        look(&self.stops.data, machine, &self.hal)
    }

    /// Comes to a place.
    fn at(&mut self, machine: &Machine, instr: usize) {
        let place = self.places;
        let why = match self.search {
            Search::Nothing => return,
            Search::Place(wanted) => (place == wanted).then_some(Why::Place),
            Search::LastPlace => Some(Why::Place),
            Search::First(after) => {
                let is_new = self.hit.is_none() && after.is_none_or(|after| place > after);
                self.why(machine, Some(instr), is_new, true)
            }
            Search::Last(before) => {
                let is_before = before.is_none_or(|before| place < before);
                self.why(machine, Some(instr), is_before, false)
            }
        };
        if let Some(why) = why {
            self.hit = Some(Hit {
                place: Some(place),
                instr,
                why,
                saved: Some(machine.save()),
            });
        }
    }

    /// Comes to the end.
    fn at_end(&mut self, machine: &Machine, was_running: bool) {
        let why = match self.search {
            Search::First(_) => {
                let is_new = self.hit.is_none();
                let why = self.why(machine, None, is_new, true);
                why.or_else(|| self.stopped(machine, is_new && was_running))
            }
            Search::Last(None) => self.why(machine, None, true, false),
            _ => None,
        };
        if let Some(why) = why {
            self.hit = Some(Hit {
                place: None,
                instr: 0,
                why,
                saved: None,
            });
        }
    }

    /// The PLC has stopped by itself.
    fn stopped(&self, machine: &Machine, was_running: bool) -> Option<Why> {
        let error = machine.last_error();
        let has_stopped = self.stops.errors && was_running && !machine.sys().running;
        (has_stopped && error.stop == Stop::Watchdog)
            .then(|| Why::Error(rungc_models::plc_errors::WATCHDOG, error.stop_step.into()))
    }

    /// The reason for a stop at a place, if there is one. `counts` is whether hits are counted.
    fn why(
        &mut self,
        machine: &Machine,
        instr: Option<usize>,
        is_wanted: bool,
        counts: bool,
    ) -> Option<Why> {
        let values = self.look(machine);
        let before = std::mem::replace(&mut self.values, values);
        let now = errors(machine);
        let has_erred = std::mem::replace(&mut self.errors, now) != now;
        if !is_wanted {
            return None;
        }
        if self.stops.errors && has_erred {
            let error = machine.last_error();
            return Some(Why::Error(error.code, error.step.into()));
        }
        let mut ids = Vec::new();
        let mut text = String::new();
        for (i, point) in self.stops.data.iter_mut().enumerate() {
            let (was, is) = (before.get(i).cloned().flatten(), self.values[i].clone());
            if was != is && point.stop.is_met(machine, counts) {
                let show = |value: Option<Reading>| {
                    value.map_or_else(String::new, |value| value.to_string())
                };
                text = format!(
                    "{} has changed from {} to {}",
                    point.target,
                    show(was),
                    show(is)
                );
                ids.push(point.stop.id);
            }
        }
        if !ids.is_empty() {
            return Some(Why::Data(ids, text));
        }
        let hal = &self.hal;
        for point in &mut self.stops.points {
            if Some(point.instr) != instr || !point.stop.is_met(machine, counts) {
                continue;
            }
            match &point.log {
                None => ids.push(point.stop.id),
                Some(log) if counts => self.logged.push(log.text(Seen {
                    machine,
                    hal,
                    plant: None,
                })),
                Some(_) => {}
            }
        }
        (!ids.is_empty()).then_some(Why::Points(ids))
    }
}
