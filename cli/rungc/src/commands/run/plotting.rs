//! `rungc run --plot`: what is drawn, and the file.

use super::super::{Failure, file_name};
use crate::output::{AtomicFile, Kind};
use rungc_ir::Module;
use rungc_rt::Program;
use rungc_sim::Target;
use rungc_sim::plant::{Axis, Process};
use rungc_sim::record::plot::{CurveId, Plot, Shape};
use rungc_sim::record::{Reading, Seen, hertz};
use rungc_syntax::DeviceClass;
use std::io::Write;
use std::path::Path;

/// Quantity that a curve shows.
#[derive(Clone, Copy)]
enum Subject {
    /// Position of an axis of the machine, by its place there.
    Position(usize),
    /// Speed of an axis.
    Speed(usize),
    /// Value of a process of the machine, by its place there.
    Value(usize),
    /// Pulses that an output has sent.
    Pulses(u32),
    /// Their frequency, negative for those that are counted down.
    Frequency(u32),
    /// A watched device.
    Watched(Target),
}

/// A watched device with the comment that the program has on it.
fn named(target: Target, module: &Module) -> String {
    let name = super::name(target);
    let (class, number, _) = target.devices(0);
    let mut comments = module.comments.iter();
    match comments.find(|(c, n, _)| (*c, *n) == (class, number)) {
        Some((_, _, comment)) => format!("{name} {comment}"),
        None => name,
    }
}

/// Value of a device as a number, if it can be drawn.
fn number(seen: Seen, target: Target) -> Option<f64> {
    match Reading::of(seen, target)? {
        Reading::Bit(on) => Some(f64::from(u8::from(on))),
        Reading::Integer(value, _) => Some(value as f64),
        Reading::Float(value) => Some(value),
        Reading::Text(_) => None,
    }
}

/// A diagram in the making.
pub struct Plotting {
    plot: Plot,
    /// Quantity on the horizontal axis instead of time.
    over: Option<Target>,
    curves: Vec<(CurveId, Subject)>,
    file: AtomicFile,
}

impl Plotting {
    /// Begins a diagram of the axes, and of what is watched.
    pub fn begin(
        (path, force): (&Path, bool),
        seen: Seen,
        (watched, over): (&[Target], Option<Target>),
        duration_ms: u64,
    ) -> std::result::Result<Self, Failure> {
        let module = seen.machine.module();
        let name = file_name(rungc_lower::stem(&module.source_name), &module.name);
        let title = format!("{name} on {}", module.model.title);
        let mut plot = Plot::new(&title, duration_ms);
        if let Some(target) = over {
            let name = named(target, module);
            number(seen, target)
                .ok_or_else(|| Failure::Because(format!("--over: `{name}` is not a number")))?;
            plot.over(&name);
        }
        let shape = match over {
            Some(_) => Shape::Line,
            None => Shape::Step,
        };
        let mut curves = Vec::new();
        let axes = seen.axes();
        for (i, axis) in axes.iter().enumerate() {
            let (name, unit) = (axis.name(), axis.unit());
            let position = plot.curve(&format!("Position ({unit})"), name, Shape::Line);
            let speed = plot.curve(&format!("Speed ({unit}/s)"), name, Shape::Line);
            curves.extend([(position, Subject::Position(i)), (speed, Subject::Speed(i))]);
        }
        for (i, process) in seen.processes().iter().enumerate() {
            let (name, unit) = (process.name(), process.unit());
            let curve = plot.curve(&format!("Process ({unit})"), name, Shape::Line);
            curves.push((curve, Subject::Value(i)));
        }
        for &output in &module.pulse_outputs {
            let followed = axes.iter().any(|axis| axis.pulse_output() == Some(output));
            // Over a value, what is watched is meant.
            if followed || (over.is_some() && !watched.is_empty()) {
                continue;
            }
            let name = DeviceClass::Y.number(output).to_string();
            let pulses = plot.curve("Position (pulses)", &name, Shape::Line);
            let hertz = plot.curve("Speed (pulses/s)", &name, Shape::Line);
            curves.push((pulses, Subject::Pulses(output)));
            curves.push((hertz, Subject::Frequency(output)));
        }
        for &target in watched {
            let name = named(target, module);
            let curve = match Reading::of(seen, target) {
                Some(Reading::Bit(_)) => plot.lane(&name),
                Some(Reading::Integer(..) | Reading::Float(_)) => {
                    let panel = match target {
                        Target::Channel(channel) => {
                            format!("Channels ({})", channel.quantity.unit())
                        }
                        _ => name.clone(),
                    };
                    plot.curve(&panel, &name, shape)
                }
                Some(Reading::Text(_)) | None => continue,
            };
            curves.push((curve, Subject::Watched(target)));
        }
        if plot.is_empty() {
            return Err(Failure::Because(
                "--plot: nothing to draw: no machine with an axis or a process, no output that sends pulses, and no number or bit in --watch".to_string(),
            ));
        }
        Ok(Plotting {
            plot,
            over,
            curves,
            file: AtomicFile::create(path, Kind::Svg, force)?,
        })
    }

    /// Takes notice of how things are now.
    pub fn sample(&mut self, at_ms: u64, seen: Seen) {
        let (machine, axes) = (seen.machine, seen.axes());
        if let Some(place) = self.over.and_then(|target| number(seen, target)) {
            self.plot.place(place);
        }
        for &(curve, subject) in &self.curves {
            let value = match subject {
                Subject::Position(i) => axes.get(i).map(Axis::position),
                Subject::Speed(i) => {
                    let hz = |output| hertz(machine, output);
                    let is_on = |output| machine.output(output);
                    axes.get(i).map(|axis| axis.speed(hz, is_on))
                }
                Subject::Value(i) => seen.processes().get(i).map(Process::value),
                Subject::Pulses(n) => number(seen, Target::Pulses(n)),
                Subject::Frequency(n) => Some(hertz(machine, n)),
                Subject::Watched(target) => number(seen, target),
            };
            if let Some(value) = value {
                self.plot.point(curve, at_ms, value);
            }
        }
    }

    /// Draws the diagram; the file takes its place.
    pub fn keep(self) -> std::result::Result<(), Failure> {
        let drawn = self.plot.draw();
        let mut out = self.file.writer()?;
        let written = out.write_all(drawn.as_bytes()).and_then(|()| out.flush());
        written.map_err(|error| self.file.failed(error))?;
        self.file.persist()
    }
}
