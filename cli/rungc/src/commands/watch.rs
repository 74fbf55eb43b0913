//! `rungc watch`: the devices of a PLC as they change.

use super::line::{self, Line};
use super::read::compare;
use super::subject::{self, Subject};
use super::{
    Context, Failure, Outcome, Result, counted, eprint_line, findings, found_reading, interruption,
    read_with_names, stream_text,
};
use crate::args::{WatchArgs, WatchTo};
use crate::report::Reporter;
use rungc::Names;
use rungc::monitor::{device_of, items, items_of_target, reading};
use rungc::trace::CONTACT;
use rungc_frontend::Read;
use rungc_lower::compile;
use rungc_models::Model;
use rungc_monitor::{Item, Plc};
use rungc_sim::Target;
use rungc_sim::record::Reading;
use rungc_syntax::{Device, DeviceClass, Program};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::ErrorKind;
use std::thread;
use std::time::{Duration, Instant};

/// Pause between two looks for an interruption.
const NAP: Duration = Duration::from_millis(50);

/// Shows the devices of a PLC.
pub fn run(args: &WatchArgs, cx: Context) -> Result {
    let (input, devices) = args.subject();
    let subject = subject::one(&input, cx)?;
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let outcome = watch(args, devices, &subject, (&mut reporter, cx));
    reporter.finish()?;
    outcome
}

fn watch(
    args: &WatchArgs,
    devices: Vec<&str>,
    subject: &Subject,
    (reporter, cx): (&mut Reporter, Context),
) -> Result {
    let read = read_with_names(subject, reporter)?;
    let findings = found_reading(subject, &read);
    if findings.failed() {
        reporter.add(&findings)?;
        return Ok(Outcome::of(&findings));
    }
    let program = &read.program;
    let model = compile::model(program, &subject.options());
    let shown = match args.all {
        true => all(program, model),
        false => shown(&devices, program, model)?,
    };
    report_errors(subject, &read);
    interruption::note();
    let mut plc = line::plc(&args.plc, model)?;
    cx.note(&format!("    Watching {}", plc.title()));
    if args.compare {
        let compared = compare(&mut plc, program)?;
        cx.note(&format!("             {compared}"));
    }
    let watched = Watched {
        args,
        program,
        model,
        shown,
    };
    watched.follow(&mut plc, cx)
}

/// Says that a program has errors, which hide none of its devices.
fn report_errors(subject: &Subject, read: &Read) {
    let compiled = compile::compile(&read.program, &subject.options());
    let errors = findings(subject, read, &compiled).totals().errors;
    if errors > 0 {
        let errors = counted(errors, "error");
        let file = subject.file.display();
        eprint_line(&format!(
            "rungc: {file} has {errors}, which `rungc check` shows; its devices are watched as they are written"
        ));
    }
}

/// All devices that a program names: of timers and counters the contact and the value.
fn all(program: &Program, model: &'static Model) -> Vec<Target> {
    let targets = items(program, model).into_iter().map(|item| {
        let Device { class, number } = device_of(item);
        match item {
            Item::Bit(..) => Target::Bit(class, number),
            Item::Word(..) if matches!(class, DeviceClass::T | DeviceClass::C) => {
                Target::Current(class, number)
            }
            Item::Word(..) => Target::Word(class, number),
        }
    });
    targets.collect()
}

/// The devices that are named, or the inputs and outputs of a program, in their order.
fn shown(
    names: &[&str],
    program: &Program,
    model: &'static Model,
) -> std::result::Result<Vec<Target>, Failure> {
    if names.is_empty() {
        let devices = items(program, model).into_iter().map(device_of);
        let terminals =
            devices.filter(|device| matches!(device.class, DeviceClass::X | DeviceClass::Y));
        let terminals: BTreeSet<Device> = terminals.collect();
        let shown = terminals.iter();
        let shown: Vec<_> = shown
            .map(|device| Target::Bit(device.class, device.number))
            .collect();
        return match shown.is_empty() {
            true => Err(Failure::Because(
                "the program names no input or output: name the devices to show".to_string(),
            )),
            false => Ok(shown),
        };
    }
    let known = Names::of(program);
    let mut shown = Vec::new();
    for name in names {
        for target in known.targets(name).map_err(Failure::Because)? {
            check(target, model)?;
            // The contact beside the value.
            if let Target::Current(class, number) = target
                && !name.ends_with(".value")
            {
                shown.push(Target::Bit(class, number));
            }
            shown.push(target);
        }
    }
    Ok(shown)
}

/// Checks that a PLC can show a target.
fn check(target: Target, model: &Model) -> std::result::Result<(), Failure> {
    let (class, first, count) = target.devices(1);
    let mut numbers = first..first.saturating_add(count);
    if let Some(missing) = numbers.find(|&number| !model.has(class, number)) {
        let (device, title) = (class.number(missing), model.title);
        let why = format!("`{device}` does not exist on {title}");
        return Err(Failure::Because(why));
    }
    match items_of_target(target, model).is_empty() {
        true => Err(Failure::Because(format!(
            "a PLC does not show `{target}` to its clients"
        ))),
        false => Ok(()),
    }
}

/// Values of a PLC.
struct Watched<'a> {
    args: &'a WatchArgs,
    program: &'a Program,
    model: &'static Model,
    shown: Vec<Target>,
}

impl Watched<'_> {
    /// Looks at the values until the time is over, the user ends it, or the reader of the output has gone.
    fn follow(&self, plc: &mut Plc<Line>, cx: Context) -> Result {
        let items = self.shown.iter();
        let items: BTreeSet<Item> = items
            .flat_map(|&target| items_of_target(target, self.model))
            .collect();
        let begin = Instant::now();
        let end = self
            .args
            .duration
            .map(|ms| begin + Duration::from_millis(ms));
        let mut last: Option<Vec<Option<Reading>>> = None;
        loop {
            let look = Instant::now();
            let sample = plc.read(items.iter().copied())?;
            let targets = self.shown.iter();
            let readings: Vec<Option<Reading>> = targets
                .map(|&target| reading(target, &sample, self.model))
                .collect();
            if last.is_none() {
                self.report_hidden(&readings, cx)?;
            }
            let ms = look.duration_since(begin).as_millis();
            let written = self.changes(ms, last.as_deref(), &readings);
            match stream_text(&written) {
                Err(error) if error.kind() == ErrorKind::BrokenPipe => break,
                printed => printed?,
            }
            last = Some(readings);
            if self.args.once {
                break;
            }
            let next = look + Duration::from_millis(self.args.every);
            if !wait(end.map_or(next, |end| next.min(end))) {
                return Ok(Outcome::Interrupted);
            }
            if end.is_some_and(|end| Instant::now() >= end) {
                break;
            }
        }
        Ok(Outcome::Success)
    }

    /// Names what the PLC does not show; an error if that is all.
    fn report_hidden(
        &self,
        readings: &[Option<Reading>],
        cx: Context,
    ) -> std::result::Result<(), Failure> {
        let hidden = self.shown.iter().zip(readings);
        let hidden = hidden.filter(|(_, reading)| reading.is_none());
        let mut hidden: Vec<String> = hidden.map(|(&target, _)| device(target)).collect();
        hidden.dedup();
        if readings.iter().all(Option::is_none) {
            let why = "the PLC shows none of these devices".to_string();
            return Err(Failure::Because(why));
        }
        if !hidden.is_empty() {
            let hidden = hidden.join(", ");
            cx.note(&format!(
                "             not shown by the port of the PLC: {hidden}"
            ));
        }
        Ok(())
    }

    /// The rows of what has changed since the last look; at the first look, of all values.
    fn changes(
        &self,
        ms: u128,
        last: Option<&[Option<Reading>]>,
        readings: &[Option<Reading>],
    ) -> String {
        let mut out = String::new();
        if last.is_none() && self.args.to == WatchTo::Csv {
            out.push_str("ms,device,value\n");
        }
        for (at, (&target, reading)) in self.shown.iter().zip(readings).enumerate() {
            let before = last.and_then(|last| last[at].as_ref());
            if let Some(value) = reading.as_ref().filter(|&value| before != Some(value)) {
                self.row(&mut out, ms, target, value);
            }
        }
        out
    }

    fn row(&self, out: &mut String, ms: u128, target: Target, value: &Reading) {
        // Writing to a String does not fail.
        let _ = match self.args.to {
            WatchTo::Csv => {
                // Characters may be any.
                let value = value.to_string();
                let quoted = value.replace('"', "\"\"");
                match value.contains([',', '"']) {
                    true => writeln!(out, "{ms},{},\"{quoted}\"", name(target)),
                    false => writeln!(out, "{ms},{},{value}", name(target)),
                }
            }
            WatchTo::Text => {
                let (class, number, _) = target.devices(1);
                let comment = self.program.comments.get(&Device { class, number });
                let comment = comment.map_or("", String::as_str);
                let seconds = ms as f64 / 1000.0;
                let (name, value) = (name(target), value.to_string());
                let row = format!("{seconds:>9.1} s  {name:<12} {value:>11}  {comment}");
                writeln!(out, "{}", row.trim_end())
            }
        };
    }
}

/// Name of a target in messages: of a contact and a value their timer or counter.
fn device(target: Target) -> String {
    match target {
        Target::Current(class, number) => class.number(number).to_string(),
        target => target.to_string(),
    }
}

/// Name of a value: of a timer or counter its contact and its value are apart.
fn name(target: Target) -> String {
    match target {
        Target::Bit(DeviceClass::T | DeviceClass::C, _) => format!("{target}{CONTACT}"),
        target => device(target),
    }
}

/// Waits until a moment; false if the user ends it before.
fn wait(until: Instant) -> bool {
    while !interruption::is_requested() {
        let rest = until.saturating_duration_since(Instant::now());
        if rest.is_zero() {
            return true;
        }
        thread::sleep(rest.min(NAP));
    }
    false
}
