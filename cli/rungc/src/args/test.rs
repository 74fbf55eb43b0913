//! Arguments of `test`.

use super::EngineChoice;
use crate::output::OutputPath;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

/// Arguments of `test`.
#[derive(Args, Debug)]
pub struct TestArgs {
    /// Test files (`*.plctest.toml`), or folders of them. Default: those of rungc.toml.
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Settings of the project (`rungc book project`). Default: the rungc.toml in this folder or the nearest one above.
    #[arg(long, value_name = "FILE")]
    pub project: Option<PathBuf>,
    /// Engine to run the cases on. Default: that of rungc.toml, else the interpreter.
    #[arg(long, value_enum)]
    pub engine: Option<EngineChoice>,
    /// Simulated machine (`rungc book machines`) for cases that do not specify one.
    #[arg(long, value_name = "FILE")]
    pub machine: Option<PathBuf>,
    /// Run only cases whose `file::name` contains this.
    #[arg(long, alias = "only", value_name = "TEXT")]
    pub filter: Option<String>,
    /// Run only one part of the cases (with --mutants, of the mutants), to share the work between machines: `1/4` is
    /// the first of four. The part of a case depends on its name alone.
    #[arg(long, value_name = "PART/PARTS")]
    pub shard: Option<Shard>,
    /// Show each trace that differs from the accepted one, and prompt to accept it.
    #[arg(long, conflicts_with_all = ["accept", "reject", "watch", "shard"])]
    pub review: bool,
    /// Accept all current traces.
    #[arg(long, conflicts_with_all = ["reject", "watch"])]
    pub accept: bool,
    /// Delete pending traces of earlier tests.
    #[arg(long, conflicts_with = "watch")]
    pub reject: bool,
    /// Rerun whenever a test file, program, machine, trace or setting is saved, until Ctrl-C.
    #[arg(long = "rerun", alias = "watch", conflicts_with = "output")]
    pub watch: bool,
    /// Ignore cached results: also run cases that passed before with the same files and compiler.
    #[arg(long)]
    pub no_cache: bool,
    /// Report coverage: networks, decisive contacts, coils on and off, transitions, timers (`rungc book coverage`). All
    /// cases run in the interpreter.
    #[arg(long, value_enum, value_name = "FORMAT", conflicts_with_all = ["format", "mutants", "watch", "review", "accept", "reject"])]
    pub coverage: Option<CoverageFormat>,
    /// Report surviving mutants: small changes to the programs that no case detects (`rungc book mutants`).
    #[arg(long, conflicts_with_all = ["format", "watch", "review", "accept", "reject"])]
    pub mutants: bool,
    /// Format of the results.
    #[arg(long, value_enum, default_value_t = TestFormat::Human)]
    pub format: TestFormat,
    /// File to write the results to, or those of --coverage or --mutants, overwriting earlier ones. Default:
    /// standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OutputPath>,
    /// Overwrite an existing file that is not an earlier result.
    #[arg(long)]
    pub force: bool,
}

/// Formats of test results.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum TestFormat {
    /// Human-readable: failed cases and totals.
    Human,
    /// JUnit XML, for continuous integration.
    Junit,
    /// JSON: one object (`rungc book test-files`).
    Json,
    /// SARIF 2.1.0: failed cases with their places, for code scanning services.
    Sarif,
    /// Workflow commands of GitHub Actions, which mark the places of failed cases.
    Github,
}

/// Formats of coverage.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum CoverageFormat {
    /// Human-readable: whatever was not reached, line by line.
    Text,
    /// A page with the ladder diagram.
    Html,
    /// An LCOV tracefile, for genhtml and coverage services.
    Lcov,
}

/// One part of the cases.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Shard {
    /// Its number, from 1.
    pub part: usize,
    /// The number of parts.
    pub parts: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers =
            numbers.and_then(|(part, parts)| Some((part.parse().ok()?, parts.parse().ok()?)));
        match numbers {
            Some((part, parts)) if (1..=parts).contains(&part) => Ok(Shard { part, parts }),
            _ => Err("expected a part and the number of parts, from 1/4 to 4/4".to_string()),
        }
    }
}
