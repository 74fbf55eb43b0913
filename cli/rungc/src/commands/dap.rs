//! `rungc dap`.

use super::{Failure, Outcome, Result, eprint_line};
use rungc_dap::Ended;
use std::io::{self, IsTerminal};

/// Serves an editor on standard input and output.
pub fn run() -> Result {
    if io::stdin().is_terminal() {
        eprint_line(
            "rungc: dap: waiting for an editor on standard input; `rungc book debugging` shows how to set one up",
        );
    }
    let ended = rungc_dap::serve_stdio();
    match ended.map_err(|error| Failure::Because(format!("dap: {error}")))? {
        Ended::Disconnected => Ok(Outcome::Success),
        Ended::Abandoned => Ok(Outcome::Failed),
    }
}
