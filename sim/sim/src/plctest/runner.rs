//! Runs a case on an engine.

use super::lines::Lines;
use super::modules::{MILLION, millionths};
use super::rules::Watch;
use super::servers::Servers;
use super::trace::Tracer;
use super::wiring;
use super::{Case, Check, Failure, Port, Run, Setting, Step, Value};
use crate::engines::{Engine, EngineError};
use crate::plant::{Description, Plant};
use crate::protocol::{Answer, Request};
use crate::target::Target;
use crate::wire::{self, Change};
use rungc_interp::rt_class;
use rungc_ir::Module;
use rungc_rt::{Class, FIRST_COUNTER32};
use rungc_syntax::DeviceClass;
use std::collections::{BTreeMap, BTreeSet};

/// Relative tolerance of floats.
const FLOAT_TOLERANCE: f64 = 1e-5;

/// Relative tolerance of frequencies.
const FREQUENCY_TOLERANCE: f64 = 0.01;

/// Relative tolerance of analog signals.
const CHANNEL_TOLERANCE: f64 = 0.001;

/// Runs a case: its own program and those of the other PLCs, each with its number among the engine's.
///
/// # Errors
/// Why it fails.
pub fn run_steps(
    engine: &mut dyn Engine,
    case: &Case,
    programs: &[(usize, &Module)],
) -> Result<(), Failure> {
    let Check::Steps { init, steps } = &case.check else {
        return Ok(());
    };
    wiring::check(case.machine.as_deref(), case.model, init, steps)?;
    let plcs = programs
        .iter()
        .map(|&(number, module)| PlcInfo::of(number, module));
    let servers = Servers::new(&case.serve, programs[0].1);
    run_case(engine, case, (plcs.collect(), servers), init, steps)
}

/// Properties of a PLC for the runner.
pub(super) struct PlcInfo {
    /// Its program in the batch.
    module: usize,
    /// True if the program reacts to events outside its scan.
    takes_events: bool,
    /// True if it sends pulses.
    sends_pulses: bool,
    /// True if the program may ask for scans of constant length.
    uses_constant_scan: bool,
    /// Its serial ports.
    pub(super) ports: Vec<u8>,
}

impl PlcInfo {
    fn of(number: usize, program: &Module) -> Self {
        PlcInfo {
            module: number,
            takes_events: program.takes_events(),
            sends_pulses: program.sends_pulses(),
            uses_constant_scan: uses_constant_scan(program),
            ports: program.ports.clone(),
        }
    }
}

/// Returns true if the module stores the devices that request scans of constant length.
fn uses_constant_scan(module: &Module) -> bool {
    let Some(asks) = module.model.constant_scan() else {
        return false;
    };
    let mut areas = module.layout.areas.iter();
    let register = asks.register.number();
    areas.any(|area| {
        area.class == DeviceClass::D && (area.first..area.first + area.count).contains(&register)
    })
}

/// A case while it runs.
pub(super) struct Running<'e> {
    pub(super) engine: &'e mut dyn Engine,
    /// The step that runs, from 1.
    pub(super) step: usize,
    now_ms: u32,
    /// State of the input terminals of each PLC, which a power cycle does not change.
    inputs: BTreeMap<(usize, u32), bool>,
    /// The PLC of the case, and the others.
    pub(super) plcs: Vec<PlcInfo>,
    /// The PLC selected last.
    current: usize,
    /// The names of the others.
    names: Vec<String>,
    /// True if a scan has run since power-on.
    scanned: bool,
    /// Minimum scan time in milliseconds, as the last scan requested.
    constant_ms: u32,
    /// The machine around the PLC.
    pub(super) plant: Option<Plant>,
    /// The serial lines.
    pub(super) lines: Lines,
    /// The servers over TCP.
    pub(super) servers: Servers,
    /// The PLCs that were put in STOP.
    stopped: BTreeSet<usize>,
}

fn run_case(
    engine: &mut dyn Engine,
    case: &Case,
    (plcs, servers): (Vec<PlcInfo>, Servers),
    init: &[Setting],
    steps: &[Step],
) -> Result<(), Failure> {
    let mut running = Running {
        engine,
        step: 0,
        now_ms: 0,
        inputs: BTreeMap::new(),
        plcs,
        current: 0,
        names: case.others.iter().map(|other| other.name.clone()).collect(),
        scanned: false,
        constant_ms: 0,
        plant: case.machine.as_deref().map(Description::plant),
        lines: Lines::new(&case.wires),
        servers,
        stopped: BTreeSet::new(),
    };
    running.power_up()?;
    running.fit(case)?;
    running.set_all(init)?;
    for other in &case.others {
        running.set_all(&other.init)?;
    }
    running.select(0)?;
    running.wire_up()?;
    let mut watch = Watch::new(&case.rules, case.model);
    let mut tracer = case.trace.as_ref().map(Tracer::new);
    for (i, step) in steps.iter().enumerate() {
        running.step = i + 1;
        watch.begin(step);
        tracer.iter_mut().for_each(|tracer| tracer.begin(i + 1));
        running.run_step(step, &mut watch, tracer.as_mut())?;
    }
    running.end_case(&watch)?;
    tracer.map_or(Ok(()), Tracer::end)
}

impl Running<'_> {
    pub(super) fn execute(&mut self, request: Request) -> Result<Answer, Failure> {
        self.engine
            .execute(request)
            .map_err(|error| self.failed(&error))
    }

    pub(super) fn failed(&self, error: &EngineError) -> Failure {
        Failure::Engine {
            step: self.step,
            message: error.to_string(),
        }
    }

    /// Asks for something that must exist.
    pub(super) fn insist(&mut self, request: Request) -> Result<(), Failure> {
        match self.execute(request)? {
            Answer::Missing => Err(self.failed(&EngineError::Missing(request))),
            _ => Ok(()),
        }
    }

    /// All PLCs of the case as they come.
    fn power_up(&mut self) -> Result<(), Failure> {
        for i in 0..self.plcs.len() {
            let module = self.plcs[i].module;
            self.execute(if i == 0 {
                Request::Case(module)
            } else {
                Request::Join(module)
            })?;
        }
        Ok(())
    }

    /// Selects the PLC for the following requests.
    pub(super) fn select(&mut self, plc: usize) -> Result<(), Failure> {
        if self.current != plc {
            self.execute(Request::Plc(plc))?;
            self.current = plc;
        }
        Ok(())
    }

    /// Puts the RUN/STOP switch of a PLC.
    pub(super) fn switch(&mut self, plc: usize, running: bool) -> Result<(), Failure> {
        if running {
            self.stopped.remove(&plc);
        } else {
            self.stopped.insert(plc);
        }
        self.select(plc)?;
        self.execute(Request::Run(running)).map(drop)
    }

    /// Returns true if that switch is at RUN.
    pub(super) fn is_running(&self, plc: usize) -> bool {
        !self.stopped.contains(&plc)
    }

    /// Time since power-on in milliseconds, wrapping.
    pub(super) fn now_ms(&self) -> u32 {
        self.now_ms
    }

    /// Time since power-on in microseconds, wrapping.
    pub(super) fn now_us(&self) -> u32 {
        self.now_ms.wrapping_mul(1000)
    }

    /// The name of a port with that of its PLC.
    pub(super) fn port_name(&self, port: &Port) -> String {
        match port.plc.checked_sub(1).and_then(|i| self.names.get(i)) {
            Some(name) => format!("{name}:{}", port.id),
            None => port.id.to_string(),
        }
    }

    fn power_cycle(&mut self) -> Result<(), Failure> {
        self.now_ms = 0;
        self.scanned = false;
        self.constant_ms = 0;
        self.plant.iter_mut().for_each(Plant::power_cycle);
        self.lines.power_cycle();
        self.stopped.clear();
        for plc in 0..self.plcs.len() {
            self.select(plc)?;
            self.execute(Request::Power)?;
        }
        for ((plc, number), on) in self.inputs.clone() {
            self.select(plc)?;
            self.execute(Request::SetBit(Class::X, number, on))?;
        }
        Ok(())
    }

    /// Applies the settings of a step before its first scan.
    fn begin_step(&mut self, step: &Step) -> Result<(), Failure> {
        if step.power_cycle {
            self.power_cycle()?;
        }
        for &(plc, running) in &step.running {
            self.switch(plc, running)?;
        }
        if let Some(fails) = step.power_fails {
            for plc in 0..self.plcs.len() {
                self.select(plc)?;
                self.insist(Request::SetPowerFails(fails))?;
            }
        }
        if let Some(clock) = step.clock {
            for plc in 0..self.plcs.len() {
                self.select(plc)?;
                self.insist(Request::SetClock(clock))?;
            }
        }
        self.select(0)?;
        for &(unit, address, value) in &step.bfm {
            self.insist(Request::SetBfm(unit, address, value))?;
        }
        self.delay_modules(step.answers_after.iter().copied())?;
        for &(channel, value) in &step.analog {
            self.insist(Request::SetAnalog(channel, value))?;
        }
        self.set_all(&step.set)?;
        self.begin_servers(step)?;
        self.begin_lines(step)
    }

    fn run_step(
        &mut self,
        step: &Step,
        watch: &mut Watch,
        mut tracer: Option<&mut Tracer>,
    ) -> Result<(), Failure> {
        self.begin_step(step)?;
        let scans = match step.run {
            Run::Scans(scans) => scans,
            Run::Ms(ms) => ms.div_ceil(step.scan_ms),
        };
        // A signal continues to its end.
        let signals = step.signals.iter().map(|signal| signal.duration_us());
        let signals = signals.max().unwrap_or(0).div_ceil(1000);
        let needed = signals.div_ceil(step.scan_ms.into()).try_into();
        let scans = scans.max(needed.unwrap_or(u32::MAX));
        let changes = wire::changes(&step.signals);
        let mut changes = changes.iter().peekable();
        let begin_ms = self.now_ms;
        let needed_ms = scans.saturating_mul(step.scan_ms);
        let (mut done, mut ended) = (0, false);
        while !ended
            && match step.run {
                Run::Scans(_) => done < scans,
                Run::Ms(_) => self.now_ms.wrapping_sub(begin_ms) < needed_ms,
            }
        {
            let scan_begin_ms = self.now_ms;
            let scan_ms = self.scan(step.scan_ms)?;
            done += 1;
            self.judge(watch, scan_begin_ms, scan_ms)?;
            for _ in 0..scan_ms {
                self.now_ms = self.now_ms.wrapping_add(1);
                self.select(0)?;
                let begin_us = u64::from(begin_ms) * 1000;
                let now_us = u64::from(self.now_ms.wrapping_sub(begin_ms)) * 1000;
                let mut others = Vec::new();
                while let Some(&change) = changes.next_if(|change| change.at_us < now_us) {
                    others.push(Change {
                        at_us: begin_us + change.at_us,
                        ..change
                    });
                }
                self.move_machine(self.now_ms, &others)?;
                self.tick()?;
            }
            self.wait(watch, begin_ms)?;
            if let Some(tracer) = &mut tracer {
                tracer.scanned(self)?;
            }
            ended = !step.until.is_empty() && self.holds(&step.until)?;
        }
        self.end_watch(watch, step, ended)?;
        self.select(0)?;
        self.check(step)
    }

    /// A scan of all PLCs; how many milliseconds it lasts. They scan together, so the longest constant scan time holds
    /// for all.
    fn scan(&mut self, scan_ms: u32) -> Result<u32, Failure> {
        let scan_us = scan_ms.max(self.constant_ms).saturating_mul(1000);
        self.constant_ms = 0;
        for plc in 0..self.plcs.len() {
            self.select(plc)?;
            self.execute(Request::Scan {
                now_ms: self.now_ms,
                scan_us,
            })?;
            if self.plcs[plc].uses_constant_scan
                && let Answer::Value(ms) = self.execute(Request::ConstantScan)?
            {
                self.constant_ms = self.constant_ms.max(ms.try_into().unwrap_or(0));
            }
        }
        self.scanned = true;
        Ok(scan_ms.max(self.constant_ms))
    }

    /// A millisecond has passed.
    fn tick(&mut self) -> Result<(), Failure> {
        self.deliver()?;
        for plc in 0..self.plcs.len() {
            if self.plcs[plc].takes_events {
                self.select(plc)?;
                self.execute(Request::Tick(self.now_ms))?;
                self.interrupts()?;
            }
        }
        self.select(0)?;
        self.serve()?;
        self.carry()
    }

    fn check(&mut self, step: &Step) -> Result<(), Failure> {
        let mut values = self.end_lines(step)?;
        values.extend(self.end_servers(step));
        for setting in &step.expect {
            if let Some(actual) = self.differs(setting)? {
                let name = self.name_of(setting.plc, setting.target);
                values.push((name, setting.value.clone(), actual));
            }
        }
        self.select(0)?;
        for &(unit, address, expected) in &step.expect_bfm {
            let request = Request::Bfm(unit, address);
            let Answer::Value(actual) = self.execute(request)? else {
                return Err(self.failed(&EngineError::Missing(request)));
            };
            if actual != i64::from(expected) {
                let name = format!("buffer memory {unit}:{address}");
                values.push((name, Value::Int(expected.into()), Value::Int(actual as i32)));
            }
        }
        values.extend(self.wrong_positions(&step.expect_position));
        if values.is_empty() {
            return Ok(());
        }
        Err(Failure::Differs {
            step: self.step,
            line: step.line,
            values,
        })
    }

    /// Value of a device, in the shape of its expected value.
    pub(super) fn current(&mut self, setting: &Setting) -> Result<Value, Failure> {
        self.select(setting.plc)?;
        self.get(setting.target, &setting.value)
    }

    /// Value of a device, if it differs from the expectation.
    pub(super) fn differs(&mut self, setting: &Setting) -> Result<Option<Value>, Failure> {
        let actual = self.current(setting)?;
        Ok((!agrees(setting, &actual)).then_some(actual))
    }

    /// The name of a device with that of its PLC.
    pub(super) fn name_of(&self, plc: usize, target: Target) -> String {
        match plc.checked_sub(1).and_then(|i| self.names.get(i)) {
            Some(name) => format!("{name}:{target}"),
            None => target.to_string(),
        }
    }

    fn set_all(&mut self, settings: &[Setting]) -> Result<(), Failure> {
        settings.iter().try_for_each(|s| self.set(s))
    }

    fn set(&mut self, setting: &Setting) -> Result<(), Failure> {
        self.select(setting.plc)?;
        if let (Target::Channel(channel), Value::Float(value)) = (setting.target, &setting.value) {
            return match self.connect_channel(channel, millionths(*value))? {
                true => Ok(()),
                false => Err(self.no_device(setting.target)),
            };
        }
        for request in requests(setting) {
            if let Request::SetBit(Class::X, number, on) = request {
                self.input(number, on)?;
            }
            if self.execute(request)? == Answer::Missing {
                return Err(self.no_device(setting.target));
            }
        }
        Ok(())
    }

    /// Returns true if the selected PLC reacts to events outside its scan.
    fn takes_events(&self) -> bool {
        self.plcs
            .get(self.current)
            .is_some_and(|plc| plc.takes_events)
    }

    /// Returns true if the selected PLC sends pulses.
    pub(super) fn sends_pulses(&self) -> bool {
        self.plcs
            .get(self.current)
            .is_some_and(|plc| plc.sends_pulses)
    }

    /// An input terminal of the selected PLC is on or off from now.
    pub(super) fn input(&mut self, number: u32, on: bool) -> Result<(), Failure> {
        let before = self.inputs.insert((self.current, number), on);
        let before = before.unwrap_or(false);
        // Inputs that are on at power-on have no edge.
        if self.takes_events() && self.scanned && on != before {
            self.execute(Request::Edge(number, on))?;
        }
        Ok(())
    }

    /// Interrupts are taken between two scans.
    pub(super) fn interrupts(&mut self) -> Result<(), Failure> {
        if self.takes_events() {
            self.execute(Request::Interrupts)?;
        }
        Ok(())
    }

    fn no_device(&self, target: Target) -> Failure {
        Failure::NoDevice {
            step: self.step,
            target,
        }
    }

    /// One value of the engine, for `target`.
    fn value(&mut self, target: Target, request: Request) -> Result<i64, Failure> {
        match self.execute(request)? {
            Answer::Value(value) => Ok(value),
            _ => Err(self.no_device(target)),
        }
    }

    /// Value of the target, in the shape of its expected value.
    fn get(&mut self, target: Target, expected: &Value) -> Result<Value, Failure> {
        let class = |class| rt_class(class).unwrap_or(Class::D);
        let int = |value: i64| Value::Int(value as i32);
        match target {
            Target::Bit(DeviceClass::Y, n) => self.value(target, Request::Output(n)).map(int),
            Target::Bit(c, n) => self.value(target, Request::Bit(class(c), n)).map(int),
            Target::Current(DeviceClass::C, n @ FIRST_COUNTER32..) => {
                self.value(target, Request::Double(Class::C, n)).map(int)
            }
            Target::Word(c, n) | Target::Current(c, n) => {
                self.value(target, Request::Word(class(c), n)).map(int)
            }
            Target::Pair(c, n) => self.value(target, Request::Double(class(c), n)).map(int),
            Target::Float(c, n) => {
                let bits = self.value(target, Request::Double(class(c), n))?;
                Ok(Value::Float(f32::from_bits(bits as u32).into()))
            }
            Target::Nibbles(digits, c, first) => {
                let mut value = 0u32;
                for n in (first..).take(4 * usize::from(digits)) {
                    let on = match c {
                        DeviceClass::Y => Request::Output(n),
                        _ => Request::Bit(class(c), n),
                    };
                    let on = self.value(target, on)?;
                    value |= u32::from(on != 0) << (n - first);
                }
                let value = value as i32;
                Ok(Value::Int(if digits <= 4 {
                    (value as i16).into()
                } else {
                    value
                }))
            }
            Target::Text(c, first) => {
                let len = match expected {
                    Value::Text(text) => text.len(),
                    _ => 0,
                };
                let mut bytes = Vec::new();
                for i in 0..len.div_ceil(2) as u32 {
                    let word = Request::Word(class(c), first.saturating_add(i));
                    bytes.extend((self.value(target, word)? as u16).to_le_bytes());
                }
                bytes.truncate(len);
                Ok(Value::Text(String::from_utf8_lossy(&bytes).into_owned()))
            }
            Target::Pulses(n) => self.value(target, Request::Pulses(n)).map(int),
            Target::Frequency(n) => {
                let millihertz = self.value(target, Request::Frequency(n))?;
                Ok(Value::Float(millihertz as f64 / 1000.0))
            }
            Target::Channel(channel) => {
                let now_ms = self.now_ms;
                let signal = self.value(target, Request::Signal { now_ms, channel })?;
                Ok(Value::Float(signal as f64 / MILLION))
            }
        }
    }
}

/// Requests that set a target.
fn requests(setting: &Setting) -> Vec<Request> {
    let (class, number, _) = setting.target.devices(0);
    let class = rt_class(class).unwrap_or(Class::D);
    match (setting.target, &setting.value) {
        (Target::Bit(..), Value::Int(v)) => vec![Request::SetBit(class, number, *v != 0)],
        (Target::Current(DeviceClass::C, FIRST_COUNTER32..) | Target::Pair(..), Value::Int(v)) => {
            vec![Request::SetDouble(class, number, *v)]
        }
        (Target::Word(..) | Target::Current(..), Value::Int(v)) => {
            vec![Request::SetWord(class, number, *v as i16)]
        }
        (Target::Float(..), Value::Float(v)) => {
            let bits = (*v as f32).to_bits() as i32;
            vec![Request::SetDouble(class, number, bits)]
        }
        (Target::Nibbles(digits, ..), Value::Int(v)) => (0..4 * u32::from(digits))
            .map(|i| Request::SetBit(class, number.saturating_add(i), v >> i & 1 == 1))
            .collect(),
        (Target::Text(..), Value::Text(text)) => text
            .as_bytes()
            .chunks(2)
            .zip(number..)
            .map(|(bytes, n)| {
                let high = bytes.get(1).copied().unwrap_or(0);
                Request::SetWord(class, n, i16::from_le_bytes([bytes[0], high]))
            })
            .collect(),
        // Pulse outputs are not set, and the reader gives every other target a value of its kind.
        _ => Vec::new(),
    }
}

fn agrees(setting: &Setting, actual: &Value) -> bool {
    let relative = match setting.target {
        Target::Frequency(_) => FREQUENCY_TOLERANCE,
        Target::Channel(_) => CHANNEL_TOLERANCE,
        _ => FLOAT_TOLERANCE,
    };
    match (&setting.value, actual, setting.tolerance) {
        (Value::Float(e), Value::Float(a), tolerance) => {
            let enough = tolerance.unwrap_or(relative * e.abs());
            e == a || (e.is_nan() && a.is_nan()) || (a - e).abs() <= enough
        }
        (Value::Int(e), Value::Int(a), Some(tolerance)) => {
            f64::from(*a) - f64::from(*e) <= tolerance && f64::from(*e) - f64::from(*a) <= tolerance
        }
        (expected, actual, _) => expected == actual,
    }
}
