//! `[io]`: what terminals and registers of a running program are connected to.

use super::super::subject::{self, Subject};
use super::super::{Context, Failure, eprint_line};
use crate::args::ServeArgs;
use crate::output::{refuse_inputs, refuse_outside};
use rungc_host::io::{Connection, End, Io, Kind, holds_numbers};
use rungc_interp::{Machine, rt_class};
use rungc_ir::Module;
use rungc_project::Project;
use rungc_rt::VirtualHal;
use rungc_sim::plant::Description;
use rungc_syntax::DeviceClass;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The settings whose `[io]` a run uses: those that `--io` names, or those of its project when it is served.
pub fn settings(
    args: &ServeArgs,
    subject: &Subject,
    cx: Context,
) -> Result<Option<Arc<Project>>, Failure> {
    match &args.io {
        Some(path) => {
            let project = subject::load(path, &subject.reporting, cx)?;
            if project.io.is_empty() {
                let path = path.display();
                let why = format!("--io {path}: there is no table `[io.NAME]`");
                return Err(Failure::Because(why));
            }
            Ok(Some(Arc::new(project)))
        }
        None if args.of_project => Ok(subject.project.clone()),
        None => Ok(None),
    }
}

/// The connections of these settings, held to the model and to the simulated machine.
pub fn connections(
    settings: Option<Arc<Project>>,
    subject: &Subject,
    (module, machine): (&Module, Option<&Description>),
    args: &ServeArgs,
    cx: Context,
) -> Result<Vec<Connection>, Failure> {
    let Some(settings) = settings else {
        return Ok(Vec::new());
    };
    let checked = settings.check_io(module.model);
    checked.map_err(|error| subject::refuse(error, &subject.reporting, cx))?;
    let connections = settings.connections();
    if let Some(machine) = machine {
        let inputs = connections
            .iter()
            .flat_map(|connection| connection.directed(true));
        let mut inputs = inputs.filter(|row| Some(row.class) == rt_class(DeviceClass::X));
        let driven = inputs.find_map(|row| {
            let mut numbers = row.first..row.first + row.count;
            numbers.find(|&number| machine.drives(DeviceClass::X, number))
        });
        if let Some(number) = driven {
            let input = DeviceClass::X.number(number);
            let why = format!("[io]: `{input}` is driven by {}", machine.name());
            return Err(Failure::Because(why));
        }
    }
    for connection in &connections {
        check_files(&settings, connection, &args.allow_folder)?;
    }
    Ok(connections)
}

/// Checks that a connection's files are within folders that it may use, and that what it writes over holds numbers.
fn check_files(
    settings: &Project,
    connection: &Connection,
    allowed: &[PathBuf],
) -> Result<(), Failure> {
    if connection.kind != Kind::Files {
        return Ok(());
    }
    let folder = Path::new(&connection.end);
    let key = format!("[io.{}] files", connection.name);
    refuse_outside(settings, &key, folder, allowed)?;
    for row in &connection.rows {
        let End::Name(name) = &row.end else { continue };
        let path = folder.join(name);
        refuse_outside(settings, &key, &path, allowed)?;
        if !row.reads {
            refuse_inputs([path.clone()].into_iter())?;
            if !holds_numbers(&path).unwrap_or(true) {
                let why = "holds something else than numbers, which a row would write over";
                return Err(Failure::Because(format!(
                    "[io.{}]: {} {why}",
                    connection.name,
                    path.display()
                )));
            }
        }
    }
    Ok(())
}

/// The connections of a run at work.
#[derive(Default)]
pub struct Connecting(Io);

impl Connecting {
    /// Starts them.
    ///
    /// # Errors
    /// A kind of connection that this executable has no driver for.
    pub fn start(connections: Vec<Connection>) -> Result<Self, Failure> {
        let io = Io::start(connections, rungc_io::opener);
        io.map(Connecting).map_err(Failure::Because)
    }

    /// Returns true if there is one.
    pub fn any(&self) -> bool {
        self.0.any()
    }

    /// Before a scan.
    pub fn take(&mut self, machine: &mut Machine, hal: &mut VirtualHal) {
        report(self.0.take(machine, hal));
    }

    /// After a scan.
    pub fn give(&mut self, machine: &mut Machine) {
        self.0.give(machine);
    }

    /// The run is over: outputs are turned off.
    pub fn end(self) {
        report(self.0.end());
    }
}

fn report(lines: Vec<String>) {
    for line in lines {
        eprint_line(&format!("rungc: {line}"));
    }
}
