//! Compiles a program of an FX-family PLC from the `build.rs` of a crate, which then includes it as a module.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), rungc_build::Error> {
//!     rungc_build::compile("machine.gxw")
//! }
//! ```
//!
//! ```ignore
//! // src/main.rs
//! mod plc {
//!     include!(concat!(env!("OUT_DIR"), "/machine.rs"));
//! }
//! ```
//!
//! The crate depends on `rungc-rt`, the runtime, and the module is what `rungc build --emit rust` writes as a crate.
//! Cargo shows errors and warnings of the program with their places, and compiles it again when its file or its
//! settings change. Start reading at [`compile`].
#![deny(missing_docs)]

mod module;

pub use module::code;
pub use rungc::{Error as OpenError, Options, Project};

use rungc::{Diagnostic, Severity};
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Reason why a program is not compiled.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// It cannot be read, or its settings have mistakes.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// It has errors, which are reported to Cargo.
    #[error("{0} has errors")]
    Rejected(PathBuf),
    /// Cargo has not called this: the variable is not set.
    #[error("the variable {0} is not set: call this from a build script")]
    Variable(&'static str),
    /// The module cannot be written.
    #[error("cannot write `{path}`: {error}")]
    Write {
        /// Its file.
        path: PathBuf,
        /// The underlying I/O error.
        error: io::Error,
    },
}

/// Compiles a program to `OUT_DIR/NAME.rs`, NAME being that of its file without extension. Paths are relative to the
/// crate's folder.
///
/// # Errors
/// A program that cannot be read or has errors; a call from outside a build script.
pub fn compile(path: impl AsRef<Path>) -> Result<(), Error> {
    compile_with(path, &Options::default())
}

/// As [`compile`], with a model, settings and levels of codes.
///
/// # Errors
/// Those of [`compile`].
pub fn compile_with(path: impl AsRef<Path>, options: &Options) -> Result<(), Error> {
    let folder = env::var_os("OUT_DIR").ok_or(Error::Variable("OUT_DIR"))?;
    for line in compile_into(path.as_ref(), Path::new(&folder), options)? {
        println!("{line}");
    }
    Ok(())
}

/// Compiles a program into a folder; returns what is printed to Cargo. Errors are printed at once.
fn compile_into(path: &Path, folder: &Path, options: &Options) -> Result<Vec<String>, Error> {
    // Also if it cannot be read: it may be mended.
    println!("cargo::rerun-if-changed={}", path.display());
    let project = Project::open_with(path, options)?;
    let settings = project.settings().map(|settings| settings.path.as_path());
    let read = [Some(project.file()), settings];
    let parts = project.source().source.parts().iter();
    let parts = parts.map(|part| Path::new(&part.path));
    let read = read.into_iter().flatten().chain(parts);
    let mut lines: Vec<String> = read
        .map(|file| format!("cargo::rerun-if-changed={}", file.display()))
        .collect();
    let checked = project.check();
    let of = |severity: Severity| {
        let all = checked.diagnostics.iter();
        all.filter(move |found| found.severity == severity)
    };
    lines.extend(of(Severity::Warning).map(|found| directive("warning", found)));
    let Ok(program) = checked.compile() else {
        for error in of(Severity::Error) {
            println!("{}", directive("error", error));
        }
        return Err(Error::Rejected(project.file().to_owned()));
    };
    let stem = project.file().file_stem().unwrap_or_default();
    let path = folder.join(stem).with_extension("rs");
    let written = fs::write(&path, code(&program));
    written.map_err(|error| Error::Write { path, error })?;
    Ok(lines)
}

/// A finding as Cargo takes it: on one line.
fn directive(kind: &str, found: &Diagnostic) -> String {
    let text = found.to_string();
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    format!("cargo::{kind}={}", lines.join("; "))
}

#[cfg(test)]
mod tests;
