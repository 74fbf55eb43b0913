//! Arguments of `explore`.

use super::{EngineChoice, Input, Properties};
use crate::output::OutputPath;
use clap::{Args, ValueEnum};
use rungc_explore::Kind;
use std::path::PathBuf;

/// Arguments of `explore`.
#[derive(Args, Debug)]
pub struct ExploreArgs {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub properties: Properties,
    /// Simulated machine, whose axes, cylinders and delays follow the outputs and drive inputs (`rungc book machines`).
    #[arg(long, value_name = "FILE")]
    pub machine: Option<PathBuf>,
    /// Values of latched devices at the start of a run.
    #[arg(long, value_enum, default_value_t = Latched::Zero)]
    pub latched: Latched,
    /// Do not search for this kind of finding; may be repeated or separated by commas.
    #[arg(long, value_enum, value_name = "KIND", value_delimiter = ',')]
    pub ignore: Vec<Ignored>,
    /// Number of scans to execute; a round of the search that has begun is completed.
    #[arg(long, default_value_t = 200_000, value_name = "COUNT")]
    pub scans: u64,
    /// Time limit of the search, in real time. With it, results depend on the speed of the machine.
    #[arg(long, alias = "for", value_parser = crate::time::parse, value_name = "TIME")]
    pub timeout: Option<u64>,
    /// Stop at the first finding.
    #[arg(long)]
    pub first: bool,
    /// Random seed: another seed searches differently.
    #[arg(long, default_value_t = 1, value_name = "NUMBER")]
    pub seed: u64,
    /// Number of threads. Default: one per processor. Does not affect the results.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
    /// Engine of the search. Does not affect the results.
    #[arg(long, value_enum, default_value_t = SearchEngine::Auto)]
    pub engine: SearchEngine,
    /// Engines that must confirm each finding before it is reported; those of C and Rust are built first.
    #[arg(long, value_enum, default_value_t = EngineChoice::Interp, value_name = "ENGINE")]
    pub replay: EngineChoice,
    /// Write the runs to a test file, which fails until the program is corrected: `rungc test FILE`.
    #[arg(long, value_name = "FILE")]
    pub write_test: Option<OutputPath>,
    /// Record the run of the first finding as a value change dump; overwrites an earlier one.
    #[arg(long, value_name = "FILE")]
    pub vcd: Option<OutputPath>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
}

/// Values of latched devices at the start of a run.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Latched {
    /// 0, as in a new PLC.
    Zero,
    /// Values saved by an earlier run: the search also switches the power off and on.
    Saved,
}

/// Engine of a search.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum SearchEngine {
    /// Lanes from 1,000,000 scans on, if the program allows them and `cc` is installed.
    Auto,
    /// The interpreter.
    Interp,
    /// Emitted C that runs 64 sequences of inputs at once.
    Lanes,
}

/// Kinds of finding that a search can omit.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ignored {
    /// Operation errors (M8067).
    Errors,
    /// Endless scans.
    Watchdog,
    /// Outputs that two coils drive to different values in one scan.
    Coils,
    /// Outputs that change in every scan.
    Oscillation,
    /// Axes that reach an end of their travel.
    Collisions,
}

impl Ignored {
    /// The search's kind of finding.
    pub fn kind(self) -> Kind {
        match self {
            Ignored::Errors => Kind::Errors,
            Ignored::Watchdog => Kind::Watchdog,
            Ignored::Coils => Kind::Doubled,
            Ignored::Oscillation => Kind::Oscillation,
            Ignored::Collisions => Kind::Collisions,
        }
    }
}
