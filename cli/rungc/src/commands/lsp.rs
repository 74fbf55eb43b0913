//! `rungc lsp`.

use super::{Failure, Outcome, Result, eprint_line};
use rungc_lsp::Ended;
use std::io::{self, IsTerminal};

/// Serves an editor on standard input and output.
pub fn run() -> Result {
    if io::stdin().is_terminal() {
        eprint_line(
            "rungc: lsp: waiting for an editor on standard input; `rungc book editors` shows how to set one up",
        );
    }
    let ended = rungc_lsp::serve_stdio();
    match ended.map_err(|error| Failure::Because(format!("lsp: {error}")))? {
        Ended::Exit => Ok(Outcome::Success),
        Ended::Abandoned => Ok(Outcome::Failed),
    }
}
