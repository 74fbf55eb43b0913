//! The command line of a program's host: which options it takes, and what it says of them.

use crate::cycle::keeps_any;
use rungc_ir::Module;
use rungc_rt::comm::service::{ServerProtocol, USUAL_CLIENTS};
use rungc_syntax::text::one_line;
use std::fmt::Write;

/// Columns of an option with its value.
const OPTION_WIDTH: usize = 24;

/// Capabilities of a host, which depend on its language.
#[derive(Clone, Copy, Debug)]
pub struct Host {
    /// Examples of the ends that `--serial` connects a port to.
    pub lines: &'static [&'static str],
    /// True if it opens servers.
    pub servers: bool,
    /// True if it has connections and a log.
    pub io: bool,
}

/// Kind of an option's value.
#[derive(Clone, Copy, Debug)]
pub enum Takes {
    /// End of a serial port: `COM1=/dev/ttyUSB0`.
    Line,
    /// The address of a server.
    Address(ServerProtocol),
    /// That of one that speaks what this port does: or what the port is connected to.
    AddressOrLine(ServerProtocol, u8),
    /// Maximum number of connections of the servers named after it.
    Clients,
    /// The file that keeps latched devices from run to run.
    Retained,
    /// The file that describes connections.
    Io,
    /// The file of the log.
    Log,
}

/// An option with a value.
#[derive(Clone, Copy, Debug)]
pub struct Valued {
    /// Name as written.
    pub name: &'static str,
    /// Kind of its value.
    pub takes: Takes,
}

/// The options with a value that the host of a module takes.
pub fn options(module: &Module, host: &Host) -> Vec<Valued> {
    let line = Valued {
        name: "--serial",
        takes: Takes::Line,
    };
    let programmer = module.model.ports.of_programmer();
    let programmer = programmer.filter(|port| module.ports.contains(port));
    let servers = ServerProtocol::all().map(|protocol| Valued {
        name: protocol.option(),
        takes: match programmer {
            Some(port) if protocol == ServerProtocol::ProgrammingPort => {
                Takes::AddressOrLine(protocol, port)
            }
            _ => Takes::Address(protocol),
        },
    });
    let line = module.has_ports().then_some(line);
    let retain = keeps_any(module).then_some(Valued {
        name: "--retain",
        takes: Takes::Retained,
    });
    let clients = Valued {
        name: "--clients",
        takes: Takes::Clients,
    };
    let servers = [clients]
        .into_iter()
        .chain(servers)
        .filter(|_| host.servers);
    let outside = [("--io", Takes::Io), ("--log", Takes::Log)];
    let outside = outside.map(|(name, takes)| Valued { name, takes });
    let outside = outside.into_iter().filter(|_| host.io);
    let own = line.into_iter().chain(retain).chain(outside);
    own.chain(servers).collect()
}

/// The port that examples name: the first that the program itself uses.
fn usual_port(module: &Module) -> u8 {
    let programmer = module.model.ports.of_programmer();
    let ports = &module.ports;
    let own = ports.iter().find(|&&port| Some(port) != programmer);
    own.or(ports.first()).copied().unwrap_or_default()
}

/// The text for `--help`, line by line.
pub fn lines(module: &Module, host: &Host) -> Vec<String> {
    let Module {
        name, source_name, ..
    } = module;
    let source = one_line(source_name);
    let mut text = format!(
        "usage: {name} [OPTIONS]\n\n\
         Runs {source} in real time, one scan every 10 ms, and prints the outputs that change.\n\
         Type X0=1 or X0=0 and Enter to switch an input, quit and Enter to end the run.\n\n"
    );
    let mut option = |option: &str, what: &str| {
        // Writing to a String does not fail.
        let _ = writeln!(text, "  {option:OPTION_WIDTH$}  {what}");
    };
    for Valued { name, takes } in options(module, host) {
        match takes {
            Takes::Line => {
                let port = usual_port(module);
                let ends = host.lines.iter().map(|end| format!("COM{port}={end}"));
                let ends = ends.collect::<Vec<_>>().join(", ");
                option(
                    &format!("{name} COM{port}=DEVICE"),
                    &format!("connect a serial port: {ends}"),
                );
            }
            Takes::Clients => option(
                &format!("{name} N"),
                &format!("connections of each server named after it (default {USUAL_CLIENTS})"),
            ),
            Takes::Retained => option(
                &format!("{name} FILE"),
                "keep latched devices in this file from run to run",
            ),
            Takes::Io => option(
                &format!("{name} FILE"),
                "connect terminals and registers by the tables [io.NAME] of this file",
            ),
            Takes::Log => option(
                &format!("{name} FILE"),
                "add what is printed to this file, with the time (UTC)",
            ),
            Takes::Address(protocol) | Takes::AddressOrLine(protocol, _) => {
                let or_line = if let Takes::AddressOrLine(_, port) = takes {
                    let lines = host.lines.join(&format!(", {name} "));
                    format!("; or connect COM{port}: {name} {lines}")
                } else {
                    String::new()
                };
                option(
                    &format!("{name} ADDRESS"),
                    &format!("serve all devices over TCP: {}{or_line}", protocol.name()),
                );
            }
        }
    }
    option("-h, --help", "print this");
    if host.servers {
        text.push_str(
            "\nAn address is 127.0.0.1:5020, or 5020, a port of this machine alone. The protocols have no password:\n\
             whoever reaches an address reads and writes every device.\n",
        );
    }
    text.lines().map(str::to_string).collect()
}
