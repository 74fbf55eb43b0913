//! The special modules of a case, and the signals at their channels.

use super::format::Reader;
use super::runner::Running;
use super::{Case, CaseProgram, Failure};
use crate::protocol::{Answer, Request};
use crate::target::{self, Channel};
use rungc_rt::modules::{self, BOARD, KINDS, Kind};
use rungc_syntax::{FittedModule, Program, diag};
use std::borrow::Cow;
use std::collections::BTreeMap;
use toml::Spanned;

/// Modules as a file names them: kinds by numbers.
pub(super) type Raw = BTreeMap<Spanned<String>, Spanned<String>>;

/// Millionths in a whole.
pub(super) const MILLION: f64 = 1e6;

impl Reader<'_> {
    /// Modules, and after how many milliseconds they answer.
    pub(super) fn delays(&mut self, raw: RawDelays) -> Vec<(u16, u16)> {
        let delays = raw.into_iter();
        delays
            .filter_map(|(unit, ms)| Some((self.unit(&unit)?, ms)))
            .collect()
    }

    /// The number of a module.
    fn unit(&mut self, name: &Spanned<String>) -> Option<u16> {
        let unit = target::unit(name.get_ref());
        if unit.is_none() {
            let message = format!("`{}` is not the number of a module", name.get_ref());
            self.report(name.span().start, message);
        }
        unit
    }

    /// The modules of a file or case.
    pub(super) fn modules(&mut self, raw: Raw) -> Vec<(u16, &'static Kind)> {
        let mut fitted = Vec::new();
        for (unit, name) in raw {
            let Some(number) = self.unit(&unit) else {
                continue;
            };
            match Kind::find(name.get_ref()) {
                Some(kind) if kind.place.named().contains(&number) == (number >= BOARD) => {
                    fitted.push((number, kind));
                }
                Some(kind) => {
                    let own = kind.place.named().iter();
                    let own: Vec<_> = own.filter_map(|&unit| modules::name(unit)).collect();
                    let places = match &own[..] {
                        [] => "a number".to_owned(),
                        names => names.join(" or "),
                    };
                    let (name, unit_name) = (kind.name, unit.get_ref());
                    let message = format!("{name} is at {places}, not at `{unit_name}`");
                    self.report(unit.span().start, message);
                }
                None => {
                    let upper = name.get_ref().to_uppercase();
                    let near = diag::did_you_mean(&upper, KINDS.iter().map(|kind| kind.name));
                    let near =
                        near.map_or(String::new(), |near| format!(": did you mean `{near}`?"));
                    let message = format!("unknown module `{}`{near}", name.get_ref());
                    self.report(name.span().start, message);
                }
            }
        }
        fitted
    }
}

impl Case {
    /// A program for a PLC with the modules of the case.
    pub(super) fn with_modules<'p>(&self, program: &'p Program) -> Cow<'p, Program> {
        if self.modules.is_empty() {
            return Cow::Borrowed(program);
        }
        let mut program = program.clone();
        let fitted = self.fitted().into_iter();
        let fitted = fitted.map(|(unit, kind)| FittedModule {
            unit,
            kind: kind.name,
            delay_ms: 0,
            pins: Vec::new(),
        });
        program.parameters.get_or_insert_default().modules = fitted.collect();
        Cow::Owned(program)
    }

    /// The modules that are fitted to its PLC: those of the file or case, else those of the settings of its program.
    pub(super) fn fitted(&self) -> Vec<(u16, &'static Kind)> {
        let own = self.modules.iter().copied();
        let others = self.of_settings().iter();
        let others = others.filter(|module| self.modules.iter().all(|own| own.0 != module.unit));
        let others = others.filter_map(|module| Some((module.unit, Kind::find(module.kind)?)));
        own.chain(others).collect()
    }

    /// The modules that the settings of its program fit.
    pub(super) fn of_settings(&self) -> &[FittedModule] {
        match &self.program {
            CaseProgram::File(file) => {
                let parameters = file.read.program.parameters.as_ref();
                parameters.map_or(&[], |parameters| &parameters.modules)
            }
            _ => &[],
        }
    }
}

impl Running<'_> {
    /// Fits the modules of a case to its PLC.
    pub(super) fn fit(&mut self, case: &Case) -> Result<(), Failure> {
        self.select(0)?;
        for (unit, kind) in case.fitted() {
            self.insist(Request::Fit(unit, kind.index()))?;
        }
        let slow = case.of_settings().iter();
        let slow = slow.filter(|module| module.delay_ms > 0);
        self.delay_modules(slow.map(|module| (module.unit, module.delay_ms)))
    }

    /// Modules of the PLC that is selected answer after this many milliseconds from now on.
    pub(super) fn delay_modules(
        &mut self,
        mut modules: impl Iterator<Item = (u16, u16)>,
    ) -> Result<(), Failure> {
        modules.try_for_each(|(unit, ms)| self.insist(Request::DelayModule(unit, ms)))
    }

    /// Connects a signal to a channel; false if there is no such input.
    pub(super) fn connect_channel(
        &mut self,
        channel: Channel,
        millionths: i32,
    ) -> Result<bool, Failure> {
        let answer = self.execute(Request::SetSignal {
            now_ms: self.now_ms(),
            channel,
            millionths,
        })?;
        Ok(answer != Answer::Missing)
    }
}

/// Times after which modules answer as a file gives them, in milliseconds: modules by numbers.
pub(super) type RawDelays = BTreeMap<Spanned<String>, u16>;

/// A value in millionths.
pub(super) fn millionths(value: f64) -> i32 {
    (value * MILLION).round() as i32
}
