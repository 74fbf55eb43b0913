//! `cargo xtask platforms`.

use crate::{Problem, root, tools};
use rungc_golden::workspace::{self, Crates};
use std::path::Path;
use std::process::{Command, Stdio};

/// Check that the crates compile for other systems: the command line for Windows and macOS, the libraries that need no
/// operating system for WebAssembly.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Cargo profile, whose build folder is used.
    #[arg(long, default_value = "dev")]
    profile: String,
}

const WINDOWS: &str = "x86_64-pc-windows-gnu";
const MACOS: &str = "aarch64-apple-darwin";
const WASM: &str = "wasm32-unknown-unknown";

/// Crates that need the sockets and files of an operating system, and with them all that are built on one of them.
const HOSTED: [&str; 5] = [
    "rungc-dap",
    "rungc-io",
    "rungc-live",
    "rungc-lsp",
    "rungc-mcp",
];

/// Checks all targets whose standard library is installed or can be.
pub fn run(args: &Args) -> Result<(), Problem> {
    let crates = workspace::crates(&root())?;
    let portable = portable(&crates);
    let command_line = ["rungc"];
    for (target, packages) in [
        (WINDOWS, &command_line[..]),
        (MACOS, &command_line),
        (WASM, &portable),
    ] {
        if !has_library(target)? {
            eprintln!("{target}: not checked, since rustup cannot install its standard library");
            continue;
        }
        let mut cargo = tools::cargo(&["clippy", "--quiet", "--profile", &args.profile]);
        cargo.args(["--target", target]);
        for package in packages {
            cargo.args(["--package", package]);
        }
        // An error, since some of a system's own are: a function that only others use.
        tools::run(cargo.args(["--", "-D", "warnings"]))?;
        println!("{target}: {}", packages.join(", "));
    }
    Ok(())
}

/// The published crates that run in a browser.
fn portable(crates: &Crates) -> Vec<&str> {
    let is_hosted = |name: &str| {
        let reached = workspace::reached(crates, name);
        HOSTED
            .iter()
            .any(|hosted| *hosted == name || reached.contains(*hosted))
    };
    let published = crates.iter().filter(|(_, one)| one.is_published);
    let names = published.map(|(name, _)| name.as_str());
    names.filter(|name| !is_hosted(name)).collect()
}

/// Returns true if the standard library for a target is installed, perhaps only now.
fn has_library(target: &str) -> Result<bool, Problem> {
    let is_there = || -> Result<bool, Problem> {
        let mut rustc = Command::new("rustc");
        let folder = tools::output(rustc.args(["--print", "target-libdir", "--target", target]))?;
        Ok(Path::new(folder.trim()).is_dir())
    };
    if is_there()? {
        return Ok(true);
    }
    let mut rustup = Command::new("rustup");
    rustup
        .args(["target", "add", target])
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    Ok(rustup.status().is_ok_and(|status| status.success()) && is_there()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crate_on_top_of_a_hosted_one_is_not_portable() {
        let crates = workspace::crates(&root()).unwrap();
        let portable = portable(&crates);
        for name in [
            "rungc-frontend",
            "rungc-codegen-c",
            "rungc-sim",
            "rungc-verify",
        ] {
            assert!(portable.contains(&name), "{name}");
        }
        for name in ["rungc", "rungc-fleet", "rungc-io", "rungc-golden"] {
            assert!(!portable.contains(&name), "{name}");
        }
        for hosted in HOSTED {
            assert!(crates.contains_key(hosted), "there is no {hosted}");
        }
    }
}
