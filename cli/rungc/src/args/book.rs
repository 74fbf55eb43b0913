//! Arguments of the commands that print pages: `explain`, `book`, `man`.

use super::values::plc;
use clap::Args;
use rungc_models::Plc;

/// Arguments of `book`.
#[derive(Args, Debug)]
pub struct BookArgs {
    /// Page to print, as the list names it: `serve`, `test-files`. Default: list all pages.
    #[arg(value_name = "PAGE")]
    pub page: Option<String>,
}

/// Arguments of `man`.
#[derive(Args, Debug)]
pub struct ManArgs {
    /// Command whose page is printed. Default: the page of rungc itself.
    #[arg(value_name = "COMMAND")]
    pub command: Option<String>,
}

/// Arguments of `explain`.
#[derive(Args, Debug)]
pub struct ExplainArgs {
    /// A diagnostic code (E0106), an error code of the PLC (6706), an instruction (ADD, LD>=), a special device
    /// (M8013), a model (fx3u) or a variant of one (h2u-mtq), a safety function (two-hand; `functions` lists them), or
    /// a page that `rungc book` lists.
    pub topic: String,
    /// PLC model whose instructions, special devices and error codes are shown. Default: all.
    #[arg(long, value_parser = plc, value_name = "MODEL")]
    pub model: Option<Plc>,
}
