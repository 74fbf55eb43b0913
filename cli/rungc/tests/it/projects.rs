//! Projects of the editors, and names and texts in any script, on the command line.

#[allow(dead_code, reason = "the tests of the readers use all of it")]
#[path = "../../../../frontend/formats/tests/it/fixture/mod.rs"]
mod fixture;

use crate::common::{MOTOR, folder, rungc, shown, text};
use fixture::{project, qcd, replace, res, simple, structured_text, wpa};
use std::fs;

/// `LD X001 / OUT Y001 / END`.
const NEW: &[&[u8]] = &[&[0x00], &[0x9C, 1], &[0x20], &[0x9D, 1], &[0x34]];
/// `LDI X002 / OUT Y002 / END`.
const OLD: &[&[u8]] = &[&[0x01], &[0x9C, 2], &[0x20], &[0x9D, 2], &[0x34]];

#[test]
fn the_compiled_program_is_read_on_purpose() {
    let mut parts = simple("FX3U/FX3UC", NEW);
    replace(&mut parts, "MAIN.res", res(2, OLD, &[]));
    let changed = project(&parts);
    replace(
        &mut parts,
        "MAIN.Program.pou",
        structured_text(8, "Y5 := X1;"),
    );
    let folder = folder(&[("changed.gxw", &changed), ("stale.gxw", &project(&parts))]);
    let list = |args: &[&str]| {
        let args = [&["convert", "--to", "il", "-q"], args].concat();
        let output = rungc(folder.path(), &args);
        (output.status.code(), text(&output.stdout))
    };
    let (code, source) = list(&["changed.gxw"]);
    assert!(code == Some(0) && source.contains("LD X001"), "{source}");
    let (code, compiled) = list(&["changed.gxw", "--compiled"]);
    assert!(
        code == Some(0) && compiled.contains("LDI X002"),
        "{compiled}"
    );
    let (code, stale) = list(&["stale.gxw"]);
    assert_eq!((code, stale.as_str()), (Some(1), ""));
    let (code, stale) = list(&["stale.gxw", "--compiled"]);
    assert!(code == Some(0) && stale.contains("LDI X002"), "{stale}");
}

#[test]
fn comments_and_parameters_of_a_project() {
    let mut parts = simple("FX2N/FX2NC", NEW);
    replace(&mut parts, "COMMENT.qcd", qcd(&[(0x9C, 1, "cảm biến 1")]));
    let latched = [1, 0, 0x90, 0, 10, 0, 0, 0];
    let blocks: &[(u16, &[u8])] = &[(0x2001, &latched), (0xFFE0, &[8, 0]), (0xFFE2, &[2, 0])];
    replace(&mut parts, "Param.wpa", wpa(0x0205, blocks));
    let folder = folder(&[("press.gxw", &project(&parts))]);
    insta::assert_snapshot!(shown(folder.path(), &["check", "-v", "press.gxw"]));
    let emitted = rungc(folder.path(), &["build", "press.gxw", "--emit", "c"]);
    assert_eq!(emitted.status.code(), Some(0));
    let header = fs::read_to_string(folder.path().join("press-c/press.h")).unwrap();
    assert!(header.contains("cảm biến 1"), "{header}");
}

#[test]
fn an_encoding_that_is_named_is_taken() {
    let list = b"LD X0 ; N\xEDvel\nOUT Y0\nEND\n";
    let folder = folder(&[("level.il", list)]);
    let comment = |args: &[&str]| {
        let args = [&["convert", "level.il", "--to", "il"], args].concat();
        text(&rungc(folder.path(), &args).stdout)
    };
    assert!(comment(&[]).contains("Nível"));
    assert!(comment(&["--encoding", "windows-1251"]).contains("Nнvel"));
    let unknown = ["check", "level.il", "--encoding", "klingon"];
    insta::assert_snapshot!("unknown_encoding", shown(folder.path(), &unknown));
}

#[test]
fn names_in_any_script() {
    let folder = folder(&[
        ("往复式传送带.il", MOTOR.as_bytes()),
        ("motor.il", MOTOR.as_bytes()),
    ]);
    let build = |args: &[&str]| shown(folder.path(), &[&["build", "--emit", "c"], args].concat());
    insta::assert_snapshot!("name_of_the_file", build(&["往复式传送带.il"]));
    let files = fs::read_dir(folder.path().join("往复式传送带-c")).unwrap();
    let mut files: Vec<_> = files.map(|file| file.unwrap().file_name()).collect();
    files.sort();
    let code = "wang_fu_shi_chuan_song_dai_98fe";
    assert!(files.contains(&format!("{code}.c").into()), "{files:?}");
    insta::assert_snapshot!("name_that_is_given", build(&["motor.il", "--name", "往复"]));
    assert!(folder.path().join("往复-c").is_dir());
}
