//! `rungc why`.

use super::line;
use super::read::compare;
use super::run::{check_machine, check_scan, look_for_all, machine};
use super::setting::{self, Setting};
use super::subject::{self, Subject};
use super::{
    Context, Failure, Outcome, Result, conclude, findings, interruption, print_text, read,
};
use crate::args::{Format, WhyArgs};
use crate::report::{Reporter, to_json};
use rungc::monitor::{device_of, items_of};
use rungc::settings::is_written_outside;
use rungc::trace::Trace;
use rungc::{Names, Why};
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_monitor::{Item, Sample};
use rungc_sim::Session;
use rungc_sim::plant::Description;
use rungc_sim::session::hardware;
use rungc_syntax::{Device, phrase};
use rungc_why::{Explainer, History, HowOptions};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Explains why a device is on or off.
pub fn run(args: &WhyArgs, cx: Context) -> Result {
    let Some((input, name)) = args.subject() else {
        let message = "name the device: `rungc why PROGRAM DEVICE`";
        return Err(Failure::Because(message.to_string()));
    };
    check_scan(args.scan)?;
    let subject = subject::one(&input, cx)?;
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let outcome = explain(args, name, &subject, (&mut reporter, cx));
    reporter.finish()?;
    outcome
}

fn explain(
    args: &WhyArgs,
    name: &str,
    subject: &Subject,
    (reporter, cx): (&mut Reporter, Context),
) -> Result {
    let read = read(subject, reporter)?;
    let names = Names::of(&read.program);
    let settings = setting::settings(&args.set, &names)?;
    let machine = machine(args.machine.as_deref(), (subject, cx), &settings)?;
    let options = CompileOptions {
        observe_all: true,
        marks: true,
        ..subject.options()
    };
    let mut compiled = compile(&read.program, &options);
    let found = findings(subject, &read, &compiled);
    let parts = compiled.module.take().zip(compiled.marks.take());
    let (module, marks) = match parts {
        Some(parts) if !found.failed() => parts,
        _ => return conclude(&found, reporter, cx, String::new),
    };
    setting::check(&settings, module.model)?;
    setting::report_unused(&settings, &read.program, subject.options());
    check_machine(machine.as_ref(), &module, (subject, cx))?;
    let explainer = Explainer::new(&read.program, &module, &marks);
    let device = rungc::why::device(name, &names, &module, &explainer);
    let device = device.map_err(Failure::Because)?;
    let run = Run {
        args,
        subject,
        read: &read,
        module: &module,
        settings: &settings,
        machine: machine.as_ref(),
    };
    let why = match (&args.trace, args.end_ms()) {
        _ if args.plc.names_plc() => run.explain_plc(&explainer, device)?,
        (Some(trace), _) => run.explain_trace(&explainer, device, trace)?,
        (None, Some(end_ms)) => run.explain(&explainer, device, end_ms)?,
        (None, None) => explainer.of_program(device),
    };
    let text = match subject.reporting.format {
        Format::Json => to_json(&why)?,
        _ => rungc::why::text(&why, cx.language.or(subject.reporting.lang)),
    };
    print_text(&text)?;
    Ok(Outcome::Success)
}

/// The run that leads to the moment.
struct Run<'a> {
    args: &'a WhyArgs,
    subject: &'a Subject,
    read: &'a Read,
    module: &'a Module,
    settings: &'a [Setting],
    machine: Option<&'a Description>,
}

impl Run<'_> {
    fn session(&self) -> Session<'_> {
        let parameters = self.read.program.parameters.as_ref();
        let modules = parameters.map_or(&[][..], |parameters| &parameters.modules);
        Session::new(self.module, hardware(modules))
    }

    /// Explains the present moment of a PLC.
    fn explain_plc(
        &self,
        explainer: &Explainer,
        device: Device,
    ) -> std::result::Result<Why, Failure> {
        interruption::note();
        let mut plc = line::plc(&self.args.plc, self.module.model)?;
        let compared = match self.args.compare {
            true => Some(compare(&mut plc, &self.read.program)?),
            false => None,
        };
        let items = rungc::monitor::items(&self.read.program, self.module.model);
        let mut sample = plc.read(items)?;
        let (program, model) = (&self.read.program, self.module.model);
        let indexed = rungc::monitor::indexed_items(program, model, &sample);
        sample.extend(plc.read(indexed)?);
        let mut why = self.explain_sample(explainer, device, &sample, "the PLC does not show")?;
        why.notes.extend(compared);
        why.notes.extend(hidden(&sample).map(|devices| {
            phrase!(
                "not shown by the port of the PLC, and taken for off or 0: {devices}",
                devices
            )
        }));
        Ok(why)
    }

    /// Explains a moment of a recording.
    fn explain_trace(
        &self,
        explainer: &Explainer,
        device: Device,
        path: &Path,
    ) -> std::result::Result<Why, Failure> {
        let model = self.module.model;
        let refuse = |why: &str| Failure::Because(format!("{}: {why}", path.display()));
        let bytes = fs::read(path).map_err(|error| refuse(&error.to_string()))?;
        let trace = Trace::read(&bytes, model).map_err(|why| refuse(&why))?;
        let (first_ms, last_ms) = trace.times();
        let ms = self.args.moment.unwrap_or(last_ms);
        if !(first_ms..=last_ms).contains(&ms) {
            let why = format!("the recording is from {first_ms} to {last_ms} ms");
            return Err(refuse(&why));
        }
        let mut sample = trace.at(ms);
        let named = rungc::monitor::items(&self.read.program, model);
        let missing = named
            .into_iter()
            .filter(|item| !sample.values.contains_key(item));
        let missing: Vec<Item> = missing.collect();
        sample.hidden.extend(missing);
        let mut why = self.explain_sample(explainer, device, &sample, "the recording has no")?;
        if let Some(moment) = &mut why.moment {
            moment.ms = Some(ms);
        }
        why.notes.extend(hidden(&sample).map(|devices| {
            phrase!(
                "not in the recording, and taken for off or 0: {devices}",
                devices
            )
        }));
        Ok(why)
    }

    /// Explains the moment at which devices have these values. `lacks` begins the message for a device without one.
    fn explain_sample(
        &self,
        explainer: &Explainer,
        device: Device,
        sample: &Sample,
        lacks: &str,
    ) -> std::result::Result<Why, Failure> {
        let own = items_of(device, self.module.model);
        if !own.iter().all(|item| sample.values.contains_key(item)) {
            return Err(Failure::Because(format!("{lacks} `{device}`")));
        }
        let mut session = self.session();
        rungc::monitor::take_over(&mut session, sample);
        let mut why = explainer.at_moment(&mut session, self.args.scan, device, None);
        if let Some(moment) = &mut why.moment {
            moment.ms = None;
        }
        self.add_how(&mut why, explainer, &mut session, device);
        Ok(why)
    }

    fn explain(
        &self,
        explainer: &Explainer,
        device: Device,
        end_ms: u64,
    ) -> std::result::Result<Why, Failure> {
        let mut session = self.session();
        let named = self.settings.iter().map(|setting| setting.target);
        look_for_all(named, session.seen(), self.module)?;
        let mut pending = self.settings;
        set(&mut session, &mut pending);
        if let Some(machine) = self.machine {
            session.connect(machine.plant())?;
        }
        let mut history = History::new(session.machine(), device);
        while session.now_ms() < end_ms && !session.machine().watchdog_tripped() {
            let began_ms = session.now_ms();
            let scan_ms = session.scan_ms(self.args.scan);
            session.scan(scan_ms);
            history.scanned(session.machine(), began_ms);
            let scan_ms = session.scan_ms(self.args.scan);
            for _ in began_ms..(began_ms + scan_ms).min(end_ms) {
                // As in `rungc run`, interrupts are taken after what is set.
                session.advance(&[], &mut |_| Ok::<_, String>(()))?;
                session.tick();
                set(&mut session, &mut pending);
                session.take_interrupts();
            }
        }
        setting::report_late(pending.iter());
        let mut why = explainer.at_moment(&mut session, self.args.scan, device, Some(&history));
        self.add_how(&mut why, explainer, &mut session, device);
        Ok(why)
    }

    /// Adds what a person can do, if that is asked for.
    fn add_how(&self, why: &mut Why, explainer: &Explainer, session: &mut Session, device: Device) {
        if self.args.how {
            let settings = self.subject.own_project();
            let is_outside = |device| is_written_outside(settings, device);
            let options = HowOptions {
                scan_ms: self.args.scan,
                is_outside: &is_outside,
                ..HowOptions::default()
            };
            why.how = Some(explainer.how(session, device, &options));
        }
    }
}

/// Devices that a sample lacks, of all that the program names.
fn hidden(sample: &Sample) -> Option<String> {
    let devices: BTreeSet<Device> = sample.hidden.iter().map(|&item| device_of(item)).collect();
    let named: Vec<String> = devices.iter().take(8).map(Device::to_string).collect();
    let more = if devices.len() > named.len() {
        ", …"
    } else {
        ""
    };
    let named = named.join(", ");
    (!devices.is_empty()).then(|| format!("{named}{more}"))
}

/// Makes the settings whose time has come.
fn set(session: &mut Session, pending: &mut &[Setting]) {
    while let Some((setting, rest)) = pending.split_first()
        && setting.at_ms <= session.now_ms()
    {
        // It exists: that was checked before the run.
        let _ = session.set(setting.target, setting.value);
        *pending = rest;
    }
}
