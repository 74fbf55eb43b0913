//! `rungc serve`: a run in real time with all servers of `rungc.toml`.

use super::run::{self, Table};
use super::subject;
use super::{Context, Failure, Result};
use crate::args::{RunArgs, ServeArgs};
use rungc_project::serve::{SerialLine, Serve};

/// Runs a program until it is interrupted, and serves it.
pub fn run(args: &RunArgs, cx: Context) -> Result {
    let subject = subject::one(&args.input, cx)?;
    let project = subject.project.as_ref();
    let mut serve = match project {
        Some(project) => args.serve.or(&project.serve),
        None => args.serve.clone(),
    };
    serve.of_project = project.is_some_and(|project| !project.io.is_empty());
    serve.sends_requests = project.is_some_and(|project| project.has_server_requests());
    if !serve.any() {
        let place = match project {
            Some(project) => format!("`[serve]` of {}", project.path.display()),
            None => "`[serve]` of a rungc.toml (`rungc init` writes one)".to_string(),
        };
        let why = format!(
            "nothing to serve: add for example `modbus-tcp = 5020` or `serial = {{ COM1 = \"/dev/ttyUSB0\" }}` to {place}, connect terminals as `[io.NAME]` (`rungc book linux`), or use \
             --modbus-tcp, --mc, --fx, --serial, --can, --io or --page"
        );
        return Err(Failure::Because(why));
    }
    let args = RunArgs {
        serve,
        ..args.clone()
    };
    run::program(&args, &subject, Table::Empty, cx)
}

impl ServeArgs {
    /// The same completed by settings. What the command line says of a protocol or of a port takes precedence.
    fn or(&self, settings: &Serve) -> ServeArgs {
        fn given<T: Clone>(own: &[T], usual: &[T]) -> Vec<T> {
            match own {
                [] => usual.to_vec(),
                own => own.to_vec(),
            }
        }
        let usual = settings.serial.iter().map(|SerialLine { line, .. }| line);
        let usual = usual.filter(|line| self.named_lines().all(|own| own.port != line.port));
        ServeArgs {
            modbus_tcp: given(&self.modbus_tcp, &settings.modbus_tcp),
            mc: given(&self.mc, &settings.mc),
            fx: given(&self.fx, &settings.fx),
            clients: self.clients.or(settings.clients),
            serial: self.serial.iter().chain(usual).cloned().collect(),
            can: self.can.clone(),
            trace_frames: self.trace_frames.clone(),
            io: self.io.clone(),
            allow_folder: self.allow_folder.clone(),
            priority: self.priority,
            of_project: self.of_project,
            page: self.page.clone(),
            sends_requests: self.sends_requests,
        }
    }
}
