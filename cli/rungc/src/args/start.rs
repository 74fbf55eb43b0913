//! Arguments of the commands for a first hour: `init`, `demo`, `doctor`.

use crate::output::OutputPath;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `init`.
#[derive(Args, Debug)]
pub struct InitArgs {
    /// The program of the project; both files are written to its folder. Default: the only program in this folder.
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
}

/// Arguments of `demo`.
#[derive(Args, Debug)]
pub struct DemoArgs {
    /// Folder to write the project to; no file of the project may exist there.
    #[arg(value_name = "DIR", default_value = "rungc-demo")]
    pub folder: OutputPath,
}

/// Arguments of `doctor`.
#[derive(Args, Debug)]
pub struct DoctorArgs {
    /// Output format.
    #[arg(long, value_enum, default_value_t = DoctorFormat::Human)]
    pub format: DoctorFormat,
}

/// Formats of `doctor`.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum DoctorFormat {
    /// Human-readable.
    Human,
    /// JSON: one object.
    Json,
}
