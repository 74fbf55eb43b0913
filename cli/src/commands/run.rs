//! `rungc run`.

mod view;

use super::{Context, Failure, Outcome, Result, conclude, findings, read, stem, tell};
use crate::args::RunArgs;
use crate::report;
use rungc_ir::Module;
use rungc_ir::compile::{CompileOptions, compile};
use rungc_rt::{Program, VirtualHal};
use rungc_sim::Machine;
use rungc_sim::plctest::Target;
use rungc_syntax::DeviceClass;
use std::io::{self, Write};
use std::thread;
use std::time::{Duration, Instant};
use view::{Column, Kind, View};

/// `X000=1@200ms`.
#[derive(Clone, Debug, PartialEq)]
struct Setting {
    at_ms: u64,
    target: Target,
    value: f64,
}

/// How many devices are shown when none are asked for.
const DEFAULT_COLUMNS: usize = 12;

/// Special relays and registers have numbers from here on; they are shown only when asked for.
const SPECIAL_FIRST: u32 = 8000;

/// How many characters of a text are shown at most.
const TEXT_LENGTH: usize = 64;

/// Runs a program in the interpreter, showing the watched devices.
pub fn run(args: &RunArgs, cx: Context) -> Result {
    if args.scan == 0 {
        return Err(Failure::Because(
            "--scan: a scan takes at least 1 ms".to_string(),
        ));
    }
    let mut settings = args
        .set
        .iter()
        .map(|text| setting(text))
        .collect::<std::result::Result<Vec<_>, _>>()?;
    settings.sort_by_key(|s| s.at_ms);
    let watched = args
        .watch
        .iter()
        .map(|name| target(name))
        .collect::<std::result::Result<Vec<_>, _>>()?;
    let read = read(&args.input, cx)?;
    let used = settings.iter().map(|s| s.target).chain(watched.clone());
    let options = CompileOptions {
        model: args.input.model,
        name: Some(stem(&args.input, &read)),
        observe: used.flat_map(observed).collect(),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let findings = findings(&args.input, &read, &compiled);
    let module = match compiled.module {
        Some(module) if !findings.failed() => module,
        _ => return conclude(&findings, &args.input.reporting, cx, String::new),
    };
    report::print(&findings, &args.input.reporting, cx.color, cx.taken)?;
    let watched = if watched.is_empty() {
        default_watch(&module)
    } else {
        watched
    };
    simulate(args, &module, &settings, &watched)
}

fn target(name: &str) -> std::result::Result<Target, Failure> {
    let upper = upper(name);
    match Target::parse(&upper).map_err(Failure::Because)? {
        Target::Pulses(_) | Target::Frequency(_) => Err(Failure::Because(format!(
            "`{name}`: pulse outputs cannot be watched yet"
        ))),
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

fn setting(text: &str) -> std::result::Result<Setting, Failure> {
    let wrong = |why: String| Failure::Because(format!("--set {text}: {why}"));
    let (name, rest) = text
        .split_once('=')
        .ok_or_else(|| wrong("write DEVICE=VALUE, for example X000=1@200ms".to_string()))?;
    let (value, at) = rest
        .split_once('@')
        .map_or((rest, None), |(value, at)| (value, Some(at)));
    let at_ms = at.map_or(Ok(0), crate::time::parse).map_err(wrong)?;
    let target = target(name).map_err(|error| wrong(error.to_string()))?;
    let value: f64 = value
        .trim()
        .parse()
        .map_err(|_| wrong(format!("`{value}` is no number")))?;
    let fits = match target {
        Target::Bit(..) => value == 0.0 || value == 1.0,
        Target::Word(..) => value.fract() == 0.0 && (-32768.0..=65535.0).contains(&value),
        Target::Float(..) => true,
        Target::Text(..) => return Err(wrong("characters cannot be set here".to_string())),
        _ => value.fract() == 0.0 && (-2_147_483_648.0..=4_294_967_295.0).contains(&value),
    };
    if fits {
        Ok(Setting {
            at_ms,
            target,
            value,
        })
    } else {
        Err(wrong(format!("`{value}` does not fit `{target}`")))
    }
}

/// A watched or set device is kept though the program may not use it.
fn observed(target: Target) -> impl Iterator<Item = (DeviceClass, u32)> {
    let (class, first, count) = target.devices(TEXT_LENGTH);
    (first..first.saturating_add(count)).map(move |n| (class, n))
}

/// The outputs, timers and counters that the program uses, then its registers and relays, as far as a line holds them.
fn default_watch(module: &Module) -> Vec<Target> {
    let of = |class| {
        let areas = module.layout.areas.iter().filter(move |a| a.class == class);
        areas.flat_map(|a| a.first..a.first + a.count)
    };
    let outputs = of(DeviceClass::Y).map(|n| Target::Bit(DeviceClass::Y, n));
    let timers = of(DeviceClass::T).map(|n| Target::Current(DeviceClass::T, n));
    let counters = of(DeviceClass::C).map(|n| Target::Current(DeviceClass::C, n));
    let special = |n: &u32| *n >= SPECIAL_FIRST;
    let registers = of(DeviceClass::D).filter(move |n| !special(n));
    let relays = of(DeviceClass::M).filter(move |n| !special(n));
    outputs
        .chain(timers)
        .chain(counters)
        .chain(registers.map(|n| Target::Word(DeviceClass::D, n)))
        .chain(relays.map(|n| Target::Bit(DeviceClass::M, n)))
        .take(DEFAULT_COLUMNS)
        .collect()
}

fn column(target: Target) -> Column {
    let kind = match target {
        Target::Bit(..) => Kind::Bit,
        Target::Current(DeviceClass::T, _) => Kind::Running,
        _ => Kind::Number,
    };
    // T0 rather than T0.value: the table shows at once that it is a number.
    let name = match target {
        Target::Current(class, n) => class.number(n).to_string(),
        other => other.to_string(),
    };
    Column { name, kind }
}

fn missing(target: Target, module: &Module) -> Failure {
    let model = module.model.title;
    Failure::Because(format!("`{target}` does not exist on {model}"))
}

fn simulate(args: &RunArgs, module: &Module, settings: &[Setting], watched: &[Target]) -> Result {
    let mut machine = Machine::new(module);
    let mut hal = VirtualHal::new();
    let mut view = View::new(watched.iter().map(|&t| column(t)).collect());
    let mut pending = settings.iter().peekable();
    // What does not exist is said before anything is shown.
    for target in settings.iter().map(|s| s.target).chain(watched.to_vec()) {
        device::get(&machine, target).ok_or_else(|| missing(target, module))?;
    }
    let mut out = io::stdout().lock();
    writeln!(out, "{}", view.heading())?;
    let begin = Instant::now();
    let mut now = 0;
    while let Some(setting) = pending.next_if(|s| s.at_ms == 0) {
        device::set(&mut machine, setting.target, setting.value)
            .ok_or_else(|| missing(setting.target, module))?;
    }
    loop {
        hal.advance_to(now as u32);
        let scan_us = (args.scan * 1000).min(u64::from(u32::MAX)) as u32;
        machine.scan(&mut hal, now as u32, scan_us);
        let values = watched
            .iter()
            .map(|&t| device::get(&machine, t).ok_or_else(|| missing(t, module)))
            .collect::<std::result::Result<Vec<_>, _>>()?;
        if let Some(row) = view.scan(now, &values) {
            writeln!(out, "{row}")?;
        }
        if machine.watchdog_tripped() {
            tell(&format!(
                "rungc: at {now} ms: a scan does not end (watchdog, D8061 = 6105)"
            ));
            return Ok(Outcome::Failed);
        }
        if now + args.scan > args.duration {
            break;
        }
        for _ in 0..args.scan {
            now += 1;
            machine.tick(now as u32);
            while let Some(setting) = pending.next_if(|s| s.at_ms == now) {
                device::set(&mut machine, setting.target, setting.value)
                    .ok_or_else(|| missing(setting.target, module))?;
                if let Target::Bit(DeviceClass::X, number) = setting.target {
                    machine.input_edge(number, setting.value != 0.0);
                }
            }
            machine.take_interrupts(&mut hal);
        }
        if args.real_time {
            thread::sleep(Duration::from_millis(now).saturating_sub(begin.elapsed()));
        }
    }
    write!(out, "\n{}", view.diagram(args.duration))?;
    for late in pending {
        tell(&format!(
            "rungc: `{}` was not set: its time, {} ms, lies behind the last scan",
            late.target, late.at_ms
        ));
    }
    Ok(Outcome::Success)
}

/// Devices of the machine by their names.
mod device {
    use rungc_ir::runs::is_counter32;
    use rungc_rt::{Class, Plc};
    use rungc_sim::Machine;
    use rungc_sim::plctest::Target;
    use rungc_sim::rt_class as class_of;

    fn pair(machine: &Machine, class: Class, number: u32) -> Option<i32> {
        let low = machine.word(class, number)? as u16;
        let high = machine.word(class, number + 1)?;
        Some(i32::from(high) << 16 | i32::from(low))
    }

    fn set_pair(machine: &mut Machine, class: Class, number: u32, value: i32) -> Option<()> {
        machine.set_word(class, number, value as i16)?;
        machine.set_word(class, number + 1, (value >> 16) as i16)
    }

    /// Sets a device; `None` if the model has no such device.
    pub fn set(machine: &mut Machine, target: Target, value: f64) -> Option<()> {
        let integer = value as i64;
        match target {
            Target::Bit(class, n) => machine.set_bit(class_of(class)?, n, value != 0.0),
            Target::Current(class, n) if is_counter32(class, n) => {
                machine.set_counter32(n, integer as i32)
            }
            Target::Word(class, n) | Target::Current(class, n) => {
                machine.set_word(class_of(class)?, n, integer as i16)
            }
            Target::Pair(class, n) => set_pair(machine, class_of(class)?, n, integer as i32),
            Target::Float(class, n) => set_pair(
                machine,
                class_of(class)?,
                n,
                (value as f32).to_bits() as i32,
            ),
            Target::Nibbles(digits, class, n) => {
                let class = class_of(class)?;
                (0..4 * u32::from(digits))
                    .try_for_each(|i| machine.set_bit(class, n + i, integer >> i & 1 == 1))
            }
            Target::Text(..) | Target::Pulses(_) | Target::Frequency(_) => None,
        }
    }

    /// A device's value as text; `None` if the model has no such device.
    pub fn get(machine: &Machine, target: Target) -> Option<String> {
        Some(match target {
            Target::Bit(class, n) => u8::from(machine.bit(class_of(class)?, n)?).to_string(),
            Target::Current(class, n) if is_counter32(class, n) => {
                machine.counter32(n)?.to_string()
            }
            Target::Word(class, n) | Target::Current(class, n) => {
                machine.word(class_of(class)?, n)?.to_string()
            }
            Target::Pair(class, n) => pair(machine, class_of(class)?, n)?.to_string(),
            Target::Float(class, n) => {
                f32::from_bits(pair(machine, class_of(class)?, n)? as u32).to_string()
            }
            Target::Nibbles(digits, class, n) => {
                let class = class_of(class)?;
                let bit = |i| Some(u32::from(machine.bit(class, n + i)?) << i);
                (0..4 * u32::from(digits))
                    .map(bit)
                    .sum::<Option<u32>>()?
                    .to_string()
            }
            Target::Text(class, n) => {
                let class = class_of(class)?;
                let words = (n..)
                    .map_while(|n| machine.word(class, n))
                    .take(super::TEXT_LENGTH / 2);
                let bytes = words
                    .flat_map(i16::to_le_bytes)
                    .take_while(|&b| b != 0)
                    .collect::<Vec<_>>();
                format!("{:?}", String::from_utf8_lossy(&bytes))
            }
            Target::Pulses(_) | Target::Frequency(_) => return None,
        })
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
