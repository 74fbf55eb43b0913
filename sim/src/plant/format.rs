//! Reading the description of a machine: TOML to [`Plant`], every mistake with its place.

use super::Plant;
use super::axis::{Axis, Back, Drive};
use super::delay::Delay;
use super::marks::{Marks, Switch};
use crate::problem::{self, LoadError, Problem};
use crate::target::Target;
use rungc_models::Model;
use rungc_syntax::{DeviceClass, Source};
use serde::Deserialize;
use std::path::Path;
use toml::Spanned;

/// The longest time of a cylinder or delay, in milliseconds: an hour.
const LONGEST_MS: u32 = 3_600_000;

/// The greatest speed of an axis and of what it makes of it at an input: a million a second.
const FASTEST: f64 = 1_000_000.0;

/// How many cycles of an encoder a pulse may make at most.
const CYCLES_PER_PULSE: f64 = 10.0;

/// The shortest length after which something comes again.
const SHORTEST: f64 = 1e-6;

const TOO_OFTEN: &str = "this comes more often than 10 times a pulse, or a million times a second";

/// The greatest length, in pulses or units: beyond the 32 bits that a PLC counts.
const LONGEST: f64 = 1e10;

/// A machine as a file describes it.
#[derive(Clone, Debug)]
pub struct Description {
    source: Source,
    plant: Plant,
    terminals: Vec<Terminal>,
}

/// A terminal that the file names, and where.
#[derive(Clone, Copy, Debug)]
struct Terminal {
    class: DeviceClass,
    number: u32,
    at: usize,
}

impl Description {
    /// The machine at rest where it begins.
    pub fn plant(&self) -> Plant {
        self.plant.clone()
    }

    /// The file's name.
    pub fn name(&self) -> &str {
        &self.source.name
    }

    /// The terminals of the PLC that the machine is wired to.
    pub fn terminals(&self) -> impl Iterator<Item = (DeviceClass, u32)> {
        self.terminals.iter().map(|t| (t.class, t.number))
    }

    /// Whether the machine drives this device.
    pub fn drives(&self, class: DeviceClass, number: u32) -> bool {
        class == DeviceClass::X && self.terminals().any(|t| t == (class, number))
    }

    /// Whether a PLC of this model has the terminals that the file names.
    pub fn check(&self, model: &Model) -> Result<(), LoadError> {
        let has = |t: &Terminal| {
            let mut ranges = model.ranges_of(t.class);
            ranges.any(|range| (range.first..=range.last).contains(&t.number))
        };
        let missing = self.terminals.iter().filter(|t| !has(t));
        let problems: Vec<_> = missing
            .map(|t| {
                let name = t.class.number(t.number);
                let message = format!("`{name}` does not exist on {}", model.title);
                Problem::at(&self.source, t.at, message)
            })
            .collect();
        if problems.is_empty() {
            return Ok(());
        }
        Err(LoadError::Format {
            name: self.source.name.clone(),
            problems,
        })
    }
}

/// Reads the description of a machine.
pub fn load(path: &Path) -> Result<Description, LoadError> {
    describe(problem::read(path)?)
}

/// Reads the text of a description.
pub fn parse(name: &str, text: &str) -> Result<Description, LoadError> {
    describe(Source::new(name, text))
}

fn describe(source: Source) -> Result<Description, LoadError> {
    let read = problem::from_toml(&source).and_then(|raw| {
        let mut reader = Reader::new(&source);
        let plant = reader.machine(raw);
        if reader.problems.is_empty() {
            return Ok((plant, reader.terminals));
        }
        reader.problems.sort_by_key(|p| (p.line, p.column));
        Err(reader.problems)
    });
    match read {
        Ok((plant, terminals)) => Ok(Description {
            source,
            plant,
            terminals,
        }),
        Err(problems) => Err(LoadError::Format {
            name: source.name,
            problems,
        }),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawMachine {
    #[serde(default)]
    axis: Vec<Spanned<RawAxis>>,
    #[serde(default)]
    cylinder: Vec<Spanned<RawCylinder>>,
    #[serde(default)]
    delay: Vec<Spanned<RawDelay>>,
    #[serde(default)]
    normally_closed: Vec<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawAxis {
    name: Option<Spanned<String>>,
    unit: Option<String>,
    pulses_per_unit: Option<Spanned<f64>>,
    output: Option<Spanned<String>>,
    direction: Option<Spanned<String>>,
    direction_on: Option<Spanned<RawDirection>>,
    forward: Option<Spanned<String>>,
    reverse: Option<Spanned<String>>,
    speed: Option<Spanned<f64>>,
    start: Option<Spanned<f64>>,
    travel: Option<Spanned<Vec<f64>>>,
    home: Option<Spanned<String>>,
    home_at: Option<Spanned<Vec<f64>>>,
    forward_limit: Option<Spanned<String>>,
    forward_limit_at: Option<Spanned<f64>>,
    reverse_limit: Option<Spanned<String>>,
    reverse_limit_at: Option<Spanned<f64>>,
    zero_phase: Option<Spanned<String>>,
    zero_phase_every: Option<Spanned<f64>>,
    encoder: Option<RawEncoder>,
    #[serde(default)]
    switch: Vec<RawSwitch>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
enum RawDirection {
    Forward,
    Reverse,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawEncoder {
    a: Spanned<String>,
    b: Spanned<String>,
    cycles_per_unit: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSwitch {
    input: Spanned<String>,
    at: Spanned<Vec<f64>>,
    every: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawCylinder {
    extend: Spanned<String>,
    retract: Option<Spanned<String>>,
    extended: Option<Spanned<String>>,
    retracted: Option<Spanned<String>>,
    time_ms: Spanned<u32>,
    retract_ms: Option<Spanned<u32>>,
    start: Option<RawEnd>,
}

#[derive(Deserialize, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
enum RawEnd {
    Retracted,
    Extended,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawDelay {
    output: Spanned<String>,
    input: Spanned<String>,
    on_ms: Option<Spanned<u32>>,
    off_ms: Option<Spanned<u32>>,
}

/// How lengths of an axis are given.
#[derive(Clone, Copy)]
struct Scale {
    per_unit: f64,
    travel: Option<[f64; 2]>,
}

/// Collects the problems of one file.
struct Reader<'t> {
    source: &'t Source,
    problems: Vec<Problem>,
    terminals: Vec<Terminal>,
}

impl<'t> Reader<'t> {
    fn new(source: &'t Source) -> Self {
        Reader {
            source,
            problems: Vec::new(),
            terminals: Vec::new(),
        }
    }

    fn report(&mut self, at: usize, message: impl Into<String>) {
        let problem = Problem::at(self.source, at, message.into());
        self.problems.push(problem);
    }

    fn machine(&mut self, raw: RawMachine) -> Plant {
        let mut plant = Plant::default();
        if raw.axis.is_empty() && raw.cylinder.is_empty() && raw.delay.is_empty() {
            let message = "a machine has parts: write [[axis]], [[cylinder]] or [[delay]] tables";
            self.report(0, message);
        }
        for axis in raw.axis {
            let at = axis.span().start;
            if let Some(axis) = self.axis(at, axis.into_inner(), &plant.axes) {
                plant.axes.push(axis);
            }
        }
        for cylinder in raw.cylinder {
            let at = cylinder.span().start;
            plant
                .cylinders
                .extend(self.cylinder(at, cylinder.into_inner()));
        }
        for delay in raw.delay {
            let at = delay.span().start;
            plant.delays.extend(self.delay(at, delay.into_inner()));
        }
        for name in raw.normally_closed {
            plant.normally_closed.extend(self.closed(&name));
        }
        plant
    }

    /// An axis; `before` are those that stand above it.
    fn axis(&mut self, at: usize, raw: RawAxis, before: &[Axis]) -> Option<Axis> {
        let (drive, name) = self.drive(at, &raw)?;
        let named = raw.name.as_ref().map(|name| name.get_ref().clone());
        let name = named.unwrap_or(name);
        if let Drive::Pulses { output, .. } = drive
            && before.iter().any(|a| a.pulse_output() == Some(output))
        {
            let at = raw.output.as_ref().map_or(at, |output| output.span().start);
            self.report(at, "another axis follows the pulses of this output");
        } else if before.iter().any(|axis| axis.name == name) {
            let at = raw.name.as_ref().map_or(at, |name| name.span().start);
            self.report(at, format!("there are two axes `{name}`"));
        }
        if name.is_empty() || name.contains(char::is_control) {
            self.report(at, "the name of an axis is a text on one line");
        }
        let per_unit = match &raw.pulses_per_unit {
            Some(value) => self.positive(value, "pulses_per_unit")?,
            None => 1.0,
        };
        let travel = match &raw.travel {
            Some(travel) => Some(self.range(travel, per_unit)?),
            None => None,
        };
        let position = match &raw.start {
            Some(start) => self.length(start, per_unit)?,
            None => 0.0,
        };
        if let Some([min, max]) = travel
            && !(min..=max).contains(&position)
        {
            let at = raw.start.as_ref().map_or(at, |start| start.span().start);
            self.report(at, "the axis starts outside its travel");
        }
        let unit = match (raw.unit.clone(), &drive) {
            (Some(unit), _) => unit,
            (None, Drive::Pulses { .. }) if per_unit == 1.0 => "pulses".to_string(),
            (None, _) => "units".to_string(),
        };
        let fastest = match &drive {
            Drive::Pulses { .. } => CYCLES_PER_PULSE,
            Drive::Outputs { out_speed, .. } => FASTEST / (1000.0 * out_speed),
        };
        let switches = self.switches(&raw, Scale { per_unit, travel }, fastest);
        Some(Axis {
            name,
            unit,
            per_unit,
            drive,
            position,
            moved: 0.0,
            travel,
            switches,
            collision: None,
        })
    }

    /// What drives an axis, and the name of the output.
    fn drive(&mut self, at: usize, raw: &RawAxis) -> Option<(Drive, String)> {
        let of_motor = [&raw.reverse].into_iter().flatten().map(Spanned::span);
        let of_motor = of_motor.chain(raw.speed.as_ref().map(Spanned::span));
        let of_pulses = [&raw.direction].into_iter().flatten().map(Spanned::span);
        let of_pulses = of_pulses
            .chain(raw.direction_on.as_ref().map(Spanned::span))
            .chain(raw.pulses_per_unit.as_ref().map(Spanned::span));
        match (&raw.output, &raw.forward) {
            (Some(output), None) => {
                for span in of_motor {
                    self.report(span.start, "this goes with `forward`, not with `output`");
                }
                let number = self.output(output)?;
                let direction = match &raw.direction {
                    Some(direction) => Some(self.output(direction)?),
                    None => None,
                };
                if let (Some(name), true) = (&raw.direction, direction == Some(number)) {
                    let message = "the direction is told by another output than the pulses";
                    self.report(name.span().start, message);
                }
                if let (None, Some(on)) = (direction, &raw.direction_on) {
                    self.report(on.span().start, "this goes with `direction`");
                }
                let on = raw.direction_on.as_ref().map(|on| *on.get_ref());
                let forward = !matches!(on, Some(RawDirection::Reverse));
                let drive = Drive::Pulses {
                    output: number,
                    direction: direction.map(|output| (output, forward)),
                    followed: 0,
                };
                Some((drive, DeviceClass::Y.number(number).to_string()))
            }
            (None, Some(forward)) => {
                for span in of_pulses {
                    self.report(span.start, "this goes with `output`, not with `forward`");
                }
                let number = self.output(forward)?;
                let back = match &raw.reverse {
                    Some(reverse) => Back::Output(self.output(reverse)?),
                    None => Back::Nothing,
                };
                let Some(speed) = &raw.speed else {
                    self.report(at, "an axis with `forward` has a `speed` in units a second");
                    return None;
                };
                let speed = self.positive(speed, "speed")?;
                let drive = Drive::Outputs {
                    forward: number,
                    back,
                    out_speed: speed / 1000.0,
                    back_speed: speed / 1000.0,
                };
                Some((drive, DeviceClass::Y.number(number).to_string()))
            }
            (both, _) => {
                let message = match both {
                    Some(_) => "an axis has `output` (pulses) or `forward` (a motor), not both",
                    None => "an axis has `output` (pulses), or `forward` and `speed` (a motor)",
                };
                self.report(at, message);
                None
            }
        }
    }

    /// The switches and the encoder of an axis, which switches at most so many times in its unit of length.
    fn switches(&mut self, raw: &RawAxis, scale: Scale, fastest: f64) -> Vec<Switch> {
        let mut switches = Vec::new();
        let home = self.home(raw, scale);
        let forward = (&raw.forward_limit, &raw.forward_limit_at);
        let reverse = (&raw.reverse_limit, &raw.reverse_limit_at);
        let forward = self.limit("forward_limit", forward, scale, 1.0);
        let reverse = self.limit("reverse_limit", reverse, scale, -1.0);
        switches.extend([home, forward, reverse].into_iter().flatten());
        switches.extend(self.zero_phase(raw, scale, fastest));
        for switch in &raw.switch {
            switches.extend(self.switch(switch, scale, fastest));
        }
        if let Some(encoder) = &raw.encoder {
            switches.extend(self.encoder(encoder, scale, fastest).into_iter().flatten());
        }
        switches
    }

    /// The home switch, unless told otherwise the first twentieth of the way forward from 0.
    fn home(&mut self, raw: &RawAxis, scale: Scale) -> Option<Switch> {
        let input =
            self.switch_input("home", &raw.home, raw.home_at.as_ref().map(Spanned::span))?;
        let [from, to] = match (&raw.home_at, scale.travel) {
            (Some(at), _) => self.range(at, scale.per_unit)?,
            (None, Some([_, max])) if max > 0.0 => [0.0, max / 20.0],
            (None, _) => {
                let at = raw.home.as_ref().map_or(0, |home| home.span().start);
                let message = "where the home switch is on is told by `home_at = [from, to]`, or by a `travel` that goes beyond 0";
                self.report(at, message);
                return None;
            }
        };
        let marks = Marks::Range { from, to };
        Some(Switch { input, marks })
    }

    /// A limit switch at the end of the way in one direction, unless told otherwise on in the last hundredth of the travel.
    fn limit(
        &mut self,
        key: &str,
        (input, place): (&Option<Spanned<String>>, &Option<Spanned<f64>>),
        scale: Scale,
        direction: f64,
    ) -> Option<Switch> {
        let named = input.as_ref().map_or(0, |input| input.span().start);
        let input = self.switch_input(key, input, place.as_ref().map(Spanned::span))?;
        let border = match (place, scale.travel) {
            (Some(at), _) => self.length(at, scale.per_unit)?,
            (None, Some([min, max])) => {
                let end = if direction > 0.0 { max } else { min };
                end - direction * (max - min) / 100.0
            }
            (None, None) => {
                let message =
                    format!("where this switch is on is told by `{key}_at`, or by a `travel`");
                self.report(named, message);
                return None;
            }
        };
        let marks = if direction > 0.0 {
            Marks::Range {
                from: border,
                to: f64::INFINITY,
            }
        } else {
            Marks::Range {
                from: f64::NEG_INFINITY,
                to: border,
            }
        };
        Some(Switch { input, marks })
    }

    /// The input of a switch whose place, if it has one, needs it.
    fn switch_input(
        &mut self,
        key: &str,
        input: &Option<Spanned<String>>,
        place: Option<std::ops::Range<usize>>,
    ) -> Option<u32> {
        match (input, place) {
            (Some(input), _) => self.input(input),
            (None, Some(place)) => {
                self.report(place.start, format!("this goes with `{key}`"));
                None
            }
            (None, None) => None,
        }
    }

    /// The zero phase of a motor: on for a tenth of each turn.
    fn zero_phase(&mut self, raw: &RawAxis, scale: Scale, fastest: f64) -> Option<Switch> {
        let place = raw.zero_phase_every.as_ref().map(Spanned::span);
        let input = self.switch_input("zero_phase", &raw.zero_phase, place)?;
        let Some(every) = &raw.zero_phase_every else {
            let at = raw.zero_phase.as_ref().map_or(0, |name| name.span().start);
            let message = "how far the axis goes in a turn is told by `zero_phase_every`";
            self.report(at, message);
            return None;
        };
        let every = self.period(every, scale.per_unit, fastest)?;
        let marks = Marks::Periodic {
            offset: 0.0,
            width: every / 10.0,
            every,
        };
        Some(Switch { input, marks })
    }

    fn switch(&mut self, raw: &RawSwitch, scale: Scale, fastest: f64) -> Option<Switch> {
        let input = self.input(&raw.input);
        let [from, to] = self.range(&raw.at, scale.per_unit)?;
        let marks = match &raw.every {
            None => Marks::Range { from, to },
            Some(every) => {
                let at = every.span().start;
                let every = self.period(every, scale.per_unit, fastest)?;
                if to - from >= every {
                    self.report(at, "`every` is longer than the place that comes again");
                    return None;
                }
                Marks::Periodic {
                    offset: from,
                    width: to - from,
                    every,
                }
            }
        };
        Some(Switch {
            input: input?,
            marks,
        })
    }

    /// The two lines of an encoder: A leads when the axis goes forward, and a whole number of cycles ends with both off.
    fn encoder(&mut self, raw: &RawEncoder, scale: Scale, fastest: f64) -> [Option<Switch>; 2] {
        let inputs = [self.input(&raw.a), self.input(&raw.b)];
        let cycles = match &raw.cycles_per_unit {
            Some(value) => self.positive(value, "cycles_per_unit"),
            None => Some(scale.per_unit),
        };
        let Some(every) = cycles.map(|cycles| scale.per_unit / cycles) else {
            return [None; 2];
        };
        if every * fastest < 1.0 {
            let at = raw.cycles_per_unit.as_ref().map_or(0, |c| c.span().start);
            self.report(at, TOO_OFTEN);
            return [None; 2];
        }
        let line = |input: Option<u32>, offset: f64| {
            let marks = Marks::Periodic {
                offset,
                width: every / 2.0,
                every,
            };
            input.map(|input| Switch { input, marks })
        };
        [line(inputs[0], every / 4.0), line(inputs[1], every / 2.0)]
    }

    fn cylinder(&mut self, at: usize, raw: RawCylinder) -> Option<Axis> {
        let forward = self.output(&raw.extend);
        let back = match &raw.retract {
            Some(retract) => self.output(retract).map(Back::Output),
            None => Some(Back::Spring),
        };
        let out_ms = self.time(&raw.time_ms, 1);
        let back_ms = match &raw.retract_ms {
            Some(time) => self.time(time, 1),
            None => out_ms,
        };
        let extended = raw.extended.as_ref().map(|name| self.input(name));
        let retracted = raw.retracted.as_ref().map(|name| self.input(name));
        if extended.is_none() && retracted.is_none() {
            let message = "a cylinder has an input `extended`, `retracted`, or both";
            self.report(at, message);
        }
        let (out_ms, back_ms) = (f64::from(out_ms?), f64::from(back_ms?));
        // Its way is as long as makes both speeds whole numbers.
        let length = out_ms * back_ms;
        let at_end = Marks::Range {
            from: length,
            to: f64::INFINITY,
        };
        let at_begin = Marks::Range {
            from: f64::NEG_INFINITY,
            to: 0.0,
        };
        let switch = |input: Option<Option<u32>>, marks| Some((input??, marks));
        let switches = [switch(extended, at_end), switch(retracted, at_begin)];
        let switches = switches.into_iter().flatten();
        Some(Axis {
            name: String::new(),
            unit: String::new(),
            per_unit: length,
            drive: Drive::Outputs {
                forward: forward?,
                back: back?,
                out_speed: back_ms,
                back_speed: out_ms,
            },
            position: match raw.start {
                Some(RawEnd::Extended) => length,
                _ => 0.0,
            },
            moved: 0.0,
            travel: Some([0.0, length]),
            switches: switches
                .map(|(input, marks)| Switch { input, marks })
                .collect(),
            collision: None,
        })
    }

    fn delay(&mut self, at: usize, raw: RawDelay) -> Option<Delay> {
        let (output, input) = (self.output(&raw.output), self.input(&raw.input));
        if raw.on_ms.is_none() && raw.off_ms.is_none() {
            self.report(at, "a delay has `on_ms`, `off_ms`, or both");
        }
        let on_ms = raw.on_ms.map_or(Some(0), |time| self.time(&time, 0));
        let off_ms = raw.off_ms.map_or(Some(0), |time| self.time(&time, 0));
        Some(Delay::new(output?, input?, on_ms?, off_ms?))
    }

    /// An input whose contact is normally closed: one that a part above drives.
    fn closed(&mut self, name: &Spanned<String>) -> Option<u32> {
        let number = self.terminal(name, DeviceClass::X)?;
        let driven = self
            .terminals
            .iter()
            .any(|t| (t.class, t.number) == (DeviceClass::X, number));
        if !driven {
            let message = format!("no part of the machine drives `{}`", name.get_ref());
            self.report(name.span().start, message);
        }
        driven.then_some(number)
    }

    /// A terminal of this class, by its name.
    fn terminal(&mut self, name: &Spanned<String>, class: DeviceClass) -> Option<u32> {
        match Target::parse(&name.get_ref().to_uppercase()) {
            Ok(Target::Bit(found, number)) if found == class => Some(number),
            Err(message) => {
                self.report(name.span().start, message);
                None
            }
            _ => {
                let (what, example) = match class {
                    DeviceClass::X => ("input", "X000"),
                    _ => ("output", "Y000"),
                };
                let message = format!("`{}` is no {what}, like `{example}`", name.get_ref());
                self.report(name.span().start, message);
                None
            }
        }
    }

    fn output(&mut self, name: &Spanned<String>) -> Option<u32> {
        let number = self.terminal(name, DeviceClass::Y)?;
        self.terminals.push(Terminal {
            class: DeviceClass::Y,
            number,
            at: name.span().start,
        });
        Some(number)
    }

    /// An input, which nothing else drives.
    fn input(&mut self, name: &Spanned<String>) -> Option<u32> {
        let (class, at) = (DeviceClass::X, name.span().start);
        let number = self.terminal(name, class)?;
        let other = self
            .terminals
            .iter()
            .find(|t| (t.class, t.number) == (class, number));
        if let Some(other) = other {
            let line = self.source.line_col(other.at as u32).0;
            let message = format!("`{}` is driven in line {line} already", name.get_ref());
            self.report(at, message);
            return None;
        }
        self.terminals.push(Terminal { class, number, at });
        Some(number)
    }

    /// A length in pulses, of one that is given in units.
    fn length(&mut self, value: &Spanned<f64>, per_unit: f64) -> Option<f64> {
        let length = value.get_ref() * per_unit;
        if length.abs() <= LONGEST {
            return Some(length);
        }
        self.report(value.span().start, "this length is too great");
        None
    }

    fn range(&mut self, value: &Spanned<Vec<f64>>, per_unit: f64) -> Option<[f64; 2]> {
        let at = value.span().start;
        let &[from, to] = value.get_ref().as_slice() else {
            self.report(at, "this is written [from, to]");
            return None;
        };
        let [from, to] = [from, to].map(|value| value * per_unit);
        if !(from.abs() <= LONGEST && to.abs() <= LONGEST) {
            self.report(at, "this length is too great");
            return None;
        }
        if from >= to {
            self.report(at, "write [from, to], the smaller number first");
            return None;
        }
        Some([from, to])
    }

    fn positive(&mut self, value: &Spanned<f64>, key: &str) -> Option<f64> {
        let fits = (1e-6..=FASTEST).contains(value.get_ref());
        if !fits {
            let message = format!("`{key}` is 0.000001 to {FASTEST}");
            self.report(value.span().start, message);
        }
        fits.then_some(*value.get_ref())
    }

    /// A length after which something comes again.
    fn period(&mut self, value: &Spanned<f64>, per_unit: f64, fastest: f64) -> Option<f64> {
        let every = value.get_ref() * per_unit;
        let fits = every * fastest >= 1.0 && (SHORTEST..=LONGEST).contains(&every);
        if !fits {
            let message = match every > 0.0 {
                true if every > LONGEST => "this length is too great",
                true => TOO_OFTEN,
                false => "this length is above 0",
            };
            self.report(value.span().start, message);
        }
        fits.then_some(every)
    }

    fn time(&mut self, value: &Spanned<u32>, least: u32) -> Option<u32> {
        let fits = (least..=LONGEST_MS).contains(value.get_ref());
        if !fits {
            let message = format!("this time is {least} to {LONGEST_MS} ms");
            self.report(value.span().start, message);
        }
        fits.then_some(*value.get_ref())
    }
}
