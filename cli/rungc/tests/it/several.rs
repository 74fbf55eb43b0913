//! Several programs at once: files, folders and standard input.

use crate::common::{MOTOR, code, folder, rungc, shown, text, with_slashes};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// One error.
const BAD: &str = "LD X000\nMOVE D0 D1\nEND\n";

/// Correct, with a double coil.
const DOUBLE: &str = "LD X000\nOUT Y000\nLD X001\nOUT Y000\nEND\n";

/// A list export without its head, and a table that is none.
const EXPORT: &str =
    "\"0\",\"\",\"LD\",\"X000\"\n\"1\",\"\",\"OUT\",\"Y000\"\n\"2\",\"\",\"END\",\"\"\n";
const TABLE: &str = "date,pieces\n2026-01-02,5\n";

fn with_input(folder: &Path, args: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(input.as_bytes())
        .unwrap();
    child.wait_with_output().unwrap()
}

fn plant() -> tempfile::TempDir {
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("double.il", DOUBLE.as_bytes()),
        ("list.csv", EXPORT.as_bytes()),
        ("data.csv", TABLE.as_bytes()),
        ("notes.txt", b"LD X0\n"),
    ]);
    for inner in ["line", "target", ".git"] {
        fs::create_dir(folder.path().join(inner)).unwrap();
        fs::write(folder.path().join(inner).join("motor.il"), BAD).unwrap();
    }
    folder
}

#[test]
fn files_and_folders_are_checked() {
    let folder = plant();
    let path = folder.path();
    insta::assert_snapshot!(
        "check_files",
        with_slashes(&shown(path, &["check", "double.il", "motor.il"]))
    );
    insta::assert_snapshot!("check_folder", with_slashes(&shown(path, &["check", "."])));
    insta::assert_snapshot!(
        "check_unread",
        with_slashes(&shown(
            path,
            &["check", "none.il", "motor.il", "line/motor.il"]
        ))
    );
    assert_eq!(code(path, &["check", "motor.il", "line"]), 1);
    assert_eq!(code(path, &["check", "-q", "motor.il", "double.il"]), 0);
    assert!(
        rungc(path, &["check", "-q", "motor.il", "list.csv"])
            .stderr
            .is_empty()
    );
    // A file that is named twice is checked once.
    let twice = rungc(path, &["check", "motor.il", "motor.il"]);
    assert!(text(&twice.stderr).contains("Total 1 program:"));
}

#[test]
fn documents_hold_all_files() {
    let folder = plant();
    let path = folder.path();
    let files = ["check", "none.il", "double.il", "line/motor.il"];
    for format in ["json", "sarif"] {
        let args = [&files[..], &["--format", format]].concat();
        insta::assert_snapshot!(format!("check_{format}"), with_slashes(&shown(path, &args)));
    }
    // The shape follows from the command line: of a folder it is that of several, whatever is in it.
    let args = ["check", "line", "--format", "json"];
    let read: serde_json::Value = serde_json::from_slice(&rungc(path, &args).stdout).unwrap();
    let file = read["files"][0]["file"].as_str().unwrap();
    assert_eq!(with_slashes(file), "line/motor.il");
    assert_eq!(read["errors"], 1);
}

#[test]
fn standard_input_is_a_program() {
    let folder = plant();
    let path = folder.path();
    let checked = with_input(path, &["check", "-"], MOTOR);
    assert_eq!(checked.status.code(), Some(0));
    assert!(text(&checked.stderr).contains("Checked stdin (FX3U"));
    let checked = with_input(path, &["check", "motor.il", "-"], BAD);
    assert_eq!(checked.status.code(), Some(1));
    assert!(
        text(&checked.stderr).contains("╭─[ stdin:2:1 ]"),
        "{}",
        text(&checked.stderr)
    );
    let converted = with_input(path, &["convert", "-", "--to", "il"], EXPORT);
    assert!(
        text(&converted.stdout).contains("OUT"),
        "{}",
        text(&converted.stdout)
    );
    let built = with_input(path, &["build", "-", "--emit", "c", "-o", "out"], MOTOR);
    assert_eq!(built.status.code(), Some(0), "{}", text(&built.stderr));
    assert!(path.join("out/program.c").is_file());
    let twice = with_input(path, &["check", "-", "-"], MOTOR);
    assert_eq!(twice.status.code(), Some(2));
    assert!(text(&twice.stderr).contains("can be read only once"));
}

#[test]
fn each_program_is_built_into_its_place() {
    let folder = plant();
    let path = folder.path();
    let args = [
        "build",
        "motor.il",
        "double.il",
        "line",
        "--emit",
        "c",
        "-o",
        "out",
    ];
    insta::assert_snapshot!("build_several", with_slashes(&shown(path, &args)));
    assert!(path.join("out/double/double.c").is_file());
    assert!(path.join("out/motor/motor.c").is_file());
    assert_eq!(
        code(path, &["build", "motor.il", "double.il", "--emit", "rust"]),
        0
    );
    assert!(path.join("motor-rust").is_dir() && path.join("double-rust").is_dir());
    fs::write(path.join("line/motor.il"), MOTOR).unwrap();
    let args = [
        "build", "motor.il", "line", "--emit", "ir", "-o", "ir", "--force",
    ];
    insta::assert_snapshot!("build_same_name", with_slashes(&shown(path, &args)));
    assert!(path.join("ir/motor.ir").is_file());
    let args = [
        "build",
        "motor.il",
        "double.il",
        "--emit",
        "c",
        "--name",
        "x",
    ];
    assert_eq!(code(path, &args), 2);
}

#[test]
fn several_programs_are_converted_into_a_folder() {
    let folder = plant();
    let path = folder.path();
    let args = ["convert", "motor.il", "list.csv", "--to", "il"];
    assert_eq!(code(path, &args), 2, "where to?");
    assert_eq!(code(path, &[&args[..], &["-o", "out"]].concat()), 0);
    assert!(
        fs::read_to_string(path.join("out/list.il"))
            .unwrap()
            .contains("OUT")
    );
    assert!(path.join("out/motor.il").is_file());
    let output = rungc(path, &[&args[..], &["-o", "all.il"]].concat());
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    let advice = "`all.il` is the name of a file: name a folder, such as `all`";
    assert!(said.contains(advice), "{said}");
    assert!(!path.join("all.il").exists());
}

/// The document for tools stays one, whatever happens between the files.
#[test]
fn failures_between_files_leave_the_document_whole() {
    let folder = plant();
    let path = folder.path();
    fs::create_dir_all(path.join("out/motor")).unwrap();
    fs::write(path.join("out/motor/kept"), "").unwrap();
    let args = [
        "build",
        "motor.il",
        "double.il",
        "--emit",
        "c",
        "-o",
        "out",
        "--format",
        "json",
    ];
    let output = rungc(path, &args);
    assert_eq!(output.status.code(), Some(2), "motor is there already");
    let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(read["files"][0]["file"], "double.il");
    assert!(path.join("out/double/double.c").is_file());
}

/// An endless source is rejected, not read until memory ends.
#[cfg(unix)]
#[test]
fn an_endless_source_is_refused() {
    let folder = folder(&[]);
    insta::assert_snapshot!("endless", shown(folder.path(), &["check", "/dev/zero"]));
    let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["check", "-"])
        .stdin(fs::File::open("/dev/zero").unwrap())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(2));
}

/// The message about an obstacle names it as the user did.
#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    let locked = path.join("ro");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(locked.join("probe"), "").is_ok() {
        println!("skipped: this user may write everywhere");
        return;
    }
    for args in [
        &["build", "motor.il", "--emit", "c", "-o", "ro/plc"][..],
        &["convert", "motor.il", "--to", "il", "-o", "ro/x.il"],
    ] {
        let messages = text(&rungc(path, args).stderr);
        assert!(messages.starts_with("rungc: ro/"), "{messages}");
        assert!(
            !messages.contains(".tmp") && !messages.contains(".rungc-"),
            "{messages}"
        );
    }
}
