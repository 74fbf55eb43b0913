//! Defaults from rungc.toml for the command line.

use super::Failure;
use super::subject::Subject;
use crate::args::{Emit, EngineChoice, Plan};
use crate::output::refuse_outside;
use clap::ValueEnum;
use rungc_firmware::target::{self, Target};
use rungc_project::{Error, Named, Project};
use rungc_syntax::diag;

/// Holds the names in a file to what there is.
pub fn check(project: &Project) -> Result<(), Error> {
    emit(project)?;
    engine(project)?;
    machine(project).map(|_| ())
}

fn unknown(project: &Project, name: &Named, what: &str, names: &[String]) -> Error {
    let near = diag::did_you_mean(&name.text, names.iter().map(String::as_str));
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("available: {}", names.join(", ")),
    };
    let message = format!("unknown {what} `{}`", name.text);
    project.error(name.error(message).help(help))
}

/// A choice of the command line, by its name there.
fn choice<T: ValueEnum>(
    project: &Project,
    name: Option<&Named>,
    what: &str,
) -> Result<Option<T>, Error> {
    let Some(name) = name else { return Ok(None) };
    T::from_str(&name.text, false).map(Some).map_err(|_| {
        let values = T::value_variants().iter();
        let names: Vec<_> = values
            .filter_map(|value| Some(value.to_possible_value()?.get_name().to_string()))
            .collect();
        unknown(project, name, what, &names)
    })
}

fn emit(project: &Project) -> Result<Option<Emit>, Error> {
    choice(project, project.build.emit.as_ref(), "form to emit")
}

/// Engine for test files.
pub fn engine(project: &Project) -> Result<Option<EngineChoice>, Error> {
    choice(project, project.test.engine.as_ref(), "engine")
}

fn machine(project: &Project) -> Result<Option<&'static Target>, Error> {
    let Some(name) = &project.build.target else {
        return Ok(None);
    };
    target::find(&name.text).map(Some).ok_or_else(|| {
        let names: Vec<_> = target::ALL.iter().map(|t| t.triple.to_string()).collect();
        unknown(project, name, "target", &names)
    })
}

/// The plan of a command line, completed by the settings for a program.
pub fn plan(plan: &Plan, subject: &Subject) -> Result<Plan, Failure> {
    let mut plan = plan.clone();
    let because = |error: Error| Failure::Because(error.to_string());
    if let Some(project) = &subject.project {
        let usual = emit(project).map_err(because)?;
        if plan.emit.is_none() && !plan.report {
            plan.emit = usual;
        }
        let as_usual = plan.emit == usual || plan.emit.is_none();
        if plan.board.is_none() && (as_usual || plan.emit.is_some_and(Emit::is_image)) {
            let board = project.build.board.as_deref();
            plan.board = board.map(|board| project.at(board));
        }
        plan.device_access |= project.build.access
            && plan.board.is_none()
            && plan.emit.is_some_and(Emit::has_headers);
        if plan.target.is_none() && plan.emit != Some(Emit::Ir) {
            plan.target = machine(project).map_err(because)?;
        }
    }
    if let Some(project) = subject.own_project() {
        if plan.name.is_none() {
            plan.name.clone_from(&project.name);
        }
        if plan.output.is_none() && plan.emit == emit(project).map_err(because)? {
            let output = project.build.output.as_deref();
            if let Some(output) = output.map(|output| project.at(output)) {
                refuse_outside(project, "[build] output", &output, &plan.allow_folder)?;
                plan.output = Some(output.into());
            }
        }
    }
    if plan.emit.is_none() && !plan.report {
        let why = "nothing to build: use --emit, or --report to measure only, or set `emit` in `[build]` of rungc.toml";
        return Err(Failure::Because(why.to_string()));
    }
    if plan.board.is_none() && (!plan.set.is_empty() || plan.duration.is_some()) {
        let why = "--set and --for only apply to images; name a board with --board";
        return Err(Failure::Because(why.to_string()));
    }
    Ok(plan)
}
