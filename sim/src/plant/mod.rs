//! The machine around a PLC: axes with their switches, encoders and sensors, cylinders, inputs that follow outputs, and
//! processes.
//!
//! A [`Description`] is read from a TOML file (`docs/src/machines.md`). The [`Plant`] that it describes moves on a
//! millisecond at a time: it looks at the PLC's outputs through [`Terminals`] and changes its inputs. Within a
//! millisecond an axis moves evenly, and each switch and each encoder line changes when the axis passes the position
//! where it does.

mod axis;
mod delay;
mod format;
mod marks;
mod process;

pub use axis::{Axis, Collision};
pub use format::{Description, load, parse};
pub use process::Process;

use crate::target::Channel;
use crate::wire::Change;
use delay::Delay;
use rungc_syntax::order;

/// What the machine asks of an output.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Look {
    /// Whether output terminal Y is on: 0 or 1.
    Output(u32),
    /// How many pulses output Y has sent since power-on, those in reverse counting down; wraps.
    Pulses(u32),
    /// The signal at a channel of a module, in millionths.
    Channel(Channel),
}

/// The terminals of a PLC, as the machine is wired to them.
pub trait Terminals {
    /// What may go wrong.
    type Error;

    /// What the outputs do now.
    fn look(&mut self, at: &[Look]) -> Result<Vec<i32>, Self::Error>;

    /// An input turns on or off. Changes come in the order of their times.
    fn change(&mut self, change: Change) -> Result<(), Self::Error>;

    /// A signal, in millionths, reaches an input of a module.
    fn connect(&mut self, channel: Channel, millionths: i32) -> Result<(), Self::Error>;
}

/// A machine.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Plant {
    axes: Vec<Axis>,
    cylinders: Vec<Axis>,
    delays: Vec<Delay>,
    processes: Vec<Process>,
    /// Inputs whose contacts open where the others close.
    normally_closed: Vec<u32>,
}

/// An input that turns on or off: when, as a part of the millisecond, which one, and whether it is on now.
type Moment = (f64, u32, bool);

impl Plant {
    /// The state of each input that the machine drives.
    pub fn inputs(&self) -> Vec<(u32, bool)> {
        let of_axes = self.movers().flat_map(Axis::inputs);
        let of_delays = self.delays.iter().map(Delay::input);
        of_axes
            .chain(of_delays)
            .map(|(input, on)| (input, self.contact(input, on)))
            .collect()
    }

    /// A millisecond passes, which ends at `now_ms`.
    pub fn step<T: Terminals>(&mut self, now_ms: u64, terminals: &mut T) -> Result<(), T::Error> {
        let mut wanted = Vec::new();
        for axis in self.movers() {
            axis.looks_at(&mut wanted);
        }
        wanted.extend(self.delays.iter().map(Delay::looks_at));
        wanted.extend(self.processes.iter().map(Process::looks_at));
        let seen = terminals.look(&wanted)?;
        let see = |look: Look| {
            let found = wanted
                .iter()
                .zip(&seen)
                .find(|(wanted, _)| **wanted == look);
            found.map_or(0, |(_, &value)| value)
        };
        let mut moments: Vec<Moment> = Vec::new();
        for axis in self.axes.iter_mut().chain(&mut self.cylinders) {
            axis.step(now_ms, &see, &mut moments);
        }
        for delay in &mut self.delays {
            delay.step(&see, &mut moments);
        }
        for process in &mut self.processes {
            process.step(&see);
        }
        order::by(&mut moments, |(a, ..), (b, ..)| a.total_cmp(b));
        for (part, input, on) in moments {
            terminals.change(Change {
                at_us: now_ms.saturating_sub(1) * 1000 + (part * 1000.0) as u64,
                input,
                on: self.contact(input, on),
            })?;
        }
        self.measure(terminals)
    }

    /// The sensors send what has changed; when the machine is connected, all that they measure.
    pub fn measure<T: Terminals>(&mut self, terminals: &mut T) -> Result<(), T::Error> {
        let axes = self.axes.iter_mut();
        let of_axes = axes.map(|axis| (axis.position(), &mut axis.sensors));
        let processes = self.processes.iter_mut();
        let of_processes = processes.map(|process| (process.value(), &mut process.sensors));
        for (value, sensors) in of_axes.chain(of_processes) {
            for (channel, millionths) in sensors.iter_mut().filter_map(|s| s.change(value)) {
                terminals.connect(channel, millionths)?;
            }
        }
        Ok(())
    }

    /// The PLC was switched off and on: it counts its pulses from 0 again. The machine stays as it is.
    pub fn power_cycle(&mut self) {
        self.axes.iter_mut().for_each(Axis::power_cycle);
    }

    /// The axes, in the order of the file.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The processes, in the order of the file.
    pub fn processes(&self) -> &[Process] {
        &self.processes
    }

    /// The axis with this name.
    pub fn axis(&self, name: &str) -> Option<&Axis> {
        self.axes.iter().find(|axis| axis.name == name)
    }

    /// The first axis that has run into an end of its travel.
    pub fn collision(&self) -> Option<&Collision> {
        let all = self.axes.iter().filter_map(|axis| axis.collision.as_ref());
        all.min_by_key(|collision| collision.at_ms)
    }

    fn movers(&self) -> impl Iterator<Item = &Axis> {
        self.axes.iter().chain(&self.cylinders)
    }

    /// What an input sees of a contact that is closed or not as it is usual.
    fn contact(&self, input: u32, on: bool) -> bool {
        on != self.normally_closed.contains(&input)
    }
}
