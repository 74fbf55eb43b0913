//! What the documents show is what the command line does.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The fenced blocks of a page in this language that begin like this, without their fences.
fn blocks(page: &str, language: &str, start: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut open: Option<(bool, String)> = None;
    for line in page.lines() {
        match (open.as_mut(), line.strip_prefix("```")) {
            (None, Some(fence)) => open = Some((fence == language, String::new())),
            (Some((_, text)), None) => *text += &format!("{line}\n"),
            (Some(_), Some(_)) => found.extend(open.take()),
            (None, None) => {}
        }
    }
    let wanted = |(fits, text): (bool, String)| (fits && text.starts_with(start)).then_some(text);
    found.into_iter().filter_map(wanted).collect()
}

/// Lines without the times that differ from run to run.
fn lines(text: &str) -> Vec<String> {
    let timeless = |line: &str| match line.split_once(") in ") {
        Some((before, rest)) => {
            let counts = rest.trim_start_matches(|c: char| c.is_ascii_digit());
            format!("{before}) in{counts}")
        }
        None => line.to_owned(),
    };
    let filled = text.lines().filter(|line| !line.trim().is_empty());
    filled.map(timeless).collect()
}

fn rungc(folder: &Path, args: &[&str]) -> (String, bool) {
    let output = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (text.concat(), output.status.success())
}

#[test]
fn readme_shows_what_happens() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let example = fs::read_to_string(root().join("examples/programs/motor.il")).unwrap();
    assert_eq!(blocks(&readme, "", "; A motor")[0].trim(), example.trim());
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("examples/programs")).unwrap();
    fs::write(folder.path().join("examples/programs/motor.il"), &example).unwrap();
    let console = blocks(&readme, "", "$ rungc");
    for part in console[0].split("$ rungc ").skip(1) {
        let (command, expected) = part.split_once('\n').unwrap();
        let args: Vec<_> = command.split_whitespace().collect();
        let (printed, succeeded) = rungc(folder.path(), &args);
        assert!(succeeded, "{command}");
        assert_eq!(lines(&printed), lines(expected), "{command}");
    }
    let emitted = fs::read_to_string(folder.path().join("firmware/plc/motor.c")).unwrap();
    let heart = blocks(&readme, "c", "    /* step 0");
    assert!(emitted.contains(&heart[0]), "motor.c is now:\n{emitted}");
}

#[test]
fn the_example_of_machines_runs() {
    let page = fs::read_to_string(root().join("docs/src/machines.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let program = &blocks(&page, "", "LD M8002")[0];
    let test = &blocks(&page, "toml", "model")[0];
    write("feeder.il", program);
    write("feeder.machine.toml", &blocks(&page, "toml", "[[axis]]")[0]);
    write("feeder.plctest.toml", test);
    let bare = |line: &str| line.split(';').next().unwrap().trim_end().to_owned();
    let bare: Vec<_> = program.lines().map(bare).collect();
    assert!(
        test.contains(&bare.join("\n")),
        "the test has another program"
    );
    let (printed, succeeded) = rungc(folder.path(), &["test", "feeder.plctest.toml"]);
    assert!(succeeded, "{printed}");
    let command = blocks(&page, "", "$ rungc run feeder").concat();
    let args = command.trim().strip_prefix("$ rungc ").unwrap();
    let (printed, succeeded) = rungc(folder.path(), &args.split(' ').collect::<Vec<_>>());
    assert!(succeeded, "{printed}");
    let counted = printed.lines().any(|line| line.ends_with("·    █      1"));
    assert!(counted, "{printed}");
}

#[test]
fn the_diagram_is_what_the_command_draws() {
    let page = fs::read_to_string(root().join("docs/src/machines.md")).unwrap();
    let examples = root().join("examples/programs");
    let machine = fs::read_to_string(examples.join("drill.machine.toml")).unwrap();
    assert_eq!(
        blocks(&page, "toml", "# The machine of drill.il")[0],
        machine
    );
    let folder = tempfile::tempdir().unwrap();
    let copies = folder.path().join("examples/programs");
    fs::create_dir_all(&copies).unwrap();
    for name in ["drill.il", "drill.machine.toml"] {
        fs::copy(examples.join(name), copies.join(name)).unwrap();
    }
    let command = blocks(&page, "", "$ rungc run examples/").concat();
    let args = command.trim().strip_prefix("$ rungc ").unwrap();
    let (printed, succeeded) = rungc(folder.path(), &args.split(' ').collect::<Vec<_>>());
    assert!(succeeded, "{printed}");
    let drawn = fs::read_to_string(folder.path().join("drill.svg")).unwrap();
    let kept = root().join("docs/src/drill.svg");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&kept, &drawn).unwrap();
    }
    let same = fs::read_to_string(&kept).is_ok_and(|kept| kept == drawn);
    assert!(
        same,
        "docs/src/drill.svg is not what the command draws: remake it with UPDATE_DOCS=1"
    );
}

#[test]
fn the_example_of_test_files_passes() {
    let page = fs::read_to_string(root().join("docs/src/test-files.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("lamp.plctest.toml");
    fs::write(&file, &blocks(&page, "toml", "model")[0]).unwrap();
    let (printed, succeeded) = rungc(folder.path(), &["test", "lamp.plctest.toml"]);
    assert!(succeeded, "{printed}");
    assert!(printed.contains("3 passed, 0 failed"), "{printed}");
}
