//! Program memory as a file: it goes through every command as other programs do.

use crate::common::{MOTOR, code, folder, rungc, shown, text};
use std::fs;

/// The instructions of a list, without comments.
fn instructions(list: &str) -> Vec<&str> {
    let lines = list
        .lines()
        .map(|line| line.split(';').next().unwrap().trim());
    lines.filter(|line| !line.is_empty()).collect()
}

#[test]
fn an_image_is_a_program_like_others() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    assert_eq!(
        code(
            path,
            &["convert", "motor.il", "--to", "image", "-o", "motor.bin"]
        ),
        0
    );
    insta::assert_snapshot!("image_check", shown(path, &["check", "motor.bin"]));
    let back = text(&rungc(path, &["convert", "motor.bin", "--to", "il"]).stdout);
    let numberless = back.lines().map(|line| {
        line.trim_start_matches([' ', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9'])
    });
    assert_eq!(numberless.collect::<Vec<_>>(), instructions(MOTOR));
    for command in [
        &["build", "motor.bin", "--emit", "c"][..],
        &["view", "motor.bin"],
    ] {
        assert_eq!(code(path, command), 0, "{command:?}");
    }
    fs::remove_file(path.join("motor.il")).unwrap();
    let all = text(&rungc(path, &["check", "."]).stderr);
    assert!(
        all.contains("motor.bin"),
        "a folder's images are found: {all}"
    );
}

#[test]
fn comments_beside_an_image_are_taken() {
    let list = format!(";! X000 = start button\n{MOTOR}");
    let folder = folder(&[("motor.il", list.as_bytes())]);
    let path = folder.path();
    for (to, file) in [("image", "motor.bin"), ("comments", "COMMENT.csv")] {
        let args = ["convert", "motor.il", "--to", to, "-o", file];
        assert_eq!(code(path, &args), 0, "{to}");
    }
    let back = text(&rungc(path, &["convert", "motor.bin", "--to", "il"]).stdout);
    assert!(back.starts_with(";! X000 = start button\n"), "{back}");
}

#[test]
fn nothing_is_written_of_what_machine_code_does_not_hold() {
    let list = ";! X000 = start\nLD X000\nMOV R0 D0\nEND\n";
    let folder = folder(&[("r.il", list.as_bytes()), ("short.bin", &[0; 8])]);
    let path = folder.path();
    insta::assert_snapshot!(
        "image_unknown",
        shown(path, &["convert", "r.il", "--to", "image", "-o", "r.bin"])
    );
    assert!(!path.join("r.bin").exists());
    insta::assert_snapshot!(
        "image_short",
        shown(path, &["check", "short.bin", "--from", "image"])
    );
}

#[test]
fn variables_of_plcopen_xml_are_named_by_a_table() {
    let project = br#"<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><pous><pou name="m" pouType="program">
        <body><IL>LD Start
ST Motor</IL></body></pou></pous></types></project>"#;
    let folder = folder(&[
        ("plc.xml", project),
        ("names.csv", b"Start,X003\nMotor,Y010\n"),
        ("odd.csv", b"Start X003\n"),
    ]);
    let path = folder.path();
    let convert = |names| {
        rungc(
            path,
            &["convert", "plc.xml", "--to", "il", "--names", names],
        )
    };
    let list = text(&convert("names.csv").stdout);
    assert_eq!(instructions(&list), ["LD X003", "OUT Y010", "END"]);
    let odd = convert("odd.csv");
    assert_eq!(odd.status.code(), Some(2));
    assert!(
        text(&odd.stderr).contains("`Start X003` is not a row"),
        "{}",
        text(&odd.stderr)
    );
    insta::assert_snapshot!("plcopen_variable", shown(path, &["check", "plc.xml"]));
}

#[test]
fn settings_name_devices_of_plcopen_variables() {
    let project = br#"<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><pous><pou name="m" pouType="program">
        <interface><localVars><variable name="Lamp"><type><BOOL/></type></variable></localVars></interface>
        <body><IL>LD Start
ST Motor
ST Lamp</IL></body></pou></pous></types></project>"#;
    let settings =
        b"[plcopen]\nfree = ['M30-M39']\n[plcopen.names]\nStart = 'X003'\nMotor = 'Y010'\n";
    let folder = folder(&[
        ("plc.xml", project),
        ("rungc.toml", settings),
        ("names.csv", b"Start,X007\n*,M50\n"),
    ]);
    let convert = |more: &[&str]| {
        let args = [&["convert", "plc.xml", "--to", "il"], more].concat();
        text(&rungc(folder.path(), &args).stdout)
    };
    let expected = ["LD X003", "OUT Y010", "OUT M30", "END"];
    assert_eq!(instructions(&convert(&[])), expected);
    let expected = ["LD X007", "OUT Y010", "OUT M50", "END"];
    assert_eq!(instructions(&convert(&["--names", "names.csv"])), expected);
}
