//! Latched devices that survive: in `rungc run`, from run to run.

mod common;

use common::{folder, rungc, text};
use std::fs;
use std::path::Path;
use std::process::Output;

/// Counts its starts in D200 and its scans in C100, which are latched, and its scans in D0, which is not.
const COUNTER: &str = "\
LD M8002
INC D200
LD M8000
INC D0
LD M8012
OUT C100 K1000
LD C100
OUT Y0
LD X7
RST C100
END
";

fn run(folder: &Path, args: &[&str]) -> Output {
    let usual = ["run", "counter.il", "--for", "1s", "--watch", "D200,D0"];
    rungc(folder, &[&usual, args].concat())
}

/// The values in the last line of a run's table.
fn last(output: &Output) -> String {
    let out = text(&output.stdout);
    let rows = out.lines().filter(|line| line.contains(" s  "));
    let last = rows.last().unwrap_or(&out).to_string();
    let words: Vec<_> = last.split_whitespace().skip(2).collect();
    words.join(" ")
}

#[test]
fn latched_devices_survive_from_run_to_run() {
    let folder = folder(&[("counter.il", COUNTER.as_bytes())]);
    let at = folder.path();
    let first = run(at, &["--watch", "C100", "--retain", "counter.retain"]);
    let said = text(&first.stderr);
    assert!(said.contains("counter.retain does not exist yet"), "{said}");
    let second = run(at, &["--watch", "C100", "--retain", "counter.retain"]);
    assert_eq!(text(&second.stderr), "");
    assert_eq!(
        (last(&first), last(&second)),
        ("1 101 10".into(), "2 101 20".into())
    );
    fs::write(
        at.join("rungc.toml"),
        "[retain]\nfile = \"counter.retain\"\n",
    )
    .unwrap();
    assert_eq!(
        last(&run(at, &["--watch", "C100"])),
        "3 101 30",
        "the project names the file"
    );
}

#[test]
fn devices_of_another_program_are_not_loaded() {
    let folder = folder(&[
        ("counter.il", COUNTER.as_bytes()),
        ("pump.il", b"LD X0\nSET M500\nLD M500\nOUT Y0\nEND\n"),
        ("light.il", b"LD X0\nOUT Y0\nEND\n"),
    ]);
    let at = folder.path();
    assert!(run(at, &["--retain", "plc.retain"]).status.success());
    let before = fs::read(at.join("plc.retain")).unwrap();
    let other = rungc(at, &["run", "pump.il", "--retain", "plc.retain"]);
    insta::assert_snapshot!(
        text(&other.stderr),
        @"rungc: --retain plc.retain: holds the latched devices of `counter (fx3u)`, and this program is `pump (fx3u)`; name another file"
    );
    assert_eq!(other.status.code(), Some(2));
    assert_eq!(fs::read(at.join("plc.retain")).unwrap(), before);
    let without = rungc(at, &["run", "light.il", "--retain", "light.retain"]);
    insta::assert_snapshot!(
        text(&without.stderr),
        @"rungc: --retain light.retain: the program has no latched devices"
    );
    fs::write(at.join("plc.retain"), &before[..before.len() - 1]).unwrap();
    let damaged = run(at, &["--retain", "plc.retain"]);
    insta::assert_snapshot!(
        text(&damaged.stderr),
        @"rungc: --retain plc.retain: does not hold latched devices, or is damaged"
    );
    assert_eq!(damaged.status.code(), Some(2));
}

#[test]
fn a_changed_program_keeps_what_both_versions_have() {
    let folder = folder(&[("counter.il", COUNTER.as_bytes())]);
    let at = folder.path();
    assert!(run(at, &["--retain", "counter.retain"]).status.success());
    let changed = COUNTER
        .replace("OUT C100 K1000\nLD C100", "INC D300")
        .replace("RST C100", "RST D300");
    fs::write(at.join("counter.il"), changed).unwrap();
    let again = run(at, &["--watch", "D300", "--retain", "counter.retain"]);
    insta::assert_snapshot!(
        text(&again.stderr),
        @"rungc: counter.retain: 1 of its devices are dropped: the program does not use them as latched devices any more"
    );
    assert!(last(&again).starts_with("2 101"), "{}", last(&again));
}
