//! Properties as users request them: conditions read for a program, and what is known of its surroundings.

mod statement;

use crate::property::is_possible;
use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::{CrossReference, Reach, Use, UseKind};
use rungc_host::duration;
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile, model, open_indexes};
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_project::property::{PropertyKind, Row};
use rungc_project::{Named, Project};
use rungc_sim::Target;
use rungc_sim::names::Comments;
use rungc_sim::property::{Condition, ParseError, Property, parse};
use rungc_syntax::{DeviceClass, Diagnostics, Program, Span, codes};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

/// Devices that may be written from outside the program, beside terminals.
#[derive(Debug, Default)]
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

/// A reader of conditions and properties of a program.
#[derive(Clone, Copy, Debug)]
pub struct Reader<'a> {
    /// The program.
    pub program: &'a Program,
    /// Options for compiling it.
    pub options: &'a CompileOptions,
}

impl Reader<'_> {
    /// Reads a condition.
    ///
    /// # Errors
    /// Description of the mistake, with its place.
    pub fn condition(&self, text: &str) -> Result<Condition, ParseError> {
        let names = Comments::of(self.program);
        let condition = parse(text, &|name| {
            let devices = names.devices(name).iter();
            devices
                .filter_map(|device| Target::parse(&device.to_string()).ok())
                .collect()
        })?;
        let model = model(self.program, self.options);
        let mut devices = condition.devices().into_iter();
        match devices.find(|&(class, number)| !model.has(class, number)) {
            None => Ok(condition),
            Some((class, number)) => Err(ParseError {
                at: 0,
                why: format!("{} does not exist on {}", class.number(number), model.title),
            }),
        }
    }

    /// Reads an assumption, which something can meet.
    ///
    /// # Errors
    /// Description of the mistake, with its place.
    pub fn assumption(&self, text: &str) -> Result<Condition, ParseError> {
        let condition = self.condition(text)?;
        match self.is_possible(&condition) {
            true => Ok(condition),
            false => Err(ParseError {
                at: 0,
                why: "this condition can never hold, so no run would be left".to_string(),
            }),
        }
    }

    /// A property as a statement: `never Y000 & Y001`, `whenever X000 then Y000 within 500ms`,
    /// `stays M0 after X001 until X002`. Words in quotes are comments.
    ///
    /// # Errors
    /// Description of the mistake, with its place.
    pub fn statement(&self, text: &str) -> Result<Property, ParseError> {
        let kind = statement::read(text)?;
        for named in kind.conditions() {
            self.condition(&named.text).map_err(|error| ParseError {
                at: named.span.start as usize + error.at,
                why: error.why,
            })?;
        }
        let property = self.property(&kind);
        property.map_err(|(named, why)| ParseError {
            at: named.span.start as usize,
            why,
        })
    }

    /// A property by its kind.
    ///
    /// # Errors
    /// Description of the mistake, and the part that it is in.
    pub fn property<'k>(&self, kind: &'k PropertyKind) -> Result<Property, (&'k Named, String)> {
        let condition = |named: &'k Named| {
            let parsed = self.condition(&named.text);
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
                        let ms = duration::parse(&named.text).map_err(|why| (named, why))?;
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
    pub fn senseless(&self, property: &Property) -> Option<(usize, String)> {
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
        let model = model(self.program, self.options);
        let options = CompileOptions {
            model: Some(model.id),
            observe: condition.devices(),
            ..CompileOptions::default()
        };
        let module = compile(&empty, &options).module;
        module.is_none_or(|module| is_possible(condition, &module))
    }
}

/// Compiles a program with all devices that these conditions look at; `None` if it has errors.
pub fn module<'a>(
    program: &Program,
    mut options: CompileOptions,
    conditions: impl IntoIterator<Item = &'a Condition>,
    external: &ExternalWrites,
) -> Option<Module> {
    let devices = conditions.into_iter().flat_map(Condition::devices);
    options.observe.extend(devices);
    let indexes = open_indexes(program, &options, |device| {
        external.devices.contains_key(&device)
    });
    options.observe.extend(indexes);
    options.optimise = false;
    let mut module = compile(program, &options).module?;
    simplify(&mut module);
    Some(module)
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

/// Warnings about properties of devices that nothing drives: no instruction, no input, nothing outside the program.
pub fn undriven<'r>(
    requested: impl IntoIterator<Item = (&'r str, &'r Property)>,
    program: &Program,
    options: &CompileOptions,
    external: &ExternalWrites,
) -> Diagnostics {
    let model = model(program, options);
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
    for (text, property) in requested {
        let devices = property.conditions().into_iter();
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
            let message = format!("`{text}`: nothing drives {}", names.join(", "));
            let warning = codes::PROPERTY_OF_UNDRIVEN.at(Span::default(), message);
            found.push(warning.help(
                "is the number right? What a panel writes belongs in rungc.toml: `[hmi] writes = \"M500\"`",
            ));
        }
    }
    found
}
