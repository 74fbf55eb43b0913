//! Tools for another machine that tests need. Without them a test says what is missing and that it did not run; with
//! `RUNGC_REQUIRE_EMBEDDED` set, as in CI, that is a failure.

use std::path::Path;
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

/// Whether all programs are there, or the test is to be left out.
pub fn tools(programs: &[&str]) -> bool {
    let missing: Vec<_> = programs.iter().filter(|name| !is_there(name)).collect();
    missing.iter().for_each(|name| leave_out(name));
    missing.is_empty()
}

/// What is missing where [`cargo`] is.
pub fn no_rust(target: &str) -> String {
    format!("Rust for {target} (rustup target add {target})")
}

/// A cargo that can build for a microcontroller: rustup's with the target, or a distribution's with the sources of `core`.
pub fn cargo(target: &str) -> Option<Command> {
    let libraries = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", target])
        .output()
        .ok()?;
    let folder = String::from_utf8(libraries.stdout).ok()?;
    let mut cargo = if Path::new(folder.trim()).exists() {
        Command::new("cargo")
    } else if Path::new("/usr/lib/rustlib/src/rust/library").exists() {
        let mut cargo = Command::new("/usr/bin/cargo");
        cargo
            .env("RUSTC", "/usr/bin/rustc")
            .env("RUSTC_BOOTSTRAP", "1")
            .env("CARGO_UNSTABLE_BUILD_STD", "core")
            .env(
                format!(
                    "CARGO_TARGET_{}_LINKER",
                    target.to_uppercase().replace('-', "_")
                ),
                "arm-none-eabi-ld",
            );
        cargo
    } else {
        return None;
    };
    for variable in ["CARGO", "RUSTUP_TOOLCHAIN", "RUSTFLAGS", "LD_LIBRARY_PATH"] {
        cargo.env_remove(variable);
    }
    Some(cargo)
}
