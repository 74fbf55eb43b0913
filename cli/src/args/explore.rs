//! Arguments of `explore`.

use super::{EngineChoice, Input, Properties};
use clap::{Args, ValueEnum};
use rungc_explore::Kind;
use std::path::PathBuf;

/// Arguments of `explore`.
#[derive(Args, Debug)]
pub struct ExploreArgs {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub asked: Properties,
    /// Simulated machine, whose axes, cylinders and delays follow the outputs and drive inputs (docs/src/machines.md).
    #[arg(long, value_name = "FILE")]
    pub machine: Option<PathBuf>,
    /// What latched devices hold when a run begins.
    #[arg(long, value_enum, default_value_t = Latched::Zero)]
    pub latched: Latched,
    /// Do not search for this. Repeat it for more.
    #[arg(long, value_enum, value_name = "KIND")]
    pub ignore: Vec<Ignored>,
    /// How many scans to execute.
    #[arg(long, default_value_t = 200_000, value_name = "COUNT")]
    pub scans: u64,
    /// How long to search, in real time: also stop then. What is found then depends on how fast the machine is.
    #[arg(long = "for", value_parser = crate::time::parse, value_name = "TIME")]
    pub duration: Option<u64>,
    /// Stop at the first thing found.
    #[arg(long)]
    pub first: bool,
    /// What random numbers begin with: another seed, another search.
    #[arg(long, default_value_t = 1, value_name = "NUMBER")]
    pub seed: u64,
    /// How many threads search. Default: one for each processor. What they find does not depend on it.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
    /// What executes the search. What is found does not depend on it.
    #[arg(long, value_enum, default_value_t = SearchEngine::Auto)]
    pub engine: SearchEngine,
    /// Engines on which each run must show the same before it is reported; those of C and Rust are built first.
    #[arg(long, value_enum, default_value_t = EngineChoice::Interp)]
    pub replay: EngineChoice,
    /// Write the runs as a test file, which fails as long as the program does this: `rungc test FILE`.
    #[arg(long, value_name = "FILE")]
    pub write_test: Option<PathBuf>,
    /// Record the run of the first thing found as a value change dump; overwrites an existing file.
    #[arg(long, value_name = "FILE")]
    pub vcd: Option<PathBuf>,
    /// Overwrite an existing test file.
    #[arg(long)]
    pub force: bool,
}

/// What latched devices hold when a run begins.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Latched {
    /// 0, as in a new PLC.
    Zero,
    /// What an earlier run has saved: the search also switches the power off and on.
    Saved,
}

/// What executes a search.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum SearchEngine {
    /// Lanes from 1,000,000 scans on, if the program permits them and `cc` is there.
    Auto,
    /// The interpreter.
    Interp,
    /// Emitted C that runs 64 sequences of inputs at once.
    Lanes,
}

/// What a search leaves out.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ignored {
    /// Operation errors (M8067).
    Errors,
    /// Scans that do not end.
    Watchdog,
    /// Outputs that two coils drive differently in one scan.
    Coils,
    /// Outputs that change in every scan.
    Oscillation,
    /// Axes that run into an end of their travel.
    Collisions,
}

impl Ignored {
    /// What it is to the search.
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
