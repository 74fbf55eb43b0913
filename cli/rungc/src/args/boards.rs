//! Arguments of `boards`.

use crate::output::OutputPath;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `boards`.
#[derive(Args, Debug)]
pub struct BoardsArgs {
    /// Board to show: a name, or a description (`rungc book boards`). Default: list all boards.
    #[arg(value_name = "BOARD")]
    pub board: Option<PathBuf>,
    /// Print the description as TOML, as a template for your own board.
    #[arg(long, requires = "board", group = "made")]
    pub toml: bool,
    /// Build an image that checks the wiring of pins: it reports inputs over a serial port, and switches one output at
    /// a time when a key is sent to it.
    #[arg(long, requires = "board", requires = "output", group = "made")]
    pub pins_only: bool,
    /// File to write: the image, or the description. Default for --toml: standard output.
    #[arg(short, long, value_name = "FILE", requires = "made")]
    pub output: Option<OutputPath>,
    /// Overwrite an existing file.
    #[arg(long, requires = "output")]
    pub force: bool,
}
