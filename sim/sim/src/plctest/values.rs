//! Values of devices as test files write them.

use super::Value;
use super::raw::Scalar;
use crate::target::Target;
use rungc_rt::FIRST_COUNTER32;

/// An integer of this many bits, signed or unsigned; `"0xFFFF"` too.
pub(super) fn integer(value: &Scalar, bits: u32) -> Option<i64> {
    let value = match value {
        Scalar::Integer(value) => *value,
        Scalar::Text(text) => i64::from_str_radix(text.strip_prefix("0x")?, 16).ok()?,
        Scalar::Float(_) | Scalar::Near(_) => return None,
    };
    (-1 << (bits - 1)..1 << bits)
        .contains(&value)
        .then_some(value)
}

impl Value {
    /// The value that a target is given or compared with; the error says what is expected.
    pub(super) fn of(target: Target, value: &Scalar) -> Result<Value, &'static str> {
        let word = || integer(value, 16).map(|v| Value::Int((v as i16).into()));
        let double = || integer(value, 32).map(|v| Value::Int(v as i32));
        match target {
            Target::Bit(..) => match value {
                Scalar::Integer(v @ 0..=1) => Ok(Value::Int(*v as i32)),
                _ => Err("0 or 1"),
            },
            Target::Current(rungc_syntax::DeviceClass::C, FIRST_COUNTER32..) => {
                double().ok_or("a 32-bit integer")
            }
            Target::Word(..) | Target::Current(..) | Target::Nibbles(1..=4, ..) => {
                word().ok_or("a 16-bit integer, or hexadecimal in quotes: \"0xFFFF\"")
            }
            Target::Pair(..) | Target::Nibbles(..) | Target::Pulses(_) => {
                double().ok_or("a 32-bit integer")
            }
            Target::Float(..) | Target::Frequency(_) | Target::Channel(_) => match value {
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
