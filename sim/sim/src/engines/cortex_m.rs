//! Batches on microcontrollers that QEMU simulates: emitted code with nothing under it but a start-up file and a C
//! library.
//!
//! Standard input and output go through semihosting, so the protocol is that of executables on the host.

use super::build::{self, BuildError, io_error, make_batch, run, write};
use super::{Engine, EngineKind, Interpreter, Process};
use rungc_firmware::target;
use rungc_ir::Module;
use rungc_runtime_sources::library::{self, Optimise};
use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A microcontroller that QEMU simulates.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Board {
    /// The core's name.
    pub core: &'static str,
    /// QEMU's name of the machine.
    machine: &'static str,
    /// Rust's name of the target.
    pub target: &'static str,
    /// Optimisation level of the C compiler: results must not depend on it.
    optimisation: &'static str,
}

/// A Cortex-M3: no floating point.
pub const CORTEX_M3: Board = Board {
    core: "cortex-m3",
    machine: "mps2-an385",
    target: "thumbv7m-none-eabi",
    optimisation: "-O0",
};

/// A Cortex-M4F: floating point in single precision.
pub const CORTEX_M4: Board = Board {
    core: "cortex-m4",
    machine: "mps2-an386",
    target: "thumbv7em-none-eabihf",
    optimisation: "-O1",
};

impl Board {
    /// Options that select the processor for the C compiler.
    fn flags(&self) -> &'static str {
        target::find(self.target).map_or("", |target| target.flags)
    }
}

/// Files that every image is linked with, beside the batch: the start-up file of the example for a board, and the parts
/// for QEMU's machine.
const SUPPORT: [(&str, &str); 3] = [
    (
        "startup.c",
        include_str!(concat!(
            env!("RUNGC_ROOT"),
            "/examples/firmware/stm32f405/c/startup.c"
        )),
    ),
    ("mps2.ld", include_str!("cortex_m/mps2.ld")),
    ("semihosting.c", include_str!("cortex_m/semihosting.c")),
];

/// Linker options of an image.
const LINK: [&str; 6] = [
    "--specs=rdimon.specs",
    "-nostartfiles",
    "-Wl,--gc-sections,-z,noexecstack,--wrap=main",
    "-Tmps2.ld",
    "startup.c",
    "semihosting.c",
];

const GCC: &str = "arm-none-eabi-gcc";
const QEMU: &str = "qemu-system-arm";

/// Time-out of an answer in seconds: `.ci/run` gives simulated machines the time that other tests leave.
const PATIENCE: u32 = 300;

/// The variable that names the parts of the standard library that cargo builds from their sources.
pub const BUILD_STD: &str = "CARGO_UNSTABLE_BUILD_STD";

/// Tools missing on this computer to build for a board and to run the result; empty if there are all.
pub fn missing(board: &Board) -> Vec<String> {
    let is_there = |name: &str| Command::new(name).arg("--version").output().is_ok();
    let tools = ["make", GCC, QEMU].into_iter();
    let mut missing: Vec<_> = tools
        .filter(|name| !is_there(name))
        .map(str::to_string)
        .collect();
    if cargo(board.target).is_none() {
        missing.push(no_rust(board.target));
    }
    missing
}

/// Message for a missing Rust target, if there is a [`cargo`].
pub fn no_rust(target: &str) -> String {
    format!("Rust for {target} (rustup target add {target})")
}

/// A cargo that can build for a target without operating system: rustup's with the target, or a distribution's with the
/// sources of `core`.
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
        let variable = target.to_ascii_uppercase().replace('-', "_");
        cargo
            .env("RUSTC", "/usr/bin/rustc")
            .env("RUSTC_BOOTSTRAP", "1")
            .env(BUILD_STD, "core")
            .env(
                format!("CARGO_TARGET_{variable}_LINKER"),
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

/// Returns true if a cargo builds the standard library from its sources.
pub fn builds_library(cargo: &Command) -> bool {
    let builds = |(name, value): (&OsStr, Option<&OsStr>)| name == BUILD_STD && value.is_some();
    cargo.get_envs().any(builds)
}

/// Makes an engine that runs these programs on a board. The interpreter runs on the host only.
pub fn build_for<'m>(
    board: &Board,
    kind: EngineKind,
    modules: &'m [Module],
    folder: &Path,
) -> Result<Box<dyn Engine + 'm>, BuildError> {
    let folder = folder.join(board.core).join(kind.name());
    let image = match kind {
        EngineKind::Interp => return Ok(Box::new(Interpreter::new(modules))),
        EngineKind::C => build_c(board, modules, &folder)?,
        EngineKind::Rust => build_rust(board, modules, &folder)?,
    };
    let mut simulate = Command::new(QEMU);
    simulate
        .args(["-M", board.machine, "-display", "none"])
        .args(["-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native"])
        .arg("-kernel")
        .arg(image);
    let name = format!("{} on {}", kind.name(), board.core);
    let process = Process::new(name, simulate).with_patience(PATIENCE);
    Ok(Box::new(process))
}

/// Lets `make` build the runtime library with this cargo.
pub fn make_with(make: &mut Command, cargo: &Command) {
    library::copy_environment(cargo, make);
    make.arg(format!("CARGO={}", cargo.get_program().display()));
}

/// A cargo for a target, or that there is none as an error.
fn find_cargo(target: &str) -> Result<Command, BuildError> {
    let none = || io_error(target, ErrorKind::NotFound.into());
    let mut cargo = cargo(target).ok_or_else(none)?;
    // A standard library that is built from its sources takes crates from the registry, the first time.
    if !builds_library(&cargo) {
        cargo.env("CARGO_NET_OFFLINE", "true");
    }
    Ok(cargo)
}

fn write_support(folder: &Path) -> Result<(), BuildError> {
    let mut files = SUPPORT.iter();
    files.try_for_each(|(name, text)| write(&folder.join(name), text))?;
    // The emitted Makefile does not know these files: linking again is cheap.
    match std::fs::remove_file(folder.join("batch")) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(io_error(folder.display(), error)),
        _ => Ok(()),
    }
}

fn build_c(board: &Board, modules: &[Module], folder: &Path) -> Result<PathBuf, BuildError> {
    write_support(folder)?;
    let mut make = Command::new("make");
    make.arg(format!("CC={GCC}"))
        .arg(format!("TARGET={}", board.target))
        .arg(format!("LDFLAGS={}", LINK.join(" ")));
    let cargo = find_cargo(board.target)?;
    make_with(&mut make, &cargo);
    let runtime = build::runtime(&cargo, Some(board.target), Optimise::Size);
    let flags = format!("{} {}", board.flags(), board.optimisation);
    let files = rungc_codegen_c::batch(modules);
    make_batch(&mut make, &flags, runtime.as_deref(), files, folder)
}

fn build_rust(board: &Board, modules: &[Module], folder: &Path) -> Result<PathBuf, BuildError> {
    write_support(folder)?;
    build::write_files(rungc_codegen_rust::batch(modules), folder)?;
    let target = folder.join("target");
    run(find_cargo(board.target)?
        .args(["rustc", "--quiet", "--lib", "--crate-type", "staticlib"])
        .args(["--features", "bare", "--target", board.target])
        .arg("--target-dir")
        .arg(&target)
        .current_dir(folder))?;
    let image = folder.join("batch.elf");
    run(Command::new(GCC)
        .args(board.flags().split(' '))
        .arg("-o")
        .arg(&image)
        .args(LINK)
        .arg(target.join(board.target).join("debug/libbatch.a"))
        .current_dir(folder))?;
    Ok(image)
}
