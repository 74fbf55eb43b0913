//! Properties of a program from the command line and the settings of its project: for all commands that search for
//! runs.

use super::setting;
use super::subject::{self, Subject};
use super::{Context, Failure, findings};
use crate::args::Properties;
use crate::report::{Findings, Reporter};
use rungc::Names;
use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::{CrossReference, Reach, Use, UseKind};
use rungc_frontend::Read;
use rungc_functions::Expanded;
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile, open_indexes};
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_project::property::{PropertyKind, Row};
use rungc_project::{Named, Project};
use rungc_sim::property::{Condition, ParseError, Property, parse};
use rungc_sim::{Target, check_lasts};
use rungc_syntax::{DeviceClass, Diagnostic, Diagnostics, OperandKind, Program, Span, codes};
use rungc_verify::property::is_possible;
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
    /// Identifier of the requirement that it belongs to.
    pub requirement: Option<String>,
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
                let option = format!("--{name}");
                let property = kind(self.given(&option, text)?);
                if let Some((_, why)) = self.senseless(&property) {
                    return Err(pointed(&option, text, &ParseError { at: 0, why }));
                }
                requested.push(RequestedProperty {
                    text: format!("{name} {text}"),
                    requirement: None,
                    property,
                });
            }
        }
        if let (true, Some(project)) = (requested.is_empty(), self.project()) {
            let rows = rungc_functions::properties(project).map_err(|mistakes| {
                let error = project.invalid(mistakes);
                subject::refuse(error, &self.subject.reporting, self.cx)
            })?;
            requested = rows
                .iter()
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
        let verify = &project.verify;
        match rungc_functions::properties(project) {
            Ok(rows) => {
                let mistakes = rows.iter().filter_map(|row| self.expanded(row).err());
                let mut seen = Vec::new();
                for mistake in mistakes.filter(|(named, why)| is_new(&mut seen, named, why)) {
                    found.push(mistake.0.error(mistake.1));
                }
            }
            Err(mistakes) => found.extend(mistakes.sorted()),
        }
        for named in &verify.assume {
            if let Err(why) = self.assumption(&named.text) {
                found.push(named.error(why.why));
            }
        }
        for named in verify.timeout.iter().chain(&verify.scan) {
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
        let free = setting::ranges("--free", &self.args.free, &names)?;
        let model = rungc_lower::compile::model(self.program, &self.subject.options());
        for &(class, first, last) in &free {
            // Only special devices may be in their way.
            for number in (first..=last).filter(|&number| is_special(class, number)) {
                check_lasts(model, Target::Word(class, number), |_| true)
                    .map_err(|why| Failure::Because(format!("--free: {why}")))?;
            }
        }
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
                let condition = self.assumption(&named.text);
                let condition =
                    condition.map_err(|error| self.refused(project, named, error.why))?;
                assumed.push((named.text.clone(), condition));
            }
        }
        for text in &self.args.assume {
            let condition = self.assumption(text);
            let condition = condition.map_err(|error| pointed("--assume", text, &error))?;
            assumed.push((text.clone(), condition));
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

    /// An assumption, which something can meet.
    fn assumption(&self, text: &str) -> std::result::Result<Condition, ParseError> {
        let condition = self.parse(text)?;
        match self.is_possible(&condition) {
            true => Ok(condition),
            false => Err(ParseError {
                at: 0,
                why: "this condition can never hold, so no run would be left".to_string(),
            }),
        }
    }

    /// A condition of the command line.
    fn given(&self, option: &str, text: &str) -> Result<Condition> {
        self.parse(text)
            .map_err(|error| pointed(option, text, &error))
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

    /// A property of the settings; else what is wrong, and with which part.
    fn expanded<'k>(
        &self,
        expanded: &'k Expanded,
    ) -> std::result::Result<Property, (&'k Named, String)> {
        for part in &expanded.parts {
            if let Err(error) = self.parse(&part.named.text) {
                return Err((&part.named, format!("{}{}", part.place, error.why)));
            }
        }
        let Row { kind, name, .. } = &expanded.row;
        self.property(kind).map_err(|(named, why)| match name {
            Some(name) if !expanded.parts.is_empty() => (named, format!("{name}: {why}")),
            _ => (named, why),
        })
    }

    fn row(&self, project: &Project, expanded: &Expanded) -> Result<RequestedProperty> {
        let property = self
            .expanded(expanded)
            .map_err(|(named, why)| self.refused(project, named, why))?;
        let row = &expanded.row;
        Ok(RequestedProperty {
            text: stated(row),
            requirement: row.requirement.clone(),
            property,
        })
    }

    /// A property by its kind; else what is wrong, and with which part.
    fn property<'k>(
        &self,
        kind: &'k PropertyKind,
    ) -> std::result::Result<Property, (&'k Named, String)> {
        let condition = |named: &'k Named| {
            let parsed = self.parse(&named.text);
            parsed.map_err(|error| (named, error.why))
        };
        let property = match kind {
            PropertyKind::Never(a) => Property::Never(condition(a)?),
            PropertyKind::Always(a) => Property::Always(condition(a)?),
            PropertyKind::Reachable(a) => Property::Reachable(condition(a)?),
            PropertyKind::Whenever { when, then, within } => Property::Whenever {
                when: condition(when)?,
                then: condition(then)?,
                within_ms: match within {
                    Some(named) => {
                        let ms = crate::time::parse(&named.text).map_err(|why| (named, why))?;
                        u32::try_from(ms).unwrap_or(u32::MAX >> 1)
                    }
                    None => 0,
                },
            },
            PropertyKind::Stays {
                after,
                holds,
                until,
            } => Property::Stays {
                after: after.as_ref().map(condition).transpose()?,
                holds: condition(holds)?,
                until: match until {
                    Some(until) => condition(until)?,
                    None => Condition::Constant(false),
                },
            },
        };
        match self.senseless(&property) {
            Some((part, why)) => Err((kind.conditions()[part], why)),
            None => Ok(property),
        }
    }

    /// The number and the problem of a condition with which a property says nothing about any program.
    fn senseless(&self, property: &Property) -> Option<(usize, String)> {
        const NOTHING: &str = "so the property says nothing about a program";
        let never = |a: &Condition| !self.is_possible(a);
        let reason =
            |part: usize, what: &str| Some((part, format!("this condition {what}, {NOTHING}")));
        match property {
            Property::Never(a) | Property::Reachable(a) if never(a) => reason(0, "can never hold"),
            Property::Always(a) if never(&Condition::Not(Box::new(a.clone()))) => {
                reason(0, "always holds")
            }
            Property::Whenever { when: a, .. }
            | Property::Stays { after: Some(a), .. }
            | Property::Stays {
                after: None,
                holds: a,
                ..
            } if never(a) => reason(0, "can never hold"),
            Property::Stays { after: None, .. } => None,
            Property::Stays { holds, .. } if never(&Condition::Not(Box::new(holds.clone()))) => {
                reason(1, "always holds")
            }
            Property::Whenever { then: b, .. } if never(&Condition::Not(Box::new(b.clone()))) => {
                reason(1, "always holds")
            }
            _ => None,
        }
    }

    /// Returns true if there are values of the devices with which a condition holds.
    fn is_possible(&self, condition: &Condition) -> bool {
        let empty = rungc_frontend::read_text("", "END\n").program;
        let model = rungc_lower::compile::model(self.program, &self.subject.options());
        let options = CompileOptions {
            model: Some(model.id),
            observe: condition.devices(),
            ..CompileOptions::default()
        };
        let module = compile(&empty, &options).module;
        module.is_none_or(|module| is_possible(condition, &module))
    }
}

/// Notes a mistake. Returns false for one that has been noted at the same place: properties of one row share parts.
fn is_new(seen: &mut Vec<(Span, String)>, named: &Named, why: &str) -> bool {
    let mistake = (named.span, why.to_string());
    let is_new = !seen.contains(&mistake);
    seen.extend(is_new.then_some(mistake));
    is_new
}

/// A mistake in a condition of the command line, with its place.
fn pointed(option: &str, text: &str, error: &ParseError) -> Failure {
    let before = text[..error.at.min(text.len())].chars().count();
    let marker = " ".repeat(before);
    let why = &error.why;
    Failure::Because(format!("{option}: {why}\n  {text}\n  {marker}^"))
}

/// Compiles the program with all devices that properties and assumptions look at; reports why if that fails.
pub fn module<'a>(
    subject: &Subject,
    read: &Read,
    conditions: impl IntoIterator<Item = &'a Condition>,
    external: &ExternalWrites,
    reporter: &mut Reporter,
) -> Result<Option<Module>> {
    let devices = conditions.into_iter().flat_map(Condition::devices);
    let mut compiling = subject.options();
    compiling.observe.extend(devices);
    let indexes = open_indexes(&read.program, &compiling, |device| {
        external.devices.contains_key(&device)
    });
    compiling.observe.extend(indexes);
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

/// A row of the settings as text: `never Y000 & Y001`, after its name if it has one.
pub fn stated(row: &Row) -> String {
    let soon = |within: &Option<Named>| match within {
        Some(within) => format!(" within {}", within.text),
        None => String::new(),
    };
    let text = match &row.kind {
        PropertyKind::Never(a) => format!("never {}", a.text),
        PropertyKind::Always(a) => format!("always {}", a.text),
        PropertyKind::Reachable(a) => format!("reachable {}", a.text),
        PropertyKind::Whenever { when, then, within } => {
            format!("whenever {} then {}{}", when.text, then.text, soon(within))
        }
        PropertyKind::Stays {
            after,
            holds,
            until,
        } => {
            let part = |word, part: &Option<Named>| match part {
                Some(part) => format!(" {word} {}", part.text),
                None => String::new(),
            };
            let (after, until) = (part("after", after), part("until", until));
            format!("stays {}{after}{until}", holds.text)
        }
    };
    match &row.name {
        Some(name) => format!("{name}: {text}"),
        None => text,
    }
}

/// Reports properties of devices that nothing drives.
pub fn report_undriven(
    requested: &[RequestedProperty],
    read: &Read,
    subject: &Subject,
    external: &ExternalWrites,
    reporter: &mut Reporter,
) -> Result<()> {
    let found = undriven(requested, &read.program, &subject.options(), external);
    if found.is_empty() {
        return Ok(());
    }
    let findings = Findings::new(&subject.file, &read.program, found, &subject.reporting);
    Ok(reporter.add(&findings)?)
}

/// Warnings about properties of devices that nothing drives: no instruction, no input, nothing outside the program.
fn undriven(
    requested: &[RequestedProperty],
    program: &Program,
    options: &CompileOptions,
    external: &ExternalWrites,
) -> Diagnostics {
    let model = rungc_lower::compile::model(program, options);
    let (resolved, _) = resolve(program, model);
    let uses = CrossReference::new(&resolved).uses;
    let drives = |used: &Use, (class, number): (DeviceClass, u32)| {
        let is_there = match used.reach {
            Reach::Count(_) => (used.first.number..used.end()).contains(&number),
            Reach::Open | Reach::Indexed => true,
        };
        // What the program only reads counts as written by a panel, but for outputs.
        let is_read = matches!(used.kind, UseKind::Contact | UseKind::Read);
        used.first.class == class && is_there && !(is_read && class == DeviceClass::Y)
    };
    let mut found = Diagnostics::new();
    for requested in requested {
        let devices = requested.property.conditions().into_iter();
        let devices: BTreeSet<_> = devices.flat_map(Condition::devices).collect();
        let is_driven = |device: &(DeviceClass, u32)| {
            device.0 == DeviceClass::X
                || is_special(device.0, device.1)
                || external.source(model, *device).is_some()
                || uses.iter().any(|used| drives(used, *device))
        };
        let names = devices.iter().filter(|device| !is_driven(device));
        let names: Vec<String> = names
            .map(|(class, number)| format!("`{}`", class.number(*number)))
            .collect();
        if !names.is_empty() {
            let message = format!("`{}`: nothing drives {}", requested.text, names.join(", "));
            let warning = codes::PROPERTY_OF_UNDRIVEN.at(Span::default(), message);
            found.push(warning.help(
                "is the number right? What a panel writes belongs in rungc.toml: `[hmi] writes = \"M500\"`",
            ));
        }
    }
    found
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
