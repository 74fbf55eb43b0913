//! Arguments of the commands for other forms of programs: `convert`, `read`.

use super::{Inputs, Reporting};
use crate::output::OutputPath;
use clap::{Args, ValueEnum};
use rungc_frontend::Names;
use rungc_project::serve::LineEnd;
use std::fs;

/// Arguments of `convert`.
#[derive(Args, Debug)]
pub struct ConvertArgs {
    #[command(flatten)]
    pub inputs: Inputs,
    /// Output form.
    #[arg(long, value_enum)]
    pub to: ConvertTo,
    /// Language of the body in PLCopen XML. Default: `ld`.
    #[arg(long, value_enum, value_name = "LANGUAGE")]
    pub body: Option<PlcopenBody>,
    /// File to write. Default: standard output. With several programs, a folder for all outputs.
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<OutputPath>,
    /// Overwrite an existing file.
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `read`.
#[derive(Args, Debug)]
pub struct ReadArgs {
    /// Serial port connected to the PLC's programming port (`/dev/ttyUSB0`, `COM3`), or a serial device server
    /// (`tcp:HOST:PORT`).
    #[arg(long, value_parser = serial_end, value_name = "PORT", group = "line")]
    pub port: LineEnd,
    #[command(flatten)]
    pub line: LineArgs,
    /// Output format; `image` is the unchanged program memory.
    #[arg(long, value_enum, default_value_t = ConvertTo::Il)]
    pub to: ConvertTo,
    /// File to write. Default: standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OutputPath>,
    /// Overwrite an existing file.
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub reporting: Reporting,
}

/// Arguments for the line to a PLC's programming port.
#[derive(Args, Clone, Debug)]
pub struct LineArgs {
    /// Bit rate. At a programming port, the format is always 7 data bits, even parity, 1 stop bit.
    #[arg(
        long,
        requires = "line",
        default_value_t = 9600,
        value_parser = clap::value_parser!(u32).range(300..=115_200),
        value_name = "BITS_PER_SECOND"
    )]
    pub baud: u32,
    /// Time to wait for a response.
    #[arg(long, default_value = "1s", value_parser = crate::time::parse_wait, value_name = "TIME")]
    pub timeout: u64,
    /// Number of retries if a response is missing or damaged.
    #[arg(long, requires = "line", default_value_t = 3, value_parser = clap::value_parser!(u32).range(..=100), value_name = "N")]
    pub retries: u32,
}

/// Arguments for a PLC that is only read.
#[derive(Args, Clone, Debug)]
pub struct PlcArgs {
    /// Read the PLC whose programming port is at this serial port (`/dev/ttyUSB0`, `COM3`) or at a serial device server
    /// (`tcp:HOST:PORT`).
    #[arg(long, value_parser = serial_end, value_name = "PORT", groups = ["line", "plc"])]
    pub port: Option<LineEnd>,
    /// Read a PLC that speaks the MC protocol over TCP, in binary, such as an FX3U with an Ethernet module.
    #[arg(long, value_parser = host, value_name = "HOST:PORT", group = "plc")]
    pub mc: Option<LineEnd>,
    /// Read a PLC that is a Modbus slave: by Modbus TCP at `HOST:PORT`, by RTU at a serial port (`/dev/ttyUSB0`,
    /// `COM3`) or at a serial device server (`tcp:HOST:PORT`).
    #[arg(long, value_parser = modbus_end, value_name = "ADDRESS", groups = ["line", "plc"])]
    pub modbus: Option<ModbusEnd>,
    /// Number of the Modbus slave.
    #[arg(
        long,
        requires = "modbus",
        conflicts_with_all = ["port", "mc"],
        default_value_t = 1,
        value_parser = clap::value_parser!(u8).range(1..=247),
        value_name = "N"
    )]
    pub unit: u8,
    /// Parity and stop bits of the serial line to the Modbus slave.
    #[arg(
        long,
        value_enum,
        requires = "modbus",
        conflicts_with_all = ["port", "mc"],
        default_value_t = RtuFormat::None1,
        value_name = "FORMAT"
    )]
    pub line_format: RtuFormat,
    /// Frame of the MC protocol: Ethernet modules of FX3 understand 1e; FX5, Q and L understand 3e.
    #[arg(long, value_enum, requires = "mc", default_value_t = McFrame::E1, value_name = "FRAME")]
    pub mc_frame: McFrame,
    #[command(flatten)]
    pub line: LineArgs,
}

impl PlcArgs {
    /// True if a PLC is named.
    pub fn names_plc(&self) -> bool {
        self.port.is_some() || self.mc.is_some() || self.modbus.is_some()
    }
}

/// Address of a Modbus slave.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum ModbusEnd {
    /// By Modbus TCP.
    Tcp(LineEnd),
    /// By RTU on a serial line.
    Rtu(LineEnd),
}

fn modbus_end(text: &str) -> Result<ModbusEnd, String> {
    host(text)
        .map(ModbusEnd::Tcp)
        .or_else(|_| serial_end(text).map(ModbusEnd::Rtu))
}

/// Formats of a character of RTU, with 8 data bits.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum RtuFormat {
    /// No parity, 1 stop bit.
    #[value(name = "8N1")]
    None1,
    /// No parity, 2 stop bits.
    #[value(name = "8N2")]
    None2,
    /// Even parity.
    #[value(name = "8E1")]
    Even,
    /// Odd parity.
    #[value(name = "8O1")]
    Odd,
}

/// Frames of the MC protocol.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum McFrame {
    /// 1E.
    #[value(name = "1e")]
    E1,
    /// 3E.
    #[value(name = "3e")]
    E3,
}

fn host(text: &str) -> Result<LineEnd, String> {
    match LineEnd::parse(&format!("tcp:{text}")) {
        Ok(end @ LineEnd::Tcp(_)) if !text.starts_with("tcp:") => Ok(end),
        _ => Err("write it as HOST:PORT, such as `192.168.1.10:5000`".to_string()),
    }
}

/// Address of a PLC or a board.
pub(super) fn serial_end(text: &str) -> Result<LineEnd, String> {
    match LineEnd::parse(text)? {
        end @ (LineEnd::Path(_) | LineEnd::Tcp(_)) => Ok(end),
        _ => Err("the other end is at a serial port or at `tcp:HOST:PORT`".to_string()),
    }
}

/// Formats that files are read as when they are named.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum ReadFrom {
    /// Program memory of an FX PLC.
    Image,
}

/// Output forms of `convert`.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConvertTo {
    /// Instruction list.
    Il,
    /// The editors' list export (UTF-16, tabs).
    Csv,
    /// Device comments, as the editors export them (`COMMENT.csv`).
    Comments,
    /// Ladder diagram drawn in characters.
    Ladder,
    /// Program memory of an FX PLC.
    Image,
    /// PLCopen XML project (TC6 2.01).
    Plcopen,
    /// Lists of AutoShop's windows, each with its heading (`MAIN`, `SBR name`, `INT name I001`).
    Autoshop,
    /// Sources of a GX Works2 project, a text for each POU, structure and table of global labels, into a folder.
    St,
    /// Declarations of all labels of a GX Works2 project, with the devices that the compiler chose.
    Labels,
    /// Label tables of a GX Works2 project as it reads them from CSV, into a folder.
    LabelsCsv,
}

/// Languages of a program in PLCopen XML.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum PlcopenBody {
    /// Ladder.
    #[default]
    Ld,
    /// Instruction list of IEC 61131-3.
    Il,
    /// Sequential function chart of a step ladder (STL) program.
    Sfc,
}

impl From<PlcopenBody> for rungc_export::Body {
    fn from(body: PlcopenBody) -> Self {
        match body {
            PlcopenBody::Ld => Self::Ladder,
            PlcopenBody::Il => Self::List,
            PlcopenBody::Sfc => Self::Chart,
        }
    }
}

impl ConvertTo {
    /// Returns true for a text that a terminal can show.
    pub const fn is_text(self) -> bool {
        match self {
            ConvertTo::Il
            | ConvertTo::Ladder
            | ConvertTo::Plcopen
            | ConvertTo::Autoshop
            | ConvertTo::St
            | ConvertTo::Labels => true,
            ConvertTo::Csv | ConvertTo::Comments | ConvertTo::Image | ConvertTo::LabelsCsv => false,
        }
    }

    /// File name extension.
    pub const fn ending(self) -> &'static str {
        match self {
            ConvertTo::Il => "il",
            ConvertTo::Ladder | ConvertTo::Autoshop => "txt",
            ConvertTo::St | ConvertTo::Labels => "st",
            ConvertTo::Csv | ConvertTo::Comments | ConvertTo::LabelsCsv => "csv",
            ConvertTo::Image => "bin",
            ConvertTo::Plcopen => "xml",
        }
    }

    /// Returns true for a form of a project's sources, not of its compiled program.
    pub const fn is_of_sources(self) -> bool {
        matches!(
            self,
            ConvertTo::St | ConvertTo::Labels | ConvertTo::LabelsCsv
        )
    }

    /// Name of this form of a program; `None` for one that holds comments or sources alone.
    pub const fn form(self) -> Option<&'static str> {
        match self {
            ConvertTo::Il => Some("an instruction list"),
            ConvertTo::Ladder => Some("drawn ladder"),
            ConvertTo::Csv => Some("a list export"),
            ConvertTo::Comments | ConvertTo::St | ConvertTo::Labels | ConvertTo::LabelsCsv => None,
            ConvertTo::Image => Some("an image"),
            ConvertTo::Plcopen => Some("PLCopen XML"),
            ConvertTo::Autoshop => Some("a list of AutoShop"),
        }
    }
}

/// A table of variables and their devices.
#[derive(Clone, Debug, Default)]
pub struct NamesFile {
    /// The file as named.
    pub path: String,
    /// What it says.
    pub names: Names,
}

/// Reads a table of variables and their devices.
pub fn names(path: &str) -> Result<NamesFile, String> {
    rungc_syntax::inputs::note(path.as_ref());
    let table = fs::read(path).map_err(|error| error.to_string())?;
    let names = Names::read(&table)?;
    let path = path.to_owned();
    Ok(NamesFile { path, names })
}
