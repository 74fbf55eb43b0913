//! Exit codes of all commands, and what is said of options that do not go together: a table.

use crate::common::{folder, rungc, text};
use std::collections::BTreeSet;

/// The command lines: see the file.
const LINES: &str = include_str!("../usage.txt");

const FILES: [(&str, &[u8]); 14] = [
    ("m.il", b"LD X000\nOUT Y000\nEND\n"),
    ("two.il", b"LD X000\nOUT Y000\nLDI X000\nOUT Y001\nEND\n"),
    ("twice.il", b"LD X000\nOUT Y000\nLD X001\nOUT Y000\nEND\n"),
    ("bad.il", b"LD X000\nOUTT Y000\nEND\n"),
    ("ugly.il", b"  ld x0\nout   y0\nend\n"),
    ("divide.il", b"LD M8000\nDIV D0 D1 D2\nEND\n"),
    ("latched.il", b"LD X000\nINC D200\nLD X000\nOUT Y000\nEND\n"),
    ("fleet.toml", b"[plc.a]\nprogram = \"m.il\"\n"),
    ("broken.toml", b"[plc.a]\nprogam = \"m.il\"\n"),
    ("board.toml", b"nam = \"mine\"\n"),
    (
        "pass.plctest.toml",
        b"topic = \"t\"\nmodel = \"fx3u\"\nprogram = { file = \"m.il\" }\n[[case]]\nname = \"a\"\n\
          [[case.step]]\nset = { X000 = 1 }\nexpect = { Y000 = 1 }\n",
    ),
    (
        "fail.plctest.toml",
        b"topic = \"t\"\nmodel = \"fx3u\"\nprogram = { file = \"m.il\" }\n[[case]]\nname = \"a\"\n\
          [[case.step]]\nset = { X000 = 1 }\nexpect = { Y000 = 0 }\n",
    ),
    (
        "broken.plctest.toml",
        b"model = \"fx3u\"\nprogram = { file = \"m.il\" }\n[[case]]\nname = \"a\"\ntopic = \"t\"\n\
          [[case.step]]\nscans = 1\n",
    ),
    (
        "negative.plctest.toml",
        b"topic = \"t\"\nmodel = \"fx3u\"\nprogram = { file = \"m.il\" }\n[[case]]\nname = \"a\"\n\
          [[case.step]]\nrun_ms = -5\n",
    ),
];

/// A line of the table: exit code, arguments, part of standard error.
type Line = (i32, &'static str, &'static str);

fn lines() -> impl Iterator<Item = Line> {
    let lines = LINES
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| {
        let mut fields = line.splitn(3, " | ");
        let code = fields.next().unwrap().parse().unwrap();
        (
            code,
            fields.next().unwrap(),
            fields.next().unwrap_or_default(),
        )
    })
}

#[test]
fn exit_codes_and_messages_are_those_of_the_table() {
    let mut wrong = Vec::new();
    for (code, line, part) in lines() {
        let folder = folder(&FILES);
        let output = rungc(folder.path(), &line.split_whitespace().collect::<Vec<_>>());
        let errors = text(&output.stderr);
        if output.status.code() != Some(code) || !errors.contains(part) {
            wrong.push(format!(
                "{line}: {:?}, not {code} | {part}\n{errors}",
                output.status.code()
            ));
        }
        let has_dash = folder.path().join("-").exists();
        assert!(!has_dash, "{line}: wrote a file of the name `-`");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_table_has_every_command() {
    let folder = folder(&FILES);
    let help = text(&rungc(folder.path(), &["help"]).stdout);
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands = commands.take_while(|line| !line.is_empty());
    let names = commands.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let names: BTreeSet<&str> = names.filter(|name| !name.is_empty()).collect();
    assert!(names.len() > 20, "{names:?}");
    for name in names.into_iter().filter(|name| *name != "help") {
        let fails =
            lines().any(|(code, line, _)| code != 0 && line.split(' ').next() == Some(name));
        assert!(fails, "{name} has no line with an error");
    }
}

/// `--color`, not its absence, decides about errors of usage.
#[test]
fn errors_of_usage_have_colour_as_asked() {
    let folder = folder(&FILES);
    let has_colour = |args: &[&str]| rungc(folder.path(), args).stderr.contains(&0x1b);
    assert!(has_colour(&["--color", "always", "check", "--nothing"]));
    assert!(has_colour(&["check", "--color=always", "--nothing"]));
    assert!(!has_colour(&["check", "--color=never", "--nothing"]));
}

/// A full disk is said to be full, of help as of results.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_that_names_the_stream() {
    let folder = folder(&FILES);
    for args in [
        &["--help"] as &[&str],
        &["view", "m.il"],
        &["check", "--help"],
    ] {
        let full = std::fs::File::options()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_rungc"));
        let output = command
            .args(args)
            .current_dir(folder.path())
            .stdout(full)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(
            text(&output.stderr).contains("standard output: "),
            "{args:?}"
        );
    }
}

/// Options of other tools and commands have a tip.
#[test]
fn unknown_options_have_a_tip() {
    let folder = folder(&[]);
    for (args, tip) in [
        (["run", "--duration"], "this is '--for' here"),
        (["explore", "--duration"], "this is '--timeout' here"),
        (["check", "--cpu"], "this is '--model' here"),
        (
            ["test", "--duration"],
            "each step of a case says how long it runs",
        ),
    ] {
        let output = rungc(folder.path(), &[&args[..], &["5"]].concat());
        let said = text(&output.stderr);
        assert!(
            said.contains(tip) && said.matches("tip:").count() == 1,
            "{said}"
        );
        assert_eq!(output.status.code(), Some(2));
    }
}

/// Words of other tools have a command here, and misspelt commands the one that is nearest.
#[test]
fn unknown_commands_have_a_tip() {
    let folder = folder(&[]);
    for (word, command) in [
        ("compile", Some("build")),
        ("ladder", Some("view")),
        ("Prove", Some("verify")),
        ("upload", Some("read")),
        ("chek", Some("check")),
        ("xyzzy", None),
    ] {
        let output = rungc(folder.path(), &[word]);
        let said = text(&output.stderr);
        let tip = command.map(|command| format!("similar subcommand exists: '{command}'"));
        assert_eq!(said.contains("tip:"), tip.is_some(), "{said}");
        assert!(said.contains(&tip.unwrap_or_default()), "{said}");
        assert_eq!(output.status.code(), Some(2));
    }
}
