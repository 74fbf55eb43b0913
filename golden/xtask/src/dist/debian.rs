//! The package for Debian and Ubuntu.

use super::files::Files;
use super::{Dist, VERSION, tarball, tool};
use crate::{Problem, root};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Makes the package from a tree of its files. (`cargo deb` would want them listed a second time, as its assets.)
pub fn make(dist: &Dist) -> Result<PathBuf, Problem> {
    let system = dist.system()?;
    let architecture = system
        .debian
        .ok_or_else(|| format!("Debian has no {}", system.triple))?;
    let executable = dist.executable(system)?;
    let files = tree(&executable)?;
    let size: usize = files.0.values().map(|file| file.contents.len()).sum();
    let control = fs::read_to_string(root().join("packaging/debian/control"))?;
    let control = control
        .replace("@VERSION@", VERSION)
        .replace("@ARCHITECTURE@", architecture)
        .replace("@SIZE@", &size.div_ceil(1024).to_string());
    let folder = tempfile::tempdir()?;
    let tree = folder.path().join("tree");
    let mut all = files;
    all.add("DEBIAN/control", control.into_bytes());
    write(&all, &tree)?;
    let path = dist.out.join(format!("rungc_{VERSION}_{architecture}.deb"));
    let mut deb = Command::new("dpkg-deb");
    deb.args(["--root-owner-group", "-Zxz", "--build"])
        .args([&tree, &path])
        .env("SOURCE_DATE_EPOCH", dist.time.to_string());
    tool(&mut deb, "apt install dpkg")?;
    Ok(path)
}

/// The files by their places on the system.
fn tree(executable: &Path) -> Result<Files, Problem> {
    let mut files = Files::default();
    files.add_executable("usr/bin/rungc", executable)?;
    files.add_debian_completions(executable)?;
    let mut manual = Files::default();
    manual.add_manual(executable)?;
    for (path, page) in manual.0 {
        let contents = tarball::compressed(&page.contents)?;
        files.add(&format!("usr/share/{path}.gz"), contents);
    }
    let text = |name: &str| fs::read(root().join(name));
    files.add(
        "usr/share/doc/rungc/copyright",
        text("packaging/debian/copyright")?,
    );
    files.add("usr/share/doc/rungc/README.md", text("README.md")?);
    let changes = tarball::compressed(&text("CHANGELOG.md")?)?;
    files.add("usr/share/doc/rungc/changelog.gz", changes);
    Ok(files)
}

/// Writes files below a folder, with their permissions.
fn write(files: &Files, folder: &Path) -> Result<(), Problem> {
    for (path, file) in &files.0 {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap_or(folder))?;
        fs::write(&path, &file.contents)?;
        permit(&path, file.mode())?;
        for above in path
            .ancestors()
            .skip(1)
            .take_while(|above| above.starts_with(folder))
        {
            permit(above, 0o755)?;
        }
    }
    Ok(())
}

/// Sets permissions, whatever the user's mask is.
#[cfg(unix)]
fn permit(path: &Path, mode: u32) -> Result<(), Problem> {
    use std::os::unix::fs::PermissionsExt;
    Ok(fs::set_permissions(path, fs::Permissions::from_mode(mode))?)
}

/// Fails: packages for Debian need the permissions of Unix.
#[cfg(not(unix))]
fn permit(_path: &Path, _mode: u32) -> Result<(), Problem> {
    Err("packages for Debian are made on Unix".into())
}
