//! Devices that are set at a time: `X000=1@200ms`.

use super::Failure;
use rungc_sim::Target;
use rungc_syntax::DeviceClass;

/// `X000=1@200ms`.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Time in milliseconds.
    pub at_ms: u64,
    /// Target to set.
    pub target: Target,
    /// To what.
    pub value: f64,
}

/// The greatest signal of a channel, in its unit.
const MOST_SIGNAL: f64 = 2000.0;

/// Reads what is watched or set.
pub fn target(name: &str) -> std::result::Result<Target, Failure> {
    let upper = upper(name);
    match Target::parse(&upper).map_err(Failure::Because)? {
        // A timer or counter is watched by its current value.
        Target::Bit(class @ (DeviceClass::T | DeviceClass::C), n) => Ok(Target::Current(class, n)),
        target => Ok(target),
    }
}

/// Device letters in upper case, views (`.i32`) as they are.
fn upper(name: &str) -> String {
    let (device, view) = name
        .trim()
        .split_once('.')
        .map_or((name.trim(), None), |(d, v)| (d, Some(v)));
    let device = device.to_uppercase();
    view.map_or(device.clone(), |view| {
        format!("{device}.{}", view.to_lowercase())
    })
}

/// Reads `X000=1@200ms` after `--set`.
pub fn setting(text: &str) -> std::result::Result<Setting, Failure> {
    parse(text).map_err(|why| Failure::Because(format!("--set {text}: {why}")))
}

/// Reads `X000=1@200ms`; the error describes the problem.
pub fn parse(text: &str) -> std::result::Result<Setting, String> {
    let (name, rest) = text
        .split_once('=')
        .ok_or("write DEVICE=VALUE, for example X000=1@200ms")?;
    let (value, at) = rest
        .split_once('@')
        .map_or((rest, None), |(value, at)| (value, Some(at)));
    let at_ms = at.map_or(Ok(0), crate::time::parse)?;
    let target = target(name).map_err(|error| error.to_string())?;
    let value: f64 = value
        .trim()
        .parse()
        .map_err(|_| format!("`{value}` is not a number"))?;
    fits(target, value)?;
    Ok(Setting {
        at_ms,
        target,
        value,
    })
}

/// Checks that a device can be set to a value; the error states the reason if not.
pub fn fits(target: Target, value: f64) -> std::result::Result<(), String> {
    let fits = match target {
        Target::Float(..) => Target::is_float(value),
        Target::Channel(_) => value.abs() <= MOST_SIGNAL,
        Target::Text(..) => return Err("characters cannot be set here".to_string()),
        Target::Pulses(_) | Target::Frequency(_) => {
            return Err("only the program can send pulses".to_string());
        }
        Target::Bit(..)
        | Target::Word(..)
        | Target::Current(..)
        | Target::Pair(..)
        | Target::Nibbles(..) => {
            let range = target.integers();
            value.fract() == 0.0 && range.is_some_and(|range| range.contains(&(value as i64)))
        }
    };
    match fits {
        true => Ok(()),
        false => Err(format!("`{value}` does not fit `{target}`")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_read() {
        let read = setting("x010=1@200ms").unwrap();
        assert_eq!(
            read,
            Setting {
                at_ms: 200,
                target: Target::Bit(DeviceClass::X, 8),
                value: 1.0
            }
        );
        assert_eq!(setting("D0.i32=-70000").unwrap().value, -70000.0);
        for right in [
            "C200.value=70000",
            "K4M0=-1",
            "K8M0=4294967295",
            "D0.f32=3.4e38",
        ] {
            assert!(setting(right).is_ok(), "{right}");
        }
        for wrong in [
            "X000",
            "X000=2",
            "X008=1",
            "D0=70000",
            "D0=-32769",
            "D0=1e30",
            "D0=nan",
            "D0.f32=1e39",
            "D0.f32=-inf",
            "D0.i32=4294967296",
            "T0.value=65536",
            "C199.value=70000",
            "K1M0=16",
            "K1M0=-1",
            "K5M0=1048576",
            "D0=x",
            "D0=1@soon",
            "Q1=1",
        ] {
            assert!(setting(wrong).is_err(), "{wrong}");
        }
    }
}
