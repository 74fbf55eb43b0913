//! Learning codes of instructions from the list that an editor exports.

use crate::common::{FX3U, code, folder, rungc, shown, text, wpg};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Codes that are not known: 63 09 77 twice, and 63 07 78, one after the other; WDT by a code that was derived.
const STRANGE: &[&[u8]] = &[
    &[0x00],
    &[0x9C, 0x00],
    &[0x63, 0x09, 0x77],
    &[0x9C, 0x08],
    &[0x9C, 0x01],
    &[0x9D, 0x00],
    &[0x9D, 0x04],
    &[0x63, 0x07, 0x78],
    &[0xE8, 0x64],
    &[0x9D, 0x00],
    &[0x9D, 0x04],
    &[0x63, 0x09, 0x77],
    &[0x9C, 0x08],
    &[0x9C, 0x02],
    &[0x9D, 0x01],
    &[0x9D, 0x05],
    &[0x61, 0x01, 0x00],
    &[0x34],
];

/// The same as a list.
const LIST: &str = "0 LD X000\n1 DSZR X010 X001 Y000 Y004\n10 PLSV K100 Y000 Y004\n17 DSZR X010 X002 Y001 Y005\n26 WDT\n27 END\n";

/// A folder with the project as `MAIN.wpg` and a list of it as `MAIN.csv`.
fn project(list: &str) -> TempDir {
    let folder = folder(&[
        ("MAIN.wpg", &wpg(FX3U, STRANGE)),
        ("list.il", list.as_bytes()),
    ]);
    let convert = ["convert", "list.il", "--to", "csv", "-o", "MAIN.csv"];
    assert_eq!(code(folder.path(), &convert), 0);
    folder
}

const LEARN: [&str; 3] = ["learn", "MAIN.wpg", "MAIN.csv"];

#[test]
fn codes_are_learned_and_used_from_then_on() {
    let folder = project(LIST);
    let path = folder.path();
    insta::assert_snapshot!("unknown_codes", shown(path, &["check", "MAIN.wpg"]));
    insta::assert_snapshot!("learned_codes", shown(path, &LEARN));
    let settings = fs::read_to_string(path.join("rungc.toml")).unwrap();
    insta::assert_snapshot!("learned_settings", settings);
    let case = "topic = \"home\"\n[[case]]\nname = \"nothing_moves\"\nprogram = { file = \"MAIN.wpg\" }\n[[case.step]]\nscans = 1\nexpect = { Y0 = 0 }\n";
    fs::write(path.join("slide.plctest.toml"), case).unwrap();
    for args in [
        &["check", "MAIN.wpg"][..],
        &["test", "slide.plctest.toml"],
        &["build", "MAIN.wpg", "--emit", "c"],
        &["run", "MAIN.wpg"],
    ] {
        assert_eq!(code(path, args), 0, "{args:?}");
    }
    let list = rungc(path, &["convert", "MAIN.wpg", "--to", "il"]);
    let list = text(&list.stdout);
    let lines: Vec<_> = list.lines().filter(|line| !line.starts_with(';')).collect();
    let expected: Vec<_> = LIST.lines().collect();
    let words = |lines: &[&str]| -> Vec<String> {
        let words = |line: &&str| line.split_whitespace().collect::<Vec<_>>().join(" ");
        lines.iter().map(words).collect()
    };
    assert_eq!(words(&lines), words(&expected));
    insta::assert_snapshot!("nothing_to_learn", shown(path, &LEARN));
}

#[test]
fn settings_stay_as_they_are() {
    let folder = project(LIST);
    let path = folder.path();
    let before = "# The press.\n[project]\nmodel = \"fx3u\"   # for now\n\n[tokens]\n\"59 0b 14\" = \"ASC\" # by hand\n\n[check]\nallow = [\"W0203\"]\n";
    fs::write(path.join("rungc.toml"), before).unwrap();
    fs::create_dir(path.join("sub")).unwrap();
    fs::rename(path.join("MAIN.wpg"), path.join("sub/MAIN.wpg")).unwrap();
    assert_eq!(code(path, &["learn", "sub/MAIN.wpg", "MAIN.csv"]), 0);
    assert!(!path.join("sub/rungc.toml").exists());
    let after = fs::read_to_string(path.join("rungc.toml")).unwrap();
    insta::assert_snapshot!("settings_with_codes", after);
    assert_eq!(code(path, &["check", "sub/MAIN.wpg"]), 0);
}

#[test]
fn codes_go_to_the_end_of_their_table() {
    let folder = project(LIST);
    let path = folder.path();
    let learned = |before: &str| {
        fs::write(path.join("rungc.toml"), before).unwrap();
        let code = code(path, &["learn", "MAIN.wpg", "MAIN.csv"]);
        (code, fs::read_to_string(path.join("rungc.toml")).unwrap())
    };
    let codes = "\"61 01 00\" = \"WDT\"\n\"63 07 78\" = \"PLSV\"\n\"63 09 77\" = \"DSZR\"\n";
    for (before, between) in [
        ("[project]", "\n\n[tokens]\n"),
        ("[project]\n", "\n[tokens]\n"),
        ("[tokens]", "\n"),
        ("[project]\n[ tokens ] # read so far\n", ""),
        ("[tokens]\n\"59 0b 14\" = \"ASC\"", "\n"),
    ] {
        assert_eq!(learned(before), (0, format!("{before}{between}{codes}")));
    }
    for before in ["tokens = {}\n", "tokens.\"59 0b 14\" = \"ASC\"\n"] {
        assert_eq!(learned(before), (2, before.to_owned()));
    }
    insta::assert_snapshot!("codes_that_are_not_in_a_table", shown(path, &LEARN));
}

#[test]
fn settings_go_where_the_project_is() {
    let folder = project(LIST);
    let path = folder.path();
    let body = path.join("press/Resource/POU/Body");
    fs::create_dir_all(&body).unwrap();
    fs::rename(path.join("MAIN.wpg"), body.join("MAIN.wpg")).unwrap();
    let learn = |file: &str| code(path, &["learn", file, "MAIN.csv"]);
    assert_eq!(learn("press"), 0);
    let settings = path.join("press/rungc.toml");
    let written = fs::read_to_string(&settings).unwrap();
    fs::remove_file(&settings).unwrap();
    assert_eq!(learn("press/Resource/POU/Body/MAIN.wpg"), 0);
    assert_eq!(fs::read_to_string(&settings).unwrap(), written);
    let given = ["learn", "press", "MAIN.csv", "--project", "codes.toml"];
    assert_eq!(code(path, &given), 0);
    let given = ["check", "press", "--project", "codes.toml"];
    assert_eq!(code(path, &given), 0);
}

#[test]
fn derived_codes_can_turn_out_to_be_others() {
    let folder = project(&LIST.replace("WDT", "SRET"));
    let output = rungc(folder.path(), &LEARN);
    assert_eq!(output.status.code(), Some(0));
    let messages = text(&output.stdout);
    assert!(
        messages.contains("61 01 00 was read as WDT before."),
        "{messages}"
    );
}

/// Message about a list that teaches nothing; nothing is written.
fn refused(list: &str) -> String {
    let folder = project(list);
    let output = rungc(folder.path(), &LEARN);
    assert_eq!(output.status.code(), Some(2), "{list}");
    assert!(output.stdout.is_empty());
    assert!(!folder.path().join("rungc.toml").exists());
    text(&output.stderr)
}

#[test]
fn lists_that_do_not_match_teach_nothing() {
    let edited = |from: &str, to: &str| {
        assert!(LIST.contains(from), "{from}");
        refused(&LIST.replacen(from, to, 1))
    };
    let messages = [
        edited("LD X000", "LDI X000"),
        edited("X001 Y000 Y004", "X003 Y000 Y004"),
        edited("10 PLSV K100 Y000 Y004\n", ""),
        edited("27 END", "27 NOP\n28 OUT Y007\n29 END"),
        edited("26 WDT\n27 END\n", ""),
        edited("17 DSZR", "17 ZRN"),
        edited("10 PLSV K100 Y000 Y004\n17", "10 PLSV K100 Y000 Y004\n23"),
        edited("PLSV", "PLSW"),
        edited("26 WDT", "26 SRET\n27 WDT"),
    ];
    insta::assert_snapshot!(messages.concat());
}

#[test]
fn instructions_that_do_not_fit_teach_nothing() {
    // Of 7 steps with these operands, but not a pulse output's.
    insta::assert_snapshot!(refused(&LIST.replace("PLSV", "ADD")));
}

#[test]
fn files_of_the_wrong_kind_teach_nothing() {
    let folder = project(LIST);
    let path = folder.path();
    let damaged = wpg(FX3U, &[&[0x00], &[0xF0, 0x01], &[0x34]]);
    fs::write(path.join("damaged.wpg"), damaged).unwrap();
    fs::write(path.join("bad.il"), "LD X0\nOUT ??\nEND\n").unwrap();
    let messages = [
        ["MAIN.csv", "MAIN.csv"],
        ["MAIN.wpg", "MAIN.wpg"],
        ["damaged.wpg", "MAIN.csv"],
        ["MAIN.wpg", "bad.il"],
        ["none.wpg", "MAIN.csv"],
    ]
    .map(|[project, export]| shown(path, &["learn", project, export]));
    insta::assert_snapshot!(messages.join("\n"));
    assert!(!Path::new(path).join("rungc.toml").exists());
}

#[test]
fn codes_that_cannot_be_learned_are_refused_in_settings() {
    let folder = project(LIST);
    let path = folder.path();
    fs::write(
        path.join("rungc.toml"),
        "[tokens]\n\"56 09 02\" = \"FROM\"\n",
    )
    .unwrap();
    insta::assert_snapshot!(shown(path, &["check", "MAIN.wpg"]));
}
