//! ARCHITECTURE.md's picture and table of the crates agree with Cargo's metadata, and each crate says where to start
//! reading.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
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
    /// `None` for a normal one, else `dev` or `build`.
    kind: Option<String>,
    /// The folder of a dependency inside the workspace.
    path: Option<PathBuf>,
}

/// A crate's folder below the root, by which the documents name it.
fn folder(path: &Path) -> String {
    let below = path
        .strip_prefix(root())
        .expect("crates lie below the root");
    let names: Vec<_> = below.iter().map(|name| name.to_string_lossy()).collect();
    names.join("/")
}

impl Package {
    fn folder(&self) -> String {
        folder(
            self.manifest_path
                .parent()
                .expect("a manifest has a folder"),
        )
    }

    /// Dependencies of its code, not of its tests.
    fn uses(&self) -> BTreeSet<String> {
        let normal = self.dependencies.iter().filter(|d| d.kind.is_none());
        normal
            .filter_map(|d| Some(folder(d.path.as_deref()?)))
            .collect()
    }
}

fn packages() -> Vec<Package> {
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
    let metadata: Metadata = serde_json::from_slice(&output.stdout).expect("cargo prints JSON");
    metadata.packages
}

/// The crates of the workspace, and what each depends on.
fn graph() -> BTreeMap<String, BTreeSet<String>> {
    let packages = packages();
    packages
        .iter()
        .map(|package| (package.folder(), package.uses()))
        .collect()
}

/// The section on crates of ARCHITECTURE.md.
fn section() -> String {
    let text = std::fs::read_to_string(root().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let (_, section) = text
        .split_once("\n## Crates\n")
        .expect("a section on crates");
    let end = section.find("\n## ").unwrap_or(section.len());
    section[..end].to_string()
}

/// The names in backquotes.
fn quoted(cell: &str) -> BTreeSet<String> {
    cell.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_string)
        .collect()
}

/// The rows of the table: a crate, what it depends on, what it must not know.
fn rows() -> Vec<(String, BTreeSet<String>, BTreeSet<String>)> {
    let section = section();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    rows.map(|row| {
        let cells: Vec<&str> = row.trim_matches('|').split('|').collect();
        let [name, uses, forbidden] = cells[..] else {
            panic!("three columns: {row}");
        };
        let name = quoted(name).pop_first().expect("a crate's name");
        (name, quoted(uses), quoted(forbidden))
    })
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
fn the_table_lists_what_crates_depend_on() {
    let rows = rows();
    let listed = rows
        .iter()
        .map(|(name, uses, _)| (name.clone(), uses.clone()));
    let listed: BTreeMap<_, _> = listed.collect();
    assert_eq!(listed.len(), rows.len(), "a crate has two rows");
    assert_eq!(listed, graph(), "left: ARCHITECTURE.md, right: Cargo");
}

#[test]
fn no_crate_reaches_what_it_must_not_know() {
    let graph = graph();
    for (name, _, forbidden) in rows() {
        for other in &forbidden {
            assert!(
                graph.contains_key(other),
                "{name}: there is no crate `{other}`"
            );
        }
        assert!(!forbidden.is_empty(), "{name} must not know anything?");
        let known: Vec<_> = reached(&graph, &name)
            .intersection(&forbidden)
            .cloned()
            .collect();
        assert!(known.is_empty(), "{name} must not know {known:?}");
    }
}

/// The crates of the picture, in reading order: a line is a folder and its crates, or folders that are crates.
fn drawn() -> Vec<String> {
    let section = section();
    let picture = section.split("```").nth(1).expect("a picture");
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
    let (drawn, graph) = (drawn(), graph());
    let places: BTreeMap<&str, usize> = drawn
        .iter()
        .enumerate()
        .map(|(place, name)| (name.as_str(), place))
        .collect();
    assert_eq!(places.len(), drawn.len(), "a crate is drawn twice");
    let shown: Vec<&str> = places.keys().copied().collect();
    let crates: Vec<&str> = graph.keys().map(String::as_str).collect();
    assert_eq!(shown, crates, "left: the picture, right: Cargo");
    for (name, uses) in &graph {
        for other in uses {
            assert!(
                places[name.as_str()] < places[other.as_str()],
                "{name} stands above or left of {other}"
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
