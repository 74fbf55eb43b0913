//! ARCHITECTURE.md's picture and the rules in `Cargo.toml` agree with Cargo's metadata, and each crate says where to
//! start reading.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::Command;

fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
    metadata: Rules,
}

/// `[workspace.metadata]`.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
struct Rules {
    /// For each package, those that it must not reach.
    must_not_know: BTreeMap<String, BTreeSet<String>>,
}

/// A package of the workspace, as `cargo metadata` prints it.
#[derive(Deserialize)]
struct Package {
    name: String,
    manifest_path: PathBuf,
    dependencies: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    name: String,
    /// `None` for a normal one, else `dev` or `build`.
    kind: Option<String>,
    /// The folder of a dependency inside the workspace.
    path: Option<PathBuf>,
}

impl Package {
    /// Its folder below the root, by which the documents name it.
    fn folder(&self) -> String {
        let folder = self
            .manifest_path
            .parent()
            .expect("a manifest has a folder");
        let below = folder
            .strip_prefix(root())
            .expect("crates lie below the root");
        let names: Vec<_> = below.iter().map(|name| name.to_string_lossy()).collect();
        names.join("/")
    }

    /// Packages of the workspace that its own code depends on, not that of its tests.
    fn uses(&self) -> BTreeSet<String> {
        let dependencies = self.dependencies.iter();
        let own = dependencies.filter(|one| one.kind.is_none() && one.path.is_some());
        own.map(|one| one.name.clone()).collect()
    }
}

fn metadata() -> Metadata {
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--no-deps",
            "--offline",
            "--format-version",
            "1",
        ])
        .current_dir(root())
        .output()
        .expect("cargo starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("cargo prints JSON")
}

fn packages() -> Vec<Package> {
    metadata().packages
}

/// The packages of the workspace, and what each depends on.
fn graph() -> BTreeMap<String, BTreeSet<String>> {
    let packages = packages();
    packages
        .iter()
        .map(|package| (package.name.clone(), package.uses()))
        .collect()
}

/// All that a crate depends on, also through others.
fn reached(graph: &BTreeMap<String, BTreeSet<String>>, from: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(name) = open.pop() {
        open.extend(
            graph[name]
                .iter()
                .filter(|uses| found.insert((*uses).clone()))
                .map(String::as_str),
        );
    }
    found
}

#[test]
fn no_crate_reaches_what_it_must_not_know() {
    let (graph, rules) = (graph(), metadata().metadata.must_not_know);
    let (ruled, crates) = (rules.keys(), graph.keys());
    assert!(ruled.eq(crates), "left: rules in Cargo.toml, right: crates");
    for (name, forbidden) in &rules {
        for other in forbidden {
            assert!(graph.contains_key(other), "{name}: there is no `{other}`");
        }
        assert!(!forbidden.is_empty(), "{name} must not know anything?");
        let known: Vec<_> = reached(&graph, name)
            .intersection(forbidden)
            .cloned()
            .collect();
        assert!(known.is_empty(), "{name} must not know {known:?}");
    }
}

/// The crates of the picture, in reading order: a line is a folder and its crates, or folders that are crates.
fn drawn() -> Vec<String> {
    let page = std::fs::read_to_string(root().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let (_, crates) = page
        .split_once("\n## Folders and crates\n")
        .expect("a section on crates");
    let picture = crates.split("```").nth(1).expect("a picture");
    let mut crates = Vec::new();
    for line in picture.lines() {
        let mut folders = Vec::new();
        for word in line.split_whitespace() {
            match (word.strip_suffix('/'), &folders[..]) {
                (Some(folder), _) => folders.push(folder),
                (None, [folder]) => crates.push(format!("{folder}/{word}")),
                (None, _) => panic!("crates of one folder in a line: {line}"),
            }
        }
        if line.trim_end().ends_with('/') {
            crates.extend(folders.into_iter().map(str::to_string));
        }
    }
    crates
}

#[test]
fn the_picture_shows_each_crate_above_or_left_of_its_dependencies() {
    let (drawn, graph, packages) = (drawn(), graph(), packages());
    let places: BTreeMap<&str, usize> = drawn
        .iter()
        .enumerate()
        .map(|(place, name)| (name.as_str(), place))
        .collect();
    assert_eq!(places.len(), drawn.len(), "a crate is drawn twice");
    let shown: Vec<&str> = places.keys().copied().collect();
    let folders: BTreeMap<&str, String> = packages
        .iter()
        .map(|package| (package.name.as_str(), package.folder()))
        .collect();
    let crates: BTreeSet<&str> = folders.values().map(String::as_str).collect();
    assert!(
        shown.iter().eq(&crates),
        "drawn: {shown:?}, in Cargo: {crates:?}"
    );
    let place = |name: &str| places[folders[name].as_str()];
    for (name, uses) in &graph {
        for other in uses {
            assert!(
                place(name) < place(other),
                "{name} is not above or left of {other}"
            );
        }
    }
}

#[test]
fn packages_are_named_after_their_folders() {
    for package in packages() {
        let folder = package.folder();
        let expected = match folder.as_str() {
            "cli/rungc" => "rungc".to_string(),
            "frontend/formats" => "rungc-frontend".to_string(),
            "golden/suite" => "rungc-golden".to_string(),
            "golden/xtask" => "xtask".to_string(),
            "runtime-rt/sources" => "rungc-runtime-sources".to_string(),
            path => format!("rungc-{}", path.rsplit('/').next().unwrap_or(path)),
        };
        assert_eq!(package.name, expected);
    }
}

#[test]
fn each_crate_says_where_to_start_reading() {
    for package in packages() {
        let folder = package
            .manifest_path
            .parent()
            .expect("a manifest has a folder");
        let roots = ["src/lib.rs", "src/main.rs"].map(|root| folder.join(root));
        let root = roots
            .iter()
            .find(|root| root.exists())
            .expect("a crate's root");
        let text = std::fs::read_to_string(root).expect("a crate's root");
        let docs = text.lines().take_while(|line| line.starts_with("//!"));
        let docs = docs.map(|line| line.trim_start_matches("//!").trim());
        let docs = docs.collect::<Vec<_>>().join(" ");
        assert!(docs.contains("Start reading at"), "{}", root.display());
    }
}
