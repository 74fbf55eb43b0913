//! The rungc command line.
#![deny(missing_docs)]

mod args;
mod report;
mod time;

use clap::Parser;

fn main() {
    let cli = args::Cli::parse();
    println!("{cli:?}");
}
