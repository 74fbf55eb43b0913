//! `rungc fleet`: many PLCs in lock step.

mod engine;
mod failures;
mod memory;
mod running;

use super::setting;
use super::subject::{self, Subject};
use super::{Context, Failure, Result, conclude, eprint_line, findings, read, stem};
use crate::args::{FleetArgs, Input};
use crate::report::Reporter;
use engine::Chosen;
use failures::About;
use rungc::Names;
use rungc_fleet::{At, Choice, Engine, Fleet, Group, Machines, Plcs, Schedule, Setting, Written};
use rungc_host::servers::cannot_serve;
use rungc_host::wall::WallClock;
use rungc_ir::Module;
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::Model;
use rungc_rt::comm::service::{ServerProtocol, Service};
use rungc_sim::session;
use rungc_syntax::codes::{self, FLEET_DEVICE, FLEET_ENGINE, FLEET_PORT};
use rungc_syntax::{Diagnostic, FittedModule};
use running::Fleets;

/// A program of the fleet, compiled.
struct Compiled {
    module: Module,
    /// The same with all devices of the model, of PLCs that clients reach.
    whole: Option<Module>,
    settings: Vec<Setting>,
    fitted: Vec<FittedModule>,
}

/// Runs a fleet.
pub fn run(args: &FleetArgs, cx: Context) -> Result {
    let reporting = &args.reading.reporting;
    let fleet = Fleet::load(&args.file).map_err(|error| subject::refuse(error, reporting, cx))?;
    let mut compiled = Vec::new();
    for plcs in &fleet.plcs {
        match compile(args, &fleet, plcs, cx)? {
            Ok(program) => compiled.push(program),
            Err(outcome) => return Ok(outcome),
        }
    }
    let refuse = |why: Box<Diagnostic>| subject::refuse(fleet.error(*why), reporting, cx);
    memory::allow_files(&fleet);
    let folder = tempfile::tempdir()?;
    let mut groups = Vec::new();
    for (plcs, compiled) in fleet.plcs.iter().zip(&compiled) {
        let folder = folder.path().join(groups.len().to_string());
        let mut hal = session::hardware(&compiled.fitted);
        if !args.in_virtual_time {
            let _ = WallClock::begin(&mut hal);
        }
        let Chosen { engine, why } = engine::choose(plcs, &compiled.module, &folder, cx)?;
        let engine: Box<dyn Engine> = match (engine, &why) {
            (Some(engine), _) => engine,
            (None, Some(why)) if matches!(plcs.engine, Choice::Lanes | Choice::C) => {
                let at = plcs.engine_span;
                return Err(refuse(FLEET_ENGINE.at(at, why).into()));
            }
            (None, _) => {
                let module = compiled.whole.as_ref().unwrap_or(&compiled.module);
                Box::new(Machines::new(module, plcs.count, &hal))
            }
        };
        let schedule = Schedule {
            settings: compiled.settings.clone(),
            spread_ms: plcs.spread_ms,
            repeat_ms: plcs.repeat_ms,
        };
        let mut group = Group::new(plcs, engine, schedule);
        check_settings(&mut group, plcs, compiled).map_err(refuse)?;
        if let Some(first) = plcs.modbus_tcp {
            let model = compiled.module.model;
            let service = Service::new(ServerProtocol::ModbusTcp, model.ports, model.type_code());
            let opened = group.serve(first, plcs.units, service);
            opened.map_err(|(address, error)| {
                let why = cannot_serve(ServerProtocol::ModbusTcp, address, &error);
                refuse(FLEET_PORT.at(plcs.modbus_span, why).into())
            })?;
            print_ports(&group, plcs, cx);
        }
        let about = About {
            module: &compiled.module,
            first: plcs.first,
            why,
        };
        groups.push((group, about));
    }
    let broker = fleet.connect().map_err(Failure::Because)?;
    Fleets::new(groups, broker, fleet.cycle_ms).run(args)
}

/// Compiles the program of a group; the outcome if it has errors.
fn compile(
    args: &FleetArgs,
    fleet: &Fleet,
    plcs: &Plcs,
    cx: Context,
) -> std::result::Result<std::result::Result<Compiled, super::Outcome>, Failure> {
    let reporting = &args.reading.reporting;
    let refuse = |why: Box<Diagnostic>| subject::refuse(fleet.error(*why), reporting, cx);
    let input = Input {
        file: Some(subject::near(fleet.program(plcs))),
        reading: args.reading.clone(),
    };
    let mut subject: Subject = subject::one(&input, cx)?;
    if plcs.modbus_tcp.is_some() {
        let rules = &mut subject.reporting.rules;
        rules.allow.push(codes::ETHERNET_CARD.id);
    }
    let mut reporter = Reporter::new(&subject.reporting, cx, true);
    let read = match read(&subject, &mut reporter) {
        Ok(read) => read,
        Err(failure) => {
            reporter.finish()?;
            return Err(failure);
        }
    };
    let mut options = subject.options();
    let model = compile::model(&read.program, &options);
    let (settings, set) = settings(plcs, &Names::of(&read.program), model).map_err(refuse)?;
    options
        .observe
        .extend(plcs.observed(model).map_err(refuse)?);
    if plcs.modbus_tcp.is_none() {
        setting::report_unused(&set, &read.program, options.clone());
    }
    let set = set
        .iter()
        .flat_map(|setting| setting::devices(setting.target));
    options.observe.extend(set);
    let options = CompileOptions {
        name: Some(stem(&subject, &read)),
        ..options
    };
    let compiled = compile::compile(&read.program, &options);
    let findings = findings(&subject, &read, &compiled);
    // An interpreter has all devices, so it keeps the special ones up to date that a client may read.
    let whole = plcs.modbus_tcp.and_then(|_| {
        let options = CompileOptions {
            observe_all: true,
            ..options
        };
        compile::compile(&read.program, &options).module
    });
    match compiled.module {
        Some(module) if !findings.failed() => {
            reporter.add_count(&findings, subject.check_command().as_deref(), cx)?;
            reporter.finish()?;
            if module.has_ports() {
                let name = &plcs.name.text;
                eprint_line(&format!(
                    "rungc: {name}: serial ports and CAN cards of a fleet are not connected: its links have no partners"
                ));
            }
            let parameters = read.program.parameters.as_ref();
            Ok(Ok(Compiled {
                module,
                whole,
                settings,
                fitted: parameters.map_or_else(Vec::new, |of| of.modules.clone()),
            }))
        }
        _ => {
            let outcome = conclude(&findings, &mut reporter, cx, String::new)?;
            reporter.finish()?;
            Ok(Err(outcome))
        }
    }
}

/// Settings of the file, as a fleet takes them and as they are written.
type Settings = (Vec<Setting>, Vec<setting::Setting>);

fn settings(
    plcs: &Plcs,
    names: &Names,
    model: &Model,
) -> std::result::Result<Settings, Box<Diagnostic>> {
    let (mut settings, mut written) = (Vec::new(), Vec::new());
    for Written { text, span } in &plcs.set {
        let read = setting::parse(text, names)
            .and_then(|read| setting::lasts(&read, model).map(|()| read))
            .map_err(|why| Box::new(FLEET_DEVICE.at(*span, why)))?;
        let parts = At::parts(read.target, read.value).ok_or_else(|| {
            let why = format!("`{}` cannot be set in a fleet", read.target);
            Box::new(FLEET_DEVICE.at(*span, why))
        })?;
        settings.push(Setting {
            at_ms: read.at_ms,
            parts,
        });
        written.push(read);
    }
    Ok((settings, written))
}

/// Checks that the program has all devices that are set.
fn check_settings(
    group: &mut Group<'_>,
    plcs: &Plcs,
    compiled: &Compiled,
) -> std::result::Result<(), Box<Diagnostic>> {
    for (written, setting) in plcs.set.iter().zip(&compiled.settings) {
        if setting.parts.iter().any(|&(at, _)| !group.has(at)) {
            let title = compiled.module.model.title;
            let why = format!(
                "`{}` sets a device that {title} does not have",
                written.text
            );
            return Err(FLEET_DEVICE.at(written.span, why).into());
        }
    }
    Ok(())
}

/// Says where clients reach the PLCs of a group.
fn print_ports(group: &Group<'_>, plcs: &Plcs, cx: Context) {
    let Some((first, last, ports)) = group.ports() else {
        return;
    };
    let name = &group.name;
    let units = match plcs.units {
        Some(_) => ", each PLC by its unit number",
        None => "",
    };
    eprint_line(&match ports {
        1 => format!("rungc: {name}: Modbus TCP at {first}{units}"),
        _ => format!("rungc: {name}: Modbus TCP at {first} to {last}{units}"),
    });
    for address in group.addresses() {
        cx.detail(|| format!("    {name} at {address}"));
    }
    if !first.ip().is_loopback() {
        eprint_line(
            "rungc: whoever reaches these addresses reads and writes every device: there is no password",
        );
    }
}
