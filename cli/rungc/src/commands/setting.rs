//! Devices that are set at a time: `X000=1@200ms`.

use super::{Failure, eprint_line};
use rungc::Names;
use rungc::names::fits;
use rungc_emit::events;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_sim::Target;
use rungc_sim::record::TEXT_LENGTH;
use rungc_syntax::{DeviceClass, Program};

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

/// Splits the lists that follow an option.
///
/// # Errors
/// An item is empty.
pub fn items<'t>(
    option: &str,
    lists: &'t [String],
    names: &Names,
) -> std::result::Result<Vec<&'t str>, Failure> {
    let mut all = Vec::new();
    for list in lists {
        let items = names.items(list, name);
        if items.iter().any(|item| item.trim().is_empty()) {
            let why = "nothing stands before or after a comma";
            return Err(Failure::Because(format!("{option} \"{list}\": {why}")));
        }
        all.extend(items);
    }
    Ok(all)
}

/// Reads the ranges of an option, which may be repeated or has several, separated by commas.
///
/// # Errors
/// The option, and what is wrong with a range.
pub fn ranges(
    option: &str,
    lists: &[String],
    names: &Names,
) -> std::result::Result<Vec<(DeviceClass, u32, u32)>, Failure> {
    let items = items(option, lists, names)?.into_iter();
    let ranges = items.map(|text| names.range(text.trim()));
    let ranges: std::result::Result<_, String> = ranges.collect();
    ranges.map_err(|why| Failure::Because(format!("{option}: {why}")))
}

/// Checks that the device of a setting keeps its value; a register of the clock may do so, while a relay stops it.
///
/// # Errors
/// The reason why it does not.
pub fn lasts(setting: &Setting, model: &Model) -> std::result::Result<(), String> {
    rungc_sim::check_lasts(model, setting.target, |_| true)
}

/// Checks that the devices of what follows `--set` keep their values.
pub fn check(settings: &[Setting], model: &Model) -> std::result::Result<(), Failure> {
    settings.iter().try_for_each(|setting| {
        let why = |why: String| {
            Failure::Because(format!("--set {}={}: {why}", setting.target, setting.value))
        };
        lasts(setting, model).map_err(why)
    })
}

/// The name in a setting. Comments may contain the sign.
fn name(setting: &str) -> &str {
    setting.rsplit_once('=').map_or(setting, |(name, _)| name)
}

/// Reads what follows `--set`, in the order of the times.
pub fn settings(texts: &[String], names: &Names) -> std::result::Result<Vec<Setting>, Failure> {
    let settings = items("--set", texts, names)?.into_iter().map(|text| {
        parse(text, names).map_err(|why| Failure::Because(format!("--set {text}: {why}")))
    });
    let mut settings = settings.collect::<std::result::Result<Vec<_>, _>>()?;
    settings.sort_by_key(|setting| setting.at_ms);
    Ok(settings)
}

/// Devices of a target.
pub fn devices(target: Target) -> impl Iterator<Item = (DeviceClass, u32)> {
    let (class, first, count) = target.devices(TEXT_LENGTH);
    (first..first.saturating_add(count)).map(move |n| (class, n))
}

/// Targets of settings that nothing in the program uses.
fn unused(settings: &[Setting], program: &Program, options: CompileOptions) -> Vec<Target> {
    let mut targets: Vec<Target> = Vec::new();
    for setting in settings {
        let general = devices(setting.target).all(|(class, n)| !is_special(class, n));
        let stored = !matches!(setting.target, Target::Channel(_));
        if general && stored && !targets.contains(&setting.target) {
            targets.push(setting.target);
        }
    }
    if targets.is_empty() {
        return targets;
    }
    let options = CompileOptions {
        optimise: false,
        ..options
    };
    let Some(module) = compile(program, &options).module else {
        return Vec::new();
    };
    let edges = events::inputs(&module);
    let is_used = |(class, n)| {
        let (class, n) = module.model.canonical(class, n);
        let has_edge = class == DeviceClass::X && edges.contains(&n);
        has_edge || module.layout.area(class, n).is_some()
    };
    targets.retain(|target| !devices(*target).any(is_used));
    targets
}

/// Reports settings of devices that nothing in the program uses; `options` compile it without them.
pub fn report_unused(settings: &[Setting], program: &Program, options: CompileOptions) {
    let names: Vec<_> = unused(settings, program, options)
        .iter()
        .map(|target| format!("`{target}`"))
        .collect();
    if let Some((last, others)) = names.split_last() {
        let set = match others {
            [] => format!("{last}, which is set"),
            others => format!("{} and {last}, which are set", others.join(", ")),
        };
        eprint_line(&format!("rungc: the program does not use {set}"));
    }
}

/// Reports settings whose time did not come.
pub fn report_late<'s>(late: impl Iterator<Item = &'s Setting>) {
    for Setting { at_ms, target, .. } in late {
        let why = format!("its time, {at_ms} ms, is after the last scan");
        eprint_line(&format!("rungc: `{target}` was not set: {why}"));
    }
}

/// Reads `X000=1@200ms`; the error describes the problem.
pub fn parse(text: &str, names: &Names) -> std::result::Result<Setting, String> {
    // Comments may contain the sign.
    let (name, rest) = text
        .rsplit_once('=')
        .ok_or("write DEVICE=VALUE, for example X000=1@200ms")?;
    let (value, at) = rest
        .split_once('@')
        .map_or((rest, None), |(value, at)| (value, Some(at)));
    let at_ms = at.map_or(Ok(0), crate::time::parse)?;
    let target = names.target(name)?;
    let value = number(value.trim()).ok_or_else(|| {
        format!("`{value}` is not a number: write for example 5, -1.5, H1F or 0x1F")
    })?;
    fits(target, value)?;
    Ok(Setting {
        at_ms,
        target,
        value,
    })
}

/// Reads a number as people or programs write it: `31`, `K31`, `H1F`, `0x1F`.
fn number(text: &str) -> Option<f64> {
    let digits = ["0x", "0X", "H", "h"]
        .iter()
        .find_map(|prefix| text.strip_prefix(prefix));
    if let Some(digits) = digits {
        let is_hex = digits.bytes().all(|digit| digit.is_ascii_hexdigit());
        let number = i64::from_str_radix(digits, 16).ok().filter(|_| is_hex);
        return number.map(|number| number as f64);
    }
    match text.strip_prefix(['K', 'k']) {
        Some(digits) => digits.parse::<i64>().ok().map(|number| number as f64),
        None => text.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setting(text: &str) -> std::result::Result<Setting, String> {
        parse(text, &Names::of(&Program::default()))
    }

    #[test]
    fn settings_of_devices_without_a_use_are_found() {
        let list = "LD X000\nAND M0\nOUT Y000\nLD M1\nMOV D0 K2M20\nLDI C235\nOUT C235 K5\nBMOV D100 D200 K8\nMOV D301 Z0\nMOV D300 R400Z0\nEND\n";
        let program = rungc_frontend::read_text("a.il", list).program;
        let is_unused = |text: &str| {
            let settings = [setting(text).unwrap()];
            !unused(&settings, &program, CompileOptions::default()).is_empty()
        };
        let inputs = ["X050=1", "X001=1", "X007=1"];
        let others = [
            "M2=1",
            "S5=1",
            "D5=1",
            "T3=1",
            "C7=1",
            "D96.i32=1",
            "K1M12=3",
            "Y007=1",
        ];
        for text in inputs.into_iter().chain(others) {
            assert!(is_unused(text), "{text}");
        }
        let read = [
            "X000=1",
            "M0=1",
            "M1=1",
            "M27=1",
            "D0=1",
            "D107=1",
            "D99.i32=1",
            "R450=1",
        ];
        let own = ["M8012=1", "D8000=100", "C235=1", "Y000=1"];
        for text in read.into_iter().chain(own) {
            assert!(!is_unused(text), "{text}");
        }
    }

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
            "D0.f32=1.4e-45",
            "D0.f32=0",
            "D0=HFFFF",
            "D0=0x1f",
            "D0=K-5",
            "D0=k7@1s",
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
            "D0=1@-1s",
            "D0=1@1.4ms",
            "D0=H",
            "D0=H-1",
            "D0=0x+1",
            "D0=K1.5",
            "D0.f32=1e-50",
            "Q1=1",
        ] {
            assert!(setting(wrong).is_err(), "{wrong}");
        }
    }
}
