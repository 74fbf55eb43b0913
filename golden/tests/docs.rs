//! The generated parts of the documentation are what the catalogue says. `UPDATE_DOCS=1 cargo test -p rungc-golden --test docs`
//! writes them anew.

use rungc_models::{Model, ModelId};
use std::fs;
use std::path::{Path, PathBuf};

const BEGIN: &str = "<!-- support table: generated from the catalogue -->\n";
const END: &str = "<!-- end of the support table -->\n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Compares a file with what it should hold, or writes it.
fn check(path: &Path, expected: &str) {
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(path, expected).unwrap();
    }
    let actual = fs::read_to_string(path).unwrap_or_default();
    assert!(
        actual == expected,
        "{} is out of date; UPDATE_DOCS=1 cargo test -p rungc-golden --test docs writes it anew",
        path.display()
    );
}

#[test]
fn support_table_of_the_readme() {
    let path = root().join("README.md");
    let readme = fs::read_to_string(&path).unwrap();
    let (before, rest) = readme
        .split_once(BEGIN)
        .expect("README.md marks where the table begins");
    let (_, after) = rest
        .split_once(END)
        .expect("README.md marks where the table ends");
    let table = rungc_catalogue::support_table();
    check(&path, &format!("{before}{BEGIN}\n{table}\n{END}{after}"));
}

#[test]
fn special_devices_of_every_model() {
    for id in ModelId::ALL {
        let model = Model::get(id);
        let table = rungc_catalogue::special_table(id);
        let text = format!(
            "# Special devices of {}\n\nGenerated from the catalogue. `rungc explain M8013 --model {}` shows one of them.\n\n{table}",
            model.title, model.name
        );
        check(
            &root().join(format!("docs/src/special-devices/{}.md", model.name)),
            &text,
        );
    }
}
