//! Properties of programs, proved and violated.

mod causes;
mod evidence;
mod peers;
mod properties;

#[cfg(unix)]
use crate::common;
use crate::common::{folder, reverser, rungc, shown, text};

/// Lines without the time that each verdict took.
fn timeless(text: &str) -> String {
    let lines = text.lines().map(|line| match line.rsplit_once(" (") {
        Some((before, seconds)) if seconds.ends_with(" s)") => before,
        _ => line,
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn an_interlock_is_proved_and_its_lack_is_shown() {
    let (good, bad) = (reverser("ANI Y000"), reverser("ANI X003"));
    let folder = folder(&[("good.il", good.as_bytes()), ("bad.il", bad.as_bytes())]);
    let verify = |args: &[&str]| {
        let output = rungc(
            folder.path(),
            &[&["verify", "--replay", "interp"], args].concat(),
        );
        let code = output.status.code();
        (code, timeless(&text(&output.stdout)), text(&output.stderr))
    };
    let (code, proved, _) = verify(&["good.il", "--never", "Y000 & Y001"]);
    assert_eq!(code, Some(0));
    insta::assert_snapshot!("proved", proved);
    let (code, violated, report) = verify(&["bad.il", "--never", "\"forward contactor\" & Y001"]);
    assert_eq!(code, Some(1));
    insta::assert_snapshot!("violated", violated);
    insta::assert_snapshot!("violated_report", report);
    let assumed = [
        "bad.il",
        "--never",
        "Y000 & Y001",
        "--assume",
        "!(X000 & X001)",
    ];
    let (code, still, _) = verify(&[&assumed[..], &["--reachable", "Y001"]].concat());
    assert_eq!(code, Some(1));
    insta::assert_snapshot!("violated_under_an_assumption", still);
}

/// A run that begins with a latched device that is on says where that comes from.
#[test]
fn a_latched_start_is_explained() {
    let list = "LD M500\nOUT Y000\nLD M501\nOUT Y001\nLD X000\nSET M500\nLD X001\nSET M501\nEND\n";
    let folder = folder(&[("a.il", list.as_bytes())]);
    let hint = "latched devices start at any value here; with `--cleared`, at 0";
    let verify = |options: &[&str]| {
        let args = [
            "verify",
            "a.il",
            "--replay",
            "interp",
            "--never",
            "Y000 & Y001",
        ];
        let output = rungc(folder.path(), &[&args[..], options].concat());
        assert_eq!(output.status.code(), Some(1), "{options:?}");
        text(&output.stdout)
    };
    assert!(verify(&[]).contains(hint), "{}", verify(&[]));
    assert!(!verify(&["--cleared"]).contains("latched devices start"));
}

/// A document without times.
fn untimed(document: &str) -> String {
    let mut parts = document.split(" time=\"");
    let mut text = parts.next().unwrap_or_default().to_string();
    for part in parts {
        text.push_str(" time=\"…");
        text.push_str(part.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.'));
    }
    timeless(&text)
}

#[test]
fn verdicts_are_for_tools_too() {
    let pid = "LD X000\nPID D0 D1 D100 D150\nLD> D150 K100\nOUT Y000\nEND\n";
    let folder = folder(&[
        ("bad.il", reverser("ANI X003").as_bytes()),
        ("pid.il", pid.as_bytes()),
        ("broken.il", b"LDD X000\n"),
    ]);
    let never = ["--never", "Y000 & Y001", "--never", "Y000 & X002"];
    for format in ["sarif", "junit", "github"] {
        let requested = ["verify", "bad.il", "--replay", "interp", "--format", format];
        let requested = [&requested[..], &never].concat();
        let output = rungc(folder.path(), &requested);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
        let printed = untimed(&text(&output.stdout));
        insta::assert_snapshot!(format!("verdicts_{format}"), printed);
        let output = rungc(
            folder.path(),
            &[&requested[..], &["-o", "verdicts"]].concat(),
        );
        assert_eq!(output.status.code(), Some(1));
        assert!(output.stdout.is_empty());
        assert!(text(&output.stderr).contains("Wrote verdicts: 1 of 2 hold"));
        let written = std::fs::read_to_string(folder.path().join("verdicts")).unwrap();
        assert_eq!(untimed(&written), printed);
    }
    let undecided = ["verify", "pid.il", "--cleared", "--never", "Y000"];
    let output = rungc(
        folder.path(),
        &[&undecided[..], &["--format", "junit"]].concat(),
    );
    assert_eq!(output.status.code(), Some(3));
    insta::assert_snapshot!("undecided_junit", untimed(&text(&output.stdout)));
    let same = ["verify", "bad.il", "--same-as", "bad.il", "--format"];
    let output = rungc(folder.path(), &[&same[..], &["junit"]].concat());
    assert_eq!(output.status.code(), Some(0));
    insta::assert_snapshot!("same_junit", untimed(&text(&output.stdout)));
    // Reasons that prevent a verification are in the report, too.
    for (file, format, code) in [
        ("broken.il", "junit", "E0033"),
        ("broken.il", "github", "title=E0033"),
        ("missing.il", "json", "\"E0"),
        ("missing.il", "junit", "type=\"E0"),
    ] {
        let requested = ["verify", file, "--never", "Y000", "--format", format];
        let output = rungc(folder.path(), &requested);
        assert_eq!(output.status.code(), Some(2));
        let printed = text(&output.stdout);
        assert!(printed.contains(code), "{file} {format}: {printed}");
    }
}

#[test]
fn a_counterexample_is_a_test() {
    let folder = folder(&[("bad.il", reverser("ANI X003").as_bytes())]);
    let args = [
        "verify",
        "bad.il",
        "--never",
        "Y000 & Y001",
        "--write-test",
        "bad.plctest.toml",
        "--replay",
        "interp",
    ];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(1));
    let test = std::fs::read_to_string(folder.path().join("bad.plctest.toml")).unwrap();
    insta::assert_snapshot!("test_file", test);
    // It fails until the program is repaired.
    let tested = || rungc(folder.path(), &["test", "bad.plctest.toml"]);
    assert_eq!(tested().status.code(), Some(1));
    std::fs::write(folder.path().join("bad.il"), reverser("ANI Y000")).unwrap();
    let output = tested();
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn buffer_memory_may_hold_anything() {
    // One reads it as an operand, the other moves it to a register first.
    let program = "LD M8000\nFROM K0 K10 D0 K1\nLD> D0 K500\nAND X000\nOUT Y000\nLD> U0\\G10 K700\nAND X001\nOUT Y001\n\
                   LD> D0 K700\nANI X001\nOUT Y002\nEND\n";
    let folder = folder(&[("scale.il", program.as_bytes())]);
    let args = [
        "verify",
        "scale.il",
        "--never",
        "Y000 & Y001",
        "--never",
        "Y001 & Y002",
        "--write-test",
        "scale.plctest.toml",
        "--replay",
        "interp",
    ];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    insta::assert_snapshot!("buffer_memory", timeless(&text(&output.stdout)));
    let test = std::fs::read_to_string(folder.path().join("scale.plctest.toml")).unwrap();
    insta::assert_snapshot!("buffer_memory_test", test);
    let output = rungc(folder.path(), &["test", "scale.plctest.toml"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
}

#[test]
fn what_is_not_decided_has_an_exit_code() {
    let program = "LD X000\nPID D0 D1 D100 D150\nLD> D150 K100\nOUT Y000\nEND\n";
    let folder = folder(&[("pid.il", program.as_bytes())]);
    let output = rungc(
        folder.path(),
        &["verify", "pid.il", "--never", "Y000", "--cleared"],
    );
    insta::assert_snapshot!("not_decided", timeless(&text(&output.stdout)));
    assert_eq!(output.status.code(), Some(3));
}

#[test]
fn mistakes_in_conditions_are_shown() {
    let folder = folder(&[("good.il", reverser("ANI Y000").as_bytes())]);
    insta::assert_snapshot!(
        "mistake",
        shown(
            folder.path(),
            &["verify", "good.il", "--never", "Y000 & Pump"]
        )
    );
    insta::assert_snapshot!("no_property", shown(folder.path(), &["verify", "good.il"]));
    let output = rungc(folder.path(), &["verify", "good.il", "--never", "Y000 &"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn settings_hold_properties() {
    let settings = "\
[project]
program = \"good.il\"

[verify]
assume = [\"!(X000 & X001)\"]
free = [\"M100-M101\"]
scan = \"50ms\"

[[property]]
name = \"no short circuit\"
never = '\"forward contactor\" & \"reverse contactor\"'

[[property]]
whenever = \"X002\"
then = \"!Y000\"
within = \"100ms\"

[[property]]
stays = \"Y000\"
until = \"X002 | Y001\"
";
    let good = reverser("ANI Y000");
    let folder = folder(&[
        ("good.il", good.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
    ]);
    let output = rungc(folder.path(), &["verify"]);
    insta::assert_snapshot!("settings", timeless(&text(&output.stdout)));
    let wrong = settings.replace("reverse contactor", "reverse pump");
    std::fs::write(folder.path().join("rungc.toml"), wrong).unwrap();
    insta::assert_snapshot!("mistake_in_settings", shown(folder.path(), &["verify"]));
    let wrong = "[[property]]\nnever = \"Y000\"\nthen = \"Y001\"\n[[property]]\nwhenever = \"X000\"\n[[property]]\nname = \"none\"\n[verify]\nfree = [\"pump\"]\nsupposed = 1\n";
    std::fs::write(folder.path().join("rungc.toml"), wrong).unwrap();
    insta::assert_snapshot!(
        "wrong_settings",
        shown(folder.path(), &["verify", "good.il"])
    );
}

/// A start-stop circuit, a timer, a controller, an edge.
const LINE: &str = "\
LD X000
OR M0
ANI X001
OUT M0
LD M0
OUT T0 K30
LD T0
OUT Y000
LDP X002
ADD D0 K1 D0
LD M0
PID D100 D110 D200 D220
LD> D220 K100
OUT Y001
LDP X003
OUT Y002
END
";

#[test]
fn outputs_of_two_programs_are_compared() {
    let added = LINE.replace("LDP X002", "LDP X005\nOUT Y004\nLDP X002");
    let slower = LINE.replace("K30", "K31");
    // The same relay by another way: the two contacts of a latch, and a relay that nothing else reads.
    let rewritten = LINE.replace(
        "LD X000\nOR M0\nANI X001\nOUT M0\n",
        "LDI X001\nOUT M9\nLD M9\nAND X000\nLD M0\nAND M9\nORB\nOUT M0\n",
    );
    let folder = folder(&[
        ("old.il", LINE.as_bytes()),
        ("added.il", added.as_bytes()),
        ("slower.il", slower.as_bytes()),
        ("rewritten.il", rewritten.as_bytes()),
    ]);
    let compared = |new: &str| {
        let args = ["verify", new, "--same-as", "old.il", "--replay", "interp"];
        let output = rungc(folder.path(), &args);
        (output.status.code(), timeless(&text(&output.stdout)))
    };
    assert_eq!(compared("old.il").0, Some(0));
    let (code, same) = compared("rewritten.il");
    assert_eq!(code, Some(0), "{same}");
    insta::assert_snapshot!("same_rewritten", same);
    let (code, other) = compared("added.il");
    assert_eq!(code, Some(1), "{other}");
    insta::assert_snapshot!("same_added", other);
    let (code, other) = compared("slower.il");
    assert_eq!(code, Some(1), "{other}");
    insta::assert_snapshot!("same_slower", other);
}

#[test]
fn devices_that_a_panel_can_set_are_inputs() {
    // Nothing drives the step, the counter or the relay: a panel or another PLC may.
    let program = "LD S500\nOUT Y000\nLD C20\nOUT Y001\nLD M77\nOUT Y002\nEND\n";
    let folder = folder(&[("panel.il", program.as_bytes())]);
    for output in ["Y000", "Y001", "Y002"] {
        let args = [
            "verify", "panel.il", "--never", output, "--replay", "interp",
        ];
        let output = rungc(folder.path(), &args);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    }
}

#[test]
fn devices_that_the_settings_connect_are_inputs() {
    // By itself, the program never switches one of these on.
    let program = "LD M100\nANI M102\nOUT Y000\nLD= D10 K7\nOUT Y001\nLD M500\nANI M102\nOUT Y002\nLD= Z0 K3\n\
                   OUT Y003\nLD X000\nOUT M100\nOUT M102\nOUT M500\nMOV K5 D10\nEND\n";
    let settings = "\
[project]
program = \"line.il\"

[serve]
modbus-tcp = \"5020\"
M = \"M100-M107\"

[io.recipe]
files = \"recipe\"
X001 = \"read start\"
D10 = \"read recipe\"
fault = \"M500\"
";
    let folder = folder(&[
        ("line.il", program.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
    ]);
    let requested = [
        "verify",
        "line.il",
        "--replay",
        "interp",
        "--cleared",
        "--never",
        "Y000",
        "--never",
        "Y001",
        "--never",
        "Y002",
        "--never",
        "Y003",
        "--never",
        "M100 & !X000",
        "--never",
        "D10 = 8 & X000",
    ];
    let output = rungc(folder.path(), &requested);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    insta::assert_snapshot!("outside", timeless(&text(&output.stdout)));
    // A search changes them, too.
    let requested = [
        "explore", "line.il", "--never", "Y001", "--scans", "200000", "--seed", "1", "--replay",
        "interp",
    ];
    let output = rungc(folder.path(), &requested);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(
        text(&output.stdout).contains("D10 = 7"),
        "{}",
        text(&output.stdout)
    );
    // Without the settings nothing sets them. M500 is latched: it outlasts STOP, where M102 does not.
    std::fs::remove_file(folder.path().join("rungc.toml")).unwrap();
    let output = rungc(
        folder.path(),
        &["verify", "line.il", "--cleared", "--never", "Y000 | Y001"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
}

/// A C compiler that takes a contact for its opposite.
#[cfg(unix)]
#[test]
fn no_verdict_rests_on_engines_that_disagree() {
    let compiler = "#!/bin/sh\nfor file in \"$@\"; do\n    case \"$file\" in\n        \
                    *.c) sed -i 's/ & !plc->X3;/ \\& plc->X3;/' \"$file\" ;;\n    esac\ndone\nexec cc \"$@\"\n";
    let program = reverser("ANI X003");
    let folder = folder(&[("bad.il", program.as_bytes())]);
    let path = folder.path().join("compiler");
    common::write_executable(&path, compiler.as_bytes());
    let verify = |requested: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(["verify", "bad.il", "--replay", "c"])
            .args(requested)
            .current_dir(folder.path())
            // A wrong build must not be reused.
            .env("RUNGC_CACHE_DIR", folder.path().join("cache"))
            .env("CC", &path)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
        let report = common::normal(&text(&output.stderr), folder.path());
        (timeless(&text(&output.stdout)), report)
    };
    let (verdict, report) = verify(&["--never", "Y000 & Y001", "--always", "!Y000 | !X002"]);
    insta::assert_snapshot!("engines_disagree", verdict);
    insta::assert_snapshot!("engines_disagree_report", report);
    let other = program.replace("OR Y001\n", "");
    std::fs::write(folder.path().join("old.il"), other).unwrap();
    let (verdict, _) = verify(&["--same-as", "old.il"]);
    assert!(
        verdict.contains("the engines of rungc disagree, so no verdict can be trusted"),
        "{verdict}"
    );
}

#[test]
fn what_can_never_happen_is_found() {
    let program = "\
LD X000
ANI X000
OUT M10
LD M10
OUT Y000
LD X001
ANI T0
OUT M11
LD M11
ANI M12
OUT T0 K50
LDI M13
OUT M12
LDI M12
OUT M13
LD X002
MOV K3 D0
LD X003
MOV K7 D0
LD> D0 K9
OUT Y001
LDI Y002
AND X004
OUT Y002
LD M8002
SET S0
STL S0
LD X005
SET S20
STL S20
OUT Y003
RET
LD X006
OUT Y004
END
";
    // The same, as it was meant.
    let plain = "LD X000\nANI X001\nOUT M10\nLD M10\nOUT T0 K50\nLD T0\nOUT Y000\nLD> D0 K9\nOUT Y001\nEND\n";
    let folder = folder(&[
        ("never.il", program.as_bytes()),
        ("plain.il", plain.as_bytes()),
    ]);
    let output = rungc(folder.path(), &["check", "--deep", "never.il"]);
    insta::assert_snapshot!(
        "deep",
        text(&output.stderr)
            .lines()
            .filter(|line| !line.contains(" Checked "))
            .collect::<Vec<_>>()
            .join("\n")
    );
    let output = rungc(folder.path(), &["check", "--deep", "plain.il"]);
    assert!(
        !text(&output.stderr).contains("W09"),
        "{}",
        text(&output.stderr)
    );
}

/// A machine with a mode in D70, which a panel chooses; D97 is the mode in use.
const MODES: &str = "\
;! cpu = FX1N
LD M8002
RST D70
RST D97
LD= D70 K3
OUT M20
LD M20
OUT Y000
LD<> D70 D97
AND X000
MOV D97 D70
LD<> D70 D97
ANI X000
MOV D70 D97
END
";

/// Settings that name D70 as written from outside, each in its own way.
const WRITTEN: [&str; 5] = [
    "[hmi]\nwrites = \"D70-D79\"\n",
    "[hmi]\nwrites = [\"M5\", \"d70\"]\n",
    "[serve]\nD = \"D70\"\n",
    "[verify]\nfree = [\"D70\"]\n",
    "[io.panel]\nfiles = \".\"\nD70 = \"read mode\"\n",
];

#[test]
fn what_a_panel_may_write_is_not_proved() {
    let folder = folder(&[("modes.il", MODES.as_bytes())]);
    let run = |args: &[&str]| {
        let output = rungc(folder.path(), args);
        let code = output.status.code();
        (code, text(&output.stdout) + &text(&output.stderr))
    };
    let commands: [(&[&str], i32, i32); 3] = [
        (&["check", "--deep", "modes.il", "-D", "never-on"], 1, 0),
        (
            &["verify", "modes.il", "--never", "M20", "--replay", "interp"],
            0,
            1,
        ),
        (
            &[
                "explore", "modes.il", "--never", "Y000", "--scans", "4000", "--first",
            ],
            0,
            1,
        ),
    ];
    for (command, alone, _) in commands {
        let (code, shown) = run(command);
        assert_eq!(code, Some(alone), "{command:?}: {shown}");
    }
    let (_, deep) = run(&["check", "--deep", "modes.il"]);
    assert!(
        deep.contains("if only the program writes D70, D97;"),
        "{deep}"
    );
    assert!(deep.contains("under these assumptions:"), "{deep}");
    assert!(deep.contains("what `[hmi]` names: no panel"), "{deep}");
    for settings in WRITTEN {
        let settings = format!("[project]\nprogram = \"modes.il\"\n{settings}");
        std::fs::write(folder.path().join("rungc.toml"), &settings).unwrap();
        for (command, _, written) in commands {
            let (code, shown) = run(command);
            assert_eq!(code, Some(written), "{command:?} {settings}: {shown}");
        }
        let (_, deep) = run(&["check", "--deep", "modes.il"]);
        assert!(
            !deep.contains("W09") && !deep.contains("assumptions"),
            "{deep}"
        );
    }
}

/// What never acts is marked at its first output, not at the END that follows it.
#[test]
fn a_rung_that_never_acts_is_marked_itself() {
    let program = "\
LD M8002
RST D70
RST D97
LD<> D70 D97
AND X000
MOV D97 D70
LD<> D70 D97
ANI X000
MOV D70 D97
END
";
    let folder = folder(&[("dead.il", program.as_bytes())]);
    let shown = text(&rungc(folder.path(), &["check", "--deep", "dead.il"]).stderr);
    let found = shown.split("warning[");
    let found: Vec<_> = found.filter(|found| found.starts_with("W0902")).collect();
    let is_marked = |line: usize| {
        let place = format!("[ dead.il:{line}:1 ]");
        found.iter().any(|found| found.contains(&place))
    };
    assert!(is_marked(6) && is_marked(9) && found.len() == 2, "{shown}");
}
