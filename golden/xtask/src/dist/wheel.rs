//! The wheel for Python.

use super::{Dist, VERSION, tool};
use crate::{Problem, root};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use zip::ZipArchive;

/// Glibc of modules in wheels for Linux: 2.17, which all supported distributions have.
const COMPATIBILITY: &str = "manylinux2014";

/// Makes the wheel: the module of `cli/python`, and the executable as a script, which pip puts on the search path.
pub fn make(dist: &Dist) -> Result<PathBuf, Problem> {
    let system = dist.system()?;
    let executable = dist.executable(system)?;
    let python = root().join("cli/python");
    // Maturin takes the files of a folder along that is named after the module.
    let data = python.join("rungc._rungc.data");
    let scripts = data.join("scripts");
    fs::create_dir_all(&scripts)?;
    let built = fs::copy(&executable, scripts.join(system.executable()))
        .map_err(Problem::from)
        .and_then(|_| build(&python, dist, system.is_linux()));
    fs::remove_dir_all(data)?;
    built?;
    let wheel = newest(dist.out)?;
    let script = format!("rungc-{VERSION}.data/scripts/{}", system.executable());
    let archive = ZipArchive::new(fs::File::open(&wheel)?)?;
    match archive.index_for_name(&script) {
        Some(_) => Ok(wheel),
        None => Err(format!("{} has no {script}", wheel.display()).into()),
    }
}

fn build(python: &Path, dist: &Dist, is_linux: bool) -> Result<(), Problem> {
    let mut maturin = Command::new("maturin");
    maturin
        .args(["build", "--locked", "--profile", dist.profile, "--out"])
        .arg(dist.out)
        .env("SOURCE_DATE_EPOCH", dist.time.to_string())
        .env("CARGO_TARGET_DIR", root().join("target/python-build"))
        .current_dir(python);
    if is_linux {
        maturin.args(["--zig", "--compatibility", COMPATIBILITY]);
    }
    tool(&mut maturin, "pip install maturin[zig]")
}

/// The wheel of this version in a folder.
fn newest(out: &Path) -> Result<PathBuf, Problem> {
    let mut found = Vec::new();
    for entry in fs::read_dir(out)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with(&format!("rungc-{VERSION}-")) && name.ends_with(".whl") {
            found.push((fs::metadata(&path)?.modified()?, path));
        }
    }
    let newest = found.into_iter().max().map(|(_, path)| path);
    newest.ok_or_else(|| {
        format!(
            "maturin has made no wheel of version {VERSION}: is it that of cli/python/Cargo.toml?"
        )
        .into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Its manifest is not part of the workspace, and inherits no version.
    #[test]
    fn the_module_has_the_version_of_the_workspace() {
        let manifest = fs::read_to_string(root().join("cli/python/Cargo.toml")).unwrap();
        assert!(manifest.contains(&format!("\nversion = \"{VERSION}\"\n")));
    }
}
