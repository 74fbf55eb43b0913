//! Something that moves: what drives it, how far it can go, and the switches along its way.

use super::marks::Switch;
use super::process::Sensor;
use super::{Look, Moment};
use std::fmt;

/// Pulses that an axis follows at once where no switch is near.
const MOST_PULSES: f64 = i32::MAX as f64;

/// Drive of an axis.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Drive {
    /// The pulses of an output.
    Pulses {
        /// Output Y.
        output: u32,
        /// The direction output, and its state for forward; without one, the sign of the pulses decides.
        direction: Option<(u32, bool)>,
        /// Pulses that it has followed.
        followed: i32,
    },
    /// A motor, or the air of a cylinder. It stands still when it is driven both ways.
    Outputs {
        /// Output that drives it forward.
        forward: u32,
        /// Drive in the backward direction.
        back: Back,
        /// Forward distance per millisecond.
        out_speed: f64,
        /// Backward distance per millisecond.
        back_speed: f64,
    },
}

/// Drive of an axis in the backward direction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Back {
    /// Nothing: it runs forward only.
    Nothing,
    /// A spring, when nothing drives it forward.
    Spring,
    /// An output.
    Output(u32),
}

/// An axis, or a cylinder. Inside lengths are in pulses if pulses drive it.
#[derive(Clone, PartialEq, Debug)]
pub struct Axis {
    pub(super) name: String,
    pub(super) unit: String,
    /// Length of a unit.
    pub(super) per_unit: f64,
    pub(super) drive: Drive,
    pub(super) position: f64,
    /// Distance moved in the last millisecond.
    pub(super) moved: f64,
    /// The ends of its way.
    pub(super) travel: Option<[f64; 2]>,
    pub(super) switches: Vec<Switch>,
    /// Sensors of its position, in its unit.
    pub(super) sensors: Vec<Sensor>,
    /// Collision with an end of its travel, if any.
    pub(super) collision: Option<Collision>,
}

/// An axis has run into an end of its travel, where it stays: its motor stalls, and pulses are lost.
#[derive(Clone, PartialEq, Debug)]
pub struct Collision {
    /// Name of the axis.
    pub axis: String,
    /// Time in milliseconds since the machine began.
    pub at_ms: u64,
    /// Position in the unit of the axis.
    pub position: f64,
    /// That unit.
    pub unit: String,
}

impl fmt::Display for Collision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Collision {
            axis,
            at_ms,
            position,
            unit,
        } = self;
        write!(
            f,
            "at {at_ms} ms: the axis {axis} hits its end stop at {position} {unit}"
        )
    }
}

impl Axis {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The unit of its lengths.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// Position in its unit.
    pub fn position(&self) -> f64 {
        self.position / self.per_unit
    }

    /// Its speed in units a second, negative when it goes back. `hz` gives the pulses that an output sends per second,
    /// negative in reverse, `is_on` whether an output is on.
    pub fn speed(&self, hz: impl Fn(u32) -> f64, is_on: impl Fn(u32) -> bool) -> f64 {
        let speed = match self.drive {
            Drive::Pulses {
                output, direction, ..
            } => match direction {
                None => hz(output),
                Some((told_by, forward)) if is_on(told_by) == forward => hz(output).abs(),
                Some(_) => -hz(output).abs(),
            },
            Drive::Outputs { .. } => self.moved * 1000.0,
        };
        speed / self.per_unit
    }

    /// Returns true if it is at the expected position, within half a pulse or, for a motor, half of its distance in a
    /// millisecond.
    pub fn is_at(&self, expected: f64) -> bool {
        let tolerance = match self.drive {
            Drive::Pulses { .. } => 0.5,
            Drive::Outputs { out_speed, .. } => out_speed / 2.0,
        };
        (self.position - expected * self.per_unit).abs() <= tolerance
    }

    /// The output whose pulses it follows.
    pub fn pulse_output(&self) -> Option<u32> {
        match self.drive {
            Drive::Pulses { output, .. } => Some(output),
            Drive::Outputs { .. } => None,
        }
    }

    /// Returns true if pulses drive it.
    pub(super) fn follows_pulses(&self) -> bool {
        self.pulse_output().is_some()
    }

    pub(super) fn inputs(&self) -> impl Iterator<Item = (u32, bool)> {
        let state = |s: &Switch| (s.input, s.is_on(self.position));
        self.switches.iter().map(state)
    }

    /// Adds the outputs of the PLC that its drive depends on.
    pub(super) fn looks_at(&self, wanted: &mut Vec<Look>) {
        match self.drive {
            Drive::Pulses {
                output, direction, ..
            } => {
                wanted.push(Look::Pulses(output));
                wanted.extend(direction.map(|(output, _)| Look::Output(output)));
            }
            Drive::Outputs { forward, back, .. } => {
                wanted.push(Look::Output(forward));
                if let Back::Output(output) = back {
                    wanted.push(Look::Output(output));
                }
            }
        }
    }

    pub(super) fn power_cycle(&mut self) {
        if let Drive::Pulses { followed, .. } = &mut self.drive {
            *followed = 0;
        }
    }

    /// Number of pulses that it may follow before one of its switches changes, at least one.
    pub(super) fn room(&self) -> u32 {
        let rooms = self.switches.iter().map(|s| s.room(self.position));
        rooms.fold(f64::INFINITY, f64::min).clamp(1.0, MOST_PULSES) as u32
    }

    /// Goes as far as its drive does: by the pulses that it has not followed yet, or by what a motor does in a
    /// millisecond.
    pub(super) fn step(
        &mut self,
        now_ms: u64,
        see: &dyn Fn(Look) -> i32,
        moments: &mut Vec<Moment>,
    ) {
        let speed = self.drive.follow(see);
        self.moved = 0.0;
        if speed == 0.0 {
            return;
        }
        let from = self.position;
        let free = from + speed;
        let to = self.travel.map_or(free, |[min, max]| free.clamp(min, max));
        if to != free && self.collision.is_none() {
            self.collision = Some(Collision {
                axis: self.name.clone(),
                at_ms: now_ms,
                position: to / self.per_unit,
                unit: self.unit.clone(),
            });
        }
        for switch in &self.switches {
            switch.pass(from, to, speed, moments);
        }
        self.moved = to - from;
        self.position = to;
    }
}

impl Drive {
    /// Distance of the axis in a millisecond.
    fn follow(&mut self, see: &dyn Fn(Look) -> i32) -> f64 {
        match self {
            Drive::Pulses {
                output,
                direction,
                followed,
            } => {
                let sent = see(Look::Pulses(*output));
                let pulses = f64::from(sent.wrapping_sub(*followed));
                *followed = sent;
                match *direction {
                    None => pulses,
                    Some((output, forward)) if (see(Look::Output(output)) != 0) == forward => {
                        pulses.abs()
                    }
                    Some(_) => -pulses.abs(),
                }
            }
            Drive::Outputs {
                forward,
                back,
                out_speed,
                back_speed,
            } => {
                let on = |output| see(Look::Output(output)) != 0;
                let out = on(*forward);
                let back = match *back {
                    Back::Nothing => false,
                    Back::Spring => !out,
                    Back::Output(output) => on(output),
                };
                match (out, back) {
                    (true, false) => *out_speed,
                    (false, true) => -*back_speed,
                    _ => 0.0,
                }
            }
        }
    }
}
