//! Properties of a program from the command line and the settings of its project: for all commands that search for
//! runs.

use super::setting;
use super::subject::{self, Subject};
use super::{Context, Failure, findings};
use crate::args::Properties;
use crate::report::{Findings, Reporter};
use rungc::Names;
use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::{CrossReference, Reach, Use};
use rungc_frontend::Read;
use rungc_functions::Expanded;
use rungc_ir::Module;
use rungc_lower::compile::compile;
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_project::property::Row;
use rungc_project::{Named, Project};
use rungc_sim::property::{Condition, ParseError, Property};
use rungc_sim::{Target, check_lasts};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, Label, Program, Span};
use rungc_verify::request;
pub use rungc_verify::request::{ExternalWrites, stated};
use std::ops::RangeInclusive;

type Result<T> = std::result::Result<T, Failure>;

/// The longest time from one scan to the next, in milliseconds: after that, the watchdog stops most models.
const SCAN_MS: u64 = 200;

/// Times that a scan may take at most, in milliseconds.
const SCANS_MS: RangeInclusive<u32> = 1..=32_767;

const WRONG_SCAN: &str = "the longest time from one scan to the next is 1ms to 32767ms";

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
                if let Some((_, why)) = self.with(|reader| reader.senseless(&property)) {
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
        self.with(|reader| reader.condition(text))
    }

    /// An assumption, which something can meet.
    fn assumption(&self, text: &str) -> std::result::Result<Condition, ParseError> {
        self.with(|reader| reader.assumption(text))
    }

    /// Reads something for the program.
    fn with<T>(&self, read: impl FnOnce(request::Reader) -> T) -> T {
        read(request::Reader {
            program: self.program,
            options: &self.subject.options(),
        })
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
        let property = self.with(|reader| reader.property(kind));
        property.map_err(|(named, why)| match name {
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
    let module = request::module(&read.program, subject.options(), conditions, external);
    if module.is_none() {
        let compiled = compile(&read.program, &subject.options());
        reporter.add(&findings(subject, read, &compiled))?;
    }
    Ok(module)
}

/// Reports properties of devices that nothing drives.
pub fn report_undriven(
    requested: &[RequestedProperty],
    read: &Read,
    subject: &Subject,
    external: &ExternalWrites,
    reporter: &mut Reporter,
) -> Result<()> {
    let found = request::undriven(
        requested
            .iter()
            .map(|one| (one.text.as_str(), &one.property)),
        &read.program,
        &subject.options(),
        external,
    );
    if found.is_empty() {
        return Ok(());
    }
    let findings = Findings::new(&subject.file, &read.program, found, &subject.reporting);
    Ok(reporter.add(&findings)?)
}

/// A diagnostic at the instructions that write these devices, or at the first that uses one if none does.
pub fn at_writes(
    mut diagnostic: Diagnostic,
    devices: &[(DeviceClass, u32)],
    read: &Read,
    model: &'static Model,
) -> Diagnostic {
    let (resolved, _) = resolve(&read.program, model);
    let uses = CrossReference::new(&resolved).uses;
    let devices = devices
        .iter()
        .map(|&(class, number)| Device { class, number });
    let devices: Vec<_> = devices.collect();
    let label = |one: &Use, device: &Device, what: &str| Label {
        span: read.program.instrs[one.instr].span,
        text: format!("`{device}` {what} here").into(),
    };
    let writes = uses.iter().filter_map(|one| {
        let device = devices.iter().find(|&&device| one.may_write(device))?;
        let is_certain = matches!(one.reach, Reach::Count(_));
        let what = if is_certain {
            "is written"
        } else {
            "may be written"
        };
        Some(label(one, device, what))
    });
    let mut labels: Vec<_> = writes.collect();
    labels.dedup_by_key(|label| label.span);
    if labels.is_empty() {
        let reads = |one: &Use| {
            let device = devices.iter().find(|&&device| one.may_concern(device))?;
            Some(label(one, device, "is used"))
        };
        labels.extend(uses.iter().find_map(reads));
    }
    let mut labels = labels.into_iter();
    if let Some(first) = labels.next() {
        diagnostic.span = first.span;
        diagnostic.label = first.text;
        diagnostic.others = labels.collect();
    }
    diagnostic
}
