//! Arguments of the commands that show and list programs: `view`, `doc`, `xref`, `stats`.

use super::values::{code, networks};
use super::{Input, Inputs};
use crate::output::OutputPath;
use clap::{Args, ValueEnum};
use std::ops::RangeInclusive;

/// Arguments of `view`.
#[derive(Args, Debug)]
pub struct ViewArgs {
    #[command(flatten)]
    pub inputs: Inputs,
    /// Draw only these networks, by number: `12` or `12..20`; may be repeated or separated by commas.
    #[arg(long, value_parser = networks, value_name = "RANGE", value_delimiter = ',')]
    pub network: Vec<RangeInclusive<usize>>,
    /// Draw only networks that contain these devices: `M100`, `D100..D199` or a comment; may be repeated or separated
    /// by commas.
    #[arg(long, value_name = "RANGE")]
    pub device: Vec<String>,
    /// Draw only networks with a diagnostic of this code: `E0404`; may be repeated or separated by
    /// commas.
    #[arg(long, value_parser = code, value_name = "CODE", value_delimiter = ',')]
    pub around: Vec<&'static str>,
    /// Draw the sequential function chart of the step ladder instead of the networks.
    #[arg(long, conflicts_with_all = ["network", "device", "around"])]
    pub sfc: bool,
    /// Line width in characters. Default: the width of the terminal, or 120; 104 in pages and pictures.
    #[arg(long, value_parser = clap::value_parser!(u16).range(40..=1000), value_name = "N")]
    pub width: Option<u16>,
    /// Omit device comments, in the terminal.
    #[arg(long)]
    pub no_comments: bool,
    /// Write a file: a page (.html) or document (.pdf) of the whole program, or a picture (.svg) of the selected
    /// networks. With several programs, a folder for their pages.
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<OutputPath>,
    /// Overwrite an existing file.
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `doc`.
#[derive(Args, Debug)]
pub struct DocArgs {
    #[command(flatten)]
    pub input: Input,
    /// Page to write (.html), which a browser prints, or the same as data (.json).
    #[arg(short, long, value_name = "PATH")]
    pub output: OutputPath,
    /// Overwrite an existing file.
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `xref`.
#[derive(Args, Debug)]
pub struct XrefArgs {
    #[command(flatten)]
    pub inputs: Inputs,
    /// List only these devices: `M100`, `D100..D199` or a comment; may be repeated or separated by commas.
    #[arg(long, value_name = "RANGE")]
    pub device: Vec<String>,
    /// Also list general devices that no instruction uses; the page and JSON always do.
    #[arg(long)]
    pub unused: bool,
    /// Output form.
    #[arg(long, value_enum, default_value_t = XrefTo::Text)]
    pub to: XrefTo,
    /// File to write; a table also as a workbook (.xlsx). Default: standard output. With several programs, a folder for
    /// all outputs.
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<OutputPath>,
    /// Overwrite an existing file.
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `stats`.
#[derive(Args, Debug)]
pub struct StatsArgs {
    #[command(flatten)]
    pub inputs: Inputs,
    /// Output form.
    #[arg(long, value_enum, default_value_t = StatsTo::Text)]
    to: StatsTo,
    /// The same as `--to json`: its name in earlier versions.
    #[arg(long, hide = true, conflicts_with = "to")]
    json: bool,
}

impl StatsArgs {
    /// Output form.
    pub fn to(&self) -> StatsTo {
        match self.json {
            true => StatsTo::Json,
            false => self.to,
        }
    }
}

/// Output forms of `stats`.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum StatsTo {
    /// Human-readable.
    Text,
    /// JSON: one object, with a member of `programs` for each program.
    Json,
}

/// Output forms of `xref`.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum XrefTo {
    /// Human-readable: a line for each use.
    Text,
    /// A table (CSV) with a line for each use.
    Csv,
    /// A page with a search.
    Html,
    /// JSON: one object.
    Json,
    /// A table (CSV) of the terminals, used and free, with their comments.
    Io,
    /// A table (CSV) of devices as tags of a SCADA system: names, types, Modbus addresses.
    Tags,
}
