//! `rungc run --vcd`: which devices are recorded, and the file.

use super::super::Failure;
use crate::output::{AtomicFile, Kind};
use rungc_ir::Module;
use rungc_sim::Target;
use rungc_sim::record::{Reading, Seen, Signal, Vcd};
use rungc_sim::wire::Change;
use rungc_syntax::DeviceClass;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// A recording that is being written.
pub struct Recording {
    /// Targets of the first signals; those of the machine follow.
    targets: Vec<Target>,
    vcd: Vcd<BufWriter<File>>,
    file: AtomicFile,
}

impl Recording {
    /// Begins a recording of a program's inputs and outputs and of what is watched.
    pub fn begin(
        (path, force): (&Path, bool),
        seen: Seen,
        watched: &[Target],
    ) -> std::result::Result<Self, Failure> {
        let module = seen.machine.module();
        let targets = targets(module, watched);
        let of_machine = machine_signals(seen);
        if targets.is_empty() && of_machine.is_empty() {
            return Err(Failure::Because(
                "--vcd: nothing to record: the program has no inputs and outputs; select devices with --watch".to_string(),
            ));
        }
        let of_target = |&target| Some((Signal::of(target), Reading::of(seen, target)?));
        let signals = targets.iter().filter_map(of_target);
        let signals = signals.chain(of_machine).collect();
        let file = AtomicFile::create(path, Kind::Vcd, force)?;
        let vcd = Vcd::begin(file.writer()?, &module.name, signals);
        Ok(Recording {
            targets,
            vcd: vcd.map_err(|error| file.failed(error))?,
            file,
        })
    }

    /// Records what has changed.
    pub fn sample(&mut self, at_us: u64, seen: Seen) -> std::result::Result<(), Failure> {
        for i in 0..self.targets.len() {
            if let Some(reading) = Reading::of(seen, self.targets[i]) {
                self.change(at_us, i, reading)?;
            }
        }
        for (i, (_, reading)) in (self.targets.len()..).zip(machine_signals(seen)) {
            self.change(at_us, i, reading)?;
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
        self.file.persist()
    }
}

/// The positions of the machine's axes and the values of its processes.
fn machine_signals(seen: Seen) -> Vec<(Signal, Reading)> {
    let axes = seen.axes().iter();
    let axes = axes.map(|axis| {
        (
            Signal::of_axis(axis.name()),
            Reading::Float(axis.position()),
        )
    });
    let processes = seen.processes().iter();
    let processes = processes.map(|process| {
        let value = Reading::Float(process.value());
        (Signal::of_process(process.name()), value)
    });
    axes.chain(processes).collect()
}

/// The inputs and outputs that the program uses, the pulses that it sends, and the watched devices, each once, by
/// class.
fn targets(module: &Module, watched: &[Target]) -> Vec<Target> {
    let terminals = [DeviceClass::X, DeviceClass::Y].into_iter();
    let terminals = terminals.flat_map(|class| used(module, class).map(move |n| (class, n)));
    let mut targets: Vec<Target> = Vec::new();
    let terminals = terminals.map(|(class, n)| Target::Bit(class, n));
    let sends = module.pulse_outputs.iter();
    let pulses = sends.flat_map(|&n| [Target::Pulses(n), Target::Frequency(n)]);
    for target in terminals.chain(pulses).chain(watched.iter().copied()) {
        if !targets.contains(&target) {
            targets.push(target);
        }
    }
    targets.sort_by_key(|&target| rank(target));
    targets
}

/// Signals of a scope are together.
fn rank(target: Target) -> usize {
    let order = ["inputs", "outputs", "relays", "timers", "counters"];
    let scope = Signal::of(target).scope;
    order
        .iter()
        .position(|&s| s == scope)
        .unwrap_or(order.len())
}

/// Devices of a class that the program uses.
fn used(module: &Module, class: DeviceClass) -> impl Iterator<Item = u32> {
    let areas = module.layout.areas.iter().filter(move |a| a.class == class);
    areas.flat_map(|a| a.first..a.first + a.count)
}
