//! The crates of this workspace, from Cargo's metadata.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates of the workspace, by package.
pub type Crates = BTreeMap<String, Crate>;

/// A crate of the workspace.
#[derive(Debug, Clone, Default)]
pub struct Crate {
    /// Path below the root, with slashes: `cli/rungc`.
    pub folder: String,
    /// Description in its manifest.
    pub description: String,
    /// Packages of the workspace that its own code depends on, not only its tests.
    pub uses: BTreeSet<String>,
    /// Packages that it must not reach (`must-not-know` in the workspace's metadata).
    pub must_not_know: BTreeSet<String>,
    /// True if it may be published in a registry.
    pub is_published: bool,
}

impl Crate {
    /// Short name in the documents: the last part of the folder.
    pub fn name(&self) -> &str {
        self.folder.rsplit('/').next().unwrap_or(&self.folder)
    }
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
    metadata: Rules,
    workspace_root: PathBuf,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
struct Rules {
    must_not_know: BTreeMap<String, BTreeSet<String>>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    description: Option<String>,
    manifest_path: PathBuf,
    dependencies: Vec<Dependency>,
    /// Permitted registries: none of them if this is an empty list, any if it is absent.
    publish: Option<Vec<String>>,
}

#[derive(Deserialize)]
struct Dependency {
    name: String,
    /// `dev` or `build`; absent for a normal one.
    kind: Option<String>,
    /// The folder of a dependency inside the workspace.
    path: Option<PathBuf>,
}

/// Reads the workspace around a folder.
///
/// # Errors
/// Cargo fails, or a rule names a package that does not exist.
pub fn crates(root: &Path) -> io::Result<Crates> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command
        .args(["metadata", "--no-deps", "--offline"])
        .args(["--format-version", "1"])
        .current_dir(root);
    let output = command.output()?;
    if !output.status.success() {
        let reason = String::from_utf8_lossy(&output.stderr);
        return Err(io::Error::other(format!("{command:?}: {reason}")));
    }
    let metadata: Metadata = serde_json::from_slice(&output.stdout)?;
    let mut rules = metadata.metadata.must_not_know;
    let packages = metadata.packages.into_iter();
    let crates: Crates = packages
        .map(|package| {
            let must_not_know = rules.remove(&package.name).unwrap_or_default();
            let name = package.name.clone();
            (
                name,
                described(package, must_not_know, &metadata.workspace_root),
            )
        })
        .collect();
    let ruled = crates.values().flat_map(|one| &one.must_not_know);
    let mut named = ruled.chain(rules.keys());
    if let Some(unknown) = named.find(|name| !crates.contains_key(*name)) {
        let message =
            format!("a rule of `must-not-know` names `{unknown}`, which is not a package");
        return Err(io::Error::other(message));
    }
    Ok(crates)
}

fn described(package: Package, must_not_know: BTreeSet<String>, root: &Path) -> Crate {
    let manifest = &package.manifest_path;
    let below = manifest.strip_prefix(root).unwrap_or(manifest);
    let names = below.parent().into_iter().flatten();
    let names: Vec<_> = names.map(|name| name.to_string_lossy()).collect();
    let dependencies = package.dependencies.into_iter();
    let own = dependencies.filter(|one| one.kind.is_none() && one.path.is_some());
    Crate {
        folder: names.join("/"),
        description: package.description.unwrap_or_default(),
        uses: own.map(|one| one.name).collect(),
        must_not_know,
        is_published: package
            .publish
            .is_none_or(|registries| !registries.is_empty()),
    }
}

/// All packages that a crate depends on, also through others.
pub fn reached(crates: &Crates, from: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(one) = open.pop().and_then(|name| crates.get(name)) {
        let new = one.uses.iter().filter(|name| found.insert((*name).clone()));
        open.extend(new.map(String::as_str));
    }
    found
}

/// Dependencies of a crate that no other of its dependencies brings along.
pub fn nearest<'a>(crates: &Crates, one: &'a Crate) -> Vec<&'a String> {
    let brought: BTreeSet<String> = one
        .uses
        .iter()
        .flat_map(|name| reached(crates, name))
        .collect();
    one.uses
        .iter()
        .filter(|name| !brought.contains(*name))
        .collect()
}
