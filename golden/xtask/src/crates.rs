//! The table of crates in ARCHITECTURE.md, from Cargo's metadata.

use crate::generate::Made;
use crate::{Problem, root};
use rungc_golden::workspace::{self, Crate, Crates};
use std::fs;

const PAGE: &str = "ARCHITECTURE.md";

/// Comments around the table.
const BEGIN: &str = "<!-- crates: cargo xtask generate crates -->\n";
const END: &str = "<!-- end of crates -->";

/// ARCHITECTURE.md with the present table.
pub fn make() -> Result<Made, Problem> {
    let page = fs::read_to_string(root().join(PAGE))?;
    let (before, rest) = page.split_once(BEGIN).ok_or("no table of crates")?;
    let (_, after) = rest.split_once(END).ok_or("no end of the table")?;
    let table = table(&workspace::crates(&root())?);
    Ok(Made::file(
        PAGE,
        format!("{before}{BEGIN}{table}{END}{after}"),
    ))
}

fn table(crates: &Crates) -> String {
    let mut rows: Vec<&Crate> = crates.values().collect();
    rows.sort_by_key(|one| &one.folder);
    let names = |packages: &mut dyn Iterator<Item = &String>| {
        let names = packages.filter_map(|package| crates.get(package));
        names.map(Crate::name).collect::<Vec<_>>().join(", ")
    };
    let mut table =
        "| crate | contents | built on | must not know |\n|---|---|---|---|\n".to_string();
    for one in rows {
        let built_on = names(&mut workspace::nearest(crates, one).into_iter());
        let unknown = names(&mut one.must_not_know.iter());
        table += &format!(
            "| `{}` | {} | {built_on} | {unknown} |\n",
            one.folder, one.description
        );
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(folder: &str, uses: &[&str]) -> (String, Crate) {
        let described = Crate {
            folder: folder.to_string(),
            description: format!("The {folder}"),
            uses: uses.iter().map(|name| name.to_string()).collect(),
            must_not_know: ["roof".to_string()].into(),
            is_published: true,
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
        let table = table(&Crates::from(house));
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
