//! The rungc command line.
#![deny(missing_docs)]

mod args;
mod commands;
mod progress;
mod report;
mod time;

use args::{Cli, ColorWhen, Command};
use clap::{CommandFactory, Parser};
use commands::{Context, Outcome};
use std::io::{self, IsTerminal};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let cx = Context {
        color: color(cli.color),
    };
    let result = match &cli.command {
        Command::Check(args) => commands::check::run(args, cx),
        Command::Build(args) => commands::build::run(args, cx),
        Command::Run(args) => commands::run::run(args, cx),
        Command::Test(args) => commands::test::run(args, cx),
        Command::Convert(args) => commands::convert::run(args, cx),
        Command::Explain(args) => commands::explain::run(args),
        Command::Completions { shell } => {
            clap_complete::generate(*shell, &mut Cli::command(), "rungc", &mut io::stdout());
            Ok(Outcome::Success)
        }
    };
    match result {
        Ok(Outcome::Success) => ExitCode::SUCCESS,
        Ok(Outcome::Failed) => ExitCode::from(1),
        Err(failure) => {
            eprintln!("rungc: {failure}");
            ExitCode::from(2)
        }
    }
}

/// Whether to colour what goes to standard error.
fn color(when: ColorWhen) -> bool {
    match when {
        ColorWhen::Always => true,
        ColorWhen::Never => false,
        ColorWhen::Auto => io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none(),
    }
}
