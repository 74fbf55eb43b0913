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
        "tasks.st",
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

/// Files of a program in structured text; the function has a mistake in its second line.
const LINE: [(&str, &str); 4] = [
    (
        "Global.st",
        "VAR_GLOBAL\n    Start AT X0 : BOOL;\n    Level AT D0 : INT;\nEND_VAR\n",
    ),
    (
        "Main.st",
        "PROGRAM Main\nY0 := Start;\nLevel := Twice(Level);\nEND_PROGRAM\n",
    ),
    (
        "Second.st",
        "PROGRAM Second\nY1 := Start AND NOT Y0;\nEND_PROGRAM\n",
    ),
    (
        "parts/Twice.st",
        "FUNCTION Twice : INT\nVAR_INPUT N : INT; END_VAR\nTwice := N + N;\nEND_FUNCTION\n",
    ),
];

/// Writes these files, and more.
fn write(folder: &Path, more: &[(&str, &str)]) {
    fs::create_dir_all(folder.join("parts")).unwrap();
    for (name, contents) in LINE.iter().chain(more) {
        fs::write(folder.join(name), contents).unwrap();
    }
}

#[test]
fn a_folder_of_structured_text_is_a_program() {
    let folder = folder(&[]);
    let path = folder.path();
    write(path, &[]);
    let list = rungc(path, &["convert", ".", "--to", "il"]);
    let list = text(&list.stdout);
    let order = ["; Y0 := ", "; Y1 := "].map(|statement| list.find(statement));
    assert!(order[0].is_some() && order[0] < order[1], "{list}");
    let checked = rungc(path, &["check", "."]);
    assert!(checked.status.success(), "{}", text(&checked.stderr));
    // The settings name another order; each file stands for all.
    let settings =
        "[project]\nprogram = [\"Second.st\", \"Main.st\", \"Global.st\", \"parts/Twice.st\"]\n";
    write(path, &[("rungc.toml", settings)]);
    for arguments in [
        &["convert", "--to", "il"][..],
        &["convert", ".", "--to", "il"],
        &["convert", "parts/Twice.st", "--to", "il"],
    ] {
        let list = rungc(path, arguments);
        let list = text(&list.stdout);
        let order = ["; Y1 := ", "; Y0 := "].map(|statement| list.find(statement));
        assert!(
            order[0].is_some() && order[0] < order[1],
            "{arguments:?}: {list}"
        );
    }
    let checked = rungc(path, &["check", "."]);
    assert!(checked.status.success(), "{}", text(&checked.stderr));
}

#[test]
fn mistakes_are_shown_in_the_files_of_a_program() {
    let folder = folder(&[]);
    let path = folder.path();
    let again = "(* again *)\nFUNCTION Twice : INT\nTwice := 1;\nEND_FUNCTION\n";
    write(path, &[("parts/Zwo.st", again)]);
    let checked = rungc(path, &["check", "."]);
    let name = path.file_name().expect("a name").to_string_lossy();
    let shown = text(&checked.stderr).replace(&*name, "fill");
    insta::assert_snapshot!(shown.replace('\\', "/"));
    let github = rungc(path, &["check", ".", "--format", "github"]);
    let github = text(&github.stdout);
    assert!(
        github.starts_with("::error file=parts/Zwo.st,line=2,endLine=2,"),
        "{github}"
    );
    let json = rungc(path, &["check", ".", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let found = &json["diagnostics"][0];
    assert_eq!(found["line"], 2);
    assert_eq!(found["related"][0]["line"], 1);
    for (place, file) in [(found, "Zwo.st"), (&found["related"][0], "Twice.st")] {
        assert!(place["file"].as_str().unwrap().ends_with(file), "{json}");
    }
    let sarif = rungc(path, &["check", ".", "--format", "sarif"]);
    assert!(text(&sarif.stdout).contains("\"uri\": \"parts/Zwo.st\""));
}

#[test]
fn a_written_project_is_checked() {
    let folder = folder(&[("press.gxw", &project("sources.gxw"))]);
    let path = folder.path();
    rungc(path, &["convert", "press.gxw", "--to", "st", "-o", "out"]);
    // One of its blocks is a ladder.
    let checked = rungc(path, &["check", "out"]);
    let found = text(&checked.stderr);
    assert!(found.contains("out/Main.st:8:3"), "{found}");
    let main = fs::read_to_string(path.join("out/Main.st")).unwrap();
    fs::write(
        path.join("out/Main.st"),
        main.replace("Count1(In := Axis1.Ready);", ""),
    )
    .unwrap();
    let checked = rungc(path, &["check", "out"]);
    assert!(checked.status.success(), "{}", text(&checked.stderr));
}

/// Files of a folder without settings: `Main.st` needs all but `Other.st` and `Old.st`.
const FOLDER: [(&str, &str); 6] = [
    (
        "Main.st",
        "PROGRAM Main\nVAR Press : Valve; END_VAR\nPress(Open := Start, Coil => Y0);\nD1 := Twice(D0);\nEND_PROGRAM\n",
    ),
    (
        "Valve.st",
        "FUNCTION_BLOCK Valve\nVAR_INPUT Open : BOOL; END_VAR\nVAR_OUTPUT Coil : BOOL; END_VAR\n\
         Coil := Open;\nEND_FUNCTION_BLOCK\n",
    ),
    (
        "Twice.st",
        "FUNCTION Twice : INT\nVAR_INPUT N : INT; END_VAR\nTwice := N * Factor;\nEND_FUNCTION\n",
    ),
    (
        "labels/Global.st",
        "VAR_GLOBAL Start AT X0 : BOOL; END_VAR\nVAR_GLOBAL CONSTANT Factor : INT := 2; END_VAR\n",
    ),
    (
        "Other.st",
        "PROGRAM Other\nY7 := X7;\nEND_PROGRAM\nFUNCTION Spare : INT\nSpare := 1;\nEND_FUNCTION\n",
    ),
    (
        "Old.st",
        "FUNCTION Gone : INT\nGone := Lost;\nEND_FUNCTION\n",
    ),
];

#[test]
fn a_file_is_compiled_with_those_that_define_what_it_uses() {
    let folder = folder(&[]);
    let path = folder.path();
    fs::create_dir(path.join("labels")).unwrap();
    for (name, contents) in FOLDER {
        fs::write(path.join(name), contents).unwrap();
    }
    let list = rungc(path, &["convert", "Main.st", "--to", "il"]);
    let list = text(&list.stdout);
    assert!(
        list.contains("LD X000\nOUT Y000\n") && list.contains("MUL D"),
        "{list}"
    );
    assert!(!list.contains("Y007"), "{list}");
    let checked = rungc(path, &["check", "Main.st"]);
    assert!(checked.status.success());
    let shown = text(&checked.stderr);
    let note = shown.split("    Checked").next().unwrap_or_default();
    insta::assert_snapshot!(note);
    // A file without a program is checked as a part of the one that needs it; a program by itself.
    let part = rungc(path, &["check", "Twice.st"]);
    let part = text(&part.stderr);
    assert!(part.contains("as a part of `Main.st`"), "{part}");
    let other = rungc(path, &["check", "Other.st", "--format", "json"]);
    let other = text(&other.stdout);
    assert!(
        !other.contains("N0240") && other.contains("\"errors\": 0"),
        "{other}"
    );
    let old = rungc(path, &["check", "Old.st"]);
    assert!(text(&old.stderr).contains("this text holds no PROGRAM"));
    // The tasks of a configuration belong to each of its programs.
    let tasks = "CONFIGURATION Line\nTASK T1(PRIORITY := 1);\nPROGRAM Main WITH T1;\nPROGRAM Other WITH T1 : Other;\n\
                 END_CONFIGURATION\n";
    fs::write(path.join("Tasks.st"), tasks).unwrap();
    for file in ["Main.st", "Other.st"] {
        let list = rungc(path, &["convert", file, "--to", "il"]);
        let list = text(&list.stdout);
        assert!(
            list.contains("Y000") && list.contains("Y007"),
            "{file}: {list}"
        );
    }
}

#[test]
fn what_no_file_defines_is_named() {
    let folder = folder(&[]);
    let path = folder.path();
    let main = "PROGRAM Main\nVAR a : Axis; END_VAR\nD1 := Twice(D0) + Spare();\nHoist_it(D0);\nEND_PROGRAM\n";
    fs::write(path.join("Main.st"), main).unwrap();
    fs::write(path.join("Other.st"), FOLDER[4].1).unwrap();
    let twice = "FUNCTION Twice : INT\nVAR_INPUT N : INT; END_VAR\nTwice := N + N;\nEND_FUNCTION\n";
    for name in ["A.st", "B.st"] {
        fs::write(path.join(name), twice).unwrap();
    }
    let checked = rungc(path, &["check", "Main.st"]);
    insta::assert_snapshot!(text(&checked.stderr));
}
