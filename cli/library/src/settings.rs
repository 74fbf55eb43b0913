//! What a `rungc.toml` says about reading, checking and compiling a program.

use crate::Error;
use rungc_frontend::{ReadOptions, is_project, programs};
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::Plc;
use rungc_project::serve::Serve;
use rungc_project::{Check, Project as Settings};
use rungc_syntax::{Device, DeviceClass, Program, codes};
use std::path::{Path, PathBuf};

/// Options for reading: what `given` asks for takes precedence.
pub fn reading(settings: &Settings, mut given: ReadOptions) -> ReadOptions {
    let usual = settings.reading();
    given.learned = usual.learned;
    given.compiled_state = usual.compiled_state;
    given.parts = usual.parts;
    given.encoding = given.encoding.or(usual.encoding);
    let names = std::mem::replace(&mut given.names, usual.names);
    given.names.devices.extend(names.devices);
    given.names.free.splice(0..0, names.free);
    given
}

/// The PLC that `[project] model` names.
pub fn plc(settings: &Settings) -> Option<Plc> {
    Some(Plc {
        model: settings.model?,
        variant: settings.variant,
    })
}

/// `[check]`, and what other settings allow: a program that is served over Ethernet has its card.
pub fn rules(settings: &Settings) -> Check {
    let mut rules = settings.check.clone();
    if !settings.serve.modbus_tcp.is_empty() || settings.has_server_requests() {
        rules.allow.push(codes::ETHERNET_CARD.id);
    }
    rules
}

/// `[retain] fault`: the bit that is on while latched devices cannot be saved.
pub fn unsaved(settings: &Settings) -> Option<(DeviceClass, u32)> {
    let fault = settings.retain_fault.as_ref()?;
    Some((fault.class, fault.first))
}

/// Returns true if the settings say that something outside writes a device while the program runs: a panel, a
/// connection, a client.
pub fn is_written_outside(settings: Option<&Settings>, device: Device) -> bool {
    let written = settings.map(Settings::written_externally);
    written.into_iter().flatten().any(|(_, run)| {
        let numbers = run.first..run.first + run.count;
        run.class == device.class && numbers.contains(&device.number)
    })
}

/// Options for compiling `file` for a PLC, if one is chosen. Errors with the codes `warn` are warnings.
pub fn compiling(
    settings: Option<&Settings>,
    file: &Path,
    plc: Option<Plc>,
    warn: &[&'static str],
) -> CompileOptions {
    let rules = settings.map(|settings| &settings.check.warn);
    let served = settings.map(|settings| &settings.serve);
    let served = served.into_iter().flat_map(Serve::stored);
    CompileOptions {
        model: plc.map(|plc| plc.model),
        variant: plc.and_then(|plc| plc.variant),
        observe: served.chain(settings.and_then(unsaved)).collect(),
        warn: warn
            .iter()
            .chain(rules.into_iter().flatten())
            .copied()
            .collect(),
        bounds: settings.map_or_else(Vec::new, |settings| settings.bounds(file)),
        ..CompileOptions::default()
    }
}

/// Gives a program that was read from `file` what its settings say of it.
///
/// # Errors
/// Settings that the model does not have.
pub fn complete(
    settings: &Settings,
    file: &Path,
    program: &mut Program,
    plc: Option<Plc>,
) -> Result<(), rungc_project::Error> {
    let options = CompileOptions {
        model: plc.map(|plc| plc.model),
        ..CompileOptions::default()
    };
    let model = compile::model(program, &options);
    settings.complete(file, program, model)
}

/// The program that a folder stands for: the one that its own settings name, else the only one in it. A path that is
/// not a folder, or a folder without programs, is itself.
///
/// # Errors
/// Several programs, of which nothing names one; a program that the settings name and that is not there.
pub fn program_in(folder: &Path, own: Option<&Settings>) -> Result<PathBuf, Error> {
    if !folder.is_dir() {
        return Ok(folder.to_owned());
    }
    let named = own.and_then(|settings| Some((settings, settings.program.as_deref()?)));
    if let Some((settings, program)) = named {
        return match settings.absent(program, settings.program_span) {
            Some(absent) => Err(absent.into()),
            None => Ok(folder.join(program)),
        };
    }
    if is_project(folder) {
        return Ok(folder.to_owned());
    }
    match &programs_in(folder)?[..] {
        [] => Ok(folder.to_owned()),
        [one] => Ok(one.clone()),
        [one, other, ..] => {
            let [one, other] = [one, other].map(|path| path.display().to_string());
            Err(Error::SeveralPrograms {
                folder: folder.to_owned(),
                one,
                other,
            })
        }
    }
}

/// The programs in a folder and below, named as a shell would.
///
/// # Errors
/// A folder that cannot be searched.
pub fn programs_in(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let found = programs(folder, usize::MAX).map_err(|error| Error::Search {
        folder: folder.to_owned(),
        error,
    })?;
    let named = |path: PathBuf| path.strip_prefix(".").map_or(path.clone(), Path::to_owned);
    Ok(found.into_iter().map(named).collect())
}
