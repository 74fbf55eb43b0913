//! Commands on many inputs: the same bytes, whatever the number of threads.

use crate::common::{folder, normal, reverser, rungc, text};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Output, messages and exit code of a command with this number of threads.
fn with(threads: &str, folder: &Path, args: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(args)
        .env("RUNGC_THREADS", threads)
        .current_dir(folder)
        .output()
        .unwrap();
    let printed = [&output.stdout, &output.stderr].map(|bytes| normal(&text(bytes), folder));
    format!("{}\n{}\n{:?}", printed[0], printed[1], output.status.code())
}

/// Compares a command with 1, 2 and 7 threads; `timeless` leaves out times. Returns what it prints.
fn compare(folder: &Path, args: &[&str], timeless: impl Fn(&str) -> String) -> String {
    let one = timeless(&with("1", folder, args));
    for threads in ["2", "7"] {
        let more = timeless(&with(threads, folder, args));
        assert_eq!(one, more, "{args:?} with {threads} threads");
    }
    one
}

/// The text with a sign in place of each number with a decimal point, which times are.
fn without_times(text: &str) -> String {
    let is_time = |word: &str| word.contains('.') && word.parse::<f64>().is_ok();
    let words =
        text.split_inclusive(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | 'e' | '-')));
    let words = words.map(|word| {
        let number = word.trim_end_matches(|c: char| !(c.is_ascii_digit() || c == '.'));
        match is_time(number) {
            true => word.replacen(number, "…", 1),
            false => word.to_string(),
        }
    });
    words.collect()
}

/// A folder of programs, some with mistakes, the first of them the longest.
fn programs() -> TempDir {
    let folder = folder(&[]);
    for number in 0..24 {
        let mut list = String::new();
        for rung in 0..(24 - number) * 3 {
            let _ = writeln!(list, "LD X{:o}\nOUT M{rung}", rung % 64);
        }
        list += match number % 4 {
            0 => "LD X000\nOUT Y008\n",
            1 => "LD M7000\nOUT M0\n",
            2 => "NOVALID X000\n",
            _ => "",
        };
        fs::write(
            folder.path().join(format!("{number:02}.il")),
            list + "END\n",
        )
        .unwrap();
    }
    fs::write(folder.path().join("24.gxw"), "not a project").unwrap();
    folder
}

#[test]
fn checks_of_folders_are_the_same_with_more_threads() {
    let folder = programs();
    for format in ["human", "json", "sarif", "github"] {
        let args = ["check", ".", "--format", format];
        let shown = compare(folder.path(), &args, str::to_string);
        assert!(shown.contains("NOVALID"), "{shown}");
    }
    let shown = compare(folder.path(), &["check", ".", "--deep"], str::to_string);
    assert!(shown.contains("Checked"), "{shown}");
}

/// Test files with cases that pass, fail and are rejected, some of one program.
fn suites() -> TempDir {
    let folder = folder(&[("reverser.il", reverser("ANI Y000").as_bytes())]);
    for file in 0..6 {
        let mut text = format!("topic = \"file {file}\"\n");
        for case in 0..12 {
            let value = (case + file) % 5;
            let program = match case % 3 {
                0 => "program = \"\"\"\nLD X000\nMOV K3 D0\nEND\n\"\"\"".to_string(),
                1 => format!("program = \"\"\"\nLD X000\nMOV K{case} D0\nEND\n\"\"\""),
                _ => "program = \"reverser.il\"".to_string(),
            };
            let expected = match case % 3 {
                2 => "{ Y000 = 1 }".to_string(),
                _ => format!("{{ D0 = {value} }}"),
            };
            let _ = write!(
                text,
                "\n[[case]]\nname = \"c{case}\"\nmodel = \"fx3u\"\nsource = \"none\"\n{program}\n\
                 [[case.step]]\nset = {{ X000 = 1 }}\nexpect = {expected}\n"
            );
        }
        let path = folder.path().join(format!("{file}.plctest.toml"));
        fs::write(path, text).unwrap();
    }
    folder
}

#[test]
fn suites_are_the_same_with_more_threads() {
    let folder = suites();
    for format in ["human", "json", "junit"] {
        let args = ["test", ".", "--no-cache", "--format", format];
        let shown = compare(folder.path(), &args, without_times);
        assert!(shown.contains("c3"), "{shown}");
    }
    let args = ["test", ".", "--no-cache", "--engine", "c"];
    let shown = compare(folder.path(), &args, without_times);
    assert!(shown.contains("passed"), "{shown}");
}

#[test]
fn coverage_and_mutants_are_the_same_with_more_threads() {
    let folder = suites();
    // Only what passes judges mutants.
    let passing = "topic = \"t\"\n[[case]]\nname = \"a\"\nmodel = \"fx3u\"\nprogram = \"reverser.il\"\n\
        [[case.step]]\nset = { X000 = 1 }\nexpect = { Y000 = 1 }\n";
    fs::write(folder.path().join("passing.plctest.toml"), passing).unwrap();
    let options: [&[&str]; 2] = [&["--mutants"], &["--coverage", "text"]];
    for option in options {
        let args = [&["test", "passing.plctest.toml"][..], option].concat();
        let shown = compare(folder.path(), &args, without_times);
        assert!(shown.contains("line"), "{shown}");
    }
}

#[test]
fn proofs_and_searches_are_the_same_with_more_threads() {
    let folder = folder(&[("reverser.il", reverser("").as_bytes())]);
    let properties = ["Y000 & Y001", "Y000 & X002", "Y001 & X002", "Y000 & X001"];
    let properties = properties.iter().flat_map(|never| ["--never", *never]);
    let properties: Vec<&str> = properties.collect();
    let args = [&["verify", "reverser.il"], &properties[..]].concat();
    let shown = compare(folder.path(), &args, without_times);
    assert!(shown.contains("Y000 & Y001"), "{shown}");
    let searched = ["explore", "reverser.il", "--scans", "20000"];
    let args = [&searched, &properties[..]].concat();
    let shown = compare(folder.path(), &args, without_times);
    assert!(shown.contains("Y000 & Y001"), "{shown}");
    let option = ["--threads", "3"];
    let stated = [&args[..], &option].concat();
    let stated = without_times(&with("1", folder.path(), &stated));
    assert_eq!(stated, shown);
}

#[test]
fn a_number_of_threads_that_is_none_is_rejected() {
    let folder = folder(&[("a.il", b"LD X000\nOUT Y000\nEND\n")]);
    for wrong in ["0", "many", "257", "-1"] {
        let shown = with(wrong, folder.path(), &["check", "a.il"]);
        assert!(shown.contains("RUNGC_THREADS"), "{shown}");
        assert!(shown.ends_with("Some(2)"), "{shown}");
    }
    let unset = with("", folder.path(), &["check", "a.il"]);
    assert!(unset.ends_with("Some(0)"), "{unset}");
    assert!(rungc(folder.path(), &["check", "a.il"]).status.success());
}
