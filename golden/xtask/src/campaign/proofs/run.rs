//! Runs of programs on the interpreter, and what is asked of them: independent of the prover's logic and its replays.

use rungc_interp::{Machine, Saved, rt_class};
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::{Class, Plc, Program, Stop, VirtualHal};
use rungc_sim::property::{Condition, Monitor, Property, Watcher};
use rungc_verify::model::{CounterPart, Key, TimerPart};
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

/// Request about runs.
#[derive(Clone, Copy, Debug)]
pub enum Goal<'c> {
    /// The event of a property happens.
    Event(&'c Property),
    /// One of these outputs of two programs differs, or one of them stops.
    Differs(&'c [u32]),
    /// The run has this many scans.
    Lives(usize),
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

/// A PLC with its surroundings.
pub struct Plant<'m> {
    /// The PLC.
    pub machine: Machine<'m>,
    at_first: Saved,
    hal: VirtualHal,
    /// True if the hardware around the PLC remembers something.
    has_hardware: bool,
    now_ms: u32,
    first: bool,
}

/// Returns true if a program uses the buffer memory of modules, ports or pulses.
fn has_hardware(module: &Module) -> bool {
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

/// Gives a piece of memory its value.
fn set(machine: &mut Machine, hal: &mut VirtualHal, key: Key, value: i64) {
    // What a program does not name is not stored, and matters to nothing.
    let _ = match key {
        Key::Buffer(module, address) => hal.set_bfm(module.into(), address as u16, value as i16),
        Key::Bit(class, number) => {
            rt_class(class).and_then(|class| machine.set_bit(class, number, value != 0))
        }
        Key::Word(class, number) => {
            rt_class(class).and_then(|class| machine.set_word(class, number, value as i16))
        }
        Key::Timer(number, TimerPart::Value) => machine.set_word(Class::T, number, value as i16),
        Key::Timer(number, TimerPart::Done) => machine.set_bit(Class::T, number, value != 0),
        Key::Counter(number, CounterPart::Value) => match machine.counter32(number) {
            Some(_) => machine.set_counter32(number, value as i32),
            None => machine.set_word(Class::C, number, value as i16),
        },
        Key::Counter(number, CounterPart::Done) => machine.set_bit(Class::C, number, value != 0),
        _ => None,
    };
}

impl<'m> Plant<'m> {
    fn new(module: &'m Module) -> Self {
        let machine = Machine::new(module);
        Plant {
            at_first: machine.save(),
            machine,
            hal: VirtualHal::new(),
            has_hardware: has_hardware(module),
            now_ms: 0,
            first: true,
        }
    }

    /// Goes to where it was at the first power-on, with these values in latched memory.
    fn begin(&mut self, start: &[(Key, i64)]) {
        self.machine.restore(&self.at_first);
        if self.has_hardware {
            self.hal = VirtualHal::new();
        }
        for &(key, value) in start {
            set(&mut self.machine, &mut self.hal, key, value);
        }
        (self.now_ms, self.first) = (0, true);
    }

    /// Executes a scan; the milliseconds since the one before, unless the PLC stops.
    fn step(&mut self, step: &Step) -> Option<u32> {
        if step.power {
            self.machine.power_cycle();
            self.hal.restart();
            (self.now_ms, self.first) = (0, true);
        }
        if step.stop {
            self.machine.set_running(false);
            self.machine.scan(&mut self.hal, self.now_ms, 0);
            self.machine.set_running(true);
            self.first = true;
        }
        for &event in &step.between {
            match event {
                Between::Tick(ms) => {
                    let now_ms = self.now_ms.wrapping_add(ms);
                    self.machine.tick(&mut self.hal, now_ms);
                }
                Between::Edge(number, level) => {
                    self.machine.input_edge(&mut self.hal, number, level);
                }
                Between::Interrupts => self.machine.take_interrupts(&mut self.hal),
            }
        }
        for &(key, value) in &step.set {
            set(&mut self.machine, &mut self.hal, key, value);
        }
        if !step.power {
            self.now_ms = self.now_ms.wrapping_add(step.ms);
        }
        self.machine.scan(&mut self.hal, self.now_ms, step.scan_us);
        let stops = self.machine.last_error().stop != Stop::No || !self.machine.sys().running;
        let elapsed = match std::mem::take(&mut self.first) {
            true => 0,
            false => step.ms,
        };
        (!stops).then_some(elapsed)
    }
}

/// Programs that run side by side with the same events, and what is asked of them.
pub struct Rig<'m, 'c> {
    /// One program, or two that are compared.
    pub plants: Vec<Plant<'m>>,
    goal: Goal<'c>,
    assumed: &'c [Condition],
    /// The assumptions, as each program has kept them.
    monitors: Vec<Monitor<'c>>,
    watcher: Option<Watcher<'c>>,
    scans: usize,
}

/// State of a [`Rig`] at one moment.
#[derive(Clone)]
pub struct Moment<'c> {
    plants: Vec<(Saved, Option<Box<VirtualHal>>, u32, bool)>,
    monitors: Vec<Monitor<'c>>,
    watcher: Option<Watcher<'c>>,
    scans: usize,
}

impl<'m, 'c> Rig<'m, 'c> {
    /// At the first power-on.
    pub fn new(modules: &[&'m Module], goal: Goal<'c>, assumed: &'c [Condition]) -> Self {
        Rig {
            plants: modules.iter().map(|module| Plant::new(module)).collect(),
            goal,
            assumed,
            monitors: vec![Monitor::new(assumed); modules.len()],
            watcher: watcher(goal),
            scans: 0,
        }
    }

    /// Nothing has been seen since power-on, or since RUN.
    fn forget(&mut self) {
        self.monitors.fill(Monitor::new(self.assumed));
        self.watcher = watcher(self.goal);
        self.scans = 0;
    }

    /// Begins anew, with these values in latched memory.
    pub fn begin(&mut self, start: &[(Key, i64)]) {
        self.plants.iter_mut().for_each(|plant| plant.begin(start));
        self.forget();
    }

    /// The most milliseconds that a program asks for from this scan to the next.
    pub fn constant_scan_ms(&self) -> u32 {
        let asked = self
            .plants
            .iter()
            .filter_map(|plant| plant.machine.constant_scan_ms());
        asked.max().unwrap_or(0).into()
    }

    /// Executes a scan of each.
    pub fn step(&mut self, step: &Step) -> State {
        if step.power || step.stop {
            self.forget();
        }
        self.scans += 1;
        let mut plants = self.plants.iter_mut();
        let elapsed: Vec<Option<u32>> = plants.by_ref().map(|plant| plant.step(step)).collect();
        if let Goal::Differs(_) = self.goal
            && elapsed.iter().any(Option::is_some) != elapsed.iter().all(Option::is_some)
        {
            return State::Happened;
        }
        let Some(&Some(elapsed)) = elapsed.first() else {
            return State::Over;
        };
        let mut kept = true;
        for (plant, monitor) in self.plants.iter().zip(&mut self.monitors) {
            kept &= monitor.all_hold(&plant.machine, elapsed);
        }
        if !kept {
            return State::Over;
        }
        let happened = match (self.goal, &mut self.watcher) {
            (Goal::Lives(scans), _) => self.scans >= scans,
            (Goal::Differs(outputs), _) => outputs.iter().any(|&number| {
                let mut states = self.plants.iter().map(|plant| plant.machine.output(number));
                let first = states.next();
                states.any(|state| Some(state) != first)
            }),
            (Goal::Event(_), Some(watcher)) => self
                .plants
                .iter()
                .any(|plant| watcher.happened(&plant.machine, elapsed)),
            (Goal::Event(_), None) => false,
        };
        match happened {
            true => State::Happened,
            false => State::Lives,
        }
    }

    /// Its state now.
    pub fn save(&self) -> Moment<'c> {
        let plants = self.plants.iter();
        Moment {
            plants: plants
                .map(|p| {
                    let hal = p.has_hardware.then(|| Box::new(p.hal.clone()));
                    (p.machine.save(), hal, p.now_ms, p.first)
                })
                .collect(),
            monitors: self.monitors.clone(),
            watcher: self.watcher.clone(),
            scans: self.scans,
        }
    }

    /// Comes back to a state.
    pub fn restore(&mut self, moment: &Moment<'c>) {
        for (plant, (saved, hal, now_ms, first)) in self.plants.iter_mut().zip(&moment.plants) {
            plant.machine.restore(saved);
            if let Some(hal) = hal {
                plant.hal.clone_from(hal);
            }
            (plant.now_ms, plant.first) = (*now_ms, *first);
        }
        self.monitors.clone_from(&moment.monitors);
        self.watcher = moment.watcher.clone();
        self.scans = moment.scans;
    }
}

fn watcher(goal: Goal) -> Option<Watcher> {
    match goal {
        Goal::Event(property) => Some(Watcher::new(property)),
        Goal::Differs(_) | Goal::Lives(_) => None,
    }
}

/// Executes a run from power-on: after how many of its scans what is searched for has happened. `None`: it does not, or
/// the run is over before, or a scan comes earlier than the program asks for.
pub fn replay(modules: &[&Module], goal: Goal, assumed: &[Condition], run: &Run) -> Option<usize> {
    let mut rig = Rig::new(modules, goal, assumed);
    rig.begin(&run.start);
    for (n, step) in run.steps.iter().enumerate() {
        if n > 0 && !step.power && !step.stop && step.ms < rig.constant_scan_ms() {
            return None;
        }
        match rig.step(step) {
            State::Lives => {}
            State::Over => return None,
            State::Happened => return Some(n + 1),
        }
    }
    None
}
