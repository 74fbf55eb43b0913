//! Properties of a program from the command line and the settings of its project: for all commands that search for
//! runs.

use super::names::Names;
use super::subject::{self, Subject};
use super::{Context, Failure, findings};
use crate::args::Properties;
use crate::report::Reporter;
use rungc_analysis::resolve::resolve;
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::Model;
use rungc_project::property::{PropertyKind, Row};
use rungc_project::{Named, Project};
use rungc_sim::Target;
use rungc_syntax::{DeviceClass, Diagnostic, Diagnostics, OperandKind, Program};
use rungc_verify::property::{Condition, ParseError, Property, parse};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

type Result<T> = std::result::Result<T, Failure>;

/// The longest time from one scan to the next, in milliseconds: after that, the watchdog stops most models.
const SCAN_MS: u64 = 200;

/// Times that a scan may take at most, in milliseconds.
const SCANS_MS: RangeInclusive<u32> = 1..=32_767;

const WRONG_SCAN: &str = "the longest time from one scan to the next is 1ms to 32767ms";

/// Devices that may be written from outside the program, beside terminals.
#[derive(Default)]
pub struct ExternalWrites {
    /// Devices, with what says so: an option or a table of the settings.
    pub devices: BTreeMap<(DeviceClass, u32), &'static str>,
    /// True if the settings name servers, whose clients could write other devices, too.
    pub has_clients: bool,
    /// True if the command has an option that names devices.
    pub has_option: bool,
}

impl ExternalWrites {
    /// Devices named by `--free`, if the command has it, and by the settings of the program's project.
    pub fn of(free: Option<&[(DeviceClass, u32, u32)]>, project: Option<&Project>) -> Self {
        let mut external = ExternalWrites {
            has_option: free.is_some(),
            ..ExternalWrites::default()
        };
        let devices = &mut external.devices;
        let mut add = |by: &'static str, class, numbers: RangeInclusive<u32>| {
            for number in numbers.filter(|_| class != DeviceClass::X) {
                devices.entry((class, number)).or_insert(by);
            }
        };
        for &(class, first, last) in free.unwrap_or_default() {
            add("--free", class, first..=last);
        }
        if let Some(project) = project {
            for range in &project.verify.free {
                add("[verify]", range.class, range.first..=range.last);
            }
            for (by, run) in project.written_externally() {
                add(by, run.class, run.first..=run.first + run.count - 1);
            }
            external.has_clients = project.serve.any();
        }
        external
    }

    /// Sources that name the devices, each once.
    pub fn sources(&self) -> Vec<&'static str> {
        BTreeSet::from_iter(self.devices.values().copied())
            .into_iter()
            .collect()
    }

    /// Source for the write of a device, by its usual name.
    pub fn source(&self, model: &Model, device: (DeviceClass, u32)) -> Option<&'static str> {
        let mut devices = self.devices.iter();
        let found = devices.find(|&(&(class, number), _)| model.canonical(class, number) == device);
        found.map(|(_, by)| *by)
    }
}

/// A property as requested.
pub struct RequestedProperty {
    /// As it is written: `never Y000 & Y001`.
    pub text: String,
    /// Meaning.
    pub property: Property,
}

/// Reader of the properties of a program.
pub struct Reader<'a> {
    pub args: &'a Properties,
    pub subject: &'a Subject,
    pub program: &'a Program,
    pub cx: Context,
}

impl Reader<'_> {
    /// The settings of the program's project.
    pub fn project(&self) -> Option<&Project> {
        self.subject.own_project()
    }

    /// The properties of the command line, else those of the settings.
    pub fn properties(&self) -> Result<Vec<RequestedProperty>> {
        type Kind = fn(Condition) -> Property;
        let kinds: [(&str, &[String], Kind); 3] = [
            ("never", &self.args.never, Property::Never),
            ("always", &self.args.always, Property::Always),
            ("reachable", &self.args.reachable, Property::Reachable),
        ];
        let mut requested = Vec::new();
        for (name, texts, kind) in kinds {
            for text in texts {
                requested.push(RequestedProperty {
                    text: format!("{name} {text}"),
                    property: kind(self.given(&format!("--{name}"), text)?),
                });
            }
        }
        if let (true, Some(project)) = (requested.is_empty(), self.project()) {
            let rows = project.properties.iter();
            requested = rows
                .map(|row| self.row(project, row))
                .collect::<Result<_>>()?;
        }
        Ok(requested)
    }

    /// The longest time from one scan to the next, in milliseconds.
    pub fn scan_ms(&self) -> Result<u32> {
        let named = self.project().and_then(|p| p.verify.scan.as_ref());
        let scan = self.chosen(self.args.scan, named, SCAN_MS)?;
        let ms = u32::try_from(scan).ok().filter(|ms| SCANS_MS.contains(ms));
        ms.ok_or_else(|| Failure::Because(WRONG_SCAN.to_string()))
    }

    /// Mistakes in the properties and assumptions of the settings.
    pub fn mistakes(&self) -> Diagnostics {
        let mut found = Diagnostics::new();
        let Some(project) = self.project() else {
            return found;
        };
        let (rows, verify) = (&project.properties, &project.verify);
        let conditions = rows.iter().flat_map(|row| row.kind.conditions());
        for named in conditions.chain(&verify.assume) {
            if let Err(error) = self.parse(&named.text) {
                found.push(named.error(error.why));
            }
        }
        let within = rows.iter().filter_map(|row| row.kind.within());
        for named in within.chain(&verify.timeout).chain(&verify.scan) {
            if let Err(why) = crate::time::parse(&named.text) {
                found.push(named.error(why));
            }
        }
        if let Some(named) = &verify.scan
            && let Ok(ms) = crate::time::parse(&named.text)
            && !SCANS_MS.contains(&u32::try_from(ms).unwrap_or(u32::MAX))
        {
            found.push(named.error(WRONG_SCAN));
        }
        found
    }

    /// Devices that may be written from outside the program, by the command line and the settings.
    pub fn external(&self) -> Result<ExternalWrites> {
        let names = Names::of(self.program);
        let free = self.args.free.iter().map(|text| names.range(text));
        let free: std::result::Result<Vec<_>, _> = free.collect();
        let free = free.map_err(|why| Failure::Because(format!("--free: {why}")))?;
        Ok(ExternalWrites::of(Some(&free), self.project()))
    }

    /// A time in milliseconds: that of the command line, else that of the settings, else the usual one.
    pub fn chosen(&self, given: Option<u64>, named: Option<&Named>, usual: u64) -> Result<u64> {
        match (given, named) {
            (Some(ms), _) => Ok(ms),
            (None, Some(named)) => self.time(named),
            (None, None) => Ok(usual),
        }
    }

    /// The assumptions, as they are written and as they are read.
    pub fn assumed(&self) -> Result<Vec<(String, Condition)>> {
        let mut assumed = Vec::new();
        if let Some(project) = self.project() {
            for named in &project.verify.assume {
                assumed.push((named.text.clone(), self.condition(project, named)?));
            }
        }
        for text in &self.args.assume {
            assumed.push((text.clone(), self.given("--assume", text)?));
        }
        Ok(assumed)
    }

    fn parse(&self, text: &str) -> std::result::Result<Condition, ParseError> {
        let names = Names::of(self.program);
        let condition = parse(text, &|name| {
            let devices = names.with_comment(name).iter();
            devices
                .filter_map(|device| Target::parse(&device.to_string()).ok())
                .collect()
        })?;
        let model = rungc_lower::compile::model(self.program, &self.subject.options());
        let mut devices = condition.devices().into_iter();
        match devices.find(|&(class, number)| !model.has(class, number)) {
            None => Ok(condition),
            Some((class, number)) => Err(ParseError {
                at: 0,
                why: format!("{} does not exist on {}", class.number(number), model.title),
            }),
        }
    }

    /// A condition of the command line.
    fn given(&self, option: &str, text: &str) -> Result<Condition> {
        self.parse(text).map_err(|error| {
            let before = text[..error.at.min(text.len())].chars().count();
            let marker = " ".repeat(before);
            let why = error.why;
            Failure::Because(format!("{option}: {why}\n  {text}\n  {marker}^"))
        })
    }

    /// A condition of the settings.
    fn condition(&self, project: &Project, named: &Named) -> Result<Condition> {
        self.parse(&named.text)
            .map_err(|error| self.refused(project, named, error.why))
    }

    fn refused(&self, project: &Project, named: &Named, why: String) -> Failure {
        let error = project.error(named.error(why));
        subject::refuse(error, &self.subject.reporting, self.cx)
    }

    fn time(&self, named: &Named) -> Result<u64> {
        let project = self.project();
        crate::time::parse(&named.text).map_err(|why| match project {
            Some(project) => self.refused(project, named, why),
            None => Failure::Because(why),
        })
    }

    fn row(&self, project: &Project, row: &Row) -> Result<RequestedProperty> {
        let condition = |named: &Named| self.condition(project, named);
        let (text, property) = match &row.kind {
            PropertyKind::Never(a) => (format!("never {}", a.text), Property::Never(condition(a)?)),
            PropertyKind::Always(a) => (
                format!("always {}", a.text),
                Property::Always(condition(a)?),
            ),
            PropertyKind::Reachable(a) => (
                format!("reachable {}", a.text),
                Property::Reachable(condition(a)?),
            ),
            PropertyKind::Whenever { when, then, within } => {
                let soon = within
                    .as_ref()
                    .map_or_else(String::new, |w| format!(" within {}", w.text));
                let within = within
                    .as_ref()
                    .map(|within| self.time(within))
                    .transpose()?;
                let property = Property::Whenever {
                    when: condition(when)?,
                    then: condition(then)?,
                    within_ms: u32::try_from(within.unwrap_or(0)).unwrap_or(u32::MAX >> 1),
                };
                (
                    format!("whenever {} then {}{soon}", when.text, then.text),
                    property,
                )
            }
            PropertyKind::Stays { holds, until } => {
                let end = until
                    .as_ref()
                    .map_or_else(String::new, |u| format!(" until {}", u.text));
                let property = Property::Stays {
                    holds: condition(holds)?,
                    until: match until {
                        Some(until) => condition(until)?,
                        None => Condition::Constant(false),
                    },
                };
                (format!("stays {}{end}", holds.text), property)
            }
        };
        let text = match &row.name {
            Some(name) => format!("{name}: {text}"),
            None => text,
        };
        Ok(RequestedProperty { text, property })
    }
}

/// Compiles the program with all devices that properties and assumptions look at; reports why if that fails.
pub fn module<'a>(
    subject: &Subject,
    read: &Read,
    conditions: impl IntoIterator<Item = &'a Condition>,
    reporter: &mut Reporter,
) -> Result<Option<Module>> {
    let devices = conditions.into_iter().flat_map(Condition::devices);
    let mut compiling = subject.options();
    compiling.observe.extend(devices);
    let compiled = compile(
        &read.program,
        &CompileOptions {
            optimise: false,
            ..compiling
        },
    );
    let Some(mut module) = compiled.module else {
        let compiled = compile(&read.program, &subject.options());
        reporter.add(&findings(subject, read, &compiled))?;
        return Ok(None);
    };
    simplify(&mut module);
    Ok(Some(module))
}

/// A diagnostic at the instructions that write these devices, if there are any.
pub fn at_writes(
    mut diagnostic: Diagnostic,
    devices: &[(DeviceClass, u32)],
    read: &Read,
    model: &'static Model,
) -> Diagnostic {
    let (resolved, _) = resolve(&read.program, model);
    let mut places = resolved.program.instrs.iter().filter_map(|instr| {
        let drives = matches!(
            instr.mnemonic.as_str(),
            "OUT" | "SET" | "RST" | "PLS" | "PLF" | "ALT"
        );
        let operand = instr.operands.first().filter(|_| drives)?;
        let OperandKind::Device(device, None) = operand.kind else {
            return None;
        };
        devices
            .contains(&(device.class, device.number))
            .then_some((instr.span, device))
    });
    if let Some((span, device)) = places.next() {
        diagnostic.span = span;
        diagnostic.label = format!("`{device}` is written here").into();
        diagnostic.others = places
            .map(|(span, device)| rungc_syntax::Label {
                span,
                text: format!("`{device}` is written here").into(),
            })
            .collect();
    }
    diagnostic
}
