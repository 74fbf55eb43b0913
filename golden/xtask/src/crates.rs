//! The table of crates in ARCHITECTURE.md, from Cargo's metadata.

use crate::generate::Made;
use crate::{Problem, root, tools};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const PAGE: &str = "ARCHITECTURE.md";

/// Comments around the table.
const BEGIN: &str = "<!-- crates: cargo xtask generate crates -->\n";
const END: &str = "<!-- end of crates -->";

/// A crate of the workspace.
struct Crate {
    /// Its folder, below the root.
    folder: String,
    description: String,
    /// Names of the packages that its own code depends on, without those of its tests.
    uses: BTreeSet<String>,
    must_not_know: Vec<String>,
}

impl Crate {
    /// Its name in the documents: the last part of the folder.
    fn name(&self) -> &str {
        self.folder.rsplit('/').next().unwrap_or(&self.folder)
    }
}

/// ARCHITECTURE.md with the present table.
pub fn make() -> Result<Made, Problem> {
    let page = fs::read_to_string(root().join(PAGE))?;
    let (before, rest) = page.split_once(BEGIN).ok_or("no table of crates")?;
    let (_, after) = rest.split_once(END).ok_or("no end of the table")?;
    let table = table(&crates()?);
    Ok(Made::file(
        PAGE,
        format!("{before}{BEGIN}{table}{END}{after}"),
    ))
}

/// The crates of the workspace, by package.
fn crates() -> Result<BTreeMap<String, Crate>, Problem> {
    let metadata = tools::metadata()?;
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let crates = packages.map(|package| {
        let name = text(&package["name"]);
        let rules = &metadata["metadata"]["must-not-know"][&name];
        let dependencies = package["dependencies"].as_array().into_iter().flatten();
        let own = dependencies.filter(|one| one["kind"].is_null() && one["path"].is_string());
        let described = Crate {
            folder: folder(&text(&package["manifest_path"])),
            description: text(&package["description"]),
            uses: own.map(|one| text(&one["name"])).collect(),
            must_not_know: rules.as_array().into_iter().flatten().map(text).collect(),
        };
        (name, described)
    });
    Ok(crates.collect())
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_string()
}

/// The folder of a manifest, below the root.
fn folder(manifest: &str) -> String {
    let manifest = Path::new(manifest);
    let below = manifest.strip_prefix(root()).unwrap_or(manifest);
    let names = below.parent().into_iter().flatten();
    names
        .map(|name| name.to_string_lossy())
        .collect::<Vec<_>>()
        .join("/")
}

fn table(crates: &BTreeMap<String, Crate>) -> String {
    let mut rows: Vec<&Crate> = crates.values().collect();
    rows.sort_by_key(|one| &one.folder);
    let names = |packages: &mut dyn Iterator<Item = &String>| {
        let names = packages.filter_map(|package| crates.get(package));
        names.map(Crate::name).collect::<Vec<_>>().join(", ")
    };
    let mut table =
        "| crate | contents | built on | must not know |\n|---|---|---|---|\n".to_string();
    for one in rows {
        let built_on = names(&mut nearest(crates, one).into_iter());
        let unknown = names(&mut one.must_not_know.iter());
        table += &format!(
            "| `{}` | {} | {built_on} | {unknown} |\n",
            one.folder, one.description
        );
    }
    table
}

/// Dependencies that no other dependency brings along.
fn nearest<'a>(crates: &'a BTreeMap<String, Crate>, one: &'a Crate) -> Vec<&'a String> {
    let is_brought = |package: &&String| {
        let mut others = one.uses.iter().filter(|other| other != package);
        others.any(|other| reaches(crates, other, package))
    };
    one.uses
        .iter()
        .filter(|package| !is_brought(package))
        .collect()
}

/// Returns true if a crate depends on another, perhaps through others.
fn reaches(crates: &BTreeMap<String, Crate>, from: &str, to: &str) -> bool {
    let uses = crates.get(from).map(|one| &one.uses);
    let mut uses = uses.into_iter().flatten();
    uses.any(|next| next == to || reaches(crates, next, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(folder: &str, uses: &[&str]) -> (String, Crate) {
        let described = Crate {
            folder: folder.to_string(),
            description: format!("The {folder}"),
            uses: uses.iter().map(|name| name.to_string()).collect(),
            must_not_know: vec!["roof".to_string()],
        };
        (described.name().to_string(), described)
    }

    #[test]
    fn rows_name_the_nearest_dependencies() {
        let house = [
            named("house/roof", &["walls", "cellar"]),
            named("house/walls", &["cellar"]),
            named("cellar", &[]),
        ];
        let table = table(&BTreeMap::from(house));
        let rows: Vec<&str> = table.lines().skip(2).collect();
        assert_eq!(
            rows,
            [
                "| `cellar` | The cellar |  | roof |",
                "| `house/roof` | The house/roof | walls | roof |",
                "| `house/walls` | The house/walls | cellar | roof |"
            ]
        );
    }
}
