//! Commands on a program of 16,000 steps: in 240 MB, and in seconds even without optimisation. A release build takes a
//! tenth of that.

use crate::common::folder;
use std::fmt::Write as _;
use std::process::Command;

/// Processor time that a command may take, in seconds: several times what it takes, so that only what grows faster than
/// the program can fail.
const SECONDS: u32 = 12;
/// Memory that it may ask for, in KiB.
const MEMORY: u32 = 240 * 1024;

/// A program of 16,000 steps, with states at its end; `last` is the last output.
fn program(last: &str) -> String {
    let mut list = String::new();
    for i in 0..970 {
        let (a, b, c) = (i % 1000, (i * 7 + 3) % 1000, i % 200);
        _ = write!(list, ";! M{a} = comment {a}\n; Network {i}\n");
        _ = write!(
            list,
            "LD M{a}\nOR M{b}\nLDP X{c:o}\nANB\nMPS\nANI M{c}\nOUT T{c} K{i}\n"
        );
        _ = write!(list, "MPP\nMOV K{i} D{a}\n");
    }
    list += "LD M8002\nSET S0\n";
    for state in 0..100 {
        let next = (state + 1) % 100;
        _ = write!(
            list,
            "STL S{state}\nOUT Y{:o}\nLD X{:o}\nSET S{next}\n",
            state, state
        );
    }
    _ = write!(list, "RET\nLD X0\nOUT {last}\nEND\n");
    list
}

#[test]
fn large_programs_take_little_time_and_memory() {
    let (old, new) = (program("Y200"), program("Y201"));
    // One network without an end.
    let coils = format!("LD X000\n{}END\n", "OUT Y000\n".repeat(25_000));
    // One that no form but a list holds.
    let contacts = format!("LD X000\n{}OUT Y000\nEND\n", "AND M0\n".repeat(200_000));
    let folder = folder(&[
        ("old.il", old.as_bytes()),
        ("new.il", new.as_bytes()),
        ("coils.il", coils.as_bytes()),
        ("contacts.il", contacts.as_bytes()),
    ]);
    for (args, end) in [
        ("view old.il", 0),
        ("view old.il --sfc", 0),
        ("view old.il -o old.html", 0),
        ("view old.il -o old.svg", 0),
        ("view old.il -o old.pdf", 0),
        ("view coils.il", 0),
        ("view coils.il -o coils.html", 0),
        ("view coils.il -o coils.svg", 0),
        ("xref old.il", 0),
        ("stats old.il", 0),
        ("fmt old.il", 0),
        ("convert old.il --to ladder -o old.txt", 0),
        ("convert old.il --to plcopen -o old.xml", 0),
        ("convert contacts.il --to plcopen -o contacts.xml", 1),
        ("diff old.il new.il", 1),
        ("diff old.il new.il --semantic", 1),
        ("diff old.il new.il --format html -o diff.html", 1),
    ] {
        let rungc = env!("CARGO_BIN_EXE_rungc");
        let limited = format!("ulimit -t {SECONDS}; ulimit -v {MEMORY}; exec '{rungc}' {args}");
        let mut command = Command::new("sh");
        let out = command.args(["-c", &limited]).current_dir(folder.path());
        let out = out.output().unwrap();
        let messages = String::from_utf8_lossy(&out.stderr);
        assert_eq!(
            out.status.code(),
            Some(end),
            "{args}: {}\n{messages}",
            out.status
        );
        if args == "view old.il" {
            let page = String::from_utf8_lossy(&out.stdout);
            let steps = page
                .lines()
                .rev()
                .find_map(|line| line.split_whitespace().next()?.parse().ok());
            assert!(
                steps.is_some_and(|steps: u32| (15_000..17_000).contains(&steps)),
                "{steps:?}"
            );
        }
    }
}
