//! The special modules of a case, and the signals at their channels.

use super::format::Reader;
use super::runner::Running;
use super::{Case, CaseProgram, Failure};
use crate::protocol::{Answer, Request};
use crate::target::{self, Channel};
use rungc_rt::modules::{KINDS, Kind};
use rungc_syntax::{FittedModule, Program, diag};
use std::borrow::Cow;
use std::collections::BTreeMap;
use toml::Spanned;

/// Modules as a file names them: kinds by numbers.
pub(super) type Raw = BTreeMap<Spanned<String>, Spanned<String>>;

/// Millionths in a whole.
pub(super) const MILLION: f64 = 1e6;

impl Reader<'_> {
    /// The modules of a file or case.
    pub(super) fn modules(&mut self, raw: Raw) -> Vec<(u16, &'static Kind)> {
        let mut modules = Vec::new();
        for (unit, name) in raw {
            let Some(number) = target::unit(unit.get_ref()) else {
                let message = format!("`{}` is not the number of a module", unit.get_ref());
                self.report(unit.span().start, message);
                continue;
            };
            match Kind::find(name.get_ref()) {
                Some(kind) => modules.push((number, kind)),
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
        modules
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
            pins: Vec::new(),
        });
        program.parameters.get_or_insert_default().modules = fitted.collect();
        Cow::Owned(program)
    }

    /// The modules that are fitted to its PLC: those of the file or case, else those of the settings of its program.
    pub(super) fn fitted(&self) -> Vec<(u16, &'static Kind)> {
        let CaseProgram::File(file) = &self.program else {
            return self.modules.clone();
        };
        let parameters = file.read.program.parameters.as_ref();
        let of_settings = parameters.map_or(&[][..], |parameters| &parameters.modules);
        let own = self.modules.iter().copied();
        let others = of_settings.iter();
        let others = others.filter(|module| self.modules.iter().all(|own| own.0 != module.unit));
        let others = others.filter_map(|module| Some((module.unit, Kind::find(module.kind)?)));
        own.chain(others).collect()
    }
}

impl Running<'_> {
    /// Fits the modules of the case to its PLC.
    pub(super) fn fit(&mut self, modules: &[(u16, &'static Kind)]) -> Result<(), Failure> {
        self.select(0)?;
        for (unit, kind) in modules {
            self.insist(Request::Fit(*unit, kind.index()))?;
        }
        Ok(())
    }

    /// Connects a signal to a channel; false if there is no such input.
    pub(super) fn connect_channel(
        &mut self,
        channel: Channel,
        millionths: i32,
    ) -> Result<bool, Failure> {
        let answer = self.ask(Request::SetSignal {
            now_ms: self.now_ms(),
            channel,
            millionths,
        })?;
        Ok(answer != Answer::Missing)
    }
}

/// A value in millionths.
pub(super) fn millionths(value: f64) -> i32 {
    (value * MILLION).round() as i32
}
