//! Runs of a program, step by step, as test files run it.

use crate::task::{Kind, Step, Task, What};
use crate::trains::{changes, left_off};
use rungc_interp::{Machine, Saved};
use rungc_rt::{Class, Plc, Program, VirtualHal};
use rungc_sim::Target;
use rungc_sim::plant::{Plant, Wired};
use rungc_sim::property::{Monitor, Watcher, read};
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
    machine: Machine<'t>,
    /// Large, so not on the stack.
    hal: Box<VirtualHal>,
    plant: Option<Plant>,
    watchers: Vec<Watcher<'t>>,
    assumed: Monitor<'t>,
    inputs: Vec<i32>,
    /// Pulses of the step that has begun; their times are since power-on.
    coming: VecDeque<Change>,
    /// Milliseconds since power-on.
    now_ms: u64,
    /// Milliseconds of the run until then, and how often the power supply has gone off.
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
    machine: Saved,
    /// `None` if the program does not use it.
    hal: Option<Box<VirtualHal>>,
    plant: Option<Plant>,
    watchers: Vec<Watcher<'t>>,
    assumed: Monitor<'t>,
    inputs: Vec<i32>,
    now_ms: u64,
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
        let mut machine = Machine::new(&task.noting);
        let mut hal = task.hal.clone();
        let mut plant = task.machine.map(|machine| machine.plant());
        if let Some(plant) = &mut plant {
            let mut wired = Wired {
                machine: &mut machine,
                hal: &mut hal,
                changed: &mut |_| Ok::<_, String>(()),
            };
            wired.connect(plant)?;
        }
        let module = task.module;
        let areas = module.layout.areas.iter();
        let outputs = areas.filter(|area| area.class == DeviceClass::Y);
        let outputs = outputs.flat_map(|area| area.first..area.first + area.count);
        let outputs = outputs.filter(|output| !module.pulse_outputs.contains(output));
        Ok(Runner {
            task,
            machine,
            hal,
            plant,
            watchers: task.properties.iter().map(Watcher::new).collect(),
            assumed: Monitor::new(task.assumed),
            inputs: vec![0; task.inputs.len()],
            coming: VecDeque::new(),
            now_ms: 0,
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
        &self.machine
    }

    /// The PLC's hardware.
    pub fn hal(&self) -> &VirtualHal {
        &self.hal
    }

    /// The machine around it.
    pub fn plant(&self) -> Option<&Plant> {
        self.plant.as_ref()
    }

    /// Milliseconds since the run began.
    pub fn now_ms(&self) -> u64 {
        self.before.0 + self.now_ms
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
            machine: self.machine.save(),
            hal: self.uses_hal.then(|| self.hal.clone()),
            plant: self.plant.clone(),
            watchers: self.watchers.clone(),
            assumed: self.assumed.clone(),
            inputs: self.inputs.clone(),
            now_ms: self.now_ms,
            before: self.before,
            last_ms: self.last_ms,
            constant_ms: self.constant_ms,
            errors: self.errors,
            outputs: self.outputs.clone(),
        }
    }

    /// Goes back to a state.
    pub fn restore(&mut self, moment: &Moment<'t>) {
        self.machine.restore(&moment.machine);
        if let Some(hal) = &moment.hal {
            self.hal.clone_from(hal);
        }
        self.plant.clone_from(&moment.plant);
        self.watchers.clone_from(&moment.watchers);
        self.assumed.clone_from(&moment.assumed);
        self.inputs.clone_from(&moment.inputs);
        self.now_ms = moment.now_ms;
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
            .for_each(|change| change.at_us += 1000 * self.now_ms);
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
            let _ = rungc_sim::set(&mut self.machine, &mut self.hal, target, value.into());
            if let Target::Bit(DeviceClass::X, number) = target
                && self.takes_events
                && self.last_ms.is_some()
                && before != value
            {
                self.machine.input_edge(&mut *self.hal, number, value != 0);
            }
            if before != value {
                self.outputs.iter_mut().for_each(|(.., times)| *times = 0);
            }
        }
    }

    /// Power off and on, as test files have it: latched devices and input terminals stay as they are.
    fn cycle_power(&mut self, times: i32) {
        self.before = (self.now_ms(), times);
        self.now_ms = 0;
        self.last_ms = None;
        self.constant_ms = 0;
        self.errors = 0;
        self.watchers = self.task.properties.iter().map(Watcher::new).collect();
        self.assumed = Monitor::new(self.task.assumed);
        self.outputs
            .iter_mut()
            .for_each(|(_, on, times)| (*on, *times) = (false, 0));
        self.hal.restart();
        self.machine.power_cycle();
        self.plant.iter_mut().for_each(Plant::power_cycle);
        for (input, value) in self.task.inputs.iter().zip(&mut self.inputs) {
            match input.target {
                Target::Bit(DeviceClass::X, number) => {
                    // It exists: it was taken from the program's devices.
                    let _ = self.machine.set_bit(Class::X, number, *value != 0);
                }
                target => *value = read(&self.machine, target),
            }
        }
    }

    /// Executes a scan and lets the time until the next one pass. What has happened is in `happened` then.
    pub fn scan(&mut self, scan_ms: u32) -> Scanned {
        self.happened.clear();
        let scan_ms = scan_ms.max(self.constant_ms);
        let scan_us = scan_ms.saturating_mul(1000);
        self.hal
            .scan(&mut self.machine, self.now_ms as u32, scan_us);
        let elapsed_ms = self.last_ms.replace(scan_ms).unwrap_or(0);
        self.constant_ms = self.machine.constant_scan_ms().unwrap_or(0).into();
        // Events between two scans are evaluated as in test files, which read once the time has passed.
        if self.takes_events {
            self.pass(scan_ms);
        }
        if !self.assumed.all_hold(&self.machine, elapsed_ms) {
            return Scanned::Excluded;
        }
        let machine = &self.machine;
        for (number, watcher) in self.watchers.iter_mut().enumerate() {
            if watcher.happened(machine, elapsed_ms) {
                self.happened.push(What::Property(number));
            }
        }
        self.notice();
        if !self.takes_events {
            self.pass(scan_ms);
        }
        let broken = self.plant.as_ref().and_then(Plant::collision);
        if let Some(collision) = broken
            && self.task.wants(Kind::Collisions)
        {
            let collision = What::Collision(collision.axis.clone());
            self.happened.push(collision);
        }
        match broken.is_some() || !self.machine.sys().running {
            true => Scanned::End,
            false => Scanned::Next,
        }
    }

    /// Notes what else has happened in a scan.
    fn notice(&mut self) {
        let machine = &self.machine;
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
        if self.plant.is_none() && !self.takes_events {
            self.now_ms += u64::from(scan_ms);
            return;
        }
        for _ in 0..scan_ms {
            self.now_ms += 1;
            self.hal.advance_to(self.now_ms as u32);
            let mut others = Vec::new();
            while let Some(next) = self.coming.front()
                && next.at_us < 1000 * self.now_ms
            {
                others.extend(self.coming.pop_front());
            }
            let mut pulsed = Plant::default();
            let plant = match &mut self.plant {
                None if !others.is_empty() => Some(&mut pulsed),
                plant => plant.as_mut(),
            };
            if let Some(plant) = plant {
                let mut wired = Wired {
                    machine: &mut self.machine,
                    hal: &mut self.hal,
                    changed: &mut |_| Ok::<_, String>(()),
                };
                // Nothing can go wrong: all sensors were connected at power-on.
                let _ = plant.step(self.now_ms, &others, &mut wired);
            }
            if self.takes_events {
                self.machine.tick(&mut *self.hal, self.now_ms as u32);
                self.machine.take_interrupts(&mut *self.hal);
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
