//! Builds executables from the emitted C and Rust of a batch of programs.

use super::{Engine, Interpreter, Process};
use crate::threads::Threads;
use rungc_codegen_c::OutFile;
use rungc_ir::Module;
use rungc_runtime_sources::cache;
use rungc_runtime_sources::library::{self, Optimise, Recipe};
use std::env;
use std::ffi::OsString;
use std::hash::Hash;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The engines there are.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum EngineKind {
    /// The reference interpreter.
    Interp,
    /// Emitted C, built by `make` with the C compiler `cc`.
    C,
    /// Emitted Rust, built by `cargo`.
    Rust,
}

impl EngineKind {
    /// All of them.
    pub const ALL: [EngineKind; 3] = [EngineKind::Interp, EngineKind::C, EngineKind::Rust];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            EngineKind::Interp => "interp",
            EngineKind::C => "c",
            EngineKind::Rust => "rust",
        }
    }

    /// The engine with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// Reason why an executable could not be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// A file could not be written, or a tool not be started.
    #[error("{what}: {error}")]
    Io {
        /// The file or the tool.
        what: String,
        /// The underlying I/O error.
        error: io::Error,
    },
    /// A tool rejected the emitted code, which is an error of the compiler.
    #[error("{command} failed:\n{output}")]
    Tool {
        /// The command.
        command: String,
        /// The end of what it says.
        output: String,
    },
}

/// Programs that are ready to run on an engine, of which there may be several at once.
#[derive(Clone, Debug)]
pub struct Ready<'m> {
    kind: EngineKind,
    modules: &'m [Module],
    /// The executable; none for the interpreter.
    command: PathBuf,
}

impl<'m> Ready<'m> {
    /// An engine.
    pub fn start(&self) -> Box<dyn Engine + 'm> {
        match self.kind {
            EngineKind::Interp => Box::new(Interpreter::new(self.modules)),
            EngineKind::C | EngineKind::Rust => {
                let command = Command::new(&self.command);
                Box::new(Process::new(self.kind.name(), command))
            }
        }
    }
}

/// Makes programs ready for an engine. Sources and objects go to `folder`, which may be used again: what has not
/// changed is not built again.
///
/// # Errors
/// A file cannot be written, a tool is not there or rejects what was emitted.
pub fn prepare<'m>(
    kind: EngineKind,
    modules: &'m [Module],
    folder: &Path,
) -> Result<Ready<'m>, BuildError> {
    let folder = folder.join(kind.name());
    let command = match kind {
        // Nothing will be asked of it: all cases are about programs that do not compile.
        EngineKind::C | EngineKind::Rust if modules.is_empty() => PathBuf::new(),
        EngineKind::Interp => PathBuf::new(),
        EngineKind::C => build_c(modules, &folder)?,
        EngineKind::Rust => build_rust(modules, &folder)?,
    };
    Ok(Ready {
        kind,
        modules,
        command,
    })
}

/// As [`prepare`], for one engine.
///
/// # Errors
/// Those of [`prepare`].
pub fn build<'m>(
    kind: EngineKind,
    modules: &'m [Module],
    folder: &Path,
) -> Result<Box<dyn Engine + 'm>, BuildError> {
    Ok(prepare(kind, modules, folder)?.start())
}

impl From<io::Error> for BuildError {
    fn from(error: io::Error) -> Self {
        io_error("the folder of executables", error)
    }
}

/// Hash of all that an executable is made of: files, the compiler, its flags.
fn hash_of(files: &[OutFile], made_by: impl Hash) -> u64 {
    let files: Vec<_> = files
        .iter()
        .map(|file| (&file.path, &file.contents))
        .collect();
    cache::hash(&(files, made_by))
}

pub(super) fn io_error(what: impl std::fmt::Display, error: io::Error) -> BuildError {
    BuildError::Io {
        what: what.to_string(),
        error,
    }
}

pub(super) fn write(path: &Path, text: &str) -> Result<(), BuildError> {
    cache::write(path, text).map_err(|error| io_error(path.display(), error))
}

/// Lines of a tool's output that an error quotes.
const QUOTED_LINES: usize = 60;

pub(super) fn run(command: &mut Command) -> Result<(), BuildError> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command
        .output()
        .map_err(|error| io_error(&program, error))?;
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stderr);
    let quoted: Vec<&str> = text.lines().take(QUOTED_LINES).collect();
    Err(BuildError::Tool {
        command: format!("{command:?}"),
        output: quoted.join("\n"),
    })
}

/// Writes the files of a batch.
pub(super) fn write_files(files: Vec<OutFile>, folder: &Path) -> Result<(), BuildError> {
    let mut files = files.into_iter();
    files.try_for_each(|file| write(&folder.join(&file.path), &file.contents))
}

fn build_rust(modules: &[Module], folder: &Path) -> Result<PathBuf, BuildError> {
    let files = rungc_codegen_rust::batch(modules);
    let made_by = (library::toolchain(&rustc()), env::var_os("RUSTFLAGS"));
    cache::executable(folder, hash_of(&files, made_by), || {
        write_files(files, folder)?;
        let target = folder.join("target");
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        run(Command::new(cargo)
            .args(["build", "--offline", "--quiet", "--target-dir"])
            .arg(&target)
            .current_dir(folder))?;
        Ok(target.join("debug").join("batch"))
    })
}

/// The Rust compiler.
fn rustc() -> OsString {
    env::var_os("RUSTC").unwrap_or_else(|| "rustc".into())
}

/// Flags with which emitted C must compile without a warning.
const C_FLAGS: &str = "-std=c99 -Wall -Wextra -Wconversion -Werror -O1";

/// The runtime as a static library, from the cache. `None` where that does not work: then `make` builds it and says
/// why it fails.
pub(super) fn runtime(
    cargo: &Command,
    target: Option<&str>,
    optimise: Optimise,
) -> Option<PathBuf> {
    let mut variables = cargo.get_envs();
    let rustc = variables.find_map(|(name, value)| value.filter(|_| name == "RUSTC"));
    let usual = self::rustc();
    let recipe = Recipe {
        cargo,
        rustc: rustc.unwrap_or(&usual),
        target,
        optimise,
        std: false,
        cargo_args: &[],
    };
    library::build(&cache::folder().ok()?, &recipe, || {}).ok()
}

/// The runtime for this machine as a static library, from the cache; `None` where it cannot be built or kept.
pub fn host_runtime() -> Option<PathBuf> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    runtime(&Command::new(cargo), None, Optimise::Speed)
}

/// Writes the C files of a batch, and lets `make` build it, with these flags in addition to the standard ones, and link
/// this runtime.
pub(super) fn make_batch(
    make: &mut Command,
    flags: &str,
    runtime: Option<&Path>,
    files: Vec<OutFile>,
    folder: &Path,
) -> Result<PathBuf, BuildError> {
    write_files(files, folder)?;
    if let Some(runtime) = runtime {
        make.arg(format!("RUNGC_RT={}", runtime.display()));
    }
    let jobs = Threads::usual().count();
    run(make
        .arg(format!("-j{jobs}"))
        .arg(format!("CFLAGS={C_FLAGS} {flags}"))
        .current_dir(folder))?;
    Ok(folder.join("batch"))
}

fn build_c(modules: &[Module], folder: &Path) -> Result<PathBuf, BuildError> {
    let runtime = host_runtime();
    let files = rungc_codegen_c::batch(modules);
    // The runtime's folder is named after its toolchain.
    let variables = ["CC", "LDFLAGS", "CARGO"].map(env::var_os);
    cache::executable(
        folder,
        hash_of(&files, (&runtime, C_FLAGS, variables)),
        || {
            let make = &mut Command::new("make");
            make_batch(make, "", runtime.as_deref(), files, folder)
        },
    )
}

/// Emitted C with the runtime's parts in C before those of the library. Otherwise as [`build`].
pub fn build_c_with_parts<'m>(
    modules: &'m [Module],
    folder: &Path,
) -> Result<Box<dyn Engine + 'm>, BuildError> {
    let command = make_batch(
        &mut Command::new("make"),
        "-Wsign-conversion",
        host_runtime().as_deref(),
        rungc_codegen_c::batch_in_c(modules),
        &folder.join("c-parts"),
    )?;
    let name = EngineKind::C.name();
    Ok(Box::new(Process::new(name, Command::new(command))))
}

/// Builds the executable of a program in a folder, by `cc`: what is emitted with these options, and this `main`. One
/// that was built there of the same is taken again.
///
/// # Errors
/// A file that cannot be written, a C compiler that is not there or rejects what was emitted.
pub fn build_with_main(
    module: &Module,
    options: &rungc_codegen_c::Options,
    main: &str,
    folder: &Path,
) -> Result<PathBuf, BuildError> {
    const FLAGS: [&str; 2] = ["-std=c99", "-O2"];
    let files = rungc_codegen_c::emit(module, options);
    cache::executable(folder, hash_of(&files, (main, FLAGS)), || {
        let mut command = Command::new("cc");
        command.args(FLAGS);
        command.args(["-o", "executable", "with_main.c"]);
        write(&folder.join("with_main.c"), main)?;
        let paths = files.iter().map(|file| &file.path);
        command.args(paths.filter(|path| path.ends_with(".c")));
        write_files(files, folder)?;
        run(command.current_dir(folder))?;
        Ok(folder.join("executable"))
    })
}

/// Emitted C, built by this compiler with these flags in addition to those that it must compile with; where they let
/// the compiler see more, its warnings are none of the code's. Otherwise as [`build`].
pub fn build_c_with<'m>(
    compiler: &str,
    flags: &str,
    modules: &'m [Module],
    folder: &Path,
) -> Result<Box<dyn Engine + 'm>, BuildError> {
    let mut make = Command::new("make");
    make.arg(format!("CC={compiler}"));
    let flags = format!("-Wno-error {flags}");
    let command = make_batch(
        &mut make,
        &flags,
        host_runtime().as_deref(),
        rungc_codegen_c::batch(modules),
        &folder.join(EngineKind::C.name()),
    )?;
    let name = EngineKind::C.name();
    Ok(Box::new(Process::new(name, Command::new(command))))
}
