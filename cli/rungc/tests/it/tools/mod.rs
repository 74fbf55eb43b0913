//! Tools for another machine that tests need. Without them a test reports what is missing and that it did not run; with
//! `RUNGC_REQUIRE_EMBEDDED` set, as in CI, that is a failure.
#![cfg_attr(
    not(all(unix, feature = "mqtt")),
    allow(dead_code, reason = "tests with brokers and on Unix use the rest")
)]

use rungc_sim::engines::cortex_m::{BUILD_STD, builds_library};
pub use rungc_sim::engines::cortex_m::{cargo, no_rust};
use std::process::Command;

fn is_there(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok()
}

/// Says that a test does not run, or fails where it has to.
pub fn leave_out(missing: &str) {
    let required = std::env::var_os("RUNGC_REQUIRE_EMBEDDED").is_some();
    assert!(!required, "missing: {missing}");
    eprintln!("not run: there is no {missing}");
}

/// Returns true if all programs are installed; otherwise the test is left out.
pub fn tools(programs: &[&str]) -> bool {
    let missing: Vec<_> = programs.iter().filter(|name| !is_there(name)).collect();
    missing.iter().for_each(|name| leave_out(name));
    missing.is_empty()
}

/// The command line with the cargo of [`cargo`].
pub fn with_cargo(cargo: &Command) -> Command {
    let mut rungc = Command::new(env!("CARGO_BIN_EXE_rungc"));
    for (name, value) in cargo.get_envs() {
        match value {
            Some(value) => rungc.env(name, value),
            None => rungc.env_remove(name),
        };
    }
    rungc.env("CARGO", cargo.get_program());
    rungc
}

/// The same cargo for what needs the standard library: a distribution's builds it from its sources, here quickly.
pub fn with_library(mut cargo: Command) -> Command {
    if builds_library(&cargo) {
        cargo.env(BUILD_STD, "std,panic_abort");
        cargo.env("RUSTFLAGS", "-Copt-level=0");
    }
    cargo
}
