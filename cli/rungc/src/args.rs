//! Arguments of the command line.

mod boards;
mod book;
mod dap;
mod diff;
mod effects;
mod emit;
mod explore;
mod flash;
mod fleet;
mod forms;
mod listings;
mod lsp;
mod mcp;
mod properties;
mod repeated;
mod serve;
mod start;
mod test;
mod values;
mod verify;
mod watch;
mod why;

pub use boards::BoardsArgs;
pub use book::{BookArgs, ExplainArgs, ManArgs};
pub use dap::DapArgs;
pub use diff::{DiffArgs, DiffFormat};
pub use effects::{idle, long_option};
pub use emit::{Backend, Emit};
pub use explore::{ExploreArgs, Latched, SearchEngine};
pub use flash::FlashArgs;
pub use fleet::FleetArgs;
pub use forms::{
    ConvertArgs, ConvertTo, LineArgs, McFrame, ModbusEnd, NamesFile, PlcArgs, PlcopenBody,
    ReadArgs, ReadFrom, RtuFormat,
};
pub use listings::{DocArgs, StatsArgs, StatsTo, ViewArgs, XrefArgs, XrefTo};
pub use lsp::LspArgs;
pub use mcp::McpArgs;
pub use properties::Properties;
pub use serve::{PageArgs, ServeArgs, ServeSettings};
pub use start::{DemoArgs, DoctorArgs, DoctorFormat, InitArgs};
pub use test::{CoverageFormat, Shard, TestArgs, TestFormat};
pub use verify::VerifyArgs;
pub use watch::{WatchArgs, WatchTo};
pub use why::WhyArgs;

use crate::output::OutputPath;
use clap::{Args, Parser, Subcommand, ValueEnum};
use rungc::Language;
use rungc_firmware::target::Target;
use rungc_frontend::{Encoding, ReadOptions};
use rungc_models::{ModelId, Plc};
use rungc_project::Check;
use std::path::PathBuf;
use values::{encoding, language, limit, model, omissible, plc, target, warning};

/// Default maximum number of diagnostics in the human format.
const DIAGNOSTICS: usize = 100;

/// Compile FX-family PLC programs to C and Rust.
#[derive(Parser, Debug)]
#[command(
    name = "rungc",
    version,
    propagate_version = true,
    subcommand_required = true,
    arg_required_else_help = true
)]
#[command(after_help = "\
Examples:
  rungc check machine.gxw                      check a program
  rungc serve machine.gxw --modbus-tcp 5020    until Ctrl-C, for HMIs and other clients
  rungc serve motor.il --page                  a page that shows the ladder live, in a browser
  rungc run motor.il --set X000=1@200ms --for 5s --watch Y000,T0
  rungc build MAIN.csv --emit c -o firmware/plc
  rungc build MAIN.csv --emit bin -o machine   an executable that scans in real time
  rungc test tests --engine all                all test files in a folder
  rungc verify motor.il --never \"Y000 & Y001\"  proved, or how it happens
  rungc explore motor.il --timeout 10s         errors that some inputs lead to
  rungc view machine.gxw --device Y000         networks, as ladder
  rungc xref machine.gxw --device M100..M199   who reads and writes each device
  rungc diff old.gxw new.gxw --semantic        what changed, and which outputs can differ
  rungc demo                                   an example project, and what to try with it
  rungc init machine.gxw                       settings of a project: rungc.toml
  rungc explain E0106                          also: rungc explain ADD, rungc explain M8013
  rungc book test-files                        a page of the book; `rungc book` lists them

Exit codes: 0: success; 1: errors in the program, a failed test, or a simulated machine that hit its end stop;
2: incorrect usage or unreadable input; 3: `verify` has not decided; 130: interrupted with Ctrl-C.
Of `verify`, `explore` and `diff`, 1 is a violation, a finding or a difference, and 2 also an error in a program.")]
pub struct Cli {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
    /// Use of colours.
    #[arg(long, global = true, value_enum, default_value_t = ColorWhen::Auto, value_name = "WHEN")]
    pub color: ColorWhen,
    /// Language of diagnostics and their explanations: en or zh. Default: that of rungc.toml, else of the environment.
    #[arg(long, global = true, value_parser = language, value_name = "LANGUAGE")]
    pub lang: Option<Language>,
    /// Print only diagnostics and results, no progress.
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print more details.
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

/// The commands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Check a program without compiling it.
    Check(CheckArgs),
    /// Compile a program to C, Rust or an executable, or print its IR.
    Build(BuildArgs),
    /// Run a program in the interpreter with virtual time.
    Run(RunArgs),
    /// Run a program in real time with the servers and serial lines of `[serve]` in rungc.toml, until Ctrl-C.
    ///
    /// Options add servers to those of rungc.toml, and take precedence for a protocol or serial port that both name. At
    /// the end, a table lists the connections: frames, errors, and devices written.
    #[command(mut_args(serve::in_real_time))]
    Serve(RunArgs),
    /// Run many PLCs in lock step, each with its own ports or MQTT topics, until Ctrl-C.
    ///
    /// At the end, reports the number of scans, missed scans, the latency of their start, and memory per PLC.
    Fleet(FleetArgs),
    /// Run PLC test files on one or all engines.
    Test(TestArgs),
    /// Prove that a program has a property, or show how it violates it.
    ///
    /// A property is a condition on the devices after a scan, such as `Y000 & Y001`. Exit codes: 0: proved; 1:
    /// violated; 2: incorrect usage, or errors in the program; 3: undecided.
    Verify(VerifyArgs),
    /// Search for runs with property violations, operation errors, or coils that drive an output to conflicting states.
    ///
    /// Tries sequences of inputs, and extends those that reach new behaviour. Prints the shortest run for each finding.
    /// Exit codes: 0: nothing found, which is not a proof; 1: found; 2: incorrect usage, or errors in the program.
    Explore(ExploreArgs),
    /// Draw a program as a ladder diagram.
    View(ViewArgs),
    /// Write the documentation of a machine: terminals, what drives each output, timers, instructions, open questions.
    ///
    /// One page with links into the ladder, for whoever inherits the machine, in the language of the reports.
    Doc(DocArgs),
    /// List the instructions that read, write, set and reset each device.
    Xref(XrefArgs),
    /// Explain why a device is on or off: which contacts, timers and states keep it so.
    ///
    /// Without a run, lists what can switch the device. With --set, --for or --machine, the program runs to that
    /// moment, and the answer says what keeps the device as it is, since when, and what would change it.
    Why(WhyArgs),
    /// Show the devices of a PLC as they change, by its programming port, MC protocol or Modbus.
    ///
    /// The PLC is read, and nothing in it is changed.
    Watch(WatchArgs),
    /// Count steps, instructions and devices, and estimate the scan time of the real PLC.
    Stats(StatsArgs),
    /// Format instruction lists, preserving comments.
    Fmt(FmtArgs),
    /// Put another device in the place of one, or give devices labels.
    ///
    /// In an instruction list, the device is replaced in all operands and in its comment, or, with the reason, not at
    /// all. A name that is not a device becomes its label in rungc.toml, for programs of any format. Exit codes: 0:
    /// renamed; 1: a program with errors; 2: incorrect usage, or a name that the device cannot have.
    Rename(RenameArgs),
    /// Compare two programs network by network, or by behaviour.
    ///
    /// Exit codes: 0: no difference; 1: a difference; 2: incorrect usage, or a program that cannot be read whole.
    Diff(DiffArgs),
    /// Convert a program to an instruction list, list export, ladder drawing, PLCopen XML or program memory.
    Convert(ConvertArgs),
    /// Read the program from a PLC over its programming port.
    ///
    /// The PLC keeps running, and nothing in it changes. Programs protected by a keyword are not read.
    Read(ReadArgs),
    /// List the supported boards, or show the pins of one.
    Boards(BoardsArgs),
    /// Flash an image to a microcontroller through its ROM boot loader (STM32, AN3155) or with probe-rs.
    ///
    /// Lists what will be erased, and asks for confirmation. Exit codes: 0: written and verified; 1: failed because of
    /// the boot loader, the part or the line (E0850 and following); 2: incorrect usage or unreadable image; 130:
    /// interrupted.
    Flash(FlashArgs),
    /// Serve an editor over the Language Server Protocol.
    ///
    /// Shows diagnostics, fixes, explanations and the ways through a program while you type. Editors start this command
    /// (`rungc book editors`) and talk to it on standard input and output. Exit codes: 0: shut
    /// down by the editor; 1: the connection ended without that.
    Lsp(LspArgs),
    /// Debug a program in an editor over the Debug Adapter Protocol.
    ///
    /// The program runs in virtual time; the editor stops it at instructions, device changes and errors, and goes back
    /// in time. Editors start this command (`rungc book debugging`) and talk to it on standard input and output. Exit
    /// codes: 0: disconnected by the editor; 1: the connection ended without that.
    Dap(DapArgs),
    /// Serve an assistant over the Model Context Protocol.
    ///
    /// Offers tools that read, check, run, test and prove programs, pages of the book, and prompts. Assistants start
    /// this command (`rungc book assistants`) and talk to it on standard input and output. It reads files below its
    /// folders, writes none unless `--allow-write` names a folder for that, and opens no connection. Exit codes: 0: the
    /// client has closed the input; 2: incorrect usage, or output that cannot be written.
    Mcp(McpArgs),
    /// Print what an assistant, or a person in a hurry, must know of the language and of rungc.
    Guide,
    /// Write rungc.toml, the commented settings of a project, and AGENTS.md for assistants.
    ///
    /// An AGENTS.md that is there already is kept.
    Init(InitArgs),
    /// Write an example project into a new folder, and print a tour of its commands.
    Demo(DemoArgs),
    /// List the tools that rungc calls, the serial ports and settings of this machine, and what each missing one
    /// prevents.
    ///
    /// Exit code 0, whatever is missing.
    Doctor(DoctorArgs),
    /// Learn unknown instruction codes of a vendor project from the editor's list export.
    Learn(LearnArgs),
    /// Explain a diagnostic code, an instruction, a special device, an error code or a safety function, or print a page
    /// of the book.
    Explain(ExplainArgs),
    /// List the pages of the book, or print one.
    Book(BookArgs),
    /// Print the manual page of rungc, or of one of its commands.
    Man(ManArgs),
    /// Print a completion script for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
}

/// A program and its reader options.
#[derive(Args, Clone, Debug)]
pub struct Input {
    /// Instruction list, structured text (.st), list export (CSV), GX Developer project (folder or MAIN.wpg), GX Works2
    /// project (.gxw) or image of program memory; recognised by content, not by name. `-` is standard input. Default:
    /// the program of rungc.toml.
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub reading: Reading,
}

/// Programs and their reader options.
#[derive(Args, Debug)]
pub struct Inputs {
    /// Instruction lists, structured text (.st), list exports (CSV), GX Developer projects (folder or MAIN.wpg), GX
    /// Works2 projects (.gxw), PLCopen XML and images of program memory, recognised by content, not by name; folders,
    /// for all programs in them and below (lists and drawn ladder as `.il`); `-` is standard input. Default: the
    /// program of rungc.toml.
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: Reading,
}

/// Kind of the files.
#[derive(Args, Clone, Debug, Default)]
pub struct FileKind {
    /// PLC model. Default: that of rungc.toml, else the CPU type that the file names, else fx3u.
    /// `rungc explain h2u-mtq` shows a variant.
    #[arg(long, value_parser = plc, value_name = "MODEL")]
    pub model: Option<Plc>,
    /// Text encoding, such as windows-1252, gbk or shift_jis. Default: the encoding that a project states, else the
    /// most likely one.
    #[arg(long, value_parser = encoding, value_name = "NAME")]
    pub encoding: Option<&'static Encoding>,
    /// Read the compiled program of a GX Works2 project, not its source.
    #[arg(long)]
    pub compiled: bool,
    /// Input format, if it cannot be detected.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub from: Option<ReadFrom>,
    /// Devices of the variables of PLCopen XML: a table of rows such as `Start,X000`; `*,M100-M199` lists devices for
    /// variables without an address.
    #[arg(long, value_parser = forms::names, value_name = "FILE")]
    pub names: Option<NamesFile>,
}

/// Options for reading programs and reporting diagnostics.
#[derive(Args, Clone, Debug, Default)]
pub struct Reading {
    #[command(flatten)]
    pub kind: FileKind,
    /// Settings of the project (`rungc book project`). Default: the nearest rungc.toml, in each program's folder or
    /// above it.
    #[arg(long, value_name = "FILE")]
    pub project: Option<PathBuf>,
    #[command(flatten)]
    pub reporting: Reporting,
}

impl Reading {
    /// The options for the readers.
    pub fn options(&self) -> ReadOptions {
        ReadOptions {
            encoding: self.kind.encoding,
            compiled: self.kind.compiled,
            image: self.kind.from == Some(ReadFrom::Image),
            names: self.kind.names.clone().unwrap_or_default().names,
            ..ReadOptions::default()
        }
    }
}

/// Options for diagnostics.
#[derive(Args, Clone, Debug)]
pub struct Reporting {
    /// Format of diagnostics. Human-readable ones go to standard error, others to standard output, or to standard error
    /// if the command itself writes to standard output.
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
    /// Treat warnings as errors.
    #[arg(long)]
    pub deny_warnings: bool,
    /// Suppress warnings and notes with this code (W0203) or name (double-coil); may be repeated or separated by
    /// commas.
    #[arg(short = 'A', long = "allow", value_name = "CODE", value_parser = omissible, value_delimiter = ',')]
    pub allow: Vec<&'static str>,
    /// Treat warnings with this code or name as errors; may be repeated or separated by commas.
    #[arg(short = 'D', long = "deny", value_name = "CODE", value_parser = warning, value_delimiter = ',')]
    pub deny: Vec<&'static str>,
    /// Treat a limit of the model with this code (E0105) or name (limits) as a warning; may be repeated or separated by
    /// commas. The PLC rejects the program, but it can be compiled.
    #[arg(short = 'W', long = "warn", value_name = "CODE", value_parser = limit, value_delimiter = ',')]
    pub warn: Vec<&'static str>,
    /// Levels of codes from rungc.toml; the command line takes precedence.
    #[arg(skip)]
    pub rules: Check,
    /// Language from rungc.toml.
    #[arg(skip)]
    pub lang: Option<Language>,
    /// Maximum number of diagnostics to print in the human format; 0 prints all.
    #[arg(long, default_value_t = DIAGNOSTICS, value_name = "N")]
    pub limit: usize,
}

/// Arguments of `check`.
#[derive(Args, Debug)]
pub struct CheckArgs {
    #[command(flatten)]
    pub inputs: Inputs,
    /// Apply safe fixes to instruction lists, and report the remaining diagnostics.
    #[arg(long)]
    pub fix: bool,
    /// In the human format, draw the network of each diagnostic as a ladder diagram, with the place marked.
    #[arg(long)]
    pub draw: bool,
    /// Also report dead logic, with a proof of each: coils that are never on, rungs without effect, steps that are
    /// never reached or left, comparisons with one result, timers that never expire; and outputs that change in every
    /// scan. Takes at most 20 seconds per program. Implies --draw.
    #[arg(long)]
    pub deep: bool,
}

/// Arguments of `build`.
#[derive(Args, Debug)]
pub struct BuildArgs {
    #[command(flatten)]
    pub inputs: Inputs,
    #[command(flatten)]
    pub plan: Plan,
}

/// Build settings; rungc.toml supplies those that the command line omits.
#[derive(Args, Clone, Debug)]
pub struct Plan {
    /// Output form.
    #[arg(long, value_enum)]
    pub emit: Option<Emit>,
    /// Report resource usage on the target, built from C: flash, RAM, stack, steps of the longest scan
    /// (`rungc book report`).
    #[arg(long)]
    pub report: bool,
    /// Target: `host` or a Rust target triple such as thumbv7em-none-eabihf. Images use the board's target.
    #[arg(long, value_parser = target, value_name = "TARGET")]
    pub target: Option<&'static Target>,
    /// Language of the image's sources.
    #[arg(long, value_enum, value_name = "LANGUAGE")]
    pub backend: Option<Backend>,
    /// Board for an image: a name that `rungc boards` lists, or a description (`rungc book boards`); with c or rust,
    /// writes the sources of the image.
    #[arg(long, value_name = "BOARD")]
    pub board: Option<PathBuf>,
    /// Scripted inputs for simulator images: `X000=1@2s`; may be repeated or separated by commas.
    #[arg(long, value_name = "DEVICE=VALUE[@TIME]")]
    pub set: Vec<String>,
    /// Run time of a simulator image, after which it exits: `30s`.
    #[arg(long = "for", value_parser = crate::time::parse, value_name = "TIME")]
    pub duration: Option<u64>,
    /// Extra argument for cargo, such as `-Zbuild-std=core`; may be repeated.
    #[arg(long, value_name = "ARG", allow_hyphen_values = true)]
    pub cargo_arg: Vec<String>,
    /// Folder (c, rust, lib) or file (bin, elf, fmu, ir) to write; for ir the default is standard output. With several
    /// programs, a folder for all outputs, each under its program's name; in c they share headers, the runtime and a
    /// Makefile there.
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<OutputPath>,
    /// Name of the program in the emitted code. Default: derived from the file's name.
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// Add a main program for a host that scans in real time.
    #[arg(long)]
    pub main: bool,
    /// Executables and main programs take --modbus-tcp, --mc and --fx, as `rungc run` does, and store every device of
    /// the model. They need the runtime library (`rungc book serve`).
    #[arg(long)]
    pub servers: bool,
    /// Executables and main programs take --io FILE, which connects terminals and registers to remote I/O, brokers,
    /// pins and files as `rungc run` does, and --log FILE. They need the runtime library (`rungc book linux`).
    #[arg(long)]
    pub io: bool,
    /// Add functions that read and write devices by number and by name to emitted C (`rungc book embedding`).
    #[arg(long)]
    pub device_access: bool,
    /// Add NAME_retain.h and rungc_retain.h to emitted C: save latched devices to flash and load them
    /// (`rungc book retain`). Emitted Rust has `Program::retained` for this.
    #[arg(long)]
    pub retain: bool,
    /// Add NAME_lanes.h and rungc_lanes.h to emitted C: run this many instances of the program at once, a bit device of
    /// all of them in one word (`rungc book lanes`).
    #[arg(long, value_name = "N", value_parser = ["64"])]
    pub lanes: Option<String>,
    /// Add misra.txt to emitted C: deviations from MISRA C:2012, as suppressions for cppcheck (`rungc book builds`).
    #[arg(long)]
    pub misra: bool,
    /// Put only sources into a functional mock-up unit, no shared library for this machine or --target (`rungc book
    /// fmu`).
    #[arg(long)]
    pub sources_only: bool,
    /// Add the feature `defmt` to emitted Rust: with it, defmt prints the program's state and errors
    /// (`rungc book builds`).
    #[arg(long)]
    pub defmt: bool,
    /// Make emitted Rust depend on the runtime in this folder, which several crates can share, instead of a copy inside
    /// the crate; the runtime is written there unless the folder has it (`rungc book embedding`).
    #[arg(long, value_name = "FOLDER")]
    pub runtime: Option<OutputPath>,
    /// Folder outside that of rungc.toml which its `[build] output` may lead to; may be repeated.
    #[arg(long, value_name = "FOLDER")]
    pub allow_folder: Vec<PathBuf>,
    /// Do not optimise the IR.
    #[arg(long)]
    pub no_opt: bool,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `run` and `serve`.
#[derive(Args, Clone, Debug)]
pub struct RunArgs {
    #[command(flatten)]
    pub input: Input,
    /// Virtual time to run: `200ms`, `5s`, `2min`, `1h`; a bare number is milliseconds. Default: 1s, or with a server
    /// until Ctrl-C.
    #[arg(long = "for", value_parser = crate::time::parse, value_name = "TIME")]
    pub duration: Option<u64>,
    /// Scan time, in virtual time; a longer constant scan time of the program takes precedence. Default: the program's
    /// constant scan time, or 10ms.
    #[arg(long, value_parser = crate::time::parse, value_name = "TIME")]
    pub scan: Option<u64>,
    /// Set a device at a time: `X000=1@200ms`, `D0=5` (at the start), `D0.f32=1.5`, `D1=H1F`, `Start button=1`; may be
    /// repeated or separated by commas. A comment with a comma may stand in quotes: `"Speed, set"=5`.
    #[arg(long, value_name = "DEVICE=VALUE[@TIME]")]
    pub set: Vec<String>,
    /// Devices to show: `Y000`, `Y000..Y007`, `T0`, `D0`, a pair of registers as an integer (`D0.i32`), a float
    /// (`D0.f32`) or characters (`D0.str`), a group of bits (`K4M0`), pulses sent by an output (`Y000.pulses`,
    /// `Y000.hz`), a comment (`Main contactor`). Default: what the program writes, outputs first, and the inputs that
    /// change, up to twelve.
    #[arg(long, value_name = "DEVICE")]
    pub watch: Vec<String>,
    /// Simulated machine, whose axes, cylinders and delays follow the outputs and drive inputs (`rungc book machines`).
    #[arg(long, value_name = "FILE")]
    pub machine: Option<PathBuf>,
    /// Record inputs, outputs and watched devices as a value change dump for GTKWave and other waveform viewers;
    /// overwrites an earlier recording.
    #[arg(long, value_name = "FILE")]
    pub vcd: Option<OutputPath>,
    /// Record this run as a test file (`*.plctest.toml`): the devices set, and the outputs and the devices of --watch
    /// as expectations.
    #[arg(
        long = "write-test",
        alias = "record",
        value_name = "FILE",
        conflicts_with = "real_time"
    )]
    pub record: Option<OutputPath>,
    /// Draw positions and speeds of the machine's axes and of pulse outputs, and watched devices, as an SVG; overwrites
    /// an earlier drawing.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<OutputPath>,
    /// With --plot: plot against this value instead of time, such as a slave axis against its master.
    #[arg(long, value_name = "DEVICE", requires = "plot")]
    pub over: Option<String>,
    /// Draw the last samples of HM's oscilloscope (D8030 to D8043) as an SVG, and write them as a table to a `.csv`
    /// file of the same name; overwrites earlier ones.
    #[arg(long, value_name = "FILE")]
    pub scope: Option<OutputPath>,
    /// Store latched devices in this file: loaded at the start, saved at the end, and in real time also once a second
    /// if one has changed. Default: the file named in rungc.toml.
    #[arg(long, value_name = "FILE")]
    pub retain: Option<PathBuf>,
    /// Run in real time instead of as fast as possible.
    #[arg(long)]
    pub real_time: bool,
    /// Overwrite existing files that are not earlier results of the same kind.
    #[arg(long)]
    pub force: bool,
    /// Fail (exit code 1) on PLC operation errors; --verbose reports each as it occurs.
    #[arg(long)]
    pub deny_errors: bool,
    #[command(flatten)]
    pub serve: ServeArgs,
}

impl RunArgs {
    /// Duration of the run, in milliseconds; `None` until it is interrupted.
    pub fn end_ms(&self) -> Option<u64> {
        const USUAL_MS: u64 = 1000;
        self.duration.or((!self.serve.any()).then_some(USUAL_MS))
    }

    /// Returns true if the run follows the clock.
    pub fn in_real_time(&self) -> bool {
        self.real_time || self.serve.any()
    }
}

/// Arguments of `fmt`.
#[derive(Args, Debug)]
pub struct FmtArgs {
    #[command(flatten)]
    pub inputs: Inputs,
    /// Change nothing: list the lines that are not formatted, and fail (exit code 1) if there are any.
    #[arg(long)]
    pub check: bool,
}

/// Arguments of `rename`.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  rungc rename press.il M0 M100            M100 in place of M0, in all instructions and in its comment
  rungc rename press.il M0 M100 --dry-run  the lines that would change
  rungc rename press.gxw M0 Press.Ready    a label in rungc.toml: a name for reports, tests and emitted code
  rungc rename press.gxw --comments        labels for all devices with a comment")]
pub struct RenameArgs {
    /// The program.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Device, or its comment.
    #[arg(
        value_name = "DEVICE",
        required_unless_present = "comments",
        requires = "name"
    )]
    pub device: Option<String>,
    /// New device, or a label.
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Give each device with a comment a label that is its comment.
    #[arg(long, conflicts_with_all = ["device", "name"])]
    pub comments: bool,
    /// Change nothing: list the lines that would change.
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub reading: Reading,
}

impl RenameArgs {
    /// The program.
    pub fn input(&self) -> Input {
        Input {
            file: Some(self.file.clone()),
            reading: self.reading.clone(),
        }
    }
}

/// Arguments of `learn`.
#[derive(Args, Debug)]
pub struct LearnArgs {
    /// GX Developer project (folder or MAIN.wpg) or GX Works2 project (.gxw).
    #[arg(value_name = "PROJECT")]
    pub file: PathBuf,
    /// List export (CSV) of the same state of the project.
    #[arg(value_name = "EXPORT")]
    pub export: PathBuf,
    /// Settings file to write the codes to. Default: the nearest rungc.toml, in the project's folder or above it, else
    /// a new one in that folder.
    #[arg(long, value_name = "FILE")]
    pub project: Option<PathBuf>,
    /// PLC model. Default: that of the settings, else the CPU type that the project names.
    #[arg(long, value_parser = model, value_name = "MODEL")]
    pub model: Option<ModelId>,
}

/// Use of colours.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum ColorWhen {
    /// On a terminal, unless NO_COLOR is set.
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

/// Format of diagnostics.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// Human-readable.
    Human,
    /// JSON: one object.
    Json,
    /// SARIF 2.1.0.
    Sarif,
    /// JUnit XML: errors as cases that failed; of `verify`, a case for each property or output.
    Junit,
    /// Workflow commands of GitHub Actions, which mark findings at their lines.
    Github,
}

impl Default for Reporting {
    /// The options of an empty command line.
    fn default() -> Self {
        Reporting {
            format: Format::Human,
            deny_warnings: false,
            allow: Vec::new(),
            deny: Vec::new(),
            warn: Vec::new(),
            rules: Check::default(),
            lang: None,
            limit: DIAGNOSTICS,
        }
    }
}

/// Engines of `test`.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum EngineChoice {
    /// The reference interpreter.
    Interp,
    /// Emitted C.
    C,
    /// Emitted Rust.
    Rust,
    /// All three.
    All,
}

#[cfg(test)]
mod tests;
