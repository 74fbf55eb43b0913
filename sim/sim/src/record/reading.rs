//! Values of devices, in the shapes that their names ask for.

use crate::plant::{Axis, Plant, Process};
use crate::target::Target;
use rungc_interp::{Machine, rt_class};
use rungc_models::runs::is_counter32;
use rungc_rt::{Class, Plc, Program, VirtualHal};
use rungc_syntax::DeviceClass;
use std::fmt;

/// Maximum number of characters of a text that are read.
pub const TEXT_LENGTH: usize = 64;

/// A PLC between two scans, with what is around it.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// The PLC.
    pub machine: &'a Machine<'a>,
    /// Its hardware.
    pub hal: &'a VirtualHal,
    /// The machine that it is wired to.
    pub plant: Option<&'a Plant>,
}

impl<'a> Seen<'a> {
    /// The axes of that machine.
    pub fn axes(self) -> &'a [Axis] {
        self.plant.map_or(&[], Plant::axes)
    }

    /// The processes of that machine.
    pub fn processes(self) -> &'a [Process] {
        self.plant.map_or(&[], Plant::processes)
    }
}

/// Value of a device.
#[derive(Clone, PartialEq, Debug)]
pub enum Reading {
    /// A bit.
    Bit(bool),
    /// A word, a pair, a group of bits: the value and its width in bits.
    Integer(i64, u32),
    /// A float.
    Float(f64),
    /// Characters.
    Text(String),
}

/// Values of the devices of a PLC.
pub trait Values {
    /// A bit; of a timer or counter its contact. `None` if there is no such bit, as for all of these.
    fn bit(&self, class: DeviceClass, number: u32) -> Option<bool>;

    /// A word; of a timer or counter its current value.
    fn word(&self, class: DeviceClass, number: u32) -> Option<i16>;

    /// The current value of a counter that has 32 bits.
    fn counter32(&self, number: u32) -> Option<i32>;

    /// A pair of words, the low one first.
    fn pair(&self, class: DeviceClass, number: u32) -> Option<i32> {
        let low = self.word(class, number)? as u16;
        let high = self.word(class, number.checked_add(1)?)?;
        Some(i32::from(high) << 16 | i32::from(low))
    }
}

/// A PLC as test files see it: an output is its terminal, at which pulses show and which M8034 switches off.
struct Outside<'a>(&'a Machine<'a>);

impl Values for Outside<'_> {
    fn bit(&self, class: DeviceClass, number: u32) -> Option<bool> {
        let on = self.0.bit(rt_class(class)?, number)?;
        Some(match class {
            DeviceClass::Y => self.0.output(number),
            _ => on,
        })
    }

    fn word(&self, class: DeviceClass, number: u32) -> Option<i16> {
        self.0.word(rt_class(class)?, number)
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.0.counter32(number)
    }
}

impl Reading {
    /// Value of the target; `None` if the model or its hardware has no such device.
    pub fn of(seen: Seen, target: Target) -> Option<Reading> {
        let Seen { machine, hal, .. } = seen;
        Some(match target {
            Target::Channel(channel) => {
                let signal = hal.signal(channel.unit, channel.number, channel.quantity)?;
                Reading::Float(f64::from(signal) / 1e6)
            }
            Target::Pulses(n) => {
                machine.bit(Class::Y, n)?;
                let sent = machine.pulse_output(n).map_or(0, |axis| axis.sent);
                Reading::Integer(sent.into(), 32)
            }
            Target::Frequency(n) => {
                machine.bit(Class::Y, n)?;
                Reading::Float(hertz(machine, n).abs())
            }
            _ => return Reading::of_values(&Outside(machine), target),
        })
    }

    /// Value of the target among these; `None` if it is not, as pulses and signals of modules never are.
    pub fn of_values(values: &impl Values, target: Target) -> Option<Reading> {
        Some(match target {
            Target::Bit(class, n) => Reading::Bit(values.bit(class, n)?),
            Target::Current(class, n) if is_counter32(class, n) => {
                Reading::Integer(values.counter32(n)?.into(), 32)
            }
            Target::Word(class, n) | Target::Current(class, n) => {
                Reading::Integer(values.word(class, n)?.into(), 16)
            }
            Target::Pair(class, n) => Reading::Integer(values.pair(class, n)?.into(), 32),
            Target::Float(class, n) => {
                let bits = values.pair(class, n)? as u32;
                Reading::Float(f32::from_bits(bits).into())
            }
            Target::Nibbles(digits, class, n) => {
                let width = 4 * u32::from(digits);
                let bit = |i| Some(i64::from(values.bit(class, n.checked_add(i)?)?) << i);
                Reading::Integer((0..width).map(bit).sum::<Option<i64>>()?, width)
            }
            Target::Text(class, n) => {
                values.word(class, n)?;
                let words = (n..).map_while(|n| values.word(class, n));
                let bytes = words.take(TEXT_LENGTH / 2).flat_map(i16::to_le_bytes);
                let bytes: Vec<u8> = bytes.take_while(|&byte| byte != 0).collect();
                Reading::Text(String::from_utf8_lossy(&bytes).into_owned())
            }
            Target::Pulses(_) | Target::Frequency(_) | Target::Channel(_) => return None,
        })
    }
}

/// The pulses that an output sends a second, negative for those that count down.
pub fn hertz(machine: &Machine, output: u32) -> f64 {
    let Some(axis) = machine.pulse_output(output) else {
        return 0.0;
    };
    let hertz = f64::from(axis.generator.millihertz()) / 1000.0;
    if axis.generator.is_reverse() && hertz > 0.0 {
        -hertz
    } else {
        hertz
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reading::Bit(on) => u8::from(*on).fmt(f),
            Reading::Integer(value, _) => value.fmt(f),
            // The device holds a single-precision value, which is shown with no more digits than it has.
            Reading::Float(value) => f.pad(&decimal(f64::from(*value as f32))),
            Reading::Text(text) => write!(f, "{text:?}"),
        }
    }
}

/// A number as people write it: the digits of single precision where these are all it has, and a power of ten where it
/// would have many zeros: `0.25`, `1.5e-20`.
pub fn decimal(value: f64) -> String {
    let single = value as f32;
    let is_plain = value == 0.0 || !value.is_finite() || (1e-5..1e10).contains(&value.abs());
    match (f64::from(single) == value, is_plain) {
        (true, true) => single.to_string(),
        (true, false) => format!("{single:e}"),
        (false, true) => value.to_string(),
        (false, false) => format!("{value:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::decimal;

    #[test]
    fn numbers_have_the_digits_that_they_need() {
        for (value, written) in [
            (0.0, "0"),
            (f64::from(0.1_f32), "0.1"),
            (0.1, "0.1"),
            (12.5, "12.5"),
            (-0.00025, "-0.00025"),
            (f64::from(-2.5e-7_f32), "-2.5e-7"),
            (f64::from(1e-45_f32), "1e-45"),
            (9_999_999_999.0, "9999999999"),
            (f64::from(3.4e38_f32), "3.4e38"),
            (1e39, "1e39"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(decimal(value), written);
        }
    }
}
