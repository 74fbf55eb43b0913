//! Arguments of `verify`.

use super::{EngineChoice, Input, Properties};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `verify`.
#[derive(Args, Debug)]
pub struct VerifyArgs {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub asked: Properties,
    /// Compare with this older program instead: can an output differ, given the same inputs at the same times?
    #[arg(
        long,
        value_name = "OLD",
        conflicts_with_all = ["never", "always", "reachable", "aiger", "btor2", "write_test"],
    )]
    pub same_as: Option<PathBuf>,
    /// The engines that must show a run before it is reported, beside the interpreter. Default: all that can be built
    /// here.
    #[arg(long, value_enum, value_name = "ENGINE")]
    pub replay: Option<EngineChoice>,
    /// Latched devices begin with 0, as on a new PLC. Default: with any value.
    #[arg(long)]
    pub cleared: bool,
    /// How long to try, for each property. Default: that of rungc.toml, or 60s.
    #[arg(long, value_parser = crate::time::parse, value_name = "TIME")]
    pub timeout: Option<u64>,
    /// Write what is asked of the only property as a file that other model checkers read (AIGER): they find out whether
    /// its output can be on.
    #[arg(long, value_name = "FILE")]
    pub aiger: Option<PathBuf>,
    /// The same in another format (BTOR2), in which bits have the names of the devices that they belong to.
    #[arg(long, value_name = "FILE")]
    pub btor2: Option<PathBuf>,
    /// Write the proof of the only property into this folder, or with --same-as the proofs of all outputs that are the
    /// same, as formulas (`*.cnf`) that any SAT solver confirms to be unsatisfiable.
    #[arg(long, value_name = "FOLDER")]
    pub certificate: Option<PathBuf>,
    /// Also write a proof of each formula beside it (`*.drat`, DRAT), whose steps a proof checker can follow: made by
    /// `cadical`, which must be installed.
    #[arg(long, requires = "certificate")]
    pub drat: bool,
    /// Write the runs that were found as a test file, which shows them again: `rungc test FILE`.
    #[arg(long, value_name = "FILE")]
    pub write_test: Option<PathBuf>,
    /// File to write the verdicts to, in the format of --format, overwriting an existing one. Default: standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overwrite an existing file.
    #[arg(long)]
    pub force: bool,
}
