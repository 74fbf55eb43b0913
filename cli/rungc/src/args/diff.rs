//! Arguments of `diff`.

use super::{FileKind, Reading, Reporting};
use crate::output::OutputPath;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `diff`.
#[derive(Args, Debug)]
pub struct DiffArgs {
    /// The old program and the new one, of any kind that `check` reads; `-` is standard input. With seven or nine
    /// arguments, those with which Git calls a diff driver (`rungc book diff`).
    #[arg(value_name = "FILE", required = true, num_args = 2..=9)]
    pub files: Vec<PathBuf>,
    /// Compare behaviour: list the devices that can have different values. Determines the exit code.
    #[arg(long)]
    pub semantic: bool,
    /// Format of the comparison.
    #[arg(long, value_enum, default_value_t = DiffFormat::Human)]
    pub format: DiffFormat,
    /// File to write the comparison to, overwriting an earlier one. Default: standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OutputPath>,
    /// Overwrite an existing file that is not an earlier comparison.
    #[arg(long)]
    pub force: bool,
    /// Line width of ladder diagrams, in characters. Default: the width of the terminal, or 120; 100 with `--format
    /// md`.
    #[arg(long, value_parser = clap::value_parser!(u16).range(40..=1000), value_name = "N")]
    pub width: Option<u16>,
    #[command(flatten)]
    pub kind: FileKind,
}

impl DiffArgs {
    /// Reader options for both programs.
    pub fn reading(&self) -> Reading {
        Reading {
            kind: self.kind.clone(),
            project: None,
            reporting: Reporting::default(),
        }
    }
}

/// Formats of a comparison.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum DiffFormat {
    /// Human-readable: the lines of ladder that differ.
    Human,
    /// A page with the old and new drawing of each network.
    Html,
    /// JSON: one object (`rungc book diff`).
    Json,
    /// Markdown, for a comment on a pull request.
    Md,
    /// A picture of the networks that differ, before and after.
    Svg,
}
