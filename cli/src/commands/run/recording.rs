//! `rungc run --vcd`: which devices are recorded, and the file.

use super::super::{Failure, Fresh};
use rungc_ir::Module;
use rungc_sim::Machine;
use rungc_sim::plant::Plant;
use rungc_sim::plctest::Target;
use rungc_sim::record::{Reading, Signal, Vcd};
use rungc_sim::wire::Change;
use rungc_syntax::DeviceClass;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// A recording that is being written.
pub struct Recording {
    targets: Vec<Target>,
    /// Axes of the machine, whose signals follow those of the targets.
    axes: Vec<String>,
    vcd: Vcd<BufWriter<File>>,
    file: Fresh,
}

impl Recording {
    /// Begins a recording of a program's inputs and outputs and of what is watched.
    pub fn begin(
        path: &Path,
        machine: &Machine,
        plant: Option<&Plant>,
        watched: &[Target],
    ) -> std::result::Result<Self, Failure> {
        let module = machine.module();
        let targets = targets(module, watched);
        let axes: Vec<String> = plant.map_or(Vec::new(), |plant| {
            plant.axes().map(str::to_owned).collect()
        });
        if targets.is_empty() && axes.is_empty() {
            return Err(Failure::Because(
                "--vcd: the program has no inputs and outputs: there is nothing to record; --watch names devices".to_string(),
            ));
        }
        let of_axis = |axis: &String| {
            let position = plant.and_then(|plant| plant.position(axis))?;
            Some((Signal::of_axis(axis), Reading::Float(position)))
        };
        let of_target = |&target| Some((Signal::of(target), Reading::of(machine, target)?));
        let signals = targets.iter().filter_map(of_target);
        let signals = signals.chain(axes.iter().filter_map(of_axis)).collect();
        let file = Fresh::begin(path)?;
        let vcd = Vcd::begin(file.writer()?, &module.name, signals);
        Ok(Recording {
            targets,
            axes,
            vcd: vcd.map_err(|error| file.failed(error))?,
            file,
        })
    }

    /// Records what has changed.
    pub fn sample(
        &mut self,
        at_us: u64,
        machine: &Machine,
        plant: Option<&Plant>,
    ) -> std::result::Result<(), Failure> {
        let of_targets = self
            .targets
            .iter()
            .map(|&target| Reading::of(machine, target));
        let position = |axis: &String| plant?.position(axis).map(Reading::Float);
        let readings: Vec<_> = of_targets.chain(self.axes.iter().map(position)).collect();
        for (i, reading) in readings.into_iter().enumerate() {
            if let Some(reading) = reading {
                self.change(at_us, i, reading)?;
            }
        }
        Ok(())
    }

    /// Records an edge of an input, at the microsecond.
    pub fn edge(&mut self, change: Change) -> std::result::Result<(), Failure> {
        let input = Target::Bit(DeviceClass::X, change.input);
        match self.targets.iter().position(|&target| target == input) {
            Some(i) => self.change(change.at_us, i, Reading::Bit(change.on)),
            None => Ok(()),
        }
    }

    fn change(
        &mut self,
        at_us: u64,
        i: usize,
        reading: Reading,
    ) -> std::result::Result<(), Failure> {
        let written = self.vcd.change(at_us, i, reading);
        written.map_err(|error| self.file.failed(error))
    }

    /// Ends the recording; the file takes its place.
    pub fn keep(self, at_us: u64) -> std::result::Result<(), Failure> {
        let written = self.vcd.end(at_us);
        written.map_err(|error| self.file.failed(error))?;
        self.file.keep()
    }
}

/// The inputs and outputs that the program uses and the watched devices, each once, by class.
fn targets(module: &Module, watched: &[Target]) -> Vec<Target> {
    let terminals = [DeviceClass::X, DeviceClass::Y].into_iter();
    let terminals = terminals.flat_map(|class| super::used(module, class).map(move |n| (class, n)));
    let mut targets: Vec<Target> = Vec::new();
    let all = terminals.map(|(class, n)| Target::Bit(class, n));
    for target in all.chain(watched.iter().copied()) {
        if !targets.contains(&target) {
            targets.push(target);
        }
    }
    targets.sort_by_key(|&target| rank(target));
    targets
}

/// Signals of a scope stand together.
fn rank(target: Target) -> usize {
    let order = ["inputs", "outputs", "relays", "timers", "counters"];
    let scope = Signal::of(target).scope;
    order
        .iter()
        .position(|&s| s == scope)
        .unwrap_or(order.len())
}
