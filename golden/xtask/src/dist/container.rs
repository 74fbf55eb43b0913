//! The image for containers.

use super::{Dist, VERSION, tool};
use crate::{Problem, root};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Makes the image as an archive, which `podman load` and `docker load` read.
pub fn make(dist: &Dist) -> Result<PathBuf, Problem> {
    let system = dist.system()?;
    if !system.is_linux() {
        return Err(format!("images are for Linux, not for {}", system.triple).into());
    }
    let executable = dist.executable(system)?;
    let context = tempfile::tempdir()?;
    fs::copy(&executable, context.path().join("rungc"))?;
    for name in ["LICENSE-APACHE", "LICENSE-MIT"] {
        fs::copy(root().join(name), context.path().join(name))?;
    }
    let tag = format!("rungc:{VERSION}");
    let path = dist
        .out
        .join(format!("rungc-{VERSION}-{}.oci.tar", system.name));
    if path.exists() {
        fs::remove_file(&path)?;
    }
    let buildah = || {
        let mut buildah = Command::new("buildah");
        // Needs no file system in the kernel.
        buildah.args(["--storage-driver", "vfs"]);
        buildah
    };
    let install = "apt install buildah";
    let mut build = buildah();
    build.args(["build", "--isolation", "chroot", "--file"]);
    build.arg(root().join("packaging/Containerfile"));
    build.args(["--timestamp", &dist.time.to_string(), "--tag", &tag]);
    tool(build.arg(context.path()), install)?;
    let archive = format!("oci-archive:{}:{tag}", path.display());
    tool(buildah().args(["push", "--quiet", &tag, &archive]), install)?;
    Ok(path)
}
