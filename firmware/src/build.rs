//! Calls of the compilers for another machine, and what to say where one is missing.

use crate::image::{self, Image};
use crate::package::Library;
use crate::target::Target;
use rungc_codegen_rust::Runtime;
use rungc_emit::OutFile;
use rungc_ir::Module;
use rungc_ir::node::{Function, FunctionKind};
use rungc_runtime_sources::cache::{self, Slot};
use rungc_runtime_sources::library::{self, Recipe};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{env, fs};

/// Reason why nothing was built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// A compiler or a library for the target is missing.
    #[error("{0}")]
    Missing(String),
    /// A compiler or `make` failed.
    #[error("{what} failed:\n{output}")]
    Failed {
        /// The tool.
        what: String,
        /// Its output.
        output: String,
    },
    /// Files could not be written or read.
    #[error("{}: {error}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The underlying I/O error.
        error: std::io::Error,
    },
}

/// The compilers for a target, by the environment: `CC_thumbv7em_none_eabihf` and `AR_…` name C's, for this machine
/// also `CC` and `AR`; `CARGO` and `RUSTC` name Rust's.
#[derive(Clone, Debug)]
pub struct Tools {
    announce: fn(&str),
    target: &'static Target,
    cc: OsString,
    ar: OsString,
    cargo: OsString,
    rustc: OsString,
    cargo_args: Vec<String>,
    std: bool,
}

fn variable(name: &str, default: &str) -> OsString {
    env::var_os(name).unwrap_or_else(|| default.into())
}

fn io(path: &Path) -> impl FnOnce(std::io::Error) -> BuildError + '_ {
    move |error| BuildError::Io {
        path: path.to_path_buf(),
        error,
    }
}

impl Tools {
    /// The compilers for a target; cargo is called with the additional arguments `cargo_args`.
    pub fn new(target: &'static Target, cargo_args: &[String]) -> Self {
        let named = |tool: &str, name: &str| {
            let of_target = format!("{tool}_{}", target.variable());
            let general = target.rustc_name().is_none().then(|| env::var_os(tool));
            env::var_os(of_target)
                .or(general.flatten())
                .filter(|named| !named.is_empty())
                .unwrap_or_else(|| name.into())
        };
        Tools {
            announce: |_| {},
            target,
            cc: named("CC", target.cc),
            ar: named("AR", target.ar),
            cargo: variable("CARGO", "cargo"),
            rustc: variable("RUSTC", "rustc"),
            cargo_args: cargo_args.to_vec(),
            std: false,
        }
    }

    /// Says what takes long, before it is done.
    #[must_use]
    pub fn announcing(mut self, announce: fn(&str)) -> Self {
        self.announce = announce;
        self
    }

    /// Selects whether the runtime library has connections, and with them the standard library in it.
    #[must_use]
    pub fn with_std(mut self, std: bool) -> Self {
        self.std = std;
        self
    }

    /// The C compiler, as a command.
    pub fn c_compiler(&self) -> &OsStr {
        &self.cc
    }

    /// Checks that C can be built.
    ///
    /// # Errors
    /// The compiler or its C library is missing.
    pub fn check_c(&self) -> Result<(), BuildError> {
        let Target {
            triple, packages, ..
        } = self.target;
        let found = Command::new(&self.cc).arg("--version").output();
        if found.is_err() {
            return Err(BuildError::Missing(format!(
                "{} not found (the C compiler for {triple}): on Debian and Ubuntu, `apt install {packages}`; \
                 {} selects another compiler",
                self.cc.display(),
                self.target.compiler_variable()
            )));
        }
        let folder = tempfile::tempdir().map_err(io(Path::new("temporary folder")))?;
        let probe = folder.path().join("probe.c");
        fs::write(&probe, "#include <string.h>\n").map_err(io(&probe))?;
        let read = Command::new(&self.cc).arg("-E").arg(&probe).output();
        let said = match read {
            Ok(output) if output.status.success() => return Ok(()),
            Ok(output) => String::from_utf8_lossy(&output.stderr).into_owned(),
            Err(error) => error.to_string(),
        };
        let cc = self.cc.display();
        Err(BuildError::Missing(match said.contains("string.h") {
            true => format!(
                "{cc} has no C library for {triple} (string.h): on Debian and Ubuntu, `apt install {packages}`"
            ),
            // It lacks its other parts, which it finds by the search path.
            false => format!(
                "{cc} does not work for {triple}: {}",
                said.lines().next().unwrap_or("it fails without a message")
            ),
        }))
    }

    /// Checks that Rust can be built. A cargo that builds the standard library itself needs no library for the target.
    ///
    /// # Errors
    /// The compiler or its library for the target is missing.
    pub fn check_rust(&self) -> Result<(), BuildError> {
        if library::builds_std(&self.cargo_args) {
            return Ok(());
        }
        let mut ask = Command::new(&self.rustc);
        ask.args(["--print", "target-libdir"]);
        if let Some(name) = self.target.rustc_name() {
            ask.args(["--target", name]);
        }
        let triple = self.target.triple;
        let Ok(output) = ask.output() else {
            return Err(BuildError::Missing(format!(
                "{} not found: the program calls the runtime, which is built with Rust (https://rustup.rs)",
                self.rustc.display()
            )));
        };
        let folder = String::from_utf8_lossy(&output.stdout);
        if output.status.success() && Path::new(folder.trim()).is_dir() {
            return Ok(());
        }
        Err(BuildError::Missing(match self.target.rustc_name() {
            Some(_) => format!(
                "the Rust toolchain has no library for {triple}: run `rustup target add {triple}`, or name one that has it \
                 by CARGO and RUSTC"
            ),
            None => format!(
                "{} has no standard library for this machine: install Rust from https://rustup.rs, or name a toolchain \
                 that has it by CARGO and RUSTC",
                self.rustc.display()
            ),
        }))
    }

    /// The runtime as a static library, which is built once for each target and toolchain. Where there is no cache, it
    /// is built in `folder`.
    ///
    /// # Errors
    /// The toolchain is missing or fails, or files cannot be written.
    pub fn runtime(&self, folder: &Path) -> Result<PathBuf, BuildError> {
        self.check_rust()?;
        // Without a cache it is built each time.
        let cache = cache::folder().unwrap_or_else(|_| folder.join("cache"));
        let cargo = Command::new(&self.cargo);
        library::build(&cache, &self.recipe(&cargo), || self.announce()).map_err(
            |error| match error {
                library::Error::Cargo { .. } => BuildError::Missing(error.to_string()),
                library::Error::Failed { output } => BuildError::Failed {
                    what: "cargo".to_string(),
                    output,
                },
                library::Error::Io { path, error } => BuildError::Io { path, error },
            },
        )
    }

    /// Recipe for compiling the runtime with this cargo.
    fn recipe<'a>(&'a self, cargo: &'a Command) -> Recipe<'a> {
        Recipe {
            cargo,
            rustc: &self.rustc,
            target: self.target.rustc_name(),
            optimise: self.target.optimise(),
            std: self.std,
            cargo_args: &self.cargo_args,
        }
    }

    /// Says that the runtime is compiled.
    fn announce(&self) {
        (self.announce)(&format!("the runtime for {}", self.target.title));
    }

    /// The runtime as a static library, for a package that needs it.
    pub fn runtime_library(&self) -> Result<Library, BuildError> {
        let folder = tempfile::tempdir().map_err(io(Path::new("temporary folder")))?;
        let path = self.runtime(folder.path())?;
        Ok(Library {
            triple: self.target.triple,
            contents: read(&path)?,
        })
    }

    /// Runs `make` in a folder for the target; `runtime` is the library that the program calls.
    fn make(&self, folder: &Path, runtime: Option<&Path>) -> Result<(), BuildError> {
        let assign = |name: &str, value: &OsStr| {
            let mut text = OsString::from(name);
            text.push("=");
            text.push(value);
            text
        };
        let mut make = Command::new("make");
        make.arg("-C")
            .arg(folder)
            .arg(assign("CC", &self.cc))
            .arg(assign("AR", &self.ar));
        if let Some(runtime) = runtime {
            make.arg(assign("RUNGC_RT", runtime.as_os_str()));
        }
        for variable in ["MAKEFLAGS", "MAKELEVEL", "MFLAGS"] {
            make.env_remove(variable);
        }
        let output = make.output().map_err(|error| {
            BuildError::Missing(format!(
                "cannot run make: {error}; it calls the compilers for {}",
                self.target.triple
            ))
        })?;
        succeeded("make", output)
    }

    /// Looks for the compilers that sources in C need, and runs `make` on them in a separate folder.
    fn build_c(&self, files: &[OutFile]) -> Result<Built, BuildError> {
        self.check_c()?;
        let folder = write(files)?;
        let runtime = match calls_runtime(files) {
            true => Some(self.runtime(folder.path())?),
            false => None,
        };
        self.make(folder.path(), runtime.as_deref())?;
        Ok(Built { folder, runtime })
    }

    /// Builds what `make` makes of sources in C under this name: an executable or an image.
    pub fn c_program(&self, files: &[OutFile], name: &str) -> Result<Vec<u8>, BuildError> {
        let built = self.build_c(files)?;
        read(&built.folder.path().join(name))
    }

    /// Builds a library of sources in C: its headers, `libNAME.a`, and if the program calls it the runtime.
    pub fn c_library(
        &self,
        files: &[OutFile],
        name: &str,
    ) -> Result<Vec<OutFile<Vec<u8>>>, BuildError> {
        let built = self.build_c(files)?;
        let is_header = |path: &str| path.ends_with(".h") && path != format!("{name}_internal.h");
        let headers = files.iter().filter(|file| is_header(&file.path));
        let mut library: Vec<_> = headers.cloned().map(OutFile::from).collect();
        for path in built.libraries(name) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            library.push(OutFile {
                path: name.into_owned(),
                contents: read(&path)?,
            });
        }
        Ok(library)
    }

    /// Builds sources in C as a shared library, of which only marked functions are visible. The same sources give the
    /// same bytes with the same compiler.
    ///
    /// # Errors
    /// A compiler is missing or fails, or files cannot be written.
    pub fn c_shared(&self, files: &[OutFile]) -> Result<Vec<u8>, BuildError> {
        self.check_c()?;
        let folder = write(files)?;
        let sources = files.iter().map(|file| file.path.as_str());
        let sources = sources.filter(|path| path.ends_with(".c") && !path.contains('/'));
        let mut link = Command::new(&self.cc);
        link.current_dir(folder.path())
            .args(self.target.flags.split_whitespace())
            .args(["-std=c99", "-O2", "-shared", "-fvisibility=hidden"])
            .args(["-ffunction-sections", "-fdata-sections", "-o", "shared"])
            .args(sources);
        if !cfg!(windows) || self.target.rustc_name().is_some() {
            link.arg("-fPIC");
        }
        if calls_runtime(files) {
            link.arg(self.runtime(folder.path())?);
            // The runtime's functions are for the program alone.
            if !cfg!(target_vendor = "apple") {
                link.args(["-Wl,--exclude-libs,ALL", "-Wl,--gc-sections"]);
            }
        }
        let output = link.output().map_err(io(Path::new(&self.cc)))?;
        succeeded("the C compiler", output)?;
        read(&folder.path().join("shared"))
    }

    /// Builds sources in C and links all of the program that a host calls, and nothing else, as an executable to be
    /// measured. Its struct is called `plc`.
    pub fn c_probe(&self, files: &[OutFile], module: &Module) -> Result<Vec<u8>, BuildError> {
        let built = self.build_c(files)?;
        let folder = built.folder.path();
        let source = folder.join("probe.c");
        fs::write(&source, probe(module)).map_err(io(&source))?;
        let mut link = Command::new(&self.cc);
        link.current_dir(folder)
            .args(self.target.flags.split_whitespace())
            .args(["-std=c11", "-Os", "--specs=nano.specs", "-nostartfiles"])
            .args([
                "-Wl,--gc-sections,-e,probe,-z,noexecstack",
                "-o",
                "probe.elf",
                "probe.c",
            ])
            .args(built.libraries(&module.name));
        let output = link.output().map_err(io(Path::new(&self.cc)))?;
        succeeded("the linker", output)?;
        read(&folder.join("probe.elf"))
    }
}

/// Output of `make`.
struct Built {
    folder: tempfile::TempDir,
    /// The library of the runtime, if the program calls it.
    runtime: Option<PathBuf>,
}

impl Built {
    /// The static libraries that sources in C become, in the order in which a linker wants them.
    fn libraries(&self, name: &str) -> Vec<PathBuf> {
        let own = self.folder.path().join(format!("lib{name}.a"));
        std::iter::once(own).chain(self.runtime.clone()).collect()
    }
}

impl Tools {
    /// Builds an image in Rust, in a folder of the cache where the runtime is compiled once for each target and
    /// toolchain; images wait for one another there. Where there is no cache, all is built in a temporary folder.
    ///
    /// # Errors
    /// The toolchain is missing or fails, or files cannot be written.
    pub fn rust_image(&self, image: &Image) -> Result<Vec<u8>, BuildError> {
        self.check_rust()?;
        let temporary = tempfile::tempdir().map_err(io(Path::new("temporary folder")))?;
        let cache = cache::folder().unwrap_or_else(|_| temporary.path().to_owned());
        let mut cargo = Command::new(&self.cargo);
        let folder = cache.join("images").join(self.recipe(&cargo).key());
        let _slot = Slot::wait(folder.clone()).map_err(io(&folder))?;
        let objects = folder.join("target");
        if !objects.exists() {
            self.announce();
        }
        write_image(image, &cache, &folder).map_err(io(&folder))?;
        cargo
            .args(["build", "--release"])
            .args(library::strictly(&self.cargo_args))
            .args(&self.cargo_args)
            .env("CARGO_TARGET_DIR", &objects)
            .env_remove("RUSTFLAGS")
            .current_dir(&folder);
        let output = cargo.output().map_err(|error| {
            BuildError::Missing(format!("cannot run {}: {error}", self.cargo.display()))
        })?;
        succeeded("cargo", output)?;
        read(&objects.join(self.target.triple).join("release/image"))
    }
}

/// Writes the sources of an image in Rust, which take the runtime from the cache.
fn write_image(image: &Image, cache: &Path, folder: &Path) -> std::io::Result<()> {
    let runtime = library::unpacked(cache)?;
    let runtime = Runtime::At(runtime.to_string_lossy().into_owned());
    let files = image::rust_project(image, &runtime).into_iter();
    let files: Vec<_> = files.map(|file| (file.path, file.contents)).collect();
    if cache::write_all(folder, &files)? {
        // Cargo does not know that the linker script is part of it.
        cache::touch(&folder.join("src/main.rs"))?;
    }
    Ok(())
}

/// Program that calls everything in a program that a host calls.
fn probe(module: &Module) -> String {
    let mut calls = String::new();
    let takes = |f: &Function| f.kind == FunctionKind::TakeInterrupts;
    for (there, call) in [
        (true, "PROGRAM_init(&plc);"),
        (true, "PROGRAM_scan(&plc, argument, argument);"),
        (true, "result = PROGRAM_output(&plc, argument);"),
        (
            module.takes_events(),
            "PROGRAM_input_edge(&plc, argument, result);",
        ),
        (module.takes_time(), "PROGRAM_tick(&plc, argument);"),
        (
            module.functions.iter().any(takes),
            "PROGRAM_take_interrupts(&plc);",
        ),
        (
            module.sends_pulses(),
            "argument = PROGRAM_pulse_timer(&plc, argument);",
        ),
    ] {
        if there {
            calls.push_str(&format!("    {call}\n"));
        }
    }
    format!(
        "#include \"PROGRAM.h\"\n\nPROGRAM_plc plc;\nvolatile uint32_t argument;\nvolatile bool result;\nvoid probe(void);\n\n\
         void probe(void)\n{{\n{calls}}}\n"
    )
    .replace("PROGRAM", &module.name)
}

/// Returns true if the runtime's sources are among the files.
fn calls_runtime(files: &[OutFile]) -> bool {
    files.iter().any(|file| file.path.contains("rungc-rt/"))
}

fn read(path: &Path) -> Result<Vec<u8>, BuildError> {
    fs::read(path).map_err(io(path))
}

fn succeeded(what: &str, output: Output) -> Result<(), BuildError> {
    if output.status.success() {
        return Ok(());
    }
    Err(BuildError::Failed {
        what: what.to_string(),
        output: String::from_utf8_lossy(&output.stderr).into_owned(),
    })
}

/// Writes files into a new temporary folder.
fn write(files: &[OutFile]) -> Result<tempfile::TempDir, BuildError> {
    let folder = tempfile::tempdir().map_err(io(Path::new("temporary folder")))?;
    for file in files {
        let path = folder.path().join(&file.path);
        let parent = path.parent().unwrap_or(folder.path());
        fs::create_dir_all(parent).map_err(io(&path))?;
        fs::write(&path, &file.contents).map_err(io(&path))?;
    }
    Ok(folder)
}
