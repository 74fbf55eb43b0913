//! Rules over time: `never`, `whenever`, `within` and `until`.

use super::format::Reader;
use super::raw::{RawCondition, RawRules, RawStays, RawWhenever, RawWithin};
use super::runner::Running;
use super::stated::{Following, Stated};
use super::{Failure, Setting, Step};
use crate::property::{Deadline, Property};
use rungc_models::{Model, ModelId};
use std::fmt;
use toml::Spanned;

/// Rules that must hold after each scan.
#[derive(Clone, Debug, Default)]
pub struct Rules {
    /// Conditions that must never hold.
    pub never: Vec<Never>,
    /// Conditions that must be followed by others.
    pub whenever: Vec<Whenever>,
    /// Rules whose conditions are texts.
    pub stated: Vec<Stated>,
}

/// After no scan, all of this holds at once.
#[derive(Clone, Debug)]
pub struct Never {
    /// Its line in the file, from 1.
    pub line: u32,
    /// Condition that must not hold.
    pub all: Vec<Setting>,
}

/// A condition that must be followed by another, after the same scan or after one at most this much later.
#[derive(Clone, Debug)]
pub struct Whenever {
    /// Its line in the file, from 1.
    pub line: u32,
    /// Triggering condition.
    pub when: Vec<Setting>,
    /// Condition that must follow.
    pub then: Vec<Setting>,
    /// Time limit in milliseconds; 0 for the same scan.
    pub within_ms: u32,
}

/// After a scan of the first milliseconds of a step, all of this holds.
#[derive(Clone, Debug)]
pub struct Within {
    /// Its line in the file, from 1.
    pub line: u32,
    /// Number of milliseconds.
    pub ms: u32,
    /// Condition that must come to hold.
    pub all: Vec<Setting>,
}

/// The rules there are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RuleKind {
    /// [`Never`].
    Never,
    /// [`Whenever`].
    Whenever,
    /// [`Within`].
    Within,
    /// [`Step::until`].
    Until,
    /// [`Property::Always`].
    Always,
    /// [`Property::Reachable`].
    Reachable,
    /// [`Property::Stays`].
    Stays,
}

impl RuleKind {
    /// Its name in files and reports.
    pub const fn name(self) -> &'static str {
        match self {
            RuleKind::Never => "never",
            RuleKind::Whenever => "whenever",
            RuleKind::Within => "within",
            RuleKind::Until => "until",
            RuleKind::Always => "always",
            RuleKind::Reachable => "reachable",
            RuleKind::Stays => "stays",
        }
    }
}

impl Rules {
    /// Adds others.
    pub(super) fn extend(&mut self, others: &Rules) {
        self.never.extend(others.never.iter().cloned());
        self.whenever.extend(others.whenever.iter().cloned());
        self.stated.extend(others.stated.iter().cloned());
    }

    fn is_empty(&self) -> bool {
        self.never.is_empty() && self.whenever.is_empty() && self.stated.is_empty()
    }

    /// All that the rules look at.
    pub fn settings(&self) -> impl Iterator<Item = Setting> {
        let never = self.never.iter().flat_map(|never| &never.all);
        let whenever = self
            .whenever
            .iter()
            .flat_map(|w| w.when.iter().chain(&w.then));
        let stated = self.stated.iter().flat_map(Stated::settings);
        never.chain(whenever).cloned().chain(stated)
    }
}

impl Step {
    /// All that the step compares with what devices hold.
    pub fn compared(&self) -> impl Iterator<Item = Setting> {
        let within = self.within.iter().flat_map(|within| &within.all);
        let at_end = self.expect.iter().chain(&self.until);
        let at_end = at_end.chain(within).cloned();
        at_end.chain(self.rules.settings())
    }

    /// Returns true if a rule is checked after each scan.
    fn watches(&self) -> bool {
        !self.within.is_empty() || !self.rules.is_empty()
    }
}

/// Rules as the file has them.
#[derive(Default)]
pub(super) struct RawOverTime {
    pub(super) never: Option<Spanned<RawRules>>,
    pub(super) always: Option<Spanned<RawRules>>,
    pub(super) reachable: Option<Spanned<RawRules>>,
    pub(super) whenever: Vec<Spanned<RawWhenever>>,
    pub(super) stays: Vec<Spanned<RawStays>>,
}

/// Reading.
impl Reader<'_> {
    /// Rules that must hold after each scan.
    pub(super) fn rules(&mut self, raw: RawOverTime) -> Rules {
        let (mut stated, tables) = self.stated(RuleKind::Never, raw.never, Property::Never);
        let never = tables.into_iter().filter_map(|raw| {
            let at = raw.span().start;
            let RawCondition::Table(table) = raw.into_inner() else {
                return None;
            };
            let all = self.expected(table);
            let line = self.line(at);
            self.some(at, all).map(|all| Never { line, all })
        });
        let never = never.collect();
        stated.extend(self.texts(RuleKind::Always, raw.always, Property::Always));
        stated.extend(self.texts(RuleKind::Reachable, raw.reachable, Property::Reachable));
        stated.extend(raw.stays.into_iter().filter_map(|raw| self.staying(raw)));
        let mut rules = Rules {
            never,
            whenever: Vec::new(),
            stated,
        };
        for raw in raw.whenever {
            // What is wrong was reported.
            let _ = self.whenever(raw, &mut rules);
        }
        rules
    }

    /// Adds a condition that must be followed by another: both are texts, or both are tables.
    fn whenever(&mut self, raw: Spanned<RawWhenever>, rules: &mut Rules) -> Option<()> {
        let at = raw.span().start;
        let raw = raw.into_inner();
        let (line, within_ms) = (self.line(at), self.limit(&raw)?);
        let ends = [raw.when, raw.then].map(|end| (end.span().start, end.into_inner()));
        match ends {
            [
                (when_at, RawCondition::Text(when)),
                (then_at, RawCondition::Text(then)),
            ] => {
                let (when, then) = ((when.as_str(), when_at), (then.as_str(), then_at));
                rules
                    .stated
                    .push(self.followed(line, when, then, within_ms)?);
            }
            [
                (_, RawCondition::Table(when)),
                (_, RawCondition::Table(then)),
            ] => {
                let (when, then) = (self.expected(when), self.expected(then));
                rules.whenever.push(Whenever {
                    line,
                    when: self.some(at, when)?,
                    then: self.some(at, then)?,
                    within_ms,
                });
            }
            [_, (then_at, _)] => {
                let message = "write `when` and `then` both as texts, or both as tables";
                self.report(then_at, message.to_string());
            }
        }
        Some(())
    }

    /// Condition that must come to hold while a step runs.
    pub(super) fn within(&mut self, raw: Spanned<RawWithin>) -> Option<Within> {
        let at = raw.span().start;
        let raw = raw.into_inner();
        let (ms, all) = (self.count(&raw.ms)?, self.expected(raw.expect));
        Some(Within {
            line: self.line(at),
            ms,
            all: self.some(at, all)?,
        })
    }

    /// Reports that nothing is named.
    fn some(&mut self, at: usize, all: Vec<Setting>) -> Option<Vec<Setting>> {
        if all.is_empty() {
            self.report(at, "name at least one device here".to_string());
            return None;
        }
        Some(all)
    }
}

/// State of the rules while a case runs.
pub(super) struct Watch<'c> {
    /// The rules of the case and, at the end, those of the step.
    never: Vec<&'c Never>,
    whenever: Vec<(&'c Whenever, Deadline)>,
    stated: Vec<Following<'c>>,
    /// Number of the case's rules among them.
    of_case: (usize, usize, usize),
    /// Conditions that have not come to hold in the running step.
    within: Vec<&'c Within>,
    /// The model of the case's PLC.
    model: ModelId,
    /// When the last scan that was judged began.
    last_ms: u32,
}

impl<'c> Watch<'c> {
    /// For a case with these rules.
    pub(super) fn new(rules: &'c Rules, model: ModelId) -> Self {
        let whenever = rules.whenever.iter();
        Watch {
            never: rules.never.iter().collect(),
            whenever: whenever.map(|w| (w, Deadline::default())).collect(),
            stated: rules.stated.iter().map(Following::new).collect(),
            of_case: (rules.never.len(), rules.whenever.len(), rules.stated.len()),
            within: Vec::new(),
            model,
            last_ms: 0,
        }
    }

    /// A step begins.
    pub(super) fn begin(&mut self, step: &'c Step) {
        self.never.truncate(self.of_case.0);
        self.whenever.truncate(self.of_case.1);
        self.stated.truncate(self.of_case.2);
        if step.power_cycle {
            self.last_ms = 0;
            self.whenever
                .iter_mut()
                .for_each(|(_, deadline)| *deadline = Deadline::default());
            self.stated.iter_mut().for_each(Following::restart);
        }
        if step.watches() {
            self.never.extend(&step.rules.never);
            let whenever = step.rules.whenever.iter();
            self.whenever
                .extend(whenever.map(|w| (w, Deadline::default())));
            self.stated
                .extend(step.rules.stated.iter().map(Following::new));
        }
        self.within = step.within.iter().collect();
    }

    fn is_idle(&self) -> bool {
        self.never.is_empty()
            && self.whenever.is_empty()
            && self.stated.is_empty()
            && self.within.is_empty()
    }
}

/// Devices and values, for a message.
struct All<'a, 'e>(&'a Running<'e>, &'a [Setting]);

impl fmt::Display for All<'_, '_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, setting) in self.1.iter().enumerate() {
            let comma = if i == 0 { "" } else { ", " };
            let name = self.0.name_of(setting.plc, setting.target);
            write!(f, "{comma}{name} = {}", setting.value)?;
            if let Some(tolerance) = setting.tolerance {
                write!(f, " ± {tolerance}")?;
            }
        }
        Ok(())
    }
}

impl Running<'_> {
    /// Returns true if all of it holds now.
    pub(super) fn holds(&mut self, all: &[Setting]) -> Result<bool, Failure> {
        for setting in all {
            if self.differs(setting)?.is_some() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    pub(super) fn broken(&self, kind: RuleKind, line: u32, message: String) -> Failure {
        Failure::Rule {
            step: self.step,
            line,
            kind,
            message,
        }
    }

    /// Differences from the expectation, as a sentence.
    fn differences(&mut self, all: &[Setting]) -> Result<String, Failure> {
        let mut texts = Vec::new();
        for setting in all {
            if let Some(actual) = self.differs(setting)? {
                texts.push(format!(
                    "{} is {actual}",
                    self.name_of(setting.plc, setting.target)
                ));
            }
        }
        Ok(texts.join(", "))
    }

    /// Judges what a scan has left, which began at `begin_ms` and takes `scan_ms`: before the time until the next one
    /// passes, in which inputs change and interrupts are taken.
    pub(super) fn judge(
        &mut self,
        watch: &mut Watch,
        begin_ms: u32,
        scan_ms: u32,
    ) -> Result<(), Failure> {
        if watch.is_idle() {
            return Ok(());
        }
        let end_ms = begin_ms.wrapping_add(scan_ms);
        for never in &watch.never {
            if self.holds(&never.all)? {
                let message = format!("{} at {end_ms} ms", All(self, &never.all));
                return Err(self.broken(RuleKind::Never, never.line, message));
            }
        }
        let elapsed_ms = begin_ms.wrapping_sub(std::mem::replace(&mut watch.last_ms, begin_ms));
        for (whenever, deadline) in &mut watch.whenever {
            self.follow(whenever, deadline, (elapsed_ms, end_ms))?;
        }
        let model = Model::get(watch.model);
        self.follow_stated(&mut watch.stated, model, (elapsed_ms, end_ms))
    }

    /// Looks for what a step that began at `begin_ms` waits for, once a scan and its time are over.
    pub(super) fn wait(&mut self, watch: &mut Watch, begin_ms: u32) -> Result<(), Failure> {
        let now_ms = self.now_ms();
        let mut open = Vec::new();
        for within in std::mem::take(&mut watch.within) {
            let waited_ms = now_ms.wrapping_sub(begin_ms);
            if waited_ms > within.ms {
                return Err(self.late(within)?);
            }
            if self.holds(&within.all)? {
                continue;
            }
            if waited_ms == within.ms {
                return Err(self.late(within)?);
            }
            open.push(within);
        }
        watch.within = open;
        Ok(())
    }

    fn late(&mut self, within: &Within) -> Result<Failure, Failure> {
        let differences = self.differences_at(&within.all, self.now_ms())?;
        let message = format!(
            "not {} within {} ms: {differences}",
            All(self, &within.all),
            within.ms
        );
        Ok(self.broken(RuleKind::Within, within.line, message))
    }

    /// Differences from the expectation, or that it holds too late.
    fn differences_at(&mut self, all: &[Setting], ms: u32) -> Result<String, Failure> {
        let differences = self.differences(all)?;
        Ok(match differences.is_empty() {
            true => format!("it holds at {ms} ms"),
            false => differences,
        })
    }

    fn follow(
        &mut self,
        rule: &Whenever,
        deadline: &mut Deadline,
        (elapsed_ms, end_ms): (u32, u32),
    ) -> Result<(), Failure> {
        let state = (self.holds(&rule.when)?, self.holds(&rule.then)?);
        let waited_ms = deadline
            .waited_ms()
            .map_or(0, |ms| ms + u64::from(elapsed_ms));
        if !deadline.is_missed(state, rule.within_ms, elapsed_ms) {
            return Ok(());
        }
        let soon = match rule.within_ms {
            0 => "after the same scan".to_string(),
            ms => format!("within {ms} ms"),
        };
        let since_ms = u64::from(end_ms).saturating_sub(waited_ms);
        let differences = self.differences_at(&rule.then, end_ms)?;
        let message = format!(
            "{} at {since_ms} ms, but not {} {soon}: {differences}",
            All(self, &rule.when),
            All(self, &rule.then),
        );
        Err(self.broken(RuleKind::Whenever, rule.line, message))
    }

    /// The case is over.
    pub(super) fn end_case(&self, watch: &Watch) -> Result<(), Failure> {
        self.end_stated(&watch.stated)
    }

    /// A step is over.
    pub(super) fn end_watch(
        &mut self,
        watch: &Watch,
        step: &Step,
        ended: bool,
    ) -> Result<(), Failure> {
        if let Some(within) = watch.within.first() {
            return Err(self.late(within)?);
        }
        if step.until.is_empty() || ended {
            return Ok(());
        }
        let differences = self.differences(&step.until)?;
        let ms = match step.run {
            super::Run::Ms(ms) => ms,
            super::Run::Scans(scans) => scans.saturating_mul(step.scan_ms),
        };
        let message = format!(
            "not {} after {ms} ms: {differences}",
            All(self, &step.until)
        );
        Err(self.broken(RuleKind::Until, step.line, message))
    }
}
