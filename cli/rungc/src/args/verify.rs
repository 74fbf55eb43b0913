//! Arguments of `verify`.

use super::{EngineChoice, Input, Properties};
use crate::output::OutputPath;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `verify`.
#[derive(Args, Debug)]
pub struct VerifyArgs {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub properties: Properties,
    /// Compare with this older program instead: can an output differ, given the same inputs at the same times?
    #[arg(
        long,
        value_name = "OLD",
        conflicts_with_all = ["never", "always", "reachable", "aiger", "btor2", "write_test"],
    )]
    pub same_as: Option<PathBuf>,
    /// Engines that must confirm a run before it is reported, in addition to the interpreter; those of C and Rust are
    /// built first. `all`: those that can be built here.
    #[arg(long, value_enum, value_name = "ENGINE")]
    pub replay: Option<EngineChoice>,
    /// Latched devices start at 0, as in a new PLC. Default: at any value.
    #[arg(long)]
    pub cleared: bool,
    /// Limit of the effort per property, in steps of the search; 1000 are about a second. What is found does not depend
    /// on the machine or its load. Default: that of rungc.toml, else 10000, or no limit with a time limit.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..), value_name = "NUMBER")]
    pub effort: Option<u64>,
    /// Time limit per property, in real time. With it, verdicts depend on the speed of the machine. Default: that of
    /// rungc.toml, or none.
    #[arg(long, value_parser = crate::time::parse, value_name = "TIME")]
    pub timeout: Option<u64>,
    /// Write the single property as a model for other model checkers (AIGER): the property is violated if the model's
    /// output can be on.
    #[arg(long, value_name = "FILE")]
    pub aiger: Option<OutputPath>,
    /// Write the same model in BTOR2, in which bits are named after their devices.
    #[arg(long, value_name = "FILE")]
    pub btor2: Option<OutputPath>,
    /// Write the proof to this folder as formulas (`*.cnf`) that any SAT solver can confirm to be unsatisfiable; each
    /// of several properties has a folder in it. With --same-as, the proofs of all equal outputs.
    #[arg(long, value_name = "FOLDER")]
    pub certificate: Option<OutputPath>,
    /// Also write a proof of each formula (`*.drat`, DRAT) for a proof checker; made by `cadical`, which must be
    /// installed.
    #[arg(long, requires = "certificate")]
    pub drat: bool,
    /// Write the runs found to a test file, whose cases fail until the program is repaired: `rungc test FILE`.
    #[arg(long, value_name = "FILE")]
    pub write_test: Option<OutputPath>,
    /// Write a report for an assessor (`rungc book requirements`): requirements, proofs, assumptions, gaps, runs and
    /// tests. A page (.html), a document (.pdf) or JSON (.json).
    #[arg(long, value_name = "FILE")]
    pub report: Option<OutputPath>,
    /// With --report: count the mutants (`rungc book mutants`) that the cases of each requirement notice.
    #[arg(long, requires = "report", conflicts_with = "same_as")]
    pub mutants: bool,
    /// Output file for the verdicts, in the format of --format; overwrites earlier ones. Default: standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OutputPath>,
    /// Overwrite an existing file.
    #[arg(long)]
    pub force: bool,
}
