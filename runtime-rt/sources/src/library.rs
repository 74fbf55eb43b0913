//! The static library that emitted C links: built by cargo from the sources, once for each target.

use crate::cache::{self, Slot};
use std::ffi::{OsStr, OsString};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The library's file.
pub const FILE: &str = "librungc_rt.a";

/// The file of the library with a host's services, as cargo names it.
const HOST_FILE: &str = "librungc_host.a";

/// Build recipe.
#[derive(Clone, Debug)]
pub struct Recipe<'a> {
    /// The cargo to call, with its environment.
    pub cargo: &'a Command,
    /// Identification of the toolchain.
    pub rustc: &'a OsStr,
    /// rustc's name of the target; `None` is this machine.
    pub target: Option<&'a str>,
    /// Goal of the optimisation.
    pub optimise: Optimise,
    /// True if it has a host's services, and with them the standard library in it.
    pub std: bool,
    /// More arguments of cargo, such as `-Zbuild-std=core`.
    pub cargo_args: &'a [String],
}

/// Goal of the library's optimisation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Optimise {
    /// Speed: a host.
    Speed,
    /// Size: a microcontroller.
    Size,
}

impl Optimise {
    /// The `opt-level` of cargo's profile.
    pub const fn level(self) -> &'static str {
        match self {
            Optimise::Speed => "3",
            Optimise::Size => "s",
        }
    }
}

/// Reason why there is no library.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Cargo cannot be started.
    #[error("cannot run {}: {error}", cargo.display())]
    Cargo {
        /// The called program.
        cargo: OsString,
        /// The underlying I/O error.
        error: io::Error,
    },
    /// Cargo failed.
    #[error("cargo failed:\n{output}")]
    Failed {
        /// Its output.
        output: String,
    },
    /// Files cannot be written.
    #[error("{}: {error}", path.display())]
    Io {
        /// The folder.
        path: PathBuf,
        /// The underlying I/O error.
        error: io::Error,
    },
}

/// Returns true if arguments or the environment make cargo build the standard library, too. The crates that this needs
/// may come from the registry.
pub fn builds_std(cargo_args: &[String]) -> bool {
    env::var_os("CARGO_UNSTABLE_BUILD_STD").is_some()
        || cargo_args.iter().any(|arg| arg.contains("build-std"))
}

/// Additional arguments of cargo: use only what is there.
pub fn strictly(cargo_args: &[String]) -> impl Iterator<Item = &'static str> {
    let offline = !builds_std(cargo_args);
    ["--locked"]
        .into_iter()
        .chain(offline.then_some("--offline"))
}

/// The manifest of the sources as a separate workspace, wherever their folder lies.
fn manifest(manifest: &str, host: bool) -> String {
    let members = match host {
        true => format!("members = [{:?}]\n", crate::HOST_FOLDER),
        false => String::new(),
    };
    format!(
        "{manifest}\n[workspace]\n{members}\n[profile.release]\npanic = \"abort\"\nopt-level = \"s\"\n"
    )
}

/// The files that cargo builds the library from, by their paths in one folder; with a host's services if there is a
/// `host`.
pub fn sources(host: bool) -> Vec<(String, String)> {
    let mut files = crate::files(host);
    files[0].1 = manifest(&files[0].1, host);
    let lock = crate::lock_file(host, &[]);
    files.insert(1, ("Cargo.lock".to_string(), lock));
    files
}

/// The folder of the cache with the sources. It is always the same one, so that cargo finds again what it has compiled
/// of them for another crate.
///
/// # Errors
/// The cache cannot be written.
pub fn unpacked(cache: &Path) -> io::Result<PathBuf> {
    let slot = Slot::wait(cache.join("sources"))?;
    let folder = slot.path().join("rungc-rt");
    cache::write_all(&folder, &sources(true))?;
    Ok(folder)
}

impl Recipe<'_> {
    /// A name for what is built like this with this toolchain.
    pub fn key(&self) -> String {
        let hash = cache::hash(&(
            self.target,
            self.optimise.level(),
            self.std,
            self.cargo_args,
            toolchain(self.rustc),
            env::var_os("RUSTFLAGS"),
        ));
        format!("{}-{hash:016x}", self.target.unwrap_or("host"))
    }
}

/// The library for a target, from the cache if it is there. `building` is called before it is built, which takes
/// seconds to minutes.
///
/// # Errors
/// The toolchain cannot build it, or the cache cannot be written.
pub fn build(cache: &Path, recipe: &Recipe, building: impl FnOnce()) -> Result<PathBuf, Error> {
    let folder = cache.join("runtime").join(recipe.key());
    let library = folder.join(FILE);
    if library.is_file() {
        return Ok(library);
    }
    let io = |error| Error::Io {
        path: folder.clone(),
        error,
    };
    let _slot = Slot::wait(folder.clone()).map_err(io)?;
    // Another process has built it in the meantime.
    if library.is_file() {
        return Ok(library);
    }
    building();
    let sources = unpacked(cache).map_err(io)?;
    let objects = folder.join("target");
    let built = run_cargo(recipe, &sources, &objects)?;
    // It appears whole or not at all.
    let whole = folder.join("whole.a");
    fs::copy(built, &whole).map_err(io)?;
    fs::rename(&whole, &library).map_err(io)?;
    fs::remove_dir_all(&objects).map_err(io)?;
    Ok(library)
}

/// Gives a command the variables that are set, or removed, for another one.
pub fn copy_environment(from: &Command, to: &mut Command) {
    for (name, value) in from.get_envs() {
        match value {
            Some(value) => to.env(name, value),
            None => to.env_remove(name),
        };
    }
}

/// Runs cargo in the folder of the sources; objects go to another one. Gives the library's place.
fn run_cargo(recipe: &Recipe, sources: &Path, objects: &Path) -> Result<PathBuf, Error> {
    let mut cargo = Command::new(recipe.cargo.get_program());
    copy_environment(recipe.cargo, &mut cargo);
    let (package, features, file) = match recipe.std {
        true => ("rungc-host", "capi", HOST_FILE),
        false => ("rungc-rt", "staticlib", FILE),
    };
    cargo
        .args(["rustc", "--release"])
        .args(strictly(recipe.cargo_args))
        .args(["--package", package, "--features", features])
        .args(["--crate-type", "staticlib", "--target-dir"])
        .arg(objects)
        .args(recipe.cargo_args)
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", recipe.optimise.level())
        .current_dir(sources);
    // With the standard library's part, so that nothing of its messages is left: an eighth of a Modbus slave.
    if recipe.optimise == Optimise::Size {
        cargo
            .env("CARGO_PROFILE_RELEASE_LTO", "fat")
            .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "1");
    }
    if let Some(target) = recipe.target {
        cargo.args(["--target", target]);
    }
    let output = cargo.output().map_err(|error| Error::Cargo {
        cargo: recipe.cargo.get_program().to_owned(),
        error,
    })?;
    if !output.status.success() {
        return Err(Error::Failed {
            output: String::from_utf8_lossy(&output.stderr).into_owned(),
        });
    }
    let built = match recipe.target {
        Some(target) => objects.join(target),
        None => objects.to_owned(),
    };
    Ok(built.join("release").join(file))
}

/// Version output of the compiler; empty if it cannot be called.
pub fn toolchain(rustc: &OsStr) -> Vec<u8> {
    let output = Command::new(rustc).arg("-vV").output();
    output.map(|output| output.stdout).unwrap_or_default()
}
