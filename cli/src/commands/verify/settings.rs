//! What the command line and the settings of a project ask.

use super::Asked;
use crate::args::VerifyArgs;
use crate::commands::Context;
use crate::commands::Failure;
use crate::commands::subject::{self, Subject};
use rungc_project::property::{Asks, Row};
use rungc_project::{Named, Project};
use rungc_sim::Target;
use rungc_syntax::{DeviceClass, Program};
use rungc_verify::model::World;
use rungc_verify::property::{Condition, Mistake, Property, parse};
use rungc_verify::prove::Options;
use std::time::Duration;

type Result<T> = std::result::Result<T, Failure>;

/// How long a property is tried, in milliseconds.
const TIMEOUT_MS: u64 = 60_000;
/// The longest time from one scan to the next, in milliseconds: after that, the watchdog stops most models.
const SCAN_MS: u64 = 200;

/// Reads what is asked of a program.
pub struct Reader<'a> {
    pub args: &'a VerifyArgs,
    pub subject: &'a Subject,
    pub program: &'a Program,
    pub cx: Context,
}

impl Reader<'_> {
    fn project(&self) -> Option<&Project> {
        self.subject.own_project()
    }

    /// The properties of the command line, else those of the settings.
    pub fn properties(&self) -> Result<Vec<Asked>> {
        type Kind = fn(Condition) -> Property;
        let kinds: [(&str, &[String], Kind); 3] = [
            ("never", &self.args.never, Property::Never),
            ("always", &self.args.always, Property::Always),
            ("reachable", &self.args.reachable, Property::Reachable),
        ];
        let mut asked = Vec::new();
        for (name, texts, kind) in kinds {
            for text in texts {
                asked.push(Asked {
                    text: format!("{name} {text}"),
                    property: kind(self.given(&format!("--{name}"), text)?),
                });
            }
        }
        if let (true, Some(project)) = (asked.is_empty(), self.project()) {
            let rows = project.properties.iter();
            asked = rows
                .map(|row| self.row(project, row))
                .collect::<Result<_>>()?;
        }
        if asked.is_empty() {
            let why = "no property given: add --never, --always or --reachable, or [[property]] to rungc.toml";
            return Err(Failure::Because(why.to_string()));
        }
        Ok(asked)
    }

    /// What is supposed of the world around the program.
    pub fn options(&self) -> Result<Options> {
        let settings = self.project().map(|project| (project, &project.verify));
        let time = |given: Option<u64>, named: Option<&Named>, usual: u64| match (given, named) {
            (Some(ms), _) => Ok(ms),
            (None, Some(named)) => self.time(named),
            (None, None) => Ok(usual),
        };
        let named = settings.map(|(_, verify)| verify);
        let scan = time(self.args.scan, named.and_then(|v| v.scan.as_ref()), SCAN_MS)?;
        let timeout = named.and_then(|v| v.timeout.as_ref());
        let timeout = time(self.args.timeout, timeout, TIMEOUT_MS)?;
        let scan_ms = u32::try_from(scan).ok();
        let Some(scan_ms) = scan_ms.filter(|ms| (1..=32_767).contains(ms)) else {
            let why = "the longest time from one scan to the next is 1ms to 32767ms";
            return Err(Failure::Because(why.to_string()));
        };
        let free = settings.into_iter().flat_map(|(_, verify)| &verify.free);
        let free = free.map(|range| (range.class, range.first, range.last));
        let free = free.chain(self.args.free.iter().copied());
        let each = |(class, first, last): (DeviceClass, u32, u32)| {
            (first..=last).map(move |number| (class, number))
        };
        Ok(Options {
            world: World {
                scan_ms,
                fresh: self.args.cleared,
                free: free.flat_map(each).collect(),
                ..World::default()
            },
            assumed: self
                .assumed()?
                .into_iter()
                .map(|(_, condition)| condition)
                .collect(),
            time: Duration::from_millis(timeout),
        })
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

    fn parse(&self, text: &str) -> std::result::Result<Condition, Mistake> {
        let plain = |text: &str| text.trim().to_lowercase();
        parse(text, &|name| {
            let named = self.program.comments.iter();
            let named = named.filter(|(_, comment)| plain(comment) == plain(name));
            named
                .filter_map(|(device, _)| Target::parse(&device.to_string()).ok())
                .collect()
        })
    }

    /// A condition of the command line.
    fn given(&self, option: &str, text: &str) -> Result<Condition> {
        self.parse(text).map_err(|mistake| {
            let before = text[..mistake.at.min(text.len())].chars().count();
            let marker = " ".repeat(before);
            let why = mistake.why;
            Failure::Because(format!("{option}: {why}\n  {text}\n  {marker}^"))
        })
    }

    /// A condition of the settings.
    fn condition(&self, project: &Project, named: &Named) -> Result<Condition> {
        self.parse(&named.text)
            .map_err(|mistake| self.refused(project, named, mistake.why))
    }

    fn refused(&self, project: &Project, named: &Named, why: String) -> Failure {
        let error = project.mistake(named.mistake(why));
        subject::refuse(error, &self.subject.reporting, self.cx)
    }

    fn time(&self, named: &Named) -> Result<u64> {
        let project = self.project();
        crate::time::parse(&named.text).map_err(|why| match project {
            Some(project) => self.refused(project, named, why),
            None => Failure::Because(why),
        })
    }

    fn row(&self, project: &Project, row: &Row) -> Result<Asked> {
        let condition = |named: &Named| self.condition(project, named);
        let (text, property) = match &row.asks {
            Asks::Never(a) => (format!("never {}", a.text), Property::Never(condition(a)?)),
            Asks::Always(a) => (
                format!("always {}", a.text),
                Property::Always(condition(a)?),
            ),
            Asks::Reachable(a) => (
                format!("reachable {}", a.text),
                Property::Reachable(condition(a)?),
            ),
            Asks::Whenever { when, then, within } => {
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
            Asks::Stays { holds, until } => {
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
        Ok(Asked { text, property })
    }
}
