//! The example project, and the commands of its tour.

use crate::common::{code, folder, rungc, text};
use std::fs;
use std::path::Path;

/// Names of the files in a folder.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

/// The commands that `rungc demo` prints.
fn tour(printed: &str) -> Vec<Vec<&str>> {
    let commands = printed
        .lines()
        .filter_map(|line| line.strip_prefix("  rungc "));
    commands
        .map(|command| command.split(' ').collect())
        .collect()
}

#[test]
fn each_command_of_the_tour_works_in_the_project() {
    let folder = folder(&[]);
    let made = rungc(folder.path(), &["demo", "gate"]);
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    let project = folder.path().join("gate");
    let files = names(&project);
    for file in &files {
        assert!(text(&made.stderr).contains(file.as_str()), "{file}");
    }
    let printed = text(&made.stdout);
    let tour = tour(&printed);
    assert!((5..=7).contains(&tour.len()), "{printed}");
    for args in tour {
        let mut args = args;
        if args[0] == "serve" {
            args.extend(["--for", "200ms"]);
        }
        let output = rungc(&project, &args);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{args:?}: {said}");
        assert!(!said.contains("warning["), "{args:?}: {said}");
        let shown = text(&output.stdout) + &said;
        let expected = match args[0] {
            "check" => "0 errors, 0 warnings",
            // The gate has opened and closed.
            "run" => "D0",
            "why" => "light barrier interrupted",
            "test" => "3 passed, 0 failed",
            "verify" => "proved      whenever M0",
            "build" => "Emitted plc",
            "serve" => "page at http://127.0.0.1:",
            _ => "",
        };
        assert!(shown.contains(expected), "{args:?}: {shown}");
    }
    assert!(project.join("plc/gate.c").is_file());
}

/// The requirements and tests notice a gate that closes on people.
#[test]
fn tests_and_requirements_of_the_project_notice_a_fault() {
    let folder = folder(&[]);
    let at = folder.path();
    assert_eq!(code(at, &["demo", "."]), 0);
    let program = fs::read_to_string(at.join("gate.il")).unwrap();
    let faulty = program.replace("ANI X000\nANI X001\nANI X002\n", "ANI X000\nANI X001\n");
    assert_ne!(program, faulty);
    fs::write(at.join("gate.il"), faulty).unwrap();
    assert_eq!(code(at, &["test"]), 1);
    let verified = rungc(at, &["verify", "--replay", "interp"]);
    assert_eq!(verified.status.code(), Some(1));
    let said = text(&verified.stdout) + &text(&verified.stderr);
    assert!(said.contains("violated"), "{said}");
}

#[test]
fn files_that_are_there_stay_and_nothing_is_written_beside_them() {
    for there in [
        "gate.il",
        "gate.machine.toml",
        "gate.plctest.toml",
        "rungc.toml",
    ] {
        let folder = folder(&[(there, b"mine")]);
        let output = rungc(folder.path(), &["demo", "."]);
        assert_eq!(output.status.code(), Some(2));
        let said = text(&output.stderr);
        assert!(
            said.contains(&format!("{there} already exists: edit or remove it")),
            "{said}"
        );
        assert_eq!(names(folder.path()), [there]);
        assert_eq!(fs::read(folder.path().join(there)).unwrap(), b"mine");
    }
}

/// A link whose end is missing is a file that is there, too.
#[cfg(unix)]
#[test]
fn links_that_lead_nowhere_stay() {
    let folder = folder(&[]);
    std::os::unix::fs::symlink("elsewhere", folder.path().join("rungc.toml")).unwrap();
    assert_eq!(code(folder.path(), &["demo", "."]), 2);
    assert_eq!(code(folder.path(), &["init"]), 2);
    assert_eq!(names(folder.path()), ["rungc.toml"]);
}
