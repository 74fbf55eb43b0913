//! `rungc run`.

mod capture;
mod connecting;
mod errors;
mod history;
pub mod lines;
mod live;
mod mode;
pub mod pace;
mod plotting;
mod recorder;
pub(super) mod recording;
mod retaining;
mod scope;
mod serving;
mod simulate;
mod table;
mod view;
mod watch;

use super::setting::{self, Setting, devices as observed};
use super::subject::{self, Subject};
use super::view::title;
use super::{
    Context, Failure, Result, Verbosity, check_name, conclude, eprint_line, findings, parent_dir,
    read, stem,
};
use crate::args::RunArgs;
use crate::output::{make_folder, refuse_outside, spare};
use crate::report::Reporter;
use live::Live;
use recorder::Recorder;
use retaining::RetainStorage;
use rungc::Names;
use rungc_frontend::{Read, image};
use rungc_interp::rt_class;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_sim::Target;
use rungc_sim::plant::{self, Axis, Description, Plant};
use rungc_syntax::{DeviceClass, Program, codes, inputs};
pub(super) use simulate::look_for_all;
use std::fs;
use std::path::Path;
pub use watch::STANDARD_ERROR;

/// Number of devices shown by default.
const DEFAULT_COLUMNS: usize = 12;

/// Devices shown in a run by default.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Table {
    /// Devices that the program writes.
    Usual,
    /// None.
    Empty,
}

/// Runs a program in the interpreter, showing the watched devices.
pub fn run(args: &RunArgs, cx: Context) -> Result {
    let mut subject = subject::one(&args.input, cx)?;
    if !args.serve.modbus_tcp.is_empty() {
        let rules = &mut subject.reporting.rules;
        rules.allow.push(codes::ETHERNET_CARD.id);
    }
    let has_requests = subject
        .project
        .as_ref()
        .is_some_and(|project| project.has_server_requests());
    if has_requests && !args.in_real_time() {
        eprint_line("rungc: servers of `[[modbus]]` are asked in real time only: add --real-time");
    }
    let mut args = args.clone();
    args.serve.sends_requests = has_requests && args.in_real_time();
    program(&args, &subject, Table::Usual, cx)
}

/// Runs a program.
pub fn program(args: &RunArgs, subject: &Subject, table: Table, cx: Context) -> Result {
    check_scan(args.scan)?;
    let wired_up = connecting::settings(&args.serve, subject, cx)?;
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let read = match read(subject, &mut reporter) {
        Ok(read) => read,
        Err(failure) => {
            reporter.finish()?;
            return Err(failure);
        }
    };
    let requested = Requested::of(args, (subject, cx), &read.program)?;
    let described = requested.machine.as_ref();
    let options = CompileOptions {
        name: Some(stem(subject, &read)),
        observe: requested.devices(args),
        ..args.serve.opened(subject.options())
    };
    let compiled = compile(&read.program, &options);
    let findings = findings(subject, &read, &compiled);
    let module = match compiled.module {
        Some(module) if !findings.failed() => module,
        _ => {
            let outcome = conclude(&findings, &mut reporter, cx, String::new);
            reporter.finish()?;
            return outcome;
        }
    };
    reporter.add_count(&findings, subject.check_command().as_deref(), cx)?;
    reporter.finish()?;
    setting::check(&requested.settings, module.model)?;
    requested.report_unused(args, subject, &read.program);
    let listed = requested.shown(&read.program, &module);
    let has_table = table == Table::Usual || !requested.watched.is_empty();
    check_machine(described, &module, (subject, cx))?;
    let connections =
        connecting::connections(wired_up, subject, (&module, described), &args.serve, cx)?;
    let plant = described.map(Description::plant);
    report_still_axes(plant.as_ref(), &module);
    let served = args.serve.any().then_some(&read.program);
    let program_memory = served.and_then(|program| image::write(program).ok());
    let live = page(args, subject, &read, &module, &listed)?;
    let retain = retained(args, subject)?;
    let connected = retain.is_some() || !connections.is_empty();
    let recorder = recorder(args, subject, connected, (&module, &requested.watched))?;
    let parameters = read.program.parameters.as_ref();
    let run = simulate::Run {
        args,
        retain,
        module: &module,
        errors_at_once: cx.verbosity == Verbosity::Verbose,
        settings: &requested.settings,
        shown: if has_table { &listed } else { &[] },
        watched: &requested.watched,
        over: requested.over,
        table: has_table,
        modules: parameters.map_or(&[], |parameters| &parameters.modules),
        program_memory: program_memory.as_deref(),
        connections,
    };
    run.simulate(plant, live, recorder)
}

/// The recorder of a run that becomes a test.
fn recorder(
    args: &RunArgs,
    subject: &Subject,
    connected: bool,
    watched: (&Module, &[Target]),
) -> std::result::Result<Option<Recorder>, Failure> {
    let Some(path) = &args.record else {
        return Ok(None);
    };
    repeatable(args, subject, connected)?;
    spare(path, args.force)?;
    let files = (subject.file.as_path(), args.machine.as_deref());
    for file in [Some(files.0), files.1].into_iter().flatten() {
        check_name(file, "a test file")?;
    }
    Ok(Some(Recorder::begin(path, files, watched)))
}

/// Checks that a test can repeat the run: nothing but its settings and its machine acts on it.
fn repeatable(
    args: &RunArgs,
    subject: &Subject,
    connected: bool,
) -> std::result::Result<(), Failure> {
    let why = match () {
        () if args.serve.any() => "no servers, serial lines or pages take part in it",
        () if connected => "it begins with no kept devices, and has no connections",
        () if subject.is_stdin() => "its program is a file",
        () => return Ok(()),
    };
    let message = format!("--write-test: a test can repeat a run only if {why}");
    Err(Failure::Because(message))
}

/// Devices and the machine that the arguments name.
struct Requested {
    /// Settings in the order of their times.
    settings: Vec<Setting>,
    watched: Vec<Target>,
    /// Target on the horizontal axis of a plot.
    over: Option<Target>,
    machine: Option<Description>,
}

impl Requested {
    fn of(
        args: &RunArgs,
        about: (&Subject, Context),
        program: &Program,
    ) -> std::result::Result<Self, Failure> {
        let names = Names::of(program);
        let target = |option: &str, name: &str| {
            let target = names.target(name);
            target.map_err(|why| Failure::Because(format!("{option}: {why}")))
        };
        let settings = setting::settings(&args.set, &names)?;
        let mut watched = Vec::new();
        for name in setting::items("--watch", &args.watch, &names)? {
            let targets = names.targets(name);
            watched.extend(targets.map_err(|why| Failure::Because(format!("--watch: {why}")))?);
        }
        Ok(Requested {
            watched,
            over: args
                .over
                .as_deref()
                .map(|name| target("--over", name))
                .transpose()?,
            machine: machine(args.machine.as_deref(), about, &settings)?,
            settings,
        })
    }

    /// The devices that are kept though the program may not use them: those that are set, watched or drawn, the
    /// terminals of the simulated machine, and what `--scope` samples.
    fn devices(&self, args: &RunArgs) -> Vec<(DeviceClass, u32)> {
        let used = self.settings.iter().map(|s| s.target);
        let used = used.chain(self.watched.iter().copied()).chain(self.over);
        let wired = self.machine.iter().flat_map(Description::terminals);
        let registers = args.scope.iter().flat_map(|_| scope::REGISTERS);
        let sampled = registers.map(|register| (DeviceClass::D, register.number()));
        used.flat_map(observed)
            .chain(wired)
            .chain(sampled)
            .collect()
    }

    /// The devices that the run shows.
    fn shown(&self, program: &Program, module: &Module) -> Vec<Target> {
        match self.watched.is_empty() {
            true => {
                let settings = || self.settings.iter();
                let moves = |number| {
                    let input = (DeviceClass::X, number);
                    let is_set = settings().any(|s| observed(s.target).any(|d| d == input));
                    let machine = self.machine.as_ref();
                    is_set || machine.is_some_and(|m| m.drives(DeviceClass::X, number))
                };
                rungc::watch::usual(program, module, DEFAULT_COLUMNS, &moves)
            }
            false => self.watched.clone(),
        }
    }

    /// Reports settings of devices that neither the program nor a client can use.
    fn report_unused(&self, args: &RunArgs, subject: &Subject, program: &Program) {
        if !args.serve.any() {
            setting::report_unused(&self.settings, program, subject.options());
        }
    }
}

/// The page that the arguments ask for, whose watch list holds these at first.
fn page(
    args: &RunArgs,
    subject: &Subject,
    read: &Read,
    module: &Module,
    watched: &[Target],
) -> std::result::Result<Option<Live>, Failure> {
    let Some(address) = args.serve.page.page else {
        if args.serve.page.read_only {
            return Err(Failure::Because(
                "--read-only: there is no page; add --page".to_string(),
            ));
        }
        return Ok(None);
    };
    let page = live::Page {
        title: &title(subject, read),
        address,
        place: &args.serve.settings.place("--page"),
        read_only: args.serve.page.read_only,
        watched: watched.to_vec(),
    };
    Live::open(page, &read.program, module.model).map(Some)
}

/// Rejects scans that take no time.
pub(super) fn check_scan(scan_ms: Option<u64>) -> std::result::Result<(), Failure> {
    match scan_ms {
        Some(0) => Err(Failure::Because(
            "--scan: a scan takes at least 1 ms".to_string(),
        )),
        _ => Ok(()),
    }
}

/// Rejects a machine with terminals that the model does not have.
pub(super) fn check_machine(
    described: Option<&Description>,
    module: &Module,
    (subject, cx): (&Subject, Context),
) -> std::result::Result<(), Failure> {
    let checked = described.map_or(Ok(()), |machine| machine.check(module.model));
    checked.map_err(|error| subject::refuse(error.into(), &subject.reporting, cx))
}

/// The simulated machine, which drives none of the inputs that are set.
pub(super) fn machine(
    path: Option<&Path>,
    (subject, cx): (&Subject, Context),
    settings: &[Setting],
) -> std::result::Result<Option<Description>, Failure> {
    let described = path.map(plant::load);
    let described = described
        .transpose()
        .map_err(|error| subject::refuse(error.into(), &subject.reporting, cx))?;
    if let Some(machine) = &described {
        free_inputs(machine, settings)?;
    }
    Ok(described)
}

/// File for the latched devices of a run: that of the command line, or that of the project.
fn retained(
    args: &RunArgs,
    subject: &Subject,
) -> std::result::Result<Option<RetainStorage>, Failure> {
    let project = subject.project.as_deref();
    let usual = project.and_then(|project| Some((project, project.at(project.retain.as_deref()?))));
    let path = match (&args.retain, usual) {
        (Some(path), _) => path.clone(),
        (None, Some((project, path))) => {
            refuse_outside(project, "[retain] file", &path, &args.serve.allow_folder)?;
            inputs::note(&path);
            path
        }
        (None, None) => return Ok(None),
    };
    if fs::metadata(&path).is_ok_and(|found| !found.is_file()) {
        let why = format!("--retain: {} is not a regular file", path.display());
        return Err(Failure::Because(why));
    }
    // What cannot be saved at the end is not begun.
    make_folder(parent_dir(&path))?;
    let fault = subject.unsaved();
    let fault = fault.and_then(|(class, number)| Some((rt_class(class)?, number)));
    Ok(Some(RetainStorage { path, fault }))
}

/// Names the axes of a machine that the program cannot move.
fn report_still_axes(plant: Option<&Plant>, module: &Module) {
    let axes = plant.map_or(&[][..], Plant::axes);
    for axis in axes.iter().filter(|axis| stands_still(axis, module)) {
        let name = axis.name();
        eprint_line(&format!(
            "rungc: the axis {name} never moves: the program sends no pulses to its output"
        ));
    }
}

/// Name of a watched device: T0 rather than T0.value, since the display shows that it is a number.
fn name(target: Target) -> String {
    match target {
        Target::Current(class, n) => class.number(n).to_string(),
        other => other.to_string(),
    }
}

/// Returns true if an axis follows an output at which the program never sends pulses.
fn stands_still(axis: &Axis, module: &Module) -> bool {
    let output = axis.pulse_output();
    output.is_some_and(|output| !module.pulse_outputs.contains(&output))
}

/// Checks that inputs driven by the machine are not set by hand.
fn free_inputs(machine: &Description, settings: &[Setting]) -> std::result::Result<(), Failure> {
    let driven = settings.iter().find_map(|setting| {
        let mut devices = observed(setting.target);
        devices.find(|&(class, n)| machine.drives(class, n))
    });
    match driven {
        Some((class, n)) => Err(Failure::Because(format!(
            "--set: `{}` is driven by {}",
            class.number(n),
            machine.name()
        ))),
        None => Ok(()),
    }
}
