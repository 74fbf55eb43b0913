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
        Target::Bit(..) => value == 0.0 || value == 1.0,
        Target::Word(..) => value.fract() == 0.0 && (-32768.0..=65535.0).contains(&value),
        Target::Float(..) => true,
        Target::Channel(_) => value.abs() <= MOST_SIGNAL,
        Target::Text(..) => return Err("characters cannot be set here".to_string()),
        Target::Pulses(_) | Target::Frequency(_) => {
            return Err("only the program can send pulses".to_string());
        }
        _ => value.fract() == 0.0 && (-2_147_483_648.0..=4_294_967_295.0).contains(&value),
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
        for wrong in [
            "X000",
            "X000=2",
            "X008=1",
            "D0=70000",
            "D0=x",
            "D0=1@soon",
            "Q1=1",
        ] {
            assert!(setting(wrong).is_err(), "{wrong}");
        }
    }
}
