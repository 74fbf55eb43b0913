//! Options of `run` and `serve` that open servers and connections.

use crate::commands::run::STANDARD_ERROR;
use crate::output::OutputPath;
use clap::{Arg, Args};
use rungc_lower::compile::CompileOptions;
use rungc_models::Model;
use rungc_project::serve::{FxEnd, Line, Serve, address};
use rungc_rt::comm::CAN_PORT;
use rungc_rt::comm::service::MAX_CLIENTS;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Servers that `run` and `serve` open.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Servers")]
pub struct ServeArgs {
    /// Serve all devices over Modbus TCP at this address: `127.0.0.1:5020`, or a port on this machine only (`5020`).
    /// Runs in real time. The protocol has no authentication: anyone who can reach the address can read and write every
    /// device.
    #[arg(long, value_parser = address, value_name = "ADDRESS")]
    pub modbus_tcp: Vec<SocketAddr>,
    /// Serve all devices over the MC protocol (1E and 3E frames, binary and ASCII), as --modbus-tcp does.
    #[arg(long, value_parser = address, value_name = "ADDRESS")]
    pub mc: Vec<SocketAddr>,
    /// Serve all devices over the programming port's protocol, as --modbus-tcp does; or connect the programming port to
    /// a line, as with --serial: `--fx pty`, `--fx /dev/ttyUSB0`.
    #[arg(long, value_name = "ADDRESS or DEVICE")]
    pub fx: Vec<FxEnd>,
    /// Allow each server this many connections at once (default: 64). One more is rejected, unless another one has been
    /// silent for a minute.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=MAX_CLIENTS as i64), value_name = "N")]
    pub clients: Option<u16>,
    /// Connect a serial port of the PLC to one of this machine (`COM1=/dev/ttyUSB0`), to a new pseudo-terminal that
    /// clients open (`COM1=pty`), to a serial device server (`COM1=tcp:HOST:PORT`), or to the client of a socket
    /// (`COM1=tcp-listen:4001`). Runs in real time. The program sets the line's format and protocol. A lost device is
    /// reopened.
    #[arg(long, value_name = "PORT=DEVICE")]
    pub serial: Vec<Line>,
    /// Connect the CAN card of H1U and H2U to a CAN interface of this machine (`can0`, Linux), or to an SLCAN adapter,
    /// with the bit rate in kbit/s (default 500): `slcan:/dev/ttyACM0,250`, `slcan:pty`. Runs in real time.
    #[arg(long, value_parser = Line::can, value_name = "BUS")]
    pub can: Option<Line>,
    /// Log each frame, decoded and as bytes: to standard error, or to a file, overwriting an earlier log; to `*.pcap`
    /// or `*.pcapng` as a capture for Wireshark (`rungc book serve`).
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, default_missing_value = STANDARD_ERROR)]
    pub trace_frames: Option<OutputPath>,
    /// Connect terminals and registers as described by the tables `[io.NAME]` of this file (rungc.toml,
    /// `rungc book linux`): Modbus remote I/O, an MQTT broker, pins (Linux), files, standard input and output. Runs in
    /// real time. `rungc serve` uses the project's rungc.toml.
    #[arg(long, value_name = "FILE")]
    pub io: Option<PathBuf>,
    /// Folder outside that of rungc.toml which its `[io]` and `[retain]` may use; may be repeated.
    #[arg(long, value_name = "FOLDER")]
    pub allow_folder: Vec<PathBuf>,
    /// Scan with this real-time priority (Linux: SCHED_FIFO, 1 to 99), with all memory locked. If the system does not
    /// permit this, a warning is printed and the run continues without. At the end, scan start latency is reported.
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=99), value_name = "N")]
    pub priority: Option<u8>,
    /// Connect them as the project's settings say.
    #[arg(skip)]
    pub of_project: bool,
    /// Values that settings give.
    #[arg(skip)]
    pub settings: ServeSettings,
    /// The program asks servers over TCP, which its settings name.
    #[arg(skip)]
    pub sends_requests: bool,
    #[command(flatten)]
    pub page: PageArgs,
}

/// Values of a rungc.toml in place of options.
#[derive(Clone, Default, Debug)]
pub struct ServeSettings {
    /// The file.
    pub path: PathBuf,
    /// Names of the options.
    pub options: Vec<&'static str>,
    /// The lines of serial ports.
    pub lines: Vec<Line>,
}

impl ServeSettings {
    /// Place of a value in messages: the key of the file, or the option.
    pub fn place(&self, option: &str) -> String {
        match self.options.contains(&option) {
            true => self.key(option),
            false => option.to_string(),
        }
    }

    /// Place of a line in messages, which is not one of `--fx`.
    pub fn place_of_line(&self, line: &Line) -> String {
        let option = if line.port == CAN_PORT {
            "--can"
        } else {
            "--serial"
        };
        match self.lines.contains(line) {
            true => self.key(option),
            false => option.to_string(),
        }
    }

    fn key(&self, option: &str) -> String {
        let key = option.trim_start_matches('-');
        format!("{}: `{key}` of `[serve]`", self.path.display())
    }
}

/// The page of `run` and `serve`.
#[derive(Args, Clone, Default, Debug)]
pub struct PageArgs {
    /// Serve a page that shows the ladder live and controls the run, at this port on this machine only; default: a free
    /// port. Prints the address to open in a browser (`rungc book live`). Runs in real time.
    #[arg(long, value_parser = address, value_name = "ADDRESS", num_args = 0..=1, default_missing_value = "0")]
    pub page: Option<SocketAddr>,
    /// Make the page read-only: it shows the run, and accepts no commands.
    #[arg(long)]
    pub read_only: bool,
}

/// The arguments that `run` and `serve` share, as `serve` describes them: it always runs in real time.
pub(super) fn in_real_time(arg: Arg) -> Arg {
    match arg.get_id().as_str() {
        "duration" => arg.help(
            "Time to run: `200ms`, `5s`, `2min`, `1h`; a bare number is milliseconds. Default: until Ctrl-C",
        ),
        "scan" => arg.help(
            "Time from one scan to the next; a longer constant scan time of the program takes precedence. Default: \
             the program's constant scan time, or 10ms",
        ),
        // It is always so, and a test cannot repeat what clients do.
        "real_time" | "record" => arg.hide(true),
        _ => arg,
    }
}

impl ServeArgs {
    /// Returns true if there is a server, a connection or a page.
    pub fn any(&self) -> bool {
        !(self.modbus_tcp.is_empty()
            && self.mc.is_empty()
            && self.fx.is_empty()
            && self.named_lines().next().is_none()
            && self.io.is_none()
            && !self.of_project
            && !self.sends_requests
            && self.page.page.is_none())
    }

    /// The lines of ports that are named: serial ports, and the CAN card.
    pub fn named_lines(&self) -> impl Iterator<Item = &Line> {
        self.serial.iter().chain(&self.can)
    }

    /// The options with which a program is compiled that these servers and lines serve.
    pub fn opened(&self, options: CompileOptions) -> CompileOptions {
        let is_line = |end: &FxEnd| matches!(end, FxEnd::Line(_));
        CompileOptions {
            // Clients may ask for any device.
            observe_all: self.any(),
            ports: self.named_lines().map(|line| line.port).collect(),
            programmer: self.fx.iter().any(is_line),
            ..options
        }
    }

    /// The lines of all ports of a model: the named ones, and the programming port.
    pub fn lines(&self, model: &Model) -> Vec<Line> {
        let of_fx = Serve::fx_lines(&self.fx, model);
        self.named_lines().cloned().chain(of_fx).collect()
    }
}
