//! Arguments of `dap`.

use clap::Args;

/// Arguments of `dap`.
#[derive(Args, Debug)]
pub struct DapArgs {
    /// Communicate over standard input and output, as always: editors pass this option.
    #[arg(long)]
    stdio: bool,
}
