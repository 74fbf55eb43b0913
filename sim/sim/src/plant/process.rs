//! Something that settles: a temperature, a level, a pressure; and the analog sensors of the machine.

use super::Look;
use crate::target::Channel;
use std::collections::VecDeque;

/// Drive of a process.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Drive {
    /// An output: fully or not at all.
    Output(u32),
    /// The signal of a module's output, between none and full.
    Channel {
        channel: Channel,
        none: f64,
        full: f64,
    },
}

impl Drive {
    fn looks_at(&self) -> Look {
        match *self {
            Drive::Output(output) => Look::Output(output),
            Drive::Channel { channel, .. } => Look::Channel(channel),
        }
    }

    /// Degree of the drive, 0 to 1.
    fn part(&self, seen: i32) -> f64 {
        match *self {
            Drive::Output(_) => f64::from(seen.clamp(0, 1)),
            Drive::Channel { none, full, .. } => {
                let signal = f64::from(seen) / 1e6;
                ((signal - none) / (full - none)).clamp(0.0, 1.0)
            }
        }
    }
}

/// Conversion of a value of the machine into an analog signal.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Sensor {
    pub(super) channel: Channel,
    /// Two values, and the signals that stand for them.
    pub(super) range: [f64; 2],
    pub(super) signal: [f64; 2],
    /// The last signal, in millionths.
    pub(super) last: Option<i32>,
}

impl Sensor {
    /// The signal of a value, in millionths.
    pub(super) fn of(&self, value: f64) -> i32 {
        let ([from, to], [low, high]) = (self.range, self.signal);
        let signal = low + (value - from) / (to - from) * (high - low);
        (signal * 1e6).round() as i32
    }

    /// The signal of a value, if it is another one than before.
    pub(super) fn change(&mut self, value: f64) -> Option<(Channel, i32)> {
        let now = self.of(value);
        (self.last.replace(now) != Some(now)).then_some((self.channel, now))
    }
}

/// A value that approaches what its drive would make of it, faster at first and slower later, and after a dead time.
#[derive(Clone, PartialEq, Debug)]
pub struct Process {
    pub(super) name: String,
    pub(super) unit: String,
    /// The value without a drive, and fully driven.
    pub(super) rest: f64,
    pub(super) full: f64,
    pub(super) drive: Drive,
    /// Part of the way that it goes in a millisecond.
    pub(super) share: f64,
    /// Drive in each millisecond of the dead time, the oldest first.
    pub(super) waiting: VecDeque<f64>,
    pub(super) value: f64,
    pub(super) sensors: Vec<Sensor>,
}

impl Process {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The unit of its value.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// Its value.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Returns true if it is at the expected value, within a hundredth of its range.
    pub fn is_at(&self, expected: f64) -> bool {
        (self.value - expected).abs() <= (self.full - self.rest).abs() / 100.0
    }

    pub(super) fn looks_at(&self) -> Look {
        self.drive.looks_at()
    }

    /// A millisecond passes.
    pub(super) fn step(&mut self, see: &dyn Fn(Look) -> i32) {
        self.waiting
            .push_back(self.drive.part(see(self.looks_at())));
        let driven = self.waiting.pop_front().unwrap_or(0.0);
        let goal = self.rest + driven * (self.full - self.rest);
        self.value += self.share * (goal - self.value);
    }
}
