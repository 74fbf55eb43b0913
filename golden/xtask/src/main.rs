//! Chores of the repository that need its crates: `cargo xtask generate` makes every generated file, `cargo xtask
//! package` the crates that are published, `cargo xtask dist` the packages that users install, `cargo xtask platforms`
//! checks other systems, `cargo xtask campaign` compares engines for hours, `cargo xtask pairs` measures the prover,
//! `cargo xtask sources` the compiler of structured text. No crate may depend on this one. Start reading at
//! `generate.rs`, the table of generated files.

mod book;
mod campaign;
mod crates;
mod dist;
mod generate;
mod header;
mod package;
mod pairs;
mod platforms;
mod rungc;
mod sources;
mod tools;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Chores of the repository.
#[derive(Parser, Debug)]
#[command(name = "cargo xtask")]
struct Args {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand, Debug)]
enum Chore {
    /// Write the generated files, or check that they are up to date.
    Generate(generate::Args),
    /// Check that every published crate builds from its package alone, or publish them.
    Package(package::Args),
    /// Make the packages that users install.
    Dist(dist::Args),
    /// Check that the crates compile for Windows, macOS and WebAssembly.
    Platforms(platforms::Args),
    /// Compare random programs on every way to run them, for hours.
    Campaign(campaign::Args),
    /// Measure the prover's precision: decide which outputs of real programs exclude each other.
    Pairs(pairs::Args),
    /// Compare the structured text of real projects with what GX Works2 compiled.
    Sources(sources::Args),
}

/// Error of a chore, as a message.
type Problem = Box<dyn std::error::Error>;

/// The repository's root.
fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

fn main() -> ExitCode {
    let done = match Args::parse().chore {
        Chore::Generate(args) => generate::run(&args),
        Chore::Package(args) => package::run(&args),
        Chore::Dist(args) => dist::run(&args),
        Chore::Platforms(args) => platforms::run(&args),
        Chore::Campaign(args) => campaign::run(&args),
        Chore::Pairs(args) => pairs::run(&args),
        Chore::Sources(args) => sources::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}
