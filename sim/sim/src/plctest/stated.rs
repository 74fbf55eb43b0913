//! Rules over time whose conditions are texts, as properties have them: `never = "Y000 & Y001"`.

use super::format::Reader;
use super::raw::{RawCondition, RawRules, RawStays, RawWhenever};
use super::rules::RuleKind;
use super::runner::Running;
use super::{Failure, Setting, Value};
use crate::property::{Condition, Devices, Property, Watcher, parse};
use crate::target::Target;
use rungc_host::duration;
use rungc_interp::rt_class;
use rungc_ir::node::Place;
use rungc_models::Model;
use rungc_models::runs::is_counter32;
use rungc_rt::Class;
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;
use toml::Spanned;

/// A property of the program of a case.
#[derive(Clone, Debug)]
pub struct Stated {
    /// Its line in the file, from 1.
    pub line: u32,
    /// Kind of the rule.
    pub kind: RuleKind,
    /// As it is written: `Y000 & Y001`.
    pub text: String,
    /// Meaning.
    pub property: Property,
}

impl Stated {
    /// What its conditions look at, as settings of the first PLC.
    pub(super) fn settings(&self) -> Vec<Setting> {
        let mut settings = Vec::new();
        for condition in self.property.conditions() {
            condition.targets(&mut |target| {
                settings.push(reading(target));
            });
        }
        settings
    }
}

/// A target of the case's PLC, as a setting.
fn reading(target: Target) -> Setting {
    Setting {
        plc: 0,
        target,
        value: Value::Int(0),
        tolerance: None,
    }
}

/// Reading.
impl Reader<'_> {
    /// A condition as a text.
    fn condition(&mut self, text: &str, at: usize) -> Option<Condition> {
        let comments = self.named.first_mut().map(|named| named.comments());
        let names = |word: &str| -> Vec<Target> {
            let devices = comments.as_ref().map_or(&[][..], |all| all.devices(word));
            let devices = devices.iter().map(ToString::to_string);
            devices
                .filter_map(|device| Target::parse(&device).ok())
                .collect()
        };
        match parse(text, &names) {
            Ok(condition) => Some(condition),
            Err(mistake) => {
                self.report(at, format!("`{text}`: {}", mistake.why));
                None
            }
        }
    }

    /// Rules of one condition; those in tables, which only `never` has, are left to the caller.
    pub(super) fn stated(
        &mut self,
        kind: RuleKind,
        raw: Option<Spanned<RawRules>>,
        make: fn(Condition) -> Property,
    ) -> (Vec<Stated>, Vec<Spanned<RawCondition>>) {
        let (mut stated, mut tables) = (Vec::new(), Vec::new());
        for raw in raw.into_iter().flat_map(RawRules::all) {
            let at = raw.span().start;
            let RawCondition::Text(text) = raw.get_ref() else {
                tables.push(raw);
                continue;
            };
            let property = self.condition(text, at).map(make);
            stated.extend(property.map(|property| Stated {
                line: self.line(at),
                kind,
                text: text.clone(),
                property,
            }));
        }
        (stated, tables)
    }

    /// Rules of one condition, which is a text.
    pub(super) fn texts(
        &mut self,
        kind: RuleKind,
        raw: Option<Spanned<RawRules>>,
        make: fn(Condition) -> Property,
    ) -> Vec<Stated> {
        let (stated, tables) = self.stated(kind, raw, make);
        for table in tables {
            let name = kind.name();
            let message = format!("write a condition in quotes: `{name} = \"Y000 & !Y001\"`");
            self.report(table.span().start, message);
        }
        stated
    }

    /// The time limit of a rule, in milliseconds; 0 for the same scan.
    pub(super) fn limit(&mut self, raw: &RawWhenever) -> Option<u32> {
        let text = match (&raw.within_ms, &raw.within) {
            (Some(ms), None) => return self.count(ms),
            (None, None) => return Some(0),
            (Some(_), Some(text)) => {
                let message = "use `within` or `within_ms`, not both".to_string();
                self.report(text.span().start, message);
                return None;
            }
            (None, Some(text)) => text,
        };
        let ms = duration::parse_within(text.get_ref(), 0..=u32::MAX.into());
        match ms.map(u32::try_from) {
            Ok(ms) => ms.ok(),
            Err(message) => {
                self.report(text.span().start, message);
                None
            }
        }
    }

    /// One condition that must follow another.
    pub(super) fn followed(
        &mut self,
        line: u32,
        (when, when_at): (&str, usize),
        (then, then_at): (&str, usize),
        within_ms: u32,
    ) -> Option<Stated> {
        let within = match within_ms {
            0 => String::new(),
            ms => format!(" within {ms} ms"),
        };
        Some(Stated {
            line,
            kind: RuleKind::Whenever,
            text: format!("whenever {when} then {then}{within}"),
            property: Property::Whenever {
                when: self.condition(when, when_at)?,
                then: self.condition(then, then_at)?,
                within_ms,
            },
        })
    }

    /// One condition that holds until another does.
    pub(super) fn staying(&mut self, raw: Spanned<RawStays>) -> Option<Stated> {
        let at = raw.span().start;
        let RawStays {
            after,
            holds,
            until,
        } = raw.into_inner();
        let begins = match &after {
            Some(after) => Some(self.condition(after.get_ref(), after.span().start)?),
            None => None,
        };
        let ends = match &until {
            Some(until) => self.condition(until.get_ref(), until.span().start)?,
            None => Condition::Constant(false),
        };
        let after = after.map_or(String::new(), |after| format!(" after {}", after.get_ref()));
        let until = until.map_or(String::new(), |until| format!(" until {}", until.get_ref()));
        Some(Stated {
            line: self.line(at),
            kind: RuleKind::Stays,
            text: format!("stays {}{after}{until}", holds.get_ref()),
            property: Property::Stays {
                after: begins,
                holds: self.condition(holds.get_ref(), holds.span().start)?,
                until: ends,
            },
        })
    }
}

/// A property that is followed while a case runs.
pub(super) struct Following<'c> {
    stated: &'c Stated,
    watcher: Watcher<'c>,
    /// True if what is wanted has happened.
    reached: bool,
}

impl<'c> Following<'c> {
    pub(super) fn new(stated: &'c Stated) -> Self {
        Following {
            stated,
            watcher: Watcher::new(&stated.property),
            reached: false,
        }
    }

    /// The PLC has been switched off and on.
    pub(super) fn restart(&mut self) {
        self.watcher = Watcher::new(&self.stated.property);
    }
}

/// Devices of an engine after a scan, as far as conditions look at them.
struct Snapshot {
    model: &'static Model,
    bits: BTreeMap<(Class, u32), bool>,
    words: BTreeMap<(Class, u32), i16>,
    counters: BTreeMap<u32, i32>,
}

impl Devices for Snapshot {
    fn bit_at(&self, class: Class, number: u32) -> bool {
        self.bits.get(&(class, number)) == Some(&true)
    }

    fn word_at(&self, class: Class, number: u32) -> i16 {
        self.words.get(&(class, number)).copied().unwrap_or(0)
    }

    fn counter32_at(&self, number: u32) -> Option<i32> {
        self.counters.get(&number).copied()
    }

    fn model(&self) -> &'static Model {
        self.model
    }
}

impl Snapshot {
    /// Adds the devices of a target.
    fn add(&mut self, running: &mut Running, target: Target) -> Result<(), Failure> {
        let (class, first, count) = target.devices(0);
        let numbers = (first..first + count).map(|number| (class, number));
        let mut devices: Vec<_> = numbers.collect();
        if let Target::Pair(..) | Target::Float(..) = target {
            let high = Place::fixed(class, first).high_word(self.model);
            devices = vec![(class, first), (high.class, high.number)];
        }
        for (class, number) in devices {
            let Some(of) = rt_class(class) else {
                continue;
            };
            let is_bit = matches!(target, Target::Bit(..) | Target::Nibbles(..));
            if is_bit {
                let value = running.integer(Target::Bit(class, number))?;
                self.bits.insert((of, number), value != 0);
            } else if is_counter32(class, number) {
                let value = running.integer(Target::Current(class, number))?;
                self.counters.insert(number, value);
            } else {
                let word = match class {
                    DeviceClass::T | DeviceClass::C => Target::Current(class, number),
                    _ => Target::Word(class, number),
                };
                let value = running.integer(word)?;
                self.words.insert((of, number), value as i16);
            }
        }
        Ok(())
    }

    /// Values that a property looks at, for a message.
    fn values(&self, property: &Property) -> String {
        let values = property.values(self).into_iter();
        let values = values.map(|(name, _, value)| format!("{name} = {value}"));
        values.collect::<Vec<_>>().join(", ")
    }
}

impl Running<'_> {
    /// An integer of the case's PLC.
    fn integer(&mut self, target: Target) -> Result<i32, Failure> {
        match self.current(&reading(target))? {
            Value::Int(value) => Ok(value),
            Value::Float(_) | Value::Text(_) => Ok(0),
        }
    }

    /// A scan is over, which began `elapsed_ms` after the one before and lasts to `end_ms`.
    pub(super) fn follow_stated(
        &mut self,
        all: &mut [Following],
        model: &'static Model,
        (elapsed_ms, end_ms): (u32, u32),
    ) -> Result<(), Failure> {
        if all.is_empty() {
            return Ok(());
        }
        // In STOP nothing is asked; with RUN, the program begins anew.
        if !self.is_running(0) {
            all.iter_mut().for_each(Following::restart);
            return Ok(());
        }
        let mut snapshot = Snapshot {
            model,
            bits: BTreeMap::new(),
            words: BTreeMap::new(),
            counters: BTreeMap::new(),
        };
        for setting in all.iter().flat_map(|of| of.stated.settings()) {
            snapshot.add(self, setting.target)?;
        }
        for following in all {
            if !following.watcher.happened(&snapshot, elapsed_ms) {
                continue;
            }
            let Stated {
                line,
                kind,
                text,
                property,
            } = following.stated;
            if property.is_wanted() {
                following.reached = true;
                continue;
            }
            let values = snapshot.values(property);
            let message = format!("`{text}` at {end_ms} ms: {values}");
            return Err(self.broken(*kind, *line, message));
        }
        Ok(())
    }

    /// The case is over.
    pub(super) fn end_stated(&self, all: &[Following]) -> Result<(), Failure> {
        let mut open = all
            .iter()
            .filter(|of| of.stated.property.is_wanted() && !of.reached);
        open.next().map_or(Ok(()), |of| {
            let message = format!("`{}` after no scan", of.stated.text);
            Err(self.broken(of.stated.kind, of.stated.line, message))
        })
    }
}

#[cfg(test)]
mod tests;
