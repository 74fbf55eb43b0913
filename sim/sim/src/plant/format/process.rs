//! Processes and analog sensors.

use super::Reader;
use super::raw::{RawProcess, RawSensor};
use crate::plant::process::{Drive, Process, Sensor};
use crate::target::{Channel, Target};
use rungc_rt::modules::Quantity;
use toml::Spanned;

/// The shortest time constant, in seconds, and the longest: a day.
const TIMES_S: std::ops::RangeInclusive<f64> = 0.001..=86_400.0;

/// The longest dead time, in seconds.
const LONGEST_DEAD_S: f64 = 600.0;

impl Reader<'_> {
    pub(super) fn process(
        &mut self,
        at: usize,
        raw: RawProcess,
        before: &[Process],
    ) -> Option<Process> {
        let name = raw.name.get_ref().clone();
        if before.iter().any(|process| process.name == name) {
            self.report(
                raw.name.span().start,
                format!("two processes are named `{name}`"),
            );
        }
        let drive = self.process_drive(&raw);
        let constant = self.seconds(&raw.time_constant_s, TIMES_S);
        let dead = match &raw.dead_time_s {
            Some(dead) => self.seconds(dead, 0.0..=LONGEST_DEAD_S),
            None => Some(0.0),
        };
        if raw.sensor.is_empty() {
            self.report(at, "a process needs a `sensor`");
        }
        let sensors = raw.sensor.into_iter();
        let sensors = sensors.filter_map(|sensor| self.sensor(sensor)).collect();
        if raw.full == raw.rest {
            self.report(at, "`full` and `rest` of a process must differ");
        }
        Some(Process {
            name,
            unit: raw.unit.unwrap_or_else(|| "units".to_string()),
            rest: raw.rest,
            full: raw.full,
            drive: drive?,
            share: 1.0 - (-0.001 / constant?).exp(),
            waiting: std::iter::repeat_n(0.0, (dead? * 1000.0) as usize).collect(),
            value: raw.start.unwrap_or(raw.rest),
            sensors,
        })
    }

    fn process_drive(&mut self, raw: &RawProcess) -> Option<Drive> {
        let Some(signal) = &raw.drive_signal else {
            return match Target::parse(raw.drive.get_ref()) {
                Ok(Target::Channel(_)) => {
                    let message = "a channel drives with `drive_signal = [NONE, FULL]`";
                    self.report(raw.drive.span().start, message);
                    None
                }
                _ => self.output(&raw.drive).map(Drive::Output),
            };
        };
        let [none, full] = self.range(signal, 1.0)?;
        let channel = self.channel(&raw.drive)?;
        Some(Drive::Channel {
            channel,
            none,
            full,
        })
    }

    fn seconds(
        &mut self,
        value: &Spanned<f64>,
        range: std::ops::RangeInclusive<f64>,
    ) -> Option<f64> {
        let fits = range.contains(value.get_ref());
        if !fits {
            let message = format!("this time must be {} to {} s", range.start(), range.end());
            self.report(value.span().start, message);
        }
        fits.then_some(*value.get_ref())
    }

    /// A channel of a module.
    fn channel(&mut self, name: &Spanned<String>) -> Option<Channel> {
        let message = match Target::parse(name.get_ref()) {
            Ok(Target::Channel(channel)) => return Some(channel),
            Ok(_) => format!(
                "`{}` is not a channel of a module; write for example `0:CH1.V`",
                name.get_ref()
            ),
            Err(message) => message,
        };
        self.report(name.span().start, message);
        None
    }

    /// A sensor at an input of a module that no other one is connected to.
    pub(super) fn sensor(&mut self, raw: RawSensor) -> Option<Sensor> {
        let at = raw.channel.span().start;
        let channel = self.channel(&raw.channel)?;
        let place = (channel.unit, channel.number);
        if self.channels.contains(&place) {
            self.report(at, "another sensor is connected to this channel");
        }
        self.channels.push(place);
        let degrees = channel.quantity == Quantity::Celsius;
        let (range, signal) = match (&raw.range, &raw.signal) {
            (Some(range), Some(signal)) => (self.range(range, 1.0)?, self.range(signal, 1.0)?),
            (None, None) if degrees => ([0.0, 1.0], [0.0, 1.0]),
            _ => {
                let message =
                    "a sensor has `range`, two values, and `signal`, what it makes of them";
                self.report(at, message);
                return None;
            }
        };
        Some(Sensor {
            channel,
            range,
            signal,
            last: None,
        })
    }
}
