//! Dependencies keep to what `deny.toml` says of licences, origins and versions, as far as Cargo's metadata shows it.
//! `cargo deny check` also reads advisories and the texts of licences.

use serde::Deserialize;
use spdx::{Expression, ParseMode};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::Command;

/// Output of `cargo metadata`.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
    workspace_members: Vec<String>,
    resolve: Resolve,
}

#[derive(Deserialize)]
struct Package {
    id: String,
    name: String,
    version: String,
    license: Option<String>,
    source: Option<String>,
}

#[derive(Deserialize)]
struct Resolve {
    nodes: Vec<Node>,
}

/// A package and what it depends on.
#[derive(Deserialize)]
struct Node {
    id: String,
    dependencies: Vec<String>,
}

/// `deny.toml`, as far as it is checked here.
#[derive(Deserialize)]
struct Deny {
    licenses: Licenses,
    bans: Bans,
}

#[derive(Deserialize)]
struct Licenses {
    allow: Vec<String>,
    exceptions: Vec<Exception>,
}

#[derive(Deserialize)]
struct Exception {
    name: String,
    allow: Vec<String>,
}

#[derive(Deserialize)]
struct Bans {
    skip: Vec<Named>,
    #[serde(rename = "skip-tree")]
    skip_tree: Vec<Named>,
}

#[derive(Deserialize)]
struct Named {
    name: String,
}

fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

fn deny() -> Deny {
    let text = std::fs::read_to_string(root().join("deny.toml")).expect("deny.toml");
    toml::from_str(&text).expect("deny.toml is well-formed")
}

/// The packages that are built on this machine, with all features of the project. Cargo fetches those that were never
/// built here.
fn metadata() -> Metadata {
    let version = Command::new("rustc").arg("-vV").output().expect("rustc");
    let version = String::from_utf8_lossy(&version.stdout).into_owned();
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--locked", "--format-version", "1"])
        .args(["--all-features", "--filter-platform", host.expect("a host")])
        .current_dir(root())
        .output()
        .expect("cargo");
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{messages}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Returns true if one choice of a licence expression consists of allowed licences only.
fn is_allowed(licence: &str, allowed: &[&String]) -> bool {
    let expression = Expression::parse_mode(licence, ParseMode::LAX);
    expression.is_ok_and(|expression| {
        expression.evaluate(|part| {
            let name = part.license.id().map(|id| id.name);
            part.addition.is_none() && allowed.iter().any(|one| Some(one.as_str()) == name)
        })
    })
}

#[test]
fn licences_are_allowed() {
    let Licenses { allow, exceptions } = deny().licenses;
    let wrong = metadata().packages.into_iter().filter(|package| {
        let of_package = exceptions.iter().filter(|one| one.name == package.name);
        let allowed = allow.iter().chain(of_package.flat_map(|one| &one.allow));
        let allowed: Vec<_> = allowed.collect();
        !is_allowed(package.license.as_deref().unwrap_or_default(), &allowed)
    });
    let wrong: Vec<_> = wrong.map(|one| (one.name, one.license)).collect();
    assert_eq!(wrong, []);
}

#[test]
fn packages_come_from_the_registry() {
    const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";
    let foreign = metadata().packages.into_iter().filter_map(|package| {
        let source = package.source?;
        (source != REGISTRY).then_some((package.name, source))
    });
    assert_eq!(foreign.collect::<Vec<_>>(), []);
}

/// Of each dependency there is one version, but for those that `deny.toml` tolerates.
#[test]
fn no_dependency_has_two_versions() {
    let bans = deny().bans;
    let metadata = metadata();
    let packages: BTreeMap<_, _> = metadata.packages.iter().map(|p| (&p.id, p)).collect();
    let nodes = metadata.resolve.nodes.iter();
    let uses: BTreeMap<_, _> = nodes.map(|node| (&node.id, &node.dependencies)).collect();
    let is_left_out = |package: &Package| bans.skip_tree.iter().any(|one| one.name == package.name);
    let mut reached = BTreeSet::new();
    let mut open: Vec<_> = metadata.workspace_members.iter().collect();
    while let Some(id) = open.pop() {
        if !is_left_out(packages[id]) && reached.insert(id) {
            open.extend(uses[id]);
        }
    }
    let mut versions: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for package in reached.into_iter().map(|id| packages[id]) {
        let known = versions.entry(&package.name).or_default();
        known.push(&package.version);
    }
    versions.retain(|name, versions| {
        versions.len() > 1 && !bans.skip.iter().any(|one| one.name == *name)
    });
    assert_eq!(versions, BTreeMap::new());
}

#[test]
fn licence_expressions_are_understood() {
    let (mit, apache) = ("MIT".to_owned(), "Apache-2.0".to_owned());
    let allowed = [&mit, &apache];
    assert!(is_allowed("MIT/Apache-2.0", &allowed));
    assert!(is_allowed("GPL-3.0-only OR MIT", &allowed));
    assert!(!is_allowed("MIT AND Unicode-3.0", &allowed));
    assert!(!is_allowed("", &allowed));
}
