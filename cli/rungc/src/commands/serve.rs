//! `rungc serve`: a run in real time with all servers of `rungc.toml`.

use super::run::{self, Table};
use super::subject;
use super::{Context, Failure, Result};
use crate::args::{PageArgs, RunArgs, ServeArgs, ServeSettings};
use rungc_project::serve::{Line, SerialLine, Serve};
use std::path::Path;

/// Runs a program until it is interrupted, and serves it.
pub fn run(args: &RunArgs, cx: Context) -> Result {
    let subject = subject::one(&args.input, cx)?;
    let project = subject.project.as_ref();
    let mut serve = match project {
        Some(project) => args.serve.or(&project.serve, &project.path),
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
    fn or(&self, settings: &Serve, path: &Path) -> ServeArgs {
        fn given<T: Clone>(own: &[T], usual: &[T]) -> Vec<T> {
            match own {
                [] => usual.to_vec(),
                own => own.to_vec(),
            }
        }
        let usual = settings.serial.iter().map(|SerialLine { line, .. }| line);
        let usual = usual.filter(|line| self.named_lines().all(|own| own.port != line.port));
        let lines: Vec<Line> = usual.cloned().collect();
        let options = [
            ("--modbus-tcp", self.modbus_tcp.is_empty()),
            ("--mc", self.mc.is_empty()),
            ("--fx", self.fx.is_empty()),
            ("--page", self.page.page.is_none()),
        ];
        let options = options.into_iter().filter(|(_, of_settings)| *of_settings);
        ServeArgs {
            settings: ServeSettings {
                path: path.to_path_buf(),
                options: options.map(|(option, _)| option).collect(),
                lines: lines.clone(),
            },
            modbus_tcp: given(&self.modbus_tcp, &settings.modbus_tcp),
            mc: given(&self.mc, &settings.mc),
            fx: given(&self.fx, &settings.fx),
            clients: self.clients.or(settings.clients),
            serial: self.serial.iter().cloned().chain(lines).collect(),
            can: self.can.clone(),
            trace_frames: self.trace_frames.clone(),
            io: self.io.clone(),
            allow_folder: self.allow_folder.clone(),
            priority: self.priority,
            of_project: self.of_project,
            page: PageArgs {
                page: self.page.page.or(settings.page),
                ..self.page
            },
            sends_requests: self.sends_requests,
        }
    }
}
