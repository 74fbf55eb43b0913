//! Sweeps: [`LANES`] runs at once, which continue from one moment with different inputs, but scan at the same times.
//!
//! The lanes of emitted C execute a sweep ([`crate::lanes`]), or the interpreter does, one run after another. What is
//! made of it is the same: both say only which devices have changed in which scan, and everything is judged here. What
//! a sweep brings is run again on the interpreter before it counts.

use crate::cover::{Feature, Last, View, value};
use crate::notes::Coil;
use crate::run::{Moment, Runner, Scanned, differ};
use crate::task::{Kind, Step, Task, What};
use rungc_interp::Machine;
use rungc_ir::node::FlagId;
use rungc_models::Model;
use rungc_models::runs::{is_counter32, is_special, rt_class};
use rungc_rt::special::M_OUTPUTS_OFF;
use rungc_rt::{Class, Plc};
use rungc_sim::Target;
use rungc_sim::property::{Condition, Devices, Monitor, Property, Watcher};
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashMap;
use std::array;

/// Number of runs in a sweep.
pub const LANES: usize = rungc_codegen_c::lanes::LANES as usize;

/// Relay that switches the output terminals off.
const OUTPUTS_OFF: (Class, u32) = (Class::M, M_OUTPUTS_OFF.number());

/// Scans of a sweep between which inputs do not change.
#[derive(Clone, Debug)]
pub struct Stride {
    /// Changes in each lane before the first of them: numbers of [`Task::inputs`] and their values.
    pub set: Vec<Vec<(usize, i32)>>,
    /// Number of scans, and the milliseconds from each to the next.
    pub time: (u32, u32),
}

/// A device or flag of a lane that a scan has changed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Change {
    /// In which lane.
    pub lane: u8,
    /// A number of [`Items::bits`], or after these of [`Items::words`].
    pub item: u32,
    /// New value; of a bit 0 or 1.
    pub value: i32,
}

/// A bit that sweeps look at.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Bit {
    /// A device, or the contact of a timer or counter.
    Device(Class, u32),
    /// A flag of the program's copy.
    Flag(FlagId),
}

/// Values evaluated by sweeps after a scan.
pub struct Items {
    /// Bits: those of [`View::bits`], branches, errors, coils, and others in conditions.
    pub bits: Vec<Bit>,
    /// Words: those of [`View::words`], and others in conditions.
    pub words: Vec<(Class, u32)>,
    /// Numbers of bits and words in a [`View`].
    followed: (usize, usize),
    bit_of: FxHashMap<(Class, u32), usize>,
    word_of: FxHashMap<(Class, u32), usize>,
    model: &'static Model,
}

/// Reason why a search has no sweeps, as the end of "the program …"; `None` if it has. It depends only on the program
/// and the task, so that a search is the same wherever it takes place.
pub fn refusal(task: &Task) -> Option<&'static str> {
    let of_inputs = task.inputs.iter().find_map(|input| match input.target {
        Target::Bit(class, n) | Target::Word(class, n) => {
            is_special(class, n).then_some("has special devices among its inputs")
        }
        _ => Some("has timers or counters among its inputs"),
    });
    let module = task.module;
    let constant = module.model.constant_scan();
    let is_constant = constant.is_some_and(|asks| {
        let area = module.layout.area(DeviceClass::D, asks.register.number());
        area.is_some()
    });
    rungc_codegen_c::lanes::refusal(module)
        .or(task.machine.map(|_| "is wired to a machine"))
        .or(is_constant.then_some("sets the time of its scans"))
        .or(of_inputs)
}

impl Items {
    /// Those of a search.
    pub fn new(task: &Task, view: &View) -> Self {
        let notes = &task.notes;
        let coils = notes.coils.iter().flat_map(|(_, coils)| coils);
        let flags = (view.branches.iter().copied())
            .chain(notes.faults.iter().map(|(flag, _)| *flag))
            .chain(coils.flat_map(|coil| [coil.executed, coil.on]));
        let devices = view.bits.iter().map(|&(class, n)| Bit::Device(class, n));
        let mut items = Items {
            bits: devices.chain(flags.map(Bit::Flag)).collect(),
            words: view.words.clone(),
            followed: (view.bits.len(), view.words.len()),
            bit_of: FxHashMap::default(),
            word_of: FxHashMap::default(),
            model: task.module.model,
        };
        let bits = view.bits.iter().enumerate();
        items.bit_of = bits.map(|(i, &device)| (device, i)).collect();
        let words = view.words.iter().enumerate();
        items.word_of = words.map(|(i, &device)| (device, i)).collect();
        let conditions = task.properties.iter().flat_map(Property::conditions);
        for condition in conditions.chain(task.assumed) {
            for (class, n) in condition.devices() {
                items.add(class, n);
            }
        }
        let layout = &task.module.layout;
        if layout.area(DeviceClass::M, OUTPUTS_OFF.1).is_some() {
            items.add(DeviceClass::M, OUTPUTS_OFF.1);
        }
        items
    }

    /// Adds a device that a condition looks at.
    fn add(&mut self, class: DeviceClass, n: u32) {
        use DeviceClass::{C, D, ER, M, R, S, T, V, X, Y, Z};
        let Some(device) = rt_class(class).map(|class| (class, n)) else {
            return;
        };
        if matches!(class, X | Y | M | S | T | C) && !self.bit_of.contains_key(&device) {
            self.bit_of.insert(device, self.bits.len());
            self.bits.push(Bit::Device(device.0, n));
        }
        if matches!(class, D | R | ER | V | Z | T | C) && !self.word_of.contains_key(&device) {
            self.word_of.insert(device, self.words.len());
            self.words.push(device);
        }
    }

    /// All values on a machine now: bits, then words.
    fn read(&self, machine: &Machine) -> Vec<i32> {
        let bits = self.bits.iter().map(|&bit| match bit {
            Bit::Device(class, n) => (machine.bit(class, n) == Some(true)).into(),
            Bit::Flag(flag) => machine.flag(flag).into(),
        });
        let words = self.words.iter().map(|&device| value(machine, device));
        bits.chain(words).collect()
    }
}

/// A sweep, and what is judged by.
pub(crate) struct Sweep<'r, 't> {
    /// The task.
    pub task: &'t Task<'t>,
    /// Values to evaluate.
    pub view: &'r View<'t>,
    /// All of it.
    pub items: &'r Items,
    /// Moment at which it begins.
    pub start: &'r Moment<'t>,
    /// The run to there, from power-on.
    pub run: &'r [Step],
    /// Steps of the sweep.
    pub strides: Vec<Stride>,
}

/// Something that one lane of a sweep shows.
pub struct Shown {
    lane: usize,
    /// In which stride.
    stride: usize,
    /// After how many scans of it.
    scans: u32,
    /// The followed devices then.
    last: Last,
    /// The event.
    pub event: Event,
}

/// Event shown by a sweep.
pub enum Event {
    /// Something that is searched for has happened.
    Happened(What),
    /// A moment to continue from, with what is new in it.
    Moment(Vec<Feature>),
}

/// A run of a sweep.
struct Lane<'i, 't> {
    items: &'i Items,
    values: Vec<i32>,
    last: Last,
    watchers: Vec<Watcher<'t>>,
    assumed: Monitor<'t>,
    /// True if the machine permits the changes.
    goes_on: bool,
    changes: Vec<(usize, i32)>,
    new: Vec<Feature>,
}

impl Devices for Lane<'_, '_> {
    fn bit_at(&self, class: Class, number: u32) -> bool {
        let on = |device: (Class, u32)| {
            let item = self.items.bit_of.get(&device);
            item.is_some_and(|&item| self.values[item] != 0)
        };
        on((class, number)) && (class != Class::Y || !on(OUTPUTS_OFF))
    }

    fn word_at(&self, class: Class, number: u32) -> i16 {
        let item = self.items.word_of.get(&(class, number));
        item.map_or(0, |&item| self.values[self.items.bits.len() + item] as i16)
    }

    fn counter32_at(&self, number: u32) -> Option<i32> {
        let item = self.items.word_of.get(&(Class::C, number));
        let item = item.filter(|_| is_counter32(DeviceClass::C, number))?;
        Some(self.values[self.items.bits.len() + item])
    }

    fn model(&self) -> &'static Model {
        self.items.model
    }
}

impl<'t> Sweep<'_, 't> {
    /// The run of a lane in this sweep, up to a number of scans of a stride.
    fn steps(&self, lane: usize, (stride, scans): (usize, u32)) -> Vec<Step> {
        let until = self.strides[..=stride].iter().enumerate();
        let steps = until.map(|(i, at)| Step {
            set: at.set[lane].clone(),
            pulses: Vec::new(),
            scans: if i == stride { scans } else { at.time.0 },
            scan_ms: at.time.1,
        });
        steps.collect()
    }

    /// Executes it on the interpreter; `row` gets the changes of each scan.
    pub(crate) fn interpret(&self, runner: &mut Runner<'t>, row: &mut dyn FnMut(&[Change])) {
        let scans = self.strides.iter().map(|stride| stride.time.0 as usize);
        let mut rows: Vec<Vec<Change>> = vec![Vec::new(); scans.sum()];
        for lane in 0..LANES {
            runner.restore(self.start);
            let mut values = self.items.read(runner.machine());
            let mut rows = rows.iter_mut();
            let mut goes_on = true;
            for stride in &self.strides {
                runner.set(&stride.set[lane]);
                for _ in 0..stride.time.0 {
                    let Some(row) = rows.next().filter(|_| goes_on) else {
                        break;
                    };
                    goes_on = runner.scan(stride.time.1) == Scanned::Next;
                    let now = self.items.read(runner.machine());
                    let pairs = now.iter().zip(&values).enumerate();
                    let changed = pairs.filter(|(_, (now, before))| now != before);
                    row.extend(changed.map(|(item, (&value, _))| Change {
                        lane: lane as u8,
                        item: item as u32,
                        value,
                    }));
                    values = now;
                }
            }
        }
        rows.iter().for_each(|changes| row(changes));
    }

    /// Judge of the changes, for each scan in order.
    pub fn judge<'s>(&'s self, runner: &mut Runner<'t>) -> Judge<'s, 't> {
        runner.restore(self.start);
        let mut last = self.view.nothing();
        self.view.look(runner, &mut last, &mut |_| {});
        let values = self.items.read(runner.machine());
        let lane = || Lane {
            items: self.items,
            values: values.clone(),
            last: last.clone(),
            watchers: runner.followed().0.to_vec(),
            assumed: runner.followed().1.clone(),
            goes_on: true,
            changes: Vec::new(),
            new: Vec::new(),
        };
        let properties = self.task.properties.iter();
        let conditions = properties.clone().flat_map(Property::conditions);
        let has_memory = conditions
            .chain(self.task.assumed)
            .any(Condition::has_memory);
        let mut waiting =
            properties.filter(|property| matches!(property, Property::Whenever { .. }));
        Judge {
            sweep: self,
            waits: has_memory || waiting.next().is_some(),
            lanes: array::from_fn(|_| lane()),
            last_ms: runner.last_ms(),
            begun: false,
            at: (0, 0),
            shown: Vec::new(),
        }
    }

    /// Runs what a lane has shown on the interpreter, which stays there; whether it shows the same.
    pub fn confirm(&self, runner: &mut Runner<'t>, shown: &Shown) -> Result<Vec<Step>, String> {
        let steps = self.steps(shown.lane, (shown.stride, shown.scans));
        runner.restore(self.start);
        let mut last = self.view.nothing();
        self.view.look(runner, &mut last, &mut |_| {});
        for step in &steps {
            runner.set(&step.set);
            for _ in 0..step.scans {
                if runner.scan(step.scan_ms) == Scanned::Excluded {
                    return Err(DIFFER.to_string());
                }
                self.view.look(runner, &mut last, &mut |_| {});
            }
        }
        let same = match &shown.event {
            Event::Happened(what) => runner.happened.contains(what),
            Event::Moment(_) => last == shown.last,
        };
        let run = self.run.iter().cloned().chain(steps).collect();
        same.then_some(run).ok_or_else(|| DIFFER.to_string())
    }
}

/// Message for an error of rungc.
const DIFFER: &str = "lanes and interpreter disagree, which is an error of rungc: please report it; \
                      `--engine interp` searches without lanes";

/// Follows the lanes of a sweep.
pub struct Judge<'s, 't> {
    sweep: &'s Sweep<'s, 't>,
    /// True if a property waits for something, or remembers something, so that scans without changes matter.
    waits: bool,
    lanes: [Lane<'s, 't>; LANES],
    last_ms: Option<u32>,
    begun: bool,
    /// Stride, and how many of its scans are done.
    at: (usize, u32),
    /// Events shown, in the order of scans and lanes.
    pub shown: Vec<Shown>,
}

impl Judge<'_, '_> {
    /// A scan of all lanes with what it has changed. `is_new`: whether a feature is new, which it is once;
    /// `is_searched`: whether something that has happened is still searched for.
    pub fn scan(
        &mut self,
        changes: &[Change],
        is_new: &mut dyn FnMut(Feature) -> bool,
        is_searched: &mut dyn FnMut(&What) -> bool,
    ) {
        for change in changes {
            if let Some(lane) = self.lanes.get_mut(usize::from(change.lane)) {
                lane.changes.push((change.item as usize, change.value));
            }
        }
        let (stride, done) = self.at;
        let (scans, scan_ms) = self.sweep.strides[stride].time;
        let elapsed_ms = self.last_ms.replace(scan_ms).unwrap_or(0);
        let all = !std::mem::replace(&mut self.begun, true);
        let ends = done + 1 == scans;
        for (number, lane) in self.lanes.iter_mut().enumerate() {
            let touched = all || !lane.changes.is_empty();
            if !lane.goes_on || !(touched || self.waits || ends) {
                lane.changes.clear();
                continue;
            }
            let mut happened = Vec::new();
            lane.scan(self.sweep, (touched, elapsed_ms), is_new, &mut happened);
            let mut show = |last: Last, event| {
                let (lane, stride, scans) = (number, stride, done + 1);
                self.shown.push(Shown {
                    lane,
                    stride,
                    scans,
                    last,
                    event,
                });
            };
            for what in happened.into_iter().filter(|what| is_searched(what)) {
                show(Last::default(), Event::Happened(what));
            }
            if ends && lane.goes_on && !lane.new.is_empty() {
                let new = std::mem::take(&mut lane.new);
                show(lane.last.clone(), Event::Moment(new));
            }
        }
        self.at = if ends {
            (stride + 1, 0)
        } else {
            (stride, done + 1)
        };
    }
}

impl Lane<'_, '_> {
    /// A scan of the lane.
    fn scan(
        &mut self,
        sweep: &Sweep,
        (touched, elapsed_ms): (bool, u32),
        is_new: &mut dyn FnMut(Feature) -> bool,
        happened: &mut Vec<What>,
    ) {
        let (task, view) = (sweep.task, sweep.view);
        let changes = std::mem::take(&mut self.changes);
        for &(item, value) in &changes {
            self.values[item] = value;
        }
        let mut assumed = std::mem::replace(&mut self.assumed, Monitor::new(&[]));
        let is_possible = assumed.all_hold(self, elapsed_ms);
        self.assumed = assumed;
        if !is_possible {
            self.goes_on = false;
            return;
        }
        let mut watchers = std::mem::take(&mut self.watchers);
        for (number, watcher) in watchers.iter_mut().enumerate() {
            if watcher.happened(self, elapsed_ms) {
                happened.push(What::Property(number));
            }
        }
        self.watchers = watchers;
        if !touched {
            return;
        }
        self.notice(task, &changes, happened);
        let mut last = std::mem::take(&mut self.last);
        let mut new = std::mem::take(&mut self.new);
        let mut note = |feature| {
            if is_new(feature) {
                new.push(feature);
            }
        };
        let (bits, words) = self.items.followed;
        let (branches, all) = (view.branches.len(), self.items.bits.len());
        for &(item, value) in &changes {
            if item < bits {
                view.bit(item, value != 0, &mut last, &mut note);
            } else if item < bits + branches {
                view.branch(item - bits, &mut last, &mut note);
            } else if (all..all + words).contains(&item) {
                view.word(item - all, value, &mut last, &mut note);
            }
        }
        view.end(self, &mut last, &mut note);
        (self.last, self.new) = (last, new);
        self.changes = changes;
        self.changes.clear();
    }

    /// Adds the other events of a scan.
    fn notice(&self, task: &Task, changes: &[(usize, i32)], happened: &mut Vec<What>) {
        let notes = &task.notes;
        let first = self.items.followed.0 + notes.branches.len();
        let faults = first..first + notes.faults.len();
        if task.wants(Kind::Errors) {
            let new = changes.iter().filter(|(item, _)| faults.contains(item));
            happened.extend(new.map(|(item, _)| {
                let (_, (code, step)) = notes.faults[item - first];
                What::Error { code, step }
            }));
        }
        if task.wants(Kind::Doubled) {
            let mut at = faults.end;
            for (output, coils) in &notes.coils {
                let flags = coils.iter().enumerate().map(|(i, _): (usize, &Coil)| {
                    let [executed, on] = [2 * i, 2 * i + 1].map(|i| self.values[at + i] != 0);
                    (executed, on)
                });
                if differ(flags.filter(|(executed, _)| *executed).map(|(_, on)| on)) {
                    happened.push(What::Doubled(*output));
                }
                at += 2 * coils.len();
            }
        }
    }
}
