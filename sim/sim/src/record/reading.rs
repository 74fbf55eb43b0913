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

impl Reading {
    /// Value of the target; `None` if the model or its hardware has no such device.
    pub fn of(seen: Seen, target: Target) -> Option<Reading> {
        let Seen { machine, hal, .. } = seen;
        Some(match target {
            Target::Channel(channel) => {
                let signal = hal.signal(channel.unit, channel.number, channel.quantity)?;
                Reading::Float(f64::from(signal) / 1e6)
            }
            Target::Bit(class, n) => Reading::Bit(bit(machine, class, n)?),
            Target::Current(class, n) if is_counter32(class, n) => {
                Reading::Integer(machine.counter32(n)?.into(), 32)
            }
            Target::Word(class, n) | Target::Current(class, n) => {
                Reading::Integer(machine.word(rt_class(class)?, n)?.into(), 16)
            }
            Target::Pair(class, n) => {
                Reading::Integer(pair(machine, rt_class(class)?, n)?.into(), 32)
            }
            Target::Float(class, n) => {
                let bits = pair(machine, rt_class(class)?, n)? as u32;
                Reading::Float(f32::from_bits(bits).into())
            }
            Target::Nibbles(digits, class, n) => {
                let width = 4 * u32::from(digits);
                let bit = |i| Some(i64::from(bit(machine, class, n.checked_add(i)?)?) << i);
                Reading::Integer((0..width).map(bit).sum::<Option<i64>>()?, width)
            }
            Target::Text(class, n) => {
                let class = rt_class(class)?;
                machine.word(class, n)?;
                let words = (n..).map_while(|n| machine.word(class, n));
                let bytes = words.take(TEXT_LENGTH / 2).flat_map(i16::to_le_bytes);
                let bytes: Vec<u8> = bytes.take_while(|&byte| byte != 0).collect();
                Reading::Text(String::from_utf8_lossy(&bytes).into_owned())
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

/// A bit. An output is its terminal, as in test files: pulses show there, and M8034 switches it off.
fn bit(machine: &Machine, class: DeviceClass, number: u32) -> Option<bool> {
    let on = machine.bit(rt_class(class)?, number)?;
    Some(match class {
        DeviceClass::Y => machine.output(number),
        _ => on,
    })
}

fn pair(machine: &Machine, class: Class, number: u32) -> Option<i32> {
    let low = machine.word(class, number)? as u16;
    let high = machine.word(class, number.checked_add(1)?)?;
    Some(i32::from(high) << 16 | i32::from(low))
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reading::Bit(on) => u8::from(*on).fmt(f),
            Reading::Integer(value, _) => value.fmt(f),
            // The device holds a single-precision value, which is shown with no more digits than it has.
            Reading::Float(value) => (*value as f32).fmt(f),
            Reading::Text(text) => write!(f, "{text:?}"),
        }
    }
}
