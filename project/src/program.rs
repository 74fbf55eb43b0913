//! Settings for a program: the devices that its PLC retains over power-off, and the ranges of its indexes.

use crate::{Error, Label, Project, Range};
use rungc_catalogue::Basic;
use rungc_lower::compile::Bound;
use rungc_models::Model;
use rungc_syntax::{Device, DeviceRun, Instr, Program, Span, codes};
use std::collections::BTreeSet;
use std::path::Path;

impl Project {
    /// Ranges of operands with an index in a program, if it is the program of the project.
    pub fn bounds(&self, file: &Path) -> Vec<Bound> {
        let bounds = self.index.iter().filter(|_| self.is_about(file));
        let bound = |bound: &crate::Bound| Bound {
            device: Device {
                class: bound.class,
                number: bound.number,
            },
            index: bound.index,
            first: bound.first,
            last: bound.last,
        };
        bounds.map(bound).collect()
    }

    /// Gives the program of `file` the latched devices and special modules of the settings and, if the project is about
    /// it, the Modbus table, CANlink and labels, which replace comments. What the model does not have is a mistake.
    pub fn complete(&self, file: &Path, program: &mut Program, model: &Model) -> Result<(), Error> {
        self.check_served(model)?;
        self.check_io(model)?;
        self.fit_modules(program, model)?;
        if self.is_about(file) {
            self.add_table(program, model)?;
            self.add_station(program, model)?;
            let panels = self.hmi.iter().chain(&self.hmi_reads);
            for range in panels.chain(&self.verify.free) {
                self.exists(range, model)?;
            }
            self.add_external(program);
            for Label { device, span, .. } in &self.labels {
                self.exists(&Range::one(*device, *span), model)?;
            }
            self.name_devices(file, program);
        }
        if self.latched.is_empty() {
            return Ok(());
        }
        for run in &self.latched {
            self.can_latch(run, model)?;
        }
        let named: BTreeSet<_> = self.latched.iter().map(|run| run.class).collect();
        let parameters = program.parameters.get_or_insert_default();
        let others = parameters.latched.take().unwrap_or_else(|| usual(model));
        let others = others.into_iter().filter(|run| !named.contains(&run.class));
        let own = self.latched.iter().map(Range::run);
        parameters.latched = Some(own.chain(others).collect());
        Ok(())
    }

    /// Gives devices of the program of `file` the names of `[labels]`, in place of their comments.
    pub fn name_devices(&self, file: &Path, program: &mut Program) {
        if !self.labels.is_empty() && self.is_about(file) {
            let labels = self.labels.iter();
            let names = labels.map(|label| (label.device, label.name.clone()));
            program.comments.extend(names);
        }
    }

    /// Adds instructions to the end of the main program. A program without an end is not compiled.
    pub(crate) fn add_at_end(
        &self,
        program: &mut Program,
        instrs: impl FnOnce(Span) -> Vec<Instr>,
    ) {
        let ends = |instr: &Instr| {
            let basic = rungc_catalogue::find(&instr.mnemonic).and_then(|found| found.inst.basic());
            matches!(basic, Some(Basic::Fend | Basic::End))
        };
        let Some(end) = program.instrs.iter().position(ends) else {
            return;
        };
        let span = program.instrs[end].span;
        program.instrs.splice(end..end, instrs(span));
    }

    fn can_latch(&self, run: &Range, model: &Model) -> Result<(), Error> {
        let fits = |number| {
            let fixed = model.range(run.class, number);
            model.can_choose_latch(run.class, number) || fixed.is_some_and(|range| range.latched)
        };
        let device = |number| Device {
            class: run.class,
            number,
        };
        let Some(wrong) = (run.first..=run.last).find(|&number| !fits(number)) else {
            return Ok(());
        };
        let message = format!("{} cannot be latched on {}", device(wrong), model.title);
        let choices = model.latch_choices.iter().filter(|c| c.0 == run.class);
        let choices: Vec<_> = choices
            .map(|&(_, first, last)| format!("{} to {}", device(first), device(last)))
            .collect();
        let help = match choices.is_empty() {
            true => format!("the {} of this model cannot be chosen", run.class.prefix()),
            false => format!("choose among {}", choices.join(", ")),
        };
        let why = codes::PROJECT_VALUE.at(run.span, message);
        Err(self.error(why.help(help)))
    }
}

/// The latched devices of a model for which that can be chosen.
fn usual(model: &Model) -> Vec<DeviceRun> {
    let latched = model.ranges.iter().filter(|range| range.latched);
    let choices = latched.flat_map(|range| {
        let choices = model.latch_choices.iter();
        choices
            .filter(|c| c.0 == range.class)
            .map(|&(class, first, last)| {
                let (first, last) = (first.max(range.first), last.min(range.last));
                DeviceRun {
                    class,
                    first,
                    count: (last + 1).saturating_sub(first),
                }
            })
    });
    choices.filter(|run| run.count > 0).collect()
}
