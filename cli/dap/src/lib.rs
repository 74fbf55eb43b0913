//! A debug adapter: an editor that speaks the Debug Adapter Protocol runs a program of an FX-family PLC, stops it at
//! its instructions, and steps forwards and back in time.
//!
//! It is a front, as the language server is: the program runs on the reference interpreter, in a session of
//! `rungc-sim`. The interpreter cannot be stopped within a scan. So a place within a scan is the number of statements
//! up to it, and the adapter executes the scan again from its beginning to show the devices there. What is changed
//! from outside is recorded with its place, so that each scan is executed again as it was. Going back costs no more
//! than going forwards.
//!
//! The crates of the registry with types of the protocol (`dap`, `dap-types`, `debug_types`) are early versions, so the
//! few arguments are types of `protocol.rs`, and answers are JSON. A test holds the adapter to the client of the
//! editor's authors.
//!
//! Start reading at [`serve`], then `server.rs` (from the first message to `launch`) and `debugger.rs` (from then on);
//! `run.rs` has the run and its history, `observe.rs` what stops it.
#![deny(missing_docs)]

mod breakpoints;
mod debugger;
mod evaluate;
mod launch;
mod observe;
mod places;
mod protocol;
mod run;
mod server;
mod variables;
mod wire;

pub use server::serve;

use std::io;

/// End of a session.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ended {
    /// The editor has ended it.
    Disconnected,
    /// Its input ended before.
    Abandoned,
}

/// Serves one editor on standard input and output.
///
/// # Errors
/// Output that cannot be written.
pub fn serve_stdio() -> io::Result<Ended> {
    serve(io::stdin(), io::stdout())
}
