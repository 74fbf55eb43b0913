//! Reading the description of a machine: TOML to [`Plant`], every mistake with its line and column.

mod axis;
mod process;
mod raw;
mod switches;
mod values;

use super::Plant;
use super::axis::{Axis, Back, Drive};
use super::delay::Delay;
use super::marks::{Marks, Switch};
use crate::problem::{self, LoadError, Problem};
use raw::{RawCylinder, RawDelay, RawEnd, RawMachine};
use rungc_models::Model;
use rungc_syntax::codes::MACHINE_FILE;
use rungc_syntax::{DeviceClass, Source};
use std::path::Path;
use toml::Spanned;

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

    /// Returns true if the machine drives this device.
    pub fn drives(&self, class: DeviceClass, number: u32) -> bool {
        class == DeviceClass::X && self.terminals().any(|t| t == (class, number))
    }

    /// Checks that a PLC of this model has the terminals that the file names.
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
            code: &MACHINE_FILE,
            file: Box::new(self.source.clone()),
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
            code: &MACHINE_FILE,
            file: Box::new(source),
            problems,
        }),
    }
}

/// Collects the problems of one file.
struct Reader<'t> {
    source: &'t Source,
    problems: Vec<Problem>,
    terminals: Vec<Terminal>,
    /// Inputs of modules that sensors are connected to: module and channel.
    channels: Vec<(u16, u8)>,
}

impl<'t> Reader<'t> {
    fn new(source: &'t Source) -> Self {
        Reader {
            source,
            problems: Vec::new(),
            terminals: Vec::new(),
            channels: Vec::new(),
        }
    }

    fn report(&mut self, at: usize, message: impl Into<String>) {
        let problem = Problem::at(self.source, at, message.into());
        self.problems.push(problem);
    }

    fn machine(&mut self, raw: RawMachine) -> Plant {
        let mut plant = Plant::default();
        let parts = [raw.axis.len(), raw.cylinder.len(), raw.delay.len()];
        if parts == [0; 3] && raw.process.is_empty() {
            let message =
                "the machine is empty: add [[axis]], [[cylinder]], [[delay]] or [[process]] tables";
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
        for process in raw.process {
            let at = process.span().start;
            let process = self.process(at, process.into_inner(), &plant.processes);
            plant.processes.extend(process);
        }
        for name in raw.normally_closed {
            plant.normally_closed.extend(self.closed(&name));
        }
        plant
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
            let message = "a cylinder needs an input `extended`, `retracted`, or both";
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
            sensors: Vec::new(),
            switches: switches
                .map(|(input, marks)| Switch { input, marks })
                .collect(),
            collision: None,
        })
    }

    fn delay(&mut self, at: usize, raw: RawDelay) -> Option<Delay> {
        let (output, input) = (self.output(&raw.output), self.input(&raw.input));
        if raw.on_ms.is_none() && raw.off_ms.is_none() {
            self.report(at, "a delay needs `on_ms`, `off_ms`, or both");
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
}
