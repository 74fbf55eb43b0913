//! `rungc explore`.

mod expected;
mod lanes;
mod replayed;
mod report;
mod test_file;

use super::check::draw;
use super::properties::{Reader, RequestedProperty, at_writes, module, report_undriven};
use super::run::recording::Recording;
use super::subject::{self, Subject};
use super::{Context, Failure, Outcome, Result, check_name, interruption, print_text, read};
use crate::args::{ExploreArgs, Latched};
use crate::output::{spare, write_file};
use crate::progress;
use crate::report::{Findings, Reporter};
use rungc_explore::run::{POWER, Runner};
use rungc_explore::trains::At;
use rungc_explore::unvaried::unvaried;
use rungc_explore::{Found, Limits, Task, What, search, shrink};
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_sim::LoadError;
use rungc_sim::plant;
use rungc_sim::property::{Condition, Property};
use rungc_sim::record::Seen;
use rungc_sim::session;
use rungc_sim::threads::Threads;
use rungc_syntax::{DeviceClass, Diagnostic, Diagnostics, Span, codes};
use rungc_verify::replay::Change;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A program that was searched, and for what.
struct Searched<'a> {
    args: &'a ExploreArgs,
    subject: &'a Subject,
    read: &'a Read,
    module: &'a Module,
    task: &'a Task<'a>,
    /// The properties as requested.
    requested: &'a [RequestedProperty],
}

/// Something found, with its run as tests and reports have it.
struct Shown {
    found: Found,
    story: Vec<Change>,
    /// For each change of the story, whether power goes off and on before it.
    power: Vec<bool>,
    /// For each change of the story, the pulses that come in the time of its first scan.
    pulses: Vec<Vec<(At, i32)>>,
}

/// Searches runs of a program.
pub fn run(args: &ExploreArgs, cx: Context) -> Result {
    if let Some(path) = &args.write_test {
        spare(path, args.force)?;
    }
    let subject = subject::one(&args.input, cx)?;
    // What was found is replayed as tests.
    check_name(&subject.file, "a test file")?;
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let read = match read(&subject, &mut reporter) {
        Ok(read) => read,
        Err(failure) => {
            reporter.finish()?;
            return Err(failure);
        }
    };
    let reader = Reader {
        args: &args.properties,
        subject: &subject,
        program: &read.program,
        cx,
    };
    let (requested, assumed) = (reader.properties()?, reader.assumed()?);
    let assumed: Vec<Condition> = assumed.into_iter().map(|(_, a)| a).collect();
    let conditions = requested
        .iter()
        .flat_map(|requested| requested.property.conditions());
    let conditions = conditions.chain(&assumed);
    let external = reader.external()?;
    let Some(module) = module(&subject, &read, conditions, &external, &mut reporter)? else {
        reporter.finish()?;
        return Ok(Outcome::Unusable);
    };
    report_undriven(&requested, &read, &subject, &external, &mut reporter)?;
    let machine = args.machine.as_deref().map(plant::load).transpose();
    let refuse = |error: LoadError| subject::refuse(error.into(), &subject.reporting, cx);
    let machine = machine.map_err(refuse)?;
    if let Some(machine) = &machine {
        machine.check(module.model).map_err(refuse)?;
    }
    let properties: Vec<Property> = requested
        .iter()
        .map(|requested| requested.property.clone())
        .collect();
    let fitted = read.program.parameters.as_ref();
    let fitted = fitted.map_or(&[][..], |parameters| &parameters.modules);
    let hal = Box::new(session::hardware(fitted));
    let external: Vec<_> = external.devices.into_keys().collect();
    let mut task = Task::new(
        &module,
        (&properties, &assumed),
        &external,
        reader.scan_ms()?,
        (machine.as_ref(), hal),
    );
    task.power_cycles = args.latched == Latched::Saved;
    for ignored in &args.ignore {
        task.kinds.remove(&ignored.kind());
    }
    let searched = Searched {
        args,
        subject: &subject,
        read: &read,
        module: &module,
        task: &task,
        requested: &requested,
    };
    searched.run(reporter, cx)
}

impl Searched<'_> {
    fn run(&self, reporter: Reporter, cx: Context) -> Result {
        let args = self.args;
        let lanes = self.lanes(cx)?;
        let limits = Limits {
            lanes: lanes.as_ref().map(|lanes| lanes.executable.clone()),
            scans: args.scans,
            time: args.timeout.map(Duration::from_millis),
            seed: args.seed,
            threads: self.threads().count(),
        };
        interruption::note();
        let report = progress::spin("searching", || {
            search(self.task, &limits, &mut |report| {
                interruption::is_requested() || args.first && !report.found.is_empty()
            })
        });
        let report = report.map_err(Failure::Because)?;
        let shown: Vec<Shown> = progress::spin("shortening", || {
            let short = |found: &Found| shrink(self.task, found.clone());
            let short = self.threads().map(&report.found, short).into_iter();
            short.map(|found| self.shown(found)).collect()
        });
        let differing = self.replay(&shown)?;
        let for_people = reporter.is_for_people();
        self.publish(&shown, &differing, reporter)?;
        if for_people {
            print_text(&self.human(&shown, &report))?;
        }
        for what in unvaried(self.task) {
            cx.note(&format!("   Not tried: {what}"));
        }
        self.write(&shown, cx)?;
        Ok(
            match shown.iter().any(|shown| self.is_fault(&shown.found)) {
                _ if interruption::is_requested() => Outcome::Interrupted,
                true => Outcome::Failed,
                false => Outcome::Success,
            },
        )
    }

    fn threads(&self) -> Threads {
        let given = self.args.threads.map(usize::from);
        given.map_or_else(Threads::usual, Threads::new)
    }

    /// Writes the requested files.
    fn write(&self, shown: &[Shown], cx: Context) -> std::result::Result<(), Failure> {
        if let Some(path) = &self.args.write_test {
            match shown.is_empty() {
                true => cx.note("     Nothing was found, so no test is written"),
                false => {
                    let text = self.test_file(path, shown);
                    write_file(path, text.as_bytes(), self.args.force)?;
                    cx.note(&format!("       Wrote {}", path.display()));
                }
            }
        }
        if let Some(path) = &self.args.vcd {
            match shown.first() {
                None => cx.note("     Nothing was found, so no run is recorded"),
                Some(first) => {
                    self.record(path, &first.found)?;
                    cx.note(&format!("       Wrote {}", path.display()));
                }
            }
        }
        Ok(())
    }

    /// Returns true if this is a fault of the program: all but the goals of `--reachable`.
    fn is_fault(&self, found: &Found) -> bool {
        match found.what {
            What::Property(number) => !self.requested[number].property.is_wanted(),
            _ => true,
        }
    }

    /// A run as tests and reports have it.
    fn shown(&self, found: Found) -> Shown {
        let (mut first, mut at_ms) = (0, 0);
        let (mut story, mut power) = (Vec::new(), Vec::new());
        let mut pulses = Vec::new();
        for step in &found.run {
            let cycles = step.set.iter().any(|(input, _)| *input == POWER);
            power.push(cycles);
            let trains = step.pulses.iter();
            let trains = trains.map(|&(source, count)| (self.task.sources[source].at, count));
            pulses.push(trains.collect());
            let set = step.set.iter().filter(|(input, _)| *input != POWER);
            let set = set.map(|&(input, value)| {
                let target = self.task.inputs[input].target;
                let (class, number, _) = target.devices(0);
                (target.to_string(), (class, number), i64::from(value).into())
            });
            story.push(Change {
                start: Vec::new(),
                first,
                scans: step.scans as usize,
                at_ms,
                restart: false,
                scan_ms: step.scan_ms,
                set: set.collect(),
                buffers: Vec::new(),
                after: Vec::new(),
            });
            first += step.scans as usize;
            at_ms += u64::from(step.scans) * u64::from(step.scan_ms);
        }
        if let (Some(last), Some(after)) = (story.last_mut(), self.after(&found)) {
            last.after = after;
        }
        Shown {
            found,
            story,
            power,
            pulses,
        }
    }

    /// The run with the PLC after each scan.
    fn follow(
        &self,
        found: &Found,
        f: &mut dyn FnMut(u64, &Runner) -> std::result::Result<(), Failure>,
    ) -> std::result::Result<(), Failure> {
        let mut runner = Runner::new(self.task)?;
        for step in &found.run {
            runner.begin(step);
            for _ in 0..step.scans {
                let at_ms = runner.now_ms();
                runner.scan(step.scan_ms);
                f(at_ms, &runner)?;
            }
        }
        Ok(())
    }

    fn record(&self, path: &Path, found: &Found) -> std::result::Result<(), Failure> {
        let runner = Runner::new(self.task)?;
        let mut recording = Recording::begin((path, self.args.force), seen(&runner), &[])?;
        let mut end_ms = 0;
        self.follow(found, &mut |at_ms, runner| {
            end_ms = runner.now_ms();
            recording.sample(1000 * at_ms, seen(runner))
        })?;
        recording.keep(1000 * end_ms)
    }

    /// Reports what was found as diagnostics.
    fn publish(
        &self,
        shown: &[Shown],
        differing: &[String],
        mut reporter: Reporter,
    ) -> std::result::Result<(), Failure> {
        let model = self.module.model;
        let mut diagnostics = Diagnostics::new();
        for shown in shown.iter().filter(|shown| self.is_fault(&shown.found)) {
            diagnostics.push(self.diagnostic(&shown.found));
        }
        for why in differing {
            diagnostics.push(codes::RUNS_DIFFER.at(Span::default(), why.clone()));
        }
        let (file, program) = (&self.subject.file, &self.read.program);
        let mut findings = Findings::new(file, program, diagnostics, &self.subject.reporting);
        if reporter.is_for_people() {
            findings.drawn = draw::networks(program, model, &findings.diagnostics);
        }
        reporter.add(&findings)?;
        Ok(reporter.finish()?)
    }

    fn diagnostic(&self, found: &Found) -> Diagnostic {
        let message = self.sentence(&found.what);
        let (code, devices, step) = match &found.what {
            What::Property(number) => {
                let conditions = self.requested[*number].property.conditions();
                let devices = conditions.into_iter().flat_map(Condition::devices);
                (&codes::PROPERTY_VIOLATED, devices.collect(), None)
            }
            What::Error { step, .. } => (&codes::REACHES_ERROR, Vec::new(), Some(*step)),
            What::Watchdog { step } => (&codes::REACHES_WATCHDOG, Vec::new(), Some(*step)),
            What::Doubled(n) => (&codes::DRIVEN_DIFFERENTLY, vec![(DeviceClass::Y, *n)], None),
            What::Oscillation(n) => (&codes::NEVER_RESTS, vec![(DeviceClass::Y, *n)], None),
            What::Collision(_) => (&codes::BREAKS_MACHINE, Vec::new(), None),
        };
        let mut diagnostic = code.at(Span::default(), message);
        let networks = step.map(|step| self.module.networks.iter().rfind(|n| n.step <= step));
        if let Some(network) = networks.flatten() {
            diagnostic.span = network.span;
            diagnostic.label = "in the network that begins here".into();
        }
        diagnostic = at_writes(diagnostic, &devices, self.read, self.module.model);
        diagnostic.help = Some("`--write-test FILE` writes the run that shows it as a test".into());
        diagnostic
    }
}

fn seen<'a>(runner: &'a Runner<'_>) -> Seen<'a> {
    Seen {
        machine: runner.machine(),
        hal: runner.hal(),
        plant: runner.plant(),
    }
}

/// A path in a test file's folder, for what the file names.
fn relative_to(test: &Path, path: &Path) -> PathBuf {
    super::verify::test_file::relative(path, test).into()
}
