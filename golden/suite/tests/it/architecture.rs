//! ARCHITECTURE.md's picture and the rules in `Cargo.toml` agree with Cargo's metadata, and each crate says where to
//! start reading.

use rungc_golden::workspace::{self, Crate, Crates};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

fn crates() -> Crates {
    workspace::crates(&root()).expect("cargo metadata")
}

#[test]
fn no_crate_reaches_what_it_must_not_know() {
    let crates = crates();
    for (name, Crate { must_not_know, .. }) in &crates {
        assert!(
            !must_not_know.is_empty(),
            "no rule for {name} in Cargo.toml"
        );
        let reached = workspace::reached(&crates, name);
        let known: Vec<_> = reached.intersection(must_not_know).collect();
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
    let (drawn, crates) = (drawn(), crates());
    let places: BTreeMap<&str, usize> = drawn
        .iter()
        .enumerate()
        .map(|(place, name)| (name.as_str(), place))
        .collect();
    assert_eq!(places.len(), drawn.len(), "a crate is drawn twice");
    let shown: BTreeSet<&str> = places.keys().copied().collect();
    let folders: BTreeSet<&str> = crates.values().map(|one| one.folder.as_str()).collect();
    assert_eq!(shown, folders, "left: drawn, right: in Cargo");
    let place = |name: &str| places[crates[name].folder.as_str()];
    for (name, Crate { uses, .. }) in &crates {
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
    for (package, one) in crates() {
        let expected = match one.folder.as_str() {
            "cli/rungc" => "rungc".to_string(),
            "frontend/formats" => "rungc-frontend".to_string(),
            "golden/suite" => "rungc-golden".to_string(),
            "golden/xtask" => "xtask".to_string(),
            "runtime-rt/sources" => "rungc-runtime-sources".to_string(),
            _ => format!("rungc-{}", one.name()),
        };
        assert_eq!(package, expected);
    }
}

#[test]
fn each_crate_says_where_to_start_reading() {
    for one in crates().values() {
        let roots = ["src/lib.rs", "src/main.rs"].map(|file| root().join(&one.folder).join(file));
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
