//! Arguments of `mcp`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `mcp`.
#[derive(Args, Debug)]
pub struct McpArgs {
    /// Folder whose files may be read, with those below it; links that lead out of it are not followed. May be
    /// repeated; paths begin at the first. Default: the current folder.
    #[arg(long, value_name = "DIR")]
    pub root: Vec<PathBuf>,
    /// Folder in which programs and test files may be written. A file that was there before is never replaced. Default:
    /// none.
    #[arg(long, value_name = "DIR")]
    pub allow_write: Option<PathBuf>,
}
