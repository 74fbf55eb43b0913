//! Runs of programs on the interpreter, and what is asked of them: independent of the prover's logic and its replays.

use rungc_interp::{Machine, Saved, rt_class};
use rungc_ir::Module;
use rungc_rt::{Class, Plc, Program, Stop, VirtualHal};
use rungc_sim::property::{Condition, Monitor, Property, Watcher};
use rungc_syntax::DeviceClass::{X, Y, Z};
use rungc_verify::model::{CounterPart, Key, TimerPart};
use rungc_verify::replay::has_hardware;
use rungc_verify::search::{Scan, Trace};
use rungc_verify::steered::{Between, Run, State, Step, Subject, distance, value_of};
use std::collections::BTreeMap;

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

    /// Turns the RUN/STOP switch.
    fn switch(&mut self, running: bool) {
        self.machine.set_running(running);
        self.hal.set_running(running);
    }

    /// Executes a scan; the milliseconds since the one before, unless the PLC stops.
    fn step(&mut self, step: &Step) -> Option<u32> {
        // Where nothing else happens between two scans, STOP takes the last millisecond, and a scan the one before.
        let is_calm = step.between.is_empty();
        let ms = match step.stop && is_calm {
            true => step.ms.max(2),
            false => step.ms,
        };
        if step.power {
            self.machine.power_cycle();
            self.hal.restart();
            (self.now_ms, self.first) = (0, true);
        }
        if step.stop {
            self.switch(false);
            let stop_ms = if is_calm { ms - 1 } else { 0 };
            let now_ms = self.now_ms.wrapping_add(stop_ms);
            self.hal.scan(&mut self.machine, now_ms, 1000);
            self.switch(true);
            self.first = true;
        }
        let mut now_ms = self.now_ms;
        for &event in &step.between {
            match event {
                Between::Tick(ms) => {
                    now_ms = self.now_ms.wrapping_add(ms);
                    self.hal.advance_to(now_ms);
                    self.machine.tick(&mut self.hal, now_ms);
                }
                Between::Edge(number, level) => {
                    self.machine.input_edge(&mut self.hal, number, level);
                }
                Between::Interrupts => self.machine.take_interrupts(&mut self.hal),
                Between::Set(key, value) => set(&mut self.machine, &mut self.hal, key, value),
                Between::Stop(ms) => {
                    self.switch(false);
                    self.hal.scan(&mut self.machine, now_ms, ms * 1000);
                }
                Between::Run => {
                    self.switch(true);
                    self.first = true;
                }
            }
        }
        for &(key, value) in &step.set {
            set(&mut self.machine, &mut self.hal, key, value);
        }
        if !step.power {
            self.now_ms = self.now_ms.wrapping_add(ms);
        }
        self.hal.scan(&mut self.machine, self.now_ms, step.scan_us);
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
}

impl<'c> Subject for Rig<'_, 'c> {
    type Moment = Moment<'c>;

    fn begin(&mut self, start: &[(Key, i64)]) {
        self.plants.iter_mut().for_each(|plant| plant.begin(start));
        self.forget();
    }

    fn constant_scan_ms(&self) -> u32 {
        let asked = self
            .plants
            .iter()
            .filter_map(|plant| plant.machine.constant_scan_ms());
        asked.max().unwrap_or(0).into()
    }

    fn step(&mut self, step: &Step) -> State {
        if step.power || step.stop || step.between.contains(&Between::Run) {
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

    fn save(&self) -> Self::Moment {
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

    fn restore(&mut self, moment: &Self::Moment) {
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

    fn programs(&self) -> usize {
        self.plants.len()
    }

    fn value(&self, program: usize, key: Key) -> i64 {
        value_of(&self.plants[program].machine, key)
    }

    fn distance(&self) -> f64 {
        match (self.goal, self.plants.first()) {
            (Goal::Event(property), Some(plant)) => distance(property, &plant.machine),
            _ => 0.0,
        }
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
        let begins = step.power || step.stop || step.between.contains(&Between::Run);
        if n > 0 && !begins && step.ms < rig.constant_scan_ms() {
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

/// A run that the prover has found, with all that happens between scans. Where nothing does, devices are set before
/// scans.
pub fn run_of(modules: &[&Module], trace: &Trace) -> Run {
    let takes_events = modules.iter().any(|module| module.takes_events());
    let mut inputs = BTreeMap::new();
    let steps = trace.scans.iter().enumerate().map(|(n, scan)| {
        let plain = Step {
            ms: if scan.restart {
                scan.ms.max(2)
            } else {
                scan.ms
            },
            scan_us: scan.scan_time * 100,
            ..Step::default()
        };
        match takes_events {
            true => Step {
                between: between(scan, n == 0, &mut inputs),
                ..plain
            },
            false => Step {
                stop: scan.restart,
                set: scan.set.iter().map(|(&key, &value)| (key, value)).collect(),
                ..plain
            },
        }
    });
    Run {
        start: trace
            .start
            .iter()
            .map(|(&key, &value)| (key, value))
            .collect(),
        steps: steps.collect(),
    }
}

/// Everything that happens before a scan of a found run: time passes, at its end perhaps a millisecond in STOP, and
/// then devices are set, inputs with edges, in the order of their names.
fn between(scan: &Scan, is_first: bool, inputs: &mut BTreeMap<u32, bool>) -> Vec<Between> {
    let mut events = Vec::new();
    let until_ms = if scan.restart {
        scan.ms.max(2) - 1
    } else {
        scan.ms
    };
    for ms in 1..=until_ms {
        events.extend([Between::Tick(ms), Between::Interrupts]);
    }
    if scan.restart {
        let back = Between::Tick(until_ms + 1);
        events.extend([Between::Stop(1), back, Between::Interrupts, Between::Run]);
    }
    let mut set: Vec<(Key, i64)> = scan.set.iter().map(|(&key, &value)| (key, value)).collect();
    set.sort_by_key(|(key, _)| match key {
        Key::Bit(X, _) => 1,
        Key::Bit(Y, _) | Key::Word(Z, _) => 2,
        _ => 0,
    });
    for (key, value) in set {
        if let Key::Bit(X, number) = key {
            let on = value != 0;
            let before = inputs.insert(number, on).unwrap_or(false);
            if !is_first && before != on {
                events.push(Between::Edge(number, on));
            }
        }
        events.push(Between::Set(key, value));
    }
    events
}
