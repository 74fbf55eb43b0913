//! Results of tests for tools, parts of a suite, and the output of an interrupted run.

use crate::common;
use crate::common::{MOTOR, code, folder, rungc, shown, text, with_slashes};
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
fn mistakes_in_test_files_for_tools() {
    let broken = "model = \"fx3u\"\ntopik = \"OUT\"\n";
    let folder = folder(&[
        ("a.plctest.toml", file(&[("one", 1)]).as_bytes()),
        ("b.plctest.toml", broken.as_bytes()),
    ]);
    for format in ["json", "junit", "sarif", "github"] {
        let output = rungc(folder.path(), &["test", ".", "--format", format]);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("topik"));
        insta::assert_snapshot!(
            format!("mistakes_{format}"),
            timeless(&text(&output.stdout))
        );
    }
}

#[test]
fn results_in_a_file() {
    let folder = suite();
    let path = folder.path();
    for format in ["json", "junit", "human"] {
        let printed = rungc(
            path,
            &["test", "b.plctest.toml", "--no-cache", "--format", format],
        )
        .stdout;
        let args = [
            "test",
            "b.plctest.toml",
            "--no-cache",
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
            for name in some {
                assert!(
                    seen.insert(name.clone()),
                    "{name} is in two parts of {parts}"
                );
            }
        }
        assert_eq!(seen.len(), all.len());
    }
    let (part, empty) = (1..=9)
        .map(|part| format!("{part}/9"))
        .map(|shard| (names(path, &["--shard", &shard]), shard))
        .find(|(names, _)| names.is_empty())
        .expect("nine parts of six cases");
    assert!(part.is_empty());
    assert_eq!(
        code(path, &["test", ".", "--shard", &empty]),
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

#[test]
fn cases_stay_in_their_part_when_others_are_added() {
    let cases = |numbers: std::ops::Range<u32>| {
        let names: Vec<String> = numbers.map(|n| format!("case {n}")).collect();
        file(
            &names
                .iter()
                .map(|name| (name.as_str(), 1))
                .collect::<Vec<_>>(),
        )
    };
    let folder = folder(&[("a.plctest.toml", cases(20..80).as_bytes())]);
    let path = folder.path();
    let parts = || [1, 2, 3, 4].map(|part| names(path, &["--shard", &format!("{part}/4")]));
    let before = parts();
    assert!(
        before.iter().all(|part| (5..30).contains(&part.len())),
        "{before:?}"
    );
    fs::write(path.join("a.plctest.toml"), cases(0..100)).unwrap();
    let after = parts();
    assert_eq!(after.iter().map(Vec::len).sum::<usize>(), 100);
    for (before, after) in before.iter().zip(&after) {
        assert!(before.iter().all(|name| after.contains(name)));
    }
}

#[cfg(unix)]
mod interrupted {
    use super::*;
    use crate::common::soon;
    use crate::common::write_executable;
    use std::process::{Child, Command, Output, Stdio};

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
                .args(["-TERM", &id])
                .status()
                .unwrap()
                .success()
        );
        child.wait_with_output().unwrap()
    }

    /// Waits until what the command prints contains a text.
    fn expect(out: &mut impl std::io::BufRead, text: &str) -> String {
        let mut all = String::new();
        while !all.contains(text) {
            let length = out.read_line(&mut all).unwrap();
            assert_ne!(length, 0, "no `{text}` in {all}");
        }
        all
    }

    #[test]
    fn saved_files_are_tested_again() {
        let test = "model = \"fx3u\"\ntopic = \"t\"\nprogram = \"lamp.il\"\n[[case]]\nname = \"a\"\n[[case.step]]\nset = { X000 = 1 }\nexpect = { Y000 = 1 }\n";
        let folder = folder(&[
            ("lamp.il", b"LD X000\nOUT Y000\nEND\n"),
            ("t.plctest.toml", test.as_bytes()),
        ]);
        let path = folder.path();
        let mut child = begin(
            Command::new(env!("CARGO_BIN_EXE_rungc"))
                .args(["test", ".", "--watch"])
                .current_dir(path),
        );
        let mut out = std::io::BufReader::new(child.stdout.take().unwrap());
        let mut err = std::io::BufReader::new(child.stderr.take().unwrap());
        expect(&mut out, "1 passed, 0 failed");
        fs::write(path.join("lamp.il"), "LDI X000\nOUT Y000\nEND\n").unwrap();
        expect(&mut out, "0 passed, 1 failed");
        // A mistake does not end it, and what it was read from is still watched.
        fs::write(path.join("t.plctest.toml"), test.replace("name", "nmae")).unwrap();
        expect(&mut err, "nmae");
        fs::write(path.join("lamp.il"), "LD X000\nOUT Y000\nOUT Y001\nEND\n").unwrap();
        fs::write(path.join("t.plctest.toml"), test).unwrap();
        expect(&mut out, "1 passed, 0 failed");
        fs::write(
            path.join("new.plctest.toml"),
            test.replace("\"a\"", "\"b\""),
        )
        .unwrap();
        expect(&mut out, "2 passed, 0 failed");
        let output = interrupt(child);
        assert_eq!(output.status.code(), Some(130));
    }

    #[test]
    fn tests_end_with_their_own_code() {
        let cases =
            file(&[("long", 1)]).replace("set = { X000", "run_ms = 100000000\nset = { X000");
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
        let slow = "#!/bin/sh\necho $$ > \"$BEGUN\"\nexec sleep 60\n";
        write_executable(&tools.join("make"), slow.as_bytes());
        let begun = path.join("begun");
        let temporary = path.join("temporary");
        fs::create_dir(&temporary).unwrap();
        let search = std::env::var("PATH").unwrap();
        let child = begin(
            Command::new(env!("CARGO_BIN_EXE_rungc"))
                .args(["build", "motor.il", "--emit", "bin", "-o", "out/motor"])
                .env("PATH", format!("{}:{search}", tools.display()))
                .env("BEGUN", &begun)
                .env("TMPDIR", &temporary)
                .current_dir(path),
        );
        let mut make = String::new();
        soon("make is called", || {
            make = fs::read_to_string(&begun).unwrap_or_default();
            make.ends_with('\n')
        });
        let output = interrupt(child);
        assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
        assert!(!path.join("out").exists());
        // The signal was for this process alone; what it has started ends with it.
        if cfg!(target_os = "linux") {
            assert!(!Path::new("/proc").join(make.trim()).exists(), "{make}");
            assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0);
        }
    }
}

/// A file whose cases fail in ways that only runs have.
const FAILING: &str = r#"model = "fx3u"
topic = "time: 50 %, more"
program = "LD X000\nOUT Y000\nEND\n"
never = [{ Y000 = 1, X001 = 1 }]
[[case]]
name = "both: 100 %, at once"
[[case.step]]
set = { X000 = 1, X001 = 1 }
[[case]]
name = "waits"
[[case.step]]
until = { Y000 = 1 }
at_most_ms = 50
[[case]]
name = "course"
trace = ["Y000"]
[[case.step]]
set = { X000 = 1 }
[[case]]
name = "passes"
[[case.step]]
expect = { Y000 = 0 }
"#;

#[test]
fn failures_are_marked_at_their_places() {
    let folder = folder(&[("a b,c.plctest.toml", FAILING.as_bytes())]);
    for format in ["sarif", "github", "junit"] {
        let output = rungc(folder.path(), &["test", ".", "--format", format]);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
        let printed = timeless(&text(&output.stdout));
        let printed = printed.split(" failed (").next().unwrap();
        insta::assert_snapshot!(format!("results_marked_{format}"), printed);
    }
}

#[test]
fn traces_are_reviewed() {
    let folder = folder(&[("t.plctest.toml", FAILING.as_bytes())]);
    let path = folder.path();
    let only = |options: &[&str]| {
        shown(
            path,
            &[&["test", ".", "--filter", "course"], options].concat(),
        )
    };
    let mut story = vec![only(&[])];
    let pending = path.join("traces/t.course.trace.new");
    assert!(pending.is_file());
    story.push(only(&["--reject"]));
    assert!(!pending.exists());
    story.push(only(&["--accept"]));
    story.push(only(&[]));
    let accepted = path.join("traces/t.course.trace");
    let right = fs::read_to_string(&accepted).unwrap();
    fs::write(&accepted, right.replace("Y000 1", "Y000 0")).unwrap();
    story.push(only(&[]));
    assert!(pending.is_file());
    story.push(answered(path, "what\nl\n"));
    story.push(answered(path, ""));
    assert!(pending.is_file());
    story.push(answered(path, "a\n"));
    assert!(!pending.exists());
    assert_eq!(fs::read_to_string(&accepted).unwrap(), right);
    insta::assert_snapshot!("results_review", with_slashes(&story.join("\n\n")));
}

/// Output of a review with these answers.
fn answered(folder: &Path, answers: &str) -> String {
    use std::io::Write;
    use std::process::{Command, Stdio};
    let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["test", ".", "--filter", "course", "--review"])
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(answers.as_bytes()).unwrap();
    drop(input);
    let output = child.wait_with_output().unwrap();
    let printed = common::normal(&text(&output.stdout), folder);
    format!("{printed}\n--- exit code {}", output.status.code().unwrap())
}

#[test]
fn only_what_passed_with_the_same_files_is_known() {
    let machine = "[[delay]]\noutput = \"Y001\"\ninput = \"X005\"\non_ms = 10\n";
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("m.toml", machine.as_bytes()),
        (
            "t.plctest.toml",
            b"model = \"fx3u\"\ntopic = \"t\"\nprogram = \"motor.il\"\nmachine = \"m.toml\"\n\
            [[case]]\nname = \"runs\"\n[[case.step]]\nset = { X000 = 1 }\nexpect = { M0 = 1 }\n\
            [[case]]\nname = \"fails\"\n[[case.step]]\nexpect = { M0 = 1 }\n",
        ),
    ]);
    let path = folder.path();
    let known = |options: &[&str]| {
        let output = rungc(
            path,
            &[&["test", ".", "--format", "json"], options].concat(),
        );
        let read: serde_json::Value = serde_json::from_slice(&output.stdout)
            .unwrap_or_else(|_| panic!("{}", text(&output.stderr)));
        let cases = read["cases"].as_array().unwrap();
        let known = cases.iter().map(|case| case["cached"] == true);
        known.collect::<Vec<bool>>()
    };
    assert_eq!(known(&[]), [false, false]);
    assert_eq!(known(&[]), [true, false], "what failed runs again");
    assert_eq!(known(&["--no-cache"]), [false, false]);
    for (file, change) in [
        ("motor.il", "; more\n"),
        ("m.toml", "# more\n"),
        ("t.plctest.toml", "# more\n"),
    ] {
        let before = fs::read_to_string(path.join(file)).unwrap();
        fs::write(path.join(file), format!("{before}{change}")).unwrap();
        assert_eq!(known(&[]), [false, false], "{file} has changed");
        assert_eq!(known(&[]), [true, false]);
    }
}

/// Whoever reads may stop reading: `rungc explain ADD | head -1`. The exit code is the one without that.
#[test]
fn closed_output_is_no_error() {
    use std::io::Read;
    use std::process::{Command, Stdio};
    let bad = "LD X000\nOUT Y000\nLD X009\nMOVE D0 D1\nADD D0 K1\nOUT Y000\nEND\n";
    let failing = "model = \"h2u\"\ntopic = \"t\"\n[[case]]\nname = \"a\"\nprogram = \"END\"\n\
                   [[case.step]]\nexpect = { D0 = 1 }\n";
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("bad.il", bad.as_bytes()),
        ("fails.plctest.toml", failing.as_bytes()),
        ("divides.il", b"LD M8000\nDIV D0 K0 D2\nOUT M0\nEND\n"),
    ]);
    for (args, expected) in [
        (&["explain", "ADD"][..], 0),
        (&["completions", "bash"], 0),
        (&["build", "motor.il", "--emit", "ir"], 0),
        (&["check", "motor.il", "--format", "json"], 0),
        (&["convert", "motor.il", "--to", "il"], 0),
        (&["run", "motor.il", "--for", "20s", "--watch", "M8011"], 0),
        (&["check", "bad.il", "--format", "json"], 1),
        (&["check", "bad.il", "motor.il", "--format", "sarif"], 1),
        (&["stats", "bad.il", "motor.il"], 1),
        (&["test", "fails.plctest.toml"], 1),
        (&["test", "fails.plctest.toml", "--coverage", "text"], 1),
        (&["diff", "motor.il", "divides.il"], 1),
        (&["verify", "motor.il", "--never", "Y000"], 1),
        (&["explore", "motor.il", "--never", "Y000"], 1),
        (
            &["run", "divides.il", "--deny-errors", "--watch", "M8011"],
            1,
        ),
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(args)
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let mut messages = String::new();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut messages)
            .unwrap();
        assert_eq!(
            child.wait().unwrap().code(),
            Some(expected),
            "{args:?}: {messages}"
        );
        assert!(
            !messages.contains("panicked") && !messages.contains("pipe"),
            "{args:?}: {messages}"
        );
    }
}

/// The exit codes of `--help`: where 1 says something else, an error in the program is 2.
#[test]
fn errors_in_a_program_have_their_exit_codes() {
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("bad.il", b"LD X000\nFROB Y000 Q\nEND\n"),
    ]);
    for (args, expected) in [
        (&["check", "bad.il"][..], 1),
        (&["build", "bad.il", "--emit", "ir"], 1),
        (&["run", "bad.il"], 1),
        (&["stats", "bad.il"], 1),
        (&["verify", "bad.il", "--never", "Y000"], 2),
        (&["verify", "motor.il", "--same-as", "bad.il"], 2),
        (&["explore", "bad.il"], 2),
        (&["diff", "motor.il", "bad.il"], 2),
    ] {
        assert_eq!(code(folder.path(), args), expected, "{args:?}");
    }
}

/// A program that does not compile is one mistake, at its place in the program, whatever the number of its cases.
#[test]
fn programs_that_do_not_compile_are_reported_once() {
    let cases = "topic = \"t\"\n[[case]]\nname = \"a\"\n[[case.step]]\nscans = 1\n\
                 [[case]]\nname = \"b\"\n[[case.step]]\nscans = 1\n";
    let folder = folder(&[
        (
            "rungc.toml",
            b"[project]\nprogram = \"bad.il\"\nmodel = \"fx1s\"\n",
        ),
        ("bad.il", b"LD X000\nMOV D0 R5\nOUTT Y000\nEND\n"),
        ("t.plctest.toml", cases.as_bytes()),
    ]);
    let results = |format: &str| {
        let output = rungc(
            folder.path(),
            &["test", "t.plctest.toml", "--format", format],
        );
        assert_eq!(output.status.code(), Some(1));
        timeless(&text(&output.stdout))
    };
    let human = results("human");
    let human: Vec<_> = human
        .lines()
        .filter(|line| !line.contains(" passed, "))
        .collect();
    insta::assert_snapshot!("uncompiled_human", human.join("\n"));
    let github = results("github");
    let github: Vec<_> = github
        .lines()
        .filter(|line| line.starts_with("::"))
        .collect();
    insta::assert_snapshot!("uncompiled_github", github.join("\n"));
    assert!(results("json").contains("\"program\": \"bad.il\""));
    assert!(results("sarif").contains("\"uri\": \"bad.il\""));
}
