//! `rungc watch`: the devices of a PLC as they change.

use super::line::{self, Line};
use super::read::compare;
use super::subject::{self, Subject};
use super::{
    Context, Failure, Outcome, Result, found_reading, interruption, read_as_written, stream_text,
};
use crate::args::{WatchArgs, WatchTo};
use crate::report::Reporter;
use rungc::Names;
use rungc::monitor::{device_of, items, items_of};
use rungc_lower::compile;
use rungc_monitor::{Item, Plc, Sample};
use rungc_syntax::{Device, DeviceClass, Program};
use std::collections::BTreeMap;
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
    let read = read_as_written(subject, reporter)?;
    let findings = found_reading(subject, &read);
    if findings.failed() {
        reporter.add(&findings)?;
        return Ok(Outcome::of(&findings));
    }
    let program = &read.program;
    let items = wanted(&devices, subject, program)?;
    interruption::note();
    let mut plc = line::plc(&args.plc)?;
    cx.note(&format!("    Watching {}", plc.title()));
    if args.compare {
        let compared = compare(&mut plc, program)?;
        cx.note(&format!("             {compared}"));
    }
    let watched = Watched {
        args,
        program,
        items,
    };
    watched.follow(&mut plc, cx)
}

/// The values of the devices that are named, or of the inputs and outputs of a program, each with its device.
fn wanted(
    devices: &[&str],
    subject: &Subject,
    program: &Program,
) -> std::result::Result<BTreeMap<Item, Device>, Failure> {
    let model = compile::model(program, &subject.options());
    if devices.is_empty() {
        let named = items(program, model).into_iter();
        let devices = named.map(|item| (item, device_of(item)));
        let terminals =
            devices.filter(|(_, device)| matches!(device.class, DeviceClass::X | DeviceClass::Y));
        let terminals: BTreeMap<_, _> = terminals.collect();
        return match terminals.is_empty() {
            true => Err(Failure::Because(
                "the program names no input or output: name the devices to show".to_string(),
            )),
            false => Ok(terminals),
        };
    }
    let names = Names::of(program);
    let mut wanted = BTreeMap::new();
    for name in devices {
        let device = names.device(name).map_err(Failure::Because)?;
        if !model.has(device.class, device.number) {
            let title = model.title;
            let why = format!("`{device}` does not exist on {title}");
            return Err(Failure::Because(why));
        }
        let own = items_of(device, model).into_iter();
        if own.len() == 0 {
            return Err(Failure::Because(format!("`{device}` has no value")));
        }
        wanted.extend(own.map(|item| (item, device)));
    }
    Ok(wanted)
}

/// Values of a PLC.
struct Watched<'a> {
    args: &'a WatchArgs,
    program: &'a Program,
    items: BTreeMap<Item, Device>,
}

impl Watched<'_> {
    /// Looks at the values until the time is over, the user ends it, or the reader of the output has gone.
    fn follow(&self, plc: &mut Plc<Line>, cx: Context) -> Result {
        let begin = Instant::now();
        let end = self
            .args
            .duration
            .map(|ms| begin + Duration::from_millis(ms));
        let mut last: Option<Sample> = None;
        loop {
            let look = Instant::now();
            let sample = plc.read(self.items.keys().copied())?;
            let ms = look.duration_since(begin).as_millis();
            let written = match &last {
                None => {
                    self.report_hidden(&sample, cx);
                    if sample.values.is_empty() {
                        let why = "the PLC shows none of these devices".to_string();
                        return Err(Failure::Because(why));
                    }
                    self.whole(ms, &sample)
                }
                Some(last) => self.changes(ms, last, &sample),
            };
            match stream_text(&written) {
                Err(error) if error.kind() == ErrorKind::BrokenPipe => break,
                printed => printed?,
            }
            last = Some(sample);
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

    fn report_hidden(&self, sample: &Sample, cx: Context) {
        let hidden = sample.hidden.iter().filter_map(|item| self.items.get(item));
        let mut hidden: Vec<String> = hidden.map(Device::to_string).collect();
        hidden.dedup();
        if !hidden.is_empty() {
            let hidden = hidden.join(", ");
            cx.note(&format!(
                "             not shown by the port of the PLC: {hidden}"
            ));
        }
    }

    /// All values at first.
    fn whole(&self, ms: u128, sample: &Sample) -> String {
        let mut out = String::new();
        if self.args.to == WatchTo::Csv {
            out.push_str("ms,device,value\n");
        }
        for (&item, &value) in &sample.values {
            self.row(&mut out, ms, item, value);
        }
        out
    }

    /// What has changed since the last look.
    fn changes(&self, ms: u128, last: &Sample, sample: &Sample) -> String {
        let mut out = String::new();
        for (item, &value) in &sample.values {
            if last.values.get(item) != Some(&value) {
                self.row(&mut out, ms, *item, value);
            }
        }
        out
    }

    fn row(&self, out: &mut String, ms: u128, item: Item, value: i32) {
        let Some(&device) = self.items.get(&item) else {
            return;
        };
        let _ = match self.args.to {
            WatchTo::Csv => writeln!(out, "{ms},{},{value}", name(item, device)),
            WatchTo::Text => {
                let comment = self.program.comments.get(&device);
                let comment = comment.map_or("", String::as_str);
                let seconds = ms as f64 / 1000.0;
                let name = name(item, device);
                let row = format!("{seconds:>9.1} s  {name:<12} {value:>11}  {comment}");
                writeln!(out, "{}", row.trim_end())
            }
        };
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

/// Name of a value: of a timer or counter its contact and its value are apart.
fn name(item: Item, device: Device) -> String {
    match (item, device.class) {
        (Item::Bit(..), DeviceClass::T | DeviceClass::C) => format!("{device} contact"),
        _ => device.to_string(),
    }
}
