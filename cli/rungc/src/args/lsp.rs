//! Arguments of `lsp`.

use clap::Args;

/// Arguments of `lsp`.
#[derive(Args, Debug)]
pub struct LspArgs {
    /// Communicate over standard input and output, as always: editors pass this option.
    #[arg(long)]
    stdio: bool,
}
