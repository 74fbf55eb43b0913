//! Results of tests for tools, parts of a suite, and the output of an interrupted run.

mod common;

use common::{MOTOR, code, folder, rungc, shown, text};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A file with cases of these names, which set X000 and expect Y000.
fn file(cases: &[(&str, u8)]) -> String {
    let mut text = "model = \"fx3u\"\ntopic = \"OUT\"\nprogram = \"LD X000\\nOUT Y000\\nEND\\n\"\n"
        .to_string();
    for (name, expected) in cases {
        text.push_str(&format!(
            "\n[[case]]\nname = {name:?}\nnote = \"a lamp\"\n[[case.step]]\nset = {{ X000 = 1 }}\nexpect = {{ Y000 = {expected} }}\n"
        ));
    }
    text
}

fn suite() -> TempDir {
    let broken = "model = \"fx3u\"\ntopic = \"OUT\"\n[[case]]\nname = \"broken\"\nprogram = \"LDD X0\"\n[[case.step]]\nscans = 1\n";
    let folder = folder(&[
        (
            "a.plctest.toml",
            file(&[("one", 1), ("<two>", 0), ("three", 1)]).as_bytes(),
        ),
        (
            "b.plctest.toml",
            file(&[("four", 1), ("five", 1)]).as_bytes(),
        ),
        ("c.plctest.toml", broken.as_bytes()),
    ]);
    fs::create_dir(folder.path().join("target")).unwrap();
    fs::write(folder.path().join("target/z.plctest.toml"), "no test").unwrap();
    folder
}

/// Times differ.
fn timeless(text: &str) -> String {
    let is_time = |c: char| c.is_ascii_digit() || c == '.' || c == 'e' || c == '-';
    let mut same = String::new();
    for line in text.lines() {
        let mut line = line.to_string();
        for mark in [" time=\"", "\"seconds\": "] {
            if let Some((before, rest)) = line.clone().split_once(mark) {
                line = format!("{before}{mark}…{}", rest.trim_start_matches(is_time));
            }
        }
        same.push_str(&line);
        same.push('\n');
    }
    same
}

#[test]
fn results_for_tools() {
    let folder = suite();
    for format in ["json", "junit"] {
        let output = rungc(folder.path(), &["test", ".", "--format", format]);
        assert_eq!(output.status.code(), Some(1));
        insta::assert_snapshot!(format!("results_{format}"), timeless(&text(&output.stdout)));
    }
    let output = rungc(folder.path(), &["test", ".", "-q"]);
    assert!(output.stderr.is_empty());
}

#[test]
fn results_in_a_file() {
    let folder = suite();
    let path = folder.path();
    for format in ["json", "junit", "human"] {
        let printed = rungc(path, &["test", "b.plctest.toml", "--format", format]).stdout;
        let args = [
            "test",
            "b.plctest.toml",
            "--format",
            format,
            "-o",
            "new/results",
        ];
        for _ in 0..2 {
            let output = rungc(path, &args);
            assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
            assert!(output.stdout.is_empty());
        }
        let written = fs::read_to_string(path.join("new/results")).unwrap();
        let plain = |text: &str| timeless(text).split("failed (").next().unwrap().to_string();
        assert_eq!(plain(&written), plain(&text(&printed)));
    }
}

/// The names of the cases that run with these options.
fn names(folder: &Path, options: &[&str]) -> Vec<String> {
    let output = rungc(
        folder,
        &[&["test", ".", "--format", "json"], options].concat(),
    );
    let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let cases = read["cases"].as_array().unwrap();
    cases
        .iter()
        .map(|case| case["name"].as_str().unwrap().to_string())
        .collect()
}

#[test]
fn parts_make_the_whole() {
    let folder = suite();
    let path = folder.path();
    let all = names(path, &[]);
    assert_eq!(all.len(), 6);
    for parts in [1, 2, 4, 9] {
        let mut seen = BTreeSet::new();
        for part in 1..=parts {
            let shard = format!("{part}/{parts}");
            let some = names(path, &["--shard", &shard]);
            assert_eq!(
                some,
                names(path, &["--shard", &shard]),
                "the same each time"
            );
            assert!(some.len() <= all.len().div_ceil(parts), "{shard}");
            for name in some {
                assert!(
                    seen.insert(name.clone()),
                    "{name} is in two parts of {parts}"
                );
            }
        }
        assert_eq!(seen.len(), all.len());
    }
    assert_eq!(
        code(path, &["test", "b.plctest.toml", "--shard", "3/3"]),
        0,
        "nothing to do"
    );
    for wrong in ["0/3", "4/3", "1", "a/b", "1/0"] {
        assert_eq!(code(path, &["test", ".", "--shard", wrong]), 2, "{wrong}");
    }
    assert_eq!(
        names(path, &["--filter", "b.plctest.toml::"]),
        ["four", "five"]
    );
    assert_eq!(names(path, &["--only", "one"]), ["one"], "its former name");
    insta::assert_snapshot!(
        "results_no_case",
        shown(path, &["test", ".", "--filter", "nobody"])
    );
}

#[cfg(unix)]
mod interrupted {
    use super::*;
    use std::os::unix::fs::PermissionsExt;
    use std::process::{Child, Command, Output, Stdio};
    use std::time::{Duration, Instant};

    fn begin(command: &mut Command) -> Child {
        command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    }

    fn interrupt(child: Child) -> Output {
        let id = child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-INT", &id])
                .status()
                .unwrap()
                .success()
        );
        child.wait_with_output().unwrap()
    }

    #[test]
    fn tests_end_with_their_own_code() {
        let cases =
            file(&[("long", 1)]).replace("set = { X000", "run_ms = 4294967295\nset = { X000");
        let folder = folder(&[("long.plctest.toml", cases.as_bytes())]);
        let mut child = begin(
            Command::new(env!("CARGO_BIN_EXE_rungc"))
                .args(["test", "long.plctest.toml"])
                .current_dir(folder.path()),
        );
        // The handler is there before the first line is written.
        use std::io::Read;
        child
            .stderr
            .as_mut()
            .unwrap()
            .read_exact(&mut [0; 10])
            .unwrap();
        let output = interrupt(child);
        assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    }

    #[test]
    fn builds_end_with_their_own_code_and_write_nothing() {
        let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
        let path = folder.path();
        let tools = path.join("tools");
        fs::create_dir(&tools).unwrap();
        let slow = "#!/bin/sh\ntouch \"$BEGUN\"\nexec sleep 5\n";
        fs::write(tools.join("make"), slow).unwrap();
        fs::set_permissions(tools.join("make"), fs::Permissions::from_mode(0o755)).unwrap();
        let begun = path.join("begun");
        let search = std::env::var("PATH").unwrap();
        let child = begin(
            Command::new(env!("CARGO_BIN_EXE_rungc"))
                .args(["build", "motor.il", "--emit", "bin", "-o", "out/motor"])
                .env("PATH", format!("{}:{search}", tools.display()))
                .env("BEGUN", &begun)
                .current_dir(path),
        );
        let patience = Instant::now();
        while !begun.exists() {
            assert!(
                patience.elapsed() < Duration::from_secs(60),
                "make is not called"
            );
            std::thread::sleep(Duration::from_millis(20));
        }
        let output = interrupt(child);
        assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
        assert!(!path.join("out").exists());
    }
}
