//! The machine around a PLC: axes with their switches, encoders and sensors, cylinders, inputs that follow outputs, and
//! processes.
//!
//! A [`Description`] is read from a TOML file (`docs/src/machines.md`). The [`Plant`] that it describes moves on a
//! millisecond at a time: it looks at the PLC's outputs through [`Terminals`] and changes its inputs. Within a
//! millisecond a motor moves evenly, and each switch and each encoder line changes when the axis passes the position
//! where it does. An axis that pulses drive stops at each pulse that changes an input, so that what the PLC does then
//! has its effect on the next pulse.

mod axis;
mod delay;
mod format;
mod marks;
mod process;
mod wired;

pub use axis::{Axis, Collision};
pub use format::{Description, load, parse};
pub use process::Process;
pub use wired::Wired;

use crate::target::Channel;
use crate::wire::Change;
use delay::Delay;
use std::ops::Range;

/// Query of the machine about an output.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Look {
    /// State of output terminal Y: 0 or 1.
    Output(u32),
    /// Number of pulses output Y has sent since power-on, those in reverse counting down; wraps.
    Pulses(u32),
    /// The signal at a channel of a module, in millionths.
    Channel(Channel),
}

/// The terminals of a PLC, as the machine is wired to them.
pub trait Terminals {
    /// Error type.
    type Error;

    /// Present values of the outputs.
    fn look(&mut self, at: &[Look]) -> Result<Vec<i32>, Self::Error>;

    /// Lets the PLC send pulses from one time until another, in microseconds of its clock, which wraps, but only until
    /// an output has sent `most`. Returns the time that is reached, and what the outputs do then.
    fn pass(
        &mut self,
        time: [u32; 2],
        most: u32,
        at: &[Look],
    ) -> Result<(u32, Vec<i32>), Self::Error>;

    /// An input turns on or off. Changes come in the order of their times.
    fn change(&mut self, change: Change) -> Result<(), Self::Error>;

    /// A signal, in millionths, reaches an input of a module.
    fn connect(&mut self, channel: Channel, millionths: i32) -> Result<(), Self::Error>;
}

/// Value of one of the queries.
fn found(wanted: &[Look], seen: &[i32], look: Look) -> i32 {
    let mut both = wanted.iter().zip(seen);
    let found = both.find(|(wanted, _)| **wanted == look);
    found.map_or(0, |(_, &value)| value)
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

/// An input that turns on or off: when, as a part of the time that passes, which one, and whether it is on now.
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

    /// A millisecond passes, which ends at `now_ms`. In it, inputs that the machine does not drive change, too, in the
    /// order of their times.
    pub fn step<T: Terminals>(
        &mut self,
        now_ms: u64,
        others: &[Change],
        terminals: &mut T,
    ) -> Result<(), T::Error> {
        let mut time = now_ms.saturating_sub(1) * 1000..now_ms * 1000;
        let mut changes = self.drive(now_ms, terminals)?;
        changes.extend(others);
        changes.sort_by_key(|change| change.at_us);
        for change in changes {
            let until = change.at_us.clamp(time.start, time.end);
            self.follow(time.start..until, now_ms, terminals)?;
            time.start = until;
            terminals.change(change)?;
        }
        if self.axes.iter().any(Axis::follows_pulses) {
            self.follow(time, now_ms, terminals)?;
        }
        self.measure(terminals)
    }

    /// Moves everything by a millisecond except axes that pulses drive; returns the changes of inputs, in any order.
    fn drive<T: Terminals>(
        &mut self,
        now_ms: u64,
        terminals: &mut T,
    ) -> Result<Vec<Change>, T::Error> {
        let Plant {
            axes,
            cylinders,
            delays,
            processes,
            ..
        } = self;
        let motors = axes.iter_mut().filter(|axis| !axis.follows_pulses());
        let mut movers: Vec<&mut Axis> = motors.chain(cylinders).collect();
        let mut wanted = Vec::new();
        movers.iter().for_each(|axis| axis.looks_at(&mut wanted));
        wanted.extend(delays.iter().map(Delay::looks_at));
        wanted.extend(processes.iter().map(Process::looks_at));
        let seen = terminals.look(&wanted)?;
        let see = |look| found(&wanted, &seen, look);
        let mut moments: Vec<Moment> = Vec::new();
        for axis in &mut movers {
            axis.step(now_ms, &see, &mut moments);
        }
        for delay in delays {
            delay.step(&see, &mut moments);
        }
        for process in processes {
            process.step(&see);
        }
        moments.sort_by(|(a, ..), (b, ..)| a.total_cmp(b));
        let begin_us = now_ms.saturating_sub(1) * 1000;
        let change = |(part, input, on): Moment| Change {
            at_us: begin_us + (part * 1000.0) as u64,
            input,
            on: self.contact(input, on),
        };
        Ok(moments.into_iter().map(change).collect())
    }

    /// Axes follow the pulses of this time, in microseconds.
    fn follow<T: Terminals>(
        &mut self,
        mut time: Range<u64>,
        now_ms: u64,
        terminals: &mut T,
    ) -> Result<(), T::Error> {
        let mut wanted = Vec::new();
        let followers = self.axes.iter().filter(|axis| axis.follows_pulses());
        followers.for_each(|axis| axis.looks_at(&mut wanted));
        loop {
            let followers = self.axes.iter_mut().filter(|axis| axis.follows_pulses());
            let mut followers: Vec<&mut Axis> = followers.collect();
            let rooms = followers.iter().map(|axis| axis.room());
            let room = rooms.min().unwrap_or(i32::MAX as u32);
            let [from, until] = [time.start as u32, time.end as u32];
            let (reached, seen) = terminals.pass([from, until], room, &wanted)?;
            let reached = time.end - u64::from(until.wrapping_sub(reached));
            let see = |look| found(&wanted, &seen, look);
            let mut moments: Vec<Moment> = Vec::new();
            for axis in &mut followers {
                axis.step(now_ms, &see, &mut moments);
            }
            moments.sort_by(|(a, ..), (b, ..)| a.total_cmp(b));
            for (_, input, on) in moments {
                terminals.change(Change {
                    at_us: reached,
                    input,
                    on: self.contact(input, on),
                })?;
            }
            time.start = reached;
            if time.is_empty() {
                return Ok(());
            }
        }
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

    /// State of an input for a contact that is normally open or closed.
    fn contact(&self, input: u32, on: bool) -> bool {
        on != self.normally_closed.contains(&input)
    }
}
