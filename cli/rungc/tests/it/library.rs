//! The library and the command line find and emit the same.

use crate::common::{folder, rungc, text};
use rungc::Project;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/programs");
    let found = rungc_frontend::programs(&folder, 1).unwrap();
    assert!(found.len() > 10);
    found
}

/// Programs with findings of all kinds: places, labels, other places, devices, helps, fixes.
const WRONG: [(&str, &str); 6] = [
    ("misspelt.il", "LD X000\nOTU Y000\nINC D0 D1\nEND\n"),
    (
        "doubled.il",
        "LD X000\nOUT Y000\nLD X001\nOUT Y000\nLD X008\nOUT Y001\nEND\n",
    ),
    (
        "other.il",
        "LD X000\nDRVA K1000 K500 Y000 Y004\nDHSZ K1 K2 C251 M0\nEND\n",
    ),
    ("open.il", "LD X000\nMPS\nOUT Y000\n"),
    ("unused.il", "LD X000\nINC D0\nLD M8013\nOUT Y000\nEND\n"),
    ("empty.il", ""),
];

#[test]
fn a_check_finds_what_the_command_reports() {
    let folder = folder(&WRONG.map(|(name, list)| (name, list.as_bytes())));
    let wrong = WRONG.map(|(name, _)| folder.path().join(name));
    let mut kinds = 0;
    for file in examples().iter().chain(&wrong) {
        let reported = rungc(
            folder.path(),
            &["check", "--format", "json", file.to_str().unwrap()],
        );
        let reported: Value = serde_json::from_slice(&reported.stdout).unwrap();
        let project = Project::open(file).unwrap();
        let checked = project.check();
        let found = serde_json::to_value(&checked.diagnostics).unwrap();
        assert_eq!(found, reported["diagnostics"], "{}", file.display());
        assert_eq!(reported["model"], checked.model.name);
        assert_eq!(reported["steps"], checked.steps);
        kinds += checked.diagnostics.len();
    }
    assert!(kinds > 10, "{kinds}");
}

#[test]
fn emitted_code_is_that_of_the_command() {
    let folder = folder(&[]);
    let mut compared = 0;
    for file in examples() {
        // Some are for another model than the default one.
        let Ok(program) = Project::open(&file).unwrap().check().compile() else {
            continue;
        };
        compared += 1;
        for (form, files) in [("c", program.emit_c()), ("rust", program.emit_rust())] {
            let out = folder.path().join(program.name()).join(form);
            let arguments = ["build", file.to_str().unwrap(), "--emit", form, "-o"];
            let arguments = [&arguments[..], &[out.to_str().unwrap()]].concat();
            let built = rungc(folder.path(), &arguments);
            assert!(built.status.success(), "{}", text(&built.stderr));
            for emitted in files {
                let written = fs::read_to_string(out.join(&emitted.path)).unwrap();
                assert_eq!(written, emitted.contents, "{}", emitted.path);
            }
        }
    }
    assert!(compared > 9, "{compared}");
}
