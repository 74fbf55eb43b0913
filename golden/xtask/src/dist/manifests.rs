//! Files about packages: checksums, and what package managers read.

use super::VERSION;
use crate::{Problem, root};
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};

/// File with the checksums of all packages.
const SUMS: &str = "SHA256SUMS";

/// Fills in the formula for Homebrew.
pub fn homebrew(out: &Path) -> Result<Vec<PathBuf>, Problem> {
    filled(
        &root().join("packaging/homebrew"),
        &out.join("homebrew"),
        out,
    )
}

/// Fills in the manifests for winget.
pub fn winget(out: &Path) -> Result<Vec<PathBuf>, Problem> {
    filled(&root().join("packaging/winget"), &out.join("winget"), out)
}

/// Writes the files of a folder to another one, with version and checksums of packages in `out`.
fn filled(templates: &Path, to: &Path, out: &Path) -> Result<Vec<PathBuf>, Problem> {
    let mut made = Vec::new();
    for entry in fs::read_dir(templates)? {
        let entry = entry?;
        let text = fill(&fs::read_to_string(entry.path())?, out)?;
        made.push((to.join(entry.file_name()), text));
    }
    made.sort();
    fs::create_dir_all(to)?;
    for (path, text) in &made {
        fs::write(path, text)?;
    }
    Ok(made.into_iter().map(|(path, _)| path).collect())
}

/// Start of the place of a checksum: `@SHA256:FILE@`.
const CHECKSUM: &str = "@SHA256:";

/// A template with its version and checksums.
fn fill(template: &str, out: &Path) -> Result<String, Problem> {
    let text = template.replace("@VERSION@", VERSION);
    let mut parts = text.split(CHECKSUM);
    let mut filled = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part
            .split_once('@')
            .ok_or_else(|| format!("`{CHECKSUM}` without an end: {part}"))?;
        filled += &checksum(&out.join(name))?;
        filled += rest;
    }
    Ok(filled)
}

/// The SHA-256 of a package, in lower case.
fn checksum(path: &Path) -> Result<String, Problem> {
    let contents = fs::read(path).map_err(|error| {
        format!(
            "{}: {error}; make this package first, or put it there",
            path.display()
        )
    })?;
    let digest = Sha256::digest(contents);
    Ok(digest.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Writes the checksums of all packages in a folder, as `sha256sum --check` reads them.
pub fn sums(out: &Path) -> Result<PathBuf, Problem> {
    let mut lines = Vec::new();
    for entry in fs::read_dir(out)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.file_type()?.is_file() && name != SUMS {
            lines.push((name, checksum(&entry.path())?));
        }
    }
    lines.sort();
    let lines = lines.iter().map(|(name, sum)| format!("{sum}  {name}\n"));
    let path = out.join(SUMS);
    fs::write(&path, lines.collect::<String>())?;
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SHA-256 of `abc` (FIPS 180-2, B.1).
    const ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

    #[test]
    fn checksums_are_those_of_the_files() {
        let out = tempfile::tempdir().unwrap();
        fs::write(out.path().join("b"), "abc").unwrap();
        fs::write(out.path().join("a"), "").unwrap();
        fs::create_dir(out.path().join("winget")).unwrap();
        for _ in 0..2 {
            let text = fs::read_to_string(sums(out.path()).unwrap()).unwrap();
            let lines: Vec<_> = text.lines().collect();
            assert!(lines[0].ends_with("  a"), "{text}");
            assert_eq!(lines[1], format!("{ABC}  b"));
            assert_eq!(lines.len(), 2, "{text}");
        }
    }

    #[test]
    fn templates_get_version_and_checksums_or_name_the_missing_package() {
        let out = tempfile::tempdir().unwrap();
        let name = format!("rungc-{VERSION}.zip");
        let template = "v@VERSION@: @SHA256:rungc-@VERSION@.zip@.";
        let error = fill(template, out.path()).unwrap_err().to_string();
        assert!(error.contains(&name), "{error}");
        fs::write(out.path().join(name), "abc").unwrap();
        let filled = fill(template, out.path()).unwrap();
        assert_eq!(filled, format!("v{VERSION}: {ABC}."));
    }

    /// Each package that a template names is one that is made.
    #[test]
    fn templates_name_packages_that_are_made() {
        let out = tempfile::tempdir().unwrap();
        for system in ["x86_64-linux-musl", "aarch64-linux-musl", "aarch64-macos"] {
            let name = format!("rungc-{VERSION}-{system}.tar.gz");
            fs::write(out.path().join(name), system).unwrap();
        }
        let name = format!("rungc-{VERSION}-x86_64-windows.zip");
        fs::write(out.path().join(name), "zip").unwrap();
        let made = [homebrew(out.path()).unwrap(), winget(out.path()).unwrap()].concat();
        assert_eq!(made.len(), 4);
        for path in made {
            let text = fs::read_to_string(path).unwrap();
            assert!(
                text.contains(VERSION) && !text.contains("@SHA") && !text.contains("@VERSION"),
                "{text}"
            );
        }
    }

    #[test]
    fn documents_name_packages_of_this_version() {
        for page in ["README.md", "docs/src/install.md"] {
            let text = fs::read_to_string(root().join(page)).unwrap();
            let package = format!("rungc_{VERSION}_amd64.deb");
            assert!(text.contains(&package), "{page} does not name {package}");
        }
    }
}
