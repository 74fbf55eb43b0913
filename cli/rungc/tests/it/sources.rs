//! `rungc convert --to st`, `labels` and `labels-csv`: the sources of a GX Works2 project.

use crate::common::{folder, rungc, text};
use std::fs;
use std::path::Path;

/// A project with a source in each language.
fn project(name: &str) -> Vec<u8> {
    let corpus = Path::new(env!("RUNGC_ROOT")).join("golden/fuzz/corpus/gx-works2");
    fs::read(corpus.join(name)).unwrap()
}

fn files(folder: &Path) -> Vec<String> {
    let files = walkdir::WalkDir::new(folder)
        .sort_by_file_name()
        .into_iter()
        .flatten();
    let files = files.filter(|entry| entry.file_type().is_file());
    let path = |entry: walkdir::DirEntry| {
        entry
            .path()
            .strip_prefix(folder)
            .unwrap()
            .display()
            .to_string()
    };
    files.map(|entry| path(entry).replace('\\', "/")).collect()
}

#[test]
fn sources_become_a_folder() {
    let folder = folder(&[("press.gxw", &project("sources.gxw"))]);
    let path = folder.path();
    let output = rungc(path, &["convert", "press.gxw", "--to", "st", "-o", "out"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let made = files(&path.join("out"));
    let expected = [
        "Counter.txt",
        "Main.st",
        "Twice.txt",
        "labels/Global1.st",
        "libraries/Maths/Half.st",
        "libraries/Maths/structures/Point.st",
        "structures/Axis.st",
        "tasks.txt",
    ];
    assert_eq!(made, expected);
    let main = fs::read_to_string(path.join("out/Main.st")).unwrap();
    assert!(
        main.starts_with("PROGRAM Main\nVAR\n") && main.contains("IF Start THEN\n"),
        "{main}"
    );
    // What is there is not overwritten.
    fs::write(path.join("out/Main.st"), "mine").unwrap();
    let again = rungc(path, &["convert", "press.gxw", "--to", "st", "-o", "out"]);
    assert!(!again.status.success());
    assert_eq!(
        fs::read_to_string(path.join("out/Main.st")).unwrap(),
        "mine"
    );
    let forced = rungc(
        path,
        &["convert", "press.gxw", "--to", "st", "-o", "out", "--force"],
    );
    assert!(forced.status.success());
    assert_eq!(fs::read_to_string(path.join("out/Main.st")).unwrap(), main);
    let tables = rungc(
        path,
        &["convert", "press.gxw", "--to", "labels-csv", "-o", "csv"],
    );
    assert!(tables.status.success());
    assert!(
        fs::read(path.join("csv/labels/Global1.csv"))
            .unwrap()
            .starts_with(&[0xFF, 0xFE])
    );
    let labels = rungc(path, &["convert", "press.gxw", "--to", "labels"]);
    assert!(text(&labels.stdout).contains("    Step : INT; (* D999, chosen by the compiler *)\n"));
}

#[test]
fn programs_without_sources_are_refused() {
    let ladder = project("ladder.gxw");
    let folder = folder(&[("list.il", b"LD X000\nEND\n"), ("ladder.gxw", &ladder)]);
    for (input, why) in [
        ("list.il", "only projects of GX Works2 hold labels"),
        ("ladder.gxw", "holds a ladder of devices alone"),
    ] {
        for to in ["st", "labels", "labels-csv"] {
            let output = rungc(folder.path(), &["convert", input, "--to", to, "-o", "out"]);
            assert!(!output.status.success(), "{input} {to}");
            assert!(
                text(&output.stderr).contains(why),
                "{input} {to}: {}",
                text(&output.stderr)
            );
            assert!(!folder.path().join("out").exists());
        }
    }
}

/// Where files are to be, there are folders, and the reverse: nothing is written.
#[test]
fn no_half_result_is_left() {
    let folder = folder(&[("press.gxw", &project("sources.gxw")), ("c", b"mine")]);
    let path = folder.path();
    fs::create_dir_all(path.join("a/Main.st")).unwrap();
    fs::create_dir(path.join("b")).unwrap();
    fs::write(path.join("b/labels"), "mine").unwrap();
    for (out, why) in [
        ("a", "Main.st is a folder"),
        ("b", "labels is not a folder"),
        ("c", "c is not a folder"),
        ("c/d", "c is not a folder"),
    ] {
        let before = files(path);
        let convert = ["convert", "press.gxw", "--to", "st", "--force", "-o", out];
        let output = rungc(path, &convert);
        let messages = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{out}: {messages}");
        assert!(messages.contains(why), "{out}: {messages}");
        assert_eq!(files(path), before);
    }
    let demo = text(&rungc(path, &["demo", "c"]).stderr);
    assert!(demo.contains("c is not a folder"), "{demo}");
    let compiled = rungc(
        path,
        &[
            "convert",
            "press.gxw",
            "--to",
            "st",
            "--compiled",
            "-o",
            "out",
        ],
    );
    assert!(text(&compiled.stderr).contains("`--compiled` reads the compiled program"));
}

#[test]
fn a_folder_must_be_named() {
    let folder = folder(&[("press.gxw", &project("sources.gxw"))]);
    let output = rungc(folder.path(), &["convert", "press.gxw", "--to", "st"]);
    assert!(!output.status.success());
    assert!(
        text(&output.stderr).contains("name one with `-o`"),
        "{}",
        text(&output.stderr)
    );
}

/// A label is a name on the command line, and a note says what the project holds.
#[test]
fn labels_name_devices_on_the_command_line() {
    let folder = folder(&[("press.gxw", &project("sources.gxw"))]);
    let arguments = [
        "run",
        "press.gxw",
        "--set",
        "Start=1",
        "--for",
        "1s",
        "--watch",
        "Y001",
    ];
    let output = rungc(folder.path(), &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(
        text(&output.stdout).contains("Y001"),
        "{}",
        text(&output.stdout)
    );
    let check = rungc(folder.path(), &["check", "press.gxw"]);
    assert!(
        text(&check.stderr).contains("the project holds 1 program"),
        "{}",
        text(&check.stderr)
    );
}
