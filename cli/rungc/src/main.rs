//! The `rungc` executable. What it does is a library, which the compiler works on while those it calls are still being
//! optimised.

use std::process::ExitCode;

fn main() -> ExitCode {
    rungc_cli::main()
}
