//! Input that no one means: names of files that would act on what reads emitted code or on a terminal, and programs
//! without instructions.

use crate::common::{folder, rungc, text};
use std::fs;

/// `#include <time.h>` finds the system's header where the emitted folder is on the include path.
#[test]
fn programs_never_shadow_headers_of_the_system() {
    let program = b"LD X000\nOUT Y000\nEND\n";
    for name in ["time", "string", "stdint", "rungc_rt", "rungc_board", "plc"] {
        let file = format!("{name}.il");
        let folder = folder(&[(&file, program)]);
        let output = rungc(folder.path(), &["build", &file, "--emit", "c", "-o", "out"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let out = folder.path().join("out");
        assert!(!out.join(format!("{name}.h")).exists(), "{name}");
        assert!(out.join(format!("plc_{name}.h")).is_file(), "{name}");
    }
}

/// Every command takes a program that has no instructions, or END alone, without a panic.
#[test]
fn programs_without_instructions_are_taken_or_rejected() {
    let programs: [(&str, &[u8]); 4] = [
        ("empty.il", b""),
        ("comment.il", b"; only a comment\n"),
        ("end.il", b"END\n"),
        ("nop.il", b"NOP\n"),
    ];
    let folder = folder(&programs);
    let conversions = [
        "il",
        "csv",
        "json",
        "gxw",
        "ladder",
        "autoshop",
        "plcopen",
        "plcopen-list",
        "wpg",
    ];
    for (name, _) in programs {
        let mut commands: Vec<Vec<&str>> =
            ["check", "view", "stats", "xref", "fmt", "learn", "read"]
                .iter()
                .map(|command| vec![*command, name])
                .collect();
        commands.extend(
            conversions
                .iter()
                .map(|to| vec!["convert", name, "--to", to]),
        );
        for body in ["ladder", "list", "sfc"] {
            commands.push(vec!["convert", name, "--to", "plcopen", "--body", body]);
        }
        commands.extend([
            vec!["view", name, "--sfc"],
            vec!["diff", name, "end.il", "--semantic"],
            vec!["diff", "end.il", name],
            vec!["run", name, "--for", "20ms"],
            vec!["verify", name, "--never", "Y000"],
            vec!["explore", name, "--never", "Y000"],
            vec!["build", name, "--emit", "ir"],
            vec!["check", name, "--deep"],
        ]);
        for command in commands {
            let output = rungc(folder.path(), &command);
            let errors = text(&output.stderr);
            assert!(!errors.contains("panicked"), "{command:?}: {errors}");
            assert_ne!(output.status.code(), Some(101), "{command:?}: {errors}");
            let is_silent = errors.is_empty() && output.stdout.is_empty();
            assert!(output.status.success() || !is_silent, "{command:?}");
        }
    }
}

/// A report in a file is shown by `cat`, and is the same as the printed one.
#[test]
fn reports_in_files_do_not_act_on_a_terminal() {
    let test = "model = \"fx3u\"\ntopic = \"t\"\nprogram = { file = \"a\u{202e}.il\" }\n\
        [[case]]\nname = \"one\"\n[[case.step]]\nscans = 1\n";
    let program = b"LD X000\nOUT Y000\nEND\n";
    let folder = folder(&[
        ("a\u{202e}.il", program),
        ("t.plctest.toml", test.as_bytes()),
    ]);
    for (command, file) in [
        (&["test", ".", "--coverage", "text"][..], "coverage.txt"),
        (&["test", ".", "--mutants"], "mutants.txt"),
        (&["test", ".", "--coverage", "lcov"], "lcov.info"),
        (&["xref", "a\u{202e}.il"], "xref.txt"),
    ] {
        let output = rungc(folder.path(), &[command, &["-o", file]].concat());
        let read = fs::read_to_string(folder.path().join(file));
        let read = read.unwrap_or_else(|_| panic!("{command:?}: {}", text(&output.stderr)));
        let acts = |c: char| c != '\n' && rungc_syntax::text::acts(c);
        assert!(
            !read.is_empty() && !read.contains(acts),
            "{command:?}: {read:?}"
        );
    }
}

/// What users pass comes back in messages; a terminal must not act on it.
#[test]
fn arguments_do_not_act_on_a_terminal() {
    let folder = folder(&[("a.il", b"LD X000\nOUT Y000\nEND\n")]);
    for hostile in ["\u{202e}lmth", "\u{9b}2J", "a\u{85}b", "\u{1b}[31m"] {
        let unknown = format!("--{hostile}");
        let scan = format!("10{hostile}");
        for command in [
            vec!["check", hostile],
            vec![hostile],
            vec!["check", "a.il", unknown.as_str()],
            vec!["check", "a.il", "--model", hostile],
            vec!["run", "a.il", "--scan", scan.as_str()],
            vec!["run", "a.il", "--set", hostile],
            vec!["check", "a.il", "--format", hostile],
        ] {
            let output = rungc(folder.path(), &command);
            assert!(!output.status.success(), "{command:?}");
            let shown = text(&output.stderr) + &text(&output.stdout);
            let acts = |c: char| c != '\n' && rungc_syntax::text::acts(c);
            assert!(!shown.contains(acts), "{command:?}: {shown:?}");
        }
    }
}
