//! `cargo xtask dist`.

mod container;
mod debian;
mod files;
mod manifests;
mod systems;
mod tarball;
mod wheel;
mod windows;

use crate::{Problem, root, rungc, tools};
use clap::ValueEnum;
use files::Files;
use rungc_golden::workspace;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};
use systems::System;

/// Version of all packages.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Make the packages that users install.
///
/// Archives are the same for the same executable: their times are that of the last commit, or SOURCE_DATE_EPOCH.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// What to make, in this order.
    #[arg(required = true)]
    what: Vec<What>,
    /// System that the packages are for, as Rust's triple [default: this one, with static executables on Linux; of
    /// `zip` x86_64-pc-windows-gnu]
    #[arg(long, value_parser = systems::find)]
    target: Option<&'static System>,
    /// Cargo profile of the executable.
    #[arg(long, default_value = "release")]
    profile: String,
    /// Folder for the packages.
    #[arg(long, default_value = "target/dist")]
    out: PathBuf,
}

/// A package, or a file about packages.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum What {
    /// An archive for Linux or macOS: executable, licences, completions, manual pages.
    Archive,
    /// A package for Debian and Ubuntu (dpkg-deb).
    Deb,
    /// An archive for Windows, with a script that installs it.
    Zip,
    /// A wheel for Python: the module and the executable (maturin; ziglang on Linux).
    Wheel,
    /// An OCI image with nothing but the executable (buildah).
    Image,
    /// The formula for Homebrew, with the checksums of archives in the folder.
    Homebrew,
    /// The manifests for winget, with the checksum of the archive for Windows in the folder.
    Winget,
    /// The dependencies of the executable as CycloneDX (cargo-cyclonedx).
    Sbom,
    /// SHA256SUMS of all packages in the folder.
    Sums,
}

/// Packages in the making.
struct Dist<'a> {
    out: &'a Path,
    profile: &'a str,
    target: Option<&'static System>,
    /// Time of files in packages, in seconds since 1970.
    time: u64,
}

/// Makes packages.
pub fn run(args: &Args) -> Result<(), Problem> {
    let out = root().join(&args.out);
    fs::create_dir_all(&out)?;
    let dist = Dist {
        out: &out,
        profile: &args.profile,
        target: args.target,
        time: time()?,
    };
    for what in &args.what {
        let made = match what {
            What::Archive => vec![dist.archive()?],
            What::Deb => vec![debian::make(&dist)?],
            What::Zip => vec![windows::make(&dist)?],
            What::Wheel => vec![wheel::make(&dist)?],
            What::Image => vec![container::make(&dist)?],
            What::Homebrew => manifests::homebrew(&out)?,
            What::Winget => manifests::winget(&out)?,
            What::Sbom => vec![dist.sbom()?],
            What::Sums => vec![manifests::sums(&out)?],
        };
        for path in made {
            println!("{} ({} bytes)", path.display(), fs::metadata(&path)?.len());
        }
    }
    Ok(())
}

impl Dist<'_> {
    /// The system that packages are for, by default this one.
    fn system(&self) -> Result<&'static System, Problem> {
        self.target.map_or_else(systems::here, Ok)
    }

    /// Builds the executable for a system.
    fn executable(&self, system: &System) -> Result<PathBuf, Problem> {
        let options = ["build", "--quiet", "--locked", "--package", "rungc"];
        let mut cargo = tools::cargo(&options);
        cargo.args(["--profile", self.profile, "--target", system.triple]);
        rungc::built(&mut cargo)
    }

    fn archive(&self) -> Result<PathBuf, Problem> {
        let system = self.system()?;
        let executable = self.executable(system)?;
        let mut files = Files::documents()?;
        files.add_executable(system.executable(), &executable)?;
        files.add_completions(&executable)?;
        files.add_manual(&executable)?;
        let name = format!("rungc-{VERSION}-{}", system.name);
        let path = self.out.join(format!("{name}.tar.gz"));
        fs::write(&path, tarball::make(&files.inside(&name), self.time)?)?;
        Ok(path)
    }

    fn sbom(&self) -> Result<PathBuf, Problem> {
        let mut cargo = tools::cargo(&["cyclonedx", "--format", "json", "--quiet"]);
        cargo.args(["--manifest-path", "cli/rungc/Cargo.toml"]);
        cargo.args(["--override-filename", "rungc.cdx"]);
        cargo.args(["--target", self.system()?.triple]);
        cargo.env("SOURCE_DATE_EPOCH", self.time.to_string());
        let done = tools::run(&mut cargo);
        done.map_err(|error| format!("{error}; `cargo install cargo-cyclonedx` installs it"))?;
        // It writes beside the manifest of each crate of the workspace.
        let path = self.out.join(format!("rungc-{VERSION}.cdx.json"));
        fs::copy(root().join("cli/rungc/rungc.cdx.json"), &path)?;
        for one in workspace::crates(&root())?.values() {
            let made = root().join(&one.folder).join("rungc.cdx.json");
            if made.exists() {
                fs::remove_file(made)?;
            }
        }
        Ok(path)
    }
}

/// Time of files in packages: SOURCE_DATE_EPOCH, else that of the last commit.
fn time() -> Result<u64, Problem> {
    let seconds = match env::var("SOURCE_DATE_EPOCH") {
        Ok(seconds) => seconds,
        Err(_) => {
            let mut git = Command::new("git");
            tools::output(git.args(["log", "-1", "--format=%ct"]).current_dir(root()))?
        }
    };
    let parsed = seconds.trim().parse();
    parsed.map_err(|_| format!("SOURCE_DATE_EPOCH: `{seconds}` is not a number of seconds").into())
}

/// Runs a tool that has to be installed; `install` says how.
fn tool(command: &mut Command, install: &str) -> Result<(), Problem> {
    let name = command.get_program().to_string_lossy().into_owned();
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?}: {status}").into()),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            Err(format!("{name} is not installed: `{install}`").into())
        }
        Err(error) => Err(format!("{name}: {error}").into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_tool_is_named_with_its_installation() {
        let error = tool(&mut Command::new("no-such-tool"), "apt install it").unwrap_err();
        let said = error.to_string();
        assert_eq!(said, "no-such-tool is not installed: `apt install it`");
    }
}
