//! A program with connections in the forms in which it runs: by `rungc serve`, and as an executable of C or Rust.

use crate::common::{built_in_rust, rungc, text};
use crate::tools::{self, cargo, leave_out, no_rust, with_cargo, with_library};
use std::path::Path;
use std::process::{Command, Output};

/// Form in which a program runs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// `rungc serve`.
    Serve,
    /// An executable of emitted C.
    C,
    /// An executable of emitted Rust.
    Rust,
    /// An executable of emitted C for 32-bit Arm, under QEMU.
    Arm,
}

/// The machine of [`Form::Arm`].
const ARM: &str = "armv7-unknown-linux-gnueabihf";

/// Path of the C library of [`ARM`].
const LIBRARIES: &str = "/usr/arm-linux-gnueabihf";

impl Form {
    /// Builds `p.il` of a folder; what runs it there as its `rungc.toml` says. `servers` are its options for servers.
    /// `None` where tools for another machine are missing.
    pub fn command(self, folder: &Path, model: &str, servers: &[&str]) -> Option<Command> {
        let mut args = vec!["build", "p.il", "--model", model, "--io"];
        if !servers.is_empty() {
            args.push("--servers");
        }
        let program = folder.join("p");
        // A shell's background jobs ignore interrupts, and executables leave it so.
        let mut run = Command::new("env");
        run.arg("--default-signal=INT");
        match self {
            Form::Serve => {
                let mut run = Command::new(env!("CARGO_BIN_EXE_rungc"));
                run.arg("serve");
                return Some(run);
            }
            Form::C => {
                args.extend(["--emit", "bin", "-o", "p"]);
                succeeds(&rungc(folder, &args));
                run.arg(program);
            }
            Form::Rust => {
                run.arg(built_in_rust(folder, &args, "p", "p"));
            }
            Form::Arm => {
                args.extend(["--emit", "bin", "--target", ARM, "-o", "p"]);
                succeeds(&for_arm(folder, &args)?);
                run.args(["qemu-arm", "-L", LIBRARIES]).arg(program);
            }
        }
        run.args(["--io", "rungc.toml"]).args(servers);
        Some(run)
    }

    /// Exit code of an interrupted run.
    pub fn code(self) -> i32 {
        match self {
            Form::Serve => 130,
            Form::C | Form::Rust | Form::Arm => 0,
        }
    }
}

fn succeeds(output: &Output) {
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// Calls the command line with a Rust that has the standard library for [`ARM`].
fn for_arm(folder: &Path, args: &[&str]) -> Option<Output> {
    if !tools::tools(&["make", "arm-linux-gnueabihf-gcc", "qemu-arm"]) {
        return None;
    }
    let Some(cargo) = cargo(ARM).map(with_library) else {
        leave_out(&no_rust(ARM));
        return None;
    };
    let mut rungc = with_cargo(&cargo);
    Some(rungc.args(args).current_dir(folder).output().unwrap())
}
