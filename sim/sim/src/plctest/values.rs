//! Values of devices as test files write them.

use super::Value;
use super::raw::Scalar;
use crate::target::Target;
use rungc_models::runs::is_counter32;

/// An integer; `"0xFFFF"` too.
pub(super) fn integer(value: &Scalar) -> Option<i64> {
    match value {
        Scalar::Integer(value) => Some(*value),
        Scalar::Text(text) => i64::from_str_radix(text.strip_prefix("0x")?, 16).ok(),
        Scalar::Float(_) | Scalar::Near(_) => None,
    }
}

impl Value {
    /// The value that a target is given or compared with; the error says what is expected.
    pub(super) fn of(target: Target, value: &Scalar) -> Result<Value, &'static str> {
        let held = || {
            let range = target.integers()?;
            integer(value).filter(|value| range.contains(value))
        };
        let word = || held().map(|v| Value::Int((v as i16).into()));
        let double = || held().map(|v| Value::Int(v as i32));
        match target {
            Target::Bit(..) => match value {
                Scalar::Integer(v @ 0..=1) => Ok(Value::Int(*v as i32)),
                _ => Err("0 or 1"),
            },
            Target::Current(class, number) if is_counter32(class, number) => {
                double().ok_or("a 32-bit integer")
            }
            Target::Nibbles(1..=3 | 5..=7, ..) => {
                double().ok_or("an integer of the group's digits, from 0")
            }
            Target::Word(..) | Target::Current(..) | Target::Nibbles(4, ..) => {
                word().ok_or("a 16-bit integer, or hexadecimal in quotes: \"0xFFFF\"")
            }
            Target::Pair(..) | Target::Nibbles(..) | Target::Pulses(_) => {
                double().ok_or("a 32-bit integer")
            }
            Target::Float(..) => match value {
                Scalar::Integer(v) => Ok(Value::Float(*v as f64)),
                Scalar::Float(v) if Target::is_float(*v) => Ok(Value::Float(*v)),
                Scalar::Float(_) => Err("a number of 32 bits, up to 3.4e38"),
                Scalar::Text(_) | Scalar::Near(_) => Err("a number"),
            },
            Target::Frequency(_) | Target::Channel(_) => match value {
                Scalar::Integer(v) => Ok(Value::Float(*v as f64)),
                Scalar::Float(v) => Ok(Value::Float(*v)),
                Scalar::Text(_) | Scalar::Near(_) => Err("a number"),
            },
            Target::Text(..) => match value {
                Scalar::Text(text) => Ok(Value::Text(text.clone())),
                _ => Err("a text in quotes"),
            },
        }
    }
}
