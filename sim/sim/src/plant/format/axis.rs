//! Axes, and what drives them.

use super::Reader;
use super::raw::{RawAxis, RawDirection};
use super::switches::Scale;
use super::values::FASTEST;
use crate::plant::axis::{Axis, Back, Drive};
use rungc_syntax::DeviceClass;
use toml::Spanned;

/// Maximum number of cycles of an encoder per pulse.
const CYCLES_PER_PULSE: f64 = 10.0;

impl Reader<'_> {
    /// An axis; `before` are those that are above it.
    pub(super) fn axis(&mut self, at: usize, raw: RawAxis, before: &[Axis]) -> Option<Axis> {
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
            self.report(at, format!("two axes are named `{name}`"));
        }
        if name.is_empty() || name.contains(char::is_control) {
            self.report(at, "the name of an axis must be a single line");
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
        let sensors = raw.sensor.into_iter();
        let sensors = sensors.filter_map(|sensor| self.sensor(sensor)).collect();
        Some(Axis {
            name,
            unit,
            per_unit,
            drive,
            position,
            moved: 0.0,
            travel,
            switches,
            sensors,
            collision: None,
        })
    }

    /// Drive of an axis, and the name of the output.
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
                    self.report(span.start, "this is for axes with `forward`, not `output`");
                }
                let number = self.output(output)?;
                let direction = match &raw.direction {
                    Some(direction) => Some(self.output(direction)?),
                    None => None,
                };
                if let (Some(name), true) = (&raw.direction, direction == Some(number)) {
                    let message = "the direction output must differ from the pulse output";
                    self.report(name.span().start, message);
                }
                if let (None, Some(on)) = (direction, &raw.direction_on) {
                    self.report(on.span().start, "this requires `direction`");
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
                    self.report(span.start, "this is for axes with `output`, not `forward`");
                }
                let number = self.output(forward)?;
                let back = match &raw.reverse {
                    Some(reverse) => Back::Output(self.output(reverse)?),
                    None => Back::Nothing,
                };
                let Some(speed) = &raw.speed else {
                    self.report(
                        at,
                        "an axis with `forward` needs a `speed` in units per second",
                    );
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
                    Some(_) => "use `output` (pulses) or `forward` (a motor) for an axis, not both",
                    None => "an axis needs `output` (pulses), or `forward` and `speed` (a motor)",
                };
                self.report(at, message);
                None
            }
        }
    }
}
