//! `rungc check`.

pub(super) mod deep;
pub(super) mod draw;

use super::subject::{self, Subject};
use super::{
    Context, Failure, Result, conclude, counted, findings, fix, grouped, ports, properties,
    report_idle, unread, with_settings,
};
use crate::args::{CheckArgs, Properties};
use crate::report::Reporter;
use rungc::language::message;
use rungc_frontend::{Read, ReadError};
use rungc_lower::compile::{self, Compiled};
use rungc_models::Model;
use rungc_project::Error;
use rungc_sim::threads::Threads;
use rungc_syntax::{Device, DeviceClass, OperandKind, Parameters, Program};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Reports everything that is wrong with programs.
pub fn run(args: &CheckArgs, cx: Context) -> Result {
    let mut noted = BTreeSet::new();
    // Fixes are reported before the findings that they leave.
    let threads = match args.fix {
        true => Threads::ONE,
        false => Threads::usual(),
    };
    let prepare = |subject: &Subject| {
        let fixed = match args.fix {
            true => fix::fix(subject, cx),
            false => Ok(()),
        };
        fixed.map(|()| Checked::of(subject, args))
    };
    subject::each_in(
        threads,
        &args.inputs,
        cx,
        &prepare,
        |subject, checked, reporter| {
            let checked = match checked? {
                Ok(checked) => checked,
                Err(error) => return Err(unread(&error, subject, reporter)?),
            };
            let outcome = checked.report(subject, reporter, args, cx)?;
            if reporter.is_for_people()
                && let Some(path) = unapplied_properties(subject)
                && noted.insert(path.clone())
            {
                cx.note(&format!(
                "  Properties of {} apply to no program: name one with `program = \"…\"` in its `[project]`",
                path.display()
            ));
            }
            Ok(outcome)
        },
    )
}

/// Settings whose properties apply to no program, because they name none.
fn unapplied_properties(subject: &Subject) -> Option<PathBuf> {
    let project = subject.project.as_deref()?;
    let idle = project.program.is_none() && project.has_properties();
    idle.then(|| subject::near(project.path.clone()))
}

/// A program with all that is wrong with it, before it is reported.
struct Checked {
    read: Read,
    /// `Err`: the settings of the program cannot be applied to it.
    compiled: std::result::Result<Compiled, Error>,
    /// Findings of `--deep`.
    found: deep::Found,
    elapsed: Duration,
}

impl Checked {
    fn of(subject: &Subject, args: &CheckArgs) -> std::result::Result<Self, ReadError> {
        let start = Instant::now();
        let mut read = subject::source(subject)?;
        rungc::unproven::suggest(&mut read, subject.model);
        let completed = with_settings(subject, &mut read.program);
        let compiled = completed.map(|()| compile::check(&read.program, &subject.options()));
        let found = match &compiled {
            Ok(compiled) if args.deep && !findings(subject, &read, compiled).failed() => {
                deep::findings(subject, &read, compiled)
            }
            _ => deep::Found::default(),
        };
        Ok(Checked {
            read,
            compiled,
            found,
            elapsed: start.elapsed(),
        })
    }

    fn report(
        self,
        subject: &Subject,
        reporter: &mut Reporter,
        args: &CheckArgs,
        cx: Context,
    ) -> Result {
        let read = self.read;
        report_idle(subject, read.program.kind, reporter);
        let compiled = match self.compiled {
            Ok(compiled) => compiled,
            Err(error) => {
                subject::report_invalid(error, &subject.reporting, reporter)?;
                return Err(Failure::Reported);
            }
        };
        check_properties(subject, &read.program, reporter, cx)?;
        let mut findings = findings(subject, &read, &compiled);
        if self.found.open > 0 {
            let open = [("count", self.found.open.into())];
            cx.note(&message(findings.language(cx), "open", &open));
        }
        findings.add(self.found.diagnostics, &subject.reporting);
        if (args.draw || args.deep) && reporter.is_for_people() {
            findings.drawn = draw::networks(&read.program, compiled.model, &findings.diagnostics);
        }
        if let Some(parameters) = &read.program.parameters {
            cx.detail(|| parameter_lines(parameters, compiled.model));
        }
        for port in &compiled.ports {
            cx.detail(|| ports::line(port));
        }
        let language = findings.language(cx);
        let (name, model) = (findings.name(reporter.many()), compiled.model.name);
        let outcome = conclude(&findings, reporter, cx, || {
            let (model, elapsed) = (model.to_uppercase(), self.elapsed.as_millis().to_string());
            let arguments = [
                ("name", (&name).into()),
                ("model", (&model).into()),
                ("steps", (compiled.steps as usize).into()),
                ("devices", devices(&read.program).into()),
                ("elapsed", (&elapsed).into()),
            ];
            message(language, "checked", &arguments)
        })?;
        if !self.found.assumptions.is_empty() {
            cx.note(&message(language, "proved", &[]));
            for line in self.found.assumptions {
                cx.note(&format!("             - {line}"));
            }
        }
        Ok(outcome)
    }
}

/// Reports properties of the settings that `verify` could not decide.
fn check_properties(
    subject: &Subject,
    program: &Program,
    reporter: &mut Reporter,
    cx: Context,
) -> std::result::Result<(), Failure> {
    let properties = properties::Reader {
        args: &Properties::default(),
        subject,
        program,
        cx,
    };
    let mistakes = properties.mistakes();
    match subject.own_project() {
        Some(project) if mistakes.has_errors() => {
            let invalid = project.invalid(mistakes);
            subject::report_invalid(invalid, &subject.reporting, reporter)?;
            Err(Failure::Reported)
        }
        _ => Ok(()),
    }
}

/// PLC parameters of a project, as lines.
fn parameter_lines(parameters: &Parameters, model: &Model) -> String {
    let mut lines = Vec::new();
    if let (Some(capacity), Some(steps)) = (parameters.capacity, parameters.program_steps()) {
        let steps = steps.min(model.max_steps);
        let (capacity, steps) = (counted(capacity as usize, "step"), grouped(steps as usize));
        lines.push(format!(
            "      Memory {capacity}, of which {steps} for the program"
        ));
    }
    let blocks = parameters.file_register_blocks;
    if blocks > 0 {
        let last = 1000 + 500 * u64::from(blocks) - 1;
        lines.push(format!("       Files D1000 to D{last} are file registers"));
    }
    if model.latch_choices.is_empty() {
        let name = model.name;
        lines.push(format!(
            "     Latched as on every {name}, regardless of the parameters"
        ));
    } else if let Some(latched) = &parameters.latched {
        let runs: Vec<_> = latched
            .iter()
            .filter(|run| run.count > 0)
            .map(ToString::to_string)
            .collect();
        let none = runs.is_empty().then(|| "no choice".to_string());
        lines.push(format!("     Latched {}", none.unwrap_or(runs.join(", "))));
    }
    lines.join("\n")
}

/// Number of devices that the program names, without pointers and nesting levels.
fn devices(program: &Program) -> usize {
    let operands = program.instrs.iter().flat_map(|instr| &instr.operands);
    let named = operands.filter_map(|operand| match operand.kind {
        OperandKind::Device(device, _)
        | OperandKind::WordBit(device, ..)
        | OperandKind::Nibbles(_, device, _) => Some(device),
        _ => None,
    });
    let is_device =
        |d: &Device| !matches!(d.class, DeviceClass::P | DeviceClass::I | DeviceClass::N);
    BTreeSet::from_iter(named.filter(is_device)).len()
}
