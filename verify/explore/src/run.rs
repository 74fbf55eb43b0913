//! Runs of a program, step by step, as test files run it.

use crate::task::{Kind, Step, Task, What};
use crate::trains::{changes, left_off};
use rungc_interp::Machine;
use rungc_rt::{Class, Plc, Program, VirtualHal};
use rungc_sim::Target;
use rungc_sim::plant::Plant;
use rungc_sim::property::{Monitor, Watcher, read};
use rungc_sim::session::{self, Session};
use rungc_sim::wire::Change;
use rungc_syntax::DeviceClass;
use std::collections::VecDeque;

/// Number of successive scans in which an output changes before it counts as one that never comes to rest.
pub(crate) const RESTLESS: u32 = 20;

/// In [`Step::set`] in place of an input: before all else, the power supply goes off and comes back. The value is how
/// often it has done so.
pub const POWER: usize = usize::MAX;

/// A program that runs.
pub struct Runner<'t> {
    task: &'t Task<'t>,
    session: Session<'t>,
    watchers: Vec<Watcher<'t>>,
    assumed: Monitor<'t>,
    inputs: Vec<i32>,
    /// Pulses of the step that has begun; their times are since power-on.
    coming: VecDeque<Change>,
    /// Milliseconds of the run until power-on, and how often the power supply has gone off.
    before: (u64, i32),
    /// Duration of the last scan; `None` before the first.
    last_ms: Option<u32>,
    takes_events: bool,
    uses_hal: bool,
    constant_ms: u32,
    /// Number of operation errors before the scan.
    errors: usize,
    /// By output that the program stores: what it was, and in how many scans in a row it has changed while no input
    /// did.
    outputs: Vec<(u32, bool, u32)>,
    /// Events of the last scan.
    pub happened: Vec<What>,
}

/// A moment of a run, to come back to.
#[derive(Clone)]
pub struct Moment<'t> {
    session: session::Moment,
    watchers: Vec<Watcher<'t>>,
    assumed: Monitor<'t>,
    inputs: Vec<i32>,
    before: (u64, i32),
    last_ms: Option<u32>,
    constant_ms: u32,
    errors: usize,
    outputs: Vec<(u32, bool, u32)>,
}

/// Outcome of a scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Scanned {
    /// The run can continue.
    Next,
    /// The PLC has stopped, or the machine is broken.
    End,
    /// The machine sees to it that this does not happen: the scan does not count.
    Excluded,
}

impl<'t> Runner<'t> {
    /// The program at power-on. Fails if the machine has a sensor at an input that the PLC does not have.
    pub fn new(task: &'t Task<'t>) -> Result<Self, String> {
        let mut session = Session::new(&task.noting, (*task.hal).clone());
        if let Some(machine) = task.machine {
            session.connect(machine.plant())?;
        }
        let module = task.module;
        let areas = module.layout.areas.iter();
        let outputs = areas.filter(|area| area.class == DeviceClass::Y);
        let outputs = outputs.flat_map(|area| area.first..area.first + area.count);
        let outputs = outputs.filter(|output| !module.pulse_outputs.contains(output));
        Ok(Runner {
            task,
            session,
            watchers: task.properties.iter().map(Watcher::new).collect(),
            assumed: Monitor::new(task.assumed),
            inputs: vec![0; task.inputs.len()],
            coming: VecDeque::new(),
            before: (0, 0),
            last_ms: None,
            takes_events: module.takes_events(),
            uses_hal: task.uses_hal(),
            constant_ms: 0,
            errors: 0,
            outputs: outputs.map(|output| (output, false, 0)).collect(),
            happened: Vec::new(),
        })
    }

    /// The PLC.
    pub fn machine(&self) -> &Machine<'t> {
        self.session.machine()
    }

    /// The PLC's hardware.
    pub fn hal(&self) -> &VirtualHal {
        self.session.hal()
    }

    /// The machine around it.
    pub fn plant(&self) -> Option<&Plant> {
        self.session.plant()
    }

    /// Milliseconds since the run began.
    pub fn now_ms(&self) -> u64 {
        self.before.0 + self.session.now_ms()
    }

    /// Number of power cycles.
    pub fn power_cycles(&self) -> i32 {
        self.before.1
    }

    /// The properties and the assumptions, as far as the run has followed them.
    pub(crate) fn followed(&self) -> (&[Watcher<'t>], &Monitor<'t>) {
        (&self.watchers, &self.assumed)
    }

    /// Duration of the last scan in milliseconds; `None` before the first.
    pub fn last_ms(&self) -> Option<u32> {
        self.last_ms
    }

    /// Present values of the inputs.
    pub fn inputs(&self) -> &[i32] {
        &self.inputs
    }

    /// The state now.
    pub fn save(&self) -> Moment<'t> {
        Moment {
            session: match self.uses_hal {
                true => self.session.save(),
                false => self.session.save_without_hardware(),
            },
            watchers: self.watchers.clone(),
            assumed: self.assumed.clone(),
            inputs: self.inputs.clone(),
            before: self.before,
            last_ms: self.last_ms,
            constant_ms: self.constant_ms,
            errors: self.errors,
            outputs: self.outputs.clone(),
        }
    }

    /// Goes back to a state.
    pub fn restore(&mut self, moment: &Moment<'t>) {
        self.session.restore(&moment.session);
        self.watchers.clone_from(&moment.watchers);
        self.assumed.clone_from(&moment.assumed);
        self.inputs.clone_from(&moment.inputs);
        self.before = moment.before;
        self.last_ms = moment.last_ms;
        self.constant_ms = moment.constant_ms;
        self.errors = moment.errors;
        self.outputs.clone_from(&moment.outputs);
    }

    /// Begins a step of a run: inputs change, and pulses come in the time of its first scan.
    pub fn begin(&mut self, step: &Step) {
        self.set(&step.set);
        self.coming.clear();
        if step.pulses.is_empty() {
            return;
        }
        let task = self.task;
        let is_on = |number: u32| {
            let target = Target::Bit(DeviceClass::X, number);
            let mut inputs = task.inputs.iter().zip(&self.inputs);
            inputs.any(|(input, value)| input.target == target && *value != 0)
        };
        let mut coming = changes(task, step, &is_on);
        coming
            .iter_mut()
            .for_each(|change| change.at_us += 1000 * self.session.now_ms());
        self.coming.extend(coming);
        for input in left_off(task, &step.pulses) {
            self.inputs[input] = 0;
        }
        self.outputs.iter_mut().for_each(|(.., times)| *times = 0);
    }

    /// Changes inputs, as a step without pulses says.
    pub fn set(&mut self, set: &[(usize, i32)]) {
        if let Some(&(_, times)) = set.iter().find(|(input, _)| *input == POWER) {
            self.cycle_power(times);
        }
        for &(input, value) in set.iter().filter(|(input, _)| *input != POWER) {
            let before = std::mem::replace(&mut self.inputs[input], value);
            let target = self.task.inputs[input].target;
            // Each input exists: it was taken from the program's devices.
            let _ = self.session.set(target, value.into());
            if before != value {
                self.outputs.iter_mut().for_each(|(.., times)| *times = 0);
            }
        }
    }

    /// Power off and on, as test files have it: latched devices and input terminals stay as they are.
    fn cycle_power(&mut self, times: i32) {
        self.before = (self.now_ms(), times);
        self.last_ms = None;
        self.constant_ms = 0;
        self.errors = 0;
        self.watchers = self.task.properties.iter().map(Watcher::new).collect();
        self.assumed = Monitor::new(self.task.assumed);
        self.outputs
            .iter_mut()
            .for_each(|(_, on, times)| (*on, *times) = (false, 0));
        self.session.power_cycle();
        for (input, value) in self.task.inputs.iter().zip(&mut self.inputs) {
            *value = read(self.session.machine(), input.target);
        }
    }

    /// Executes a scan and lets the time until the next one pass. What has happened is in `happened` then.
    pub fn scan(&mut self, scan_ms: u32) -> Scanned {
        self.happened.clear();
        let scan_ms = scan_ms.max(self.constant_ms);
        self.session.scan(scan_ms.into());
        let elapsed_ms = self.last_ms.replace(scan_ms).unwrap_or(0);
        let constant_ms = self.session.machine().constant_scan_ms();
        self.constant_ms = constant_ms.unwrap_or(0).into();
        let machine = self.session.machine();
        if !self.assumed.all_hold(machine, elapsed_ms) {
            return Scanned::Excluded;
        }
        for (number, watcher) in self.watchers.iter_mut().enumerate() {
            if watcher.happened(machine, elapsed_ms) {
                self.happened.push(What::Property(number));
            }
        }
        self.notice();
        self.pass(scan_ms);
        let broken = self.session.plant().and_then(Plant::collision);
        if let Some(collision) = broken
            && self.task.wants(Kind::Collisions)
        {
            let collision = What::Collision(collision.axis.clone());
            self.happened.push(collision);
        }
        match broken.is_some() || !self.session.machine().sys().running {
            true => Scanned::End,
            false => Scanned::Next,
        }
    }

    /// Notes what else has happened in a scan.
    fn notice(&mut self) {
        let machine = self.session.machine();
        let mut found = Vec::new();
        let errors = machine.errors();
        let new = errors.get(self.errors..).unwrap_or_default();
        found.extend(new.iter().map(|error| What::Error {
            code: error.code,
            step: error.step,
        }));
        self.errors = errors.len();
        if machine.watchdog_tripped() {
            let step = machine.last_error().stop_step.into();
            found.push(What::Watchdog { step });
        }
        let outputs = self.task.notes.coils.iter();
        let doubled = outputs.filter(|(_, coils)| {
            let driven = coils.iter().filter(|coil| machine.flag(coil.executed));
            differ(driven.map(|coil| machine.flag(coil.on)))
        });
        found.extend(doubled.map(|(output, _)| What::Doubled(*output)));
        for (output, was, times) in &mut self.outputs {
            let is = machine.bit(Class::Y, *output) == Some(true);
            *times = match std::mem::replace(was, is) != is {
                true => *times + 1,
                false => 0,
            };
        }
        let task = self.task;
        let wanted = found.into_iter();
        self.happened
            .extend(wanted.filter(|what| what.kind().is_none_or(|kind| task.wants(kind))));
    }

    /// The outputs that have changed in this many scans in a row, with inputs that stay.
    pub fn restless(&self, scans: u32) -> impl Iterator<Item = u32> {
        let outputs = self.outputs.iter();
        outputs
            .filter(move |(.., times)| *times >= scans)
            .map(|(output, ..)| *output)
    }

    /// Returns true if an output changes in every scan from here on, however long scans are; the state of the run is
    /// restored.
    pub(crate) fn never_rests(&mut self, output: u32) -> bool {
        /// Times that no clock of a PLC follows both, in milliseconds.
        const SCAN_MS: [u32; 2] = [10, 7];
        let here = self.save();
        let restless = SCAN_MS.into_iter().all(|scan_ms| {
            self.restore(&here);
            self.outputs.iter_mut().for_each(|(.., times)| *times = 0);
            let runs = (0..RESTLESS).all(|_| self.scan(scan_ms) == Scanned::Next);
            runs && self.restless(RESTLESS).any(|restless| restless == output)
        });
        self.restore(&here);
        self.happened.clear();
        restless
    }

    /// The time from one scan to the next.
    fn pass(&mut self, scan_ms: u32) {
        if self.session.plant().is_none() && !self.takes_events {
            self.session.skip(scan_ms.into());
            return;
        }
        for _ in 0..scan_ms {
            let next_us = 1000 * (self.session.now_ms() + 1);
            let mut others = Vec::new();
            while let Some(next) = self.coming.front()
                && next.at_us < next_us
            {
                others.extend(self.coming.pop_front());
            }
            // Nothing can go wrong: all sensors were connected at power-on.
            let _ = self.session.advance(&others, &mut |_| Ok::<_, String>(()));
            if self.takes_events {
                self.session.tick();
                self.session.take_interrupts();
            }
        }
    }
}

/// Returns true if the last of the coils of an output that a scan has executed is off, and one before it is on.
pub fn differ(driven: impl DoubleEndedIterator<Item = bool>) -> bool {
    let mut driven = driven.rev();
    driven.next() == Some(false) && driven.any(|on| on)
}

/// Runs these steps from power-on; the run until what is searched for has happened, if it does.
pub fn replay(task: &Task, what: &What, run: &[Step]) -> Option<Vec<Step>> {
    follow(&mut Runner::new(task).ok()?, what, run)
}

/// The same with a runner that is at power-on.
pub fn follow(runner: &mut Runner, what: &What, run: &[Step]) -> Option<Vec<Step>> {
    let mut done: Vec<Step> = Vec::new();
    for step in run {
        runner.begin(step);
        done.push(Step {
            scans: 0,
            ..step.clone()
        });
        for _ in 0..step.scans {
            let scanned = runner.scan(step.scan_ms);
            done.last_mut()?.scans += 1;
            if scanned != Scanned::Excluded && runner.happened.contains(what) {
                return Some(done);
            }
            if scanned != Scanned::Next {
                return None;
            }
        }
    }
    match *what {
        What::Oscillation(output) => runner.never_rests(output).then_some(done),
        _ => None,
    }
}
