//! A run with its history: forwards and back, by places and by scans.

use crate::breakpoints::{Breakpoints, Resolved};
use crate::launch::Launch;
use crate::observe::{Hit, Search, Watch, Why};
use crate::places::Places;
use rungc::{Plc, Program, Snapshot, Value};
use rungc_rt::Plc as _;
use rungc_sim::Target;
use rungc_sim::session::History;
use std::collections::BTreeMap;

/// A change from outside.
#[derive(Clone, Copy, Debug)]
enum Change {
    Set(Target, f64),
    Force(Target, f64),
    Release(Target),
    ReleaseAll,
    Switch(bool),
}

/// A place within a scan at which the run stands.
#[derive(Clone, Copy, Debug)]
struct Inside {
    place: u32,
    instr: usize,
}

/// A stop of a run.
#[derive(Clone, Debug)]
pub struct Stopped {
    /// The reason; `None` where nothing was met: at the end of a scan, or of the history.
    pub why: Option<Why>,
    /// True if the history ends here.
    pub is_first: bool,
}

/// Result of a scan.
pub struct Progress {
    /// The stop that it came to.
    pub stopped: Option<Stopped>,
    /// Messages of breakpoints.
    pub logged: Vec<String>,
}

/// A run.
pub struct Run<'p> {
    program: &'p Program,
    /// The source of the program.
    pub places: Places,
    /// The PLC between two scans: before the scan in which the run stands.
    plc: Plc<'p>,
    /// The PLC at a place within that scan.
    view: Plc<'p>,
    inside: Option<Inside>,
    /// Number of scans that have ended.
    scans: u64,
    scan_ms: Option<u64>,
    history: History<Snapshot>,
    /// Changes from outside, by the scan and the place in it: 0 before the scan, else the number of the place and 1.
    changes: BTreeMap<(u64, u32), Vec<Change>>,
    watch: Watch,
}

impl<'p> Run<'p> {
    /// A run at power-on.
    ///
    /// # Errors
    /// An input that cannot be set.
    pub fn new(program: &'p Program, launch: &Launch) -> Result<Self, String> {
        let places = Places::of(program);
        let watch = Watch::new(places.marks());
        let mut run = Run {
            program,
            places,
            plc: program.start(),
            view: program.start(),
            inside: None,
            scans: 0,
            scan_ms: launch.scan_ms,
            history: History::default(),
            changes: BTreeMap::new(),
            watch,
        };
        run.history.keep(0, run.plc.save());
        for (name, value) in &launch.inputs {
            let settable = run.plc.settable(name, value.clone());
            let (target, value) = settable.map_err(|error| format!("`inputs`: {error}"))?;
            run.existing(target)?;
            run.record(Change::Set(target, value));
        }
        Ok(run)
    }

    /// The program.
    pub fn program(&self) -> &'p Program {
        self.program
    }

    /// The PLC as it is at the present place.
    pub fn plc(&self) -> &Plc<'p> {
        match self.inside {
            None => &self.plc,
            Some(_) => &self.view,
        }
    }

    /// As [`plc`](Self::plc), for those who read its session.
    pub fn plc_mut(&mut self) -> &mut Plc<'p> {
        match self.inside {
            None => &mut self.plc,
            Some(_) => &mut self.view,
        }
    }

    /// The PLC before the present scan.
    pub fn before_scan(&mut self) -> &mut Plc<'p> {
        &mut self.plc
    }

    /// Number of scans that have ended.
    pub fn scans(&self) -> u64 {
        self.scans
    }

    /// Milliseconds since power-on at the beginning of the present scan.
    pub fn now_ms(&self) -> u64 {
        self.plc.now().as_millis() as u64
    }

    /// The instruction that is next.
    pub fn instr(&self) -> usize {
        self.inside.map_or(0, |inside| inside.instr)
    }

    /// Returns true within a scan.
    pub fn is_inside(&self) -> bool {
        self.inside.is_some()
    }

    /// Finds the breakpoints of an editor in this program.
    pub fn set_breakpoints(&self, breakpoints: &Breakpoints) -> Resolved {
        let mut resolved = breakpoints.resolve(&self.plc, self.program, &self.places);
        let stops = std::mem::take(&mut resolved.stops);
        self.watch.set(|old| *old = stops);
        resolved
    }

    /// Executes the rest of the scan, unless something stops it.
    pub fn scan(&mut self) -> Progress {
        let after = self.inside.map(|inside| inside.place);
        self.search(match self.watch.has_stops() {
            true => Search::First(after),
            false => Search::Nothing,
        })
    }

    /// Executes the first scan after a stop: as [`scan`](Self::scan), but between two scans the run stands at the first
    /// place already.
    pub fn resume(&mut self) -> Progress {
        let after = self.inside.map_or(0, |inside| inside.place);
        self.search(Search::First(Some(after)))
    }

    /// Goes to the next place; after the last one to the end of the scan.
    pub fn step(&mut self) {
        let place = self.inside.map_or(0, |inside| inside.place);
        self.search(Search::Place(place + 1));
    }

    /// Goes to the end of the scan.
    pub fn step_out(&mut self) {
        self.search(Search::Nothing);
    }

    /// Goes to the place before, and to the last one of the scan before. Returns false at the end of the history.
    pub fn step_back(&mut self) -> bool {
        match self.inside {
            Some(Inside { place, .. }) if place > 1 => {
                self.search(Search::Place(place - 1));
                true
            }
            Some(_) => {
                self.inside = None;
                true
            }
            None => {
                let can_go = self.scans > 0 && self.go_to(self.scans - 1);
                if can_go {
                    self.search(Search::LastPlace);
                }
                can_go
            }
        }
    }

    /// Goes back to the last stop of breakpoints before the present place, or as far as the history reaches.
    pub fn reverse(&mut self) -> Stopped {
        let end = self.scans;
        if let Some(Inside { place, .. }) = self.inside {
            if let Some(stopped) = self.search(Search::Last(Some(place))).stopped {
                return stopped;
            }
            self.go_to(end);
        }
        // A stop at the end of the scan before is at the same place as the run.
        let mut until = end;
        let mut is_end_other = self.inside.is_some();
        self.inside = None;
        while let Some((first, moment)) = self.history.before(until) {
            self.restore(first, &moment);
            let mut last = None;
            while self.scans < until {
                let scan = self.scans;
                let hit = self.search(Search::Last(None)).stopped;
                let is_at_end = self.scans > scan;
                if hit.is_some() && (!is_at_end || scan + 1 < until || is_end_other) {
                    last = Some(scan);
                }
                if !is_at_end {
                    self.inside = None;
                    self.search(Search::Nothing);
                }
            }
            if let Some(scan) = last {
                self.go_to(scan);
                if let Some(stopped) = self.search(Search::Last(None)).stopped {
                    return stopped;
                }
            }
            (until, is_end_other) = (first, true);
        }
        let first = self.history.first().unwrap_or_default();
        self.go_to(first);
        Stopped {
            why: None,
            is_first: true,
        }
    }

    /// Goes to the beginning of a scan, which is not later than the present one. Returns false if the history does not
    /// reach it.
    fn go_to(&mut self, scan: u64) -> bool {
        let Some((first, moment)) = self.history.before(scan.saturating_add(1)) else {
            return false;
        };
        self.restore(first, &moment);
        while self.scans < scan {
            self.search(Search::Nothing);
        }
        true
    }

    /// Goes to a moment of the history.
    fn restore(&mut self, scans: u64, moment: &Snapshot) {
        // It is of this program.
        let _ = self.plc.restore(moment);
        self.scans = scans;
        self.inside = None;
        self.apply_recorded();
    }

    /// Executes the present scan from its beginning, up to what is looked for, or to its end.
    fn search(&mut self, search: Search) -> Progress {
        let start = (search != Search::Nothing).then(|| self.plc.save());
        let changes = self.changes.range((self.scans, 1)..=(self.scans, u32::MAX));
        let changes = changes.flat_map(|(&(_, place), changes)| {
            changes.iter().filter_map(move |change| match *change {
                Change::Set(target, value) => Some((place - 1, target, value)),
                _ => None,
            })
        });
        let changes: Vec<_> = changes.collect();
        let is_observed = search != Search::Nothing || !changes.is_empty();
        let session = self.plc.session();
        let was_running = session.machine().sys().running;
        if is_observed {
            self.watch.begin(session.machine(), search, changes);
            session.machine_mut().observe(Box::new(self.watch.clone()));
        }
        let scan_ms = session.scan_ms(self.scan_ms);
        session.scan(scan_ms);
        let scan_ms = session.scan_ms(self.scan_ms);
        session.pass(scan_ms);
        self.inside = None;
        let mut hit = None;
        let mut logged = Vec::new();
        if is_observed {
            session.machine_mut().take_observer();
            let scanned = self.watch.end(session.machine(), was_running);
            (hit, logged) = (scanned.hit, scanned.logged);
        }
        let stopped = hit.as_ref().map(|hit| Stopped {
            why: Some(hit.why.clone()),
            is_first: false,
        });
        match hit.zip(start) {
            Some((hit, start)) if hit.place.is_some() => self.stand(hit, &start),
            _ => self.arrive(),
        }
        Progress { stopped, logged }
    }

    /// Stands at a place within the scan.
    fn stand(&mut self, mut hit: Hit, start: &Snapshot) {
        // Both are of this program.
        let _ = self.plc.restore(start);
        let _ = self.view.restore(start);
        if let Some(saved) = hit.take_saved() {
            self.view.session().machine_mut().restore(&saved);
        }
        self.inside = hit.place.map(|place| Inside {
            place,
            instr: hit.instr,
        });
    }

    /// A scan has ended.
    fn arrive(&mut self) {
        self.scans += 1;
        if self.history.is_due(self.scans) {
            self.history.keep(self.scans, self.plc.save());
        }
        self.apply_recorded();
    }

    /// Applies what was changed before the present scan when it was executed for the first time.
    fn apply_recorded(&mut self) {
        for change in self.changes.get(&(self.scans, 0)).into_iter().flatten() {
            apply(&mut self.plc, *change);
        }
    }

    /// Records a change at the present place, and applies it. What was changed later in an earlier course of the run is
    /// forgotten.
    fn record(&mut self, change: Change) {
        let now = (self.scans, self.inside.map_or(0, |inside| inside.place + 1));
        let mut later = self.changes.split_off(&now);
        if let Some(own) = later.remove(&now) {
            self.changes.insert(now, own);
        }
        let at = match (self.inside, change) {
            (None, _) | (Some(_), Change::Set(..)) => now,
            // From the next scan on.
            (Some(_), _) => (self.scans + 1, 0),
        };
        self.changes.entry(at).or_default().push(change);
        match (self.inside, change) {
            (None, _) => apply(&mut self.plc, change),
            (Some(_), Change::Set(target, value)) => {
                let (machine, hal) = self.view.session().parts();
                let _ = rungc_sim::set(machine, hal, target, value);
            }
            (Some(_), _) => {}
        }
    }

    fn existing(&mut self, target: Target) -> Result<(), String> {
        let model = self.program.module().model.title;
        match self.plc.session().reading(target) {
            Some(_) => Ok(()),
            None => Err(format!("`{target}` does not exist on {model}")),
        }
    }

    fn settable(&mut self, name: &str, value: Value) -> Result<(Target, f64), String> {
        let settable = self.plc().settable(name, value);
        let (target, value) = settable.map_err(|error| error.to_string())?;
        self.existing(target)?;
        match (self.inside, target) {
            (Some(_), Target::Channel(_)) => Err(format!(
                "`{target}` can be set between two scans: step out of this one first"
            )),
            _ => Ok((target, value)),
        }
    }

    /// Sets a device.
    ///
    /// # Errors
    /// One that does not exist, or a value that does not fit.
    pub fn set(&mut self, name: &str, value: Value) -> Result<Target, String> {
        let (target, value) = self.settable(name, value)?;
        self.record(Change::Set(target, value));
        Ok(target)
    }

    /// Forces a device; within a scan it is set, and forced from the next one on.
    ///
    /// # Errors
    /// Those of [`set`](Self::set), and a device of which another name is forced.
    pub fn force(&mut self, name: &str, value: Value) -> Result<Target, String> {
        let (target, number) = self.settable(name, value)?;
        // Of what is forced already.
        let moment = self.plc.save();
        let forced = self.plc.session().force(target, number);
        let _ = self.plc.restore(&moment);
        forced?;
        if self.is_inside() {
            self.record(Change::Set(target, number));
        }
        self.record(Change::Force(target, number));
        Ok(target)
    }

    /// Releases a device; within a scan, from the next one on.
    ///
    /// # Errors
    /// One that is not forced.
    pub fn release(&mut self, name: &str) -> Result<Target, String> {
        let target = self.plc.target(name).map_err(|error| error.to_string())?;
        let is_forced = self
            .plc
            .session()
            .forced()
            .iter()
            .any(|(forced, _)| forced == target);
        if !is_forced {
            return Err(format!("{target} is not forced"));
        }
        self.record(Change::Release(target));
        Ok(target)
    }

    /// Releases all devices; within a scan, from the next one on.
    pub fn release_all(&mut self) {
        self.record(Change::ReleaseAll);
    }

    /// Turns the RUN/STOP switch; within a scan, after it.
    pub fn switch(&mut self, running: bool) {
        self.record(Change::Switch(running));
    }
}

/// Applies a change between two scans.
fn apply(plc: &mut Plc, change: Change) {
    let session = plc.session();
    // All of them were possible when they were recorded; where an earlier course of the run makes a difference, a
    // device that is not forced is not released.
    match change {
        Change::Set(target, value) => {
            let _ = session.set(target, value);
        }
        Change::Force(target, value) => {
            let _ = session.force(target, value);
        }
        Change::Release(target) => {
            let _ = session.release(target);
        }
        Change::ReleaseAll => session.release_all(),
        Change::Switch(running) => session.set_running(running),
    }
    session.take_interrupts();
}
