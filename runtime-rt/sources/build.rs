//! Lists the sources of the runtime, of a host's services and of libm, which the library embeds.
//!
//! Runtime and services are neighbours in the repository. libm lies where Cargo has it: in the registry's folder, or
//! wherever its configuration puts the sources of packages. A published package has neither: it brings the files in
//! `published/`, which `cargo xtask package` makes.

use serde_json::Value;
use std::ffi::OsString;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

/// The runtime's package.
const RUNTIME: &str = "../rt";

/// The package of a host's services.
const HOST: &str = "../host";

/// The lock file of the workspace.
const LOCK: &str = "../../Cargo.lock";

/// Files of libm beside its `src`: what builds it, and its licence.
const LIBM_FILES: [&str; 4] = ["Cargo.toml", "LICENSE.txt", "build.rs", "configure.rs"];

/// A package that depends on libm; the lock file gives the version.
const PROBE: &str = r#"[package]
name = "probe"
version = "0.0.0"
edition = "2024"

[dependencies]
libm = "*"

[workspace]
"#;

/// The files of a published package.
const PUBLISHED: &str = "published";

/// Manifests in it, which would otherwise make packages of their folders.
const MANIFEST: &str = "manifest.toml";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let out = PathBuf::from(variable("OUT_DIR")?);
    let here = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
    let runtime = here.join(RUNTIME);
    let mut files = Vec::new();
    if runtime.exists() {
        let libm = libm(&here, &out)?;
        println!("cargo::rerun-if-changed={RUNTIME}");
        println!("cargo::rerun-if-changed={HOST}");
        println!("cargo::rerun-if-changed={LOCK}");
        files.push(("Cargo.toml".to_string(), runtime.join("Cargo.toml")));
        for name in LIBM_FILES {
            files.push((format!("libm/{name}"), libm.join(name)));
        }
        list(&libm.join("src"), "libm/src/", &mut files)?;
        list(&runtime.join("src"), "src/", &mut files)?;
        let host = here.join(HOST);
        files.push(("host/Cargo.toml".to_string(), host.join("Cargo.toml")));
        list(&host.join("src"), "host/src/", &mut files)?;
    } else {
        println!("cargo::rerun-if-changed={PUBLISHED}");
        list(&here.join(PUBLISHED), "", &mut files)?;
        for (name, _) in &mut files {
            *name = name.replace(MANIFEST, "Cargo.toml");
        }
    }
    files.sort();
    let mut table = String::from("&[\n");
    for (name, path) in files {
        let _ = writeln!(table, "    ({name:?}, include_str!({path:?})),");
    }
    table += "]\n";
    fs::write(out.join("files.rs"), table)
}

/// Adds the files in a folder and its folders, named by `prefix` and their paths in it.
fn list(folder: &Path, prefix: &str, files: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), files)?;
        } else {
            files.push((name, entry.path()));
        }
    }
    Ok(())
}

/// The folder of the libm that the workspace's lock file names. Cargo is asked about a package that depends on nothing
/// else, so that nothing has to be there but what this build has taken from the registry already.
fn libm(here: &Path, out: &Path) -> io::Result<PathBuf> {
    let probe = out.join("probe");
    let manifest = probe.join("Cargo.toml");
    fs::create_dir_all(probe.join("src"))?;
    fs::write(probe.join("src/lib.rs"), "")?;
    fs::copy(here.join(LOCK), probe.join("Cargo.lock"))?;
    fs::write(&manifest, PROBE)?;
    // In this folder, so that it has the configuration of this build.
    let output = Command::new(variable("CARGO")?)
        .args(["metadata", "--offline", "--format-version", "1"])
        .arg("--manifest-path")
        .arg(manifest)
        .current_dir(here)
        .output()?;
    if !output.status.success() {
        let stderr = String::from_utf8_lossy(&output.stderr);
        return Err(io::Error::other(format!("cargo metadata: {stderr}")));
    }
    let metadata: Value = serde_json::from_slice(&output.stdout)?;
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let mut manifests = packages
        .filter(|package| package["name"] == "libm")
        .filter_map(|package| package["manifest_path"].as_str());
    let folder = manifests.next().and_then(|path| Path::new(path).parent());
    let folder = folder.ok_or_else(|| io::Error::other("cargo metadata names no libm"))?;
    Ok(folder.to_path_buf())
}

fn variable(name: &str) -> io::Result<OsString> {
    env::var_os(name).ok_or_else(|| io::Error::other(format!("cargo sets {name}")))
}
