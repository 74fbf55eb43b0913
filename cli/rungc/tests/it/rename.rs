//! Another device in place of one, and labels.

use crate::common::{code, folder, shown, text};
use std::fs;

const PRESS: &str = "\
;! X000 = start\n;! M0 = automatic\n;! M2 = Automatic\n;! M3 = D0\n;! Y000 = valve\n\
LD X000 ; the button\nOR M0\nOUT M0\nLD M0\nOUT Y000\nLD M2\nMOV K1M20 D0\nEND\n";

#[test]
fn a_device_gets_another_place_or_stays_with_the_reason() {
    let folder = folder(&[("press.il", PRESS.as_bytes())]);
    let path = folder.path();
    let rename = |args: &[&str]| shown(path, &[&["rename", "press.il"], args].concat());
    let list = || fs::read_to_string(path.join("press.il")).unwrap();
    insta::assert_snapshot!("rename_listed", rename(&["M0", "M100", "--dry-run"]));
    assert_eq!(list(), PRESS);
    for refused in ["M2", "M20", "D5", "M8000", "X9", "M9999999"] {
        assert_eq!(code(path, &["rename", "press.il", "M0", refused]), 2);
        assert_eq!(list(), PRESS, "{refused}");
    }
    insta::assert_snapshot!("rename_taken", rename(&["M0", "M21"]));
    insta::assert_snapshot!("rename_latched", rename(&["start", "X020"]));
    insta::assert_snapshot!("rename_notes", rename(&["M0", "M600"]));
    insta::assert_snapshot!("renamed_list", list());
    // A project of an editor is not written.
    let st = "PROGRAM main\nY0 := X0;\nEND_PROGRAM\n";
    fs::write(path.join("main.st"), st).unwrap();
    assert_eq!(code(path, &["rename", "main.st", "Y000", "Y001"]), 2);
    assert_eq!(fs::read_to_string(path.join("main.st")).unwrap(), st);
}

#[test]
fn a_name_becomes_a_label() {
    let folder = folder(&[("press.il", PRESS.as_bytes())]);
    let path = folder.path();
    let rename = |args: &[&str]| shown(path, &[&["rename", "press.il"], args].concat());
    let settings = || fs::read_to_string(path.join("rungc.toml")).unwrap();
    insta::assert_snapshot!(
        "label_listed",
        rename(&["M0", "Press.Automatic", "--dry-run"])
    );
    assert!(!path.join("rungc.toml").exists());
    rename(&["M0", "Press.Automatic"]);
    insta::assert_snapshot!("labels_by_comments", rename(&["--comments"]));
    insta::assert_snapshot!("label_settings", settings());
    let why = text(&crate::common::rungc(path, &["why", "press.il", "Press.Automatic"]).stdout);
    assert!(why.starts_with("M0 \"Press.Automatic\""), "{why}");
    // All have one now.
    let before = settings();
    insta::assert_snapshot!("label_again", rename(&["M0", "Other"]));
    insta::assert_snapshot!("label_taken", rename(&["D0", "valve"]));
    insta::assert_snapshot!("rename_labelled", rename(&["M0", "M100"]));
    assert_eq!(settings(), before);
    // Settings that are about another program.
    fs::write(path.join("rungc.toml"), "[project]\nmodel = \"fx3u\"\n").unwrap();
    insta::assert_snapshot!("label_of_another", rename(&["M0", "Ready"]));
}
